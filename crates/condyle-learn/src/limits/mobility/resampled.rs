//! Between what bounds the share of reachable rotations lies.

use crate::limits::{Cloud, Field, Settings, learn};
use condyle_diagnostics::Error;
use condyle_math::Quat;

/// A share with bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// How many parts were left out in turn.
    pub parts: usize,
    /// The lower bound of the share, at 95 %.
    pub low: f64,
    /// The upper one.
    pub high: f64,
    /// The mean of the shares without one part, below the whole where parts know what others do not.
    pub without_one: f64,
}

/// Quantiles of Student's distribution at 97.5 % for 1 to 15 degrees of freedom.
const STUDENT: [f64; 15] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
    2.145, 2.131,
];

/// Bounds of the share of valid rotations, by the jackknife over parts: whole takes where there are four or more,
/// else blocks of time. With V₋ₖ the share without part k, learned with the same thickness of the layer,
///
/// ```text
/// SE² = (K - 1)/K Σ (V₋ₖ - mean)²      V ± t SE
/// ```
///
/// `None` with fewer than three parts.
///
/// # Errors
/// Those of [`learn`].
pub fn interval(field: &Field) -> Result<Option<Interval>, Error> {
    let ground = field.ground();
    let parts = parts(&ground.samples, &ground.takes);
    if parts.len() < 3 {
        return Ok(None);
    }
    let settings = Settings {
        nodes: ground.settings.nodes.min(64),
        gap: Some(field.learned().gap),
        ..ground.settings
    };
    let mut shares = vec![];
    for out in 0..parts.len() {
        let kept: Vec<&[Quat]> = (0..parts.len())
            .filter(|part| *part != out)
            .flat_map(|part| parts[part].iter().copied())
            .collect();
        let Ok(cloud) = Cloud::gather(&kept, 0.0) else { continue };
        shares.push(learn(&cloud, &settings)?.learned().valid);
    }
    let count = shares.len() as f64;
    let mean = shares.iter().sum::<f64>() / count;
    let spread: f64 = shares.iter().map(|v| (v - mean).powi(2)).sum();
    let error = ((count - 1.0) / count * spread).sqrt();
    let student = STUDENT.get(shares.len().saturating_sub(2)).copied().unwrap_or(2.0);
    let whole = field.learned().valid;
    Ok(Some(Interval {
        parts: shares.len(),
        low: (whole - student * error).max(0.0),
        high: (whole + student * error).min(1.0),
        without_one: mean,
    }))
}

/// Parts of samples: takes, or blocks of those there are.
fn parts<'s>(samples: &'s [Quat], takes: &[u32]) -> Vec<Vec<&'s [Quat]>> {
    let mut pieces = vec![];
    let mut rest = samples;
    for &take in takes {
        let (own, others) = rest.split_at((take as usize).min(rest.len()));
        if !own.is_empty() {
            pieces.push(own);
        }
        rest = others;
    }
    if !rest.is_empty() {
        pieces.push(rest);
    }
    let most = 10;
    if pieces.len() >= 4 {
        let count = pieces.len().min(most);
        let mut parts = vec![vec![]; count];
        for (index, piece) in pieces.into_iter().enumerate() {
            parts[index % count].push(piece);
        }
        return parts;
    }
    let blocks = 8usize.div_ceil(pieces.len().max(1));
    let cut = |piece: &'s [Quat]| {
        piece.chunks(piece.len().div_ceil(blocks).max(1)).map(|block| vec![block])
    };
    pieces.into_iter().flat_map(cut).collect()
}
