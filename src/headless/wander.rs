//! Random views: eye and light thrown through and around a scene, the same for the same seed everywhere.
//!
//! Most views of most scenes are easy. So the eyes go where shadow volumes are hard, in turn: anywhere
//! in and around the scene, in a caster's box, behind a caster seen from the light (in its shadow),
//! and so close to a caster's surface that the near plane cuts it.

use fastrand::Rng;
use glam::DVec3;
use serde::Serialize;

use crate::frame::Camera;
use crate::geometry::Aabb;
use crate::scene::{LightKind, Pose, Scene, pose::pose};
use crate::settings::{CameraChoice, LightEdit, Settings};

/// Where an eye was put.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// In and around the scene.
    Anywhere,
    /// In or at the box of a caster.
    AtCaster,
    /// On the far side of a caster, seen from the light.
    BehindCaster,
    /// A caster's surface lies before the near plane, or across it.
    AcrossNearPlane,
}

/// One view.
#[derive(Debug, Clone, PartialEq)]
pub struct Stray {
    /// What draws it: camera, light, time and the light's edit are set.
    pub settings: Settings,
    /// Where its eye is.
    pub place: Place,
}

/// So many views share a moment of a scene that moves, so that its triangles are sorted once.
const VIEWS_A_MOMENT: usize = 10;

/// `count` views of `scene`, everything else as `base` says. Lights are those that `only` allows. None
/// for a scene without lights.
#[must_use]
pub fn strays(scene: &Scene, base: &Settings, only: Option<usize>, count: usize, seed: u64) -> Vec<Stray> {
    let mut random = Rng::with_seed(seed);
    let mut strays = Vec::with_capacity(count);
    let mut moment = None;
    if scene.lights.is_empty() {
        return strays;
    }
    for view in 0..count {
        if view % VIEWS_A_MOMENT == 0 {
            let time = if scene.animations.is_empty() { base.time } else { base.time + random.f64() * 20.0 };
            moment = Some(Moment::new(scene, Settings { time, ..base.clone() }));
        }
        let Some(moment) = &moment else { break };
        let light = only.unwrap_or_else(|| random.usize(..scene.lights.len()));
        strays.push(moment.stray(scene, light, view, &mut random));
    }
    strays
}

/// A scene at one time.
struct Moment {
    settings: Settings,
    pose: Pose,
    /// World space: where eyes and lights go, somewhat larger than what casts.
    low: DVec3,
    high: DVec3,
    /// Nodes that cast, with their boxes in world space.
    casters: Vec<(usize, Aabb)>,
    near: f64,
}

impl Moment {
    fn new(scene: &Scene, settings: Settings) -> Self {
        let pose = pose(scene, settings.time, settings.animation.unwrap_or(scene.default_animation), &settings.lights);
        let casters: Vec<_> = scene
            .instances()
            .filter(|(_, node, mesh)| node.casts_shadow && !mesh.topology.triangles().is_empty())
            .map(|(node, ..)| (node, pose.world_bounds(scene, node)))
            .collect();
        // Where the casters are: floors reach much farther than what stands on them.
        let mut bounds = casters.iter().fold(Aabb::EMPTY, |held, (_, bounds)| held.union(bounds));
        if bounds.is_empty() {
            bounds = scene.bounds(&pose);
        }
        if bounds.is_empty() {
            bounds = Aabb::around(DVec3::NEG_ONE, DVec3::ONE);
        }
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        // A sheet has no height, and the views are to leave its plane.
        let margin = ((high - low) * 0.25).max(DVec3::splat((high - low).max_element() * 0.1));
        let near = Camera::choose(&settings, scene, &pose).map_or(crate::frame::camera::DEFAULT_NEAR, |camera| camera.near);
        Self { settings, pose, low: low - margin, high: high + margin, casters, near }
    }

