//! Archives of NumPy built by its specification, and the numbers of `oracles/smpl/evaluate.py` by its formulas.

use condyle_formats::smpl::Tree;
use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc};
use std::f64::consts::{FRAC_PI_2, PI};
use std::io::Write;

/// Corners of a body, frames, and numbers of a shape.
const CORNERS: usize = 120;
const FRAMES: usize = 3;
const SHAPES: usize = 10;

/// An array of doubles, or singles, in the format of NumPy.
#[derive(Clone)]
pub(crate) struct Npy {
    shape: Vec<usize>,
    /// In C order.
    values: Vec<f64>,
    fortran: bool,
    big_endian: bool,
    single: bool,
}

impl Npy {
    /// An array by a formula of its indices.
    pub(crate) fn new(shape: &[usize], value: impl Fn(&[usize]) -> f64) -> Self {
        let count: usize = shape.iter().product();
        let values = (0..count).map(|number| value(&indices(shape, number))).collect();
        let shape = shape.to_vec();
        Self { shape, values, fortran: false, big_endian: false, single: false }
    }

    pub(crate) fn fortran(mut self) -> Self {
        self.fortran = true;
        self
    }

    pub(crate) fn big_endian(mut self) -> Self {
        self.big_endian = true;
        self
    }

    pub(crate) fn single(mut self) -> Self {
        self.single = true;
        self
    }

    pub(crate) fn reshaped(mut self, shape: &[usize]) -> Self {
        self.shape = shape.to_vec();
        self
    }

    /// The file of it.
    fn bytes(&self) -> Vec<u8> {
        let order = if self.big_endian { '>' } else { '<' };
        let size = if self.single { 4 } else { 8 };
        let fortran = if self.fortran { "True" } else { "False" };
        let sides: String = self.shape.iter().map(|side| format!("{side}, ")).collect();
        let head = format!(
            "{{'descr': '{order}f{size}', 'fortran_order': {fortran}, 'shape': ({sides}), }}\n"
        );
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((head.len() as u16).to_le_bytes());
        bytes.extend(head.as_bytes());
        let places: Vec<usize> = match self.fortran {
            false => (0..self.values.len()).collect(),
            // Of the number of an element in Fortran order the one in C order.
            true => {
                let back: Vec<usize> = self.shape.iter().rev().copied().collect();
                let place = |number: usize| {
                    let at = indices(&back, number);
                    let pairs = self.shape.iter().zip(at.iter().rev());
                    pairs.fold(0, |place, (side, index)| place * side + index)
                };
                (0..self.values.len()).map(place).collect()
            }
        };
        for place in places {
            let value = self.values[place];
            let mut digits = match self.single {
                true => (value as f32).to_le_bytes().to_vec(),
                false => value.to_le_bytes().to_vec(),
            };
            if self.big_endian {
                digits.reverse();
            }
            bytes.extend(digits);
        }
        bytes
    }
}

/// The indices of an element by its number in C order.
fn indices(shape: &[usize], mut number: usize) -> Vec<usize> {
    let mut indices = vec![0; shape.len()];
    for (index, side) in indices.iter_mut().zip(shape).rev() {
        *index = number % side;
        number /= side;
    }
    indices
}

/// How entries are put into an archive.
#[derive(Clone, Copy, PartialEq)]
enum Packed {
    Stored,
    Deflated,
    /// With sizes and places of 64 bits.
    Stored64,
}

/// An archive of arrays.
#[derive(Clone, Default)]
pub(crate) struct Npz {
    arrays: Vec<(String, Npy)>,
}

impl Npz {
    pub(crate) fn with(self, name: &str, array: Npy) -> Self {
        let mut own = self.without(name);
        own.arrays.push((name.to_owned(), array));
        own
    }

    pub(crate) fn without(mut self, name: &str) -> Self {
        self.arrays.retain(|(known, _)| known != name);
        self
    }

    pub(crate) fn get(&self, name: &str) -> &Npy {
        &self.arrays.iter().find(|(known, _)| known == name).unwrap().1
    }

    pub(crate) fn stored(&self) -> Vec<u8> {
        self.bytes(Packed::Stored)
    }

    pub(crate) fn deflated(&self) -> Vec<u8> {
        self.bytes(Packed::Deflated)
    }

    pub(crate) fn zip64(&self) -> Vec<u8> {
        self.bytes(Packed::Stored64)
    }

