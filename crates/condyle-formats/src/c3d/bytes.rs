//! Numbers as the three processors store them.

/// The processor whose way of storing numbers a file follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Processor {
    /// Intel: the lowest byte first, IEEE floats.
    #[default]
    Intel,
    /// DEC: the lowest byte first, floats of the VAX.
    Dec,
    /// SGI and MIPS: the highest byte first, IEEE floats.
    Mips,
}

impl Processor {
    /// Its short name.
    ///
    /// ```
    /// assert_eq!(condyle_formats::c3d::Processor::Mips.name(), "SGI/MIPS");
    /// ```
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Intel => "Intel",
            Self::Dec => "DEC",
            Self::Mips => "SGI/MIPS",
        }
    }

    /// By the fourth byte of the parameter section.
    pub(super) fn from_code(code: u8) -> Option<Self> {
        match code {
            84 => Some(Self::Intel),
            85 => Some(Self::Dec),
            86 => Some(Self::Mips),
            _ => None,
        }
    }

    /// A whole number of 16 bits.
    pub(super) fn u16(self, bytes: [u8; 2]) -> u16 {
        match self {
            Self::Intel | Self::Dec => u16::from_le_bytes(bytes),
            Self::Mips => u16::from_be_bytes(bytes),
        }
    }

    /// A float of 32 bits.
    ///
    /// Those of the VAX have their halves exchanged and an exponent that is two larger; their zero has no
    /// exponent, whatever the rest is.
    pub(super) fn f32(self, bytes: [u8; 4]) -> f32 {
        match self {
            Self::Intel => f32::from_le_bytes(bytes),
            Self::Mips => f32::from_be_bytes(bytes),
            Self::Dec => {
                let [a, b, c, d] = bytes;
                let bits = u32::from_le_bytes([c, d, a, b]);
                if bits & 0x7f80_0000 == 0 {
                    return 0.0;
                }
                // As a double no exponent of the VAX is special; a quarter of it fits a float again.
                let exponent = i32::from(((bits >> 23) & 0xff) as u8) - 129;
                let fraction = 1.0 + f64::from(bits & 0x007f_ffff) / 8_388_608.0;
                let sign = if bits >> 31 == 1 { -1.0 } else { 1.0 };
                (sign * fraction * f64::powi(2.0, exponent)) as f32
            }
        }
    }
}

/// The bytes of a file, read at any place; `None` behind its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'b> {
    pub(super) bytes: &'b [u8],
    pub(super) processor: Processor,
}

impl Source<'_> {
    pub(super) fn u8(&self, at: usize) -> Option<u8> {
        self.bytes.get(at).copied()
    }

    pub(super) fn i8(&self, at: usize) -> Option<i8> {
        self.u8(at).map(|byte| byte as i8)
    }

    pub(super) fn u16(&self, at: usize) -> Option<u16> {
        self.array(at).map(|bytes| self.processor.u16(bytes))
    }

    pub(super) fn f32(&self, at: usize) -> Option<f32> {
        self.array(at).map(|bytes| self.processor.f32(bytes))
    }

    fn array<const N: usize>(&self, at: usize) -> Option<[u8; N]> {
        self.bytes.get(at..at.checked_add(N)?)?.try_into().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_of_the_vax() {
        // VAX Architecture Reference Manual: F_floating has hidden-bit fraction 0.1m and exponent excess 128,
        // so 1.0 = 0.5 * 2^1 has the exponent 129; the word with sign and exponent is stored first.
        for (bytes, value) in [
            ([0x80, 0x40, 0, 0], 1.0),
            ([0x80, 0xc0, 0, 0], -1.0),
            ([0x00, 0x41, 0, 0], 2.0),
            ([0x48, 0x43, 0, 0], 50.0),
            ([0, 0, 0, 0], 0.0),
            ([0x7f, 0, 0xff, 0xff], 0.0),
        ] {
            assert_eq!(Processor::Dec.f32(bytes), value, "{bytes:?}");
        }
        // 0.1 is 0x3dcccccd as IEEE; as VAX its exponent is two larger and its halves are exchanged.
        assert_eq!(Processor::Dec.f32([0xcc, 0x3e, 0xcd, 0xcc]), 0.1);
        assert_eq!(Processor::Mips.f32([0x3d, 0xcc, 0xcc, 0xcd]), 0.1);
        assert_eq!(Processor::Mips.u16([0x30, 0x39]), 12345);
        // The largest is finite; four times smaller than the same bits of IEEE.
        assert_eq!(Processor::Dec.f32([0xff, 0x7f, 0xff, 0xff]), 1.701_411_7e38);
    }

    #[test]
    fn nothing_is_read_behind_the_end() {
        let source = Source { bytes: &[1, 2, 3], processor: Processor::Intel };
        assert_eq!(source.u16(1), Some(0x0302));
        assert_eq!(source.u16(2), None);
        assert_eq!(source.f32(usize::MAX), None);
    }
}
