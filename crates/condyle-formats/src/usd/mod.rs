//! UsdSkel: skeletons with their motion, in the text form of Universal Scene Description. Written, not read.
//!
//! A model becomes a `Skeleton` under a `SkelRoot`, its segments the joints, named by their paths; the rest
//! transforms are those at the defaults, the bind transforms the same in the world. A motion becomes a
//! `SkelAnimation`: translations, rotations and scales of every joint in its parent at every frame. Numbers are those
//! of the format: single precision, scales in half.
//!
//! The unit is the metre, the axis that is up the model's. Limits are applied where asked; what remains is plain
//! bones. Shear has no place and is told.

use crate::skeleton::Place;
use condyle_diagnostics::{Diagnostic, Error, Read, listed};
use condyle_math::Affine;
use condyle_model::{Mode, Model, Pose, Program, SegmentId, UpAxis};
use condyle_motion::Motion;
use std::collections::{BTreeSet, HashSet};
use std::fmt::Write as _;

/// Less than single precision can tell.
const LEAST: f64 = 1e-6;

/// A model, and its motion where there is one, as `.usda`.
///
/// # Errors
/// `usd/empty` without segments; `usd/size` if a frame has not the model's number of values.
///
/// ```
/// use condyle_model::{Mode, ModelBuilder};
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", condyle_math::Vec3::Z);
/// let text = condyle_formats::usd::write(&b.build()?, &Default::default(), Mode::Open)?.value;
/// assert!(text.starts_with("#usda 1.0") && text.contains("def Skeleton"));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn write(model: &Model, motion: &Motion, mode: Mode) -> Result<Read<String>, Error> {
    if model.segments().is_empty() {
        return Err(Error::new("usd/empty", "the model has no segments"));
    }
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut file = File {
        model,
        order: model.parents_first(),
        sheared: BTreeSet::new(),
        scaled: false,
        worst: 0.0,
    };
    let paths = file.paths();
    evaluate(&program, &model.defaults(), mode, &mut pose)?;
    let (rest, bind) = file.rest(&pose);
    let root = identifier(model.name());
    let mut out = String::with_capacity(1 << 14);
    let up = match model.up() {
        UpAxis::Y => "Y",
        UpAxis::Z => "Z",
    };
    let rate = rate(motion);
    let _ = write!(
        out,
        "#usda 1.0\n(\n    defaultPrim = \"{root}\"\n    doc = \"written by condyle\"\n    metersPerUnit = 1\n    upAxis = \"{up}\"\n"
    );
    if let (Some(first), Some(last)) = (motion.times.first(), motion.times.last()) {
        let _ = write!(
            out,
            "    startTimeCode = {}\n    endTimeCode = {}\n    timeCodesPerSecond = {rate:?}\n    framesPerSecond = {rate:?}\n",
            code(*first, rate),
            code(*last, rate)
        );
    }
    let _ = write!(
        out,
        ")\n\ndef SkelRoot \"{root}\" (\n    kind = \"component\"\n    prepend apiSchemas = [\"SkelBindingAPI\"]\n)\n{{\n"
    );
    let _ = writeln!(out, "    rel skel:skeleton = </{root}/Skeleton>\n");
    let joints = paths.iter().map(|path| format!("\"{path}\"")).collect::<Vec<_>>().join(", ");
    let _ = write!(
        out,
        "    def Skeleton \"Skeleton\" (\n        prepend apiSchemas = [\"SkelBindingAPI\"]\n    )\n    {{\n        \
         uniform matrix4d[] bindTransforms = [{}]\n        uniform token[] joints = [{joints}]\n        \
         uniform matrix4d[] restTransforms = [{}]\n",
        matrices(&bind),
        matrices(&rest)
    );
    if motion.frames.is_empty() {
        out.push_str("    }\n}\n");
    } else {
        let _ = write!(
            out,
            "        rel skel:animationSource = </{root}/Skeleton/Animation>\n\n        \
             def SkelAnimation \"Animation\"\n        {{\n            uniform token[] joints = [{joints}]\n"
        );
        file.animation(&mut out, &program, &mut pose, motion, mode, rate)?;
        out.push_str("        }\n    }\n}\n");
    }
    Ok(Read { value: out, warnings: file.remarks() })
}

struct File<'m> {
    model: &'m Model,
    order: Vec<SegmentId>,
    sheared: BTreeSet<SegmentId>,
    scaled: bool,
    worst: f64,
}

