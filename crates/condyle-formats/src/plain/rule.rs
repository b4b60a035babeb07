//! Values: what turns and slides are driven by.

use condyle_math::function::{Curve, Function, FunctionOfSeveral};
use std::collections::BTreeMap;

/// The position of a value among the rules of a tree.
pub type Value = usize;

/// How a value is computed.
#[derive(Clone, Debug, PartialEq)]
pub enum Rule {
    /// Always the same.
    Constant(f64),
    /// A variable, by its position.
    Variable(usize),
    /// A function of another value.
    One(Function, Value),
    /// A function of several others.
    Several(FunctionOfSeveral, Vec<Value>),
    /// What is left of a chain at a pose: no function of variables is known.
    Measured,
}

/// The rules of all values; each reads only those before it.
#[derive(Clone, Debug, Default)]
pub struct Rules {
    rules: Vec<Rule>,
}

/// What a value comes from.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Form {
    /// The variables that it depends on, in increasing order.
    pub drivers: Vec<usize>,
    /// Factors of variables and a constant, where it is linear in variables.
    pub linear: Option<(Vec<(usize, f64)>, f64)>,
    /// Whether it depends on what is measured.
    pub measured: bool,
}

/// The most arguments of a sum that is made of sums.
const MOST_TERMS: usize = 16;

impl Rules {
    /// The number of rules.
    pub fn len(&self) -> usize {
        self.rules.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rules.is_empty()
    }

    /// A rule; a value that does not exist is 0.
    pub fn rule(&self, value: Value) -> &Rule {
        self.rules.get(value).unwrap_or(&Rule::Constant(0.0))
    }

    /// Replaces the rule of a value by one that reads only values before it.
    pub fn set(&mut self, value: Value, rule: Rule) {
        if let Some(old) = self.rules.get_mut(value) {
            *old = rule;
        }
    }

    /// Adds a rule as it is.
    pub fn push(&mut self, rule: Rule) -> Value {
        // Variables and constants are often asked for: one of each is enough.
        if matches!(rule, Rule::Constant(_) | Rule::Variable(_))
            && let Some(known) = self.rules.iter().position(|known| *known == rule)
        {
            return known;
        }
        self.rules.push(rule);
        self.rules.len() - 1
    }

    /// The number, if it never changes.
    pub fn as_constant(&self, value: Value) -> Option<f64> {
        match self.rule(value) {
            Rule::Constant(c) => Some(*c),
            _ => None,
        }
    }

    /// A function of a value, in the simplest form.
    pub fn one(&mut self, function: Function, of: Value) -> Value {
        if let Some(c) = function.as_constant() {
            return self.push(Rule::Constant(c));
        }
        if let Some(x) = self.as_constant(of) {
            return self.push(Rule::Constant(function.value_and_slope(x).0));
        }
        if let Some((slope, intercept)) = function.as_linear() {
            if (slope, intercept) == (1.0, 0.0) {
                return of;
            }
            return self.sum(&[(of, slope)], intercept);
        }
        self.push(Rule::One(function, of))
    }

    /// A function of several values, in the simplest form.
    pub fn several(&mut self, function: FunctionOfSeveral, of: &[Value]) -> Value {
        if let FunctionOfSeveral::Linear { slopes, intercept } = &function {
            let terms: Vec<(Value, f64)> = of.iter().copied().zip(slopes.iter().copied()).collect();
            return self.sum(&terms, *intercept);
        }
        let constants: Option<Vec<f64>> = of.iter().map(|&v| self.as_constant(v)).collect();
        match constants {
            Some(numbers) => self.push(Rule::Constant(function.apply(&numbers))),
            None => self.push(Rule::Several(function, of.to_vec())),
        }
    }

