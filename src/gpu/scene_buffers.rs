//! The scene on the device: what does not change while it is shown, and room for what is posed.

use super::context::{Context, GpuError};
use super::texture::{self, Samplers};
use super::types::{Attributes, Material};
use crate::geometry::outward;
use crate::scene::{self, AlphaMode, DeformedMesh, Mesh, Node, Scene};
use bytemuck::cast_slice;
use glam::Vec3;

/// Bytes that a scene may take on the device; llvmpipe overcommits memory until it aborts.
const BUDGET: u64 = 3 << 30;

/// A scene's buffers, textures and bind groups.
pub struct SceneBuffers {
    /// One per mesh.
    pub meshes: Vec<MeshBuffers>,
    /// What each instance shows, as [`Scene::instances`] counts them.
    pub shown: Vec<Shown>,
    /// One per instance: its own vertices while it is deformed.
    pub deformed: Vec<Option<VertexBuffers>>,
    /// One per material.
    pub materials: Vec<wgpu::BindGroup>,
    /// The numbers of all of them.
    pub all_materials: wgpu::Buffer,
}

/// An instance of the scene that was set, found without a walk through its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shown {
    /// The node that shows it.
    pub node: usize,
    /// The mesh that is shown.
    pub mesh: usize,
}

/// One mesh: its vertices at rest, and what every pose of it shares.
pub struct MeshBuffers {
    /// At rest.
    pub vertices: VertexBuffers,
    /// `u32`, three a triangle.
    pub indices: wgpu::Buffer,
    /// `u32`, two a line; made when first shown.
    pub edges: Option<(wgpu::Buffer, u32)>,
}

/// The vertices of one pose.
pub struct VertexBuffers {
    /// `Float32x3`, object space.
    pub positions: wgpu::Buffer,
    /// [`Attributes`].
    pub attributes: wgpu::Buffer,
    /// `Float32x4`: welded positions with w = 1, then the same with w = 0.
    pub volume: wgpu::Buffer,
    /// `Float32x3`, object space: which way is out ([`outward::directions`]); made when first drawn swollen.
    pub outward: Option<wgpu::Buffer>,
    /// Welded positions, as volumes are built from them.
    pub welded: Vec<Vec3>,
    /// Memory that positions are gathered in.
    scratch: Scratch,
}

#[derive(Default)]
struct Scratch {
    attributes: Vec<Attributes>,
    volume: Vec<[f32; 4]>,
}

fn described(number: usize, material: &scene::Material) -> Material {
    Material {
        base_color: material.base_color.to_array(),
        emissive: material.emissive.to_array(),
        roughness: material.roughness,
        metallic: material.metallic,
        cutoff: if let AlphaMode::Mask(cutoff) = material.alpha { cutoff } else { 0.0 },
        unlit: f32::from(u8::from(material.unlit)),
        #[expect(clippy::cast_precision_loss, reason = "f32 holds whole numbers to 16 million")]
        number: number as f32,
    }
}

