//! A motion defined by a user of the library: T = law(x₁, …, x₄).
//!
//! The law is one generic function, which posing, derivatives and tracking evaluate. Files store
//! its name and its parameters.

use super::{Contract, Geometry, Kind, Mirrored, MotionLaw, Port, PortType, Reflection};
use condyle_math::{Affine, Dual, Lane, Scalar};
use std::any::TypeId;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use super::MOST_LAW_INPUTS;

/// A dual number with a derivative for every input of a law.
pub type LawDual = Dual<MOST_LAW_INPUTS>;

/// The parameters of a [`Custom`] component: lists of numbers by name, in metres and radians.
pub type Parameters = BTreeMap<String, Vec<f64>>;

/// An object-safe [`MotionLaw`], in the form in which a [`Custom`] component stores it.
///
/// Blanket-implemented for every `MotionLaw` that is `Debug`, `Send` and `Sync`.
pub trait ErasedLaw: fmt::Debug + Send + Sync {
    /// The transform.
    fn at(&self, inputs: &[f64]) -> Affine;
    /// The transform with its derivatives.
    fn dual_at(&self, inputs: &[LawDual]) -> Affine<LawDual>;
    /// Whether it is rigid at all inputs; see [`MotionLaw::is_rigid`].
    fn is_rigid(&self) -> bool;
}

impl<L: MotionLaw + fmt::Debug + Send + Sync> ErasedLaw for L {
    fn at(&self, inputs: &[f64]) -> Affine {
        self.transform(inputs)
    }

    fn dual_at(&self, inputs: &[LawDual]) -> Affine<LawDual> {
        self.transform(inputs)
    }

    fn is_rigid(&self) -> bool {
        MotionLaw::is_rigid(self)
    }
}

/// A motion defined by a user's law.
#[derive(Clone, Debug)]
pub struct Custom {
    /// The name under which the law is registered.
    pub law: String,
    /// The parameters of the law.
    pub parameters: Parameters,
    motion: Arc<dyn ErasedLaw>,
}

impl PartialEq for Custom {
    fn eq(&self, other: &Self) -> bool {
        (&self.law, &self.parameters) == (&other.law, &other.parameters)
    }
}

impl Custom {
    pub(crate) const KIND: Kind = Kind {
        name: "custom",
        ports: &[Port::list("inputs", PortType::Scalar).at_most(MOST_LAW_INPUTS)],
    };
}

impl Contract for Custom {
    fn deforms(&self) -> bool {
        !self.motion.is_rigid()
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }

    fn mirror(&mut self, _: Reflection) -> Result<Mirrored, String> {
        Err(format!("the mirror image of law `{}` is not known: write both sides", self.law))
    }
}

impl Custom {
    /// The transform in one lane.
    fn transform_lane<L: Lane>(&self, inputs: &[L]) -> Affine<L> {
        // Without derivatives the plain evaluation is enough.
        if TypeId::of::<L>() == TypeId::of::<f64>() {
            let mut plain = [0.0; MOST_LAW_INPUTS];
            plain.iter_mut().zip(inputs).for_each(|(p, x)| *p = x.value());
            return self.motion.at(&plain[..inputs.len()]).cast();
        }
        // The law is known on `LawDual` only: its partial derivatives are applied to the inputs by
        // the chain rule. Exact for dual numbers, which are of first order.
        let mut duals = [LawDual::constant(0.0); MOST_LAW_INPUTS];
        for (i, (dual, input)) in duals.iter_mut().zip(inputs).enumerate() {
            *dual = LawDual::variable(input.value(), i);
        }
        let moved = self.motion.dual_at(&duals[..inputs.len()]);
        let lift = |d: LawDual| {
            let slopes = inputs.iter().zip(d.partials);
            slopes.fold(L::from_f64(d.value), |sum, (x, p)| sum + x.chain(|_| (0.0, p)))
        };
        Affine::from_columns(moved.to_columns().map(lift))
    }
}

impl MotionLaw for Custom {
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let mut all = [S::zero(); MOST_LAW_INPUTS];
        let n = inputs.len().min(MOST_LAW_INPUTS);
        all[..n].copy_from_slice(&inputs[..n]);
        let moved = S::lane_by_lane(all, |all| self.transform_lane(&all[..n]).to_columns());
        Affine::from_columns(moved)
    }

    fn is_rigid(&self) -> bool {
        self.motion.is_rigid()
    }
}

type Maker = dyn Fn(&Parameters) -> Result<Arc<dyn ErasedLaw>, String> + Send + Sync;

/// The laws that are available by name, so that files can refer to them.
///
/// ```
/// use condyle_math::{Affine, Mat3, Scalar, Vec3};
/// use condyle_model::component::{MotionLaw, Registry};
///
/// /// A cam: it rotates about z and lifts as it rotates.
/// #[derive(Debug)]
/// struct Cam { lift: f64 }
/// impl MotionLaw for Cam {
///     fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
///         let (s, c) = inputs[0].sin_cos();
///         let lift = (S::one() - c) * S::from_f64(self.lift);
///         let turn = Mat3::rotation_about(Vec3::Z.cast(), (s, c));
///         Affine::new(turn, Vec3::new(S::zero(), lift, S::zero()))
///     }
/// }
///
/// let mut registry = Registry::default();
/// registry.register("cam", &["angle"], |parameters| {
///     let lift = parameters.get("lift").and_then(|v| v.first());
///     Ok(Cam { lift: *lift.ok_or("it needs a `lift` in metres")? })
/// });
/// let parameters = [("lift".to_owned(), vec![0.02])].into();
/// let cam = registry.make("cam", parameters).unwrap();
/// assert_eq!(cam.transform(&[std::f64::consts::PI]).translation.y, 0.04);
/// ```
#[derive(Clone, Default)]
pub struct Registry {
    laws: BTreeMap<String, (Vec<String>, Arc<Maker>)>,
}

impl fmt::Debug for Registry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}

impl Registry {
    /// Adds a law under a name, with the names of its inputs and a function that makes it from its
    /// parameters.
    ///
    /// For invalid parameters `make` returns a sentence that describes the error. A law that is
    /// already registered under the same name is replaced.
    pub fn register<L: ErasedLaw + 'static>(
        &mut self,
        name: &str,
        inputs: &[&str],
        make: impl Fn(&Parameters) -> Result<L, String> + Send + Sync + 'static,
    ) {
        let make = move |p: &Parameters| make(p).map(|law| Arc::new(law) as Arc<dyn ErasedLaw>);
        let inputs = inputs.iter().map(|&input| input.to_owned()).collect();
        self.laws.insert(name.to_owned(), (inputs, Arc::new(make)));
    }

    /// The names of all laws.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.laws.keys().map(String::as_str)
    }

    /// The names of a law's inputs.
    pub fn inputs(&self, name: &str) -> Option<&[String]> {
        self.laws.get(name).map(|(inputs, _)| inputs.as_slice())
    }

    /// A registered law with these parameters.
    ///
    /// # Errors
    /// A sentence: the law is not registered, or the error of its `make` function.
    pub fn make(&self, name: &str, parameters: Parameters) -> Result<Custom, String> {
        let Some((_, make)) = self.laws.get(name) else {
            let known: Vec<&str> = self.names().collect();
            return Err(match known.is_empty() {
                true => format!("no law `{name}` is registered: none is, in this program"),
                false => format!("no law `{name}` is registered; there are: {}", known.join(", ")),
            });
        };
        let motion = make(&parameters)?;
        Ok(Custom { law: name.to_owned(), parameters, motion })
    }
}
