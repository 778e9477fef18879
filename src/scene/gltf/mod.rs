//! glTF and GLB files, on the gltf crate's schema and readers of our own.
//!
//! Users' files and the models that are built in come this way. Nothing a file says is believed: the
//! crate's own readers panic or abort on hostile files, and its validation refuses valid ones that
//! users have, so only its schema ([`gltf::json`]) is used.
//!
//! ```text
//! files      bytes, of regular files below the folder only
//! container  GLB chunks, data URIs, buffers
//! document   JSON -> the schema, leniently where users' files need it
//! nodes      the hierarchy: cycles and two parents are errors; parents first
//! accessor   buffers -> numbers, every step checked, out of one memory budget
//! mesh, materials, images, lights, animation      -> the scene's
//! staging    what the file leaves out: lights (lamps), a camera (viewpoint), the exposure
//! floor      when asked for
//! ```
//!
//! What can be shown without harm in spite of a fault is shown, with a warning in
//! [`Scene::warnings`]; all else is an [`ImportError`] that names the file and the part.

mod accessor;
mod animation;
mod container;
mod document;
mod error;
mod files;
mod floor;
mod images;
mod lamps;
mod lights;
mod materials;
mod mesh;
mod nodes;
mod staging;
mod viewpoint;

use std::path::Path;

use glam::DAffine3;
use gltf::json::Root;

pub use super::open::{Loading, load_on_thread};
pub use error::{AccessorError, ImportError, Problem};
pub use floor::add_floor;

use super::pose::is_invertible;
use super::{AnimationChoice, Material, Mesh, Property, Scene};
use error::{Budget, Warnings, part};
use files::Folder;

/// What a file's geometry and animation may unpack to, bytes.
const MEMORY: u64 = 3 << 29;

fn budget_words() -> String {
    format!("{} MiB unpacked", MEMORY >> 20)
}

/// Reads a glTF or GLB file, and the files it names.
///
/// # Errors
/// Whatever keeps the file from being a scene, see [`Problem`].
pub fn load(path: &Path) -> Result<Scene, ImportError> {
    let file = path.display().to_string();
    let failed = |problem| ImportError::new(&file, problem);
    let bytes = files::read(path, &Budget::new(files::LARGEST_FILE)).map_err(failed)?;
    let folder = Folder::of(path).map_err(failed)?;
    let name = path.file_stem().map_or_else(|| file.clone(), |stem| stem.to_string_lossy().into_owned());
    import(&name, &bytes, &folder).map_err(failed)
}

/// Reads a model that is built into the program.
///
/// # Errors
/// As [`load`]; a model that is not whole in itself too.
pub fn load_embedded(name: &str, glb: &'static [u8]) -> Result<Scene, ImportError> {
    load_bytes(name, glb)
}

/// Reads a model in memory, which can name no files.
///
/// # Errors
/// As [`load`].
pub fn load_bytes(name: &str, bytes: &[u8]) -> Result<Scene, ImportError> {
    import(name, bytes, &Folder::nowhere()).map_err(|problem| ImportError::new(name, problem))
}

/// The whole way, in order.
fn import(name: &str, bytes: &[u8], folder: &Folder) -> Result<Scene, Problem> {
    let mut warnings = Warnings::default();
    let halves = container::split(bytes)?;
    let root = document::parse(halves.json, &mut warnings)?;
    let hierarchy = nodes::hierarchy(&root, &mut warnings)?;
    if hierarchy.order.is_empty() {
        return Err(Problem::Nothing("there are no nodes in the scene".into()));
    }
    let buffers = container::buffers(&root, halves.binary, folder)?;
    let budget = Budget::new(MEMORY);
    let store = accessor::Store::new(&root, &buffers, &budget);

    let (meshes, mesh_numbers) = import_meshes(&root, &store, &hierarchy, &mut warnings)?;
    let (skins, skin_numbers) = nodes::skins(&root, &store, &hierarchy)?;
    let mut images = images::Images::new(&root, &store, folder);
    let default = root.materials.len();
    let mut used = vec![false; default + 1];
    meshes.iter().flat_map(|mesh| &mesh.primitives).for_each(|primitive| used[primitive.material] = true);
    let mut materials = materials::import(&root, &used, &mut images, &mut warnings)?;
    if used[default] {
        materials.push(Material::default());
    }

    let nodes = nodes::import(&root, &hierarchy, &mesh_numbers, &skin_numbers, &mut warnings)?;
    let mut scene = Scene { name: error::one_line(name), nodes, meshes, skins, materials, ..Scene::default() };
    if scene.instances().next().is_none() {
        return Err(Problem::Nothing("the scene's nodes show no triangles".into()));
    }
    scene.animations = animation::import(&root, &store, &hierarchy, &scene.nodes, &scene.meshes, &mut warnings)?;
    check_instances(&mut scene, &root, &hierarchy, &store, &mut warnings)?;
    scene.default_animation = if scene.animations.is_empty() { AnimationChoice::All } else { AnimationChoice::One(0) };
    scene.lights = lights::lights(&root, &hierarchy, &mut images, &mut warnings)?;
    scene.textures = images.textures;
    let (cameras, heights): (Vec<_>, Vec<_>) = lights::cameras(&root, &hierarchy, &mut warnings)?.into_iter().unzip();
    scene.cameras = cameras;
    staging::complete(&mut scene, &heights, &mut warnings)?;
    scene.find_mirrors().into_iter().for_each(|refused| warnings.push(refused));
    scene.find_receivers().into_iter().for_each(|refused| warnings.push(refused));
    scene.warnings = warnings.finish();
    Ok(scene)
}

