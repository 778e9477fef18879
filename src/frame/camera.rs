//! The eye: where it is, what it sees, and the one projection everything shares.

use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4};
use thiserror::Error;

use crate::geometry::near_rectangle::{ThroughLight, through_light};
use crate::geometry::planar::reflection;
use crate::scene::{Pose, Scene};
use crate::settings::{CameraChoice, Settings};

/// A perspective eye in world space.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Camera {
    /// Metres.
    pub eye: DVec3,
    /// Unit, where it looks.
    pub forward: DVec3,
    /// Unit, square to `forward`.
    pub up: DVec3,
    /// Full vertical angle, radians, in (0, pi).
    pub vertical_fov: f64,
    /// Width over height.
    pub aspect: f64,
    /// Distance of the near plane, metres.
    pub near: f64,
    /// Distance of the far plane, metres; none by default, and volumes need none (DESIGN section 3).
    pub far: Option<f64>,
    /// How far along `forward` the point of interest lies, metres: what an orbit turns about.
    pub focus_distance: f64,
    /// How far the picture lies beside where it would, in halves of it, to the right and up: a part of a
    /// pixel, where several frames are gathered into one picture.
    pub shift: DVec2,
    /// Looks by way of an odd number of mirrors: what is to the right of the eye is on the left of the picture.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub mirrored: bool,
}

/// Why there is no such camera.
#[derive(Debug, Error, PartialEq)]
pub enum CameraError {
    /// No such name, and no such index.
    #[error("no camera `{0}` in this scene; it has: {1}")]
    Unknown(String, String),
    /// A coordinate is NaN or infinite, or the eye is the target.
    #[error("the camera's {0}")]
    Degenerate(&'static str),
    /// The angle is outside (0, 180) degrees.
    #[error("the field of view must lie between 0 and 180 degrees, not {0}")]
    FieldOfView(f64),
    /// The far plane is not behind the near one.
    #[error("the far plane must lie beyond the near plane at {1} m, not at {0} m")]
    Far(f64, f64),
}

/// The near plane of cameras that do not say, metres.
pub const DEFAULT_NEAR: f64 = 0.1;

impl Camera {
    /// The camera that `settings` ask for, in `scene` as posed, for a picture of `settings.size`.
    ///
    /// # Errors
    /// An unknown camera, coordinates that are no place, an angle out of range.
    pub fn choose(settings: &Settings, scene: &Scene, pose: &Pose) -> Result<Self, CameraError> {
        let aspect = f64::from(settings.size[0].max(1)) / f64::from(settings.size[1].max(1));
        let mut camera = match &settings.camera {
            CameraChoice::First => Self::of_scene(scene, pose, 0, aspect),
            CameraChoice::Named(name) => {
                let index = scene
                    .cameras
                    .iter()
                    .position(|camera| camera.name == *name)
                    .or_else(|| name.parse().ok().filter(|index| *index < scene.cameras.len()))
                    .ok_or_else(|| {
                        let names: Vec<_> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
                        CameraError::Unknown(name.clone(), names.join(", "))
                    })?;
                Self::of_scene(scene, pose, index, aspect)
            }
            CameraChoice::Free { eye, target } => {
                let first = Self::of_scene(scene, pose, 0, aspect);
                Self::look_at(*eye, *target, first.vertical_fov, aspect, first.near)?
            }
        };
        if let Some(degrees) = settings.fov {
            if !(degrees > 0.0 && degrees < 180.0) {
                return Err(CameraError::FieldOfView(degrees));
            }
            camera.vertical_fov = degrees.to_radians();
        }
        if let Some(far) = settings.far {
            if !(far > camera.near && far.is_finite()) {
                return Err(CameraError::Far(far, camera.near));
            }
            camera.far = Some(far);
        }
        Ok(camera)
    }

    /// From `eye` towards `target`, upright.
    ///
    /// # Errors
    /// Coordinates that are NaN, infinite or the same point.
    pub fn look_at(eye: DVec3, target: DVec3, vertical_fov: f64, aspect: f64, near: f64) -> Result<Self, CameraError> {
        if !eye.is_finite() || !target.is_finite() {
            return Err(CameraError::Degenerate("coordinates must be finite numbers"));
        }
        let forward = (target - eye).try_normalize().ok_or(CameraError::Degenerate("eye and target are the same point"))?;
        let right = forward.cross(DVec3::Y).try_normalize().unwrap_or_else(|| forward.cross(DVec3::NEG_Z).normalize());
        let up = right.cross(forward);
        Ok(Self {
            eye,
            forward,
            up,
            vertical_fov,
            aspect,
            near,
            far: None,
            focus_distance: eye.distance(target),
            shift: DVec2::ZERO,
            mirrored: false,
        })
    }

