//! Which coordinate of the file holds which number, and what couples them.

use super::function::{one, several};
use super::{Moved, own_function};
use crate::plain::{Names, Rule, Tree, Value};
use condyle_model::{CoordinateKind, Model, Range};
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

/// A coordinate of the file.
pub(super) struct Coordinate {
    pub(super) name: String,
    pub(super) value: Value,
    pub(super) default: f64,
    pub(super) range: Range,
    pub(super) locked: bool,
}

/// A body that nothing hangs from, whose joint holds numbers.
pub(super) struct Holder {
    pub(super) name: String,
    /// The position of the coordinate of its turn.
    pub(super) turn: Option<usize>,
    /// Those of its slides, at most three.
    pub(super) slides: Vec<usize>,
}

/// All coordinates of the file.
pub(super) struct Coordinates {
    all: Vec<Coordinate>,
    /// Which of them each joint has, by the positions of joints.
    of_joint: Vec<Vec<usize>>,
    holders: Vec<Holder>,
    /// The coordinate of each variable of the tree that has one.
    of_variable: HashMap<usize, usize>,
    /// The coordinate that holds a value and is coupled to what the value is computed from.
    coupled: HashMap<Value, usize>,
    /// The joint that a variable belongs to.
    owner: HashMap<usize, usize>,
    /// Coordinates that are equal to others, where a joint is moved by a number of another one.
    copies: Vec<(usize, Value)>,
}

