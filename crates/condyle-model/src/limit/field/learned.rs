//! A learned limit as files hold it: whose rotation, from whom, and the field, which is made when it is first
//! asked for.

use super::dependent::{Dependence, Dependent, Given};
use super::{Field, Ground, Learned};
use std::sync::{Arc, OnceLock};

/// What people want to know of a learned limit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct About {
    /// Its name.
    pub name: String,
    /// The segment whose rotation is limited.
    pub child: String,
    /// The segment in which it is seen; `None` for the laboratory.
    pub reference: Option<String>,
    /// Where the rotations come from: recordings, a paper.
    pub source: String,
    /// Who was measured.
    pub population: String,
    /// How the frames of both segments are defined: a recipe, or a model and a joint of it.
    pub frames: String,
    /// A name for each take, or none.
    pub takes: Vec<String>,
}

/// A limit that was learned, or read and not made yet.
///
/// Making the field of 96³ nodes takes about a second; so that is done when [`LearnedLimit::field`] is first called.
#[derive(Clone, Debug)]
pub struct LearnedLimit {
    about: About,
    ground: Arc<Ground>,
    learned: Option<Learned>,
    field: OnceLock<Field>,
    make: fn(&Arc<Ground>) -> Field,
    depends: Option<Depends>,
}

/// How a dependence is made of the ground of its limit.
pub type MakeDependent = fn(&Ground, &Dependence) -> Dependent;

/// What a limit depends on, made or not yet.
#[derive(Clone, Debug)]
struct Depends {
    dependence: Arc<Dependence>,
    made: OnceLock<Dependent>,
    make: MakeDependent,
}

impl LearnedLimit {
    /// A limit that is made of its ground by a method when it is first asked for. `learned` is what a file
    /// says was learned.
    #[must_use]
    pub fn new(
        about: About,
        ground: Arc<Ground>,
        learned: Option<Learned>,
        make: fn(&Arc<Ground>) -> Field,
    ) -> Self {
        Self { about, ground, learned, field: OnceLock::new(), make, depends: None }
    }

    /// The same limit with its field, which is then not made again.
    #[must_use]
    pub fn with_field(self, field: Field) -> Self {
        Self { field: OnceLock::from(field), ..self }
    }

    /// The same limit, given the driver of each of its samples: it depends on another joint.
    #[must_use]
    pub fn depending_on(self, dependence: Dependence, make: MakeDependent) -> Self {
        let depends = Depends { dependence: Arc::new(dependence), made: OnceLock::new(), make };
        Self { depends: Some(depends), ..self }
    }

    /// What it depends on, without making anything; `None` if on nothing.
    #[must_use]
    pub fn dependence(&self) -> Option<&Dependence> {
        self.depends.as_ref().map(|depends| &*depends.dependence)
    }

    /// The limit with its driver, made when this is first called; `None` if it depends on nothing.
    #[must_use]
    pub fn given(&self) -> Option<Given<'_>> {
        let depends = self.depends.as_ref()?;
        let made = depends.made.get_or_init(|| (depends.make)(&self.ground, &depends.dependence));
        Some(Given { limit: self, dependence: &depends.dependence, made })
    }

    /// What people want to know of it.
    #[must_use]
    pub fn about(&self) -> &About {
        &self.about
    }

    /// What it is made of.
    #[must_use]
    pub fn ground(&self) -> &Arc<Ground> {
        &self.ground
    }

    /// The field; made when this is first called.
    #[must_use]
    pub fn field(&self) -> &Field {
        self.field.get_or_init(|| (self.make)(&self.ground))
    }

    /// Whether the field was made already.
    #[must_use]
    pub fn is_made(&self) -> bool {
        self.field.get().is_some()
    }

    /// What its file says was learned, without making the field.
    #[must_use]
    pub fn stated(&self) -> Option<&Learned> {
        self.learned.as_ref()
    }

    /// What was learned, in numbers: as its file says, else of the field.
    #[must_use]
    pub fn learned(&self) -> &Learned {
        self.learned.as_ref().unwrap_or_else(|| self.field().learned())
    }
}

/// Equal are limits of equal ground and description: what it is made of and what is said of it.
impl PartialEq for LearnedLimit {
    fn eq(&self, other: &Self) -> bool {
        self.about == other.about
            && self.ground == other.ground
            && self.dependence() == other.dependence()
    }
}
