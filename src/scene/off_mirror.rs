//! Light off mirrors: each light once more behind each mirror (K section 3, "reflect light sources through
//! mirrors"; Diefenbach's thesis has it with shadow volumes).
//!
//! ```text
//!        light *                     what is lit by way of the mirror: everything that sees the
//!               \         . P        virtual light through the mirror's outline, and has nothing
//!                \      .            in its way, neither from the mirror on (Q to P) nor
//!     ---- ====== Q =====  ----      before it (light to Q)
//!               .   mirror
//!      virtual * light               its distance to P is the length of the whole way
//! ```
//!
//! A virtual light is a light as any other: it has a kind, a colour, a range and a cone, all reflected. That it shines
//! only through the mirror, and what stands in its way, is up to whoever counts its shadows
//! ([`crate::techniques::off_mirror`]) or casts its rays ([`crate::truth`]).

use glam::DVec4;

use super::{LightKind, Mirror, Pose, PosedLight, Scene};
use crate::geometry::planar::{height, reflection};
use crate::settings::{self, MirrorLight};

/// The mirror that a virtual light comes off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OffMirror {
    /// The scene's light that is reflected.
    pub light: usize,
    /// The mirror's number among those in force.
    pub mirror: usize,
    /// The instance that shows it, as [`Scene::instances`] counts.
    pub instance: usize,
    /// Which of its mesh's primitives it is.
    pub primitive: usize,
    /// World space: the mirror's plane, its normal towards the side that the light is on; none where the mirror does not
    /// reflect this light, which stands behind it or on its plane.
    pub plane: Option<DVec4>,
}

/// Of the largest coordinate: so near a mirror's plane single precision may have a light on either side.
const ON_THE_PLANE: f64 = 2e-6;

impl PosedLight {
    /// The same light as it is seen in a mirror.
    #[must_use]
    pub fn reflected(&self, plane: DVec4) -> Self {
        let reflection = reflection(plane);
        Self {
            position: reflection.transform_point3(self.position),
            center: reflection.transform_point3(self.center),
            direction: reflection.transform_vector3(self.direction),
            right: reflection.transform_vector3(self.right),
            ..*self
        }
    }

    /// How high it stands over a plane: metres, or for a directional light how steeply it shines down.
    fn over(&self, plane: DVec4) -> f64 {
        match self.kind {
            LightKind::Directional => -plane.truncate().dot(self.direction),
            LightKind::Point | LightKind::Spot { .. } => height(plane, self.position),
        }
    }
}

impl Pose {
    /// Appends each light once more for each of `mirrors`, light by light, whether it reflects it or not: numbers do not
    /// change with what moves.
    pub fn add_lights_off(&mut self, scene: &Scene, mirrors: &[Mirror]) {
        let largest = scene.bounds(self);
        let largest = f64::from(largest.min.abs().max(largest.max.abs()).max_element());
        let posed: Vec<_> = mirrors.iter().map(|mirror| mirror.posed(scene, self).ok()).collect();
        for index in 0..self.lights.len() {
            let light = self.lights[index];
            for (number, (mirror, posed)) in mirrors.iter().zip(&posed).enumerate() {
                let room = ON_THE_PLANE * largest.max(light.position.abs().max_element());
                let room = if light.kind == LightKind::Directional { ON_THE_PLANE } else { room };
                let plane = posed.as_ref().filter(|posed| posed.turn.is_none()).and_then(|posed| match light.over(posed.plane) {
                    over if over > room => Some(posed.plane),
                    over if over < -room && mirror.double_sided => Some(-posed.plane),
                    _ => None,
                });
                let off =
                    OffMirror { light: index, mirror: number, instance: mirror.instance, primitive: mirror.primitive, plane };
                let there = plane.map_or(light, |plane| light.reflected(plane));
                self.lights.push(PosedLight {
                    off: Some(off),
                    of: self.lights.len(),
                    on: light.on && plane.is_some(),
                    intensity: light.intensity * mirror.look.tint * mirror.look.reflectivity,
                    ..there
                });
            }
        }
    }
}

impl Scene {
    /// The lights that a frame has: the scene's, and those off mirrors after them; the points of lights with a size are
    /// not counted.
    #[must_use]
    pub fn lights_in_force(&self, settings: &settings::Mirrors) -> usize {
        match settings.light {
            MirrorLight::Virtual => self.lights.len() * (1 + self.mirrors_in_force(settings).0.len()),
            MirrorLight::Off | MirrorLight::Ambient => self.lights.len(),
        }
    }

    /// The name of one of the lights that a frame has.
    #[must_use]
    pub fn light_name(&self, settings: &settings::Mirrors, light: usize) -> String {
        let Some(beyond) = light.checked_sub(self.lights.len()) else { return self.lights[light].name.clone() };
        let mirrors = self.mirrors_in_force(settings).0;
        match (self.lights.get(beyond / mirrors.len().max(1)), mirrors.get(beyond % mirrors.len().max(1))) {
            (Some(light), Some(mirror)) => format!("{} off {}", light.name, mirror.name),
            _ => String::new(),
        }
    }
}
