//! What is drawn is what is enforced: places of every drawn limit, turned back into the numbers that they stand for, are within
//! 0.1 degrees of where these numbers begin to be changed or refused.

use super::super::figure::Figure;
use super::super::figure::tests::{model, seen};
use super::super::sweep::Sweep;
use super::twist::Twist;
use super::{arc, cone, ellipse, field};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::component::Swinging;
use condyle_model::evaluate::Bound;
use condyle_model::limit::Limit;
use condyle_model::{CoordinateId, CoordinateKind, Law, Mode, Model, Pose, Program};
use condyle_render::{Line, Scene, palette};
use std::f64::consts::TAU;

/// How far from the boundary is failing, in radians.
const NEAR: f64 = 0.1 * TAU / 360.0;

/// All shipped models, and two whose limits these do not have.
fn models() -> Vec<Model> {
    let shipped = crate::shipped::names().map(|name| {
        crate::shipped::read(name).unwrap_or_else(|e| panic!("{name}: {e}")).value.model
    });
    let mut models: Vec<Model> = shipped.collect();
    // A fist that flexes less the more the wrist is flexed, and what two coordinates make together.
    models.push(model(
        r#"
        condyle = 1
        kind = "model"
        angles = "deg"
        [segment.forearm]
        [segment.hand]
        parent = "forearm"
        at = [0, -0.25, 0]
        [segment.finger]
        parent = "hand"
        at = [0, -0.1, 0]
        [segment.tip]
        parent = "finger"
        at = [0, -0.05, 0]
        [joint_set.wrist]
        coordinate.wrist = { range = [-70, 80] }
        coordinate.fist = { range = [0, 100] }
        coordinate.out = { range = [-10, 40] }
        component.held.half_space = { inputs = ["wrist", "fist"], normal = [1, 1], bound = 1.9 }
        component.bend.rotate = { angle = "held", axis = [0, 0, 1] }
        component.close.rotate = { angle = "held.2", axis = [0, 0, 1] }
        component.sum.combine = { inputs = ["held", "out"], function = { slopes = [0.5, 1], intercept = 0 } }
        component.stop.half_space = { inputs = ["sum"], normal = [1], bound = 0.9 }
        output.hand = ["bend"]
        output.finger = ["close"]
        "#,
    ));
    models
}

/// A pose within all limits, at the defaults or beside them.
fn within(model: &Model, beside: bool) -> Vec<f64> {
    let mut asked = model.defaults();
    if beside {
        let step: Vec<f64> =
            (0..model.tangent_len()).map(|i| 0.05 + 0.02 * (i % 7) as f64).collect();
        model.retract(&model.defaults(), &step, &mut asked);
    }
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    for _ in 0..3 {
        crate::legal::evaluate(model, &program, &asked, &mut pose).expect("its length");
        asked = pose.effective().to_vec();
    }
    asked
}

/// Whether numbers are left as they are asked, move all segments so, and break nothing that is measured.
fn kept(figure: &Figure, pose: &mut Pose, asked: &[f64]) -> bool {
    figure.program.evaluate(asked, Mode::Posed, pose).expect("its length");
    let model = figure.model;
    let changed = model.coordinate_ids().any(|id| {
        let free = model.coordinate(id).follows.is_none();
        let range = model.stored_range(id);
        let mut pairs = asked[range.clone()].iter().zip(&pose.effective()[range]);
        free && pairs.any(|(a, b)| (a - b).abs() > 1e-7)
    });
    let mut open = Pose::new(figure.program);
    figure.program.evaluate(asked, Mode::Open, &mut open).expect("its length");
    // What is limited may be made of several coordinates, which then stay.
    let moved =
        pose.segments().iter().zip(open.segments()).any(|(a, b)| {
            a.to_rows().into_iter().zip(b.to_rows()).any(|(a, b)| (a - b).abs() > 1e-7)
        });
    let broken = |&row: &usize| {
        pose.limit_row(row) < -1e-7 && pose.limit_row(row) < figure.pose.limit_row(row) - 1e-7
    };
    !changed && !moved && !figure.program.measured_limit_rows().iter().any(broken)
}

