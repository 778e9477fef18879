//! Lights (KHR_lights_punctual) and cameras, put in range.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::Vec3;
use gltf::json::camera::Type as CameraType;
use gltf::json::extensions::scene::khr_lights_punctual::{Light as GltfLight, Type as LightType};
use gltf::json::validation::Checked;
use gltf::json::{Extras, Root};
use serde_json::Value;

use super::error::{Problem, Warnings, name, part};
use super::images::Images;
use super::nodes::Hierarchy;
use crate::frame::camera::DEFAULT_NEAR;
use crate::scene::{Camera, Extent, Light, LightKind};

/// More lights than this are no picture any more, but hours of shadow passes.
const MOST_LIGHTS: usize = 256;

/// The lights of the scene's nodes.
pub(super) fn lights(
    root: &Root,
    hierarchy: &Hierarchy,
    images: &mut Images<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<Light>, Problem> {
    let defined = root.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
    let defined = defined.map_or(&[][..], |extension| &extension.lights);
    let mut lights = Vec::new();
    for (number, &index) in hierarchy.order.iter().enumerate().filter(|(number, _)| !hierarchy.hidden[*number]) {
        let node = &root.nodes[index];
        let extension = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        let Some(light) = extension.map(|extension| extension.light.value()) else { continue };
        let Some(definition) = defined.get(light) else {
            let what = format!("light {light} does not exist; the file has {}", defined.len());
            return Err(Problem::Part { part: part("node", index, node.name.as_deref()), what });
        };
        if lights.len() == MOST_LIGHTS {
            warnings.push(format!("only the first {MOST_LIGHTS} lights shine"));
            break;
        }
        let fallback = node.name.as_deref().filter(|name| !name.is_empty());
        let imported = self::light(definition, light, fallback, number, warnings);
        // What the node says goes before what the light says, which other nodes may share.
        let extra = |key: &str| [&node.extras, &definition.extras].into_iter().find_map(|extras| extra(extras, key));
        let named = || part("light", light, definition.name.as_deref());
        lights.extend(imported.map(|imported| with_extras(imported, extra, images, named, warnings)));
    }
    Ok(lights)
}

/// A value of the user's in `extras`.
pub(super) fn extra(extras: &Extras, key: &str) -> Option<Value> {
    serde_json::from_str::<Value>(extras.as_deref()?.get()).ok()?.get(key).cloned()
}

/// A light with what glTF has no word for: `radius` or `size` in metres, and the texture it `projects`.
fn with_extras(
    mut light: Light,
    extra: impl Fn(&str) -> Option<Value>,
    images: &mut Images<'_>,
    named: impl Fn() -> String,
    warnings: &mut Warnings,
) -> Light {
    #[expect(clippy::cast_possible_truncation, reason = "what is too large is put in range")]
    let metres = |value: &Value| value.as_f64().filter(|metres| *metres > 0.0).map(|metres| (metres as f32).min(LARGEST_LIGHT));
    let round = extra("radius").map(|radius| metres(&radius).map(Extent::Round));
    let rectangle = extra("size").map(|size| match size.as_array().map(Vec::as_slice) {
        Some([width, height]) => metres(width).zip(metres(height)).map(|(width, height)| Extent::Rectangle([width, height])),
        _ => None,
    });
    match rectangle.or(round) {
        None => {}
        Some(_) if light.kind == LightKind::Directional => {
            warnings.push(format!("{}: it is directional, and its size is left out", named()));
        }
        Some(Some(extent)) => light.extent = extent,
        Some(None) => warnings.push(format!("{}: its size is no size, and it shines from a point", named())),
    }
    if let Some(texture) = extra("projects") {
        let index = texture.as_u64().and_then(|index| usize::try_from(index).ok());
        let spot = matches!(light.kind, LightKind::Spot { .. });
        light.slide = index.filter(|_| spot).and_then(|index| images.texture(index, warnings));
        if !spot {
            warnings.push(format!("{}: only spots project, and this is none", named()));
        } else if light.slide.is_none() {
            warnings.push(format!("{}: it projects texture {texture}, which does not exist", named()));
        }
    }
    light
}

/// Metres: more is the sky.
const LARGEST_LIGHT: f32 = 1e6;

fn light(light: &GltfLight, index: usize, fallback: Option<&str>, node: usize, warnings: &mut Warnings) -> Option<Light> {
    let named = part("light", index, light.name.as_deref());
    let mut mended = |what: &str| warnings.push(format!("{named}: its {what}"));
    let kind = match light.type_ {
        Checked::Valid(LightType::Point) => LightKind::Point,
        Checked::Valid(LightType::Directional) => LightKind::Directional,
        Checked::Valid(LightType::Spot) => {
            let (inner, outer) =
                light.spot.as_ref().map_or((0.0, FRAC_PI_4), |spot| (spot.inner_cone_angle, spot.outer_cone_angle));
            let good = (0.0..=FRAC_PI_2 + 1e-4).contains(&outer) && outer > 0.0 && inner >= 0.0 && inner <= outer;
            if !good {
                mended("cone is put in range");
            }
            let outer = if outer > 1e-3 { outer.min(FRAC_PI_2) } else { FRAC_PI_4 };
            LightKind::Spot { inner: if inner > 0.0 { inner.min(outer) } else { 0.0 }, outer }
        }
        Checked::Invalid => {
            mended("type is not one of glTF's, and it does not shine");
            return None;
        }
    };
    let clamped = |value: f32, most: f32| if value > 0.0 { value.min(most) } else { 0.0 }; // NaN too
    let color = Vec3::from_array(light.color.map(|value| clamped(value, 1e6)));
    let intensity = clamped(light.intensity, 1e12);
    if color.to_array() != light.color || intensity != light.intensity {
        mended("brightness is put in range");
    }
    let range = match light.range {
        Some(range) if range > 0.0 && kind != LightKind::Directional => range,
        Some(_) if kind != LightKind::Directional => {
            mended("range is not positive and taken as endless");
            f32::INFINITY
        }
        _ => f32::INFINITY,
    };
    let name = light.name.as_deref().filter(|name| !name.is_empty()).or(fallback);
    let name = self::name("light", index, name);
    Some(Light { name, node, kind, color, intensity, range, ..Light::default() })
}

/// A camera, and for an orthographic one half the height it sees.
pub(super) type FileCamera = (Camera, Option<f64>);

/// The cameras of the scene's nodes; their focus is set when the scene's bounds are known.
pub(super) fn cameras(root: &Root, hierarchy: &Hierarchy, warnings: &mut Warnings) -> Result<Vec<FileCamera>, Problem> {
    let mut cameras = Vec::new();
    for (number, &index) in hierarchy.order.iter().enumerate().filter(|(number, _)| !hierarchy.hidden[*number]) {
        let node = &root.nodes[index];
        let Some(camera) = node.camera.map(|camera| camera.value()) else { continue };
        let Some(definition) = root.cameras.get(camera) else {
            let what = format!("camera {camera} does not exist; the file has {}", root.cameras.len());
            return Err(Problem::Part { part: part("node", index, node.name.as_deref()), what });
        };
        let named = part("camera", camera, definition.name.as_deref());
        let (fov, near, height) = match (&definition.type_, &definition.perspective, &definition.orthographic) {
            (Checked::Valid(CameraType::Perspective), Some(lens), _) => (f64::from(lens.yfov), f64::from(lens.znear), None),
            (Checked::Valid(CameraType::Orthographic), _, Some(lens)) => {
                warnings.push(format!("{named}: it is orthographic; a perspective one stands in for it"));
                (45f64.to_radians(), f64::from(lens.znear), Some(f64::from(lens.ymag.abs())))
            }
            _ => {
                warnings.push(format!("{named}: it is neither perspective nor orthographic and left out"));
                continue;
            }
        };
        let vertical_fov = if fov > 0.0 { fov.clamp(0.01, 3.0) } else { 45f64.to_radians() };
        if height.is_none() && vertical_fov != fov {
            warnings.push(format!("{named}: its angle of view is put in range"));
        }
        let near = if near > 0.0 && near.is_finite() { near } else { DEFAULT_NEAR };
        let name = definition.name.as_deref().or(node.name.as_deref()).filter(|name| !name.is_empty());
        let name = self::name("camera", camera, name);
        let height = height.filter(|height| height.is_finite() && *height > 0.0);
        cameras.push((Camera { name, node: number, vertical_fov, near, focus_distance: 1.0 }, height));
    }
    Ok(cameras)
}
