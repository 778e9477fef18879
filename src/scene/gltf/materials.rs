//! Materials: what of glTF's is shown, put in range.

use glam::{Affine2, Vec2, Vec3, Vec4};
use gltf::json::material::AlphaMode as GltfAlpha;
use gltf::json::validation::Checked;
use gltf::json::{Extras, Root, texture};
use serde_json::Value;

use super::error::{Problem, Warnings, name, part};
use super::images::Images;
use super::lights::extra;
use super::mesh::{MaterialUse, UvSource};
use crate::scene::{AlphaMode, Material, Reflective};

/// A flag of the user's in `extras`.
pub(super) fn flag(extras: &Extras, key: &str) -> Option<bool> {
    extra(extras, key)?.as_bool()
}

/// What meshes have to know of each material, the default one last.
pub(super) fn uses(root: &Root) -> Vec<MaterialUse> {
    let of = |material: &gltf::json::Material| {
        let base = material.pbr_metallic_roughness.base_color_texture.as_ref();
        MaterialUse {
            uvs: base.map(uv_source).unwrap_or_default(),
            shadeless: material.alpha_mode == Checked::Valid(GltfAlpha::Blend) || flag(&material.extras, "decal") == Some(true),
        }
    };
    root.materials.iter().map(of).chain([MaterialUse::default()]).collect()
}

fn uv_source(info: &texture::Info) -> UvSource {
    let Some(transform) = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref()) else {
        return UvSource { set: info.tex_coord, transform: None };
    };
    // Turned the other way round, because glTF's v runs downward.
    let affine = Affine2::from_scale_angle_translation(
        Vec2::from_array(transform.scale.0),
        -transform.rotation.0,
        Vec2::from_array(transform.offset.0),
    );
    UvSource { set: transform.tex_coord.unwrap_or(info.tex_coord), transform: affine.is_finite().then_some(affine) }
}

/// All materials of the file, in order. Those that no primitive uses have their textures left out.
pub(super) fn import(
    root: &Root,
    used: &[bool],
    images: &mut Images<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<Material>, Problem> {
    let mut materials = Vec::with_capacity(root.materials.len());
    for (index, material) in root.materials.iter().enumerate() {
        let named = || part("material", index, material.name.as_deref());
        let base = &material.pbr_metallic_roughness;
        let extensions = material.extensions.as_ref();
        let base_color_texture = match &base.base_color_texture {
            None => None,
            Some(_) if !used.get(index).copied().unwrap_or(false) => None,
            Some(info) => match images.texture(info.index.value(), warnings) {
                Some(texture) => Some(texture),
                None => {
                    let what = format!("texture {} does not exist; the file has {}", info.index, root.textures.len());
                    return Err(Problem::Part { part: named(), what });
                }
            },
        };
        let mut emissive = Vec3::from_array(material.emissive_factor.0.map(|value| range(value, 0.0, 1.0, 0.0)));
        if let Some(strength) = extensions.and_then(|extensions| extensions.emissive_strength.as_ref()) {
            emissive *= range(strength.emissive_strength.0, 0.0, 1e6, 1.0);
        }
        if material.emissive_texture.is_some() && emissive != Vec3::ZERO {
            // Without its texture the whole surface would glow.
            warnings.push(format!("{}: its emissive texture is not shown", named()));
            emissive = Vec3::ZERO;
        }
        let alpha = match material.alpha_mode {
            Checked::Valid(GltfAlpha::Opaque) => AlphaMode::Opaque,
            Checked::Valid(GltfAlpha::Mask) => {
                AlphaMode::Mask(material.alpha_cutoff.map_or(0.5, |cutoff| range(cutoff.0, 0.0, 2.0, 0.5)))
            }
            Checked::Valid(GltfAlpha::Blend) => AlphaMode::Blend,
            Checked::Invalid => {
                warnings.push(format!("{}: its alpha mode is not one of glTF's and taken as OPAQUE", named()));
                AlphaMode::Opaque
            }
        };
        materials.push(Material {
            name: name("material", index, material.name.as_deref()),
            base_color: Vec4::from_array(base.base_color_factor.0.map(|value| range(value, 0.0, 1.0, 1.0))),
            base_color_texture,
            roughness: range(base.roughness_factor.0, 0.0, 1.0, 1.0),
            metallic: range(base.metallic_factor.0, 0.0, 1.0, 1.0),
            emissive,
            double_sided: material.double_sided,
            alpha,
            unlit: extensions.is_some_and(|extensions| extensions.unlit.is_some()),
            mirror: mirror(&material.extras, named, warnings),
            receiver: receiver(&material.extras, named, warnings),
            decal: flag(&material.extras, "decal").unwrap_or(false),
        });
    }
    Ok(materials)
}

/// What `extras` say of mirrors: `mirror` true or false, `reflectivity` 0 to 1, `tint` linear RGB, each 0 to 1.
fn mirror(extras: &Extras, named: impl Fn() -> String, warnings: &mut Warnings) -> Option<Reflective> {
    let marked = extra(extras, "mirror")?;
    let Some(marked) = marked.as_bool() else {
        warnings.push(format!("{}: its `mirror` is neither true nor false, and it is none", named()));
        return None;
    };
    if !marked {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "it is in range")]
    let share = |value: &Value| value.as_f64().filter(|share| (0.0..=1.0).contains(share)).map(|share| share as f32);
    let mut look = Reflective::default();
    if let Some(value) = extra(extras, "reflectivity") {
        look.reflectivity = share(&value).unwrap_or_else(|| {
            warnings.push(format!("{}: its reflectivity is no number from 0 to 1, and taken as 1", named()));
            1.0
        });
    }
    if let Some(value) = extra(extras, "tint") {
        let tint = match value.as_array().map(Vec::as_slice) {
            Some([r, g, b]) => share(r).zip(share(g)).zip(share(b)).map(|((r, g), b)| Vec3::new(r, g, b)),
            _ => None,
        };
        look.tint = tint.unwrap_or_else(|| {
            warnings.push(format!("{}: its tint is not three numbers from 0 to 1, and left out", named()));
            Vec3::ONE
        });
    }
    Some(look)
}

/// What `extras` say of planar shadows: `receiver` true or false.
fn receiver(extras: &Extras, named: impl Fn() -> String, warnings: &mut Warnings) -> bool {
    let Some(marked) = extra(extras, "receiver") else { return false };
    marked.as_bool().unwrap_or_else(|| {
        warnings.push(format!("{}: its `receiver` is neither true nor false, and it is none", named()));
        false
    })
}

/// Clamped; what is no number becomes `otherwise`.
fn range(value: f32, least: f32, most: f32, otherwise: f32) -> f32 {
    if value.is_nan() { otherwise } else { value.clamp(least, most) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    #[test]
    fn texture_transforms_turn_as_the_extension_says() {
        let info = r#"{"index":0,"texCoord":3,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"rotation":1.5707963,"scale":[2,1],"texCoord":1}}}"#;
        let source = uv_source(&serde_json::from_str(info).unwrap());
        assert_eq!(source.set, 1);
        // A quarter turn counter-clockwise as seen with v downward takes +u to -v.
        let uv = source.transform.unwrap().transform_point2(Vec2::X);
        assert!(uv.abs_diff_eq(Vec2::new(0.5, -2.0), 1e-6), "{uv}");
    }
}
