//! Pipelines by value: the state in the step is the cache key. Nothing here knows a technique.

use std::collections::HashMap;

use super::context::{Context, DARK_FORMAT, GEOMETRY_FORMAT, GpuError, MEAN_FORMAT, color_format};
use super::shaders::{BANDS, Library, Override, Vertices, entry_of};
use super::types::{Attributes, Draw, Frame, LabelVertex, Light, LineVertex, Material, Object, Volume};
use crate::frame::state::{Blend, Compare, Cull, DepthBias, NearPlane, State, Winding};
use crate::frame::stencil::{StencilFace, StencilOp};
use crate::frame::{LightShape, Look, MirrorLook, Program, SHADED_TOGETHER, Target};
use crate::settings::Accumulation;

/// Everything a pipeline depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Key {
    /// Which shaders.
    pub program: Program,
    /// What of them is needed.
    pub look: Look,
    /// The whole fixed state.
    pub state: State,
    /// Where it draws to.
    pub target: Target,
    /// The picture's format, for [`Target::Output`].
    pub output: wgpu::TextureFormat,
    /// Of the scene's targets.
    pub samples: u32,
    /// What lights are added into, for [`Target::Scene`].
    pub accumulation: Accumulation,
}

/// What a full-screen program finds in group 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reads {
    /// There is none.
    Nothing,
    /// Scene colour and stencil.
    Targets,
    /// The counts, one sample a pixel.
    Counts,
    /// The counts, several samples a pixel.
    CountsEach,
    /// A solid's own depth and stencil, one sample a pixel.
    Solid,
    /// The same, several samples a pixel.
    SolidEach,
    /// What was kept of the surfaces that pixels show.
    Geometry,
}

/// What a program that is no surface's reads, drawing into `target`.
#[must_use]
pub fn reads(program: Program, target: Target) -> Reads {
    match program {
        Program::WideVerdict | Program::WideBit | Program::WideOverflow => Reads::Counts,
        Program::WideVerdictEach => Reads::CountsEach,
        Program::SolidMerge => Reads::Solid,
        Program::SolidMergeEach => Reads::SolidEach,
        Program::Shade => Reads::Geometry,
        _ if matches!(target, Target::Mean | Target::Output) => Reads::Targets,
        _ => Reads::Nothing,
    }
}

/// Bind group layouts, shader modules and the pipelines made so far.
pub struct Pipelines {
    /// Group 0: frame, objects, lights, volumes, draw, slides and their sampler.
    pub frame_layout: wgpu::BindGroupLayout,
    /// Group 1 of surfaces: material, texture, sampler.
    pub material_layout: wgpu::BindGroupLayout,
    /// Group 1 of the full-screen programs: scene colour or a mean in its place, stencil, the mean before.
    pub targets_layout: wgpu::BindGroupLayout,
    /// Group 1 of names: the atlas of glyphs.
    pub labels_layout: wgpu::BindGroupLayout,
    /// Group 1 of programs that read the counts, of one sample and of several.
    pub counts_layouts: [wgpu::BindGroupLayout; 2],
    /// Group 1 of what reads a solid's own target, of one sample and of several.
    pub solid_layouts: [wgpu::BindGroupLayout; 2],
    /// Group 1 of what shades pixels: depth, surfaces, the lights' bits, materials.
    pub geometry_layout: wgpu::BindGroupLayout,
    /// Group 2 of mirrors with a texture: the texture, its sampler.
    pub reflection_layout: wgpu::BindGroupLayout,
    bare: wgpu::PipelineLayout,
    surface: wgpu::PipelineLayout,
    mirrored: wgpu::PipelineLayout,
    kept: wgpu::PipelineLayout,
    picture: wgpu::PipelineLayout,
    labels: wgpu::PipelineLayout,
    geometry: wgpu::PipelineLayout,
    counts: [wgpu::PipelineLayout; 2],
    solid: [wgpu::PipelineLayout; 2],
    modules: HashMap<&'static str, wgpu::ShaderModule>,
    made: HashMap<Key, wgpu::RenderPipeline>,
    generation: u64,
}

