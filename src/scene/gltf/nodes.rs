//! The node hierarchy: proved to be one, cut to the chosen scene, sorted parents first.
//!
//! glTF's nodes name their children, and nothing keeps a file from naming one twice or in a circle.
//! So every node's parent is found first (two parents are an error), then all nodes are walked from
//! those without one, with a stack of our own; whoever is not reached hangs in a circle (an error).

use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::json::{Index, Node as GltfNode, Root};

use super::accessor::{self, Store};
use super::error::{AccessorError, Problem, Warnings, name, part};
use super::lights::extra;
use super::materials::flag;
use crate::scene::{Node, Skin, Transform};

/// The chosen scene's nodes.
pub(super) struct Hierarchy {
    /// The file's indices, parents before children: the order of the scene's nodes.
    pub order: Vec<usize>,
    /// By the file's index: the scene's, where the node is in it.
    pub number: Vec<Option<usize>>,
    /// By the scene's index.
    pub parents: Vec<Option<usize>>,
    /// By the scene's index: only there because a skin's joints are, outside the chosen scene.
    pub hidden: Vec<bool>,
}

impl Hierarchy {
    /// Where the scene has a node of the file.
    pub fn find(&self, node: Index<GltfNode>) -> Option<usize> {
        self.number.get(node.value()).copied().flatten()
    }
}

fn named(root: &Root, node: usize) -> String {
    part("node", node, root.nodes.get(node).and_then(|node| node.name.as_deref()))
}

fn children(node: &GltfNode) -> &[Index<GltfNode>] {
    node.children.as_deref().unwrap_or_default()
}

/// Finds the chosen scene's nodes: the default scene's, else the first one's, else all.
pub(super) fn hierarchy(root: &Root, warnings: &mut Warnings) -> Result<Hierarchy, Problem> {
    let count = root.nodes.len();
    let parents = parents(root)?;
    let sorted = sort(root, &parents)?;

    let mut kept = vec![false; count];
    match chosen_scene(root, warnings)? {
        Some(scene) => {
            for node in &scene.nodes {
                let Some(kept) = kept.get_mut(node.value()) else {
                    return Err(Problem::Part {
                        part: "scene".into(),
                        what: format!("node {node} does not exist; the file has {count}"),
                    });
                };
                *kept = true;
            }
        }
        None => kept.fill(true),
    }
    for &node in &sorted {
        kept[node] |= parents[node].is_some_and(|parent| kept[parent]);
    }
    // Joints may lie outside the scene against glTF's rule; they are needed, with all above them.
    let shown = kept.clone();
    for (node, shown) in root.nodes.iter().zip(&shown) {
        let skin = node.skin.filter(|_| *shown).and_then(|skin| root.skins.get(skin.value()));
        for joint in skin.map_or(&[][..], |skin| &skin.joints) {
            let mut above = Some(joint.value()).filter(|joint| *joint < count);
            while let Some(node) = above.filter(|node| !kept[*node]) {
                kept[node] = true;
                above = parents[node];
            }
        }
    }

    let order: Vec<usize> = sorted.into_iter().filter(|node| kept[*node]).collect();
    let mut number = vec![None; count];
    for (at, &node) in order.iter().enumerate() {
        number[node] = Some(at);
    }
    Ok(Hierarchy {
        parents: order.iter().map(|&node| parents[node].and_then(|parent| number[parent])).collect(),
        hidden: order.iter().map(|&node| !shown[node]).collect(),
        number,
        order,
    })
}

fn chosen_scene<'a>(root: &'a Root, warnings: &mut Warnings) -> Result<Option<&'a gltf::json::Scene>, Problem> {
    if root.scenes.is_empty() {
        return Ok(None);
    }
    let index = root.scene.map_or(0, |scene| scene.value());
    let Some(scene) = root.scenes.get(index) else {
        let what = format!("scene {index} does not exist; the file has {}", root.scenes.len());
        return Err(Problem::Part { part: "default scene".into(), what });
    };
    if root.scenes.len() > 1 {
        let shown = part("scene", index, scene.name.as_deref());
        warnings.push(format!("the file has {} scenes; {shown} is shown", root.scenes.len()));
    }
    Ok(Some(scene))
}

