//! Masses and inertias.
//!
//! With a mass m before and m' after, an inertia of equal factors s is multiplied by m'/m · s². With
//! unequal ones OpenSim takes the body as a cylinder about one of its ends: its axis is that of the least
//! moment I = m r²/2, its length that of another moment m (L²/3 + r²/4). Then L grows along the axis,
//! r² by the product of the other two factors, and products of inertia by m'/m and the factors of
//! their axes.

use super::report::ScaledBody;
use super::{Scaling, written};
use crate::xml::Element;
use condyle_diagnostics::Error;

/// The names of the six numbers in files before version 3.
const SINGLE: [&str; 6] =
    ["inertia_xx", "inertia_yy", "inertia_zz", "inertia_xy", "inertia_xz", "inertia_yz"];

/// Below this a mass is none (kilograms).
const NO_MASS: f64 = f64::EPSILON;

/// What moves with difficulty: mass and moments.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Inertia {
    mass: f64,
    /// xx, yy, zz, xy, xz, yz.
    moments: [f64; 6],
}

impl Inertia {
    /// The inertia of a body that is stretched by three factors, its mass by their product or not at all.
    fn stretched(self, f: [f64; 3], grows: bool) -> Self {
        let growth = if grows { f.iter().product::<f64>().abs() } else { 1.0 };
        let mass = self.mass * growth;
        let Self { mass: old, mut moments } = self;
        if mass <= NO_MASS {
            return Self { mass, moments: [0.0; 6] };
        }
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-14 * a.abs().max(b.abs()).max(1.0);
        if near(f[0], f[1]) && near(f[1], f[2]) {
            return Self { mass, moments: moments.map(|i| i * growth * f[0] * f[0]) };
        }
        // The first of the least moments.
        let mut axis = 0;
        for other in [1, 2] {
            if moments[other] < moments[axis] {
                axis = other;
            }
        }
        let across = if axis == 0 { 1 } else { 0 };
        let radius_squared = (2.0 * moments[axis] / old).max(0.0);
        let length_squared = (3.0 * (moments[across] / old - 0.25 * radius_squared)).max(0.0);
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let radius_squared = radius_squared * f[b] * f[c];
        let length_squared = length_squared * f[axis] * f[axis];
        for (i, moment) in moments.iter_mut().take(3).enumerate() {
            *moment = match i == axis {
                true => 0.5 * mass * radius_squared,
                false => mass * (length_squared / 3.0 + 0.25 * radius_squared),
            };
        }
        for (i, (a, b)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            moments[3 + i] *= growth * f[a] * f[b];
        }
        Self { mass, moments }
    }

    fn times(self, factor: f64) -> Self {
        Self { mass: self.mass * factor, moments: self.moments.map(|i| i * factor) }
    }
}

impl<'d> Scaling<'d, '_, '_> {
    /// Mass centres, masses and inertias of all bodies.
    pub(super) fn bodies(&mut self) -> Result<(), Error> {
        let bodies: Vec<_> = self.frames.bodies().collect();
        let mut scaled = vec![];
        for (element, base) in bodies {
            let factors = self.factor(base);
            if self.triple(element, "mass_center", factors)? {
                self.report.count("mass centres");
            }
            let mass = element.child_f64("mass")?;
            let inertia = mass.map(|mass| -> Result<_, Error> {
                let before = Inertia { mass, moments: moments(element)? };
                let after = before.stretched(factors.to_array(), !self.rules.preserve_mass);
                Ok((before, after))
            });
            scaled.push((element, factors, inertia.transpose()?));
        }
        let total: f64 = scaled.iter().filter_map(|(_, _, i)| Some(i.as_ref()?.1.mass)).sum();
        let share = match self.rules.mass {
            Some(mass) if total > 0.0 => mass / total,
            _ => 1.0,
        };
        for (element, factors, inertia) in scaled {
            let inertia = inertia.map(|(before, after)| (before, after.times(share)));
            if let Some((before, after)) = inertia {
                self.weigh(element, before, after);
            }
            self.report.bodies.push(ScaledBody {
                name: element.attribute("name").unwrap_or_default().to_owned(),
                factors: factors.to_array(),
                mass: inertia.map(|(before, after)| [before.mass, after.mass]),
            });
        }
        Ok(())
    }

    fn weigh(&mut self, element: Element<'d>, before: Inertia, after: Inertia) {
        if before == after {
            return;
        }
        if let Some(mass) = element.child("mass") {
            self.edits.set_text(mass, &written(&[after.mass]));
        }
        self.report.count("masses and inertias");
        if let Some(six) = element.child("inertia").filter(|e| !e.text().is_empty()) {
            self.edits.set_text(six, &written(&after.moments));
        }
        for (name, moment) in SINGLE.iter().zip(after.moments) {
            if let Some(one) = element.child(name).filter(|e| !e.text().is_empty()) {
                self.edits.set_text(one, &written(&[moment]));
            }
        }
    }
}

/// The six moments of a body, however its version states them; 0 where it does not.
fn moments(element: Element<'_>) -> Result<[f64; 6], Error> {
    if let Some(six) = element.child_numbers::<6>("inertia")? {
        return Ok(six);
    }
    let mut six = [0.0; 6];
    for (moment, name) in six.iter_mut().zip(SINGLE) {
        *moment = element.child_f64(name)?.unwrap_or(0.0);
    }
    Ok(six)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cylinder of radius 0.05 m and length 0.4 m about one end, along y.
    fn cylinder(mass: f64, radius: f64, length: f64) -> Inertia {
        let across = mass * (length * length / 3.0 + radius * radius / 4.0);
        let moments = [across, mass * radius * radius / 2.0, across, 0.0, 0.0, 0.0];
        Inertia { mass, moments }
    }

    #[test]
    fn a_cylinder_becomes_the_longer_cylinder() {
        let longer = cylinder(3.0, 0.05, 0.4).stretched([1.2, 1.5, 1.2], true);
        let right = cylinder(3.0 * 1.2 * 1.2 * 1.5, 0.06, 0.6);
        assert!((longer.mass - right.mass).abs() < 1e-12);
        for (a, b) in longer.moments.iter().zip(right.moments) {
            assert!((a - b).abs() < 1e-12, "{longer:?} {right:?}");
        }
    }

    #[test]
    fn equal_factors_scale_by_the_fifth_power_or_the_square() {
        let body = Inertia { mass: 2.0, moments: [0.3, 0.2, 0.4, 0.01, -0.02, 0.03] };
        for (grows, power) in [(true, 5), (false, 2)] {
            let larger = body.stretched([1.1; 3], grows);
            for (a, b) in larger.moments.iter().zip(body.moments) {
                assert!((a - b * 1.1f64.powi(power)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn what_has_no_mass_has_no_inertia() {
        let none = Inertia { mass: 0.0, moments: [1.0; 6] }.stretched([1.0, 2.0, 1.0], true);
        assert_eq!(none.moments, [0.0; 6]);
    }
}
