//! Bones of a file, and the model that is made of them.

use crate::text::distinct;
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_math::{Affine, Vec3};
use condyle_mesh::{Finish, Form};
use condyle_model::component::{Along, Law, Scale};
use condyle_model::model::Facing;
use condyle_model::{CoordinateKind, Model, ModelBuilder, Range, SegmentId, Shape, Signal, UpAxis};

/// What one number of a bone, or one orientation, does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FreedomKind {
    /// Turns about an axis, in radians.
    Turn(Vec3),
    /// Moves along an axis, in metres.
    Move(Vec3),
    /// Sizes along an axis: 1 changes nothing.
    Size(Vec3),
    /// Turns freely: four numbers x, y, z, w.
    Ball,
}

/// One way in which a bone moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Freedom {
    /// The name of the coordinate; unique in its bone.
    pub name: String,
    /// What it does.
    pub kind: FreedomKind,
    /// Its value at rest: one number, or x, y, z, w.
    pub default: [f64; 4],
    /// Its range, of one that is one number.
    pub range: Range,
}

impl Freedom {
    /// One without limits that changes nothing at rest, with the usual name: `rx`, `tx`, `sx`, or
    /// `orientation`. Axes that are no unit axis have the number of none: give them a name of their own.
    #[must_use]
    pub fn new(kind: FreedomKind) -> Self {
        let (letter, axis) = match kind {
            FreedomKind::Turn(axis) => ("r", axis),
            FreedomKind::Move(axis) => ("t", axis),
            FreedomKind::Size(axis) => ("s", axis),
            FreedomKind::Ball => ("orientation", Vec3::ZERO),
        };
        let which = Vec3::UNITS.iter().position(|unit| *unit == axis);
        let name = format!("{letter}{}", which.map_or("", |index| ["x", "y", "z"][index]));
        let default = match kind {
            FreedomKind::Ball => [0.0, 0.0, 0.0, 1.0],
            FreedomKind::Size(_) => [1.0, 0.0, 0.0, 0.0],
            _ => [0.0; 4],
        };
        Self { name, kind, default, range: Range::FREE }
    }

    /// How many numbers it stores in a frame.
    #[must_use]
    pub fn stored(&self) -> usize {
        if self.kind == FreedomKind::Ball { 4 } else { 1 }
    }
}

/// One bone.
#[derive(Clone, Debug, PartialEq)]
pub struct Bone {
    /// Its name in the file.
    pub name: String,
    /// The bone that it hangs on, which stands before it; `None` for the world.
    pub parent: Option<usize>,
    /// Its joint in its parent, in metres.
    pub joint_in_parent: Affine,
    /// Its joint in itself: the identity where the bone's own frame is that of its joint.
    pub joint_in_segment: Affine,
    /// How it moves, from the parent to the bone; none for one that is fixed.
    pub freedoms: Vec<Freedom>,
    /// Its tips: name and place in the bone, in metres.
    pub ends: Vec<(String, Vec3)>,
}

impl Bone {
    /// A bone that does not move yet, its joint and its own origin at a point of its parent (metres).
    #[must_use]
    pub fn at(name: &str, parent: Option<usize>, point_in_parent: Vec3) -> Self {
        Self {
            name: name.to_owned(),
            parent,
            joint_in_parent: Affine::from_translation(point_in_parent),
            joint_in_segment: Affine::IDENTITY,
            freedoms: vec![],
            ends: vec![],
        }
    }
}

/// The bones of a file.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Skeleton {
    /// The name of the model.
    pub name: String,
    /// The axis that points up.
    pub up: UpAxis,
    /// Where the figure looks at rest.
    pub facing: Facing,
    /// Its bones, each after its parent.
    pub bones: Vec<Bone>,
    /// What bones look like: a bone's position in the list, and a surface in its own frame.
    pub shapes: Vec<(usize, Form)>,
}

impl Skeleton {
    /// The joints and tips at rest in the world, with all freedoms at zero: for each bone its name, the place
    /// of its joint, and those of its tips.
    #[must_use]
    pub fn rest(&self) -> Vec<(&str, Vec3, Vec<Vec3>)> {
        let mut frames: Vec<Affine> = Vec::with_capacity(self.bones.len());
        let mut rest = Vec::with_capacity(self.bones.len());
        for bone in &self.bones {
            let parent = bone.parent.and_then(|p| frames.get(p)).copied();
            let joint = parent.unwrap_or(Affine::IDENTITY) * bone.joint_in_parent;
            let own = joint * bone.joint_in_segment.rigid_inverse();
            let ends = bone.ends.iter().map(|(_, point)| own * *point).collect();
            rest.push((bone.name.as_str(), joint.translation, ends));
            frames.push(own);
        }
        rest
    }

