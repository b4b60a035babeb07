//! Rotations of a child with the driver at each, thinned together.

use super::super::super::cloud::Gathered;
use super::super::super::spread::Spread;
use condyle_diagnostics::Error;
use condyle_math::Quat;
use condyle_model::limit::field::dependent::{Driver, Drivers};

/// Rotations of a child, of length 1, and the driver at each.
///
/// Two are as far apart as the angle between the rotations plus the slope times the distance of the drivers.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairs {
    /// The rotations.
    pub rotations: Vec<Quat>,
    /// The drivers.
    pub drivers: Drivers,
    /// The take of each, counted from 0.
    pub takes: Vec<u32>,
    /// What became of those that were given.
    pub gathered: Gathered,
}

impl Pairs {
    /// Those of several takes, so that no two are nearer than `spacing` in radians; of one not finite neither is used.
    ///
    /// # Errors
    /// `cloud/empty` if none is left; `given/pairs` where a take has not as many drivers as rotations, or drivers of another kind.
    pub fn gather(takes: &[(&[Quat], Drivers)], spacing: f64, slope: f64) -> Result<Self, Error> {
        let mut gathered = Gathered::default();
        let scalars = matches!(takes.first(), Some((_, Drivers::Scalars(_))) | None);
        let mut kept = if scalars { Drivers::Scalars(vec![]) } else { Drivers::Rotations(vec![]) };
        let (mut rotations, mut of): (Vec<Quat>, Vec<u32>) = (vec![], vec![]);
        let least = spacing.clamp(1e-6, 1.0);
        let mut spread = Spread::new(least);
        for (take, (given, drivers)) in (0u32..).zip(takes) {
            if given.len() != drivers.len() {
                let message = format!(
                    "{} rotations have {} values of the driver",
                    given.len(),
                    drivers.len()
                );
                return Err(Error::new("given/pairs", message));
            }
            for (index, q) in given.iter().enumerate() {
                gathered.given += 1;
                let norm = q.dot(*q).sqrt();
                let rotation = norm.is_finite() && norm > 1e-9;
                let Some(driver) = drivers.get(index).filter(|d| rotation && usable(d)) else {
                    gathered.unusable += 1;
                    continue;
                };
                let q = q.normalized();
                let mut near = false;
                spread.visit(q, |other| {
                    let other = other as usize;
                    let Some((p, at)) = rotations.get(other).zip(kept.get(other)) else {
                        return false;
                    };
                    near = p.angle_to(q) + slope * driver.distance(at) < least;
                    near
                });
                if near {
                    gathered.near += 1;
                    continue;
                }
                let index = u32::try_from(rotations.len()).map_err(|_| {
                    Error::new("cloud/size", "there are more than 4294967295 rotations")
                })?;
                if !push(&mut kept, driver) {
                    let message = "drivers are not all of one kind";
                    return Err(Error::new("given/pairs", message));
                }
                spread.insert(q, index);
                rotations.push(q);
                of.push(take);
            }
        }
        if rotations.is_empty() {
            let message = "there are no rotations with a value of the driver";
            return Err(Error::new("cloud/empty", message));
        }
        Ok(Self { rotations, drivers: kept, takes: of, gathered })
    }
}

/// Whether a value is one: finite, and a rotation of a length above 0.
fn usable(driver: &Driver) -> bool {
    match driver {
        Driver::Scalar(value) => value.is_finite(),
        Driver::Rotation(q) => q.dot(*q).is_finite() && q.dot(*q) > 1e-12,
    }
}

fn push(drivers: &mut Drivers, driver: Driver) -> bool {
    match (drivers, driver) {
        (Drivers::Scalars(values), Driver::Scalar(value)) => {
            values.push(value);
            true
        }
        (Drivers::Rotations(values), Driver::Rotation(q)) => {
            values.push(q.normalized());
            true
        }
        _ => false,
    }
}
