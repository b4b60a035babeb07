//! MJCF as far as it is written, evaluated as MuJoCo's documentation has it; MuJoCo's own answers are compared with it.

use condyle::formats::xml::{Element, XmlDocument};
use condyle::math::{Affine, Mat3, Quat, Vec3};
use std::collections::HashMap;

/// The transforms of all bodies in the file's world, where these joints are set and the others follow.
pub(crate) fn bodies(text: &str, set: &[(String, f64)]) -> HashMap<String, Affine> {
    let read = XmlDocument::parse(text).unwrap().value;
    let root = read.root();
    let mut values: HashMap<String, f64> = set.iter().cloned().collect();
    follow(root, &mut values);
    let mut all = HashMap::new();
    let world = root.child("worldbody").unwrap();
    let mut open: Vec<(Element<'_>, Affine)> =
        world.children_named("body").map(|body| (body, Affine::IDENTITY)).collect();
    while let Some((body, above)) = open.pop() {
        let mut here = above * Affine::new(turn(body).to_mat3(), vector(body, "pos"));
        for joint in body.children_named("joint") {
            let value = values[joint.attribute("name").unwrap()];
            let axis = vector(joint, "axis").normalized();
            let at = Affine::from_translation(vector(joint, "pos"));
            here = here
                * match joint.attribute("type") {
                    Some("slide") => Affine::from_translation(axis * value),
                    Some("hinge") => {
                        let turn = Mat3::rotation_about(axis, value.sin_cos());
                        at * Affine::from_rotation(turn) * at.rigid_inverse()
                    }
                    other => panic!("a joint of the type {other:?}"),
                };
        }
        all.insert(body.attribute("name").unwrap().to_owned(), here);
        open.extend(body.children_named("body").map(|child| (child, here)));
    }
    all
}

/// Joints that follow others, by polynomials, and by sums that tendons hold.
fn follow(root: Element<'_>, values: &mut HashMap<String, f64>) {
    let Some(equalities) = root.child("equality") else { return };
    let mut open: Vec<Element<'_>> =
        equalities.children().filter(|e| e.is("joint") || e.is("tendon")).collect();
    while !open.is_empty() {
        let before = open.len();
        open.retain(|equality| {
            let numbers = numbers(*equality, "polycoef");
            let named = |name: &str| equality.attribute(name).unwrap();
            if equality.is("joint") {
                let Some(&x) = values.get(named("joint2")) else { return true };
                let y = numbers.iter().rev().fold(0.0, |sum, c| sum * x + c);
                values.insert(named("joint1").to_owned(), y);
                return false;
            }
            let tendons = root.child("tendon").unwrap();
            let tendon = tendons
                .children_named("fixed")
                .find(|tendon| tendon.attribute("name") == Some(named("tendon1")))
                .unwrap();
            let parts: Vec<(&str, f64)> = tendon
                .children_named("joint")
                .map(|j| (j.attribute("joint").unwrap(), self::numbers(j, "coef")[0]))
                .collect();
            let ((own, factor), others) = parts.split_first().unwrap();
            let mut sum = numbers[0];
            for (name, factor) in others {
                let Some(x) = values.get(*name) else { return true };
                sum -= factor * x;
            }
            values.insert((*own).to_owned(), sum / factor);
            false
        });
        assert!(open.len() < before, "equalities in a circle");
    }
}

fn numbers(element: Element<'_>, name: &str) -> Vec<f64> {
    let text = element.attribute(name).unwrap_or_default();
    text.split_whitespace().map(|x| x.parse().unwrap()).collect()
}

fn vector(element: Element<'_>, name: &str) -> Vec3 {
    let [x, y, z] = numbers(element, name)[..] else { return Vec3::ZERO };
    Vec3::new(x, y, z)
}

fn turn(element: Element<'_>) -> Quat {
    let [w, x, y, z] = numbers(element, "quat")[..] else { return Quat::IDENTITY };
    Quat::from([x, y, z, w]).normalized()
}