    /// The model of these bones; the [contract](super) says what becomes of each.
    ///
    /// # Errors
    /// `skeleton/order` where a parent does not stand before its child; what [`ModelBuilder::build`] finds.
    ///
    /// ```
    /// use condyle_formats::skeleton::{Bone, Freedom, FreedomKind, Skeleton};
    /// use condyle_math::Vec3;
    /// let mut thigh = Bone::at("thigh", None, Vec3::new(0.0, 0.9, 0.0));
    /// thigh.freedoms = Vec3::UNITS.map(|axis| Freedom::new(FreedomKind::Turn(axis))).to_vec();
    /// let mut shank = Bone::at("shank", Some(0), Vec3::new(0.0, -0.4, 0.0));
    /// shank.freedoms.push(Freedom::new(FreedomKind::Ball));
    /// let skeleton = Skeleton { bones: vec![thigh, shank], ..Skeleton::default() };
    /// let model = skeleton.build()?.value;
    /// let keys: Vec<String> = model.coordinate_ids().map(|id| model.coordinate_key(id)).collect();
    /// assert_eq!(keys, ["rx", "ry", "rz", "orientation"]);
    /// assert_eq!(model.stored_len(), 7);
    /// # Ok::<(), condyle_formats::Error>(())
    /// ```
    pub fn build(&self) -> Result<Read<Model>, Error> {
        let mut warnings = Warnings::default();
        let names = distinct(self.bones.iter().map(|bone| bone.name.as_str()), |_, renamed| {
            warnings.add("skeleton/name", || {
                let message = format!("two bones have one name: the second is called `{renamed}`");
                Diagnostic::warning("skeleton/name", message)
            });
        });
        let mut b = ModelBuilder::new(&self.name);
        b.up(self.up);
        b.facing(self.facing);
        let mut ids: Vec<SegmentId> = Vec::with_capacity(self.bones.len());
        for (bone, name) in self.bones.iter().zip(&names) {
            let parent = match bone.parent {
                Some(parent) => match ids.get(parent) {
                    Some(id) => Some(*id),
                    None => {
                        let message = format!("bone `{name}` stands before its parent");
                        return Err(Error::new("skeleton/order", message));
                    }
                },
                None => None,
            };
            let id = b.segment(name, parent);
            ids.push(id);
            b.place_joint_frames(id, bone.joint_in_parent, bone.joint_in_segment);
            move_by(&mut b, id, name, &bone.freedoms);
        }
        let ends = self.bones.iter().flat_map(|bone| bone.ends.iter().map(|end| end.0.as_str()));
        let markers = distinct(names.iter().map(String::as_str).chain(ends), |_, _| {});
        let (joints, ends) = markers.split_at(names.len().min(markers.len()));
        for ((bone, &id), name) in self.bones.iter().zip(&ids).zip(joints) {
            b.marker(name, Some(id), bone.joint_in_segment.translation);
        }
        let places = self.bones.iter().zip(&ids);
        let places = places.flat_map(|(bone, &id)| bone.ends.iter().map(move |end| (id, end.1)));
        for ((id, point), name) in places.zip(ends) {
            b.marker(name, Some(id), point);
        }
        for (number, (bone, form)) in self.shapes.iter().enumerate() {
            let (Some(&segment), Some(name)) = (ids.get(*bone), names.get(*bone)) else { continue };
            let (name, form) = (format!("{name}_shape{}", number + 1), form.clone());
            b.shape(Shape { name, segment, form, finish: Finish::Bone, until: None });
        }
        let read = b.build_with_warnings()?;
        warnings.extend(read.warnings);
        Ok(Read { value: read.value, warnings: warnings.finish() })
    }
}

/// The joint set of one bone.
fn move_by(b: &mut ModelBuilder, id: SegmentId, name: &str, freedoms: &[Freedom]) {
    if freedoms.is_empty() {
        return;
    }
    let set = b.joint_set(name);
    let mut factors: Vec<Signal> = vec![];
    let mut used: Vec<String> = vec![];
    for freedom in freedoms {
        // A second turn about one axis.
        let mut own = freedom.name.clone();
        let mut number = 2;
        while used.contains(&own) {
            own = format!("{}{number}", freedom.name);
            number += 1;
        }
        used.push(own.clone());
        let kind = match freedom.kind {
            FreedomKind::Turn(_) => CoordinateKind::Rotation,
            FreedomKind::Move(_) => CoordinateKind::Translation,
            FreedomKind::Size(_) => CoordinateKind::Scale,
            FreedomKind::Ball => CoordinateKind::Orientation,
        };
        let coordinate = b.coordinate(set, &own, kind);
        let known = b.coordinate_mut(coordinate);
        known.default = freedom.default;
        known.range = freedom.range;
        factors.push(match freedom.kind {
            FreedomKind::Turn(axis) => b.rotate(set, &own, coordinate, axis),
            FreedomKind::Move(axis) => b.translate(set, &own, coordinate, axis),
            FreedomKind::Ball => b.ball(set, &own, coordinate),
            FreedomKind::Size(axis) => {
                let law = Law::Scale(Scale { along: Along::Axis(axis) });
                b.component(set, &own, law, vec![coordinate.into()])
            }
        });
    }
    let motion = match factors[..] {
        [only] => only,
        _ => b.product(set, "motion", factors),
    };
    b.output(set, id, motion);
}