fn drawn(scene: &Scene, width: f64) -> impl Iterator<Item = &Line> {
    scene.lines.iter().filter(move |l| l.colour == palette::LIMIT && l.width == width)
}

fn value(scene: &Scene) -> Option<[Vec3; 2]> {
    let line = scene.lines.iter().find(|l| l.colour == palette::VALUE)?;
    Some([line.points[0].into(), line.points[1].into()])
}

#[test]
fn ends_of_arcs_and_bars_are_where_coordinates_are_held() {
    let (mut ends, mut wrong) = (0, vec![]);
    for model in models() {
        for beside in [false, true] {
            let stored = within(&model, beside);
            seen(&model, &stored, |figure| {
                let mut pose = Pose::new(figure.program);
                for id in model.coordinate_ids() {
                    let (found, off) = ends_of(figure, &mut pose, id);
                    ends += found;
                    wrong.extend(off.map(|off| format!("{}: {off}", model.name())));
                }
            });
        }
    }
    assert!(wrong.is_empty(), "{} of {ends}: {:#?}", wrong.len(), &wrong[..wrong.len().min(20)]);
    assert!(ends > 500, "{ends}");
}

/// How many ends are drawn of a coordinate's range, and which of them is wrong.
fn ends_of(figure: &Figure, pose: &mut Pose, id: CoordinateId) -> (usize, Option<String>) {
    let mut scene = Scene::default();
    arc::draw(figure, &mut Sweep::new(figure), id, false, &mut scene);
    let lines: Vec<&Line> = drawn(&scene, 2.5).chain(drawn(&scene, 5.0)).collect();
    if lines.is_empty() {
        return (0, None);
    }
    let (segment, base, _) = arc::moved(figure, id).expect("it was drawn");
    let centre = value(&scene).map(|[centre, _]| centre);
    let point = value(&scene).map_or(figure.joint(segment).translation, |[_, point]| point);
    let frame = figure.pose.segment(segment);
    let own = frame.linear.inverse() * (point - frame.translation);
    let now = figure.pose.frame(base);
    let place = |value: f64, sweep: &mut Sweep| {
        let at = sweep.at(id, value).expect("its length");
        now * (at.pose.frame(base).rigid_inverse() * (at.pose.segment(segment) * own))
    };
    let mut sweep = Sweep::new(figure);
    let [low, high] = sweep.range(id).expect("it was drawn");
    let near = match figure.model.coordinate(id).kind {
        CoordinateKind::Rotation => NEAR,
        _ => 1e-3 * (high - low),
    };
    let mut held = |value: f64| {
        let mut asked = figure.stored.to_vec();
        *figure.model.value_mut(&mut asked, id) = value;
        kept(figure, pose, &asked)
    };
    let mut count = 0;
    for line in lines {
        let last = line.points[line.points.len() - 1];
        for (end, out) in [(line.points[0], -1.0), (last, 1.0)] {
            let end = Vec3::from(end);
            // The value that the place stands for: the nearest of all, then between its neighbours.
            let step = (high - low) / 64.0;
            let off = |value: f64, sweep: &mut Sweep| (place(value, sweep) - end).norm();
            let all = (-4..=68).map(|i| low + step * f64::from(i));
            // Where several give the same place, an end of the range before others.
            let all = [low, high].into_iter().chain(all);
            let nearest = all
                .map(|value| ((off(value, &mut sweep) * 1e6).round(), value))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .expect("some");
            let wide = if nearest.0 == 0.0 { 0.0 } else { step };
            let (mut from, mut to) = (nearest.1 - wide, nearest.1 + wide);
            for _ in 0..40 {
                let [a, b] = [from + 0.4 * (to - from), to - 0.4 * (to - from)];
                if off(a, &mut sweep) < off(b, &mut sweep) { to = b } else { from = a }
            }
            let found = 0.5 * (from + to);
            count += 1;
            let (inside, outside) = (held(found - out * near), held(found + out * near));
            if !inside || outside {
                let key = figure.model.coordinate_key(id);
                let said = format!(
                    "{key} {found} in [{low}, {high}] {out}: inside kept {inside}, outside {outside} {centre:?}"
                );
                return (count, Some(said));
            }
        }
    }
    (count, None)
}

