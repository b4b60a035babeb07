//! Several poses and views in one picture, at one scale.

use super::figure::Figure;
use super::focus::{Chosen, Focus};
use super::{Show, View, axes, bones, contacts, limits, marks, view};
use condyle_diagnostics::Error;
use condyle_math::Vec3;
use condyle_model::{Jacobian, Model, Pose, Program};
use condyle_render::{Bounds, Camera, Canvas, Ground, Picture, Scene, TextSize, palette};

/// A pose in a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Posed {
    /// The stored numbers of all coordinates, taken as they are.
    pub stored: Vec<f64>,
    /// What is written under it.
    pub title: String,
}

impl Posed {
    /// A pose without a title.
    pub fn new(stored: Vec<f64>) -> Self {
        Self { stored, title: String::new() }
    }
}

/// What is drawn in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// The poses, side by side.
    pub poses: Vec<Posed>,
    /// From where each is seen. With several, there is a row for each.
    pub views: Vec<View>,
    /// What is shown of it.
    pub show: Vec<Show>,
    /// What the picture looks at.
    pub focus: Focus,
    /// The width and height of the whole picture in pixels.
    pub size: [usize; 2],
}

impl Sheet {
    /// A sheet of bones, from half right, 1280 by 720 pixels.
    pub fn new(poses: Vec<Posed>) -> Self {
        Self {
            poses,
            views: vec![View::OBLIQUE],
            show: vec![Show::Bones],
            focus: Focus::default(),
            size: [1280, 720],
        }
    }
}

/// The most pixels of a picture.
const MOST_PIXELS: usize = 1 << 26;

/// The most poses times views.
const MOST_CELLS: usize = 1 << 10;

/// Draws a sheet of a model. Poses stand at one scale; the picture goes along with the first segment over
/// the ground.
///
/// # Errors
/// `picture/unknown` for names that the model does not have; `picture/size` for pictures of no pixels or of
/// too many, or for cells smaller than 16 pixels; `picture/poses` for poses of another length.
pub fn draw(model: &Model, sheet: &Sheet) -> Result<Canvas, Error> {
    draw_figure(model, &crate::Figure::new(model), sheet)
}

/// Draws a sheet as [`draw`] does, of surfaces that are given: of files, for example.
///
/// # Errors
/// As [`draw`].
pub fn draw_figure(
    model: &Model,
    surfaces: &crate::Figure,
    sheet: &Sheet,
) -> Result<Canvas, Error> {
    let chosen = sheet.focus.resolve(model)?;
    let layout = Layout::of(sheet)?;
    let program = Program::compile(model);
    let reaches = limits::Reaches::default();
    let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
    let mut page = Canvas::new(sheet.size[0], sheet.size[1], palette::PAGE);
    let mut evaluate = |stored: &[f64], draw: &mut dyn FnMut(&Figure)| {
        let evaluated = program.evaluate_with_jacobian(stored, &mut pose, &mut jacobian);
        evaluated.map_err(|error| Error::new("picture/poses", error.to_string()))?;
        let figure = Figure {
            model,
            program: &program,
            stored,
            pose: &pose,
            jacobian: &jacobian,
            surfaces,
            chosen: chosen.as_ref(),
            highlight: sheet.focus.highlight,
            reaches: &reaches,
            unit: 0.0,
        };
        draw(&figure);
        Ok::<(), Error>(())
    };
    // First the places, since all cells have one scale.
    let mut placed = vec![];
    for posed in &sheet.poses {
        evaluate(&posed.stored, &mut |figure| placed.push(Placed::of(figure, &sheet.show)))?;
    }
    let cameras = cameras(model, sheet, &placed, &layout);
    let ground = ground(model, &placed);
    for (index, posed) in sheet.poses.iter().enumerate() {
        for (row, &seen) in sheet.views.iter().enumerate() {
            let camera = cameras[row * sheet.poses.len() + index];
            evaluate(&posed.stored, &mut |figure| {
                let figure = Figure { unit: 0.05 * camera.height, ..*figure };
                let mut scene = scene(&figure, &sheet.show);
                scene.ground = ground.map(|ground| placed[index].on(ground, model));
                let drawn = rendered(&Picture::new(&scene, &camera, layout.wide, layout.high));
                let (x, y) = layout.cell(row, index);
                page.place(&drawn, x, y);
            })?;
            let mut title = posed.title.clone();
            if sheet.views.len() > 1 {
                title =
                    [&title[..], &seen.title()[..]].join(if title.is_empty() { "" } else { "  " });
            }
            layout.write(&mut page, (row, index), &title);
        }
    }
    Ok(page)
}

