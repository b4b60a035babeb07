//! Recording of generators while chains run.

use super::chain::Recorder;
use super::deformation::{NO_STRAIN, Rate, sum, times};
use super::derivative_plan::{DerivativePlan, Start, Term};
use super::instruction::{Code, ContactCall, Frame};
use super::rotation_rate::{exp_rate, log_rate};
use crate::component::{LawDual, MOST_LAW_INPUTS, MotionLaw};
use condyle_math::{Affine, Dual, Mat3, Twist, Vec3};

/// Accumulates unit motions to the twists of directions, in the order of the derivative plan.
///
/// A unit motion is the generator per unit of a scalar; its contribution to the twist of a
/// direction is multiplied by ∂scalar/∂direction. The plan knows the unit motions of each instruction.
pub(super) struct Tape<'a> {
    pub twists: &'a mut [Twist],
    pub strains: &'a mut [Mat3],
    /// Whether something in this chain is not rigid, so that its own twists have strains.
    pub deforming: bool,
    pub derivatives: &'a [f64],
    pub scalars: &'a [f64],
    pub plan: &'a DerivativePlan,
    /// The numbers of terms of the unit motions to come, and the terms.
    pub counts: std::slice::Iter<'a, u32>,
    pub terms: std::slice::Iter<'a, Term>,
}

impl Tape<'_> {
    #[inline(always)]
    fn emit(&mut self, twist: impl FnOnce() -> Twist) {
        // No direction moves this scalar: its twist need not be computed.
        let count = self.counts.next().copied().unwrap_or(0);
        if count == 0 {
            return;
        }
        let unit = twist();
        for _ in 0..count {
            let Some(term) = self.terms.next() else { return };
            let addend = unit * self.derivatives[term.derivative as usize];
            self.twists[term.twist as usize] = match term.start {
                Start::Zero => addend,
                Start::From(other) => self.twists[other as usize] + addend,
                Start::Add => self.twists[term.twist as usize] + addend,
            };
        }
    }

    /// The same as `emit`, for a chain whose twists have strains.
    fn emit_rate(&mut self, rate: impl FnOnce() -> Rate) {
        let count = self.counts.next().copied().unwrap_or(0);
        if count == 0 {
            return;
        }
        let (unit, unit_strain) = rate().split();
        for _ in 0..count {
            let Some(term) = self.terms.next() else { return };
            let factor = self.derivatives[term.derivative as usize];
            let (twist, strain) = match term.start {
                Start::Zero => (Twist::zero(), NO_STRAIN),
                Start::From(other) => (self.twists[other as usize], self.strain(other)),
                Start::Add => (self.twists[term.twist as usize], self.strain(term.twist)),
            };
            self.twists[term.twist as usize] = twist + unit * factor;
            if let Some(slot) = self.plan.strain_slot(term.twist) {
                self.strains[slot] = sum(strain, times(unit_strain, factor));
            }
        }
    }

    fn strain(&self, twist: u32) -> Mat3 {
        self.plan.strain_slot(twist).map_or(NO_STRAIN, |slot| self.strains[slot])
    }
}

/// A dual number with derivatives along six rigid motions (three rotations, three translations) and
/// two drivers.
type ContactDual = Dual<8>;

impl Tape<'_> {
    /// Evaluates a contact with its derivatives: the transform of its rotations, their two angles and
    /// two gaps, and the slopes of the gaps along the six motions of the frame and the two drivers.
    ///
    /// The derivatives along the six rigid motions of the segment's frame are computed once; that
    /// of a direction is their linear combination with the frame's twist as coefficients.
    pub(super) fn contact(
        &mut self,
        call: &ContactCall,
        frame: Affine,
    ) -> (Affine, [f64; 4], [[f64; 8]; 2]) {
        let number = |value: f64, partials: [f64; 6]| {
            let mut all = [0.0; 8];
            all[..6].copy_from_slice(&partials);
            ContactDual { value, partials: all }
        };
        let carried = |v: Vec3, slides: bool| {
            // Along motion k the vector changes by eₖ × v, a point also by eₖ itself.
            let turns = Vec3::UNITS.map(|e| e.cross(v).to_array());
            let part = |i: usize| {
                let slide = |k: usize| f64::from(u8::from(slides && k == i));
                [turns[0][i], turns[1][i], turns[2][i], slide(0), slide(1), slide(2)]
            };
            Vec3::new(number(v.x, part(0)), number(v.y, part(1)), number(v.z, part(2)))
        };
        // The columns of the rotation are vectors, the origin is a point.
        let m = frame.linear;
        let linear =
            Mat3::from_columns(carried(m.x, false), carried(m.y, false), carried(m.z, false));
        let moving = Affine::new(linear, carried(frame.translation, true));
        let mut drivers = [ContactDual::constant(0.0); 2];
        for (k, &driver) in call.drivers.iter().enumerate() {
            drivers[k] = ContactDual::variable(self.scalars[driver.index()], 6 + k);
        }
        let glide = call.law.glide(moving, &drivers[..call.drivers.len()]);
        let pick = |v: Vec3<ContactDual>, f: &dyn Fn(ContactDual) -> f64| {
            Vec3::new(f(v.x), f(v.y), f(v.z))
        };
        let whole = |f: &dyn Fn(ContactDual) -> f64| {
            let r = glide.rotation;
            Mat3::from_columns(pick(r.x, f), pick(r.y, f), pick(r.z, f))
        };
        let turns = Affine::from_rotation(whole(&|d| d.value));
        // The angular velocity of R along motion k, from Ṙ·Rᵀ.
        let spins: [Vec3; 8] = std::array::from_fn(|k| {
            let derivative = Affine::new(whole(&|d| d.partials[k]), Vec3::ZERO);
            Twist::from_derivative(turns, derivative).angular
        });
        let spin = |t: Twist| {
            let (w, l) = (t.angular, t.linear);
            let weights = [w.x, w.y, w.z, l.x, l.y, l.z];
            weights.into_iter().zip(spins).fold(Vec3::ZERO, |sum, (w, s)| sum + s * w)
        };
        // In the order of the plan: the directions of the frame, then the drivers.
        for &(_, twist) in self.plan.frame_entries(call.frame) {
            let inner = self.twists[twist as usize];
            self.emit(|| Twist::rotation(spin(inner), Vec3::ZERO));
        }
        for k in 0..call.drivers.len() {
            self.emit(|| Twist::rotation(spins[6 + k], Vec3::ZERO));
        }
        let [a, b] = glide.angles.map(|d| d.value);
        let [c, d] = glide.gaps.map(|d| d.value);
        (turns, [a, b, c, d], glide.gaps.map(|gap| gap.partials))
    }
}

