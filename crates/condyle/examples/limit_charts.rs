//! The charts of docs/learned-limits.md: `cargo run -p condyle --example limit_charts oracles/limits/curves.json docs/pictures`.

use condyle_render::{Chart, Drawn, Mark, Series, palette};
use serde_json::Value;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [from, to] = &arguments[..] else {
        return Err("give the file curves.json and a folder".into());
    };
    let said: Value = serde_json::from_str(&std::fs::read_to_string(from)?)?;
    let write = |name: &str, chart: &Chart| {
        std::fs::write(Path::new(to).join(name), chart.picture(760, 460).png())
    };
    for (key, name) in [
        ("takes of 01 left out", "limits-takes.png"),
        ("from 01 to 02", "limits-01-to-02.png"),
        ("from 02 to 01", "limits-02-to-01.png"),
    ] {
        write(name, &coverage(key, &said["coverage"][key]))?;
    }
    write("limits-radii.png", &radii(&said["histograms"]["radii"]))?;
    write("limits-values.png", &values(&said["histograms"]["values"]))?;
    Ok(())
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
}

fn coverage(key: &str, curves: &Value) -> Chart {
    let looks = [
        ("closing", palette::AXIS_Z, Mark::Disc, 0.0),
        ("Euler ranges", palette::ACCENT, Mark::Square, 0.0),
        ("circular cone", palette::MARKER, Mark::Triangle, 8.0),
        ("herda2003", palette::MOTION, Mark::Cross, 4.0),
    ];
    let series = looks.map(|(name, colour, mark, dash)| {
        let pairs = curves[name].as_array().into_iter().flatten().map(numbers);
        let mut points: Vec<[f64; 2]> =
            pairs.filter(|p| p.len() == 2).map(|p| [1e2 * p[0], p[1]]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Series { name: name.to_owned(), colour, drawn: Drawn::Line(mark, dash), points }
    });
    Chart {
        title: format!("Right upper arm in the thorax, {key}"),
        axes: ["volume, % of all rotations".into(), "held-out frames valid".into()],
        ranges: [[0.0, 40.0], [0.0, 1.0]],
        series: series.to_vec(),
        lines: vec![],
    }
}

/// Counts between edges as points of bars.
fn bars(edges: &[f64], counts: &[f64]) -> Vec<[f64; 2]> {
    let heights = counts.iter().copied().chain([0.0]);
    edges.iter().copied().zip(heights).map(|(x, y)| [x, y]).collect()
}

fn radii(said: &Value) -> Chart {
    let (edges, counts) = (numbers(&said["edges"]), numbers(&said["counts"]));
    let most = counts.iter().copied().fold(1.0, f64::max);
    let largest = said["largest"].as_f64().unwrap_or(0.0);
    Chart {
        title:
            "Samples of subject 01 in the fullest of 7 x 7 solid angles (Herda et al., Figure 7)"
                .into(),
        axes: ["distance from the centroid in (qx, qy, qz)".into(), "samples".into()],
        ranges: [[0.0, edges.last().copied().unwrap_or(1.0)], [0.0, 1.15 * most]],
        series: vec![Series {
            name: String::new(),
            colour: palette::AXIS_Z,
            drawn: Drawn::Bars,
            points: bars(&edges, &counts),
        }],
        lines: vec![(0.9 * largest, "outer tenth".into())],
    }
}

fn values(said: &Value) -> Chart {
    let edges = numbers(&said["edges"]);
    let series = [
        ("subject 01", "training", palette::AXIS_Z, Drawn::Bars),
        ("subject 02", "other", palette::ACCENT, Drawn::Steps),
    ];
    let inside = |key: &str| 1e2 * said[key].as_f64().unwrap_or(f64::NAN);
    Chart {
        title: format!(
            "F at frames of 01, of whom it was learned ({:.0} % inside), and of 02 ({:.0} %)",
            inside("training_inside"),
            inside("other_inside")
        ),
        axes: ["F of equation 5 (3 and more in the last bar)".into(), "share of frames".into()],
        ranges: [[0.0, 3.0], [0.0, 0.35]],
        series: series
            .map(|(name, key, colour, drawn)| Series {
                name: name.to_owned(),
                colour,
                drawn,
                points: bars(&edges, &numbers(&said[key])),
            })
            .to_vec(),
        lines: vec![(1.0, "F = 1".into())],
    }
}