/// Draws a picture on all cores.
fn rendered(picture: &Picture) -> Canvas {
    #[cfg(feature = "parallel")]
    let bands: Vec<_> = {
        use rayon::prelude::*;
        (0..picture.bands()).into_par_iter().map(|band| picture.band(band)).collect()
    };
    #[cfg(not(feature = "parallel"))]
    let bands: Vec<_> = (0..picture.bands()).map(|band| picture.band(band)).collect();
    picture.finish(&bands)
}

/// What is shown of a posed figure.
pub(super) fn scene(figure: &Figure, show: &[Show]) -> Scene {
    let mut scene = Scene::default();
    let shows = |kind: Show| show.contains(&kind);
    let skinned = shows(Show::Skin) && !figure.surfaces.skins.is_empty();
    let boned = shows(Show::Bones) || shows(Show::Skin) && !skinned;
    if boned {
        scene.surfaces.extend(bones::surfaces(figure).into_iter().map(|(_, surface)| surface));
    }
    if skinned {
        scene.surfaces.extend(bones::skins(figure, boned));
    }
    if shows(Show::Frames) {
        marks::frames(figure, &mut scene);
    }
    let named = shows(Show::Names);
    if shows(Show::Axes) {
        axes::axes(figure, named, &mut scene);
    }
    if shows(Show::Centres) {
        axes::centres(figure, &mut scene);
    }
    if shows(Show::Limits) {
        limits::limits(figure, named, &mut scene);
    }
    if shows(Show::Contacts) {
        contacts::contacts(figure, named, &mut scene);
    }
    if shows(Show::Markers) {
        marks::markers(figure, &mut scene);
    }
    if named {
        marks::names(figure, shows(Show::Markers), &mut scene);
    }
    scene
}

/// Where a posed figure is.
struct Placed {
    /// The box of all bones.
    whole: Bounds,
    /// The box of what is looked at: where nothing is named, of all bones and what they are shown to glide on.
    looked: Bounds,
    /// The middle of the joints of joint sets that are looked at, where there are any.
    joints: Option<Vec3>,
    /// The origin of its first segment.
    root: Vec3,
}

impl Placed {
    fn of(figure: &Figure, show: &[Show]) -> Self {
        let surfaces = bones::surfaces(figure);
        let of = |only: Option<&Chosen>| {
            let kept = surfaces.iter().filter(|(id, _)| only.is_none_or(|c| c.has(*id)));
            Bounds::of(kept.flat_map(|(_, surface)| surface.positions.iter().copied()))
        };
        // Other signs are as large as suits the frame.
        let mut signs = Scene::default();
        if show.contains(&Show::Contacts) {
            contacts::contacts(figure, false, &mut signs);
        }
        let chosen = figure.chosen;
        let around = Bounds { low: [-0.5; 3], high: [0.5; 3] };
        let skins = if show.contains(&Show::Skin) { bones::skins(figure, false) } else { vec![] };
        let skins = Bounds::of(skins.into_iter().flat_map(|skin| skin.positions));
        let whole =
            match (of(None).filter(|_| show.contains(&Show::Bones) || skins.is_none()), skins) {
                (Some(bones), Some(skins)) => bones.with(skins),
                (bones, skins) => bones.or(skins).unwrap_or(around),
            };
        let looked = match chosen {
            Some(_) => of(chosen).unwrap_or(whole),
            None => signs.bounds().map_or(whole, |signs| whole.with(signs)),
        };
        let first = figure.model.parents_first().first().map(|&id| figure.pose.segment(id));
        let root = first.map_or(Vec3::ZERO, |frame| frame.translation);
        let joints = chosen.map_or(&[][..], |chosen| &chosen.joints);
        let joints = joints.iter().map(|&id| figure.joint(id).translation.to_array());
        let joints = Bounds::of(joints).map(|bounds| Vec3::from(bounds.centre()));
        Self { whole, looked, joints, root: if root.is_finite() { root } else { Vec3::ZERO } }
    }

