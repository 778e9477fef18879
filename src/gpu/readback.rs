//! Pictures and stencil values back from the device.

use std::collections::HashSet;

use super::context::{Context, GpuError};
use super::{FrameStats, Renderer};
use crate::frame::{DrawSet, FramePlan, Part, VolumePart, WideCounts};
use crate::scene::{Pose, Scene};

/// The format pictures are drawn in without a window. Like every picture's it does not convert: the shaders
/// encode sRGB themselves.
pub const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// What a picture of so many pixels is drawn into.
#[must_use]
pub fn target(context: &Context, [width, height]: [u32; 2]) -> wgpu::Texture {
    context.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: PICTURE_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Draws the plan into a picture of its own and reads it back: sRGB, rows from the top, opaque.
///
/// # Errors
/// What [`Renderer::render`] may return, or a device that does not answer.
pub fn picture(
    context: &Context,
    renderer: &mut Renderer,
    plan: &FramePlan,
    scene: &Scene,
    pose: &Pose,
) -> Result<(FrameStats, image::RgbaImage), GpuError> {
    let [width, height] = plan.size;
    let texture = target(context, plan.size);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut stats = renderer.render(context, plan, scene, pose, &view, PICTURE_FORMAT)?;
    let pixels = read(context, &texture, wgpu::TextureAspect::All, 4, plan.size)?;
    stats.gpu_ms = renderer.gpu_ms();
    add_computed(context, renderer, plan, &mut stats)?;
    if let Some(error) = context.take_error() {
        return Err(GpuError::Device(error));
    }
    let image = image::RgbaImage::from_raw(width, height, pixels)
        .ok_or_else(|| GpuError::Device("the picture came back with a wrong size".into()))?;
    Ok((stats, image))
}

/// The stencil as the last frame left it, one byte a pixel, rows from the top; frames of one sample only.
///
/// # Errors
/// No frame yet, several samples, or a device that does not answer.
pub fn stencil(context: &Context, renderer: &Renderer) -> Result<Vec<u8>, GpuError> {
    let targets = renderer.targets().ok_or_else(|| GpuError::Device("nothing was drawn yet".into()))?;
    if targets.shape.samples != 1 {
        return Err(GpuError::Device("the stencil of several samples cannot be read".into()));
    }
    read(context, &targets.depth_stencil_texture, wgpu::TextureAspect::StencilOnly, 1, targets.shape.size)
}

/// Depth as the last frame left it, reverse-Z, rows from the top; frames of one sample only.
///
/// # Errors
/// No frame yet, several samples, a device without float depth, or one that does not answer.
pub fn depth(context: &Context, renderer: &Renderer) -> Result<Vec<f32>, GpuError> {
    let targets = renderer.targets().ok_or_else(|| GpuError::Device("nothing was drawn yet".into()))?;
    if targets.shape.samples != 1 || !context.capabilities().float_depth {
        return Err(GpuError::Device("this depth cannot be read: several samples, or no floats".into()));
    }
    let bytes = read(context, &targets.depth_stencil_texture, wgpu::TextureAspect::DepthOnly, 4, targets.shape.size)?;
    Ok(bytes.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
}

/// What the last frame that counted beyond the stencil counted, rows from the top; frames of one
/// sample only.
///
/// # Errors
/// No such frame yet, several samples, or a device that does not answer.
pub fn counts(context: &Context, renderer: &Renderer) -> Result<Vec<f32>, GpuError> {
    let counts = renderer.targets().and_then(|targets| targets.counts.as_ref().map(|counts| (counts, targets)));
    let (counts, targets) = counts.ok_or_else(|| GpuError::Device("nothing was counted wide yet".into()))?;
    if targets.shape.samples != 1 {
        return Err(GpuError::Device("the counts of several samples cannot be read".into()));
    }
    let aspect = wgpu::TextureAspect::All;
    Ok(match context.capabilities().wide_counts {
        WideCounts::Float32 => {
            let bytes = read(context, &counts.texture, aspect, 4, targets.shape.size)?;
            bytes.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
        }
        WideCounts::Float16 => {
            let bytes = read(context, &counts.texture, aspect, 2, targets.shape.size)?;
            bytes.as_chunks::<2>().0.iter().map(|bytes| half(u16::from_le_bytes(*bytes))).collect()
        }
    })
}

/// A half-precision float, finite, in single precision.
fn half(bits: u16) -> f32 {
    let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    let size = if exponent == 0 { mantissa * 2f32.powi(-24) } else { (1024.0 + mantissa) * 2f32.powi(exponent - 25) };
    if bits >> 15 == 1 { -size } else { size }
}

fn read(
    context: &Context,
    texture: &wgpu::Texture,
    aspect: wgpu::TextureAspect,
    texel: u32,
    [width, height]: [u32; 2],
) -> Result<Vec<u8>, GpuError> {
    let row = width * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(padded) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo { texture, mip_level: 0, origin: wgpu::Origin3d::ZERO, aspect },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
        },
        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
    );
    let bytes = finish(context, encoder, &buffer)?;
    Ok(bytes.chunks_exact(padded as usize).flat_map(|line| &line[..row as usize]).copied().collect())
}

