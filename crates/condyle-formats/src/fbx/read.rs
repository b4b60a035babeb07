//! The nodes of an FBX file, and their places in each frame.

use crate::glb::{Channel, Clip, Figure, LocalPose, Options, Path, Still, Tree, TreeNode};
use crate::text::distinct;
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings, did_you_mean, listed};
use condyle_motion::Animation;
use std::rc::Rc;

/// Reads the skeleton of a file and its first animation.
///
/// # Errors
/// As [`read`].
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Animation>, Error> {
    read(bytes, &Options::default())
}

/// Reads the skeleton of a file and one of its animations.
///
/// # Warnings
/// `fbx/animations` where the file holds several and none was asked for, `fbx/frames` where the animation is too long for its
/// size, `skeleton/scale`, `skeleton/left-out`, `skeleton/unit`, `skeleton/name`.
///
/// # Errors
/// `fbx/damaged` with what is wrong, `fbx/animation` if there is none of the wanted name, `fbx/no-skeleton` without bones and
/// animation.
///
/// ```
/// use condyle_formats::fbx;
/// let error = fbx::from_bytes(b"; FBX 7.4.0 project file\nNonsense").unwrap_err();
/// assert_eq!(error.code(), "fbx/damaged");
/// ```
pub fn read(bytes: &[u8], options: &Options) -> Result<Read<Animation>, Error> {
    let mut warnings = Warnings::default();
    let scene = ufbx::load_memory(bytes, load_options(bytes.len())).map_err(|error| {
        let what: &str = &error.description;
        let message = match error.info() {
            "" => format!("the file cannot be read: {what}"),
            info => format!("the file cannot be read: {what}: {info}"),
        };
        Error::new("fbx/damaged", message)
    })?;
    let (tree, bones) = tree(&scene, &mut warnings)?;
    let chosen = chosen(&scene, options, &mut warnings)?;
    let clip = match chosen {
        Some(stack) => clip(&scene, stack, &tree, bytes.len(), &mut warnings),
        None => Clip::default(),
    };
    if !bones.contains(&true) && clip.channels.iter().all(Channel::is_still) {
        return Err(Error::new("fbx/no-skeleton", "the file has neither bones nor an animation")
            .with_help("a figure that moves is read, not a still scene"));
    }
    let still = Still { rest: tree.nodes.iter().map(|node| node.local).collect(), joint: bones };
    let mut figure = Figure::new(&tree, &still, &clip, &mut warnings);
    let above = tree.order.iter().find(|index| still.joint[**index]);
    let name = above.and_then(|index| tree.nodes.get(tree.nodes[*index].parent.unwrap_or(*index)));
    figure.skeleton.name = name.map_or("figure", |node| node.name.as_str()).to_owned();
    figure.settle_unit(&options.assumed, &mut warnings);
    let motion = figure.motion(&tree, &still, &clip, bytes.len(), &mut warnings);
    let Read { value: model, warnings: told } = figure.skeleton.build()?;
    warnings.extend(told);
    Ok(Read { value: Animation { model, motion }, warnings: warnings.finish() })
}

/// Metres, y up, no geometry, and no more memory than three times the size of the file and 24 MB for each of the two parts.
fn load_options<'a>(size: usize) -> ufbx::LoadOpts<'a> {
    let most = || ufbx::AllocatorOpts { memory_limit: 3 * size + (24 << 20), ..Default::default() };
    ufbx::LoadOpts {
        temp_allocator: most(),
        result_allocator: most(),
        ignore_geometry: true,
        ignore_embedded: true,
        node_depth_limit: 1000,
        target_axes: ufbx::CoordinateAxes::right_handed_y_up(),
        target_unit_meters: 1.0,
        space_conversion: ufbx::SpaceConversion::ModifyGeometry,
        inherit_mode_handling: ufbx::InheritModeHandling::Compensate,
        ..Default::default()
    }
}

/// The nodes without the root, which stands for the scene; and which are bones.
fn tree(scene: &ufbx::Scene, warnings: &mut Warnings) -> Result<(Tree, Vec<bool>), Error> {
    let mut index_of = vec![None; scene.nodes.len()];
    let (mut nodes, mut bones): (Vec<TreeNode>, Vec<bool>) = (vec![], vec![]);
    // Parents come before their children.
    for node in &scene.nodes {
        if node.is_root {
            continue;
        }
        if let Some(place) = index_of.get_mut(node.element.typed_id as usize) {
            *place = Some(nodes.len());
        }
        let parent = node.parent.as_ref().map(|parent| parent.element.typed_id as usize);
        let name: &str = &node.element.name;
        let name = name.trim();
        nodes.push(TreeNode {
            name: if name.is_empty() { format!("node_{}", nodes.len()) } else { name.to_owned() },
            parent: parent.and_then(|parent| index_of.get(parent).copied().flatten()),
            local: place(&node.local_transform),
            shows: node.mesh.is_some() || node.camera.is_some() || node.light.is_some(),
            skin: None,
        });
        bones.push(node.bone.is_some());
    }
    let names = distinct(nodes.iter().map(|node| node.name.as_str()), |_, renamed| {
        warnings.add("skeleton/name", || {
            let message = format!("two nodes have one name: the second is called `{renamed}`");
            Diagnostic::warning("skeleton/name", message)
        });
    });
    for (node, name) in nodes.iter_mut().zip(names) {
        node.name = name;
    }
    Ok((Tree::of(nodes)?, bones))
}

