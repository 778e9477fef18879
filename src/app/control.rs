//! Moving the eye by mouse and keys: an orbit about the point of interest, and free flight.
//!
//! Each movement is a pure function from the camera that is shown to another free one: no state is
//! kept, so the mouse carries on from wherever the panel, a named camera or a settings file put
//! the eye.

use glam::{DQuat, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::frame::Camera;
use crate::settings::{CameraChoice, Settings};

/// What dragging the mouse does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// The eye turns about what it looks at.
    #[default]
    Orbit,
    /// The eye turns its head.
    Fly,
}

/// How close to straight up or down the view may come, radians: beyond it, up is undefined.
const POLE: f64 = 0.01;

/// The nearest the eye comes to its target, metres.
const NEAREST: f64 = 0.05;

/// The farthest it goes from it: beyond, single precision has nothing left for the scene.
const FARTHEST: f64 = 1.0e5;

/// Where a movement leads: the eye, and what it looks at, metres, world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Where the eye is.
    pub eye: DVec3,
    /// What it looks at.
    pub target: DVec3,
}

impl Place {
    fn of(camera: &Camera) -> Self {
        let distance = if camera.focus_distance.is_finite() { camera.focus_distance.clamp(NEAREST, FARTHEST) } else { 1.0 };
        Self { eye: camera.eye, target: camera.eye + camera.forward * distance }
    }

    /// The settings' word for it; none where numbers ran out.
    #[must_use]
    pub fn choice(self) -> Option<CameraChoice> {
        let fine = self.eye.is_finite() && self.target.is_finite() && self.eye.distance_squared(self.target) > 0.0;
        fine.then_some(CameraChoice::Free { eye: self.eye, target: self.target })
    }
}

/// `forward` turned left by `yaw` and up by `pitch` radians, kept off the poles.
fn turned(forward: DVec3, yaw: f64, pitch: f64) -> DVec3 {
    let yawed = DQuat::from_rotation_y(yaw) * forward;
    let flat = DVec3::new(yawed.x, 0.0, yawed.z).try_normalize().unwrap_or(DVec3::NEG_Z);
    let up_by = yawed.y.clamp(-1.0, 1.0).asin() + pitch;
    let limit = std::f64::consts::FRAC_PI_2 - POLE;
    let (sin, cos) = up_by.clamp(-limit, limit).sin_cos();
    flat * cos + DVec3::Y * sin
}

/// The mouse moved by `drag`, in picture heights (x to the right, y down): the eye turns about its target.
#[must_use]
pub fn orbit(camera: &Camera, drag: DVec2) -> Place {
    let place = Place::of(camera);
    let forward = turned(camera.forward, -drag.x * std::f64::consts::PI, -drag.y * std::f64::consts::PI);
    Place { eye: place.target - forward * place.eye.distance(place.target), target: place.target }
}

/// The mouse moved by `drag`, in picture heights: the eye turns that way, where it is.
#[must_use]
pub fn look(camera: &Camera, drag: DVec2) -> Place {
    let place = Place::of(camera);
    let forward = turned(camera.forward, -drag.x * camera.vertical_fov, -drag.y * camera.vertical_fov);
    Place { eye: place.eye, target: place.eye + forward * place.eye.distance(place.target) }
}

/// The mouse moved by `drag`, in picture heights: eye and target move with it, so that the target
/// stays under the mouse.
#[must_use]
pub fn pan(camera: &Camera, drag: DVec2) -> Place {
    let place = Place::of(camera);
    let height = 2.0 * place.eye.distance(place.target) * (camera.vertical_fov * 0.5).tan();
    let right = camera.forward.cross(camera.up);
    let shift = (camera.up * drag.y - right * drag.x) * height;
    Place { eye: place.eye + shift, target: place.target + shift }
}

/// The wheel turned by `notches` (positive: nearer).
#[must_use]
pub fn zoom(camera: &Camera, notches: f64) -> Place {
    let place = Place::of(camera);
    let distance = (place.eye.distance(place.target) * 0.87f64.powf(notches)).clamp(NEAREST, FARTHEST);
    Place { eye: place.target - camera.forward * distance, target: place.target }
}

/// Flies by `right`, `up` and `forward` metres, along the view's own right and forward and the world's up.
#[must_use]
pub fn fly(camera: &Camera, right: f64, up: f64, forward: f64) -> Place {
    let place = Place::of(camera);
    let shift = camera.forward.cross(camera.up) * right + DVec3::Y * up + camera.forward * forward;
    Place { eye: place.eye + shift, target: place.target + shift }
}

