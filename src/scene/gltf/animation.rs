//! Animations: keyframes checked against what they move.

use gltf::json;
use gltf::json::Root;
use gltf::json::animation::{Channel as GltfChannel, Interpolation as GltfInterpolation, Property as GltfProperty};
use gltf::json::validation::Checked;

use super::accessor::{self, Store, Wanted};
use super::error::{AccessorError, Problem, Warnings, name, part};
use super::nodes::Hierarchy;
use crate::scene::{Animation, Channel, Interpolation, Mesh, Node, Property};

/// All animations of the file that move something in the scene.
pub(super) fn import(
    root: &Root,
    store: &Store<'_>,
    hierarchy: &Hierarchy,
    nodes: &[Node],
    meshes: &[Mesh],
    warnings: &mut Warnings,
) -> Result<Vec<Animation>, Problem> {
    let mut animations = Vec::new();
    for (index, animation) in root.animations.iter().enumerate() {
        let named = || part("animation", index, animation.name.as_deref());
        let mut channels = Vec::new();
        for (number, channel) in animation.channels.iter().enumerate() {
            let name = || format!("{}, channel {number}", named());
            let reader = Reader { root, store, animation, channel, name: &name };
            channels.extend(reader.read(hierarchy, nodes, meshes, warnings)?);
        }
        if channels.is_empty() {
            warnings.push(format!("{}: it moves nothing in this scene and is left out", named()));
            continue;
        }
        let last = channels.iter().filter_map(|channel| channel.times.last()).fold(0.0f32, |a, b| a.max(*b));
        let name = name("animation", index, animation.name.as_deref());
        animations.push(Animation { name, channels, duration: f64::from(last) });
    }
    Ok(animations)
}

struct Reader<'a> {
    root: &'a Root,
    store: &'a Store<'a>,
    animation: &'a json::Animation,
    channel: &'a GltfChannel,
    name: &'a dyn Fn() -> String,
}

impl Reader<'_> {
    fn error(&self, what: String) -> Problem {
        Problem::Part { part: (self.name)(), what }
    }

    /// The channel; `None` where it moves nothing of the scene's.
    fn read(
        &self,
        hierarchy: &Hierarchy,
        nodes: &[Node],
        meshes: &[Mesh],
        warnings: &mut Warnings,
    ) -> Result<Option<Channel>, Problem> {
        let target = &self.channel.target;
        let (property, width, wanted): (_, _, &Wanted) = match target.path {
            Checked::Valid(GltfProperty::Translation) => (Property::Translation, 3, &accessor::VEC3),
            Checked::Valid(GltfProperty::Rotation) => (Property::Rotation, 4, &accessor::VEC4),
            Checked::Valid(GltfProperty::Scale) => (Property::Scale, 3, &accessor::VEC3),
            Checked::Valid(GltfProperty::MorphTargetWeights) => (Property::Weights, 0, &accessor::SCALAR),
            Checked::Invalid => {
                warnings.push(format!("{}: what it moves is not one of glTF's and stands still", (self.name)()));
                return Ok(None);
            }
        };
        let sampler = self.channel.sampler.value();
        let Some(sampler) = self.animation.samplers.get(sampler) else {
            return Err(self.error(format!("sampler {sampler} does not exist; there are {}", self.animation.samplers.len())));
        };
        if target.node.value() >= self.root.nodes.len() {
            return Err(self.error(format!("node {} does not exist; the file has {}", target.node, self.root.nodes.len())));
        }
        let Some(node) = hierarchy.find(target.node) else { return Ok(None) };
        let morphs = || nodes[node].mesh.map_or(0, |mesh| meshes[mesh].morphs.len());
        let width = if property == Property::Weights { morphs() } else { width };
        if width == 0 {
            warnings.push(format!("{}: its node has no morph targets", (self.name)()));
            return Ok(None);
        }
        let interpolation = match sampler.interpolation {
            Checked::Valid(GltfInterpolation::Step) => Interpolation::Step,
            Checked::Valid(GltfInterpolation::Linear) => Interpolation::Linear,
            Checked::Valid(GltfInterpolation::CubicSpline) => Interpolation::CubicSpline,
            Checked::Invalid => return Err(self.error("its interpolation is not one of glTF's".into())),
        };
        let input_name = || format!("{}, input", (self.name)());
        let times = self.store.floats(sampler.input, &accessor::SCALAR, input_name)?;
        let output_name = || format!("{}, output", (self.name)());
        let values = self.store.floats(sampler.output, wanted, output_name)?;
        let per_key = if interpolation == Interpolation::CubicSpline { 3 * width } else { width };
        let needed = times.count().checked_mul(per_key);
        if needed != Some(values.values.len()) {
            let wanted = needed.unwrap_or(usize::MAX) / values.width.max(1);
            let error = AccessorError::Count { found: values.count(), wanted };
            return Err(Store::error(sampler.output, error, output_name));
        }
        let bytes = (times.values.len() + values.values.len()) as u64 * 4;
        if !self.store.budget().take(Some(bytes)) {
            return Err(Problem::TooLarge { what: "its animation is", limit: super::budget_words() });
        }
        let mut channel = Channel { node, property, interpolation, times: Vec::new(), values: Vec::new() };
        for (time, values) in times.values.iter().zip(values.values.chunks_exact(per_key)) {
            // Some writers repeat a key; the first of a time counts.
            if channel.times.last().is_none_or(|last| last < time) {
                channel.times.push(*time);
                channel.values.extend_from_slice(values);
            }
        }
        if channel.times.len() < times.count() {
            warnings.push(format!("{}: {} keys that do not rise in time", (self.name)(), times.count() - channel.times.len()));
        }
        if channel.times.is_empty() {
            warnings.push(format!("{}: it has no keys", (self.name)()));
            return Ok(None);
        }
        Ok(Some(channel))
    }
}
