//! One joint for every step: for programs whose joints have one number and are coupled by polynomials of one other.

use super::fit::{ANGLE_TOLERANCE, LENGTH_TOLERANCE, polynomial_of_one};
use super::legal::Legal;
use super::rule::{Rule, Value};
use super::written::Names;
use super::{Source, Step, Tree};
use condyle_diagnostics::{Diagnostic, listed};
use condyle_math::function::Curve;
use condyle_model::{CoordinateKind, Model, Range};
use std::collections::HashMap;

/// A joint of one number.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Its value in the tree.
    pub value: Value,
    /// Whether it turns, or else slides.
    pub turns: bool,
    /// Its range.
    pub range: Range,
    /// Its default.
    pub default: f64,
    /// The joint that it follows, by its position, and the polynomial by ascending powers.
    pub coupled: Option<(usize, Vec<f64>)>,
    /// The sum of others that it follows: their positions and factors, and a constant.
    pub sum: Option<(Vec<(usize, f64)>, f64)>,
}

/// A joint that moves no segment and holds a number that drives others.
#[derive(Clone, Debug)]
pub struct Lone {
    /// The name of its body.
    pub body: String,
    /// The position of the joint.
    pub joint: usize,
}

/// A coupling that is not said exactly.
#[derive(Clone, Debug)]
struct Inexact {
    joint: String,
    /// The largest error of the best polynomial, radians or metres; `None` where it has several drivers.
    error: Option<f64>,
    turns: bool,
    free: bool,
}

/// All joints of a tree.
#[derive(Clone, Debug)]
pub struct Joints {
    /// The joints.
    pub all: Vec<Joint>,
    /// Joints that hold numbers.
    pub holders: Vec<Lone>,
    /// The names of the bodies of links.
    pub bodies: Vec<String>,
    /// The name of the world, or of what stands in it.
    pub world: String,
    /// The joint of each step, by link and step.
    places: HashMap<(usize, usize), usize>,
    inexact: Vec<Inexact>,
}

impl Joints {
    /// The joints of a tree, coupled by polynomials up to this order.
    pub fn new(model: &Model, tree: &Tree, order: usize) -> Self {
        let mut bodies = Names::default();
        // MuJoCo's own body has the name `world`: nothing else may have it.
        bodies.take("world");
        let world = bodies.take("base_of_model");
        let bodies_of: Vec<String> =
            tree.links.iter().map(|link| bodies.take(&link.name)).collect();
        let mut this = Self {
            all: vec![],
            holders: vec![],
            bodies: bodies_of,
            world,
            places: HashMap::new(),
            inexact: vec![],
        };
        let forms = tree.rules.forms();
        let mut names = Names::default();
        let variable_names: Vec<String> =
            tree.variables.iter().map(|v| names.take(&v.name)).collect();
        let rest = tree.variables.iter().map(|v| v.default).collect::<Vec<f64>>();
        let rest = tree.rules.evaluate(&rest);
        // The first joint that a variable moves by itself is its own.
        let mut own: HashMap<usize, usize> = HashMap::new();
        for (place, link) in tree.links.iter().enumerate() {
            let mut number = 0usize;
            for (at, step) in link.steps.iter().enumerate() {
                let Some(value) = step.value() else { continue };
                let turns = matches!(step, Step::Turn { .. });
                number += 1;
                let variable = match tree.rules.rule(value) {
                    Rule::Variable(v)
                        if !own.contains_key(v) && fits(tree.variables[*v].kind, turns) =>
                    {
                        Some(*v)
                    }
                    _ => None,
                };
                let (name, range) = match variable {
                    Some(v) => (variable_names[v].clone(), tree.variables[v].range),
                    None => (names.take(&format!("{}_{number}", link.name)), Range::FREE),
                };
                this.all.push(Joint {
                    name,
                    value,
                    turns,
                    range,
                    default: rest[value],
                    coupled: None,
                    sum: None,
                });
                this.places.insert((place, at), this.all.len() - 1);
                if let Some(v) = variable {
                    own.insert(v, this.all.len() - 1);
                }
            }
        }
        this.hold(tree, &forms, &mut own, &variable_names, &mut bodies);
        let intervals: Vec<(f64, f64)> = tree
            .variables
            .iter()
            .map(|v| match v.source {
                Source::Coordinate(id) => Legal::interval(model, id),
                Source::Angle(..) => (-std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2),
            })
            .collect();
        for joint in 0..this.all.len() {
            let value = this.all[joint].value;
            let followed = match tree.rules.rule(value) {
                Rule::Variable(v) if own.get(v) == Some(&joint) => match tree.variables[*v].follows
                {
                    Some(leader) => leader,
                    None => continue,
                },
                _ => value,
            };
            this.couple(tree, &forms[followed], followed, joint, &own, &intervals, order);
        }
        this
    }

    /// Gives every variable that drives something and moves nothing by itself a joint.
    fn hold(
        &mut self,
        tree: &Tree,
        forms: &[super::Form],
        own: &mut HashMap<usize, usize>,
        names: &[String],
        bodies: &mut Names,
    ) {
        let mut drivers: Vec<usize> =
            self.all.iter().flat_map(|joint| forms[joint.value].drivers.iter().copied()).collect();
        let mut next = 0;
        while let Some(&v) = drivers.get(next) {
            next += 1;
            if let Some(leader) = tree.variables[v].follows {
                let more = forms[leader].drivers.iter().copied().filter(|d| !drivers.contains(d));
                let more: Vec<usize> = more.collect();
                drivers.extend(more);
            }
        }
        drivers.sort_unstable();
        drivers.dedup();
        for v in drivers {
            if own.contains_key(&v) {
                continue;
            }
            let variable = &tree.variables[v];
            let value = (0..tree.rules.len()).find(|&at| *tree.rules.rule(at) == Rule::Variable(v));
            let Some(value) = value else { continue };
            self.all.push(Joint {
                name: names[v].clone(),
                value,
                turns: variable.kind == CoordinateKind::Rotation,
                range: variable.range,
                default: variable.default,
                coupled: None,
                sum: None,
            });
            let body = bodies.take(&format!("{}_value", names[v]));
            self.holders.push(Lone { body, joint: self.all.len() - 1 });
            own.insert(v, self.all.len() - 1);
        }
    }

