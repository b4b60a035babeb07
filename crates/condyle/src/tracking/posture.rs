//! What a model says of its posture, as targets.

use condyle_model::{Model, PostureTerm};
use condyle_track::PostureTarget;

/// The posture terms of a model.
pub(crate) fn of_model(model: &Model) -> impl Iterator<Item = PostureTarget> + '_ {
    model.postures().iter().map(target)
}

/// Adds the posture terms of a model before those that were asked for; a single coordinate that was asked
/// for is held as asked.
pub(super) fn add(model: &Model, targets: &mut Vec<PostureTarget>) {
    let asked = |own: &PostureTarget| {
        let [(own, _)] = own.terms[..] else { return false };
        targets.iter().any(|t| matches!(t.terms[..], [(asked, _)] if asked == own))
    };
    let own: Vec<PostureTarget> = of_model(model).filter(|own| !asked(own)).collect();
    targets.splice(0..0, own);
}

fn target(term: &PostureTerm) -> PostureTarget {
    PostureTarget { terms: term.sum.clone(), rest: term.rest, stiffness: term.stiffness }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Vec3;
    use condyle_model::{CoordinateId, ModelBuilder};

    #[test]
    fn what_is_asked_of_a_coordinate_replaces_what_the_model_says_of_it() {
        let mut b = ModelBuilder::new("arm");
        let arm = b.segment("arm", None);
        let hand = b.segment("hand", Some(arm));
        let (_, first) = b.hinge("elbow", arm, "elbow", Vec3::Z);
        let (_, second) = b.hinge("wrist", hand, "wrist", Vec3::Z);
        let term = |name: &str, sum: Vec<(CoordinateId, f64)>, stiffness| PostureTerm {
            name: name.to_owned(),
            sum,
            rest: 0.1,
            stiffness,
            source: None,
        };
        b.posture(term("elbow", vec![(first, 1.0)], 1e-5));
        b.posture(term("wrist", vec![(second, 1.0)], 2e-5));
        b.posture(term("both", vec![(first, 1.0), (second, -0.5)], 3e-5));
        let model = b.build().unwrap();
        let asked = PostureTarget { terms: vec![(second, 2.0)], rest: 0.4, stiffness: 7e-5 };
        let mut targets = vec![asked.clone()];
        add(&model, &mut targets);
        let stiffnesses: Vec<f64> = targets.iter().map(|t| t.stiffness).collect();
        assert_eq!(stiffnesses, [1e-5, 3e-5, 7e-5]);
        assert_eq!(targets[1].terms, [(first, 1.0), (second, -0.5)]);
        assert_eq!(targets[2], asked);
    }
}