    fn of_scene(scene: &Scene, pose: &Pose, index: usize, aspect: f64) -> Self {
        let fallback = Self {
            eye: DVec3::new(4.0, 3.0, 6.0),
            forward: DVec3::new(-4.0, -3.0, -6.0).normalize(),
            up: DVec3::Y,
            vertical_fov: 50f64.to_radians(),
            aspect,
            near: DEFAULT_NEAR,
            far: None,
            focus_distance: 8.0,
            shift: DVec2::ZERO,
            mirrored: false,
        };
        let Some(camera) = scene.cameras.get(index) else { return fallback };
        let Some(world_from_node) = pose.world_from_node.get(camera.node) else { return fallback };
        let eye = world_from_node.translation;
        let axis = |v: DVec3| world_from_node.transform_vector3(v).try_normalize();
        let (Some(forward), Some(up)) = (axis(DVec3::NEG_Z), axis(DVec3::Y)) else { return fallback };
        let Some(right) = forward.cross(up).try_normalize() else { return fallback };
        Self {
            eye,
            forward,
            up: right.cross(forward),
            vertical_fov: camera.vertical_fov,
            aspect,
            near: camera.near,
            far: None,
            focus_distance: camera.focus_distance,
            shift: DVec2::ZERO,
            mirrored: false,
        }
    }

    /// The point of interest, world space.
    #[must_use]
    pub fn target(&self) -> DVec3 {
        self.eye + self.forward * self.focus_distance
    }

    /// Towards the right of the picture; unit.
    #[must_use]
    pub fn right(&self) -> DVec3 {
        let right = self.forward.cross(self.up);
        if self.mirrored { -right } else { right }
    }

    /// What sees the unreflected world as this camera sees it in a mirror on `plane` (unit normal, world space).
    #[must_use]
    pub fn reflected(&self, plane: DVec4) -> Self {
        self.turned(&reflection(plane))
    }

    /// This camera carried elsewhere, by a reflection or a rigid transform of the world.
    #[must_use]
    pub fn turned(&self, turn: &DAffine3) -> Self {
        Self {
            eye: turn.transform_point3(self.eye),
            forward: turn.transform_vector3(self.forward),
            up: turn.transform_vector3(self.up),
            mirrored: self.mirrored != (turn.matrix3.determinant() < 0.0),
            ..*self
        }
    }

    /// View space: the eye at the origin, looking along -Z.
    #[must_use]
    pub fn view_from_world(&self) -> DMat4 {
        let view_from_world = glam::dcamera::rh::view::look_to_mat4(self.eye, self.forward, self.up);
        if self.mirrored { DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * view_from_world } else { view_from_world }
    }

    /// Reverse-Z with infinite far: near maps to depth 1, infinity to 0 (DESIGN section 3). With a far
    /// plane that maps to 0, and what lies beyond, infinity with it, is cut off.
    #[must_use]
    pub fn clip_from_view(&self) -> DMat4 {
        use glam::dcamera::rh::proj::directx::{perspective, perspective_infinite_reverse};
        let mut clip_from_view = match self.far {
            None => perspective_infinite_reverse(self.vertical_fov, self.aspect, self.near),
            // Near and far change places: reverse-Z.
            Some(far) => perspective(self.vertical_fov, self.aspect, far, self.near),
        };
        // Times w, which is -z.
        clip_from_view.z_axis.x -= self.shift.x;
        clip_from_view.z_axis.y -= self.shift.y;
        clip_from_view
    }

    /// The near rectangle's corners in world space, around.
    #[must_use]
    pub fn near_rectangle(&self) -> [DVec3; 4] {
        let half_height = (self.vertical_fov / 2.0).tan() * self.near;
        let (up, right) = (self.up * half_height, self.right() * (half_height * self.aspect));
        let center = self.eye + self.forward * self.near - right * self.shift.x - up * self.shift.y;
        [center - right - up, center + right - up, center + right + up, center - right + up]
    }

    /// The near plane in world space: unit normal towards the eye, and offset.
    #[must_use]
    pub fn near_plane(&self) -> DVec4 {
        (-self.forward).extend(self.forward.dot(self.eye) + self.near)
    }

    /// What a light sees through the near rectangle; `None` where it stands on its plane.
    #[must_use]
    pub fn through_light(&self, light: impl Into<DVec4>) -> Option<ThroughLight> {
        through_light(light.into(), self.near_plane(), self.near, &self.clip_from_world())
    }

    /// The part of the near rectangle that some pixels (x, y, width, height from the top left) of a
    /// picture of `size` see, in world space, around.
    #[must_use]
    pub fn near_rectangle_of(&self, [x, y, width, height]: [u32; 4], size: [u32; 2]) -> [DVec3; 4] {
        let [left_bottom, right_bottom, _, left_top] = self.near_rectangle();
        let (across, down) = (right_bottom - left_bottom, left_bottom - left_top);
        let share = |pixel: u32, whole: u32| f64::from(pixel) / f64::from(whole.max(1));
        let corner = |x: u32, y: u32| left_top + across * share(x, size[0]) + down * share(y, size[1]);
        [corner(x, y + height), corner(x + width, y + height), corner(x + width, y), corner(x, y)]
    }

    /// What every vertex shader's matrices are made from.
    #[must_use]
    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_view() * self.view_from_world()
    }
}
