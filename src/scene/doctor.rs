//! What was imported, and how each mesh will cast its shadow: for `obscura info` and the panel.

use std::fmt;

use serde::Serialize;

use super::{AlphaMode, Extent, LightKind, Scene};
use crate::geometry::topology::TopologyReport;

/// A scene in numbers and words.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The scene's name.
    pub name: String,
    /// Nodes of the hierarchy.
    pub nodes: usize,
    /// Nodes that show a mesh.
    pub instances: usize,
    /// Of all instances together.
    pub triangles: usize,
    /// Of all instances together.
    pub vertices: usize,
    /// Name, kind and how far it reaches.
    pub lights: Vec<String>,
    /// By name.
    pub cameras: Vec<String>,
    /// Name and duration.
    pub animations: Vec<String>,
    /// How many.
    pub materials: usize,
    /// How many of them are drawn blended, and so cast no shadow.
    pub blended_materials: usize,
    /// Name and size.
    pub textures: Vec<String>,
    /// How many skins bend meshes.
    pub skins: usize,
    /// Node and primitive, as `--mirror` has them; name, and how each reflects.
    pub mirrors: Vec<String>,
    /// `node:primitive`, and its name.
    pub receivers: Vec<String>,
    /// One a mesh.
    pub meshes: Vec<MeshReport>,
    /// What the importer had to leave out or replace.
    pub warnings: Vec<String>,
}

/// One mesh's health.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeshReport {
    /// The mesh's name.
    pub name: String,
    /// Nodes that show it.
    pub instances: usize,
    /// Of those, how many cast shadows.
    pub casters: usize,
    /// All that are drawn.
    pub triangles: usize,
    /// All that are drawn.
    pub vertices: usize,
    /// Morph targets.
    pub morph_targets: usize,
    /// Bent by joints.
    pub skinned: bool,
    /// Every component is closed and no inside-out shell.
    pub closed: bool,
    /// What its shadow is made from, after welding.
    pub topology: TopologyReport,
    /// How its volume is built, in words.
    pub volume: String,
}

/// Looks at all of `scene`.
#[must_use]
pub fn report(scene: &Scene) -> Report {
    // How often each mesh is shown, and how often it casts.
    let mut shown = vec![(0, 0); scene.meshes.len()];
    for node in &scene.nodes {
        if let Some((instances, casters)) = node.mesh.and_then(|mesh| shown.get_mut(mesh)) {
            *instances += 1;
            *casters += usize::from(node.casts_shadow);
        }
    }
    let meshes = scene.meshes.iter().zip(shown).map(|(mesh, (instances, casters))| {
        let topology = mesh.topology.report().clone();
        MeshReport {
            name: mesh.name.clone(),
            instances,
            casters,
            triangles: mesh.indices.len() / 3,
            vertices: mesh.positions.len(),
            morph_targets: mesh.morphs.len(),
            skinned: !mesh.skin.is_empty(),
            closed: topology.is_solid(),
            volume: volume(&topology, casters).into(),
            topology,
        }
    });
    let lights = scene.lights.iter().map(|light| {
        let kind = match light.kind {
            LightKind::Point => "point",
            LightKind::Directional => "directional",
            LightKind::Spot { .. } => "spot",
        };
        let reach = if light.range.is_finite() { format!(", {} m", light.range) } else { String::new() };
        let unit = if light.kind == LightKind::Directional { "lx" } else { "cd" };
        let size = match light.extent {
            Extent::Point => String::new(),
            Extent::Round(radius) => format!(", radius {radius} m"),
            Extent::Rectangle([width, height]) => format!(", {width} m by {height} m"),
        };
        let slide = light.slide.and_then(|slide| scene.textures.get(slide));
        let slide = slide.map_or_else(String::new, |slide| format!(", projects {}", slide.name));
        format!("{} ({kind}, {} {unit}{reach}{size}{slide})", light.name, light.intensity)
    });
    let textures =
        scene.textures.iter().map(|texture| format!("{} ({} x {})", texture.name, texture.width, texture.height)).collect();
    Report {
        name: scene.name.clone(),
        nodes: scene.nodes.len(),
        instances: scene.instances().count(),
        triangles: scene.instances().map(|(_, _, mesh)| mesh.indices.len() / 3).sum(),
        vertices: scene.instances().map(|(_, _, mesh)| mesh.positions.len()).sum(),
        lights: lights.collect(),
        cameras: scene.cameras.iter().map(|camera| camera.name.clone()).collect(),
        animations: scene
            .animations
            .iter()
            .map(|animation| format!("{} ({:.2} s)", animation.name, animation.duration))
            .collect(),
        materials: scene.materials.len(),
        blended_materials: scene.materials.iter().filter(|material| material.alpha == AlphaMode::Blend).count(),
        textures,
        skins: scene.skins.len(),
        mirrors: scene.mirrors.iter().map(|mirror| format!("{}:{} {mirror}", mirror.node, mirror.primitive)).collect(),
        receivers: scene
            .receivers
            .iter()
            .map(|receiver| format!("{}:{} {receiver}", receiver.node, receiver.primitive))
            .collect(),
        meshes: meshes.collect(),
        warnings: scene.warnings.clone(),
    }
}

