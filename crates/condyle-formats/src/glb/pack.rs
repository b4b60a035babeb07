//! Packs numbers into the binary chunk, with the accessors that refer to them.

use gltf_json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf_json::buffer::{Target, View};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Index, Root};

/// The binary chunk under construction; every view starts at a multiple of 4 bytes.
#[derive(Debug, Default)]
pub(super) struct Pack {
    pub(super) bytes: Vec<u8>,
}

impl Pack {
    /// Vectors of `N` numbers, with their bounds where `bounded`.
    pub(super) fn floats<const N: usize>(
        &mut self,
        root: &mut Root,
        data: &[[f32; N]],
        target: Option<Target>,
        bounded: bool,
    ) -> Index<Accessor> {
        let start = self.bytes.len();
        let (mut low, mut high) = ([f32::INFINITY; N], [f32::NEG_INFINITY; N]);
        for vector in data {
            for (axis, x) in vector.iter().enumerate() {
                low[axis] = low[axis].min(*x);
                high[axis] = high[axis].max(*x);
                self.bytes.extend(x.to_le_bytes());
            }
        }
        let kind = match N {
            1 => Type::Scalar,
            3 => Type::Vec3,
            16 => Type::Mat4,
            _ => Type::Vec4,
        };
        let bound = |b: [f32; N]| bounded.then(|| gltf_json::Value::from(b.to_vec()));
        let (low, high) = (bound(low), bound(high));
        self.accessor(root, start, data.len(), (ComponentType::F32, kind), target, (low, high))
    }

    /// Four joints for each corner.
    pub(super) fn joints(&mut self, root: &mut Root, data: &[[u16; 4]]) -> Index<Accessor> {
        let start = self.bytes.len();
        for joint in data.iter().flatten() {
            self.bytes.extend(joint.to_le_bytes());
        }
        let kind = (ComponentType::U16, Type::Vec4);
        let target = Some(Target::ArrayBuffer);
        self.accessor(root, start, data.len(), kind, target, (None, None))
    }

    /// Indices of corners, in 16 bits where they fit.
    pub(super) fn indices(&mut self, root: &mut Root, data: &[u32]) -> Index<Accessor> {
        let start = self.bytes.len();
        // 65535 itself is reserved for restarting a strip.
        let short = data.iter().all(|i| *i < u32::from(u16::MAX));
        for index in data {
            if short {
                self.bytes.extend((*index as u16).to_le_bytes());
            } else {
                self.bytes.extend(index.to_le_bytes());
            }
        }
        let component = if short { ComponentType::U16 } else { ComponentType::U32 };
        let target = Some(Target::ElementArrayBuffer);
        let kind = (component, Type::Scalar);
        self.accessor(root, start, data.len(), kind, target, (None, None))
    }

    fn accessor(
        &mut self,
        root: &mut Root,
        start: usize,
        count: usize,
        (component, kind): (ComponentType, Type),
        target: Option<Target>,
        (min, max): (Option<gltf_json::Value>, Option<gltf_json::Value>),
    ) -> Index<Accessor> {
        let length = self.bytes.len() - start;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = root.push(View {
            buffer: Index::new(0),
            byte_length: USize64::from(length),
            byte_offset: Some(USize64::from(start)),
            byte_stride: None,
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: Default::default(),
        });
        root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(count),
            component_type: Checked::Valid(GenericComponentType(component)),
            type_: Checked::Valid(kind),
            min,
            max,
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: Default::default(),
        })
    }

    /// The whole file: header, JSON chunk, binary chunk, each padded to 4 bytes. None if it
    /// would be larger than the format's 4 GiB.
    pub(super) fn file(self, mut json: Vec<u8>) -> Option<Vec<u8>> {
        json.resize(json.len().next_multiple_of(4), b' ');
        // A chunk without bytes is omitted.
        let binary = if self.bytes.is_empty() { 0 } else { 8 + self.bytes.len() };
        let total = 12 + 8 + json.len() + binary;
        let size = |n: usize| u32::try_from(n).ok().map(u32::to_le_bytes);
        let mut file = Vec::with_capacity(total);
        file.extend(b"glTF");
        file.extend(2u32.to_le_bytes());
        file.extend(size(total)?);
        file.extend(size(json.len())?);
        file.extend(b"JSON");
        file.extend(json);
        if binary > 0 {
            file.extend(size(self.bytes.len())?);
            file.extend(b"BIN\0");
            file.extend(self.bytes);
        }
        Some(file)
    }
}
