//! Laws that couple coordinates, learned from recordings: how the centre of a knee travels with its angles.
//!
//! ```text
//! d = c₀ + Σ cᵢ·tᵢ(a)        d a coordinate that follows, a those in control, t the terms of a basis
//! ```
//!
//! With the terms t = a this is the correlative joint of Pronost, Sandholm & Thalmann 2010 (equation 1; equation 2 where
//! the controls lie in other joints). [`learn()`] fits a law for each coordinate that follows by ordinary or ridge least
//! squares and says how far it can be believed:
//!
//! - frames of a trial are not independent, so intervals are clustered by trial: the sandwich of Bell & McCaffrey 2002
//!   (CR2) with Satterthwaite's degrees of freedom ([`Law::ci95`]);
//! - every trial is predicted by the law of the others, every subject by that of the others ([`LeftOut`]); a law is
//!   [accepted](Law::accepted) if it predicts trials that were left out better than the mean does, beyond chance;
//! - what the data do not determine is named: dropped terms, the condition number, the share that each control explains;
//! - the [region](condyle_model::component::Region) of the training angles is kept with the law;
//! - the criterion of Pronost et al. is told in both readings; it accepts noise ([`Validity`]).
//!
//! | module | what |
//! | --- | --- |
//! | `samples` | frames of trials, and which trials belong together |
//! | `basis` | terms of controls: linear, polynomials, splines |
//! | `design` | a factorised design, its parts by trial, intervals |
//! | `student` | the t distribution |
//! | `judged` | parts left out, acceptance, the criterion of 2010 |
//! | `compared` | laws for motions of a kind beside those for all |
//! | `split` | which coordinates control, where nobody says |
//! | `region` | where the training angles are |
//! | `law` | what is learned |
//! | `applied` | laws in a model |
//! | `scaled` | laws on a body of another size |

mod applied;
mod basis;
mod compared;
mod design;
mod judged;
mod law;
mod learn;
mod region;
mod samples;
mod scaled;
mod split;
mod student;

pub use applied::apply;
pub(crate) use applied::leader;
pub use basis::{Basis, LawFunction};
pub use compared::{Scope, Scoped};
pub use judged::{LeftOut, Validity};
pub use law::{About, Law, Laws, TrialOf};
pub use learn::{Settings, learn};
pub use region::region_of;
pub use samples::{Groups, Samples, Trial};
pub use scaled::{ScaleRule, SizeRatios, of_opposite, scaled};
pub use split::{Split, split};
pub use student::{quantile as t_quantile, share as t_share};