impl Pipelines {
    /// Compiles the library's shaders; pipelines are made when first asked for.
    ///
    /// # Errors
    /// A shader that does not compile.
    pub fn new(context: &Context, library: &Library) -> Result<Self, GpuError> {
        let device = &context.device;
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let uniform = |binding, size: usize, dynamic| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: both,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: dynamic,
                min_binding_size: std::num::NonZeroU64::new(size as u64),
            },
            count: None,
        };
        let storage = |binding, size: usize| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: both,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: std::num::NonZeroU64::new(size as u64),
            },
            count: None,
        };
        let sampled = |binding, sample_type| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled: false },
            count: None,
        };
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let frame_layout = layout(
            "frame",
            &[
                uniform(0, size_of::<Frame>(), true),
                storage(1, size_of::<Object>()),
                storage(2, size_of::<Light>()),
                storage(3, size_of::<Volume>()),
                uniform(4, size_of::<Draw>(), true),
                wgpu::BindGroupLayoutEntry {
                    binding: 5,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: true },
                        view_dimension: wgpu::TextureViewDimension::D2Array,
                        multisampled: false,
                    },
                    count: None,
                },
                wgpu::BindGroupLayoutEntry {
                    binding: 6,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                    count: None,
                },
            ],
        );
        let material_layout = layout(
            "material",
            &[
                uniform(0, size_of::<Material>(), false),
                sampled(1, wgpu::TextureSampleType::Float { filterable: true }),
                wgpu::BindGroupLayoutEntry {
                    binding: 2,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                    count: None,
                },
            ],
        );
        let targets_layout = layout(
            "scene targets",
            &[
                sampled(0, wgpu::TextureSampleType::Float { filterable: false }),
                sampled(1, wgpu::TextureSampleType::Uint),
                sampled(2, wgpu::TextureSampleType::Float { filterable: false }),
            ],
        );
        let labels_layout = layout("glyphs", &[sampled(0, wgpu::TextureSampleType::Float { filterable: false })]);
        let counts_layouts = [false, true].map(|multisampled| {
            let mut entry = sampled(0, wgpu::TextureSampleType::Float { filterable: false });
            if let wgpu::BindingType::Texture { multisampled: of_entry, .. } = &mut entry.ty {
                *of_entry = multisampled;
            }
            layout("counts", &[entry])
        });
        let solid_layouts = [false, true].map(|each| {
            let mut entries = [sampled(0, wgpu::TextureSampleType::Depth), sampled(1, wgpu::TextureSampleType::Uint)];
            for entry in &mut entries {
                if let wgpu::BindingType::Texture { multisampled, .. } = &mut entry.ty {
                    *multisampled = each;
                }
            }
            layout("solid", &entries)
        });
        let geometry_layout = layout(
            "geometry",
            &[
                sampled(0, wgpu::TextureSampleType::Depth),
                sampled(1, wgpu::TextureSampleType::Uint),
                sampled(2, wgpu::TextureSampleType::Float { filterable: false }),
                wgpu::BindGroupLayoutEntry {
                    binding: 3,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Storage { read_only: true },
                        has_dynamic_offset: false,
                        min_binding_size: None,
                    },
                    count: None,
                },
            ],
        );
        let reflection_layout = layout(
            "reflection",
            &[
                sampled(0, wgpu::TextureSampleType::Float { filterable: true }),
                wgpu::BindGroupLayoutEntry {
                    binding: 1,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                    count: None,
                },
            ],
        );
        let pipeline_layout = |label, groups: &[&wgpu::BindGroupLayout]| {
            let groups: Vec<_> = groups.iter().map(|&group| Some(group)).collect();
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &groups,
                immediate_size: 0,
            })
        };
        let modules = compile(context, library)?;
        Ok(Self {
            bare: pipeline_layout("bare", &[&frame_layout]),
            surface: pipeline_layout("surface", &[&frame_layout, &material_layout]),
            mirrored: pipeline_layout("mirrored", &[&frame_layout, &material_layout, &reflection_layout]),
            kept: pipeline_layout("kept", &[&frame_layout, &reflection_layout]),
            reflection_layout,
            picture: pipeline_layout("picture", &[&frame_layout, &targets_layout]),
            labels: pipeline_layout("labels", &[&frame_layout, &labels_layout]),
            labels_layout,
            geometry: pipeline_layout("geometry", &[&frame_layout, &geometry_layout]),
            geometry_layout,
            counts: counts_layouts.each_ref().map(|counts| pipeline_layout("counts", &[&frame_layout, counts])),
            counts_layouts,
            solid: solid_layouts.each_ref().map(|solid| pipeline_layout("solid", &[&frame_layout, solid])),
            solid_layouts,
            frame_layout,
            material_layout,
            targets_layout,
            modules,
            made: HashMap::new(),
            generation: 0,
        })
    }

    /// Takes the library's shaders anew. On an error the last good ones stay.
    ///
    /// # Errors
    /// A shader that does not compile, with file, line and column.
    pub fn reload(&mut self, context: &Context, library: &Library) -> Result<(), GpuError> {
        let scope = context.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let modules = match compile(context, library) {
            Ok(modules) => modules,
            Err(error) => {
                // Nothing reached the device.
                drop(scope);
                return Err(error);
            }
        };
        // A shader may be valid by itself and still not fit its pipeline: try all that are in use.
        let keys: Vec<_> = self.made.keys().copied().collect();
        let before = std::mem::replace(&mut self.modules, modules);
        let made: HashMap<_, _> = keys.into_iter().map(|key| (key, self.make(context, &key))).collect();
        match pollster::block_on(scope.pop()) {
            None => {
                self.made = made;
                self.generation += 1;
                Ok(())
            }
            Some(error) => {
                self.modules = before;
                let lines: Vec<_> = error.to_string().lines().map(|line| line.trim().to_owned()).collect();
                Err(GpuError::Shader(lines.join(" ")))
            }
        }
    }

    /// The module of a file of the library's.
    #[must_use]
    pub fn module(&self, file: &str) -> &wgpu::ShaderModule {
        &self.modules[file]
    }

    /// How often the shaders were taken anew.
    #[must_use]
    pub const fn generation(&self) -> u64 {
        self.generation
    }

    /// Makes the pipeline if it is not there yet.
    pub fn prepare(&mut self, context: &Context, key: &Key) {
        if !self.made.contains_key(key) {
            let pipeline = self.make(context, key);
            self.made.insert(*key, pipeline);
        }
    }

    /// A pipeline that was prepared.
    #[must_use]
    pub fn get(&self, key: &Key) -> Option<&wgpu::RenderPipeline> {
        self.made.get(key)
    }

    fn make(&self, context: &Context, key: &Key) -> wgpu::RenderPipeline {
        let entry = entry_of(key.program);
        let module = &self.modules[entry.file];
        let layout = match (entry.vertices, reads(key.program, key.target)) {
            (Vertices::Surface, _) if key.program == Program::Mirrored => &self.mirrored,
            (Vertices::Surface, _) => &self.surface,
            (Vertices::Labels, _) => &self.labels,
            (Vertices::Lines, _) => &self.bare,
            _ if key.program == Program::LayKept => &self.kept,
            (_, Reads::Targets) => &self.picture,
            (_, Reads::Counts) => &self.counts[0],
            (_, Reads::CountsEach) => &self.counts[1],
            (_, Reads::Solid) => &self.solid[0],
            (_, Reads::SolidEach) => &self.solid[1],
            (_, Reads::Geometry) => &self.geometry,
            (_, Reads::Nothing) => &self.bare,
        };
        let formats: &[_] = match key.target {
            Target::Solid => &[],
            Target::Scene => &[color_format(key.accumulation)],
            Target::Mean => &[MEAN_FORMAT],
            Target::Direct | Target::Shaded | Target::Output => &[key.output],
            Target::Counts => &[context.counts_format()],
            Target::Geometry => &[GEOMETRY_FORMAT],
            Target::Dark => &[DARK_FORMAT],
        };
        let color_target = |format: &wgpu::TextureFormat| {
            Some(wgpu::ColorTargetState {
                format: *format,
                blend: key.state.color.and_then(blend),
                write_mask: if key.state.color.is_some() { wgpu::ColorWrites::ALL } else { wgpu::ColorWrites::empty() },
            })
        };
        let targets: Vec<_> = formats.iter().map(color_target).collect();
        let constants = constants(entry.overrides, key);
        let compilation_options =
            || wgpu::PipelineCompilationOptions { constants: &constants, ..wgpu::PipelineCompilationOptions::default() };
        let in_scene = !matches!(key.target, Target::Mean | Target::Output);
        context.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(entry.fragment),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(entry.vertex),
                compilation_options: compilation_options(),
                buffers: vertex_buffers(entry.vertices),
            },
            primitive: wgpu::PrimitiveState {
                topology: if entry.vertices == Vertices::Edges {
                    wgpu::PrimitiveTopology::LineList
                } else {
                    wgpu::PrimitiveTopology::TriangleList
                },
                front_face: match key.state.winding {
                    Winding::Ccw => wgpu::FrontFace::Ccw,
                    Winding::Cw => wgpu::FrontFace::Cw,
                },
                cull_mode: match key.state.cull {
                    Cull::None => None,
                    Cull::Back => Some(wgpu::Face::Back),
                    Cull::Front => Some(wgpu::Face::Front),
                },
                unclipped_depth: key.state.near_plane == NearPlane::Clamp,
                ..Default::default()
            },
            depth_stencil: in_scene.then(|| depth_stencil(&key.state, context.depth_format())),
            multisample: wgpu::MultisampleState { count: if in_scene { key.samples } else { 1 }, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(entry.fragment),
                compilation_options: compilation_options(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The values of a program's overrides.
fn constants(overrides: &[Override], Key { look, state, .. }: &Key) -> Vec<(&'static str, f64)> {
    let kind = |light: LightShape| match light {
        LightShape::Point => 0.0,
        LightShape::Directional => 1.0,
        LightShape::Spot => 2.0,
        LightShape::Projector => 3.0,
    };
    const NO_LIGHT: f64 = 4.0;
    const NAMES: [&str; SHADED_TOGETHER] = ["LIGHT_0", "LIGHT_1", "LIGHT_2", "LIGHT_3"];
    let value = |it: Override| match it {
        Override::Textured => ("TEXTURED", f64::from(u8::from(look.textured))),
        Override::Glossy => ("GLOSSY", f64::from(u8::from(look.glossy))),
        Override::BothSides => ("BOTH_SIDES", f64::from(u8::from(state.cull == Cull::None || look.inside))),
        Override::LightKind => ("LIGHT_KIND", kind(look.light)),
        Override::EachKind(place) => (NAMES[place], look.shade.lights[place].map_or(NO_LIGHT, kind)),
        Override::Each => ("EACH", f64::from(u8::from(look.shade.each))),
        Override::Materials => ("MATERIALS", f64::from(u8::from(look.shade.materials))),
        Override::Bands => ("BANDS", f64::from(BANDS)),
        Override::Finished => ("FINISHED", f64::from(u8::from(look.finished))),
        Override::Clipped => ("CLIPPED", f64::from(u8::from(look.clipped))),
        Override::Mirror => {
            let mirror = match look.mirror {
                MirrorLook::None => 0.0,
                MirrorLook::Even => 1.0,
                MirrorLook::Fresnel => 2.0,
            };
            ("MIRROR", mirror)
        }
    };
    overrides.iter().map(|&it| value(it)).collect()
}

fn compile(context: &Context, library: &Library) -> Result<HashMap<&'static str, wgpu::ShaderModule>, GpuError> {
    let sources = library.load()?;
    let modules = sources.into_iter().map(|(file, source)| {
        let module = context.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(file),
            source: wgpu::ShaderSource::Wgsl(source.text.into()),
        });
        (file, module)
    });
    Ok(modules.collect())
}

