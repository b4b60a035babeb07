//! The reach cone that is nearest to a field: N directions, each with a range of twist.
//!
//! Corners stand on N even meridians about the bone's direction in the middle rotation, and along a meridian twists go from
//! those at the middle to those at the corner as our [`Cone`] has it. What is fitted are the angle of each corner and its two
//! twists, and the two at the middle: corner by corner over all angles and twists, then in ever smaller steps. While fitting,
//! the boundary between two corners is the great arc, cot ρ(ψ) = (cot ρ₁·sin(ψ₂-ψ) + cot ρ₂·sin(ψ-ψ₁))/sin(ψ₂-ψ₁), and
//! twists on it are taken as linear in ψ; losses are those of the [`Cone`] itself.

use super::fitting::{DEAR, ROOM};
use super::{Aim, ConeTwist, EngineError, Law, Parted, Region, inside};
use condyle_math::{Quat, Vec3};
use condyle_model::limit::{Cone, ConePoint, Projection};
use std::f64::consts::{PI, TAU};

/// A spherical polygon of directions with ranges of twist, about a middle rotation.
#[derive(Clone, Debug, PartialEq)]
pub struct ReachCone {
    /// The rotation of the child in its reference in which the bone points to the cone's rest, without twist.
    pub middle: Quat,
    /// The limit of middle⁻¹·R; its rest is the bone's direction in the child.
    pub cone: Cone,
}

impl ReachCone {
    /// Whether a rotation of the child in its reference is allowed.
    #[must_use]
    pub fn allows(&self, rotation: Quat) -> bool {
        let relative = (self.middle.conjugate() * rotation).to_mat3();
        let direction = relative * self.cone.rest().normalized();
        self.cone.contains(direction)
            && self.cone.rows(relative)[1..].iter().all(|(g, _)| *g >= 0.0)
    }
}

/// The least and the largest angle of a corner from the middle.
const LEAST: f64 = 0.02;
const LARGEST: f64 = 176.0 * PI / 180.0;

#[derive(Clone, Copy, Debug)]
struct Corner {
    angle: f64,
    twist: [f64; 2],
}

/// A rotation in polar angles of its swing.
#[derive(Clone, Copy)]
struct Polar {
    angle: f64,
    /// The part of the way from one corner's meridian to the next.
    part: f64,
    twist: f64,
    inside: bool,
    weight: f64,
}

/// The reach cone of so many directions that is nearest to a region, about the middle and in the frame of a fitted cone.
///
/// # Errors
/// [`EngineError`].
pub fn reach_cone(
    region: &Region,
    distance: &dyn Fn(Quat) -> f64,
    about: &ConeTwist,
    directions: usize,
    aim: Aim,
) -> Result<ReachCone, EngineError> {
    if !(6..=256).contains(&directions) {
        return Err(EngineError::Directions);
    }
    let sectors = sectors(region, about, directions, aim);
    let dear = if aim == Aim::Inside { DEAR } else { 1.0 };
    let mut fit =
        Fit { corners: begun(about, directions), rest: [-about.twist, about.twist], sectors, dear };
    for _ in 0..2 {
        fit.scan();
        fit.scan_rest();
    }
    for step in [0.12, 0.06, 0.03, 0.015, 0.0075] {
        fit.refine(step);
    }
    let mut found = fit.cone(about)?;
    if aim == Aim::Inside {
        for _ in 0..200 {
            let beyond = inside::beyond(&found, about.in_child, distance);
            if beyond.is_empty() {
                return Ok(found);
            }
            fit.shrink(&beyond);
            found = fit.cone(about)?;
        }
        return Err(EngineError::NoneInside);
    }
    Ok(found)
}

/// The swing of polar angles: azimuth from y toward z of where the bone goes.
///
/// A swing by the rotation vector (0, θ_y, θ_z) moves x toward (0, θ_z, -θ_y).
fn azimuth([y, z]: [f64; 2]) -> f64 {
    (-y).atan2(z).rem_euclid(TAU)
}

fn sectors(region: &Region, about: &ConeTwist, directions: usize, aim: Aim) -> Vec<Vec<Polar>> {
    let back = about.in_reference().conjugate();
    let room = if aim == Aim::Inside { ROOM } else { 0.0 };
    let mut sectors = vec![vec![]; directions];
    for place in &region.fitted {
        let parted = Parted::of(back * place.rotation * about.in_child);
        let vector = parted.vector();
        let along = azimuth(vector) / TAU * directions as f64;
        let sector = (along as usize).min(directions - 1);
        sectors[sector].push(Polar {
            angle: vector[0].hypot(vector[1]),
            part: along - sector as f64,
            twist: parted.twist,
            inside: place.distance >= room,
            weight: place.weight,
        });
    }
    sectors
}

