//! Lines and areas over the picture: the panel's own tessellator (epaint) makes triangles of them, whose rims
//! fade within a pixel.

use bytemuck::cast_slice;
use egui::epaint::{Mesh, PathShape, PathStroke, TessellationOptions, Tessellator};
use egui::{Color32, Pos2};

use super::context::Context;
use super::growing::Growing;
use super::types::LineVertex;
use crate::frame::{DrawSet, FramePlan, Stroke};

/// The triangles of the frame's lines.
pub struct Lines {
    vertices: Growing,
    indices: Growing,
    drawn: Vec<Stroke>,
    index_count: u32,
}

impl Default for Lines {
    fn default() -> Self {
        Self {
            vertices: Growing::new("line vertices", wgpu::BufferUsages::VERTEX),
            indices: Growing::new("line indices", wgpu::BufferUsages::INDEX),
            drawn: Vec::new(),
            index_count: 0,
        }
    }
}

impl Lines {
    /// The triangles of the lines that the plan draws.
    pub fn write(&mut self, context: &Context, plan: &FramePlan) {
        let strokes = plan.draws().find_map(|(_, draw)| match &draw.set {
            DrawSet::Strokes(strokes) => Some(strokes),
            _ => None,
        });
        let Some(strokes) = strokes.filter(|strokes| **strokes != self.drawn) else { return };
        let options = TessellationOptions {
            coarse_tessellation_culling: false,
            round_line_segments_to_pixels: false,
            ..Default::default()
        };
        let mut tessellator = Tessellator::new(1.0, options, [1, 1], Vec::new());
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        let mut append = |shape: PathShape, color: [f32; 4]| {
            let mut mesh = Mesh::default();
            tessellator.tessellate_path(&shape, &mut mesh);
            let first = u32::try_from(vertices.len()).unwrap_or(0);
            // Shapes are white: what the tessellator says of a vertex is how much of it there is.
            vertices.extend(mesh.vertices.iter().map(|vertex| {
                let [r, g, b, alpha] = color;
                let alpha = alpha * f32::from(vertex.color.a()) / 255.0;
                LineVertex { at: vertex.pos.into(), color: [r * alpha, g * alpha, b * alpha, alpha] }
            }));
            indices.extend(mesh.indices.iter().map(|index| first + index));
        };
        for stroke in strokes {
            let points: Vec<Pos2> = stroke.points.iter().map(|&at| at.into()).collect();
            if let Some(fill) = stroke.fill {
                append(PathShape::convex_polygon(points.clone(), Color32::WHITE, PathStroke::NONE), fill);
            }
            let line = PathStroke::new(stroke.width, Color32::WHITE);
            let shape = if stroke.closed { PathShape::closed_line(points, line) } else { PathShape::line(points, line) };
            append(shape, stroke.color);
        }
        self.vertices.write(context, cast_slice(&vertices), size_of::<LineVertex>());
        self.indices.write(context, cast_slice(&indices), 4);
        self.index_count = u32::try_from(indices.len()).unwrap_or(0);
        self.drawn.clone_from(strokes);
    }

    /// Vertices, indices, and how many of those [`Self::write`] made.
    #[must_use]
    pub fn get(&self) -> Option<(&wgpu::Buffer, &wgpu::Buffer, u32)> {
        Some((self.vertices.buffer()?, self.indices.buffer()?, self.index_count))
    }
}
