//! Joints as joint sets: each OpenSim joint type is built from the same components as other models.
//!
//! | joint | coordinates | motion |
//! | --- | --- | --- |
//! | Weld | - | nothing |
//! | Pin | rz | Rz |
//! | Slider | tx | Tx |
//! | Universal | rx, ry | Rx·Ry |
//! | Ball, Gimbal | rx, ry, rz | Rx·Ry·Rz, body-fixed |
//! | Planar | rz, tx, ty | Tx·Ty·Rz |
//! | Free | rx, ry, rz, tx, ty, tz | Tx·Ty·Tz·Rx·Ry·Rz |
//! | Custom | any | T(a₄f₄ + a₅f₅ + a₆f₆)·R(a₁, f₁)·R(a₂, f₂)·R(a₃, f₃) |
//! | Ellipsoid | rx, ry, rz | gliding on an ellipsoid |
//! | Scapulothoracic | abduction, elevation, upward rotation, winging | Rz(90°)·ellipsoid·Rz(-90°)·hinge |
//! | ConstantCurvature | rx, rz, ry | the end of an arc |

use super::function::{self, AnyFunction};
use super::joint_graph::PlacedJoint;
use super::{Reader, triple};
use crate::xml::Element;
use condyle_diagnostics::Error;
use condyle_math::function::{Curve, Function, FunctionOfSeveral};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::component::ConstantCurvature;
use condyle_model::{CoordinateId, CoordinateKind, JointSetId, Range, Signal};
use std::f64::consts::FRAC_PI_2;

/// One elementary motion that can be inverted.
enum Factor {
    Turn(Signal, Vec3),
    Slide(Signal, Vec3),
    Fixed(Affine),
    Law(Signal),
}

/// Adds the joint set of one joint to the model.
pub(super) fn build(reader: &mut Reader<'_, '_>, joint: &PlacedJoint<'_>) -> Result<(), Error> {
    let set = reader.builder.joint_set(&joint.name);
    let element = joint.element;
    let coordinates = Coordinates::read(reader, set, joint)?;
    let factors = factors(reader, set, joint, &coordinates)?;
    if factors.is_empty() {
        return Ok(());
    }
    let factors = if joint.backwards { backwards(element, factors)? } else { factors };
    let mut sources = vec![];
    for (index, factor) in factors.into_iter().enumerate() {
        let name = format!("motion_{}", index + 1);
        sources.push(match factor {
            Factor::Turn(angle, axis) => reader.builder.rotate(set, &name, angle, axis),
            Factor::Slide(distance, axis) => reader.builder.translate(set, &name, distance, axis),
            Factor::Fixed(transform) => reader.builder.place(set, &name, transform),
            Factor::Law(source) => source,
        });
    }
    let whole = reader.builder.product(set, "motion", sources);
    reader.builder.output(set, joint.moved, whole);
    Ok(())
}

/// The inverse motion, for a joint that the file defines from child to parent.
fn backwards(element: Element<'_>, factors: Vec<Factor>) -> Result<Vec<Factor>, Error> {
    factors
        .into_iter()
        .rev()
        .map(|factor| match factor {
            Factor::Turn(angle, axis) => Ok(Factor::Turn(angle, -axis)),
            Factor::Slide(distance, axis) => Ok(Factor::Slide(distance, -axis)),
            Factor::Fixed(transform) => Ok(Factor::Fixed(transform.rigid_inverse())),
            Factor::Law(_) => Err(element
                .error(
                    "osim/backwards",
                    format!("{} is stated from child to parent", element.describe()),
                )
                .with_help("exchange its parent and child frames")),
        })
        .collect()
}

/// The coordinates of one joint, added to the model when first used.
struct Coordinates<'d> {
    elements: Vec<Element<'d>>,
    ids: Vec<(String, CoordinateId)>,
}