fn begun(about: &ConeTwist, directions: usize) -> Vec<Corner> {
    (0..directions)
        .map(|i| {
            let (s, c) = (TAU * i as f64 / directions as f64).sin_cos();
            // At this azimuth the rotation vector is along (-s, c).
            let [a, b] = match about.law {
                Law::MujocoBall => [about.swing[0]; 2],
                _ => about.swing,
            };
            let angle = 1.0 / (s / a).hypot(c / b);
            let twist = if about.law.twists() { about.twist } else { about.swing[0] };
            Corner { angle: angle.clamp(LEAST, LARGEST), twist: [-twist, twist] }
        })
        .collect()
}

struct Fit {
    corners: Vec<Corner>,
    rest: [f64; 2],
    sectors: Vec<Vec<Polar>>,
    dear: f64,
}

/// How twists go from the middle to the boundary.
fn eased(rho: f64) -> f64 {
    let rho = rho.clamp(0.0, 1.0);
    rho * rho * (3.0 - 2.0 * rho)
}

impl Fit {
    fn cost_of(&self, place: &Polar, first: &Corner, second: &Corner, width: f64) -> f64 {
        let (a, b) = (place.part * width, (1.0 - place.part) * width);
        let cotangent = (b.sin() / first.angle.tan() + a.sin() / second.angle.tan()) / width.sin();
        let reach = 1f64.atan2(cotangent);
        let allowed = place.angle <= reach && {
            let s = eased(place.angle / reach);
            let bound = |i: usize| {
                let edge = (1.0 - place.part) * first.twist[i] + place.part * second.twist[i];
                (1.0 - s) * self.rest[i] + s * edge
            };
            bound(0) <= place.twist && place.twist <= bound(1)
        };
        match (allowed, place.inside) {
            (true, false) => self.dear * place.weight,
            (false, true) => place.weight,
            _ => 0.0,
        }
    }

    fn cost_in(&self, sector: usize) -> f64 {
        let next = (sector + 1) % self.corners.len();
        let width = TAU / self.corners.len() as f64;
        let (first, second) = (&self.corners[sector], &self.corners[next]);
        self.sectors[sector].iter().map(|p| self.cost_of(p, first, second, width)).sum()
    }

    /// What depends on a corner.
    fn cost_at(&self, corner: usize) -> f64 {
        let count = self.corners.len();
        self.cost_in(corner) + self.cost_in((corner + count - 1) % count)
    }

    fn whole(&self) -> f64 {
        (0..self.corners.len()).map(|sector| self.cost_in(sector)).sum()
    }

    /// Each corner by itself over all angles and twists, as if it held for its whole sectors.
    fn scan(&mut self) {
        let count = self.corners.len();
        let degree = PI / 180.0;
        let places: Vec<Vec<Polar>> = (0..count)
            .map(|corner| {
                let before = (corner + count - 1) % count;
                let near = self.sectors[corner].iter().filter(|p| p.part < 0.5);
                let other = self.sectors[before].iter().filter(|p| p.part >= 0.5);
                near.chain(other).step_by(2).copied().collect()
            })
            .collect();
        for (corner, places) in places.iter().enumerate() {
            let mut best = (f64::INFINITY, self.corners[corner]);
            // Where nothing is inside, whatever is smallest.
            for step in 0..36 {
                let angle = if step == 0 { LEAST } else { 5.0 * degree * f64::from(step) };
                // What is beyond does not depend on the twist.
                let near: Vec<(f64, &Polar)> = places
                    .iter()
                    .filter(|p| p.angle <= angle)
                    .map(|p| (eased(p.angle / angle), p))
                    .collect();
                let beyond: f64 =
                    places.iter().filter(|p| p.angle > angle && p.inside).map(|p| p.weight).sum();
                let middle = 0.5 * (self.rest[0] + self.rest[1]);
                let end = |i: usize| {
                    let side = if i == 0 { -1.0 } else { 1.0 };
                    let mut best = (f64::INFINITY, 0.0);
                    for turn in 0..=30 {
                        let twist = middle + side * 6.0 * degree * f64::from(turn);
                        let cost: f64 = near
                            .iter()
                            .filter(|(_, p)| side * (p.twist - middle) >= 0.0)
                            .map(|(s, p)| {
                                let bound = (1.0 - s) * self.rest[i] + s * twist;
                                match (side * (bound - p.twist) >= 0.0, p.inside) {
                                    (true, false) => self.dear * p.weight,
                                    (false, true) => p.weight,
                                    _ => 0.0,
                                }
                            })
                            .sum();
                        if cost < best.0 {
                            best = (cost, twist.clamp(-PI, PI));
                        }
                    }
                    best
                };
                let (low, high) = (end(0), end(1));
                let cost = beyond + low.0 + high.0;
                if cost < best.0 {
                    best = (cost, Corner { angle: angle.min(LARGEST), twist: [low.1, high.1] });
                }
            }
            self.corners[corner] = best.1;
        }
    }

