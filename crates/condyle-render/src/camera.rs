//! Where a picture is taken from: parallel rays, so that lengths across the view are true everywhere.

use condyle_math::Vec3;

/// A camera with parallel rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// What is in the middle of the picture.
    pub centre: [f64; 3],
    /// The direction to the right of the picture, of length 1.
    pub right: [f64; 3],
    /// The direction to the top of the picture, of length 1.
    pub up: [f64; 3],
    /// The direction towards the viewer, of length 1.
    pub toward: [f64; 3],
    /// How many metres the picture's height shows.
    pub height: f64,
}

/// A box along the axes of the world that holds points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least of each coordinate.
    pub low: [f64; 3],
    /// The greatest of each coordinate.
    pub high: [f64; 3],
}

impl Bounds {
    /// The box of points; those that are not finite are left out. `None` without any.
    pub fn of(points: impl IntoIterator<Item = [f64; 3]>) -> Option<Self> {
        let mut found: Option<Self> = None;
        for point in points.into_iter().filter(|p| p.iter().all(|x| x.is_finite())) {
            let bounds = found.get_or_insert(Self { low: point, high: point });
            for axis in 0..3 {
                bounds.low[axis] = bounds.low[axis].min(point[axis]);
                bounds.high[axis] = bounds.high[axis].max(point[axis]);
            }
        }
        found
    }

    /// The box that holds two.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        let pick =
            |f: fn(f64, f64) -> f64, a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| f(a[i], b[i]));
        Self {
            low: pick(f64::min, self.low, other.low),
            high: pick(f64::max, self.high, other.high),
        }
    }

    /// The middle.
    pub fn centre(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| 0.5 * (self.low[i] + self.high[i]))
    }

    /// The eight corners.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        [0, 1, 2, 3, 4, 5, 6, 7].map(|corner: usize| {
            [0, 1, 2].map(|i| if corner >> i & 1 == 0 { self.low[i] } else { self.high[i] })
        })
    }
}

impl Camera {
    /// A camera that looks at the origin from a direction; its height is one metre.
    ///
    /// `azimuth` is the angle from `forward` to the viewer about `up` (radians; positive towards the
    /// figure's right, which is `forward` × `up`), `elevation` the viewer's angle above the horizon. From
    /// straight above, the top of the picture is opposite to where the viewer would come down.
    ///
    /// ```
    /// use condyle_render::Camera;
    /// // From the right of a figure that looks along x, x points to the right of the picture.
    /// let side = Camera::looking([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 90f64.to_radians(), 0.0);
    /// assert!((side.right[0] - 1.0).abs() < 1e-15 && (side.toward[2] - 1.0).abs() < 1e-15);
    /// ```
    pub fn looking(forward: [f64; 3], up: [f64; 3], azimuth: f64, elevation: f64) -> Self {
        let (forward, up) = (Vec3::from(forward), Vec3::from(up));
        let right = forward.cross(up);
        let (sin, cos) = azimuth.sin_cos();
        let level = forward * cos + right * sin;
        let (rise, reach) = elevation.sin_cos();
        let toward = level * reach + up * rise;
        let top = up * reach - level * rise;
        Self {
            centre: [0.0; 3],
            right: top.cross(toward).to_array(),
            up: top.to_array(),
            toward: toward.to_array(),
            height: 1.0,
        }
    }

    /// The same direction, with all of a box in a picture whose width is `aspect` times its height, and
    /// `margin` of its height free on every side.
    #[must_use]
    pub fn framing(self, bounds: &Bounds, aspect: f64, margin: f64) -> Self {
        let centre = Vec3::from(bounds.centre());
        let (mut wide, mut high) = (0.0f64, 0.0f64);
        for corner in bounds.corners() {
            let off = Vec3::from(corner) - centre;
            wide = wide.max(off.dot(self.right.into()).abs());
            high = high.max(off.dot(self.up.into()).abs());
        }
        let free = (1.0 - 2.0 * margin).max(0.1);
        // The margin is the same length on all sides.
        let across = 2.0 * wide / (aspect - 2.0 * margin).max(0.1 * aspect);
        let height = (2.0 * high / free).max(across).max(1e-4);
        Self { centre: centre.to_array(), height, ..self }
    }

    /// A point as metres to the right of, above and in front of the middle of the picture.
    pub fn seen(&self, point: [f64; 3]) -> [f64; 3] {
        let off = Vec3::from(point) - Vec3::from(self.centre);
        [self.right, self.up, self.toward].map(|axis| off.dot(axis.into()))
    }
}