fn parents(root: &Root) -> Result<Vec<Option<usize>>, Problem> {
    let count = root.nodes.len();
    let mut parents: Vec<Option<usize>> = vec![None; count];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in children(node) {
            let child = child.value();
            let Some(parent) = parents.get_mut(child) else {
                let what = format!("its child {child} does not exist; the file has {count} nodes");
                return Err(Problem::Part { part: named(root, index), what });
            };
            if let Some(other) = parent {
                let what = if *other == index {
                    format!("is twice a child of {}", named(root, index))
                } else {
                    format!("is a child of both {} and {}", named(root, *other), named(root, index))
                };
                return Err(Problem::Part { part: named(root, child), what });
            }
            *parent = Some(index);
        }
    }
    Ok(parents)
}

/// Depth first from the nodes without parent, children in the file's order.
fn sort(root: &Root, parents: &[Option<usize>]) -> Result<Vec<usize>, Problem> {
    let mut visited = vec![false; parents.len()];
    let mut order = Vec::with_capacity(parents.len());
    let mut stack: Vec<usize> = (0..parents.len()).rev().filter(|node| parents[*node].is_none()).collect();
    while let Some(node) = stack.pop() {
        visited[node] = true;
        order.push(node);
        stack.extend(children(&root.nodes[node]).iter().rev().map(|child| child.value()));
    }
    let Some(lost) = visited.iter().position(|visited| !visited) else { return Ok(order) };
    // Everyone above it has a parent too, so going up ends in the circle itself.
    let mut seen = vec![false; parents.len()];
    let mut at = lost;
    while !seen[at] {
        seen[at] = true;
        at = parents[at].unwrap_or(at);
    }
    let mut circle = vec![named(root, at)];
    let mut next = parents[at].unwrap_or(at);
    while next != at && circle.len() < 8 {
        circle.push(named(root, next));
        next = parents[next].unwrap_or(at);
    }
    let more = if next == at { "" } else { " and so on" };
    circle[1..].reverse();
    Err(Problem::Part { part: circle.join(", "), what: format!("each is a child of another in a circle{more}") })
}

/// The chosen nodes; `meshes` and `skins` say what the file's are in the scene. Nodes that animations move
/// have to be translation, rotation and scale.
pub(super) fn import(
    root: &Root,
    hierarchy: &Hierarchy,
    meshes: &[Option<usize>],
    skins: &[Option<usize>],
    warnings: &mut Warnings,
) -> Result<Vec<Node>, Problem> {
    let animated = animated(root);
    let node = |(at, &index): (usize, &usize)| {
        let node = &root.nodes[index];
        let hidden = hierarchy.hidden[at];
        let local = transform(node, animated[index], &|| named(root, index), warnings)?;
        let lookup = |what: &str, target: Option<usize>, table: &[Option<usize>]| match target {
            Some(target) if target >= table.len() => {
                let what = format!("{what} {target} does not exist; the file has {}", table.len());
                Err(Problem::Part { part: named(root, index), what })
            }
            Some(target) if !hidden => Ok(table[target]),
            _ => Ok(None),
        };
        let mesh = lookup("mesh", node.mesh.map(|mesh| mesh.value()), meshes)?;
        let skin = lookup("skin", node.skin.map(|skin| skin.value()), skins)?;
        let mut morph_weights = node.weights.clone().unwrap_or_default();
        morph_weights.iter_mut().filter(|weight| !weight.is_finite()).for_each(|weight| *weight = 0.0);
        Ok(Node {
            name: name("node", index, node.name.as_deref()),
            parent: hierarchy.parents[at],
            local,
            mesh,
            skin: skin.filter(|_| mesh.is_some()),
            morph_weights,
            casts_shadow: flag(&node.extras, "casts_shadow").unwrap_or(true),
            halo: flag(&node.extras, "halo").unwrap_or(false),
            portal: None,
        })
    };
    let mut nodes: Vec<Node> = hierarchy.order.iter().enumerate().map(node).collect::<Result<_, _>>()?;
    for (at, &index) in hierarchy.order.iter().enumerate() {
        let Some(exit) = extra(&root.nodes[index].extras, "portal") else { continue };
        let found = exit.as_str().and_then(|exit| nodes.iter().position(|other| other.name == exit));
        if found.is_none() {
            warnings.push(format!("{}: its `portal` is no other node's name, and it is none", named(root, index)));
        }
        nodes[at].portal = found;
    }
    Ok(nodes)
}

