//! Evaluation of a chain: the product of its elementary steps.

use super::instruction::{Code, Frame, Step};
use super::pose::Pose;
use crate::component::{MOST_LAW_INPUTS, MotionLaw, shear};
use condyle_math::{Affine, Mat3, Quat, Scalar, Twist, Vec3};

/// An observer that is called for every elementary motion of a chain, to record its generator.
///
/// Twists are expressed in the base frame of the chain (the world, for segments), per unit of the
/// scalar that drives the motion.
pub(super) trait Recorder<S> {
    /// A rotation or translation by one scalar in `frame`, whose twist is `inside` expressed in
    /// `frame` and `outside` expressed in the base; the latter only if `frame` is rigid.
    fn motion(
        &mut self,
        frame: Affine<S>,
        inside: impl FnOnce() -> Twist<S>,
        outside: impl FnOnce() -> Twist<S>,
    );
    /// A scale or shear by the scalar `by` in `frame`; `rate` is the generator of its linear part
    /// there.
    fn deformation(&mut self, frame: Affine<S>, by: S, rate: impl FnOnce(f64) -> Mat3);
    /// A smooth law; `before` is the frame before it is multiplied.
    fn law(&mut self, code: &Code, law: u32, before: Affine<S>);
    /// A transform computed by an earlier instruction; `before` is the frame before it.
    fn transform(&mut self, of: Frame, before: Affine<S>);
    /// The inverse of an earlier, rigid transform; `before` is the frame before it.
    fn inverse(&mut self, of: Frame, inverse: Affine<S>, before: Affine<S>);
    /// A power of the rotation of an earlier transform; `before` is the frame before it.
    fn power(&mut self, of: Frame, exponent: f64, rotation: Mat3<S>, before: Affine<S>);
}

/// The observer that records nothing, for evaluation without derivatives.
pub(super) struct Silent;

impl<S> Recorder<S> for Silent {
    #[inline(always)]
    fn motion(&mut self, _: Affine<S>, _: impl FnOnce() -> Twist<S>, _: impl FnOnce() -> Twist<S>) {
    }
    #[inline(always)]
    fn deformation(&mut self, _: Affine<S>, _: S, _: impl FnOnce(f64) -> Mat3) {}
    #[inline(always)]
    fn law(&mut self, _: &Code, _: u32, _: Affine<S>) {}
    #[inline(always)]
    fn transform(&mut self, _: Frame, _: Affine<S>) {}
    #[inline(always)]
    fn inverse(&mut self, _: Frame, _: Affine<S>, _: Affine<S>) {}
    #[inline(always)]
    fn power(&mut self, _: Frame, _: f64, _: Mat3<S>, _: Affine<S>) {}
}

/// A rotation raised to a power p: exp(p·log R), without logarithm for 1, 0 and -1.
#[inline]
pub(super) fn power<S: Scalar>(rotation: Mat3<S>, exponent: f64) -> Mat3<S> {
    match exponent {
        1.0 => rotation,
        0.0 => Mat3::identity(),
        -1.0 => rotation.transpose(),
        _ => Quat::exp(rotation.log() * S::from_f64(exponent)).to_mat3(),
    }
}