/// The coordinates of the joints that have a fixed number of them.
fn standard(joint: &str) -> &'static [CoordinateKind] {
    use CoordinateKind::{Rotation as R, Translation as T};
    match joint {
        "PinJoint" => &[R],
        "SliderJoint" => &[T],
        "UniversalJoint" => &[R, R],
        "BallJoint" | "GimbalJoint" | "EllipsoidJoint" | "ConstantCurvatureJoint" => &[R, R, R],
        "PlanarJoint" => &[R, T, T],
        "FreeJoint" => &[R, R, R, T, T, T],
        "ScapulothoracicJoint" => &[R, R, R, R],
        _ => &[],
    }
}

impl<'d> Coordinates<'d> {
    fn read(
        reader: &mut Reader<'_, '_>,
        set: JointSetId,
        placed: &PlacedJoint<'d>,
    ) -> Result<Self, Error> {
        let joint = placed.element;
        let list = joint.child("coordinates").or_else(|| {
            let set = joint.child("CoordinateSet")?;
            Some(set.child("objects").unwrap_or(set))
        });
        let elements: Vec<Element<'d>> =
            list.into_iter().flat_map(|l| l.children_named("Coordinate")).collect();
        let standard = standard(placed.kind);
        let count = if placed.kind == "CustomJoint" { elements.len() } else { standard.len() };
        let mut coordinates = Self { elements, ids: vec![] };
        for index in 0..count {
            let element = coordinates.elements.get(index).copied();
            let name = match element.and_then(|e| e.attribute("name")).filter(|n| !n.is_empty()) {
                Some(name) => name.to_owned(),
                None => format!("{}_coord_{index}", placed.name),
            };
            if coordinates.ids.iter().any(|(known, _)| *known == name) {
                return Err(element
                    .unwrap_or(joint)
                    .error(
                        "osim/duplicate-coordinate",
                        format!("{} has two coordinates `{name}`", joint.describe()),
                    )
                    .with_help("give each coordinate of a joint a name of its own"));
            }
            let kind = standard.get(index).copied().unwrap_or(CoordinateKind::Other);
            let id = reader.builder.coordinate(set, &name, kind);
            if let Some(element) = element {
                reader.uses(element);
                read_properties(reader, element, id)?;
            }
            coordinates.ids.push((name, id));
        }
        Ok(coordinates)
    }

    fn source(&self, index: usize) -> Signal {
        Signal::Coordinate(self.ids[index].1)
    }

    fn named(
        &self,
        joint: Element<'_>,
        at: Element<'_>,
        name: &str,
    ) -> Result<CoordinateId, Error> {
        self.ids.iter().find(|(known, _)| known == name).map(|(_, id)| *id).ok_or_else(|| {
            let known: Vec<&str> = self.ids.iter().map(|(name, _)| name.as_str()).collect();
            at.error(
                "osim/unknown-coordinate",
                format!("{} has no coordinate `{name}`", joint.describe()),
            )
            .with_help(format!("its coordinates are: {}", known.join(", ")))
        })
    }
}

fn read_properties(
    reader: &mut Reader<'_, '_>,
    element: Element<'_>,
    id: CoordinateId,
) -> Result<(), Error> {
    let prescribed = element.child_bool("prescribed")?.unwrap_or(false);
    let always = if prescribed { prescribed_value(element) } else { None };
    let stated = element.child_f64("default_value")?;
    // Its name in the first versions.
    let stated = stated.map_or_else(|| element.child_f64("initial_value"), |v| Ok(Some(v)))?;
    let default = always.or(stated).unwrap_or(0.0);
    if !default.is_finite() {
        return Err(element
            .error(
                "osim/not-finite",
                format!("the default of {} is not finite", element.describe()),
            )
            .with_help("give a number"));
    }
    let range = element.child_numbers::<2>("range")?;
    let clamped = element.child_bool("clamped")?.unwrap_or(false);
    let locked = element.child_bool("locked")?.unwrap_or(false);
    if let Some([lower, upper]) = range
        && (lower.is_nan() || upper.is_nan())
    {
        return Err(element
            .error(
                "osim/not-finite",
                format!("the range of {} is not a number", element.describe()),
            )
            .with_help("give the lowest and the highest value"));
    }
    if prescribed && always.is_none() {
        reader.warn(
            "osim/prescribed",
            element,
            format!("{} is prescribed as a function of time", element.describe()),
            "it is kept at its default value",
        );
    }
    let coordinate = reader.builder.coordinate_mut(id);
    coordinate.default[0] = default;
    coordinate.locked = locked || prescribed;
    if let Some([lower, upper]) = range {
        let side = |v: f64| v.is_finite().then_some(v);
        coordinate.range = Range { lower: side(lower), upper: side(upper), enforced: clamped };
    }
    Ok(())
}

