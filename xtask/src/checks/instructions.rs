//! Instructions of one call of each kernel, beside those of `benches/instructions.toml`.
//!
//! Times on a shared machine are too variable for a check; counts are not. Each kernel runs N and
//! 2 N times under callgrind, and the difference divided by N is one call, without the startup. The
//! count depends on the compiler and slightly on the processor, for which the mathematical library
//! selects its variants, so it is compared with a tolerance, and only with the same compiler.

use crate::outcome::{Context, Outcome};
use crate::{cargo, tool};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The fraction by which a count may grow before the check fails.
const TOLERANCE: f64 = 0.05;

pub(super) fn run(context: &Context) -> Outcome {
    if !tool::is_installed(&mut Command::new("valgrind")) {
        return Outcome::Skipped("valgrind is not installed".into());
    }
    compare(context).unwrap_or_else(Outcome::Failed)
}

fn compare(context: &Context) -> Result<Outcome, String> {
    let program = build(context)?;
    let compiler = compiler(context)?;
    let mut counts = BTreeMap::new();
    for line in tool::output(context, Command::new(&program).arg("list"))?.lines() {
        let known = line.split_once(' ').and_then(|(name, n)| Some((name, n.parse().ok()?)));
        let (kernel, repeats): (_, u64) =
            known.ok_or_else(|| format!("`{line}` names no kernel and its repeats"))?;
        let [once, twice] = [repeats, 2 * repeats].map(|repeats| count(&program, kernel, repeats));
        counts.insert(kernel.to_owned(), (twice? - once?) as f64 / repeats as f64);
    }
    let file = context.root.join("benches/instructions.toml");
    if context.bless {
        std::fs::write(&file, written(&compiler, &counts))
            .map_err(|error| format!("{}: {error}", file.display()))?;
        counts.iter().for_each(|(kernel, count)| println!("   {kernel:<20} {count:>10.0}"));
        return Ok(Outcome::Passed);
    }
    let text =
        std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    let committed = Committed::parse(&text);
    let findings = judge(&committed, &counts);
    if committed.compiler != compiler {
        return Ok(Outcome::Skipped(format!(
            "the committed counts are those of {}, this is {compiler}",
            committed.compiler
        )));
    }
    Ok(if findings.is_empty() { Outcome::Passed } else { Outcome::Failed(findings.join("; ")) })
}

/// Prints every kernel beside its committed count; returns what is wrong.
fn judge(committed: &Committed, counts: &BTreeMap<String, f64>) -> Vec<String> {
    let mut findings = vec![];
    println!("   {:<20} {:>10} {:>10} {:>8}", "kernel", "committed", "now", "change");
    for (kernel, &now) in counts {
        let Some(&before) = committed.counts.get(kernel) else {
            findings.push(format!("{kernel} has no committed count: --bless writes it"));
            continue;
        };
        let change = now / before - 1.0;
        let word = if change < -TOLERANCE { "  far below: --bless keeps the gain" } else { "" };
        println!("   {kernel:<20} {before:>10.0} {now:>10.0} {:>+7.1}%{word}", 100.0 * change);
        if change > TOLERANCE {
            findings.push(format!(
                "{kernel} takes {:.1} % more instructions (--bless accepts that)",
                100.0 * change
            ));
        }
    }
    for kernel in committed.counts.keys().filter(|kernel| !counts.contains_key(*kernel)) {
        findings.push(format!("{kernel} has a committed count but is no kernel"));
    }
    findings
}

/// The contents of the file.
#[derive(Debug, Default, PartialEq)]
struct Committed {
    compiler: String,
    counts: BTreeMap<String, f64>,
}

impl Committed {
    fn parse(text: &str) -> Self {
        let mut committed = Self::default();
        for (key, value) in text.lines().filter_map(|line| line.split_once(" = ")) {
            if key == "compiler" {
                committed.compiler = value.trim_matches('"').to_owned();
            } else if let Ok(count) = value.parse() {
                committed.counts.insert(key.to_owned(), count);
            }
        }
        committed
    }
}

fn written(compiler: &str, counts: &BTreeMap<String, f64>) -> String {
    let mut text = format!(
        "# Instructions of one call of each kernel, counted by callgrind.\n\
         # Written by `cargo xtask instructions --bless`.\n\
         compiler = \"{compiler}\"\n\n[instructions]\n"
    );
    for (kernel, count) in counts {
        text.push_str(&format!("{kernel} = {count:.0}\n"));
    }
    text
}