/// How an axis is driven.
pub(super) enum Drive<'c> {
    /// By the coordinate itself.
    Plain(&'c str),
    /// By a function of a coordinate.
    Function(&'c str, String),
    /// Not at all.
    Constant(f64),
}

impl Coordinates {
    pub(super) fn new(model: &Model, tree: &Tree, moved: &[Moved]) -> Self {
        let mut this = Self {
            all: vec![],
            of_joint: vec![vec![]; moved.len()],
            holders: vec![],
            of_variable: HashMap::new(),
            coupled: HashMap::new(),
            owner: HashMap::new(),
            copies: vec![],
        };
        this.owners(tree, moved);
        let mut names = Names::default();
        let rest = variables_at_rest(model, tree);
        let values = tree.rules.evaluate(&rest);
        // Variables first: they keep their names.
        let needed = needed(tree, moved);
        let mut variable_names = HashMap::new();
        for (place, variable) in tree.variables.iter().enumerate() {
            if needed.contains(&place) {
                variable_names.insert(place, names.take(&variable.name));
            }
        }
        let variable_value = |place: usize| {
            (0..tree.rules.len())
                .find(|&v| *tree.rules.rule(v) == Rule::Variable(place))
                .unwrap_or_default()
        };
        let of_tree = |place: usize, name: &str| {
            let variable = &tree.variables[place];
            Coordinate {
                name: name.to_owned(),
                value: variable_value(place),
                default: variable.default,
                range: variable.range,
                locked: variable.locked,
            }
        };
        for (number, moved) in moved.iter().enumerate() {
            for (value, turns) in moved.piece.values() {
                if tree.rules.as_constant(value).is_some() {
                    continue;
                }
                let own = own_function(tree, value).filter(|v| this.owner.get(v) == Some(&number));
                if let Some(place) = own {
                    if !this.of_variable.contains_key(&place)
                        && let Some(name) = variable_names.get(&place)
                    {
                        this.all.push(of_tree(place, name));
                        this.of_variable.insert(place, this.all.len() - 1);
                        this.of_joint[number].push(this.all.len() - 1);
                    }
                    continue;
                }
                let known = this.of_joint[number].iter().any(|&c| this.all[c].value == value);
                if known {
                    continue;
                }
                let word = if turns { "turn" } else { "slide" };
                let name = names.take(&format!("{}_{word}", moved.joint));
                this.all.push(Coordinate {
                    name,
                    value,
                    default: values[value],
                    range: Range::FREE,
                    locked: false,
                });
                let at = this.all.len() - 1;
                this.of_joint[number].push(at);
                match tree.rules.rule(value) {
                    Rule::Measured => {}
                    _ if !matches!(tree.rules.rule(value), Rule::Variable(_))
                        && !this.coupled.contains_key(&value) =>
                    {
                        this.coupled.insert(value, at);
                    }
                    _ => this.copies.push((at, value)),
                }
            }
        }
        // Variables that only drive others.
        let mut places: Vec<usize> = variable_names.keys().copied().collect();
        places.sort_unstable();
        for place in places {
            if !this.of_variable.contains_key(&place) {
                this.all.push(of_tree(place, &variable_names[&place]));
                this.of_variable.insert(place, this.all.len() - 1);
                let rotates = tree.variables[place].kind == CoordinateKind::Rotation;
                this.hold(this.all.len() - 1, rotates, &tree.name);
            }
        }
        // Numbers on the way to what is coupled.
        let mut wanted = vec![false; tree.rules.len()];
        this.coupled.keys().for_each(|&v| wanted[v] = true);
        tree.variables.iter().filter_map(|v| v.follows).for_each(|v| wanted[v] = true);
        for value in (0..tree.rules.len()).rev() {
            if wanted[value] {
                match tree.rules.rule(value) {
                    Rule::One(_, of) => wanted[*of] = true,
                    Rule::Several(_, of) => of.iter().for_each(|&v| wanted[v] = true),
                    _ => {}
                }
            }
        }
        for value in (0..tree.rules.len()).filter(|&v| wanted[v]) {
            let constant = match tree.rules.rule(value) {
                Rule::Variable(_) | Rule::Measured => continue,
                Rule::Constant(_) => true,
                _ => false,
            };
            if this.coupled.contains_key(&value) {
                continue;
            }
            this.all.push(Coordinate {
                name: names.take(&format!("value_{value}")),
                value,
                default: values[value],
                range: Range::FREE,
                locked: constant,
            });
            this.coupled.insert(value, this.all.len() - 1);
            this.hold(this.all.len() - 1, false, &tree.name);
        }
        this
    }

    /// The joint that each variable belongs to: where it moves an axis by itself, else, if it is no angle or
    /// distance, where a function of it does.
    fn owners(&mut self, tree: &Tree, moved: &[Moved]) {
        let uses = || {
            moved
                .iter()
                .enumerate()
                .flat_map(|(n, m)| m.piece.values().map(move |(v, t)| (n, v, t)))
        };
        for (number, value, turns) in uses() {
            let Some(place) = own_function(tree, value) else { continue };
            let plain = match tree.rules.rule(value) {
                Rule::One(f, _) => f.as_linear().is_some_and(|(slope, _)| slope.abs() == 1.0),
                _ => true,
            };
            let fits = match tree.variables[place].kind {
                CoordinateKind::Rotation => turns,
                CoordinateKind::Translation => !turns,
                _ => true,
            };
            if plain && fits {
                self.owner.entry(place).or_insert(number);
            }
        }
        for (number, value, _) in uses() {
            let Some(place) = own_function(tree, value) else { continue };
            if !matches!(
                tree.variables[place].kind,
                CoordinateKind::Rotation | CoordinateKind::Translation
            ) {
                self.owner.entry(place).or_insert(number);
            }
        }
    }

    /// Puts a coordinate into a joint of its own, with others of that sort.
    fn hold(&mut self, at: usize, rotates: bool, model: &str) {
        let room = |holder: &&mut Holder| match rotates {
            true => holder.turn.is_none(),
            false => holder.slides.len() < 3,
        };
        let mut names = Names::default();
        let name = names.take(&format!("{model}_values_{}", self.holders.len() + 1));
        let holder = match self.holders.iter_mut().rev().find(room) {
            Some(holder) => holder,
            None => {
                self.holders.push(Holder { name, turn: None, slides: vec![] });
                match self.holders.last_mut() {
                    Some(holder) => holder,
                    None => return,
                }
            }
        };
        if rotates {
            holder.turn = Some(at);
        } else {
            holder.slides.push(at);
        }
    }

    pub(super) fn holders(&self) -> &[Holder] {
        &self.holders
    }

    pub(super) fn get(&self, at: usize) -> Option<&Coordinate> {
        self.all.get(at)
    }

    pub(super) fn of_joint(&self, number: usize) -> impl Iterator<Item = &Coordinate> {
        self.of_joint.get(number).into_iter().flatten().filter_map(|&at| self.all.get(at))
    }

    pub(super) fn of_variable(&self, place: usize) -> Option<&str> {
        self.of_variable.get(&place).and_then(|&at| self.all.get(at)).map(|c| c.name.as_str())
    }

    /// How a value drives an axis of a joint.
    pub(super) fn drive(&self, tree: &Tree, number: usize, value: Value) -> Drive<'_> {
        if let Some(constant) = tree.rules.as_constant(value) {
            return Drive::Constant(constant);
        }
        let own = own_function(tree, value).filter(|v| self.owner.get(v) == Some(&number));
        if let Some(place) = own
            && let Some(name) = self.of_variable(place)
        {
            let coupled = tree.variables[place].kind == CoordinateKind::Other;
            return match tree.rules.rule(value) {
                Rule::One(function, _) => Drive::Function(name, one(function, coupled)),
                _ if coupled => {
                    let itself = condyle_math::function::Function::identity();
                    Drive::Function(name, one(&itself, true))
                }
                _ => Drive::Plain(name),
            };
        }
        match self.of_joint(number).find(|c| c.value == value) {
            Some(coordinate) => Drive::Plain(&coordinate.name),
            None => Drive::Constant(0.0),
        }
    }

    /// The name of the coordinate that holds a value.
    fn holding(&self, tree: &Tree, value: Value) -> Option<&str> {
        match tree.rules.rule(value) {
            Rule::Variable(place) => self.of_variable(*place),
            Rule::Measured => self.all.iter().find(|c| c.value == value).map(|c| c.name.as_str()),
            _ => self.coupled.get(&value).and_then(|&at| self.all.get(at)).map(|c| c.name.as_str()),
        }
    }

    /// What couples coordinates.
    pub(super) fn couplers(&self, out: &mut String, tree: &Tree) {
        let mut values: Vec<(Value, usize)> =
            self.coupled.iter().map(|(&v, &at)| (v, at)).collect();
        values.sort_unstable();
        for (value, at) in values {
            let Some(dependent) = self.all.get(at) else { continue };
            let (function, of) = match tree.rules.rule(value) {
                Rule::One(function, of) => (one(function, false), std::slice::from_ref(of)),
                Rule::Several(function, of) => (several(function), &of[..]),
                _ => continue,
            };
            let drivers: Option<Vec<&str>> = of.iter().map(|&v| self.holding(tree, v)).collect();
            if let Some(drivers) = drivers {
                let name = format!("{}_coupler", dependent.name);
                coupler(out, &name, &function, &drivers.join(" "), &dependent.name);
            }
        }
        let same = one(&condyle_math::function::Function::identity(), false);
        let copies = self.copies.iter().filter_map(|&(at, value)| Some((self.all.get(at)?, value)));
        for (copy, value) in copies {
            if let Some(driver) = self.holding(tree, value) {
                coupler(out, &format!("{}_coupler", copy.name), &same, driver, &copy.name);
            }
        }
        for (place, variable) in tree.variables.iter().enumerate() {
            let Some(value) = variable.follows else { continue };
            if let (Some(follower), Some(driver)) =
                (self.of_variable(place), self.holding(tree, value))
            {
                coupler(out, &format!("{follower}_coupler"), &same, driver, follower);
            }
        }
    }

    /// All names with their values.
    pub(super) fn into_named(self) -> Vec<(String, Value)> {
        self.all.into_iter().map(|c| (c.name, c.value)).collect()
    }
}