    fn stray(&self, scene: &Scene, light: usize, view: usize, random: &mut Rng) -> Stray {
        let mut settings = self.settings.clone();
        settings.light = light;
        let directional = matches!(scene.lights[light].kind, LightKind::Directional);
        let mut position = None;
        if !directional {
            let at = between(random, self.low, self.high);
            position = Some(at);
            let edit: &mut LightEdit = settings.lights.entry(light).or_default();
            edit.position = position;
            // Every fourth light ends within the scene, the others shine as far as it goes.
            #[expect(clippy::cast_possible_truncation, reason = "settings hold single precision")]
            let range = ((self.high - self.low).length() * 0.25) as f32;
            edit.range = Some(if view % 4 == 3 && range > 0.0 { range } else { f32::INFINITY });
        }
        let (place, eye) = self.eye(scene, light, position, random);
        let mut target = between(random, self.low, self.high);
        if target.distance(eye) < 1e-3 {
            target = eye + DVec3::NEG_Z;
        }
        settings.camera = CameraChoice::Free { eye, target };
        Stray { settings, place }
    }

    fn eye(&self, scene: &Scene, light: usize, position: Option<DVec3>, random: &mut Rng) -> (Place, DVec3) {
        let place = match random.u32(..6) {
            0 => Place::AtCaster,
            1 => Place::BehindCaster,
            2 => Place::AcrossNearPlane,
            _ => Place::Anywhere,
        };
        let anywhere = between(random, self.low, self.high);
        let Some((node, bounds)) = random.choice(&self.casters) else { return (Place::Anywhere, anywhere) };
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let inside = between(random, low, high);
        match place {
            Place::Anywhere => (place, anywhere),
            Place::AtCaster => (place, between(random, low - self.near, high + self.near)),
            Place::BehindCaster => {
                let away = match position {
                    Some(position) => inside - position,
                    None => self.pose.lights[light].direction * (self.high - self.low).length() * 0.5,
                };
                (place, inside + away * (0.05 + random.f64()))
            }
            Place::AcrossNearPlane => {
                let off = between(random, DVec3::NEG_ONE, DVec3::ONE) * self.near;
                (place, self.on_surface(scene, *node, random).unwrap_or(inside) + off)
            }
        }
    }

    /// A point of a node's mesh, world space.
    fn on_surface(&self, scene: &Scene, node: usize, random: &mut Rng) -> Option<DVec3> {
        let mesh = &scene.meshes[scene.nodes[node].mesh?];
        let triangle = random.choice(mesh.topology.mesh_triangles())?;
        let positions = self.pose.positions(scene, node);
        let corner = |at: u32| positions[mesh.indices[(triangle * 3 + at) as usize] as usize].as_dvec3();
        let (mut u, mut v) = (random.f64(), random.f64());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let at = corner(0) + (corner(1) - corner(0)) * u + (corner(2) - corner(0)) * v;
        Some(self.pose.world_from_object[node].transform_point3(at))
    }
}

fn between(random: &mut Rng, low: DVec3, high: DVec3) -> DVec3 {
    low + (high - low) * DVec3::new(random.f64(), random.f64(), random.f64())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)] // a test may stop where it stands
    use super::*;
    use crate::scene::stock;
    use std::collections::BTreeSet;

    #[test]
    fn the_same_seed_strays_the_same_way_and_everywhere() {
        let scene = stock::build("courtyard").unwrap().unwrap();
        let base = Settings::default();
        let all = strays(&scene, &base, None, 60, 7);
        assert_eq!(all, strays(&scene, &base, None, 60, 7));
        assert_ne!(all, strays(&scene, &base, None, 60, 8));
        let places: BTreeSet<_> = all.iter().map(|stray| stray.place).collect();
        assert_eq!(places.len(), 4);
        let lights: BTreeSet<_> = all.iter().map(|stray| stray.settings.light).collect();
        assert_eq!(lights.len(), scene.lights.len());
        assert!(strays(&scene, &base, Some(1), 9, 7).iter().all(|stray| stray.settings.light == 1));
        for stray in &all {
            crate::cli::check(&stray.settings).unwrap();
            crate::cli::check_against(&stray.settings, &scene).unwrap();
        }
    }

    #[test]
    fn a_scene_without_lights_has_no_views_and_one_without_casters_has() {
        let mut scene = stock::build("cubes").unwrap().unwrap();
        scene.nodes.iter_mut().for_each(|node| node.casts_shadow = false);
        assert_eq!(strays(&scene, &Settings::default(), None, 5, 1).len(), 5);
        scene.lights.clear();
        assert!(strays(&scene, &Settings::default(), None, 5, 1).is_empty());
    }
}