    #[expect(clippy::too_many_arguments, reason = "what a coupling depends on, once")]
    fn couple(
        &mut self,
        tree: &Tree,
        form: &super::Form,
        value: Value,
        joint: usize,
        own: &HashMap<usize, usize>,
        intervals: &[(f64, f64)],
        order: usize,
    ) {
        let turns = self.all[joint].turns;
        let tolerance = if turns { ANGLE_TOLERANCE } else { LENGTH_TOLERANCE };
        let mut note = |joint: &Joint, error, free| {
            self.inexact.push(Inexact { joint: joint.name.clone(), error, turns, free });
        };
        if form.measured || form.drivers.is_empty() {
            note(&self.all[joint], None, true);
            return;
        }
        if let Some((terms, constant)) = &form.linear {
            let terms: Option<Vec<(usize, f64)>> =
                terms.iter().map(|(v, factor)| Some((*own.get(v)?, *factor))).collect();
            match terms.as_deref() {
                Some([(leader, slope)]) => {
                    self.all[joint].coupled = Some((*leader, vec![*constant, *slope]));
                    return;
                }
                Some(several) => {
                    self.all[joint].sum = Some((several.to_vec(), *constant));
                    if order == 1 {
                        note(&self.all[joint], None, true);
                    }
                    return;
                }
                None => {}
            }
        }
        let ([driver], Some(leader)) =
            (&form.drivers[..], form.drivers.first().and_then(|v| own.get(v)))
        else {
            note(&self.all[joint], None, true);
            return;
        };
        if let Some(exact) = exact(tree, value, order) {
            self.all[joint].coupled = Some((*leader, exact));
            return;
        }
        let mut variables: Vec<f64> = tree.variables.iter().map(|v| v.default).collect();
        variables.resize(variables.len().max(driver + 1), 0.0);
        let at = |x: f64| {
            let mut here = variables.clone();
            here[*driver] = x;
            tree.rules.evaluate(&here)[value]
        };
        match polynomial_of_one(&at, intervals[*driver], order) {
            Some((coefficients, error)) => {
                let free = error > tolerance;
                if !free {
                    self.all[joint].coupled = Some((*leader, coefficients));
                }
                note(&self.all[joint], Some(error), free);
            }
            None => note(&self.all[joint], None, true),
        }
    }

    /// The joint of a step.
    pub fn at(&self, link: usize, step: usize) -> Option<&Joint> {
        self.places.get(&(link, step)).and_then(|&joint| self.all.get(joint))
    }

    /// All names with their values.
    pub fn named(&self) -> Vec<(String, Value)> {
        self.all.iter().map(|joint| (joint.name.clone(), joint.value)).collect()
    }

    /// What is not said exactly.
    pub fn remarks(&self, format: &str, code: &'static str) -> Vec<Diagnostic> {
        let mut remarks = vec![];
        let said = |inexact: &Inexact| match inexact.error {
            Some(error) if inexact.turns => {
                format!("{} ({:.3}°)", inexact.joint, error.to_degrees())
            }
            Some(error) => format!("{} ({:.3} mm)", inexact.joint, error * 1e3),
            None => inexact.joint.clone(),
        };
        let fitted: Vec<String> = self.inexact.iter().filter(|i| !i.free).map(said).collect();
        if !fitted.is_empty() {
            let worst = |turns: bool| {
                let errors = self.inexact.iter().filter(|i| !i.free && i.turns == turns);
                errors.filter_map(|i| i.error).fold(0.0, f64::max)
            };
            remarks.push(Diagnostic::note(
                "plain/fitted",
                format!(
                    "{} couplings are fitted, largest error {:.4} mm, {:.4}°: {}",
                    fitted.len(),
                    worst(false) * 1e3,
                    worst(true).to_degrees(),
                    listed(&fitted)
                ),
            ));
        }
        let free: Vec<String> = self.inexact.iter().filter(|i| i.free).map(said).collect();
        if !free.is_empty() {
            remarks.push(
                Diagnostic::warning(
                    code,
                    format!("{} joints that others drive are free, since {format} cannot couple them: {}", free.len(), listed(&free)),
                )
                .with_help("set them from the model, with all others"),
            );
        }
        remarks
    }
}

fn fits(kind: CoordinateKind, turns: bool) -> bool {
    match kind {
        CoordinateKind::Rotation => turns,
        CoordinateKind::Translation => !turns,
        _ => true,
    }
}

/// The polynomial of a variable that a value is, up to an order, by ascending powers.
fn exact(tree: &Tree, value: Value, order: usize) -> Option<Vec<f64>> {
    let Rule::One(function, of) = tree.rules.rule(value) else { return None };
    let (Rule::Variable(_), Curve::Polynomial(p)) = (tree.rules.rule(*of), &function.curve) else {
        return None;
    };
    let all: Vec<f64> = p.ascending().iter().map(|c| c * function.factor).collect();
    (all.len() <= order + 1).then_some(all)
}