/// The meshes that nodes of the scene show, and where the file's went.
fn import_meshes(
    root: &Root,
    store: &accessor::Store<'_>,
    hierarchy: &nodes::Hierarchy,
    warnings: &mut Warnings,
) -> Result<(Vec<Mesh>, Vec<Option<usize>>), Problem> {
    let uses = materials::uses(root);
    let mut shown = vec![false; root.meshes.len()];
    for &node in &hierarchy.order {
        if let Some(shown) = root.nodes[node].mesh.and_then(|mesh| shown.get_mut(mesh.value())) {
            *shown = true;
        }
    }
    let mut meshes = Vec::new();
    let mut numbers = vec![None; root.meshes.len()];
    for (index, mesh) in root.meshes.iter().enumerate().filter(|(index, _)| shown[*index]) {
        if let Some(mesh) = mesh::import(store, index, mesh, &uses, warnings)? {
            numbers[index] = Some(meshes.len());
            meshes.push(mesh);
        }
    }
    Ok((meshes, numbers))
}

/// Which nodes may have no inverse, now or when their animations play: meshes there are posed vertex by
/// vertex.
fn flattened(scene: &Scene) -> Vec<bool> {
    let mut scaled = vec![false; scene.nodes.len()];
    for channel in scene.animations.iter().flat_map(|animation| &animation.channels) {
        scaled[channel.node] |= channel.property == Property::Scale;
    }
    let mut world_from_node: Vec<DAffine3> = Vec::with_capacity(scene.nodes.len());
    for (index, node) in scene.nodes.iter().enumerate() {
        let world_from_parent = node.parent.map_or(DAffine3::IDENTITY, |parent| world_from_node[parent]);
        world_from_node.push(world_from_parent * node.local.affine());
        scaled[index] |= node.parent.is_some_and(|parent| scaled[parent]);
    }
    scaled.iter().zip(&world_from_node).map(|(scaled, placed)| *scaled || !is_invertible(placed)).collect()
}

/// What depends on a mesh and on the node that shows it: enough joints, enough weights, and memory for
/// every instance that is bent on the CPU.
fn check_instances(
    scene: &mut Scene,
    root: &Root,
    hierarchy: &nodes::Hierarchy,
    store: &accessor::Store<'_>,
    warnings: &mut Warnings,
) -> Result<(), Problem> {
    let joints_needed = mesh::joints_needed(&scene.meshes);
    let flattened = flattened(scene);
    for (index, node) in scene.nodes.iter_mut().enumerate() {
        let Some(mesh_index) = node.mesh else { continue };
        let mesh = &scene.meshes[mesh_index];
        let in_file = hierarchy.order[index];
        let named = || part("node", in_file, root.nodes[in_file].name.as_deref());
        if let Some(skin) = node.skin {
            let joints = scene.skins[skin].joints.len();
            match joints_needed.get(&mesh_index) {
                None => {
                    warnings.push(format!("{}: its mesh has no joints and is not bent by its skin", named()));
                    node.skin = None;
                }
                Some(needed) if *needed > joints => {
                    let what = format!("mesh {:?} needs joint {}, but the skin has {joints}", mesh.name, needed - 1);
                    return Err(Problem::Part { part: named(), what });
                }
                Some(_) => {}
            }
        }
        if !node.morph_weights.is_empty() && node.morph_weights.len() != mesh.morphs.len() {
            if !mesh.morphs.is_empty() {
                warnings.push(format!(
                    "{}: it has {} weights for {} morph targets",
                    named(),
                    node.morph_weights.len(),
                    mesh.morphs.len()
                ));
            }
            node.morph_weights.resize(mesh.morphs.len(), 0.0);
        }
        // What a pose holds of it, two arrays of vectors and one of floats, and what it costs to make.
        let bent = mesh.is_deformable() || flattened[index];
        let joints = node.skin.map_or(0, |skin| scene.skins[skin].joints.len()) as u64;
        let bytes = mesh.positions.len() as u64 * (32 + 8 * mesh.morphs.len() as u64) + joints * 160;
        if bent && !store.budget().take(Some(bytes)) {
            return Err(Problem::TooLarge { what: "its geometry is", limit: budget_words() });
        }
    }
    Ok(())
}
