//! A list of warnings that stays short.

use crate::Diagnostic;

/// How many warnings of one code are kept in full.
const KEPT_PER_CODE: usize = 5;

/// Collects warnings; after five of one code it counts the rest, so that a file of a million short
/// rows costs five sentences and a sum.
#[derive(Debug, Default)]
pub struct Warnings {
    kept: Vec<Diagnostic>,
    counts: Vec<(&'static str, usize)>,
}

impl Warnings {
    /// Adds one; the closure runs only if the sentence will be kept.
    pub fn add(&mut self, code: &'static str, say: impl FnOnce() -> Diagnostic) {
        let count = match self.counts.iter_mut().find(|(c, _)| *c == code) {
            Some((_, count)) => {
                *count += 1;
                *count
            }
            None => {
                self.counts.push((code, 1));
                1
            }
        };
        if count <= KEPT_PER_CODE {
            self.kept.push(say());
        }
    }

    /// Adds one that is already a sentence.
    pub fn push(&mut self, warning: Diagnostic) {
        self.add(warning.code, || warning);
    }

    /// Adds those of an inner reader.
    pub fn extend(&mut self, warnings: Vec<Diagnostic>) {
        for warning in warnings {
            self.push(warning);
        }
    }

    /// The list, each code's surplus summed up at the end.
    #[must_use]
    pub fn finish(mut self) -> Vec<Diagnostic> {
        for (code, count) in self.counts {
            if count > KEPT_PER_CODE {
                self.kept.push(Diagnostic::warning(
                    code,
                    format!("and {} more like the last `{code}`", count - KEPT_PER_CODE),
                ));
            }
        }
        self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Place;

    #[test]
    fn surplus_warnings_are_counted() {
        let mut warnings = Warnings::default();
        for line in 1..=9 {
            warnings.add("x/y", || Diagnostic::warning("x/y", "odd").at(Place::at_line(line)));
        }
        let list = warnings.finish();
        assert_eq!(list.len(), 6);
        assert_eq!(list[4].to_string(), "line 5: odd");
        assert_eq!(list[5].message, "and 4 more like the last `x/y`");
    }
}
