//! A learned limit in the numbers of game and robot engines.

use condyle_diagnostics::Error;
use condyle_formats::document;
use condyle_learn::limits::engine::{self, Aim, ConeTwist, Law, Loss, ReachCone, Region};
use condyle_learn::limits::{About, Field};
use condyle_math::{Affine, Quat, Vec3};
use condyle_model::component::{JointCone, Swinging};
use condyle_model::{CoordinateKind, Law as ComponentLaw, ModelBuilder};

/// A cone with twist and what it loses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    /// The cone.
    pub cone: ConeTwist,
    /// What is lost.
    pub loss: Loss,
}

/// A limit as engines can hold it.
#[derive(Clone, Debug, PartialEq)]
pub struct Engines {
    /// The direction of the bone in the child.
    pub bone: Vec3,
    /// What was wanted.
    pub aim: Aim,
    /// The nearest cone of swing angles, for no engine in particular.
    pub cone: Fitted,
    /// The nearest of each engine's own law.
    pub engines: Vec<Fitted>,
    /// The nearest reach cone.
    pub reach: ReachCone,
    /// What that loses.
    pub reach_loss: Loss,
}

/// Fits what engines can hold to a field, for a bone along `bone` in the child; the reach cone has so many directions.
///
/// # Errors
/// `limits/engine`, as [`EngineError`](engine::EngineError) says it.
///
/// ```
/// use condyle::learning::{Aim, engines};
/// use condyle::limits::{Cloud, Settings, herda2003, learn};
/// use condyle::math::{Quat, Vec3};
/// // 4000 turns of a bone along y by up to 45 degrees, each with a twist within ±30.
/// let angle = |i: usize, by: f64| 2.0 * (0.5 + i as f64 * by).fract() - 1.0;
/// let take: Vec<Quat> = (0..4000)
///     .map(|i| {
///         let [x, z, t] = [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|by| angle(i, by));
///         Quat::exp(Vec3::new(x, 0.0, z) * 0.785) * Quat::exp(Vec3::Y * (0.524 * t))
///     })
///     .filter(|q| (*q * Quat::exp(Vec3::ZERO)).to_mat3().y.y > 0.785f64.cos())
///     .collect();
/// let cloud = Cloud::gather(&[&take], 0.0)?;
/// let settings = Settings { nodes: 48, ..Settings::default() };
/// let limit = learn(&cloud, &settings, Default::default())?;
/// let found = engines(limit.field(), Vec3::Y, 12, Aim::Closest)?;
/// let cone = &found.cone.cone;
/// assert!(cone.swing.iter().all(|a| (a.to_degrees() - 45.0).abs() < 3.0), "{cone:?}");
/// assert!((cone.twist.to_degrees() - 30.0).abs() < 3.0);
/// # Ok::<(), condyle::Error>(())
/// ```
pub fn engines(field: &Field, bone: Vec3, directions: usize, aim: Aim) -> Result<Engines, Error> {
    let wrong = |error: engine::EngineError| Error::new("limits/engine", error.to_string());
    let region = Region::of(field);
    let distance = |q: Quat| field.distance(q);
    let fitted = |cone: ConeTwist| Fitted { cone, loss: Loss::of(&region, |q| cone.allows(q)) };
    let fit = |law, from: Option<&ConeTwist>| {
        engine::cone_twist(&region, &distance, bone, law, aim, from).map_err(wrong)
    };
    let cone = fit(Law::Angle, None)?;
    let own = Law::ALL.into_iter().filter(|law| *law != Law::Angle);
    let engines =
        own.map(|law| fit(law, Some(&cone)).map(fitted)).collect::<Result<Vec<Fitted>, Error>>()?;
    let reach = engine::reach_cone(&region, &distance, &cone, directions, aim).map_err(wrong)?;
    let reach_loss = Loss::of(&region, |q| reach.allows(q));
    Ok(Engines { bone, aim, cone: fitted(cone), engines, reach, reach_loss })
}

/// A reach cone as a model document: a ball joint whose orientation a `cone` limits, in a joint frame turned by the middle
/// rotation. The joint's orientation is middle⁻¹·R.
///
/// # Errors
/// What the model's checks find wrong, such as names that cannot be.
pub fn reach_document(reach: &ReachCone, about: &About) -> Result<String, Error> {
    let named = |name: &str, other: &str| match name.trim() {
        "" => other.to_owned(),
        name => name.to_owned(),
    };
    let reference = named(about.reference.as_deref().unwrap_or(""), "reference");
    let mut child = named(&about.child, "child");
    if child == reference {
        child.push_str("_child");
    }
    let mut builder = ModelBuilder::new(&named(&about.name, "reach"));
    let parent = builder.segment(&reference, None);
    let segment = builder.segment(&child, Some(parent));
    let turned = Affine::from_rotation(reach.middle.to_mat3());
    builder.place_joint_frames(segment, turned, Affine::IDENTITY);
    let set = builder.joint_set("reach");
    let orientation = builder.coordinate(set, "orientation", CoordinateKind::Orientation);
    let cone = JointCone { of: Swinging::Orientation, cone: reach.cone.clone() };
    let legal = builder.component(set, "legal", ComponentLaw::Cone(cone), vec![orientation.into()]);
    let turn = builder.component(
        set,
        "turn",
        ComponentLaw::Ball(condyle_model::component::Ball),
        vec![legal],
    );
    builder.output(set, segment, turn);
    Ok(document::model::write(&builder.build()?))
}
