//! Every struct shared with WGSL. A test compares each field's offset with naga's layout of the
//! struct of the same name in `shaders/shared/`.

use bytemuck::{Pod, Zeroable};

/// `struct Frame` of `shared/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct Frame {
    /// World space, metres.
    pub eye: [f32; 3],
    /// Times linear colour.
    pub exposure: f32,
    /// Linear radiance.
    pub ambient_sky: [f32; 3],
    /// 1 or 0.
    pub smooth_terminator: f32,
    /// Linear radiance.
    pub ambient_ground: [f32; 3],
    /// How many `lights` there are, those that are off included.
    pub light_count: u32,
    /// Linear.
    pub background_top: [f32; 3],
    /// The size of a pixel one metre before the eye, metres.
    pub pixel: f32,
    /// Linear.
    pub background_bottom: [f32; 3],
    /// Times all light that surfaces give; `exposure` is then less by it.
    pub scale: f32,
    /// Pixels.
    pub size: [f32; 2],
    #[doc(hidden)]
    pub _pad2: [f32; 2],
    /// By columns. Not what places vertices: only the failure of mismatched arithmetic is computed by it.
    pub clip_from_world: [[f32; 4]; 4],
    /// World space: nothing under it is drawn by what asks. Of views by way of a mirror.
    pub clip_plane: [f32; 4],
    /// Unit: through the middle of the picture.
    pub way_ahead: [f32; 3],
    /// Metres.
    pub near: f32,
    /// From there to the right edge, one metre before the eye.
    pub way_right: [f32; 3],
    #[doc(hidden)]
    pub _pad3: f32,
    /// And to the upper edge.
    pub way_up: [f32; 3],
    #[doc(hidden)]
    pub _pad4: f32,
}

/// `struct Object` of `shared/frame.wgsl`; matrices by columns.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct Object {
    /// The one matrix that places vertices on screen.
    pub clip_from_object: [[f32; 4]; 4],
    /// Metres.
    pub world_from_object: [[f32; 4]; 4],
    /// Inverse transpose, unnormalised.
    pub normal_from_object: [[f32; 4]; 4],
}

/// `struct Light` of `shared/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct Light {
    /// World space.
    pub position: [f32; 3],
    /// 0 where it has no end.
    pub inverse_range_squared: f32,
    /// Unit, where it shines to.
    pub direction: [f32; 3],
    /// Of a spot's outer half angle.
    pub cos_outer: f32,
    /// Linear RGB, candela or lux.
    pub intensity: [f32; 3],
    /// 1 / (cos inner - cos outer).
    pub inverse_cone_width: f32,
    /// Unit, square to `direction`: to the right of what it projects.
    pub right: [f32; 3],
    /// 0 point, 1 directional, 2 spot, 3 projector.
    pub kind: u32,
    /// Which slide it projects, a layer of the slides' array.
    pub slide: u32,
    /// Slide halves a metre beside the axis, one metre before the light.
    pub slide_scale: f32,
    /// -1 for a light that is reflected, with all that it projects; else 1.
    pub hand: f32,
    #[doc(hidden)]
    pub _pad: u32,
}

/// `struct Volume` of `shared/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct Volume {
    /// The light in the caster's object space, homogeneous.
    pub light_in_object: [f32; 4],
    /// The plane the volume ends on, in the same space.
    pub end_in_object: [f32; 4],
    /// And the plane it starts on; all zero where it starts at its caster.
    pub start_in_object: [f32; 4],
    /// Where a cut-out's far vertices go: homogeneous object space. For ZP+, where the light sees a
    /// vertex through the near rectangle, and for planar shadows, where it throws it: clip space.
    pub thrown: [[f32; 4]; 4],
    /// The caster's instance number.
    pub object: u32,
    /// 1 for cut-outs, whose far vertices are thrown by the matrix.
    pub by_matrix: u32,
    /// Metres from the light to the far end; 0 where that is a plane.
    pub extrusion: f32,
    #[doc(hidden)]
    pub _pad: u32,
}

/// `struct Draw` of `shared/frame.wgsl`: one a step, at a dynamic offset.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct Draw {
    /// Linear RGBA.
    pub constant: [f32; 4],
    /// The light looked at.
    pub light: Light,
    /// Pixels that swollen surfaces grow by.
    pub swell: f32,
    #[doc(hidden)]
    pub _pad: [f32; 3],
}

/// A corner of a name's plate or of one of its letters: `LabelVertex` of `labels.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct LabelVertex {
    /// Pixels from the upper left.
    pub at: [f32; 2],
    /// In the atlas, 0 to 1.
    pub uv: [f32; 2],
    /// As the picture stores it, premultiplied.
    pub color: [f32; 4],
}

/// A corner of a line's or an area's triangles: `LineVertex` of `lines.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct LineVertex {
    /// Pixels from the upper left.
    pub at: [f32; 2],
    /// As the picture stores it, premultiplied.
    pub color: [f32; 4],
}

/// `struct Material` of `shared/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct Material {
    /// Linear, with alpha.
    pub base_color: [f32; 4],
    /// Linear radiance.
    pub emissive: [f32; 3],
    /// 0 to 1.
    pub roughness: f32,
    /// 0 to 1.
    pub metallic: f32,
    /// Of masked materials.
    pub cutoff: f32,
    /// 1 or 0.
    pub unlit: f32,
    /// Among the scene's materials.
    pub number: f32,
}

/// What a surface vertex has beside its position, interleaved.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct Attributes {
    /// Unit, object space.
    pub normal: [f32; 3],
    /// Of the base colour texture.
    pub uv: [f32; 2],
    /// Linear RGBA, 0 to 255 for 0 to 1.
    pub color: [u8; 4],
    /// Sine of the terminator bound.
    pub sin_bound: f32,
}

/// One volume whose silhouette a compute shader finds. Words of the arenas, places among facings and indices.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Job {
    /// The light in object space, as bits.
    pub light: [u32; 4],
    /// As [`crate::geometry::Planes::unsure`] gives it, as bits.
    pub reach: u32,
    /// The same.
    pub room: u32,
    /// The same.
    pub rounding: u32,
    /// Which parts are built, and how.
    pub flags: u32,
    /// Where the mesh's triangles stand in the arena of topologies.
    pub triangles: u32,
    /// Their neighbours.
    pub neighbours: u32,
    /// The edges of two triangles.
    pub pairs: u32,
    /// All other edges.
    pub others: u32,
    /// Those edges' triangles.
    pub incidences: u32,
    /// Where the planes stand in the arena of poses.
    pub planes: u32,
    /// The welded vertices.
    pub welded: u32,
    /// How many welded vertices there are.
    pub vertices: u32,
    /// The first triangle's place among facings.
    pub facing: u32,
    /// The place of the list of those seen edge-on.
    pub edge_on: u32,
    /// The first index of the sides.
    pub sides: u32,
    /// Of the light cap.
    pub cap: u32,
    /// Of the dark cap.
    pub dark: u32,
    /// How many triangles there are.
    pub triangle_count: u32,
    /// Edges of two triangles.
    pub pair_count: u32,
    /// Other edges.
    pub other_count: u32,
    /// The first block of triangles.
    pub triangle_block: u32,
    /// How many there are.
    pub triangle_blocks: u32,
    /// The first block of edges.
    pub edge_block: u32,
    /// How many there are.
    pub edge_blocks: u32,
    /// The first index of the start cap.
    pub start: u32,
    #[doc(hidden)]
    pub _pad: [u32; 3],
}