    /// The ground under it.
    fn on(&self, ground: Ground, model: &Model) -> Ground {
        let (centre, up) = (Vec3::from(self.whole.centre()), Vec3::from(view::up(model)));
        let level = Vec3::from(ground.middle).dot(up);
        let middle = centre + up * (level - centre.dot(up));
        Ground { middle: middle.to_array(), ..ground }
    }
}

/// The cameras of all cells, views after views: at one scale.
fn cameras(model: &Model, sheet: &Sheet, placed: &[Placed], layout: &Layout) -> Vec<Camera> {
    let aspect = layout.wide as f64 / layout.high as f64;
    let up = Vec3::from(view::up(model));
    // Poses are laid over each other by their first segments, over the ground.
    let away = |from: &Placed| {
        let off = placed.first().map_or(Vec3::ZERO, |first| from.root - first.root);
        off - up * off.dot(up)
    };
    let moved = |bounds: &Bounds, off: Vec3| Bounds {
        low: (Vec3::from(bounds.low) - off).to_array(),
        high: (Vec3::from(bounds.high) - off).to_array(),
    };
    let all = |p: &Placed| if sheet.focus.names.is_empty() { p.looked } else { p.whole };
    let whole = placed.iter().map(|p| moved(&all(p), away(p))).reduce(Bounds::with);
    // What is looked at moves in the figure, while the figure stays where it is in all cells.
    let looked = placed.iter().map(|p| moved(&p.looked, away(p))).reduce(Bounds::with);
    let mut cameras = vec![];
    for view in &sheet.views {
        let camera = view.camera(model);
        let (Some(whole), Some(looked)) = (whole, looked) else { continue };
        let framed = camera.framing(&whole, aspect, MARGIN);
        let height = match sheet.focus.zoom {
            Some(zoom) => framed.height / zoom,
            None if sheet.focus.names.is_empty() => framed.height,
            None => camera.framing(&looked, aspect, 2.0 * MARGIN).height,
        };
        for placed in placed {
            let centre = match sheet.focus.names.is_empty() {
                true => Vec3::from(whole.centre()) + away(placed),
                // A joint stays in the middle while its bones move, if they need not all be seen.
                false => placed
                    .joints
                    .filter(|_| sheet.focus.zoom.is_some())
                    .unwrap_or_else(|| Vec3::from(looked.centre()) + away(placed)),
            };
            cameras.push(Camera { centre: centre.to_array(), height, ..camera });
        }
    }
    // Scales differ between views only as far as the figure's sizes do not: the largest holds for all.
    let height = cameras.iter().map(|c| c.height).fold(0.0, f64::max);
    cameras.iter_mut().for_each(|camera| camera.height = height);
    cameras
}

/// Free space on every side, as a share of a cell's height.
const MARGIN: f64 = 0.04;

/// The ground: at height 0 for a figure that stands about there, else under the lowest one.
fn ground(model: &Model, placed: &[Placed]) -> Option<Ground> {
    let axis = view::up(model).iter().position(|x| *x == 1.0)?;
    let all = placed.iter().map(|p| p.whole).reduce(Bounds::with)?;
    let (low, high) = (all.low[axis], all.high[axis]);
    let stands = low > -0.08 * (high - low) && low < 0.6 * (high - low);
    let level = if stands { 0.0 } else { low };
    let size = placed.iter().map(|p| {
        let [x, y, z] = [0, 1, 2].map(|i| p.whole.high[i] - p.whole.low[i]);
        x.hypot(y).hypot(z)
    });
    let mut middle = all.centre();
    middle[axis] = level;
    let radius = size.fold(0.0, f64::max);
    Some(Ground { up: view::up(model), forward: [1.0, 0.0, 0.0], middle, radius })
}

