//! Whether the last frame's volumes are this one's too, indices and all.
//!
//! Where no caster, pose or light has moved, and the steps draw the same parts, there is nothing to build and nothing to
//! upload: the eye may go where it likes, for volumes are built in their casters' own spaces.

use crate::frame::VolumePart;
use crate::geometry::VolumeParts;
use crate::settings::Backend;

/// What one volume's indices depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Its caster.
    pub instance: usize,
    /// The build of its caster's planes ([`crate::geometry::Planes::build_number`]).
    pub posed: u64,
    /// The light in object space, as bits.
    pub light: [u32; 4],
    /// What is built of it.
    pub parts: Option<VolumeParts>,
    /// The volume whose indices it shares.
    pub first: usize,
    /// Nothing else has a say.
    pub plain: bool,
    /// What finds its silhouette.
    pub silhouette: Backend,
}

/// What the indices of the last frame that was uploaded depended on, and this one's.
#[derive(Debug, Default)]
pub struct Kept {
    volumes: [Vec<Shape>; 2],
    draws: [Vec<(usize, VolumePart)>; 2],
    uploaded: bool,
}

impl Kept {
    /// Another frame begins.
    pub fn start(&mut self) {
        self.volumes[1].clear();
        self.draws[1].clear();
    }

    /// One of its volumes, in order.
    pub fn volume(&mut self, shape: Shape) {
        self.volumes[1].push(shape);
    }

    /// The parts that one of its draws draws, by the draw's number among the plan's.
    pub fn draw(&mut self, number: usize, parts: &[VolumePart]) {
        self.draws[1].extend(parts.iter().map(|part| (number, *part)));
    }

    /// Whether what is on the device is right for this frame.
    #[must_use]
    pub fn is_same(&self) -> bool {
        let [before, now] = &self.volumes;
        let [drawn, draws] = &self.draws;
        self.uploaded && before == now && drawn == draws && now.iter().all(|shape| shape.plain || shape.parts.is_none())
    }

    /// This frame's indices are on the device.
    pub fn written(&mut self) {
        self.volumes.swap(0, 1);
        self.draws.swap(0, 1);
        self.uploaded = true;
    }

    /// Nothing of use is on the device.
    pub fn forget(&mut self) {
        self.uploaded = false;
    }
}
