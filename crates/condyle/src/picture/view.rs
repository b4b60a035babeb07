//! From where a figure is seen.

use condyle_diagnostics::{Error, did_you_mean};
use condyle_model::{Model, UpAxis};
use condyle_render::Camera;

/// A direction from which a figure is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From its front towards its right, in radians.
    pub azimuth: f64,
    /// Above the horizon, in radians.
    pub elevation: f64,
}

/// Views with names: azimuth and elevation in degrees. From above, forward is the top of the picture.
const NAMED: [(&str, f64, f64); 6] = [
    ("front", 0.0, 0.0),
    ("back", 180.0, 0.0),
    ("side", 90.0, 0.0),
    ("right", 90.0, 0.0),
    ("left", -90.0, 0.0),
    ("top", 180.0, 90.0),
];

impl View {
    /// From half right and a little above.
    pub const OBLIQUE: Self = Self { azimuth: 0.61, elevation: 0.21 };

    /// The view that a text names: `front`, `back`, `side` (the right one), `left`, `right`, `top`, or
    /// azimuth and elevation in degrees: `0,0` is the front, `90,0` the figure's right, `0,90` above.
    ///
    /// # Errors
    /// `picture/view` with what would be right.
    ///
    /// ```
    /// use condyle::picture::View;
    /// assert_eq!(View::named("90,0")?, View::named("side")?);
    /// assert!(View::named("frnt").unwrap_err().to_string().contains("did you mean `front`?"));
    /// # Ok::<(), condyle::Error>(())
    /// ```
    pub fn named(text: &str) -> Result<Self, Error> {
        let of = |azimuth: f64, elevation: f64| Self {
            azimuth: azimuth.to_radians(),
            elevation: elevation.to_radians(),
        };
        if let Some(&(_, azimuth, elevation)) = NAMED.iter().find(|(name, ..)| *name == text.trim())
        {
            return Ok(of(azimuth, elevation));
        }
        let fail = |message: String, help: String| {
            Err(Error::new("picture/view", message).with_help(help))
        };
        let kinds =
            || "front, back, side, left, right, top, or azimuth and elevation in degrees: 30,15";
        let Some((azimuth, elevation)) = text.split_once(',') else {
            let help = did_you_mean(text, NAMED.map(|(name, ..)| name), || kinds().to_owned());
            return fail(format!("unknown view `{text}`"), help);
        };
        let number = |part: &str| part.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        match (number(azimuth), number(elevation)) {
            (Some(azimuth), Some(elevation)) if elevation.abs() <= 90.0 => {
                Ok(of(azimuth % 360.0, elevation))
            }
            (Some(_), Some(_)) => fail(
                format!("the elevation of the view `{text}` is not within ±90°"),
                String::new(),
            ),
            _ => fail(format!("the view `{text}` is not two numbers"), kinds().to_owned()),
        }
    }

    /// The camera of this view of a model.
    pub(super) fn camera(self, model: &Model) -> Camera {
        Camera::looking(front(model), up(model), self.azimuth, self.elevation)
    }

    /// How a view is called under a picture.
    pub(super) fn title(self) -> String {
        let degrees = |x: f64| x.to_degrees().round();
        let (azimuth, elevation) = (degrees(self.azimuth), degrees(self.elevation));
        let named =
            NAMED.iter().find(|(name, a, e)| *name != "side" && (*a, *e) == (azimuth, elevation));
        named.map_or_else(|| format!("{azimuth}°, {elevation}°"), |(name, ..)| (*name).to_owned())
    }
}

/// Where a model looks at rest.
fn front(model: &Model) -> [f64; 3] {
    model.facing().ahead(model.up()).to_array()
}

/// The direction up in a model's world.
pub(super) fn up(model: &Model) -> [f64; 3] {
    match model.up() {
        UpAxis::Y => [0.0, 1.0, 0.0],
        UpAxis::Z => [0.0, 0.0, 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_model::ModelBuilder;
    use condyle_model::model::Facing;

    #[test]
    fn the_front_is_where_a_model_looks() {
        let front = |facing, up| {
            let mut builder = ModelBuilder::new("figure");
            builder.segment("body", None);
            builder.facing(facing);
            builder.up(up);
            let model = builder.build().unwrap();
            View::named("front").unwrap().camera(&model).toward
        };
        assert_eq!(front(Facing::PlusX, UpAxis::Y), [1.0, 0.0, 0.0]);
        assert_eq!(front(Facing::PlusZ, UpAxis::Y), [0.0, 0.0, 1.0]);
        assert_eq!(front(Facing::MinusZ, UpAxis::Y), [0.0, 0.0, -1.0]);
        // Blender's figures have z up and look against y.
        assert_eq!(front(Facing::PlusZ, UpAxis::Z), [0.0, -1.0, 0.0]);
    }
}
