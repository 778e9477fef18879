//! What the scene is drawn into: made in one place, for a size and sample count.

use super::context::{Context, DARK_FORMAT, GEOMETRY_FORMAT, GpuError, MEAN_FORMAT, color_format};
use crate::frame::FramePlan;
use crate::settings::Accumulation;

/// What targets are made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Pixels.
    pub size: [u32; 2],
    /// Per pixel.
    pub samples: u32,
    /// What lights are added into.
    pub accumulation: Accumulation,
    /// A mean of frames is kept.
    pub gathers: bool,
}

impl Shape {
    /// What a plan needs.
    #[must_use]
    pub fn of(plan: &FramePlan) -> Self {
        let FramePlan { size, samples, accumulation, gather, .. } = *plan;
        Self { size, samples, accumulation, gathers: gather.is_some() }
    }
}

/// The mean of the frames gathered so far, in one of two textures: each frame reads the one that the frame
/// before wrote, and so may be drawn again.
pub struct Mean {
    /// What is drawn to.
    pub view: wgpu::TextureView,
    /// What is read while it is drawn: the scene's, and the other mean.
    pub gather: wgpu::BindGroup,
    /// What the picture reads: this mean in place of the scene's colour.
    pub read: wgpu::BindGroup,
}

/// The scene's attachments and the bind group that the picture's programs read them by.
pub struct Targets {
    /// What they were made for.
    pub shape: Shape,
    /// What is drawn to.
    pub color: wgpu::TextureView,
    /// The same, for copies (at one sample).
    pub color_texture: wgpu::Texture,
    /// What `color` resolves to, where it has several samples.
    pub resolved: Option<wgpu::TextureView>,
    /// Depth and stencil.
    pub depth_stencil: wgpu::TextureView,
    /// The depth and stencil texture, for copies.
    pub depth_stencil_texture: wgpu::Texture,
    /// Resolved colour and (at one sample) the stencil.
    pub read: wgpu::BindGroup,
    /// For frames of even and of odd number, where a mean is kept.
    pub means: Option<[Mean; 2]>,
    /// Made by [`Self::with_counts`] for the first plan that counts beyond the stencil.
    pub counts: Option<Counts>,
    /// Made by [`Self::with_solid`] for the first plan that puts solids together.
    pub solid: Option<SolidTarget>,
    /// Made by [`Self::with_geometry`] for the first plan that shades pixel by pixel.
    pub geometry: Option<Geometry>,
    /// Made by [`Self::with_reflections`]: one for each view that goes into a texture.
    pub reflections: Vec<Reflection>,
}

/// What a mirror shows, as a texture.
pub struct Reflection {
    /// Pixels.
    pub size: [u32; 2],
    /// What is copied to.
    pub texture: wgpu::Texture,
    /// What mirrors read it by.
    pub read: wgpu::BindGroup,
}

/// One number a sample, for counts that the stencil has too few bits for.
pub struct Counts {
    /// What volumes are added up in.
    pub view: wgpu::TextureView,
    /// The texture, for copies (at one sample).
    pub texture: wgpu::Texture,
    /// What the verdict is read by.
    pub read: wgpu::BindGroup,
}

/// What is kept of the surfaces that pixels show, and in which lights' shadows they are.
pub struct Geometry {
    /// What surfaces are drawn to.
    pub surface: wgpu::TextureView,
    /// The lights' bits.
    pub dark: wgpu::TextureView,
    /// What pixels are shaded by.
    pub read: wgpu::BindGroup,
}

/// Depth and stencil of one layer of two solids put together.
pub struct SolidTarget {
    /// What is drawn to.
    pub depth_stencil: wgpu::TextureView,
    /// What layers are merged by.
    pub read: wgpu::BindGroup,
}

/// Bytes that targets may take; llvmpipe overcommits memory until it aborts.
const BUDGET: u64 = 4 << 30;

