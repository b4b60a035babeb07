//! Laws in a model: coordinates that were free follow others.

use super::LawFunction;
use condyle_diagnostics::Error;
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_model::component::{Correlate, Map, Region};
use condyle_model::{JointSetId, Law, Model, ModelBuilder, Signal};

/// The model in which coordinates follow others by laws: the component `D_law` of kind `correlate` in the joint set of each
/// dependent D. Controls may lie in any joint.
///
/// A law that is a sum of functions of one control each becomes a `map` for each and a `combine` of them; the region is then
/// not kept.
///
/// ```
/// use condyle_learn::coupling::{LawFunction, apply};
/// use condyle_math::{Vec3, function::FunctionOfSeveral};
/// use condyle_model::{CoordinateKind, Mode, ModelBuilder, Pose, Program};
/// let mut b = ModelBuilder::new("bolt");
/// let bolt = b.segment("bolt", None);
/// let set = b.joint_set("thread");
/// let turn = b.coordinate(set, "turn", CoordinateKind::Rotation);
/// let along = b.coordinate(set, "along", CoordinateKind::Translation);
/// let parts = vec![b.rotate(set, "r", turn, Vec3::X), b.translate(set, "t", along, Vec3::X)];
/// let moved = b.product(set, "moved", parts);
/// b.output(set, bolt, moved);
/// let free = b.build()?;
/// let pitch = LawFunction::Several(FunctionOfSeveral::Linear { slopes: vec![0.001], intercept: 0.02 });
/// let screw = apply(&free, &["turn".into()], None, &[("along", &pitch)])?;
/// let program = Program::compile(&screw);
/// let mut pose = Pose::new(&program);
/// program.evaluate(&[3.0, 0.0], Mode::Open, &mut pose)?;
/// assert!((pose.segments()[0].translation.x - 0.023).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Names that the model does not have, with the nearest; `learn/orientation` for an orientation, which is no single number;
/// what is wrong with the model that results, such as laws that depend on each other.
pub fn apply(
    model: &Model,
    controls: &[String],
    region: Option<&Region>,
    laws: &[(&str, &LawFunction)],
) -> Result<Model, Error> {
    let find = |name: &str| {
        let id = model.find_coordinate(name)?;
        if model.coordinate(id).kind.stored() != 1 {
            let message = format!("`{name}` is an orientation, which is no single number");
            let help = "give the joint three angles";
            return Err(Error::new("learn/orientation", message).with_help(help));
        }
        Ok(id)
    };
    let inputs: Vec<Signal> =
        controls.iter().map(|name| find(name).map(Signal::from)).collect::<Result<_, _>>()?;
    let mut builder = ModelBuilder::from(model.clone());
    for (dependent, function) in laws {
        let id = find(dependent)?;
        let (set, name) = (model.coordinate(id).joint_set, &model.coordinate(id).name);
        let taken = |name: &str| {
            let components = model.components().iter();
            components.clone().any(|c| c.joint_set == set && c.name == name)
                || model.coordinates().iter().any(|c| c.joint_set == set && c.name == name)
        };
        let mut free = format!("{name}_law");
        while taken(&free) {
            free.push('_');
        }
        let leader = leader(&mut builder, set, &free, &inputs, function, region);
        let coordinate = builder.coordinate_mut(id);
        coordinate.locked = false;
        builder.follow(id, leader);
    }
    builder.build()
}

/// The component that computes a law, with the name `name`; those of its parts are named after it.
pub(crate) fn leader(
    builder: &mut ModelBuilder,
    set: JointSetId,
    name: &str,
    inputs: &[Signal],
    function: &LawFunction,
    region: Option<&Region>,
) -> Signal {
    match function {
        LawFunction::Several(function) => {
            let law = Correlate { function: function.clone(), region: region.cloned() };
            builder.component(set, name, Law::Correlate(law), inputs.to_vec())
        }
        LawFunction::Sum { intercept, parts } => {
            let mut sum = vec![];
            for (k, (part, input)) in parts.iter().zip(inputs).enumerate() {
                let map = Map { functions: vec![Function::clone(part)] };
                let name = format!("{name}_{}", k + 1);
                sum.push(builder.component(set, &name, Law::Map(map), vec![*input]));
            }
            let slopes = vec![1.0; sum.len()];
            let all = FunctionOfSeveral::Linear { slopes, intercept: *intercept };
            builder.combine(set, name, sum, all)
        }
    }
}