/// The numbers for which a function is zero, by steps of Gauss and Newton with differences.
fn solved(start: &[f64], off: &mut dyn FnMut(&[f64]) -> Vec3) -> Option<Vec<f64>> {
    let mut at = start.to_vec();
    for _ in 0..60 {
        let here = off(&at);
        if here.norm() < 1e-10 {
            return Some(at);
        }
        let columns: Vec<Vec3> = (0..at.len())
            .map(|i| {
                let mut there = at.clone();
                there[i] += 1e-6;
                (off(&there) - here) * 1e6
            })
            .collect();
        let column = |i: usize| columns.get(i).copied().unwrap_or(Vec3::ZERO);
        let normal = |k: usize| {
            let mut row = [0, 1, 2].map(|i| column(i).dot(column(k)));
            row[k] += 1e-10;
            Vec3::from(row)
        };
        let matrix = Mat3::from_columns(normal(0), normal(1), normal(2));
        let step = matrix.inverse() * Vec3::from([0, 1, 2].map(|i| column(i).dot(here)));
        for (number, step) in at.iter_mut().zip(step.to_array()) {
            *number -= step.clamp(-0.4, 0.4);
        }
    }
    (off(&at).norm() < 1e-7).then_some(at)
}

/// Directions all along drawn lines, those between corners too, and a step outward from each.
fn along(lines: &[Vec<Vec3>]) -> Vec<(Vec3, Vec3)> {
    let mut all = vec![];
    for ends in lines.iter().flat_map(|line| line.windows(2)) {
        let along = ends[1] - ends[0];
        if along.norm() < 1e-9 {
            continue;
        }
        // Not at a corner itself: a step inward across one of its sides may lead out across the other.
        for share in [0.1, 0.3, 0.5] {
            let at = (ends[0] * (1.0 - share) + ends[1] * share).normalized();
            all.push((at, along.cross(at).normalized() * NEAR));
        }
    }
    all
}