impl Targets {
    /// New targets.
    ///
    /// # Errors
    /// More bytes than the budget, or the device refuses.
    pub fn new(context: &Context, layout: &wgpu::BindGroupLayout, shape: Shape) -> Result<Self, GpuError> {
        let Shape { size, samples, accumulation, gathers } = shape;
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        // Colour, depth with stencil, counts, a solid's own depth and geometry should they be needed, and means.
        let bytes = pixels * (u64::from(samples) * (8 + 8 + 4 + 8) + 8 + 17 + if gathers { 32 } else { 0 });
        if bytes > BUDGET {
            return Err(GpuError::TooLarge(format!(
                "{} x {} pixels with {samples} samples need {} MiB of {} MiB",
                size[0],
                size[1],
                bytes >> 20,
                BUDGET >> 20
            )));
        }
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let read = attachment | wgpu::TextureUsages::TEXTURE_BINDING;
        let one = samples == 1;
        let format = color_format(accumulation);
        let color = texture(
            context,
            "scene colour",
            size,
            samples,
            format,
            if one { read | wgpu::TextureUsages::COPY_SRC } else { attachment },
        );
        let resolved = (!one).then(|| texture(context, "scene colour, resolved", size, 1, format, read));
        let depth_usage = if one { read | wgpu::TextureUsages::COPY_SRC } else { attachment };
        let depth_stencil_texture =
            texture(context, "scene depth and stencil", size, samples, context.depth_format(), depth_usage);
        let color_texture = color;
        let color = color_texture.create_view(&Default::default());
        let resolved = resolved.map(|texture| texture.create_view(&Default::default()));
        let depth_stencil = depth_stencil_texture.create_view(&Default::default());

        // With several samples nothing reads the stencil (the plan sees to it): a stand-in is bound.
        let stand_in = (!one)
            .then(|| texture(context, "no stencil", [1, 1], 1, context.depth_format(), wgpu::TextureUsages::TEXTURE_BINDING));
        let stencil = stand_in
            .as_ref()
            .unwrap_or(&depth_stencil_texture)
            .create_view(&wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::StencilOnly, ..Default::default() });
        let drawn = resolved.as_ref().unwrap_or(&color);
        // The colour that is read, and the mean before it.
        let group = |color: &wgpu::TextureView, before: &wgpu::TextureView| {
            let entry = |binding, view| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
            context.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("scene targets"),
                layout,
                entries: &[entry(0, color), entry(1, &stencil), entry(2, before)],
            })
        };
        let means = gathers.then(|| {
            let views = ["mean, even frames", "mean, odd frames"]
                .map(|label| texture(context, label, size, 1, MEAN_FORMAT, read).create_view(&Default::default()));
            [0, 1].map(|this| Mean {
                view: views[this].clone(),
                gather: group(drawn, &views[1 - this]),
                read: group(&views[this], drawn),
            })
        });
        let read = group(drawn, drawn);
        let reflections = Vec::new();
        Ok(Self {
            shape,
            color,
            color_texture,
            reflections,
            resolved,
            depth_stencil,
            depth_stencil_texture,
            read,
            means,
            counts: None,
            solid: None,
            geometry: None,
        })
    }

    /// Makes a texture of each of these sizes, where it is not there yet.
    pub fn with_reflections(&mut self, context: &Context, layout: &wgpu::BindGroupLayout, sizes: &[[u32; 2]]) {
        if self.reflections.iter().map(|reflection| reflection.size).eq(sizes.iter().copied()) {
            return;
        }
        let usage = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING;
        let format = color_format(self.shape.accumulation);
        let sampler = context.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("reflection"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let make = |&size: &[u32; 2]| {
            let texture = texture(context, "reflection", size, 1, format, usage);
            let view = texture.create_view(&Default::default());
            let read = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("reflection"),
                layout,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
                    wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
                ],
            });
            Reflection { size, texture, read }
        };
        self.reflections = sizes.iter().map(make).collect();
    }

    /// Makes a solid's own target where it is not there yet; `layouts` are those of one sample and of several.
    pub fn with_solid(&mut self, context: &Context, layouts: &[wgpu::BindGroupLayout; 2]) {
        if self.solid.is_some() {
            return;
        }
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let Shape { size, samples, .. } = self.shape;
        let texture = texture(context, "solid depth and stencil", size, samples, context.depth_format(), usage);
        let aspect = |aspect| texture.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() });
        let views = [wgpu::TextureAspect::DepthOnly, wgpu::TextureAspect::StencilOnly].map(aspect);
        let entry = |binding: usize| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource: wgpu::BindingResource::TextureView(&views[binding]),
        };
        let read = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("solid"),
            layout: &layouts[usize::from(samples != 1)],
            entries: &[entry(0), entry(1)],
        });
        self.solid = Some(SolidTarget { depth_stencil: texture.create_view(&Default::default()), read });
    }

    /// Makes what pixels are shaded from where it is not there yet; all `materials` are read with it.
    pub fn with_geometry(&mut self, context: &Context, layout: &wgpu::BindGroupLayout, materials: &wgpu::Buffer) {
        if self.geometry.is_some() {
            return;
        }
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let make = |label, format| texture(context, label, self.shape.size, 1, format, usage).create_view(&Default::default());
        let (surface, dark) = (make("surfaces", GEOMETRY_FORMAT), make("dark", DARK_FORMAT));
        let depth = self
            .depth_stencil_texture
            .create_view(&wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::DepthOnly, ..Default::default() });
        let entry = |binding, view| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
        let read = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("geometry"),
            layout,
            entries: &[
                entry(0, &depth),
                entry(1, &surface),
                entry(2, &dark),
                wgpu::BindGroupEntry { binding: 3, resource: materials.as_entire_binding() },
            ],
        });
        self.geometry = Some(Geometry { surface, dark, read });
    }

    /// Makes the counts' target where it is not there yet; `layouts` are those of one sample and of
    /// several.
    pub fn with_counts(&mut self, context: &Context, layouts: &[wgpu::BindGroupLayout; 2]) {
        if self.counts.is_some() {
            return;
        }
        let one = self.shape.samples == 1;
        let read = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let usage = if one { read | wgpu::TextureUsages::COPY_SRC } else { read };
        let texture = texture(context, "counts", self.shape.size, self.shape.samples, context.counts_format(), usage);
        let view = texture.create_view(&Default::default());
        let read = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("counts"),
            layout: &layouts[usize::from(!one)],
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
        });
        self.counts = Some(Counts { view, texture, read });
    }
}

fn texture(
    context: &Context,
    label: &str,
    size: [u32; 2],
    samples: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    context.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
