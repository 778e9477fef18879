//! The slides that spots project: one array of textures of one size, so that any step may read any of them.

use super::context::Context;
use super::texture;
use crate::scene::slides::SIDE;
use crate::scene::{BuiltInSlide, Pose, Scene, Slide, Texture};

/// The array, its sampler, and which layer a slide is.
#[derive(Default)]
pub struct Slides {
    made: Option<(wgpu::TextureView, wgpu::Sampler)>,
    /// The real ones are there, and not only a stand-in.
    filled: bool,
    /// The scene's textures that are slides; they follow after the built-in ones.
    of_scene: Vec<usize>,
}

impl Slides {
    /// Another scene's slides may come.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Makes what the lights of `pose` need: nothing is drawn and uploaded before some light projects.
    /// True where the array was made anew.
    pub fn prepare(&mut self, context: &Context, scene: &Scene, pose: &Pose) -> bool {
        let needed = pose.lights.iter().any(|light| light.slide.is_some());
        if self.made.is_some() && (self.filled || !needed) {
            return false;
        }
        let array = if needed {
            self.of_scene = scene.lights.iter().filter_map(|light| light.slide).collect();
            self.of_scene.sort_unstable();
            self.of_scene.dedup();
            let built_in = BuiltInSlide::ALL.map(BuiltInSlide::texture);
            let layers = u32::try_from(built_in.len() + self.of_scene.len()).unwrap_or(u32::MAX);
            let array = texture::allocate(context, "slides", [SIDE; 2], layers);
            let resized: Vec<_> = self.of_scene.iter().filter_map(|&index| scene.textures.get(index)).map(fit).collect();
            for (layer, slide) in (0..).zip(built_in.into_iter().chain(&resized)) {
                texture::write_layer(context, &array, layer, slide);
            }
            array
        } else {
            texture::allocate(context, "no slides", [1; 2], 1)
        };
        let view = array.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let sampler = context.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("slides"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        self.made = Some((view, sampler));
        self.filled = needed;
        true
    }

    /// Array and sampler, once prepared.
    #[must_use]
    pub fn get(&self) -> Option<&(wgpu::TextureView, wgpu::Sampler)> {
        self.made.as_ref()
    }

    /// The layer of a slide.
    #[must_use]
    pub fn layer(&self, slide: Slide) -> u32 {
        let layer = match slide {
            Slide::BuiltIn(slide) => slide as usize,
            Slide::Texture(texture) => BuiltInSlide::ALL.len() + self.of_scene.partition_point(|known| *known < texture),
        };
        u32::try_from(layer).unwrap_or(0)
    }
}

/// The same picture in the size of all slides.
fn fit(slide: &Texture) -> Texture {
    let resized = image::RgbaImage::from_raw(slide.width, slide.height, slide.rgba.clone())
        .map(|image| image::imageops::resize(&image, SIDE, SIDE, image::imageops::FilterType::Triangle).into_raw())
        .unwrap_or_else(|| vec![255; SIDE as usize * SIDE as usize * 4]);
    Texture { name: slide.name.clone(), width: SIDE, height: SIDE, rgba: resized, wrap: slide.wrap, nearest: slide.nearest }
}