/// DESIGN section 4, for one mesh.
fn volume(topology: &TopologyReport, casters: usize) -> &'static str {
    if casters == 0 {
        "none: it casts no shadow"
    } else if topology.triangles == 0 {
        "none: all its triangles are blended or without area"
    } else if topology.is_solid() {
        "closed: one side per silhouette edge"
    } else if topology.solid_components > 0 {
        "partly closed: one side per silhouette edge there; elsewhere every triangle counts, turned to face the light"
    } else {
        "open or not manifold: every triangle counts, turned to face the light"
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.name)?;
        writeln!(f, "  nodes       {} ({} show a mesh)", self.nodes, self.instances)?;
        writeln!(f, "  triangles   {} ({} vertices)", self.triangles, self.vertices)?;
        writeln!(f, "  materials   {} ({} blended)", self.materials, self.blended_materials)?;
        for (title, entries) in [
            ("textures", &self.textures),
            ("lights", &self.lights),
            ("cameras", &self.cameras),
            ("animations", &self.animations),
            ("mirrors", &self.mirrors),
            ("receivers", &self.receivers),
        ] {
            let listed = if entries.is_empty() { "none".into() } else { entries.join(", ") };
            writeln!(f, "  {title:<10}  {listed}")?;
        }
        writeln!(f, "  skins       {}", self.skins)?;
        for mesh in &self.meshes {
            mesh.fmt(f)?;
        }
        for warning in &self.warnings {
            writeln!(f, "  warning: {warning}")?;
        }
        Ok(())
    }
}

impl fmt::Display for MeshReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let topology = &self.topology;
        let moves = match (self.skinned, self.morph_targets) {
            (false, 0) => String::new(),
            (true, 0) => ", skinned".into(),
            (skinned, targets) => format!(", {}{targets} morph targets", if skinned { "skinned, " } else { "" }),
        };
        writeln!(
            f,
            "  mesh {:?}: {} triangles, {} vertices, shown {} times, casting {}{moves}",
            self.name, self.triangles, self.vertices, self.instances, self.casters
        )?;
        writeln!(
            f,
            "    {} components, {} closed; {} border edges, {} non-manifold edges, {} degenerate triangles",
            topology.components,
            topology.closed_components,
            topology.border_edges,
            topology.non_manifold_edges,
            topology.degenerate
        )?;
        if topology.inside_out_components > 0 {
            writeln!(f, "    {} components are inside out", topology.inside_out_components)?;
        }
        writeln!(f, "    volume: {}", self.volume)
    }
}