/// Puts the eye there. A named camera's angle of view is kept, since a free eye would else take the
/// first camera's.
pub fn place(settings: &mut Settings, camera: &Camera, place: Place) {
    let Some(choice) = place.choice() else { return };
    if matches!(settings.camera, CameraChoice::Named(_)) && settings.fov.is_none() {
        settings.fov = Some((camera.vertical_fov.to_degrees() * 100.0).round() / 100.0);
    }
    settings.camera = choice;
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a failed unwrap is a failed test
    use super::*;

    fn camera() -> Camera {
        Camera::look_at(DVec3::new(4.0, 3.0, 6.0), DVec3::new(0.0, 1.0, 0.0), 0.9, 1.5, 0.1).unwrap()
    }

    fn look_from(place: Place) -> Camera {
        Camera::look_at(place.eye, place.target, 0.9, 1.5, 0.1).unwrap()
    }

    #[test]
    fn an_orbit_keeps_target_and_distance() {
        let camera = camera();
        for drag in [DVec2::new(0.3, 0.0), DVec2::new(-2.0, 0.4), DVec2::new(0.1, 5.0), DVec2::new(0.0, -5.0)] {
            let place = orbit(&camera, drag);
            assert!(place.target.distance(camera.target()) < 1e-9);
            assert!((place.eye.distance(place.target) - camera.focus_distance).abs() < 1e-9);
            assert!(place.choice().is_some());
        }
        assert!(orbit(&camera, DVec2::new(0.0, 5.0)).eye.y > camera.eye.y, "dragging down lifts the eye");
        let back = orbit(&look_from(orbit(&camera, DVec2::new(0.2, 0.0))), DVec2::new(-0.2, 0.0));
        assert!(back.eye.distance(camera.eye) < 1e-9);
    }

    #[test]
    fn an_orbit_never_passes_the_pole() {
        let mut camera = camera();
        for _ in 0..50 {
            camera = look_from(orbit(&camera, DVec2::new(0.05, 0.2)));
            assert!(camera.up.y > 0.0);
        }
        assert!(camera.forward.y < -0.99);
    }

    #[test]
    fn looking_leaves_the_eye_and_flying_leaves_the_view() {
        let camera = camera();
        let place = look(&camera, DVec2::new(0.3, -0.2));
        assert_eq!(place.eye, camera.eye);
        let turn = (place.target - place.eye).normalize();
        assert!(turn.dot(camera.forward.cross(camera.up)) > 0.0 && turn.dot(camera.up) > 0.0, "right and up");
        let flown = look_from(fly(&camera, 1.0, 2.0, 3.0));
        assert!(flown.forward.distance(camera.forward) < 1e-9);
        assert!((fly(&camera, 0.0, 0.0, 2.0).eye - camera.eye - camera.forward * 2.0).length() < 1e-9);
    }

    #[test]
    fn a_pan_keeps_the_target_under_the_mouse() {
        let camera = camera();
        let panned = look_from(pan(&camera, DVec2::new(0.25, -0.1)));
        let clip = panned.clip_from_world() * camera.target().extend(1.0);
        // A picture is 2 clip units high; x is squeezed by the aspect.
        assert!((clip.x / clip.w * 0.5 * camera.aspect - 0.25).abs() < 1e-9);
        assert!((clip.y / clip.w * 0.5 - 0.1).abs() < 1e-9);
    }

    #[test]
    fn zooming_ends_before_the_target_and_before_infinity() {
        let mut camera = camera();
        for _ in 0..500 {
            camera = look_from(zoom(&camera, 1.0));
        }
        assert!((camera.focus_distance - NEAREST).abs() < 1e-6);
        assert!(zoom(&camera, -1e6).choice().is_some());
    }

    #[test]
    fn a_named_cameras_angle_is_kept() {
        let camera = camera();
        let mut settings = Settings { camera: CameraChoice::Named("tower".into()), ..Settings::default() };
        place(&mut settings, &camera, zoom(&camera, 1.0));
        assert!(matches!(settings.camera, CameraChoice::Free { .. }));
        assert_eq!(settings.fov, Some(51.57));
        let mut settings = Settings::default();
        place(&mut settings, &camera, zoom(&camera, 1.0));
        assert_eq!(settings.fov, None);
        place(&mut settings, &camera, Place { eye: DVec3::NAN, target: DVec3::ZERO });
        assert!(matches!(settings.camera, CameraChoice::Free { eye, .. } if eye.is_finite()));
    }
}
