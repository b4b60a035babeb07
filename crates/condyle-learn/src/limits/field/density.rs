//! How sparse a cloud is from place to place.
//!
//! Samples and the volume of the inside are counted at the nodes and both spread by the same Gaussian; the volume over
//! the number is that of a sample there, and near a boundary as right as elsewhere, for what is outside is in neither.

use super::even::spread;
use super::layer::share;
use super::nearest::Nodes;
use condyle_math::Quat;

/// The deviation of the Gaussian, in spacings: some 180 samples within it.
const WIDE: f64 = 2.0;
/// Volumes of samples whose mean square is less, as a multiple of their squared mean, are even but for chance.
const EVEN: f64 = 1.03;
/// How much sparser or denser than on average a place may be, in spacings.
const BOUNDS: [f64; 2] = [0.5, 2.0];

/// The spacing about each sample over the mean one; all 1 if what differs may be chance.
pub(super) fn scales(
    nodes: &Nodes<'_>,
    inner: &[f32],
    samples: &[Quat],
    spacing: f64,
) -> Option<Vec<f64>> {
    let lattice = nodes.lattice;
    let (mut volume, mut number) = (vec![0.0f32; lattice.len()], vec![0.0f32; lattice.len()]);
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        // The boundary is about a third of a spacing outside of the closing.
        let held = share(nodes, f64::from(inner[node]) + spacing / 3.0);
        if held > 0.0 {
            volume[node] = (held * lattice.around_node(*q)) as f32;
        }
    }
    for q in samples {
        for node in lattice.around(*q) {
            if let Some(number) = number.get_mut(node) {
                *number += 0.125;
            }
        }
    }
    let sigma = WIDE * spacing / lattice.angle();
    let (volume, number) = (spread(lattice, &volume, sigma), spread(lattice, &number, sigma));
    let at = |q: Quat| {
        let (mut v, mut n) = (0.0, 0.0);
        for node in lattice.corners(q) {
            v += f64::from(volume[node]);
            n += f64::from(number[node]);
        }
        ((v / n.max(1e-9)).cbrt() / spacing).clamp(BOUNDS[0], BOUNDS[1])
    };
    let found: Vec<f64> = samples.iter().map(|q| at(*q)).collect();
    let (mut sum, mut squares) = (0.0, 0.0);
    for scale in &found {
        sum += scale.powi(3);
        squares += scale.powi(6);
    }
    (squares * found.len() as f64 > EVEN * sum * sum).then_some(found)
}