    /// A sum of multiples, with sums among them taken apart.
    fn sum(&mut self, terms: &[(Value, f64)], intercept: f64) -> Value {
        let (mut atoms, mut constant) = (BTreeMap::<Value, f64>::new(), intercept);
        for &(value, factor) in terms {
            let (inner, offset) = self.as_sum(value);
            constant += factor * offset;
            inner.into_iter().for_each(|(v, f)| *atoms.entry(v).or_default() += factor * f);
        }
        atoms.retain(|_, factor| *factor != 0.0);
        if atoms.len() > MOST_TERMS {
            let slopes = terms.iter().map(|(_, f)| *f).collect();
            let of = terms.iter().map(|(v, _)| *v).collect();
            return self.push(Rule::Several(FunctionOfSeveral::Linear { slopes, intercept }, of));
        }
        let atoms: Vec<(Value, f64)> = atoms.into_iter().collect();
        match atoms[..] {
            [] => self.push(Rule::Constant(constant)),
            [(value, factor)] => match self.rule(value).clone() {
                _ if (factor, constant) == (1.0, 0.0) => value,
                // A multiple of a function is that function with another factor.
                Rule::One(mut function, of) if constant == 0.0 => {
                    function.factor *= factor;
                    self.push(Rule::One(function, of))
                }
                _ => self.push(Rule::One(Function::linear(factor, constant), value)),
            },
            _ => {
                let (of, slopes) = atoms.into_iter().unzip();
                let function = FunctionOfSeveral::Linear { slopes, intercept: constant };
                self.push(Rule::Several(function, of))
            }
        }
    }

    fn as_sum(&self, value: Value) -> (Vec<(Value, f64)>, f64) {
        match self.rule(value) {
            Rule::Constant(c) => (vec![], *c),
            Rule::One(f @ Function { curve: Curve::Linear { .. }, .. }, of) => {
                let (slope, intercept) = f.as_linear().unwrap_or_default();
                (vec![(*of, slope)], intercept)
            }
            Rule::Several(FunctionOfSeveral::Linear { slopes, intercept }, of) => {
                (of.iter().copied().zip(slopes.iter().copied()).collect(), *intercept)
            }
            _ => (vec![(value, 1.0)], 0.0),
        }
    }

    /// All values at variables; what is measured is 0.
    pub fn evaluate(&self, variables: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.rules.len());
        for rule in &self.rules {
            let at = |v: &Value| values.get(*v).copied().unwrap_or(0.0);
            let value = match rule {
                Rule::Constant(c) => *c,
                Rule::Variable(i) => variables.get(*i).copied().unwrap_or(0.0),
                Rule::One(function, of) => function.value_and_slope(at(of)).0,
                Rule::Several(function, of) => function.apply_to(of.iter().map(at)),
                Rule::Measured => 0.0,
            };
            values.push(value);
        }
        values
    }

    /// What each value comes from.
    pub fn forms(&self) -> Vec<Form> {
        let mut forms: Vec<Form> = Vec::with_capacity(self.rules.len());
        for rule in &self.rules {
            let form = match rule {
                Rule::Constant(c) => Form { linear: Some((vec![], *c)), ..Form::default() },
                Rule::Variable(i) => Form {
                    drivers: vec![*i],
                    linear: Some((vec![(*i, 1.0)], 0.0)),
                    measured: false,
                },
                Rule::Measured => Form { measured: true, ..Form::default() },
                Rule::One(function, of) => {
                    let linear = function.as_linear().map(|(s, c)| (vec![s], c));
                    joined(&forms, std::slice::from_ref(of), linear)
                }
                Rule::Several(function, of) => {
                    let linear = match function {
                        FunctionOfSeveral::Linear { slopes, intercept } => {
                            Some((slopes.clone(), *intercept))
                        }
                        FunctionOfSeveral::Polynomial(_) => None,
                    };
                    joined(&forms, of, linear)
                }
            };
            forms.push(form);
        }
        forms
    }
}

fn joined(forms: &[Form], of: &[Value], linear: Option<(Vec<f64>, f64)>) -> Form {
    let inner: Vec<&Form> = of.iter().filter_map(|&v| forms.get(v)).collect();
    let mut drivers: Vec<usize> = inner.iter().flat_map(|f| f.drivers.iter().copied()).collect();
    drivers.sort_unstable();
    drivers.dedup();
    let linear = linear.and_then(|(slopes, intercept)| {
        let (mut terms, mut constant) = (BTreeMap::<usize, f64>::new(), intercept);
        for (form, slope) in inner.iter().zip(slopes) {
            let (inside, offset) = form.linear.as_ref()?;
            constant += slope * offset;
            inside.iter().for_each(|(i, f)| *terms.entry(*i).or_default() += slope * f);
        }
        Some((terms.into_iter().collect(), constant))
    });
    Form { drivers, linear, measured: inner.iter().any(|f| f.measured) }
}