#[test]
fn edges_of_cones_and_their_twist_are_where_rotations_are_moved() {
    let (mut places, mut twists) = (0, 0);
    for model in models() {
        seen(&model, &within(&model, true), |figure| {
            for bound in figure.program.bounds() {
                let component = &model.components()[bound.component.index()];
                let Law::Cone(law) = &component.law else { continue };
                let mut scene = Scene::default();
                cone::draw(figure, bound, law, &mut scene);
                let numbers: Vec<f64> = figure.pose.bounded(bound).collect();
                let turned = |numbers: &[f64]| cone::rotation(law, numbers);
                let frames = cone::Said { rotation: &turned, off: &|a, b| cone::off(law, a, b) };
                let now = turned(&numbers).expect("a rotation");
                let (_, frame) = cone::frame(figure, bound, &frames, now).expect("a frame");
                let [centre, tip] = value(&scene).expect("it is drawn");
                let direction = |p: [f64; 3]| frame.transpose() * (Vec3::from(p) - centre);
                let edges: Vec<Vec<Vec3>> = drawn(&scene, 2.0)
                    .map(|line| line.points.iter().map(|p| direction(*p).normalized()).collect())
                    .collect();
                assert!(!edges.is_empty(), "{}", component.name);
                let rest = law.cone.rest().normalized();
                // Whether the bone may point somewhere: by numbers that are left as they are, and in ranges.
                let held = |to: Vec3| {
                    let middle = law.cone.twist_bounds(to);
                    let middle = middle.map_or(0.0, |([low, high], _)| 0.5 * (low + high));
                    let whole = Twist::of(rest, swing(rest, to)).with(middle).to_mat3();
                    let mut off = |n: &[f64]| match (&law.of, turned(n)) {
                        (Swinging::Directions(_), Some(r)) => {
                            (r * rest).cross(to) + (r * rest - to) * 0.5
                        }
                        (_, Some(r)) => (whole.transpose() * r).log(),
                        _ => Vec3::X,
                    };
                    if matches!(law.of, Swinging::Orientation) {
                        return law.legal(&Quat::from_mat3(whole).to_array()).is_none();
                    }
                    let starts = starts(figure, bound, &numbers);
                    let mut found = starts.iter().filter_map(|start| solved(start, &mut off));
                    found.any(|n| in_ranges(figure, bound, &n) && law.legal(&n).is_none())
                };
                for (at, out) in along(&edges).into_iter().step_by(3) {
                    places += 1;
                    let along = out.cross(at);
                    let round = [along - out, -along - out, along + out, out - along];
                    let around = [-out, out, along, -along].into_iter().chain(round);
                    let mut judged = [false; 2];
                    for by in around {
                        let there = (at + by.normalized() * NEAR).normalized();
                        judged[usize::from(held(there))] = true;
                        if judged == [true, true] {
                            break;
                        }
                    }
                    assert_eq!(judged, [true, true], "{} {}: {at:?}", model.name(), component.name);
                }
                // The arc of twist where the bone points now.
                let turn = Twist::of(rest, now);
                for line in drawn(&scene, 1.5) {
                    for (end, out) in
                        [(line.points[0], -1.0), (line.points[line.points.len() - 1], 1.0)]
                    {
                        let along = frame.transpose() * (Vec3::from(end) - tip);
                        let from = turn.with(0.0).to_mat3().transpose() * along;
                        let twist = angle_about(turn.bone, from);
                        let moved = |by: f64| law.cone.legal(turn.with(twist + by).to_mat3()).moved;
                        assert!(!moved(-out * NEAR) && moved(out * NEAR), "{}", component.name);
                        twists += 1;
                    }
                }
            }
        });
    }
    assert!(places > 1000 && twists >= 8);
}

/// Numbers from which those of a rotation are sought: these, none, and a few within their ranges.
fn starts(figure: &Figure, bound: &Bound, now: &[f64]) -> Vec<Vec<f64>> {
    let inputs = &figure.model.components()[bound.component.index()].inputs;
    let within = |i: usize| {
        inputs.iter().enumerate().map(move |(k, signal)| {
            let ends = ellipse::bounded(figure, *signal).map_or([-1.0, 1.0], |(_, ends)| ends);
            let [low, high] = [ends[0].max(-3.0), ends[1].min(3.0)];
            // Beside gimbal lock only those near by are found.
            low + (high - low) * [0.02, 0.25, 0.75, 0.98][i >> (2 * k) & 3]
        })
    };
    let some = (0..1 << (2 * inputs.len())).map(|i| within(i).collect());
    [now.to_vec(), vec![0.0; now.len()]].into_iter().chain(some).collect()
}

/// The angle of a direction about a bone, from where arcs of twist begin.
fn angle_about(bone: Vec3, direction: Vec3) -> f64 {
    let [side, up] = condyle_render::shape::across(bone);
    direction.dot(up).atan2(direction.dot(side))
}

fn swing(from: Vec3, to: Vec3) -> Mat3 {
    let across = from.cross(to);
    let angle = across.norm().atan2(from.dot(to));
    Quat::from_axis_angle(across.normalized(), angle).to_mat3()
}

