//! Frame, objects and lights in the numbers that shaders read.

use glam::{DAffine3, DMat3, DMat4, Mat4, Vec3, Vec4};

use super::slides::Slides;
use super::types::{Frame, Light, Object};
use crate::frame::{FramePlan, View, Window};
use crate::scene::{LightKind, Pose, PosedLight, Scene};
use crate::settings::Accumulation;

/// One instance as a view sees it.
pub fn object(clip_from_world: &DMat4, world_from_object: &DAffine3) -> Object {
    let world_from_object = DMat4::from(*world_from_object);
    let linear = DMat3::from_mat4(world_from_object);
    // The cofactor matrix is the inverse transpose times the determinant: it needs no
    // inverse, and its sign is put right so that mirrored objects keep their outside.
    let cofactors = DMat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    ) * linear.determinant().signum();
    Object {
        clip_from_object: (*clip_from_world * world_from_object).as_mat4().to_cols_array_2d(),
        world_from_object: world_from_object.as_mat4().to_cols_array_2d(),
        normal_from_object: Mat4::from_mat3(cofactors.as_mat3()).to_cols_array_2d(),
    }
}

/// The frame as a view sees it.
pub fn frame(plan: &FramePlan, view: &View, scene: &Scene, pose: &Pose) -> Frame {
    #[expect(clippy::cast_precision_loss, reason = "pixels fit f32 exactly")]
    let size = view.picture.map(|side| side as f32);
    let more = Vec3::from(plan.reflections.ambient);
    let camera = &view.camera;
    let half_height = (camera.vertical_fov / 2.0).tan();
    Frame {
        eye: view.camera.eye.as_vec3().to_array(),
        exposure: plan.exposure / scale(plan),
        scale: scale(plan),
        ambient_sky: (scene.environment.ambient_sky + more).to_array(),
        smooth_terminator: f32::from(u8::from(plan.smooth_terminator)),
        ambient_ground: (scene.environment.ambient_ground + more).to_array(),
        light_count: u32::try_from(pose.lights.len()).unwrap_or(u32::MAX),
        background_top: scene.environment.background[0].to_array(),
        #[expect(clippy::cast_possible_truncation, reason = "the GPU works in f32")]
        pixel: (half_height * 2.0 / f64::from(plan.size[1])) as f32,
        background_bottom: scene.environment.background[1].to_array(),
        size,
        clip_from_world: view.camera.clip_from_world().as_mat4().to_cols_array_2d(),
        clip_plane: view.through.as_ref().map_or(Vec4::ZERO, Window::clip_plane).to_array(),
        way_ahead: camera.forward.as_vec3().to_array(),
        #[expect(clippy::cast_possible_truncation, reason = "the GPU works in f32")]
        near: camera.near as f32,
        way_right: (camera.forward.cross(camera.up) * half_height * camera.aspect).as_vec3().to_array(),
        way_up: (camera.up * half_height).as_vec3().to_array(),
        ..Frame::default()
    }
}

/// What light is multiplied with before it is added. In 8 bits the picture's own range is all there is, as it
/// was all there was; floats are exposed at the end.
pub fn scale(plan: &FramePlan) -> f32 {
    match plan.accumulation {
        Accumulation::Float => 1.0,
        Accumulation::EightBit => plan.exposure,
    }
}

/// A light; `scale` is what it is multiplied with.
pub fn light(light: &PosedLight, scale: f32, slides: &Slides) -> Light {
    let (kind, inner, outer) = match light.kind {
        LightKind::Point => (0, 0.0, 0.0),
        LightKind::Directional => (1, 0.0, 0.0),
        LightKind::Spot { inner, outer } => (if light.slide.is_some() { 3 } else { 2 }, inner, outer),
    };
    let range = light.range;
    #[expect(clippy::cast_possible_truncation, reason = "the GPU works in f32")]
    let inverse_range_squared = if range.is_finite() && kind != 1 { (1.0 / (range * range)) as f32 } else { 0.0 };
    Light {
        position: light.position.as_vec3().to_array(),
        inverse_range_squared,
        direction: light.direction.as_vec3().to_array(),
        cos_outer: outer.cos(),
        intensity: if light.on { light.intensity * scale } else { Vec3::ZERO }.to_array(),
        inverse_cone_width: 1.0 / (inner.cos() - outer.cos()).max(1e-4),
        kind,
        right: light.right.as_vec3().to_array(),
        slide: light.slide.map_or(0, |slide| slides.layer(slide)),
        // The slide's corners touch the outer cone; one of a half-space would be endless.
        slide_scale: std::f32::consts::SQRT_2 / outer.clamp(1e-3, 1.55).tan(),
        // A reflection's right is its left.
        hand: if light.off.is_some_and(|off| off.plane.is_some()) { -1.0 } else { 1.0 },
        _pad: 0,
    }
}