fn vertex_buffers(vertices: Vertices) -> &'static [Option<wgpu::VertexBufferLayout<'static>>] {
    const POSITION: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
        array_stride: 12,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3],
    };
    const ATTRIBUTES: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
        array_stride: size_of::<Attributes>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![1 => Float32x3, 2 => Float32x2, 3 => Unorm8x4, 4 => Float32],
    };
    const VOLUME: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
        array_stride: 16,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x4],
    };
    const LABELS: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
        array_stride: size_of::<LabelVertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Float32x4],
    };
    const LINES: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
        array_stride: size_of::<LineVertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x4],
    };
    const OUTWARD: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
        array_stride: 12,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![1 => Float32x3],
    };
    match vertices {
        Vertices::Swollen => &[Some(POSITION), Some(OUTWARD)],
        Vertices::Lines => &[Some(LINES)],
        Vertices::Labels => &[Some(LABELS)],
        Vertices::None | Vertices::Bands => &[],
        Vertices::Surface => &[Some(POSITION), Some(ATTRIBUTES)],
        Vertices::Positions | Vertices::Edges => &[Some(POSITION)],
        Vertices::Volume => &[Some(VOLUME)],
    }
}

fn blend(blend: Blend) -> Option<wgpu::BlendState> {
    let one_and = |dst_factor| wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor,
        operation: wgpu::BlendOperation::Add,
    };
    let both = |component| Some(wgpu::BlendState { color: component, alpha: component });
    match blend {
        Blend::Replace => None,
        Blend::Add => both(one_and(wgpu::BlendFactor::One)),
        Blend::Multiply => both(wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::Dst,
            dst_factor: wgpu::BlendFactor::Zero,
            operation: wgpu::BlendOperation::Add,
        }),
        Blend::Over => both(one_and(wgpu::BlendFactor::OneMinusSrcAlpha)),
        Blend::Under => {
            both(wgpu::BlendComponent { src_factor: wgpu::BlendFactor::OneMinusDstAlpha, ..one_and(wgpu::BlendFactor::One) })
        }
    }
}

