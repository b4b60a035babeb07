//! Units of length in files.

/// A unit of length in a file; in memory, lengths are in metres.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LengthUnit {
    /// `m`
    #[default]
    Metre,
    /// `cm`
    Centimetre,
    /// `mm`
    Millimetre,
    /// `in`, 0.0254 m
    Inch,
    /// `ft`, 0.3048 m
    Foot,
}

impl LengthUnit {
    /// The unit of this name, in any of the spellings found in files.
    ///
    /// ```
    /// use condyle_motion::LengthUnit;
    /// assert_eq!(LengthUnit::from_name(" MM "), Some(LengthUnit::Millimetre));
    /// assert_eq!(LengthUnit::from_name("meters"), Some(LengthUnit::Metre));
    /// assert_eq!(LengthUnit::from_name("furlong"), None);
    /// ```
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        // C3D cuts units to four letters: "mete".
        let bare = name.trim().trim_matches(['(', ')', '[', ']']).trim_end_matches('.');
        match bare.to_ascii_lowercase().as_str() {
            "m" | "mete" | "meter" | "meters" | "metre" | "metres" => Some(Self::Metre),
            "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => {
                Some(Self::Centimetre)
            }
            "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => {
                Some(Self::Millimetre)
            }
            "in" | "inch" | "inches" | "\"" => Some(Self::Inch),
            "ft" | "foot" | "feet" => Some(Self::Foot),
            _ => None,
        }
    }

    /// The short name, as written in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }

    /// A length in this unit, in metres.
    ///
    /// ```
    /// use condyle_motion::LengthUnit;
    /// assert_eq!(LengthUnit::Millimetre.to_metres(125.0), 0.125);
    /// assert_eq!(LengthUnit::Inch.to_metres(10.0), 0.254);
    /// ```
    #[must_use]
    pub fn to_metres(self, length: f64) -> f64 {
        // Dividing by a whole number rounds once, multiplying by 0.001 twice.
        match self {
            Self::Metre => length,
            Self::Centimetre => length / 100.0,
            Self::Millimetre => length / 1000.0,
            Self::Inch => length * 0.0254,
            Self::Foot => length * 0.3048,
        }
    }

    /// A length in metres, in this unit: among the neighbouring doubles that read back as the same
    /// length, the one with the shortest decimal, so that a file read and written keeps its digits.
    #[must_use]
    pub fn from_metres(self, length: f64) -> f64 {
        let near = match self {
            Self::Metre => return length,
            Self::Centimetre => length * 100.0,
            Self::Millimetre => length * 1000.0,
            Self::Inch => length / 0.0254,
            Self::Foot => length / 0.3048,
        };
        [near, near.next_up(), near.next_down()]
            .into_iter()
            .filter(|candidate| self.to_metres(*candidate) == length)
            .min_by_key(|candidate| candidate.to_string().len())
            .unwrap_or(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_read_and_written_keeps_its_digits() {
        for unit in [LengthUnit::Millimetre, LengthUnit::Centimetre, LengthUnit::Inch] {
            for thousandths in (-50_000_i32..50_000).step_by(7) {
                let written: f64 = format!("{thousandths}e-3").parse().unwrap();
                let metres = unit.to_metres(written);
                assert_eq!(unit.to_metres(unit.from_metres(metres)), metres);
                if unit == LengthUnit::Millimetre {
                    assert_eq!(unit.from_metres(metres), written);
                }
            }
        }
    }
}