    fn bytes(&self, packed: Packed) -> Vec<u8> {
        let (mut bytes, mut directory) = (vec![], vec![]);
        let wide = packed == Packed::Stored64;
        for (name, array) in &self.arrays {
            let name = format!("{name}.npy");
            let content = array.bytes();
            let mut crc = Crc::new();
            crc.update(&content);
            let data = match packed {
                Packed::Deflated => {
                    let mut encoder = DeflateEncoder::new(vec![], Compression::default());
                    encoder.write_all(&content).unwrap();
                    encoder.finish().unwrap()
                }
                _ => content.clone(),
            };
            let at = bytes.len();
            let method = if packed == Packed::Deflated { 8u16 } else { 0 };
            let sizes = match wide {
                true => [u32::MAX; 2],
                false => [data.len() as u32, content.len() as u32],
            };
            let mut extra = vec![];
            if wide {
                for number in [content.len(), data.len(), at] {
                    extra.extend((number as u64).to_le_bytes());
                }
                extra.splice(0..0, [1, 0, 24, 0]);
            }
            // Version, flags, method, time, date, checksum, sizes, lengths of name and extra field.
            let mut fields = vec![];
            for number in [20u16, 0, method, 0, 0] {
                fields.extend(number.to_le_bytes());
            }
            fields.extend(crc.sum().to_le_bytes());
            sizes.iter().for_each(|size| fields.extend(size.to_le_bytes()));
            fields.extend((name.len() as u16).to_le_bytes());
            fields.extend((extra.len() as u16).to_le_bytes());
            bytes.extend(b"PK\x03\x04");
            bytes.extend(&fields);
            bytes.extend(name.as_bytes());
            bytes.extend(&extra);
            bytes.extend(&data);
            directory.extend(b"PK\x01\x02");
            directory.extend(20u16.to_le_bytes());
            directory.extend(&fields);
            directory.extend([0; 10]);
            let place = if wide { u32::MAX } else { at as u32 };
            directory.extend(place.to_le_bytes());
            directory.extend(name.as_bytes());
            directory.extend(&extra);
        }
        let (start, size, count) = (bytes.len(), directory.len(), self.arrays.len());
        bytes.extend(directory);
        if wide {
            let end = bytes.len();
            bytes.extend(b"PK\x06\x06");
            bytes.extend(44u64.to_le_bytes());
            bytes.extend([45, 0, 45, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
            for number in [count, count, size, start] {
                bytes.extend((number as u64).to_le_bytes());
            }
            bytes.extend(b"PK\x06\x07\0\0\0\0");
            bytes.extend((end as u64).to_le_bytes());
            bytes.extend(1u32.to_le_bytes());
        }
        bytes.extend(b"PK\x05\x06\0\0\0\0");
        let short = |number: usize| if wide { u16::MAX } else { number as u16 };
        let long = |number: usize| if wide { u32::MAX } else { number as u32 };
        [count, count].iter().for_each(|n| bytes.extend(short(*n).to_le_bytes()));
        [size, start].iter().for_each(|n| bytes.extend(long(*n).to_le_bytes()));
        bytes.extend([0, 0]);
        bytes
    }
}

/// The synthetic body of a tree.
pub(crate) fn body(tree: Tree) -> Npz {
    let joints = tree.joints();
    let count = joints.len();
    let corners = Npy::new(&[CORNERS, 3], |at| {
        let i = at[0] as f64;
        [0.9 * (1.1 * i).sin(), 1.2 * (0.7 * i + 0.3).cos(), 0.5 * (2.3 * i + 1.0).sin()][at[1]]
    });
    let shapes = Npy::new(&[CORNERS, 3, SHAPES], |at| {
        0.02 * (at[0] as f64 + 2.0 * at[1] as f64 + 3.0 * at[2] as f64).sin()
    });
    let regressor = Npy::new(&[count, CORNERS], |at| {
        let joint = at[0];
        let all = [(7 * joint + 1, 0.5), (11 * joint + 5, 0.3), (13 * joint + 2, 0.2)];
        let own = all.iter().filter(|(corner, _)| corner % CORNERS == at[1]);
        own.map(|(_, weight)| weight).sum()
    });
    let parents = Npy::new(&[2, count], |at| match at[0] {
        0 => joints[at[1]].1.map_or(f64::from(u32::MAX), |parent| parent as f64),
        _ => at[1] as f64,
    });
    Npz::default()
        .with("v_template", corners)
        .with("shapedirs", shapes)
        .with("J_regressor", regressor)
        .with("kintree_table", parents)
}

/// The synthetic poses of a tree.
pub(crate) fn poses(tree: Tree) -> Npz {
    let lean = match tree {
        Tree::SmplH => FRAC_PI_2,
        Tree::SmplX => PI,
        _ => 0.0,
    };
    let poses = Npy::new(&[FRAMES, 3 * tree.len()], |at| {
        let t = at[0] as f64;
        match at[1] {
            0 => lean + 0.1 * t.sin(),
            1 => 0.05 * t.cos(),
            2 => 0.1 * (2.0 * t).sin(),
            k => 0.6 * (0.9 * t + 0.37 * k as f64).sin(),
        }
    });
    let places = Npy::new(&[FRAMES, 3], |at| {
        let t = at[0] as f64;
        [0.1 * t, -0.2 * t, 0.9 + 0.01 * t][at[1]]
    });
    let betas = Npy::new(&[SHAPES], |at| 0.5 * (at[0] as f64).cos());
    Npz::default().with("poses", poses).with("trans", places).with("betas", betas)
}