/// Whether the coordinates that a limit reads may have these values.
fn in_ranges(figure: &Figure, bound: &Bound, numbers: &[f64]) -> bool {
    let inputs = &figure.model.components()[bound.component.index()].inputs;
    inputs.iter().zip(numbers).all(|(signal, number)| {
        ellipse::bounded(figure, *signal)
            .is_none_or(|(_, [low, high])| *number > low - 1e-9 && *number < high + 1e-9)
    })
}

#[test]
fn ellipses_are_where_both_coordinates_are_held() {
    let mut places = 0;
    for model in models() {
        seen(&model, &within(&model, false), |figure| {
            let mut pose = Pose::new(figure.program);
            for bound in figure.program.bounds() {
                let component = &model.components()[bound.component.index()];
                let Law::Ellipse(law) = &component.law else { continue };
                let mut scene = Scene::default();
                ellipse::draw(figure, &mut Sweep::new(figure), bound, law, &mut scene);
                let lines: Vec<&Line> = drawn(&scene, 2.5).collect();
                assert_eq!(lines.len(), 1, "{} {}", model.name(), component.name);
                let ids = [0, 1].map(|i| {
                    ellipse::bounded(figure, component.inputs[i]).expect("it was drawn").0
                });
                let segment = ellipse::moved_last(figure, ids).expect("it was drawn");
                let base = figure.first_moved(&ids).and_then(|s| model.segment(s).parent);
                let [centre, tip] = value(&scene).expect("it was drawn");
                let frame = figure.pose.segment(segment);
                let own = frame.linear.inverse() * (tip - frame.translation);
                let now = figure.pose.frame(base);
                let mut sweep = Sweep::new(figure);
                let mut stands = |p: Vec3, start: &[f64]| {
                    let to = (p - centre).normalized();
                    solved(start, &mut |n| {
                        let at = sweep.with(&[(ids[0], n[0]), (ids[1], n[1])]).expect("a pose");
                        let place = now
                            * (at.pose.frame(base).rigid_inverse()
                                * (at.pose.segment(segment) * own));
                        let is = (place - centre).normalized();
                        is.cross(to) + (is - to) * 0.5
                    })
                };
                let points = &lines[0].points;
                let mut before: Option<Vec<f64>> = None;
                for ends in points.windows(2) {
                    let [a, b] = [ends[0], ends[1]].map(Vec3::from);
                    if (b - a).norm() < 1e-9 {
                        continue;
                    }
                    let start = before.clone().unwrap_or_else(|| law.centre().to_vec());
                    let (Some(from), Some(to)) = (stands(a, &start), stands(b, &start)) else {
                        panic!("{}: no numbers give this place", component.name)
                    };
                    let middle = stands((a + b) * 0.5, &from).expect("numbers");
                    let way = [to[0] - from[0], to[1] - from[1]];
                    let size = way[0].hypot(way[1]).max(1e-12);
                    let out = [way[1] / size * NEAR, -way[0] / size * NEAR];
                    let mut held = |side: f64| {
                        let mut asked = figure.stored.to_vec();
                        for i in 0..2 {
                            *model.value_mut(&mut asked, ids[i]) = middle[i] + side * out[i];
                        }
                        kept(figure, &mut pose, &asked)
                    };
                    let judged = [held(-1.0), held(1.0)];
                    let degrees: Vec<f64> = middle.iter().map(|x| x.to_degrees()).collect();
                    assert_eq!(
                        judged,
                        [true, false],
                        "{} {} {degrees:?}",
                        model.name(),
                        component.name
                    );
                    places += 1;
                    before = Some(to);
                }
            }
        });
    }
    assert!(places > 100, "{places}");
}