/// The indices of every part of a volume that the last frame drew, by the CPU or on the device, in the order in which
/// `plan`, which is that frame's, draws them first.
///
/// # Errors
/// A device that does not answer.
pub fn volume_parts(context: &Context, renderer: &Renderer, plan: &FramePlan) -> Result<Vec<(VolumePart, Vec<u32>)>, GpuError> {
    let frame = renderer.frame_buffers();
    let words = |buffer: Option<&wgpu::Buffer>| buffer.map_or(Ok(Vec::new()), |buffer| all_words(context, buffer));
    let (draws, indices) = (words(frame.compute.draws.buffer())?, words(frame.compute.indices.buffer())?);
    let mut parts: Vec<(VolumePart, Vec<u32>)> = Vec::new();
    for (_, draw) in plan.draws() {
        let DrawSet::Volumes(drawn) = &draw.set else { continue };
        for &part in drawn {
            if parts.iter().any(|(known, _)| (known.volume, known.part) == (part.volume, part.part)) {
                continue;
            }
            let found = match frame.compute.slot(part) {
                None => frame.built(part),
                Some(slot) => {
                    let at = slot as usize * 5;
                    let [count, first] = [draws[at], draws[at + 2]].map(|word| word as usize);
                    indices[first..first + count].to_vec()
                }
            };
            parts.push((part, found));
        }
    }
    Ok(parts)
}

/// What the device alone knows of the frame that was drawn last, by `plan`: the volumes whose silhouettes it found, added to
/// the CPU's numbers.
///
/// # Errors
/// A device that does not answer.
pub fn add_computed(context: &Context, renderer: &Renderer, plan: &FramePlan, stats: &mut FrameStats) -> Result<(), GpuError> {
    let frame = renderer.frame_buffers();
    let computed = plan.volumes.iter().any(|volume| !volume.silhouette.is_cpu());
    let Some(draws) = frame.compute.draws.buffer().filter(|_| computed) else { return Ok(()) };
    let draws = all_words(context, draws)?;
    // Views that see one volume draw one set of indices.
    let mut built = HashSet::new();
    for (_, draw) in plan.draws() {
        let DrawSet::Volumes(parts) = &draw.set else { continue };
        for part in parts {
            let Some(slot) = frame.compute.slot(*part) else { continue };
            let indices = u64::from(draws[slot as usize * 5]);
            stats.volume_triangles += indices / 3;
            stats.triangles += indices / 3;
            // What closes a piece and what closes the whole are the same triangles.
            let kind = if part.part == Part::EndCap { Part::DarkCap } else { part.part };
            if built.insert((frame.first_of_shape(part.volume), kind)) {
                stats.indices += indices;
                stats.index_bytes += indices * 4;
            }
        }
    }
    Ok(())
}

/// All of a buffer that can be copied from.
fn all_words(context: &Context, source: &wgpu::Buffer) -> Result<Vec<u32>, GpuError> {
    let buffer = context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: source.size(),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
    encoder.copy_buffer_to_buffer(source, 0, &buffer, 0, source.size());
    let bytes = finish(context, encoder, &buffer)?;
    Ok(bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect())
}

/// Submits what copies into `buffer`, and waits for its bytes.
fn finish(context: &Context, encoder: wgpu::CommandEncoder, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let submission = context.queue.submit([encoder.finish()]);
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver is gone only when this function has returned with an error already.
        let _ = sender.send(result);
    });
    context.wait(submission)?;
    match receiver.try_recv() {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(GpuError::Device(error.to_string())),
        Err(_) => return Err(GpuError::Device("the picture did not come back".into())),
    }
    let view = buffer.get_mapped_range(..).map_err(|error| GpuError::Device(error.to_string()))?;
    let bytes = view.to_vec();
    drop(view);
    buffer.unmap();
    Ok(bytes)
}