fn depth_stencil(state: &State, format: wgpu::TextureFormat) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(state.depth.write),
        depth_compare: Some(compare(state.depth.compare)),
        stencil: wgpu::StencilState {
            front: stencil_face(&state.stencil.front),
            back: stencil_face(&state.stencil.back),
            read_mask: state.stencil.read_mask.into(),
            write_mask: state.stencil.write_mask.into(),
        },
        bias: depth_bias(state.depth.bias),
    }
}

fn depth_bias(bias: DepthBias) -> wgpu::DepthBiasState {
    #[expect(clippy::cast_precision_loss, reason = "slopes are small whole numbers")]
    wgpu::DepthBiasState { constant: bias.constant, slope_scale: bias.slope as f32, clamp: 0.0 }
}

fn stencil_face(face: &StencilFace) -> wgpu::StencilFaceState {
    wgpu::StencilFaceState {
        compare: compare(face.compare),
        fail_op: stencil_op(face.fail),
        depth_fail_op: stencil_op(face.depth_fail),
        pass_op: stencil_op(face.pass),
    }
}

fn compare(compare: Compare) -> wgpu::CompareFunction {
    match compare {
        Compare::Never => wgpu::CompareFunction::Never,
        Compare::Always => wgpu::CompareFunction::Always,
        Compare::Equal => wgpu::CompareFunction::Equal,
        Compare::NotEqual => wgpu::CompareFunction::NotEqual,
        Compare::Less => wgpu::CompareFunction::Less,
        Compare::LessEqual => wgpu::CompareFunction::LessEqual,
        Compare::Greater => wgpu::CompareFunction::Greater,
        Compare::GreaterEqual => wgpu::CompareFunction::GreaterEqual,
    }
}

fn stencil_op(op: StencilOp) -> wgpu::StencilOperation {
    match op {
        StencilOp::Keep => wgpu::StencilOperation::Keep,
        StencilOp::IncrementWrap => wgpu::StencilOperation::IncrementWrap,
        StencilOp::DecrementWrap => wgpu::StencilOperation::DecrementWrap,
        StencilOp::IncrementClamp => wgpu::StencilOperation::IncrementClamp,
        StencilOp::DecrementClamp => wgpu::StencilOperation::DecrementClamp,
        StencilOp::Zero => wgpu::StencilOperation::Zero,
        StencilOp::Replace => wgpu::StencilOperation::Replace,
        StencilOp::Invert => wgpu::StencilOperation::Invert,
    }
}