/// The product of a base transform and the steps after it.
#[inline(always)]
pub(super) fn run_chain<S: Scalar, R: Recorder<S>>(
    code: &Code,
    steps: &[Step],
    base: Affine<S>,
    pose: &Pose<S>,
    recorder: &mut R,
) -> Affine<S> {
    let mut frame = base;
    for step in steps {
        let (r, origin) = (frame.linear, frame.translation);
        match *step {
            Step::Shift(offset) => frame = frame.shifted(offset.cast()),
            Step::Fixed(index) => frame = frame * code.fixed[index as usize].cast(),
            // A rotation keeps its own axis, so its twist is the same before and after it.
            Step::TurnX(turn) => {
                let inside = || Twist::rotation(Vec3::X.cast(), Vec3::zero());
                recorder.motion(frame, inside, || Twist::rotation(r.x, origin));
                frame.linear = r.rotated_x(pose.turn(turn));
            }
            Step::TurnY(turn) => {
                let inside = || Twist::rotation(Vec3::Y.cast(), Vec3::zero());
                recorder.motion(frame, inside, || Twist::rotation(r.y, origin));
                frame.linear = r.rotated_y(pose.turn(turn));
            }
            Step::TurnZ(turn) => {
                let inside = || Twist::rotation(Vec3::Z.cast(), Vec3::zero());
                recorder.motion(frame, inside, || Twist::rotation(r.z, origin));
                frame.linear = r.rotated_z(pose.turn(turn));
            }
            Step::TurnAbout { axis, turn } => {
                let axis: Vec3<S> = axis.cast();
                let inside = || Twist::rotation(axis, Vec3::zero());
                recorder.motion(frame, inside, || Twist::rotation(r * axis, origin));
                frame.linear = r * Mat3::rotation_about(axis, pose.turn(turn));
            }
            Step::Slide { axis, distance } => {
                // A translation keeps the axes, so `along` is the same before and after it.
                let along = r * axis.cast();
                let inside = || Twist::translation(axis.cast());
                recorder.motion(frame, inside, || Twist::translation(along));
                frame.translation = origin + along * pose.scalars[distance.index()];
            }
            Step::Move(distances) => {
                for (unit, along) in Vec3::UNITS.into_iter().zip([r.x, r.y, r.z]) {
                    let inside = || Twist::translation(unit.cast());
                    recorder.motion(frame, inside, || Twist::translation(along));
                }
                let [x, y, z] = distances.map(|distance| pose.scalars[distance.index()]);
                frame = frame.shifted(Vec3::new(x, y, z));
            }
            Step::Ball(orientation) => {
                let q = orientation.quaternion(&pose.scalars);
                frame.linear = r * Quat::from(q).to_mat3();
                // q ⊕ δ = q·exp(δ): the three directions rotate about the axes *after* the
                // rotation.
                let turned = frame.linear;
                for (unit, axis) in Vec3::UNITS.into_iter().zip([turned.x, turned.y, turned.z]) {
                    let inside = || Twist::rotation(unit.cast(), Vec3::zero());
                    recorder.motion(frame, inside, || Twist::rotation(axis, origin));
                }
            }
            Step::Transform(of) => {
                recorder.transform(of, frame);
                frame = frame * pose.transforms[of.index()];
            }
            _ => frame = rare_step(code, *step, frame, pose, recorder),
        }
    }
    frame
}

/// The steps that few joints have. Inlined, because a call would pass the frame through memory.
#[inline(always)]
fn rare_step<S: Scalar, R: Recorder<S>>(
    code: &Code,
    step: Step,
    mut frame: Affine<S>,
    pose: &Pose<S>,
    recorder: &mut R,
) -> Affine<S> {
    let (r, scalars) = (frame.linear, &pose.scalars);
    match step {
        Step::Stretch { along, factor } => {
            // The rate M′·M⁻¹ is expressed in the frame before the scale, as is that of a shear.
            let (along, factor) = (code.scales[along as usize], scalars[factor.index()]);
            recorder.deformation(frame, factor, |factor| along.rate(factor));
            frame.linear = r * along.matrix(factor);
        }
        Step::Shear { directions, amount } => {
            let [along, across] = code.shears[directions as usize];
            let amount = scalars[amount.index()];
            recorder.deformation(frame, amount, |amount| shear::rate(along, across, amount));
            frame.linear = r * shear::matrix(along, across, amount);
        }
        Step::Law(index) => {
            recorder.law(code, index, frame);
            let call = &code.laws[index as usize];
            let mut inputs = [S::zero(); MOST_LAW_INPUTS];
            for (value, &register) in inputs.iter_mut().zip(&call.inputs) {
                *value = scalars[register.index()];
            }
            frame = frame * call.law.transform(&inputs[..call.inputs.len()]);
        }
        Step::Inverse(of) => {
            let inverse = pose.transforms[of.index()].rigid_inverse();
            recorder.inverse(of, inverse, frame);
            frame = frame * inverse;
        }
        Step::Power { of, exponent } => {
            // The rotation only, about the origin of the current frame.
            let rotation = pose.transforms[of.index()].linear;
            recorder.power(of, exponent, rotation, frame);
            frame.linear = r * power(rotation, exponent);
        }
        _ => {}
    }
    frame
}