/// The animation that is wanted.
fn chosen<'s>(
    scene: &'s ufbx::Scene,
    options: &Options,
    warnings: &mut Warnings,
) -> Result<Option<&'s ufbx::AnimStack>, Error> {
    let stacks: Vec<&ufbx::AnimStack> = scene.anim_stacks.into_iter().collect();
    let names: Vec<&str> = stacks.iter().map(|stack| &*stack.element.name).collect();
    let Some(wanted) = &options.animation else {
        if stacks.len() > 1 {
            let message = format!("the file holds {} animations: {}", stacks.len(), listed(&names));
            warnings.push(
                Diagnostic::warning("fbx/animations", message)
                    .with_help("the first is read; another is chosen by --animation"),
            );
        }
        return Ok(stacks.first().copied());
    };
    let number = wanted.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    let named = names.iter().position(|name| name == wanted).or(number);
    match named.and_then(|index| stacks.get(index)) {
        Some(stack) => Ok(Some(*stack)),
        None => {
            let help = did_you_mean(wanted, names.iter().copied(), || match names.is_empty() {
                true => "the file has none".to_owned(),
                false => format!("the file holds {}", listed(&names)),
            });
            let message = format!("there is no animation `{wanted}`");
            Err(Error::new("fbx/animation", message).with_help(help))
        }
    }
}

/// Where every node is in each frame.
fn clip(
    scene: &ufbx::Scene,
    stack: &ufbx::AnimStack,
    tree: &Tree,
    size: usize,
    warnings: &mut Warnings,
) -> Clip {
    let rate = scene.settings.frames_per_second;
    let rate = if rate.is_finite() && rate > 0.0 { rate.min(1000.0) } else { 30.0 };
    let (first, last) = (stack.time_begin, stack.time_end);
    let span = if last > first && (last - first).is_finite() { last - first } else { 0.0 };
    // Ten numbers of a node in each frame, in at most twice the size of the file and 16 MB.
    let most = (2 * size + (16 << 20)) / (80 * tree.nodes.len().max(1));
    let wanted = (span * rate + 1e-6).floor() + 1.0;
    let frames = wanted.min(most.max(2) as f64) as usize;
    let step = if wanted > frames as f64 { span / (frames - 1).max(1) as f64 } else { 1.0 / rate };
    if wanted > frames as f64 {
        let message = format!("the animation has {wanted} frames at {rate} a second");
        let help = format!("sampled evenly in {frames} frames");
        warnings.push(Diagnostic::warning("fbx/frames", message).with_help(help));
    }
    let times: Rc<Vec<f64>> =
        Rc::new((0..frames).map(|frame| first + step * frame as f64).collect());
    let keys: Rc<Vec<usize>> = Rc::new((0..frames).collect());
    let mut channels = vec![];
    for (index, node) in (&scene.nodes).into_iter().filter(|node| !node.is_root).enumerate() {
        let poses: Vec<LocalPose> = times
            .iter()
            .map(|time| place(&ufbx::evaluate_transform(&stack.anim, node, *time)))
            .collect();
        let still = poses.iter().all(|pose| *pose == tree.nodes[index].local);
        if still {
            continue;
        }
        let clock = (&times, &keys);
        let of = |part: fn(&LocalPose) -> &[f64]| poses.iter().flat_map(part).copied().collect();
        channels.push(Channel::sampled(index, Path::Translation, clock, of(|p| &p.translation)));
        channels.push(Channel::sampled(index, Path::Rotation, clock, of(|p| &p.rotation)));
        channels.push(Channel::sampled(index, Path::Scale, clock, of(|p| &p.scale)));
    }
    Clip { channels }
}

fn place(t: &ufbx::Transform) -> LocalPose {
    let numbers =
        [t.translation.x, t.translation.y, t.translation.z, t.scale.x, t.scale.y, t.scale.z];
    let turn = [t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w];
    let length = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
    let finite = numbers.iter().all(|x| x.is_finite()) && length.is_finite();
    if !finite || length < 1e-9 {
        return LocalPose::IDENTITY;
    }
    let [x, y, z, a, b, c] = numbers;
    LocalPose { translation: [x, y, z], rotation: turn.map(|x| x / length), scale: [a, b, c] }
}
