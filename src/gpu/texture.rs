//! Textures with their mip levels, and samplers by value.

use std::collections::HashMap;

use super::context::Context;
use crate::scene::{Texture, Wrap};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Samplers made so far, by what they depend on.
#[derive(Default)]
pub struct Samplers {
    made: HashMap<([Wrap; 2], bool), wgpu::Sampler>,
}

impl Samplers {
    /// The sampler a texture asks for; a repeating, smooth one without a texture.
    pub fn get(&mut self, context: &Context, texture: Option<&Texture>) -> wgpu::Sampler {
        let key = texture.map_or(([Wrap::Repeat; 2], false), |texture| (texture.wrap, texture.nearest));
        let make = || {
            let address = |wrap| match wrap {
                Wrap::Repeat => wgpu::AddressMode::Repeat,
                Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
                Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
            };
            context.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("base colour"),
                address_mode_u: address(key.0[0]),
                address_mode_v: address(key.0[1]),
                mag_filter: if key.1 { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear },
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            })
        };
        self.made.entry(key).or_insert_with(make).clone()
    }
}

/// One white texel: what materials without a texture sample.
#[must_use]
pub fn white(context: &Context) -> wgpu::TextureView {
    let texture =
        Texture { name: "white".into(), width: 1, height: 1, rgba: vec![255; 4], wrap: [Wrap::Repeat; 2], nearest: false };
    upload(context, &texture)
}

/// Uploads a texture with all its mip levels.
#[must_use]
pub fn upload(context: &Context, texture: &Texture) -> wgpu::TextureView {
    let made = allocate(context, &texture.name, [texture.width, texture.height], 1);
    write_layer(context, &made, 0, texture);
    made.create_view(&wgpu::TextureViewDescriptor::default())
}

/// A texture for images of this size, one a layer, with room for all their mip levels.
pub fn allocate(context: &Context, label: &str, [width, height]: [u32; 2], layers: u32) -> wgpu::Texture {
    context.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: width.max(height).max(1).ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Writes one layer with all its mip levels; `texture` has the size of `made`.
pub fn write_layer(context: &Context, made: &wgpu::Texture, layer: u32, texture: &Texture) {
    let levels = made.mip_level_count();
    let write = |level: u32, width: u32, height: u32, rgba: &[u8]| {
        context.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: made,
                mip_level: level,
                origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
                aspect: wgpu::TextureAspect::All,
            },
            rgba,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 4), rows_per_image: None },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
    };
    write(0, texture.width, texture.height, &texture.rgba);
    let linear = linear_table();
    let (mut width, mut height) = (texture.width, texture.height);
    let mut above: Option<Vec<u8>> = None;
    for level in 1..levels {
        let smaller = halve(&linear, above.as_deref().unwrap_or(&texture.rgba), width, height);
        (width, height) = ((width / 2).max(1), (height / 2).max(1));
        write(level, width, height, &smaller);
        above = Some(smaller);
    }
}

/// The next mip level: 2 x 2 texels averaged in linear light.
fn halve(linear: &[f32; 256], rgba: &[u8], width: u32, height: u32) -> Vec<u8> {
    let (half_width, half_height) = ((width / 2).max(1), (height / 2).max(1));
    let texel = |x: u32, y: u32| (y.min(height - 1) as usize * width as usize + x.min(width - 1) as usize) * 4;
    let mut smaller = Vec::with_capacity(half_width as usize * half_height as usize * 4);
    for y in 0..half_height {
        for x in 0..half_width {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| texel(x * 2 + dx, y * 2 + dy));
            for channel in 0..3 {
                let mean = four.iter().map(|at| linear[rgba[at + channel] as usize]).sum::<f32>() / 4.0;
                smaller.push(encode(mean));
            }
            let alpha = four.iter().map(|at| u32::from(rgba[at + 3])).sum::<u32>();
            smaller.push(u8::try_from((alpha + 2) / 4).unwrap_or(u8::MAX));
        }
    }
    smaller
}

fn linear_table() -> [f32; 256] {
    std::array::from_fn(|value| {
        #[expect(clippy::cast_precision_loss, reason = "0 to 255")]
        let value = value as f32 / 255.0;
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
}

fn encode(linear: f32) -> u8 {
    let value = if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0..=255")]
    let byte = (value * 255.0).round().clamp(0.0, 255.0) as u8;
    byte
}