#[test]
fn edges_of_fields_and_their_twist_are_where_rotations_are_refused() {
    let (mut places, mut twists) = (0, 0);
    for model in models() {
        seen(&model, &within(&model, true), |figure| {
            // Sides are alike.
            let first = |bound: &&Bound| {
                matches!(model.components()[bound.component.index()].law, Law::Field(_))
            };
            let Some(bound) = figure.program.bounds().iter().find(first) else { return };
            let Law::Field(law) = &model.components()[bound.component.index()].law else { return };
            let mut scene = Scene::default();
            field::draw(figure, bound, law, &mut scene);
            let numbers: Vec<f64> = figure.pose.bounded(bound).collect();
            let now = field::rotation(&numbers).expect("a rotation");
            let (_, frame) = field::turned(figure, bound, now).expect("a frame");
            let [centre, tip] = value(&scene).expect("it is drawn");
            let bone = (now.transpose() * frame.transpose() * (tip - centre)).normalized();
            let allowed = |q: Quat| {
                let mut asked = numbers.clone();
                asked[..4].copy_from_slice(&q.to_array());
                law.rows_at(&asked)[0].0 >= 0.0
            };
            let reached = |to: Vec3| {
                let turn = Twist::of(bone, swing(bone, to));
                (0..1080).any(|i| allowed(turn.with(f64::from(i) * TAU / 1080.0)))
            };
            let edges: Vec<Vec<Vec3>> = drawn(&scene, 2.0)
                .map(|line| {
                    let points = line.points.iter();
                    points
                        .map(|p| (frame.transpose() * (Vec3::from(*p) - centre)).normalized())
                        .collect()
                })
                .collect();
            for (at, out) in along(&edges).into_iter().step_by(7) {
                let judged = [at - out, at + out].map(|to| reached(to.normalized()));
                assert_eq!(judged, [true, false], "{} {at:?}", model.name());
                places += 1;
            }
            let turn = Twist::of(bone, now);
            for line in drawn(&scene, 1.5) {
                for (end, out) in
                    [(line.points[0], -1.0), (line.points[line.points.len() - 1], 1.0)]
                {
                    let along = frame.transpose() * (Vec3::from(end) - tip);
                    let twist = angle_about(bone, turn.with(0.0).to_mat3().transpose() * along);
                    let judged = [-out, out].map(|by| allowed(turn.with(twist + by * NEAR)));
                    assert_eq!(judged, [true, false], "{}", model.name());
                    twists += 1;
                }
            }
        });
    }
    assert!(places > 100 && twists >= 2, "{places} {twists}");
}

/// Corners, middles of sides and of triangles of ellipsoids that bones glide on, against the surface that is enforced: their
/// distance as an angle about the middle.
#[test]
fn ellipsoids_are_where_bones_glide() {
    let mut places = 0;
    for model in models() {
        seen(&model, &within(&model, false), |figure| {
            for id in figure.program.contacts() {
                let component = &model.components()[id.index()];
                let Law::Contact(law) = &component.law else { continue };
                let surface = component.segments_at("surface").next();
                let frame = figure.pose.frame(surface) * law.law.ellipsoid_in_surface();
                let mut scene = Scene::default();
                super::super::contacts::contacts(figure, false, &mut scene);
                let middle = |s: &condyle_render::Surface| {
                    let count = s.positions.len().max(1) as f64;
                    let sum = s.positions.iter().fold(Vec3::ZERO, |sum, p| sum + Vec3::from(*p));
                    sum * count.recip()
                };
                let large = |s: &&condyle_render::Surface| {
                    s.opacity < 0.5 && (middle(s) - frame.translation).norm() < 1e-3
                };
                let ball = scene.surfaces.iter().find(large).expect("it is drawn");
                for triangle in &ball.triangles {
                    let [a, b, c] = triangle.map(|i| Vec3::from(ball.positions[i as usize]));
                    for place in
                        [a, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5, (a + b + c) * (1.0 / 3.0)]
                    {
                        let own = frame.linear.transpose() * (place - frame.translation);
                        let radii = law.law.radii();
                        let level =
                            Vec3::new(own.x / radii.x, own.y / radii.y, own.z / radii.z).norm();
                        assert!((level - 1.0).abs() < NEAR, "{}: {level}", component.name);
                        places += 1;
                    }
                }
            }
        });
    }
    assert!(places > 10_000, "{places}");
}
