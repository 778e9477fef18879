//! Random views: eye and light thrown through and around a scene, the same for the same seed everywhere.
//!
//! Most views of most scenes are easy. So the eyes go where shadow volumes are hard, in turn: anywhere
//! in and around the scene, in a caster's box, behind a caster seen from the light (in its shadow),
//! and so close to a caster's surface that the near plane cuts it; and where the scene has mirrors, close
//! before one and behind it.

use fastrand::Rng;
use glam::{DVec3, DVec4};
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
    /// Close to a mirror, on either side.
    AtMirror,
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
        let mut stray = moment.stray(scene, light, view, &mut random);
        // Light off mirrors is the harder part.
        let off_mirrors = scene.lights_in_force(&base.mirrors) / scene.lights.len() - 1;
        if only.is_none() && off_mirrors > 0 && random.u32(..3) > 0 {
            stray.settings.light = scene.lights.len() + light * off_mirrors + random.usize(..off_mirrors);
        }
        strays.push(stray);
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
    /// The triangles of mirrors, world space, each with its mirror's plane.
    glass: Vec<([DVec3; 3], DVec4)>,
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
        let mirrors = scene.mirrors_in_force(&settings.mirrors).0;
        let posed = mirrors.iter().filter_map(|mirror| mirror.posed(scene, &pose).ok());
        let glass = posed.flat_map(|posed| posed.triangles.into_iter().map(move |corners| (corners, posed.plane))).collect();
        Self { settings, pose, low: low - margin, high: high + margin, casters, glass, near }
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
        let places = if self.glass.is_empty() { 6 } else { 8 };
        let place = match random.u32(..places) {
            0 => Place::AtCaster,
            1 => Place::BehindCaster,
            2 => Place::AcrossNearPlane,
            6.. => return (Place::AtMirror, self.at_mirror(random)),
            _ => Place::Anywhere,
        };
        let anywhere = between(random, self.low, self.high);
        let Some((node, bounds)) = random.choice(&self.casters) else { return (Place::Anywhere, anywhere) };
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let inside = between(random, low, high);
        match place {
            Place::Anywhere | Place::AtMirror => (place, anywhere),
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

    /// A place before a mirror or behind it, mostly before, at a distance of any order of magnitude between a
    /// hundredth of the near plane's and the scene's width.
    fn at_mirror(&self, random: &mut Rng) -> DVec3 {
        let Some((corners, plane)) = random.choice(&self.glass) else { return self.low };
        let (least, most) = (self.near * 0.01, (self.high - self.low).length() * 0.5);
        let distance = least * (most / least).powf(random.f64());
        let side = if random.u32(..4) == 0 { -1.0 } else { 1.0 };
        in_triangle(*corners, random) + plane.truncate() * (side * distance)
    }

    /// A point of a node's mesh, world space.
    fn on_surface(&self, scene: &Scene, node: usize, random: &mut Rng) -> Option<DVec3> {
        let mesh = &scene.meshes[scene.nodes[node].mesh?];
        let triangle = random.choice(mesh.topology.mesh_triangles())?;
        let positions = self.pose.positions(scene, node);
        let corner = |at: u32| positions[mesh.indices[(triangle * 3 + at) as usize] as usize].as_dvec3();
        let at = in_triangle([corner(0), corner(1), corner(2)], random);
        Some(self.pose.world_from_object[node].transform_point3(at))
    }
}

fn in_triangle([a, b, c]: [DVec3; 3], random: &mut Rng) -> DVec3 {
    let (mut u, mut v) = (random.f64(), random.f64());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    a + (b - a) * u + (c - a) * v
}

fn between(random: &mut Rng, low: DVec3, high: DVec3) -> DVec3 {
    low + (high - low) * DVec3::new(random.f64(), random.f64(), random.f64())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)] // a test may stop where it stands
    use super::*;
    use crate::scene::stock;
    use crate::settings::{MirrorMode, Mirrors};
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
    fn eyes_go_before_and_behind_mirrors_where_there_are_some() {
        let scene = stock::build("barbershop").unwrap().unwrap();
        let base = Settings::default();
        let eyes = |settings: &Settings| {
            let all = strays(&scene, settings, None, 120, 3);
            let mirrors = all.into_iter().filter(|stray| stray.place == Place::AtMirror);
            let eye = |stray: Stray| match stray.settings.camera {
                CameraChoice::Free { eye, .. } => eye,
                other => panic!("{other:?}"),
            };
            mirrors.map(eye).collect::<Vec<_>>()
        };
        // They hang at 2.27 m left and right of the middle, over the counters.
        let eyes_on = eyes(&base);
        let behind = eyes_on.iter().filter(|eye| eye.x.abs() > 2.27).count();
        let close = eyes_on.iter().filter(|eye| (eye.x.abs() - 2.27).abs() < 0.1).count();
        assert!(eyes_on.len() > 15 && behind > 2 && close > 5, "{eyes_on:?}");
        assert!(eyes_on.iter().all(|eye| (eye.y - 1.72).abs() < 0.72 && (eye.z + 0.7).abs() < 2.34), "{eyes_on:?}");
        let off = Mirrors { mode: MirrorMode::Off, ..Mirrors::default() };
        assert!(eyes(&Settings { mirrors: off, ..base }).is_empty());
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