impl SceneBuffers {
    /// Uploads a scene.
    ///
    /// # Errors
    /// More bytes than the budget or the device's largest buffer.
    pub fn new(
        context: &Context,
        layout: &wgpu::BindGroupLayout,
        samplers: &mut Samplers,
        scene: &Scene,
    ) -> Result<Self, GpuError> {
        check_budget(context, scene)?;
        let meshes = scene
            .meshes
            .iter()
            .map(|mesh| MeshBuffers {
                vertices: VertexBuffers::new(context, mesh, mesh),
                indices: filled(context, &mesh.name, cast_slice(&mesh.indices), wgpu::BufferUsages::INDEX),
                edges: None,
            })
            .collect();
        let textures: Vec<_> = scene.textures.iter().map(|texture| texture::upload(context, texture)).collect();
        let white = texture::white(context);
        let values: Vec<_> = scene.materials.iter().enumerate().map(|(number, material)| described(number, material)).collect();
        // A buffer must not be empty.
        let stand_in = [Material::default()];
        let all_materials = filled(
            context,
            "materials",
            cast_slice(if values.is_empty() { &stand_in } else { &values }),
            wgpu::BufferUsages::STORAGE,
        );
        let materials = scene
            .materials
            .iter()
            .zip(&values)
            .map(|(material, values)| {
                let image = material.base_color_texture.and_then(|index| scene.textures.get(index).zip(textures.get(index)));
                let sampler = samplers.get(context, image.map(|(texture, _)| texture));
                let uniform = filled(context, &material.name, bytemuck::bytes_of(values), wgpu::BufferUsages::UNIFORM);
                context.device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some(&material.name),
                    layout,
                    entries: &[
                        wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
                        wgpu::BindGroupEntry {
                            binding: 1,
                            resource: wgpu::BindingResource::TextureView(image.map_or(&white, |(_, view)| view)),
                        },
                        wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&sampler) },
                    ],
                })
            })
            .collect();
        let mesh_of = |node: &Node| node.mesh.unwrap_or(0);
        let shown: Vec<_> = scene.instances().map(|(index, node, _)| Shown { node: index, mesh: mesh_of(node) }).collect();
        let deformed = shown.iter().map(|_| None).collect();
        Ok(Self { meshes, shown, deformed, materials, all_materials })
    }

    /// The vertices an instance shows now.
    #[must_use]
    pub fn vertices(&self, instance: usize) -> &VertexBuffers {
        self.deformed[instance].as_ref().unwrap_or(&self.meshes[self.shown[instance].mesh].vertices)
    }

    /// Takes an instance's pose: its own vertices while it is deformed, the mesh's otherwise.
    pub fn pose(&mut self, context: &Context, instance: usize, mesh: &Mesh, deformed: Option<&DeformedMesh>) {
        let slot = &mut self.deformed[instance];
        match (deformed, slot.as_mut()) {
            (None, _) => *slot = None,
            (Some(pose), Some(buffers)) => buffers.write(context, mesh, pose),
            (Some(pose), None) => *slot = Some(VertexBuffers::new(context, mesh, pose)),
        }
    }

    /// Says which way is out at the vertices that an instance of `mesh` shows now, if that is not there yet.
    pub fn prepare_outward(&mut self, context: &Context, instance: usize, index: usize, mesh: &Mesh) {
        let vertices = self.deformed[instance].as_mut().unwrap_or(&mut self.meshes[index].vertices);
        if vertices.outward.is_none() {
            let welded = &mesh.topology.weld().welded_of_vertex;
            let triangles = mesh.indices.as_chunks::<3>().0.iter().map(|corners| corners.map(|vertex| welded[vertex as usize]));
            let ways = outward::directions(triangles, &vertices.welded);
            let of_vertices: Vec<Vec3> = welded.iter().map(|&welded| ways[welded as usize]).collect();
            vertices.outward = Some(filled(context, "outward", cast_slice(&of_vertices), wgpu::BufferUsages::VERTEX));
        }
    }

    /// Makes a mesh's line list if it is not there yet.
    pub fn prepare_edges(&mut self, context: &Context, index: usize, mesh: &Mesh) {
        let buffers = &mut self.meshes[index];
        if buffers.edges.is_none() {
            let mut lines: Vec<[u32; 2]> = mesh
                .indices
                .as_chunks::<3>()
                .0
                .iter()
                .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
                .map(|[a, b]| [a.min(b), a.max(b)])
                .collect();
            lines.sort_unstable();
            lines.dedup();
            let buffer = filled(context, "edges", cast_slice(&lines), wgpu::BufferUsages::INDEX);
            buffers.edges = Some((buffer, u32::try_from(lines.len() * 2).unwrap_or(u32::MAX)));
        }
    }
}

/// Where a pose's vertex data comes from.
trait VertexSource {
    fn positions(&self) -> &[Vec3];
    fn normals(&self) -> &[Vec3];
    fn terminator(&self) -> &[f32];
}

