//! Names over the picture: text to triangles and an atlas of glyphs.
//!
//! The panel's own text engine (epaint) rasterises the glyphs of the font it brings along; the atlas grows
//! as names need it.

use std::sync::Arc;

use bytemuck::cast_slice;
use egui::epaint::text::{Fonts, LayoutJob, TextOptions};
use egui::{Color32, FontDefinitions, FontId};

use super::context::Context;
use super::growing::Growing;
use super::types::LabelVertex;
use crate::frame::{DrawSet, FramePlan, Label, LabelKind};

/// As the picture stores them (sRGB), premultiplied.
const PLATE: [f32; 4] = [0.03, 0.036, 0.05, 0.5];
const OF_LIGHTS: [f32; 4] = [1.0, 0.81, 0.46, 1.0];
const OF_CASTERS: [f32; 4] = [0.94, 0.95, 0.98, 1.0];

/// Fonts, their atlas, and the triangles of the frame's names.
pub struct Labels {
    /// Made when the first name is drawn.
    fonts: Option<Fonts>,
    atlas: Option<(wgpu::Texture, wgpu::BindGroup)>,
    vertices: Growing,
    indices: Growing,
    drawn: Vec<Label>,
    index_count: u32,
}

impl Default for Labels {
    fn default() -> Self {
        Self {
            fonts: None,
            atlas: None,
            vertices: Growing::new("label vertices", wgpu::BufferUsages::VERTEX),
            indices: Growing::new("label indices", wgpu::BufferUsages::INDEX),
            drawn: Vec::new(),
            index_count: 0,
        }
    }
}

/// What a pass draws names with.
pub struct Drawable<'a> {
    pub atlas: &'a wgpu::BindGroup,
    pub vertices: &'a wgpu::Buffer,
    pub indices: &'a wgpu::Buffer,
    pub index_count: u32,
}

impl Labels {
    /// The triangles of the names that the plan draws, and the atlas they need.
    pub fn write(&mut self, context: &Context, layout: &wgpu::BindGroupLayout, plan: &FramePlan) {
        let labels = plan.draws().find_map(|(_, draw)| match &draw.set {
            DrawSet::Labels(labels) => Some(labels),
            _ => None,
        });
        let Some(labels) = labels.filter(|labels| **labels != self.drawn) else { return };
        let fonts = self.fonts.get_or_insert_with(|| {
            let max_texture_side = context.capabilities().max_size.min(2048) as usize;
            Fonts::new(TextOptions { max_texture_side, ..TextOptions::default() }, FontDefinitions::default())
        });
        // Rasterise all of them before any coordinate is taken: the atlas may grow meanwhile.
        let texts: Vec<_> = labels
            .iter()
            .map(|label| {
                let font = FontId::monospace(label.text_size);
                fonts.layout_uncached(1.0, Arc::new(LayoutJob::simple_singleline(label.text.clone(), font, Color32::WHITE)))
            })
            .collect();
        #[expect(clippy::cast_precision_loss, reason = "texels")]
        let atlas_size = fonts.font_image_size().map(|side| side as f32);
        let mut shapes = Shapes::default();
        for (label, text) in labels.iter().zip(&texts) {
            let color = match label.kind {
                LabelKind::Light => OF_LIGHTS,
                LabelKind::Eye | LabelKind::Caster | LabelKind::Legend | LabelKind::Shape | LabelKind::Note => OF_CASTERS,
            };
            let [x, y, width, height] = label.plate;
            let size = text.rect.size();
            let centered = [(x + (width - size.x) / 2.0).round(), (y + (height - size.y) / 2.0).round()];
            let mut origin = centered;
            if label.kind == LabelKind::Legend {
                origin[0] = x.round();
            } else {
                shapes.rectangle([x, y, width, height], PLATE);
            }
            if matches!(label.kind, LabelKind::Light | LabelKind::Eye | LabelKind::Caster) {
                let [ax, ay] = label.anchor.map(f32::round);
                shapes.rectangle([ax - 2.0, ay - 2.0, 4.0, 4.0], color);
            }
            for row in &text.rows {
                let mesh = &row.row.visuals.mesh;
                let first = shapes.next();
                shapes.vertices.extend(mesh.vertices.iter().map(|vertex| LabelVertex {
                    at: [origin[0] + row.pos.x + vertex.pos.x, origin[1] + row.pos.y + vertex.pos.y],
                    uv: [vertex.uv.x / atlas_size[0], vertex.uv.y / atlas_size[1]],
                    color,
                }));
                shapes.indices.extend(mesh.indices.iter().map(|index| first + index));
            }
        }
        self.vertices.write(context, cast_slice(&shapes.vertices), size_of::<LabelVertex>());
        self.indices.write(context, cast_slice(&shapes.indices), 4);
        self.index_count = u32::try_from(shapes.indices.len()).unwrap_or(0);
        self.drawn.clone_from(labels);
        if fonts.font_image_delta().is_some() || self.atlas.is_none() {
            self.atlas = Some(upload(context, layout, fonts));
        }
    }

    /// What [`Self::write`] made.
    #[must_use]
    pub fn get(&self) -> Option<Drawable<'_>> {
        let (_, atlas) = self.atlas.as_ref()?;
        let (vertices, indices) = (self.vertices.buffer()?, self.indices.buffer()?);
        Some(Drawable { atlas, vertices, indices, index_count: self.index_count })
    }
}

fn upload(context: &Context, layout: &wgpu::BindGroupLayout, fonts: &Fonts) -> (wgpu::Texture, wgpu::BindGroup) {
    let image = fonts.image();
    let [width, height] = image.size.map(|side| u32::try_from(side).unwrap_or(1));
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = context.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("glyphs"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    // Only how much of a texel is covered: colours are the names' own.
    let coverage: Vec<u8> = image.pixels.iter().map(|pixel| pixel.a()).collect();
    context.queue.write_texture(
        texture.as_image_copy(),
        &coverage,
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width), rows_per_image: None },
        size,
    );
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let group = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("glyphs"),
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
    });
    (texture, group)
}

#[derive(Default)]
struct Shapes {
    vertices: Vec<LabelVertex>,
    indices: Vec<u32>,
}

impl Shapes {
    fn next(&self) -> u32 {
        u32::try_from(self.vertices.len()).unwrap_or(0)
    }

    /// x, y, width and height in pixels. The atlas's first texel is covered whole.
    fn rectangle(&mut self, [x, y, width, height]: [f32; 4], color: [f32; 4]) {
        let first = self.next();
        let corners = [[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
        self.vertices.extend(corners.map(|at| LabelVertex { at, uv: [0.0; 2], color }));
        self.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
}