impl Recorder<f64> for Tape<'_> {
    #[inline(always)]
    fn motion(
        &mut self,
        frame: Affine,
        inside: impl FnOnce() -> Twist,
        outside: impl FnOnce() -> Twist,
    ) {
        if self.deforming {
            self.emit_rate(|| Rate::new(inside(), NO_STRAIN).transformed(frame));
        } else {
            self.emit(outside);
        }
    }

    fn deformation(&mut self, frame: Affine, by: f64, rate: impl FnOnce(f64) -> Mat3) {
        self.emit_rate(|| Rate::of_linear(rate(by)).transformed(frame));
    }

    fn law(&mut self, code: &Code, law: u32, before: Affine) {
        // One evaluation on duals gives the derivatives with respect to all inputs.
        let call = &code.laws[law as usize];
        let mut inputs = [LawDual::constant(0.0); MOST_LAW_INPUTS];
        for (i, &register) in call.inputs.iter().enumerate() {
            inputs[i] = LawDual::variable(self.scalars[register.index()], i);
        }
        let moved = call.law.transform(&inputs[..call.inputs.len()]);
        let part = |v: Vec3<LawDual>, f: &dyn Fn(LawDual) -> f64| Vec3::new(f(v.x), f(v.y), f(v.z));
        let whole = |f: &dyn Fn(LawDual) -> f64| {
            let l = moved.linear;
            let linear = Mat3::from_columns(part(l.x, f), part(l.y, f), part(l.z, f));
            Affine::new(linear, part(moved.translation, f))
        };
        let value = whole(&|d| d.value);
        for i in 0..call.inputs.len() {
            let derivative = whole(&|d| d.partials[i]);
            if self.deforming {
                self.emit_rate(|| Rate::from_derivative(value, derivative).transformed(before));
            } else {
                self.emit(|| Twist::from_derivative(value, derivative).transformed(before));
            }
        }
    }

    fn inverse(&mut self, of: Frame, inverse: Affine, before: Affine) {
        // d(T⁻¹)/dt·T = -T⁻¹·V·T for the twist V of T.
        for &(_, twist) in self.plan.frame_entries(of) {
            let inner = self.twists[twist as usize].transformed(inverse) * -1.0;
            self.motion(before, || inner, || inner.transformed(before));
        }
    }

    fn power(&mut self, of: Frame, exponent: f64, rotation: Mat3, before: Affine) {
        // ±1 need no logarithm, and have no kink at a half turn.
        let plain = exponent == 1.0 || exponent == -1.0;
        let turn = if plain { Vec3::ZERO } else { rotation.log() };
        let raised = turn * exponent;
        for &(_, twist) in self.plan.frame_entries(of) {
            let spin = self.twists[twist as usize].angular;
            // The angular velocity of exp(p·ρ) is J(p·ρ)·p·J(ρ)⁻¹·ω, with J the left Jacobian of
            // SO(3). For p = -1, Rᵀ has the angular velocity -Rᵀ·ω.
            let moved = match exponent {
                1.0 => spin,
                -1.0 => -(rotation.transpose() * spin),
                _ => exp_rate(raised, log_rate(turn, spin) * exponent),
            };
            self.motion(
                before,
                || Twist::rotation(moved, Vec3::ZERO),
                || Twist::rotation(before.linear * moved, before.translation),
            );
        }
    }

    fn transform(&mut self, of: Frame, before: Affine) {
        // The twists of the earlier transform, in its own base, mapped by the adjoint of `before`.
        for &(_, twist) in self.plan.frame_entries(of) {
            let inner = self.twists[twist as usize];
            if self.deforming {
                let strain = self.strain(twist);
                self.emit_rate(|| Rate::new(inner, strain).transformed(before));
            } else {
                self.emit(|| inner.transformed(before));
            }
        }
    }
}
