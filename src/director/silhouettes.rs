//! Which volumes' silhouettes the device finds, and why the others' it does not.

use std::collections::BTreeMap;

use glam::DVec4;

use crate::frame::{Capabilities, FramePlan, Method, VolumePlan};
use crate::geometry::arena::{Fixed, most_indices, posed_words};
use crate::geometry::{Outline, VolumeParts, light_in_object};
use crate::scene::{Pose, Scene};
use crate::settings::Backend;
use crate::techniques::workspace::Workspace;

/// Gives a finished plan's volumes to the compute shader, as far as it can build them; a note says what stays.
pub(super) fn choose(
    plan: &mut FramePlan,
    backend: Backend,
    (scene, pose): (&Scene, &Pose),
    capabilities: &Capabilities,
    workspace: &Workspace,
) {
    if backend.is_cpu() {
        return;
    }
    let Some(largest) = capabilities.compute_silhouettes else {
        let lack = "this device has no indirect draws that say which volume they draw (INDIRECT_FIRST_INSTANCE)";
        plan.notes.push(format!("silhouettes are found on the CPU: {lack}"));
        return;
    };
    let mut budget = Budget::new(scene, largest);
    let mut left: BTreeMap<&str, usize> = BTreeMap::new();
    // One caster's volumes in one light are built once, whatever sees them.
    let mut decided = workspace.decided.borrow_mut();
    decided.clear();
    let nodes = workspace.numbers.collect(scene.instances().map(|(node, ..)| node));
    for volume in plan.volumes.iter_mut().filter(|volume| volume.method != Method::Dropped) {
        let why_not = unlike(volume).map_or_else(
            || {
                let shape = (volume.instance, volume.light, volume.reflected.is_some(), volume.extrusion.is_some());
                *decided.entry(shape).or_insert_with(|| budget.take(volume, nodes[volume.instance], scene, pose))
            },
            Err,
        );
        match why_not {
            Ok(()) => volume.silhouette = Backend::Compute,
            Err(why) => *left.entry(why).or_default() += 1,
        }
    }
    plan.notes.extend(left.iter().map(|(why, count)| format!("{count} volumes are built on the CPU: {why}")));
}

/// What makes a volume one that the shader does not build.
fn unlike(volume: &VolumePlan) -> Option<&'static str> {
    [
        (volume.outline != Outline::Silhouette, "every polygon has one of its own"),
        (volume.cutout.is_some(), "they are thrown from cut-outs"),
        (volume.projection.is_some_and(|projection| projection.cut), "a receiver's plane cuts their casters"),
        (!volume.piece.is_whole(), "only a part of their casters throws them"),
        (volume.flaw.is_some(), "they are built wrongly on purpose"),
    ]
    .into_iter()
    .find_map(|(found, why)| found.then_some(why))
}

/// What there is still room for in the device's buffers, in words of 32 bits.
struct Budget {
    facing: u64,
    indices: u64,
    poses: u64,
    /// The scene's topologies, and its poses at rest, fit at all.
    fits: bool,
}

impl Budget {
    fn new(scene: &Scene, largest: u64) -> Self {
        // A buffer may be somewhat larger than what is in it.
        let words = largest / 4 - 4;
        let fixed = scene.meshes.iter().map(|mesh| u64::from(Fixed::of(&mesh.topology).words)).sum::<u64>();
        let rest = scene.meshes.iter().map(|mesh| posed_words(&mesh.topology)).sum::<u64>();
        let fits = fixed <= words && rest <= words;
        Self { facing: words, indices: words, poses: words.saturating_sub(rest), fits }
    }

    fn take(&mut self, volume: &VolumePlan, node: usize, scene: &Scene, pose: &Pose) -> Result<(), &'static str> {
        /// Metres: beyond, single precision might run out of exponents.
        const FAR: f64 = 1e9;
        let Some(mesh) = scene.nodes[node].mesh.map(|mesh| &scene.meshes[mesh]) else { return Err("their casters are gone") };
        let light = light_in_object(&volume.placed(&pose.world_from_object[node]), &pose.lights[volume.light]);
        let bounds = pose.bounds(scene, node);
        let size = f64::from(bounds.min.abs().max(bounds.max.abs()).max_element());
        // What is not a number is not near either.
        let near = size < FAR && light.abs().cmplt(DVec4::splat(FAR)).all();
        if !near {
            return Err("caster or light is farther away than a million kilometres");
        }
        let facing = mesh.topology.triangles().len() as u64 * 2;
        let indices = most_indices(&mesh.topology, VolumeParts { start_cap: true, ..VolumeParts::ALL }).iter().sum::<u64>();
        // Of every light anew, though one would do: it is a bound.
        let poses = if pose.deformed[node].is_some() { posed_words(&mesh.topology) } else { 0 };
        if !self.fits || facing > self.facing || indices > self.indices || poses > self.poses {
            return Err("the device's buffers are too small for all of them");
        }
        self.facing -= facing;
        self.indices -= indices;
        self.poses -= poses;
        Ok(())
    }
}
