//! The order in which things are computed, or the cycle that prevents one.

use crate::component::{Law, Signal};
use crate::model::{ComponentId, CoordinateId, Model};
use condyle_diagnostics::Subject;

/// One thing that is computed: a coordinate's effective value, or a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Node {
    Coordinate(CoordinateId),
    Component(ComponentId),
}

/// Coordinates and components in an order in which each comes after its inputs.
///
/// Order and cycles are determined over the whole model, per component and not per segment.
///
/// # Errors
/// The first node of a cycle, and the names along it, the first one repeated at the end.
pub(crate) fn dependency_order(model: &Model) -> Result<Vec<Node>, (Subject, Vec<String>)> {
    let coordinates = model.coordinates.len();
    let number = |source: Signal| match source {
        Signal::Coordinate(id) => Some(id.index()),
        Signal::Output(id, _) => Some(coordinates + id.index()),
        Signal::Segment(_) => None,
    };
    let reads = |node: usize| -> Vec<usize> {
        if node < coordinates {
            model.coordinates[node].follows.into_iter().filter_map(number).collect()
        } else {
            let id = ComponentId((node - coordinates) as u32);
            model.reads(id).into_iter().filter_map(number).collect()
        }
    };
    let subject = |node: usize| match node.checked_sub(coordinates) {
        None => Subject::Coordinate(model.coordinate_key(CoordinateId(node as u32))),
        Some(component) => model.component_subject(&model.components[component]),
    };
    let name = |node: usize| match subject(node) {
        Subject::Component { joint_set, name } => format!("{joint_set}.{name}"),
        other => other.name().to_owned(),
    };
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let total = coordinates + model.components.len();
    let mut marks = vec![Mark::New; total];
    let mut order = Vec::with_capacity(total);
    // Depth first with an explicit stack: a node, its inputs, and how many of them are done.
    let mut stack: Vec<(usize, Vec<usize>, usize)> = Vec::new();
    for root in 0..total {
        if marks[root] != Mark::New {
            continue;
        }
        marks[root] = Mark::Open;
        stack.push((root, reads(root), 0));
        while let Some((node, inputs, done)) = stack.last_mut() {
            let Some(&next) = inputs.get(*done) else {
                marks[*node] = Mark::Done;
                order.push(if *node < coordinates {
                    Node::Coordinate(CoordinateId(*node as u32))
                } else {
                    Node::Component(ComponentId((*node - coordinates) as u32))
                });
                stack.pop();
                continue;
            };
            *done += 1;
            match marks[next] {
                Mark::Done => {}
                Mark::New => {
                    marks[next] = Mark::Open;
                    stack.push((next, reads(next), 0));
                }
                Mark::Open => {
                    let from = stack.iter().position(|(n, ..)| *n == next).unwrap_or(0);
                    let mut names: Vec<String> =
                        stack[from..].iter().map(|(n, ..)| name(*n)).collect();
                    names.reverse();
                    names.insert(0, name(next));
                    return Err((subject(next), names));
                }
            }
        }
    }
    Ok(order)
}

/// Which components depend on what is measured between segments, in this order of evaluation.
pub(crate) fn measured(model: &Model, order: &[Node]) -> Vec<bool> {
    let mut coordinates = vec![false; model.coordinates.len()];
    let mut components = vec![false; model.components.len()];
    for node in order {
        let of = |source: Signal| match source {
            Signal::Coordinate(id) => coordinates[id.index()],
            Signal::Output(id, _) => components[id.index()],
            Signal::Segment(_) => false,
        };
        match *node {
            Node::Coordinate(id) => {
                coordinates[id.index()] = model.coordinate(id).follows.is_some_and(of);
            }
            Node::Component(id) => {
                let component = &model.components[id.index()];
                let measures =
                    matches!(component.law, Law::RelativeOrientation(_) | Law::RelativePosition(_));
                components[id.index()] = measures || component.values().any(of);
            }
        }
    }
    components
}