impl VertexSource for Mesh {
    fn positions(&self) -> &[Vec3] {
        &self.positions
    }
    fn normals(&self) -> &[Vec3] {
        &self.normals
    }
    fn terminator(&self) -> &[f32] {
        &self.terminator
    }
}

impl VertexSource for DeformedMesh {
    fn positions(&self) -> &[Vec3] {
        &self.positions
    }
    fn normals(&self) -> &[Vec3] {
        &self.normals
    }
    fn terminator(&self) -> &[f32] {
        &self.terminator
    }
}

impl VertexBuffers {
    fn new(context: &Context, mesh: &Mesh, source: &impl VertexSource) -> Self {
        let vertices = mesh.positions.len().max(1) as u64;
        let welded = mesh.topology.weld().vertex_of_welded.len().max(1) as u64;
        let buffer = |label, size| {
            context.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let mut buffers = Self {
            positions: buffer("positions", vertices * 12),
            attributes: buffer("attributes", vertices * size_of::<Attributes>() as u64),
            volume: buffer("volume vertices", welded * 32),
            outward: None,
            welded: Vec::new(),
            scratch: Scratch::default(),
        };
        buffers.write(context, mesh, source);
        buffers
    }

    fn write(&mut self, context: &Context, mesh: &Mesh, source: &impl VertexSource) {
        let positions = source.positions();
        self.outward = None;
        self.scratch.attributes.clear();
        self.scratch.attributes.extend((0..positions.len()).map(|vertex| Attributes {
            normal: source.normals()[vertex].to_array(),
            uv: mesh.uvs[vertex].to_array(),
            color: mesh.colors[vertex],
            sin_bound: source.terminator()[vertex],
        }));
        self.welded.clear();
        self.welded.extend(mesh.topology.weld().vertex_of_welded.iter().map(|&vertex| positions[vertex as usize]));
        self.scratch.volume.clear();
        for w in [1.0, 0.0] {
            self.scratch.volume.extend(self.welded.iter().map(|position| position.extend(w).to_array()));
        }
        context.queue.write_buffer(&self.positions, 0, cast_slice(positions));
        context.queue.write_buffer(&self.attributes, 0, cast_slice(&self.scratch.attributes));
        context.queue.write_buffer(&self.volume, 0, cast_slice(&self.scratch.volume));
    }
}

/// A buffer with these bytes; at least four, as a buffer may not be empty. Written through the queue:
/// a mapped buffer panics where the device is lost or out of memory.
fn filled(context: &Context, label: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let buffer = context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len().next_multiple_of(4).max(4) as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    context.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

fn check_budget(context: &Context, scene: &Scene) -> Result<(), GpuError> {
    let mut bytes = 0u64;
    let largest = context.device.limits().max_buffer_size;
    for mesh in &scene.meshes {
        let vertices = mesh.positions.len() as u64;
        let parts = [vertices * 12, vertices * size_of::<Attributes>() as u64, vertices * 32, mesh.indices.len() as u64 * 4];
        if let Some(part) = parts.iter().find(|&&part| part > largest) {
            let what = format!("mesh `{}` needs a buffer of {} MiB, the device allows {}", mesh.name, part >> 20, largest >> 20);
            return Err(GpuError::TooLarge(what));
        }
        bytes += parts.iter().sum::<u64>();
    }
    for (_, node, mesh) in scene.instances() {
        if node.skin.is_some() || !mesh.morphs.is_empty() {
            bytes += mesh.positions.len() as u64 * (12 + 28 + 32);
        }
    }
    let side = context.device.limits().max_texture_dimension_2d;
    for texture in &scene.textures {
        if texture.width > side || texture.height > side {
            let what = format!("texture `{}` is {} x {}, the device allows {side}", texture.name, texture.width, texture.height);
            return Err(GpuError::TooLarge(what));
        }
        bytes += texture.rgba.len() as u64 * 4 / 3;
    }
    if bytes > BUDGET {
        return Err(GpuError::TooLarge(format!("it needs {} MiB of {} MiB", bytes >> 20, BUDGET >> 20)));
    }
    Ok(())
}