impl File<'_> {
    /// The path of every joint: the names from the root on.
    fn paths(&self) -> Vec<String> {
        let mut by_segment = vec![String::new(); self.order.len()];
        let mut taken: HashSet<String> = HashSet::new();
        let mut paths = vec![];
        for &id in &self.order {
            let segment = self.model.segment(id);
            let above = segment.parent.map(|parent| by_segment[parent.index()].clone());
            let base = match above {
                Some(above) => format!("{above}/{}", identifier(&segment.name)),
                None => identifier(&segment.name),
            };
            let mut path = base.clone();
            let mut number = 2usize;
            while !taken.insert(path.clone()) {
                path = format!("{base}_{number}");
                number += 1;
            }
            by_segment[id.index()].clone_from(&path);
            paths.push(path);
        }
        paths
    }

    /// Rest transforms in the parent, and bind transforms in the world, without shear.
    fn rest(&mut self, pose: &Pose) -> (Vec<Affine>, Vec<Affine>) {
        let mut world = vec![Affine::IDENTITY; self.order.len()];
        let (mut rest, mut bind) = (vec![], vec![]);
        for id in self.order.clone() {
            let place = self.place(id, pose);
            let local = affine(&place);
            let parent =
                self.model.segment(id).parent.map_or(Affine::IDENTITY, |p| world[p.index()]);
            world[id.index()] = parent * local;
            rest.push(local);
            bind.push(world[id.index()]);
        }
        (rest, bind)
    }

    fn place(&mut self, id: SegmentId, pose: &Pose) -> Place {
        let (place, shear) = Place::nearest(pose.segment_in_parent(self.model, id));
        if shear > LEAST {
            self.sheared.insert(id);
            self.worst = self.worst.max(shear);
        }
        let s = place.scale;
        self.scaled |= [s.x, s.y, s.z].iter().any(|s| (s - 1.0).abs() > LEAST);
        place
    }

    fn animation(
        &mut self,
        out: &mut String,
        program: &Program,
        pose: &mut Pose,
        motion: &Motion,
        mode: Mode,
        rate: f64,
    ) -> Result<(), Error> {
        let (mut turns, mut places, mut sizes) = (String::new(), String::new(), String::new());
        let mut last = None;
        for (&time, frame) in motion.times.iter().zip(&motion.frames) {
            let time = code(time, rate);
            // One sample for each time.
            if last.as_ref() == Some(&time) {
                continue;
            }
            evaluate(program, frame, mode, pose)?;
            let all: Vec<Place> =
                self.order.clone().into_iter().map(|id| self.place(id, pose)).collect();
            let list = |text: &dyn Fn(&Place) -> String| {
                all.iter().map(text).collect::<Vec<_>>().join(", ")
            };
            let turn = list(&|p| {
                let q = p.rotation;
                tuple([q.w, q.x, q.y, q.z])
            });
            let place = list(&|p| tuple(p.translation.to_array()));
            let size = list(&|p| tuple(p.scale.to_array()));
            let _ = writeln!(turns, "                {time}: [{turn}],");
            let _ = writeln!(places, "                {time}: [{place}],");
            let _ = writeln!(sizes, "                {time}: [{size}],");
            last = Some(time);
        }
        let ones = vec!["(1, 1, 1)"; self.order.len()].join(", ");
        let _ =
            write!(out, "            quatf[] rotations.timeSamples = {{\n{turns}            }}\n");
        let _ = match self.scaled {
            true => {
                write!(out, "            half3[] scales.timeSamples = {{\n{sizes}            }}\n")
            }
            false => writeln!(out, "            half3[] scales = [{ones}]"),
        };
        let _ = write!(
            out,
            "            float3[] translations.timeSamples = {{\n{places}            }}\n"
        );
        Ok(())
    }

    fn remarks(&self) -> Vec<Diagnostic> {
        let mut remarks = vec![];
        if !self.sheared.is_empty() {
            let names = self.sheared.iter().map(|&id| self.model.segment(id).name.as_str());
            let message = format!(
                "shears are left out: {}; at worst points are off by {:.2} % of their distance from the joint",
                listed(names),
                100.0 * self.worst
            );
            remarks.push(Diagnostic::warning("usd/shear", message));
        }
        if self.scaled {
            let message = "scales are written in half precision, which is all that UsdSkel holds: three digits";
            remarks.push(Diagnostic::note("usd/scale", message));
        }
        if !self.model.markers().is_empty() {
            let message = format!("{} markers are left out", self.model.markers().len());
            remarks.push(Diagnostic::note("usd/dropped", message));
        }
        remarks
    }
}

fn evaluate(program: &Program, stored: &[f64], mode: Mode, pose: &mut Pose) -> Result<(), Error> {
    program.evaluate(stored, mode, pose).map_err(|error| Error::new("usd/size", error.to_string()))
}

fn affine(place: &Place) -> Affine {
    let turn = place.rotation.to_mat3();
    let s = place.scale;
    let linear = condyle_math::Mat3::from_columns(turn.x * s.x, turn.y * s.y, turn.z * s.z);
    Affine::new(linear, place.translation)
}

/// Frames a second: those of the motion, whole where they nearly are.
fn rate(motion: &Motion) -> f64 {
    let steps = motion.times.len().saturating_sub(1);
    let length = match (motion.times.first(), motion.times.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    };
    let rate = steps as f64 / length;
    match rate.is_finite() && rate > 0.0 {
        true if (rate - rate.round()).abs() < 1e-4 * rate => rate.round().max(1.0),
        true => rate,
        false => 24.0,
    }
}

/// A time as a time code, without the rounding of a product.
fn code(time: f64, rate: f64) -> String {
    let code = time * rate;
    let near = code.round();
    let code = if (code - near).abs() < 1e-6 { near } else { code };
    if code == 0.0 { "0".to_owned() } else { format!("{code}") }
}

fn tuple<const N: usize>(all: [f64; N]) -> String {
    let text = all.map(|x| {
        let x = x as f32;
        if x == 0.0 { "0".to_owned() } else { format!("{x}") }
    });
    format!("({})", text.join(", "))
}

/// Row vectors: the transpose of what stands here elsewhere.
fn matrices(all: &[Affine]) -> String {
    let text = |a: &Affine| {
        let row = |v: condyle_math::Vec3, w: u8| {
            let [x, y, z] =
                v.to_array().map(|x| if x == 0.0 { "0".to_owned() } else { format!("{x}") });
            format!("({x}, {y}, {z}, {w})")
        };
        let l = a.linear;
        format!("( {}, {}, {}, {} )", row(l.x, 0), row(l.y, 0), row(l.z, 0), row(a.translation, 1))
    };
    all.iter().map(text).collect::<Vec<_>>().join(", ")
}

/// A name that the format takes: letters, digits and underscores, no digit first.
fn identifier(name: &str) -> String {
    let mut out: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if out.is_empty() || out.starts_with(|c: char| c.is_ascii_digit()) {
        out.insert(0, '_');
    }
    out
}