/// The value that a coordinate is prescribed at all times; `None` if it varies.
fn prescribed_value(element: Element<'_>) -> Option<f64> {
    let holder = element.child("prescribed_function")?;
    match function::inside(holder) {
        Ok(Some(AnyFunction::One(Function { factor, curve: Curve::Constant(value) }))) => {
            Some(factor * value)
        }
        _ => None,
    }
}

fn factors(
    reader: &mut Reader<'_, '_>,
    set: JointSetId,
    joint: &PlacedJoint<'_>,
    coordinates: &Coordinates<'_>,
) -> Result<Vec<Factor>, Error> {
    let element = joint.element;
    let q = |i: usize| coordinates.source(i);
    let turn = |i: usize, axis: Vec3| Factor::Turn(q(i), axis);
    let slide = |i: usize, axis: Vec3| Factor::Slide(q(i), axis);
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    Ok(match joint.kind {
        "WeldJoint" => vec![],
        "PinJoint" => vec![turn(0, z)],
        "SliderJoint" => vec![slide(0, x)],
        "UniversalJoint" => vec![turn(0, x), turn(1, y)],
        "BallJoint" | "GimbalJoint" => vec![turn(0, x), turn(1, y), turn(2, z)],
        "PlanarJoint" => vec![slide(1, x), slide(2, y), turn(0, z)],
        "FreeJoint" => {
            vec![slide(3, x), slide(4, y), slide(5, z), turn(0, x), turn(1, y), turn(2, z)]
        }
        "CustomJoint" => custom(reader, set, element, coordinates)?,
        "EllipsoidJoint" => {
            let radii = triple(element, "radii_x_y_z")?;
            vec![Factor::Law(reader.builder.ellipsoid(set, "surface", [q(0), q(1), q(2)], radii))]
        }
        "ScapulothoracicJoint" => {
            let radii = triple(element, "thoracic_ellipsoid_radii_x_y_z")?;
            let origin =
                element.child_numbers::<2>("scapula_winging_axis_origin")?.unwrap_or_default();
            let direction = element.child_f64("scapula_winging_axis_direction")?.unwrap_or(0.0);
            // The surface's third axis points out of the ribs; its first two are exchanged.
            let radii = Vec3::new(radii.y, radii.x, radii.z);
            let quarter = |sign: f64| {
                Factor::Fixed(Affine::from_rotation(Mat3::rotation_z(sign * FRAC_PI_2)))
            };
            let hinge = Affine::from_translation(Vec3::new(origin[0], origin[1], 0.0));
            let axis = Vec3::new(-direction.sin(), direction.cos(), 0.0);
            let surface = reader.builder.ellipsoid(set, "surface", [q(0), q(1), q(2)], radii);
            vec![
                quarter(1.0),
                Factor::Law(surface),
                quarter(-1.0),
                Factor::Fixed(hinge),
                turn(3, axis),
                Factor::Fixed(hinge.rigid_inverse()),
            ]
        }
        "ConstantCurvatureJoint" => {
            let neutral = triple(element, "neutral_angle_x_z_y")?.to_array();
            let length = element.child_f64("length")?.unwrap_or(1.0);
            let column = ConstantCurvature { neutral, length };
            let angles = [q(0), q(1), q(2)];
            vec![Factor::Law(reader.builder.constant_curvature(set, "column", angles, column))]
        }
        other => {
            return Err(element
                .error("osim/unknown-joint", format!("the joint type `{other}` is not known"))
                .with_help("use one of OpenSim's own joint types, for example a CustomJoint"));
        }
    })
}

