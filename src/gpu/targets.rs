//! What the scene is drawn into: made in one place, for a size and sample count.

use super::context::{COLOR_FORMAT, Context, DEPTH_FORMAT, GpuError};

/// The scene's attachments and the bind group that the picture's programs read them by.
pub struct Targets {
    /// Pixels.
    pub size: [u32; 2],
    /// Per pixel.
    pub samples: u32,
    /// What is drawn to.
    pub color: wgpu::TextureView,
    /// What `color` resolves to, where it has several samples.
    pub resolved: Option<wgpu::TextureView>,
    /// Depth and stencil.
    pub depth_stencil: wgpu::TextureView,
    /// The depth and stencil texture, for copies.
    pub depth_stencil_texture: wgpu::Texture,
    /// Resolved colour and (at one sample) the stencil.
    pub read: wgpu::BindGroup,
}

/// Bytes that targets may take; llvmpipe overcommits memory until it aborts.
const BUDGET: u64 = 4 << 30;

impl Targets {
    /// New targets.
    ///
    /// # Errors
    /// More bytes than the budget, or the device refuses.
    pub fn new(context: &Context, layout: &wgpu::BindGroupLayout, size: [u32; 2], samples: u32) -> Result<Self, GpuError> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let bytes = pixels * (u64::from(samples) * (8 + 8) + 8);
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
        let color = texture(context, "scene colour", size, samples, COLOR_FORMAT, if one { read } else { attachment });
        let resolved = (!one).then(|| texture(context, "scene colour, resolved", size, 1, COLOR_FORMAT, read));
        let depth_usage = if one { read | wgpu::TextureUsages::COPY_SRC } else { attachment };
        let depth_stencil_texture = texture(context, "scene depth and stencil", size, samples, DEPTH_FORMAT, depth_usage);
        let color = color.create_view(&Default::default());
        let resolved = resolved.map(|texture| texture.create_view(&Default::default()));
        let depth_stencil = depth_stencil_texture.create_view(&Default::default());

        // With several samples nothing reads the stencil (the plan sees to it): a stand-in is bound.
        let stand_in =
            (!one).then(|| texture(context, "no stencil", [1, 1], 1, DEPTH_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING));
        let stencil = stand_in
            .as_ref()
            .unwrap_or(&depth_stencil_texture)
            .create_view(&wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::StencilOnly, ..Default::default() });
        let read = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scene targets"),
            layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(resolved.as_ref().unwrap_or(&color)),
                },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&stencil) },
            ],
        });
        Ok(Self { size, samples, color, resolved, depth_stencil, depth_stencil_texture, read })
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