    /// The twists at the middle, in steps.
    fn scan_rest(&mut self) {
        for step in [0.3, 0.1, 0.03] {
            self.refine_rest(step);
        }
    }

    fn refine_rest(&mut self, step: f64) {
        for end in 0..2 {
            let mut best = self.whole();
            for sign in [-1.0, 1.0] {
                for _ in 0..12 {
                    let before = self.rest;
                    self.rest[end] = (self.rest[end] + sign * step).clamp(-PI, PI);
                    let cost =
                        if self.rest[0] <= self.rest[1] { self.whole() } else { f64::INFINITY };
                    if cost < best {
                        best = cost;
                    } else {
                        self.rest = before;
                        break;
                    }
                }
            }
        }
    }

    /// All numbers in steps of this size, as long as the cost falls.
    fn refine(&mut self, step: f64) {
        for _ in 0..3 {
            let mut changed = false;
            for corner in 0..self.corners.len() {
                let mut best = self.cost_at(corner);
                for number in 0..3 {
                    for sign in [-1.0, 1.0] {
                        let before = self.corners[corner];
                        let now = &mut self.corners[corner];
                        match number {
                            0 => now.angle = (now.angle + sign * step).clamp(LEAST, LARGEST),
                            n => {
                                let twist = &mut now.twist[n - 1];
                                *twist = (*twist + sign * step).clamp(-PI, PI);
                            }
                        }
                        let good = now.twist[0] <= now.twist[1];
                        let cost = if good { self.cost_at(corner) } else { f64::INFINITY };
                        if cost < best {
                            best = cost;
                            changed = true;
                        } else {
                            self.corners[corner] = before;
                        }
                    }
                }
            }
            self.refine_rest(step);
            if !changed {
                break;
            }
        }
    }

    /// A little less at the corners beside what is outside.
    fn shrink(&mut self, beyond: &[[f64; 3]]) {
        let count = self.corners.len();
        let mut hit = vec![[false; 3]; count];
        let mut rest = [false; 2];
        for [y, z, twist] in beyond {
            let sector = (azimuth([*y, *z]) / TAU * count as f64) as usize % count;
            let next = (sector + 1) % count;
            let reach = self.corners[sector].angle.max(self.corners[next].angle);
            let middle = 0.5 * (self.rest[0] + self.rest[1]);
            let end = usize::from(*twist > middle);
            let part = y.hypot(*z) / reach.max(1e-6);
            // In the inner half the twist at the middle decides, else that at the corner; the angle does everywhere.
            if part < 0.5 {
                rest[end] = true;
            }
            for corner in [sector, next] {
                hit[corner][1 + end] = true;
                hit[corner][0] |= part > 0.4;
            }
        }
        const LESS: f64 = 0.97;
        let middle = 0.5 * (self.rest[0] + self.rest[1]);
        for (corner, hit) in self.corners.iter_mut().zip(hit) {
            let own = 0.5 * (corner.twist[0] + corner.twist[1]);
            if hit[0] {
                corner.angle = (corner.angle * LESS).max(0.5 * LEAST);
            }
            for end in 0..2 {
                if hit[1 + end] {
                    corner.twist[end] = own + LESS * (corner.twist[end] - own);
                }
            }
        }
        for end in 0..2 {
            if rest[end] {
                self.rest[end] = middle + LESS * (self.rest[end] - middle);
            }
        }
    }

    fn cone(&self, about: &ConeTwist) -> Result<ReachCone, EngineError> {
        let frame = about.in_child.to_mat3();
        let count = self.corners.len() as f64;
        let points = self
            .corners
            .iter()
            .enumerate()
            .map(|(i, corner)| {
                let (s, c) = (TAU * i as f64 / count).sin_cos();
                let toward = Vec3::new(0.0, c, s);
                let direction = Vec3::X * corner.angle.cos() + toward * corner.angle.sin();
                ConePoint { direction: frame * direction, twist: Some(corner.twist) }
            })
            .collect();
        let cone = Cone::new(frame.x, Some(self.rest), points, 0, Projection::Nearest)
            .map_err(|_| EngineError::NoneInside)?;
        Ok(ReachCone { middle: about.middle, cone })
    }
}