/// A custom joint: translations along three axes, then rotations about three body-fixed axes.
fn custom(
    reader: &mut Reader<'_, '_>,
    set: JointSetId,
    element: Element<'_>,
    coordinates: &Coordinates<'_>,
) -> Result<Vec<Factor>, Error> {
    let mut turns = vec![];
    let mut slides = vec![];
    let mut kinds: Vec<CoordinateKind> = vec![CoordinateKind::Other; coordinates.ids.len()];
    let scale = scale_factors(reader, element)?;
    for (place, axis_element) in axes(element) {
        reader.uses(axis_element);
        let rotation = axis_element.child_bool("is_rotation")?.unwrap_or(place < 3);
        let default = [Vec3::X, Vec3::Y, Vec3::Z][place % 3];
        let axis = match axis_element.child("axis") {
            Some(_) => triple(axis_element, "axis")?,
            None => default,
        };
        let drivers =
            axis_element.child("coordinates").or_else(|| axis_element.child("coordinate"));
        let mut inputs = vec![];
        let names = drivers.map_or("", |d| d.text());
        let separates = |c: char| c.is_whitespace() || matches!(c, ',' | ';');
        for name in names.split(separates).filter(|name| !name.is_empty()) {
            let at = drivers.unwrap_or(axis_element);
            inputs.push(coordinates.named(element, at, name)?);
        }
        let function = function::inside(axis_element)?;
        // OpenSim reads an empty <function/> as the coordinate itself, and a missing one as 0.
        let absent =
            axis_element.child("function").is_none() && element.child("SpatialTransform").is_some();
        if function.is_none() && absent && !inputs.is_empty() {
            reader.warn(
                "osim/no-function",
                axis_element,
                format!("{} has coordinates but no function of them", axis_element.describe()),
                "it does not move; add a function such as <LinearFunction>",
            );
            continue;
        }
        let plain = match &function {
            None => true,
            Some(AnyFunction::One(Function { curve: Curve::Linear { slope, .. }, .. })) => {
                slope.abs() == 1.0 && !function::is_multiplied(axis_element)
            }
            Some(_) => false,
        };
        if plain {
            note_kind(&mut kinds, coordinates, &inputs, rotation);
        }
        let name = axis_element.attribute("name").filter(|n| !n.is_empty());
        let name = name.map_or_else(|| format!("axis_{}", place + 1), str::to_owned);
        // A coordinate that slides by itself is in metres already.
        let (factor, axis) =
            if rotation || is_coordinate(&function) { (1.0, axis) } else { stretched(axis, scale) };
        let Some(amount) = amount(reader, set, axis_element, &name, &inputs, function, factor)?
        else {
            continue;
        };
        if rotation {
            turns.push(Factor::Turn(amount, axis));
        } else {
            slides.push(Factor::Slide(amount, axis));
        }
    }
    for ((_, id), kind) in coordinates.ids.iter().zip(kinds) {
        reader.builder.coordinate_mut(*id).kind = kind;
    }
    slides.extend(turns);
    Ok(slides)
}

/// The factors by which joints before version 2 stretch the translations that are functions.
fn scale_factors(reader: &mut Reader<'_, '_>, element: Element<'_>) -> Result<Vec3, Error> {
    let ones = Vec3::new(1.0, 1.0, 1.0);
    if element.child_text("scale_factors").is_none() {
        return Ok(ones);
    }
    let factors = triple(element, "scale_factors")?;
    if factors != ones && reader.version.is_some_and(|version| version >= 20000) {
        let message = format!("<scale_factors> of {} is not used", element.describe());
        let help = "since version 2 the functions of a joint are scaled by a MultiplierFunction";
        reader.warn("osim/unused-property", element, message, help);
        return Ok(ones);
    }
    Ok(factors)
}

/// How far a step along `axis` reaches in stretched space, and in which direction.
fn stretched(axis: Vec3, scale: Vec3) -> (f64, Vec3) {
    let reach = Vec3::new(axis.x * scale.x, axis.y * scale.y, axis.z * scale.z);
    let factor = reach.norm() / axis.norm();
    if scale == Vec3::new(1.0, 1.0, 1.0) || !factor.is_finite() {
        return (1.0, axis);
    }
    if factor == 0.0 { (0.0, axis) } else { (factor, reach) }
}