/// Where cells are in a picture.
struct Layout {
    columns: usize,
    /// Rows of cells for each view.
    rows: usize,
    /// The size of a cell, without its title.
    wide: usize,
    high: usize,
    /// The height of a title.
    title: usize,
    /// Free pixels between cells.
    gap: usize,
    /// What is left over, to the left and above.
    free: [usize; 2],
    text: TextSize,
}

/// Free pixels between cells.
const GAP: usize = 4;

/// The least width and height of a cell in pixels.
const LEAST_CELL: usize = 16;

impl Layout {
    fn of(sheet: &Sheet) -> Result<Self, Error> {
        let fail =
            |message: String, help: &str| Err(Error::new("picture/size", message).with_help(help));
        let [width, height] = sheet.size;
        let (poses, views) = (sheet.poses.len(), sheet.views.len());
        if poses == 0 || views == 0 {
            return Err(Error::new("picture/poses", "a picture of no pose or no view"));
        }
        if width.saturating_mul(height) > MOST_PIXELS {
            let most = "at most 67 million pixels are drawn: 8192x8192";
            return fail(format!("a picture of {width}x{height} pixels is too large"), most);
        }
        if poses.saturating_mul(views) > MOST_CELLS {
            let message = format!("{poses} poses and {views} views do not fit in one picture");
            return fail(message, "at most 1024 of both together");
        }
        let text = TextSize::for_picture(width, height);
        let titled = views > 1 || sheet.poses.iter().any(|pose| !pose.title.is_empty());
        let title = if titled { text.character().1 + 5 } else { 0 };
        // With one view, as many columns as make cells of a figure's shape; else a row a view.
        let columns = match views {
            1 => (1..=poses).max_by(|&a, &b| {
                let fit = |columns: usize| {
                    let (wide, high) = (width / columns, height / poses.div_ceil(columns));
                    (wide as f64 / 0.62).min(high.saturating_sub(title) as f64)
                };
                fit(a).total_cmp(&fit(b)).then(b.cmp(&a))
            }),
            _ if poses == 1 => None,
            _ => Some(poses),
        };
        let (columns, rows) = match columns {
            Some(columns) => (columns, poses.div_ceil(columns)),
            // One pose from several sides: side by side.
            None => (views, 0),
        };
        let lines = if rows == 0 { 1 } else { rows * views };
        let gap = if poses * views > 1 { GAP } else { 0 };
        let wide = ((width + gap) / columns).saturating_sub(gap);
        let high = ((height + gap) / lines).saturating_sub(gap + title);
        if wide < LEAST_CELL || high < LEAST_CELL {
            let message =
                format!("{poses} poses and {views} views do not fit in {width}x{height} pixels");
            return fail(message, "each needs at least 16 pixels and its title");
        }
        let used = [(wide + gap) * columns - gap, (high + title + gap) * lines - gap];
        let free = [(width - used[0]) / 2, (height - used[1]) / 2];
        Ok(Self { gap, columns, rows, wide, high, title, free, text })
    }

    /// The upper left corner of a cell.
    fn cell(&self, view: usize, pose: usize) -> (usize, usize) {
        let (column, line) = match self.rows {
            0 => (view, 0),
            rows => (pose % self.columns, view * rows + pose / self.columns),
        };
        let [x, y] = self.free;
        (x + column * (self.wide + self.gap), y + line * (self.high + self.title + self.gap))
    }

    /// Writes a title under a cell, as much of it as fits.
    fn write(&self, page: &mut Canvas, (view, pose): (usize, usize), title: &str) {
        let (x, y) = self.cell(view, pose);
        let (character, _) = self.text.character();
        let title: String = title.chars().take(self.wide / character).collect();
        let left = x + (self.wide - title.chars().count() * character) / 2;
        let at = (left as i32, (y + self.high + 1) as i32);
        page.write(&title, at, self.text, palette::TEXT, palette::PAGE);
    }
}