fn animated(root: &Root) -> Vec<bool> {
    let mut animated = vec![false; root.nodes.len()];
    for channel in root.animations.iter().flat_map(|animation| &animation.channels) {
        if let Some(animated) = animated.get_mut(channel.target.node.value()) {
            *animated = true;
        }
    }
    animated
}

fn transform(node: &GltfNode, animated: bool, named: &dyn Fn() -> String, warnings: &mut Warnings) -> Result<Transform, Problem> {
    let not_finite = |what: &str| Problem::Part { part: named(), what: format!("its {what} is not finite") };
    if let Some(matrix) = node.matrix {
        if !matrix.iter().all(|value| value.is_finite()) {
            return Err(not_finite("matrix"));
        }
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        if matrix.row(3) != glam::DVec4::W {
            warnings.push(format!("{}: the last row of its matrix is not 0 0 0 1 and left out", named()));
        }
        let affine = DAffine3::from_mat4(matrix);
        let (scale, rotation, translation) = affine.to_scale_rotation_translation();
        if animated && scale.is_finite() && rotation.is_finite() {
            return Ok(Transform::Trs { translation, rotation: rotation.normalize(), scale });
        }
        return Ok(Transform::Affine(affine));
    }
    let vector = |value: Option<[f32; 3]>, default: DVec3| value.map_or(default, |v| DVec3::from_array(v.map(f64::from)));
    let translation = vector(node.translation, DVec3::ZERO);
    let scale = vector(node.scale, DVec3::ONE);
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |rotation| DQuat::from_array(rotation.0.map(f64::from)));
    for (what, finite) in
        [("translation", translation.is_finite()), ("scale", scale.is_finite()), ("rotation", rotation.is_finite())]
    {
        if !finite {
            return Err(not_finite(what));
        }
    }
    let length = rotation.length();
    let rotation = if length > 1e-12 {
        rotation / length
    } else {
        warnings.push(format!("{}: its rotation is no direction and left out", named()));
        DQuat::IDENTITY
    };
    Ok(Transform::Trs { translation, rotation, scale })
}

/// The skins that nodes of the scene use, and where the file's went.
pub(super) fn skins(root: &Root, store: &Store<'_>, hierarchy: &Hierarchy) -> Result<(Vec<Skin>, Vec<Option<usize>>), Problem> {
    let mut skins = Vec::new();
    let mut numbers = vec![None; root.skins.len()];
    for &node in &hierarchy.order {
        let Some(index) = root.nodes[node].skin.map(|skin| skin.value()) else { continue };
        // A skin that does not exist is told when its node is made.
        let Some(skin) = root.skins.get(index).filter(|_| numbers[index].is_none()) else { continue };
        let named = || part("skin", index, skin.name.as_deref());
        let failed = |what: String| Problem::Part { part: named(), what };
        if skin.joints.is_empty() || skin.joints.len() > usize::from(u16::MAX) + 1 {
            return Err(failed(format!("{} joints; 1 to 65536 are possible", skin.joints.len())));
        }
        let joint = |joint: &Index<GltfNode>| {
            hierarchy.find(*joint).ok_or_else(|| failed(format!("its joint, node {joint}, does not exist")))
        };
        let joints = skin.joints.iter().map(joint).collect::<Result<Vec<_>, _>>()?;
        let inverse_bind = match skin.inverse_bind_matrices {
            None => vec![DAffine3::IDENTITY; joints.len()],
            Some(index) => {
                let name = || format!("{}, inverse bind matrices", named());
                let matrices = store.floats(index, &accessor::MAT4, name)?;
                if matrices.count() < joints.len() {
                    return Err(Store::error(
                        index,
                        AccessorError::Count { found: matrices.count(), wanted: joints.len() },
                        name,
                    ));
                }
                let matrix = |at| matrices.get::<16>(at).map_or(DMat4::IDENTITY, |m| DMat4::from_cols_array(&m.map(f64::from)));
                (0..joints.len()).map(|at| DAffine3::from_mat4(matrix(at))).collect()
            }
        };
        numbers[index] = Some(skins.len());
        skins.push(Skin { joints, inverse_bind });
    }
    Ok((skins, numbers))
}