pub(super) fn coupler(
    out: &mut String,
    name: &str,
    function: &str,
    drivers: &str,
    dependent: &str,
) {
    let _ = writeln!(
        out,
        "<CoordinateCouplerConstraint name=\"{name}\"><isEnforced>true</isEnforced>\
         <coupled_coordinates_function>{function}</coupled_coordinates_function>\
         <independent_coordinate_names>{drivers}</independent_coordinate_names>\
         <dependent_coordinate_name>{dependent}</dependent_coordinate_name>\
         <scale_factor>1</scale_factor></CoordinateCouplerConstraint>"
    );
}

/// The variables that something in the file depends on.
fn needed(tree: &Tree, moved: &[Moved]) -> HashSet<usize> {
    let forms = tree.rules.forms();
    let mut needed: HashSet<usize> = HashSet::new();
    let mut open: Vec<Value> =
        moved.iter().flat_map(|m| m.piece.values().map(|(v, _)| v)).collect();
    while let Some(value) = open.pop() {
        for &driver in forms.get(value).into_iter().flat_map(|form| &form.drivers) {
            if needed.insert(driver) {
                open.extend(tree.variables[driver].follows);
            }
        }
    }
    needed
}

fn variables_at_rest(model: &Model, tree: &Tree) -> Vec<f64> {
    let mut legal = crate::plain::Legal::new(model, 1);
    let (stored, _) = legal.rest();
    tree.variables_at(model, &stored)
}
