//! A JSON value with its place, for messages.

use crate::Error;
use condyle_diagnostics::did_you_mean;
use condyle_math::function::{
    Curve, Function, FunctionOfSeveral, MultivariatePolynomial, PiecewiseLinear, Polynomial,
    SimmSpline,
};
use condyle_math::{Affine, Mat3, Vec3};
use serde_json::Value;
use std::fmt::Display;

/// A value and where it is, such as `components[3].parameters.axis`.
pub(super) struct At<'v> {
    value: &'v Value,
    place: String,
}

impl<'v> At<'v> {
    /// The whole document.
    pub(super) fn top(value: &'v Value) -> Self {
        Self { value, place: String::new() }
    }

    pub(super) fn error(&self, message: impl Display, help: impl Into<String>) -> Error {
        let place = if self.place.is_empty() { "the file" } else { &self.place };
        Error::new("exchange/value", format!("{place}: {message}")).with_help(help)
    }

    fn wrong(&self, wanted: &str) -> Error {
        let found = match self.value {
            Value::Null => "nothing",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::String(_) => "a text",
            Value::Array(_) => "a list",
            Value::Object(_) => "an object",
        };
        self.error(format!("there is {found}, not {wanted}"), format!("give {wanted}"))
    }

    /// The value at a key; an error where there is none or null.
    pub(super) fn key(&self, key: &str) -> Result<Self, Error> {
        match self.perhaps(key) {
            Some(found) => Ok(found),
            None if self.value.is_object() => {
                Err(self.error(format!("`{key}` is missing"), "give it"))
            }
            None => Err(self.wrong(&format!("an object with `{key}`"))),
        }
    }

    /// The value at a key that may be absent or null.
    pub(super) fn perhaps(&self, key: &str) -> Option<Self> {
        let value = self.value.get(key).filter(|value| !value.is_null())?;
        let dot = if self.place.is_empty() { "" } else { "." };
        Some(Self { value, place: format!("{}{dot}{key}", self.place) })
    }

    /// The keys of an object.
    pub(super) fn keys(&self) -> impl Iterator<Item = &'v str> + use<'v> {
        self.value.as_object().into_iter().flat_map(|object| object.keys().map(String::as_str))
    }

    pub(super) fn is_null(&self) -> bool {
        self.value.is_null()
    }

    pub(super) fn list(&self) -> Result<Vec<Self>, Error> {
        let list = self.value.as_array().ok_or_else(|| self.wrong("a list"))?;
        let at = |(index, value)| Self { value, place: format!("{}[{index}]", self.place) };
        Ok(list.iter().enumerate().map(at).collect())
    }

    /// The parts of a list that may be absent.
    pub(super) fn all(&self, key: &str) -> Result<Vec<Self>, Error> {
        self.perhaps(key).map_or(Ok(vec![]), |list| list.list())
    }

    /// Exactly two parts.
    pub(super) fn two(&self) -> Result<[Self; 2], Error> {
        self.list()?.try_into().map_err(|_| self.error("there are not two", "give two"))
    }

    pub(super) fn number(&self) -> Result<f64, Error> {
        self.value.as_f64().ok_or_else(|| self.wrong("a number"))
    }

    pub(super) fn count(&self) -> Result<u32, Error> {
        let count = self.value.as_u64().and_then(|count| u32::try_from(count).ok());
        count.ok_or_else(|| self.wrong("a whole number from 0"))
    }

    pub(super) fn flag(&self) -> Result<bool, Error> {
        self.value.as_bool().ok_or_else(|| self.wrong("true or false"))
    }