/// Whether an axis is moved by its coordinate unchanged.
fn is_coordinate(function: &Option<AnyFunction>) -> bool {
    let Some(AnyFunction::One(Function { factor, curve })) = function else {
        return function.is_none();
    };
    *factor == 1.0
        && matches!(curve, Curve::Linear { slope, intercept } if (*slope, *intercept) == (1.0, 0.0))
}

/// The axes of a custom joint with their positions, rotations from 0 and translations from 3: by
/// name where the names are OpenSim's own, else in file order.
pub(in crate::opensim) fn axes(joint: Element<'_>) -> Vec<(usize, Element<'_>)> {
    const NAMES: [&str; 6] =
        ["rotation1", "rotation2", "rotation3", "translation1", "translation2", "translation3"];
    let holder = joint.child("SpatialTransform").or_else(|| {
        let set = joint.child("TransformAxisSet")?;
        Some(set.child("objects").unwrap_or(set))
    });
    let found = holder.into_iter().flat_map(|h| h.children_named("TransformAxis"));
    let place = |axis: Element<'_>| NAMES.iter().position(|n| Some(*n) == axis.attribute("name"));
    let mut axes: Vec<_> =
        found.enumerate().map(|(i, axis)| (place(axis).unwrap_or(i), axis)).collect();
    axes.sort_by_key(|(place, _)| *place);
    axes
}

/// OpenSim calls a coordinate rotational (translational) if some axis takes it unchanged, up to
/// sign, as its angle (distance), the last such axis deciding; all others are coupled, also those in
/// a multiplier of 1, and files never hold them in degrees.
fn note_kind(
    kinds: &mut [CoordinateKind],
    coordinates: &Coordinates<'_>,
    inputs: &[CoordinateId],
    rotation: bool,
) {
    let [id] = inputs else { return };
    if let Some(index) = coordinates.ids.iter().position(|(_, known)| known == id) {
        kinds[index] =
            if rotation { CoordinateKind::Rotation } else { CoordinateKind::Translation };
    }
}

/// What drives an axis: nothing, a coordinate unchanged, or a function of one or several.
fn amount(
    reader: &mut Reader<'_, '_>,
    set: JointSetId,
    element: Element<'_>,
    name: &str,
    inputs: &[CoordinateId],
    function: Option<AnyFunction>,
    factor: f64,
) -> Result<Option<Signal>, Error> {
    let function = function.map(|function| match function {
        AnyFunction::One(f) => AnyFunction::One(Function { factor: f.factor * factor, ..f }),
        several @ AnyFunction::Several(_) => several,
    });
    let sources: Vec<Signal> = inputs.iter().map(|&id| Signal::Coordinate(id)).collect();
    let mismatch = |expected: usize| {
        element
            .error(
                "osim/arity",
                format!(
                    "{} has {} coordinates but its function takes {expected}",
                    element.describe(),
                    inputs.len()
                ),
            )
            .with_help("list as many coordinates as the function has arguments")
    };
    match (&sources[..], function) {
        ([], None) => Ok(None),
        ([one], None) => Ok(Some(*one)),
        (_, None) => Err(mismatch(1)),
        ([one], Some(AnyFunction::One(function))) => {
            Ok(Some(reader.builder.map(set, name, *one, function)))
        }
        ([], Some(AnyFunction::One(function))) => {
            // A constant needs no argument, and any other function is evaluated at 0.
            let value = function.value_and_slope(0.0).0;
            if value == 0.0 {
                return Ok(None);
            }
            let constant = FunctionOfSeveral::Linear { slopes: vec![], intercept: value };
            Ok(Some(reader.builder.combine(set, name, vec![], constant)))
        }
        (_, Some(AnyFunction::One(_))) => Err(mismatch(1)),
        (list, Some(AnyFunction::Several(function))) => {
            if list.len() != function.arity() {
                return Err(mismatch(function.arity()));
            }
            let value = reader.builder.combine(set, name, list.to_vec(), function);
            if factor == 1.0 {
                return Ok(Some(value));
            }
            let scaled = FunctionOfSeveral::Linear { slopes: vec![factor], intercept: 0.0 };
            Ok(Some(reader.builder.combine(set, &format!("{name}_scaled"), vec![value], scaled)))
        }
    }
}
