//! C3D files put together byte by byte, for any processor and storage, right or wrong.

/// Who stores numbers how.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Processor {
    Intel = 84,
    Dec = 85,
    Mips = 86,
}

impl Processor {
    fn word(self, value: i32) -> Vec<u8> {
        let value = value as u16;
        match self {
            Self::Mips => value.to_be_bytes().to_vec(),
            _ => value.to_le_bytes().to_vec(),
        }
    }

    fn float(self, value: f32) -> Vec<u8> {
        match self {
            Self::Intel => value.to_le_bytes().to_vec(),
            Self::Mips => value.to_be_bytes().to_vec(),
            // Of the VAX the exponent is two larger, and the half with the sign stands first.
            Self::Dec if value == 0.0 => vec![0; 4],
            Self::Dec => {
                let bits = value.to_bits() + (2 << 23);
                let [a, b, c, d] = bits.to_le_bytes();
                vec![c, d, a, b]
            }
        }
    }
}

/// A parameter: its group, its name, type, sizes, and its values as bytes.
pub(crate) type Parameter = (u8, &'static str, i8, Vec<u8>, Vec<u8>);

/// What a file is made of.
#[derive(Clone)]
pub(crate) struct Build {
    pub(crate) processor: Processor,
    pub(crate) real: bool,
    pub(crate) scale: f32,
    /// Frames by the header.
    pub(crate) frames: [i32; 2],
    pub(crate) points: i32,
    pub(crate) analog: i32,
    pub(crate) samples: i32,
    /// x, y, z and word of each point, and the analog numbers, frame by frame.
    pub(crate) numbers: Vec<f32>,
    pub(crate) parameters: Vec<Parameter>,
}

impl Build {
    /// Three points in two frames; coordinates in steps of the scale are 100, 200, …
    pub(crate) fn new(processor: Processor, real: bool) -> Self {
        let numbers = (0..24).map(|i| if i % 4 == 3 { 0.0 } else { 100.0 * (i + 1) as f32 });
        let mut build = Self {
            processor,
            real,
            scale: 0.25,
            frames: [1, 2],
            points: 3,
            analog: 0,
            samples: 1,
            numbers: numbers.collect(),
            parameters: vec![],
        };
        build.text(1, "LABELS", &["A", "B", "C"]);
        build.text(1, "UNITS", &["mm"]);
        build.word(1, "USED", 3);
        build.word(1, "FRAMES", 2);
        build.float(1, "RATE", 50.0);
        let sign = if real { -1.0 } else { 1.0 };
        build.float(1, "SCALE", sign * 0.25);
        build
    }

    pub(crate) fn text(&mut self, group: u8, name: &'static str, texts: &[&str]) {
        let width = texts.iter().map(|t| t.len()).max().unwrap_or(0);
        let letters = texts.iter().flat_map(|t| format!("{t:<width$}").into_bytes()).collect();
        self.parameters.push((group, name, -1, vec![width as u8, texts.len() as u8], letters));
    }

    pub(crate) fn word(&mut self, group: u8, name: &'static str, value: i32) {
        self.parameters.push((group, name, 2, vec![], self.processor.word(value)));
    }

    pub(crate) fn float(&mut self, group: u8, name: &'static str, value: f32) {
        self.parameters.push((group, name, 4, vec![], self.processor.float(value)));
    }

    pub(crate) fn floats(&mut self, group: u8, name: &'static str, sizes: &[u8], values: &[f32]) {
        let bytes = values.iter().flat_map(|v| self.processor.float(*v)).collect();
        self.parameters.push((group, name, 4, sizes.to_vec(), bytes));
    }

    pub(crate) fn words(&mut self, group: u8, name: &'static str, values: &[i32]) {
        let bytes = values.iter().flat_map(|v| self.processor.word(*v)).collect();
        self.parameters.push((group, name, 2, vec![values.len() as u8], bytes));
    }

    pub(crate) fn without(&mut self, name: &str) {
        self.parameters.retain(|p| p.1 != name);
    }

    /// The parameter section; groups are POINT, ANALOG, FORCE_PLATFORM, EVENT and TRIAL.
    fn section(&self) -> Vec<u8> {
        let mut section = vec![1, 0x50, 0, self.processor as u8];
        let mut record = |name: &str, id: i8, body: &[u8]| {
            section.extend([name.len() as u8, id as u8]);
            section.extend(name.bytes());
            section.extend(self.processor.word(body.len() as i32 + 2));
            section.extend(body);
        };
        for (index, name) in
            ["POINT", "ANALOG", "FORCE_PLATFORM", "EVENT", "TRIAL"].iter().enumerate()
        {
            record(name, -(index as i8 + 1), &[0]);
        }
        for (group, name, kind, sizes, values) in &self.parameters {
            let mut body = vec![*kind as u8, sizes.len() as u8];
            body.extend(sizes);
            body.extend(values);
            body.push(0);
            record(name, *group as i8, &body);
        }
        section.push(0);
        section.resize(section.len().next_multiple_of(512), 0);
        section[2] = (section.len() / 512) as u8;
        section
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        let section = self.section();
        let p = self.processor;
        let sign = if self.real { -1.0 } else { 1.0 };
        let mut file = vec![2, 0x50];
        file.extend(p.word(self.points));
        file.extend(p.word(self.analog));
        file.extend(p.word(self.frames[0]));
        file.extend(p.word(self.frames[1]));
        file.extend(p.word(10));
        file.extend(p.float(sign * self.scale));
        file.extend(p.word(2 + section.len() as i32 / 512));
        file.extend(p.word(self.samples));
        file.extend(p.float(50.0));
        file.resize(512, 0);
        file.extend(section);
        let width = (4 * self.points + self.analog).max(1) as usize;
        for frame in self.numbers.chunks(width) {
            for (index, number) in frame.iter().enumerate() {
                let coordinate = index < 4 * self.points as usize && index % 4 != 3;
                match self.real {
                    true if coordinate => file.extend(p.float(number * self.scale)),
                    true => file.extend(p.float(*number)),
                    false => file.extend(p.word(*number as i32)),
                }
            }
        }
        file.resize(file.len().next_multiple_of(512), 0);
        file
    }
}