    pub(super) fn text(&self) -> Result<&'v str, Error> {
        self.value.as_str().ok_or_else(|| self.wrong("a text"))
    }

    /// One of a few words, by the value that each stands for.
    pub(super) fn word<T: Copy>(&self, words: &[(&str, T)]) -> Result<T, Error> {
        let text = self.text()?;
        if let Some((_, value)) = words.iter().find(|(word, _)| *word == text) {
            return Ok(*value);
        }
        Err(self.unknown(text, words.iter().map(|(word, _)| *word)))
    }

    /// The error for a name that is not known.
    pub(super) fn unknown<'n>(
        &self,
        name: &str,
        known: impl Iterator<Item = &'n str> + Clone,
    ) -> Error {
        let all = || {
            let words: Vec<&str> = known.clone().take(30).collect();
            format!("known are: {}", words.join(", "))
        };
        self.error(format!("unknown `{name}`"), did_you_mean(name, known.clone(), all))
    }

    pub(super) fn numbers(&self) -> Result<Vec<f64>, Error> {
        self.list()?.iter().map(Self::number).collect()
    }

    pub(super) fn some<const N: usize>(&self) -> Result<[f64; N], Error> {
        let numbers = self.numbers()?;
        numbers
            .try_into()
            .map_err(|_| self.error(format!("there are not {N} numbers"), "give them"))
    }

    pub(super) fn vector(&self) -> Result<Vec3, Error> {
        self.some::<3>().map(Vec3::from)
    }

    pub(super) fn vectors(&self) -> Result<Vec<Vec3>, Error> {
        self.list()?.iter().map(Self::vector).collect()
    }

    /// Three rows of four numbers.
    pub(super) fn frame(&self) -> Result<Affine, Error> {
        let rows = self.rows::<4>()?;
        let column = |c: usize| Vec3::new(rows[0][c], rows[1][c], rows[2][c]);
        Ok(Affine::new(Mat3::from_columns(column(0), column(1), column(2)), column(3)))
    }

    /// Three rows of three numbers.
    pub(super) fn matrix(&self) -> Result<Mat3, Error> {
        let [x, y, z] = self.rows::<3>()?.map(Vec3::from);
        Ok(Mat3::from_columns(x, y, z).transpose())
    }

    fn rows<const N: usize>(&self) -> Result<[[f64; N]; 3], Error> {
        let rows: Vec<[f64; N]> =
            self.list()?.iter().map(Self::some::<N>).collect::<Result<_, _>>()?;
        rows.try_into().map_err(|_| self.error("there are not three rows", "give three"))
    }

    fn knots(&self) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let knots = self.key("knots")?.list()?;
        let pairs: Vec<[f64; 2]> = knots.iter().map(Self::some::<2>).collect::<Result<_, _>>()?;
        Ok(pairs.into_iter().map(|[x, y]| (x, y)).unzip())
    }

    pub(super) fn spline(&self) -> Result<SimmSpline, Error> {
        self.key("kind")?.word(&[("simm_spline", ())])?;
        let (x, y) = self.knots()?;
        SimmSpline::new(x, y).map_err(|error| self.error(error, "correct its knots"))
    }

    /// Three splines, for x, y and z.
    pub(super) fn path(&self) -> Result<Box<[SimmSpline; 3]>, Error> {
        let splines: Vec<SimmSpline> =
            self.list()?.iter().map(Self::spline).collect::<Result<_, _>>()?;
        let path = splines.try_into();
        path.map(Box::new).map_err(|_| self.error("there are not three splines", "give x, y and z"))
    }

    pub(super) fn function(&self) -> Result<Function, Error> {
        let curve = match self.key("kind")?.text()? {
            "constant" => Curve::Constant(self.key("value")?.number()?),
            "linear" => Curve::Linear {
                slope: self.key("slope")?.number()?,
                intercept: self.key("intercept")?.number()?,
            },
            "polynomial" => {
                Curve::Polynomial(Polynomial::from_ascending(self.key("coefficients")?.numbers()?))
            }
            "piecewise_linear" => {
                let (x, y) = self.knots()?;
                let lines = PiecewiseLinear::new(x, y);
                Curve::PiecewiseLinear(
                    lines.map_err(|error| self.error(error, "correct its knots"))?,
                )
            }
            "simm_spline" => Curve::SimmSpline(self.spline()?),
            other => {
                let known = ["constant", "linear", "polynomial", "piecewise_linear", "simm_spline"];
                return Err(self.unknown(other, known.into_iter()));
            }
        };
        let factor = self.perhaps("factor").map_or(Ok(1.0), |factor| factor.number())?;
        Ok(Function { factor, curve })
    }

    pub(super) fn function_of_several(&self) -> Result<FunctionOfSeveral, Error> {
        match self.key("kind")?.text()? {
            "linear" => Ok(FunctionOfSeveral::Linear {
                slopes: self.key("slopes")?.numbers()?,
                intercept: self.key("intercept")?.number()?,
            }),
            "polynomial" => {
                let [dimension, order] =
                    [self.key("dimension")?.count()?, self.key("order")?.count()?];
                let coefficients = self.key("coefficients")?.numbers()?;
                let (dimension, order) = (dimension as usize, order as usize);
                MultivariatePolynomial::up_to_order(dimension, order, &coefficients)
                    .map(FunctionOfSeveral::Polynomial)
                    .map_err(|count| {
                        self.error(
                            format!("{} coefficients do not fit", coefficients.len()),
                            format!("this dimension and order have {count}; at most 16 variables, order 64"),
                        )
                    })
            }
            other => Err(self.unknown(other, ["linear", "polynomial"].into_iter())),
        }
    }
}