/// Builds the program that runs the kernels; its path.
fn build(context: &Context) -> Result<PathBuf, String> {
    let arguments = ["--release", "--package", "condyle-benches", "--bin", "instruction_counts"];
    let program = cargo::build(context, &arguments)?.pop();
    program.map(|(_, path)| path).ok_or_else(|| "cargo named no program".to_owned())
}

/// The release and the platform of the compiler.
fn compiler(context: &Context) -> Result<String, String> {
    let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    let said = tool::output(context, command.arg("-vV"))?;
    let part = |key| said.lines().find_map(|line| line.strip_prefix(key)).unwrap_or("?");
    Ok(format!("rustc {} {}", part("release: "), part("host: ")))
}

/// Instructions of a whole run.
fn count(program: &Path, kernel: &str, repeats: u64) -> Result<u64, String> {
    let name = format!("condyle-{}-{kernel}.callgrind", std::process::id());
    let file = std::env::temp_dir().join(name);
    let mut command = Command::new("valgrind");
    command.arg("--tool=callgrind").arg(format!("--callgrind-out-file={}", file.display()));
    command.arg(program).args([kernel, &repeats.to_string()]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let status = command.status().map_err(|error| format!("valgrind: {error}"))?;
    let text = std::fs::read_to_string(&file);
    // The name is unique; a file that cannot be removed does no harm.
    let _ = std::fs::remove_file(&file);
    if !status.success() {
        return Err(format!("valgrind ended with {status} on {kernel}"));
    }
    let text = text.map_err(|error| format!("{}: {error}", file.display()))?;
    let total = text.lines().find_map(|line| {
        let rest = line.strip_prefix("summary:").or_else(|| line.strip_prefix("totals:"))?;
        rest.trim().parse().ok()
    });
    total.ok_or_else(|| format!("callgrind gave no total for {kernel}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    #[test]
    fn what_is_written_is_read() {
        let counts = BTreeMap::from([("pose".to_owned(), 1234.0), ("spline".to_owned(), 56.0)]);
        let read = Committed::parse(&written("rustc 1.2.3 somewhere", &counts));
        assert_eq!(read, Committed { compiler: "rustc 1.2.3 somewhere".to_owned(), counts });
    }

    #[test]
    fn growth_beyond_the_tolerance_is_found() {
        let counts = |n: f64| BTreeMap::from([("pose".to_owned(), n)]);
        let committed = Committed { compiler: String::new(), counts: counts(1000.0) };
        assert!(judge(&committed, &counts(1049.0)).is_empty());
        assert!(judge(&committed, &counts(500.0)).is_empty());
        assert_eq!(judge(&committed, &counts(1051.0)).len(), 1);
    }

    #[test]
    fn a_kernel_without_a_count_and_a_count_without_a_kernel_are_found() {
        let counts = |names: &[&str]| names.iter().map(|name| ((*name).to_owned(), 1.0)).collect();
        let committed = |names| Committed { compiler: String::new(), counts: counts(names) };
        assert!(judge(&committed(&["pose"]), &counts(&["pose"])).is_empty());
        assert_eq!(
            judge(&committed(&["pose", "gone"]), &counts(&["pose", "new"])),
            [
                "new has no committed count: --bless writes it",
                "gone has a committed count but is no kernel"
            ]
        );
    }

    /// A program with one kernel that runs the code in `work`.
    fn kernels(workspace: Workspace, work: &str) -> Workspace {
        let text = format!(
            "fn main() {{\n    let words: Vec<String> = std::env::args().skip(1).collect();\n    \
             let [_, repeats] = &words[..] else {{ return println!(\"kernel 100\") }};\n    \
             for n in 0..repeats.parse().unwrap() {{\n        {work}\n    }}\n}}\n"
        );
        workspace.file("src/bin/instruction_counts.rs", &text)
    }

    #[test]
    fn a_kernel_that_takes_more_than_before_fails() {
        if !tool::is_installed(&mut Command::new("valgrind")) {
            return eprintln!("skipped: valgrind is not installed");
        }
        let little = "std::hint::black_box::<u64>(n);";
        let much = "(0..1000 + n).for_each(|n| { std::hint::black_box(n); });";
        let workspace = Workspace::of_one_crate()
            .with_instead("Cargo.toml", "sound", "condyle-benches")
            .file("benches/instructions.toml", "");
        let workspace = kernels(workspace, little);
        let blessed = run(&Context { bless: true, ..workspace.context() });
        assert!(matches!(blessed, Outcome::Passed), "{blessed:?}");
        let workspace = workspace.passes(run);
        kernels(workspace, much).fails(run, "% more instructions");
    }
}
