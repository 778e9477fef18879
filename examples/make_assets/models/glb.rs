//! Writes glTF 2.0 binary files: a JSON chunk and one buffer.

use glam::{DMat4, DQuat, DVec3};
use serde_json::{Map, Value, json};

use super::soup::Shape;

/// A file in the making. Indices returned are glTF's own.
#[derive(Default)]
pub struct Glb {
    lists: Map<String, Value>,
    bytes: Vec<u8>,
}

/// What a surface looks like; linear colour.
#[derive(Clone)]
pub struct Look<'a> {
    pub name: &'a str,
    pub color: [f64; 3],
    pub roughness: f64,
    pub metallic: f64,
    pub emissive: [f64; 3],
    pub double_sided: bool,
    pub texture: Option<usize>,
}

impl Default for Look<'_> {
    fn default() -> Self {
        Self {
            name: "plain",
            color: [0.8; 3],
            roughness: 0.9,
            metallic: 0.0,
            emissive: [0.0; 3],
            double_sided: false,
            texture: None,
        }
    }
}

/// Joints and weights of each vertex of a skinned shape.
pub type Binding = ([u8; 4], [f32; 4]);

const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const FLOAT: u32 = 5126;

impl Glb {
    fn push(&mut self, list: &str, value: Value) -> usize {
        let entry = self.lists.entry(list).or_insert_with(|| Value::Array(Vec::new()));
        entry.as_array_mut().map_or(0, |array| {
            array.push(value);
            array.len() - 1
        })
    }

    fn view(&mut self, data: &[u8], target: Option<u32>) -> usize {
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        let mut view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": data.len()});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend(data);
        self.push("bufferViews", view)
    }

    fn floats<const N: usize>(&mut self, kind: &str, values: &[[f32; N]], bounds: bool, target: Option<u32>) -> usize {
        let data: Vec<u8> = values.iter().flatten().flat_map(|v| (v + 0.0).to_le_bytes()).collect();
        let view = self.view(&data, target);
        let mut accessor = json!({"bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind});
        if bounds {
            let fold = |start: f32, f: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N).map(|i| values.iter().fold(start, |m, v| f(m, v[i])) + 0.0).collect()
            };
            accessor["min"] = json!(fold(f32::INFINITY, f32::min));
            accessor["max"] = json!(fold(f32::NEG_INFINITY, f32::max));
        }
        self.push("accessors", accessor)
    }

    /// An embedded picture that repeats.
    pub fn texture(&mut self, name: &str, png: &[u8]) -> usize {
        let view = self.view(png, None);
        let image = self.push("images", json!({"name": name, "bufferView": view, "mimeType": "image/png"}));
        if !self.lists.contains_key("samplers") {
            self.push("samplers", json!({"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}));
        }
        self.push("textures", json!({"source": image, "sampler": 0}))
    }

    pub fn material(&mut self, look: &Look) -> usize {
        let [r, g, b] = look.color;
        let mut surface =
            json!({"baseColorFactor": [r, g, b, 1.0], "roughnessFactor": look.roughness, "metallicFactor": look.metallic});
        if let Some(texture) = look.texture {
            surface["baseColorTexture"] = json!({"index": texture});
        }
        let mut material = json!({"name": look.name, "pbrMetallicRoughness": surface});
        if look.double_sided {
            material["doubleSided"] = json!(true);
        }
        if look.emissive != [0.0; 3] {
            material["emissiveFactor"] = json!(look.emissive);
        }
        self.push("materials", material)
    }

    /// One mesh of several shapes, each with its material, and where it is skinned each with its
    /// bindings; texture coordinates and colours only where a shape has some.
    pub fn mesh(&mut self, name: &str, parts: &[(Shape, usize)], bindings: &[&[Binding]]) -> usize {
        let mut primitives = Vec::new();
        for (i, (shape, material)) in parts.iter().enumerate() {
            let target = Some(ARRAY_BUFFER);
            let positions: Vec<_> = shape.positions.iter().map(|p| p.as_vec3().to_array()).collect();
            let normals: Vec<_> = shape.normals.iter().map(|n| n.as_vec3().to_array()).collect();
            let mut attributes = json!({
                "POSITION": self.floats("VEC3", &positions, true, target),
                "NORMAL": self.floats("VEC3", &normals, false, target),
            });
            if self.lists["materials"][*material]["pbrMetallicRoughness"].get("baseColorTexture").is_some() {
                let uvs: Vec<_> = shape.uvs.iter().map(|uv| uv.as_vec2().to_array()).collect();
                attributes["TEXCOORD_0"] = json!(self.floats("VEC2", &uvs, false, target));
            }
            if shape.colors.iter().any(|c| *c != [255; 3]) {
                let data: Vec<u8> = shape.colors.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
                let view = self.view(&data, target);
                let accessor = json!({"bufferView": view, "componentType": UNSIGNED_BYTE, "normalized": true, "count": shape.colors.len(), "type": "VEC4"});
                attributes["COLOR_0"] = json!(self.push("accessors", accessor));
            }
            if let Some(binding) = bindings.get(i) {
                let joints: Vec<u8> = binding.iter().flat_map(|b| b.0).collect();
                let view = self.view(&joints, target);
                let accessor =
                    json!({"bufferView": view, "componentType": UNSIGNED_BYTE, "count": binding.len(), "type": "VEC4"});
                attributes["JOINTS_0"] = json!(self.push("accessors", accessor));
                let weights: Vec<_> = binding.iter().map(|b| b.1).collect();
                attributes["WEIGHTS_0"] = json!(self.floats("VEC4", &weights, false, target));
            }
            let (data, component): (Vec<u8>, u32) = if shape.positions.len() < 65535 {
                (shape.indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect(), UNSIGNED_SHORT)
            } else {
                (shape.indices.iter().flat_map(|&i| i.to_le_bytes()).collect(), UNSIGNED_SHORT + 2)
            };
            let view = self.view(&data, Some(ELEMENT_ARRAY_BUFFER));
            let indices = self.push(
                "accessors",
                json!({"bufferView": view, "componentType": component, "count": shape.indices.len(), "type": "SCALAR"}),
            );
            primitives.push(json!({"attributes": attributes, "indices": indices, "material": material}));
        }
        self.push("meshes", json!({"name": name, "primitives": primitives}))
    }

    /// Any node; `value` is glTF's own JSON.
    pub fn node(&mut self, value: Value) -> usize {
        self.push("nodes", value)
    }

    /// A node at the origin that shows a mesh.
    pub fn show(&mut self, name: &str, parts: &[(Shape, usize)]) -> usize {
        let mesh = self.mesh(name, parts, &[]);
        self.node(json!({"name": name, "mesh": mesh}))
    }

    /// As [`Self::show`], for what casts no shadow.
    pub fn show_without_shadow(&mut self, name: &str, parts: &[(Shape, usize)]) -> usize {
        let mesh = self.mesh(name, parts, &[]);
        self.node(json!({"name": name, "mesh": mesh, "extras": {"casts_shadow": false}}))
    }

    pub fn skin(&mut self, joints: &[usize], inverse_bind: &[DMat4]) -> usize {
        let matrices: Vec<_> = inverse_bind.iter().map(|m| m.as_mat4().to_cols_array()).collect();
        let accessor = self.floats("MAT4", &matrices, false, None);
        self.push("skins", json!({"joints": joints, "inverseBindMatrices": accessor}))
    }

    /// One animation: rotations of some nodes and translations of others, at common times.
    pub fn animation(
        &mut self,
        name: &str,
        times: &[f32],
        rotations: &[(usize, Vec<DQuat>)],
        translations: &[(usize, Vec<DVec3>)],
    ) {
        let times: Vec<_> = times.iter().map(|&t| [t]).collect();
        let input = self.floats("SCALAR", &times, true, None);
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        let mut channel = |node: usize, path: &str, output: usize| {
            channels.push(json!({"sampler": samplers.len(), "target": {"node": node, "path": path}}));
            samplers.push(json!({"input": input, "output": output, "interpolation": "LINEAR"}));
        };
        for (node, keys) in rotations {
            let keys: Vec<_> = keys.iter().map(|q| q.as_quat().to_array()).collect();
            channel(*node, "rotation", self.floats("VEC4", &keys, false, None));
        }
        for (node, keys) in translations {
            let keys: Vec<_> = keys.iter().map(|t| t.as_vec3().to_array()).collect();
            channel(*node, "translation", self.floats("VEC3", &keys, false, None));
        }
        self.push("animations", json!({"name": name, "samplers": samplers, "channels": channels}));
    }

    /// The file's bytes; nodes that are no node's child are the scene.
    pub fn finish(mut self) -> Vec<u8> {
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        let empty = Vec::new();
        let nodes = self.lists.get("nodes").and_then(Value::as_array).unwrap_or(&empty);
        let children: Vec<u64> =
            nodes.iter().filter_map(|n| n["children"].as_array()).flatten().filter_map(Value::as_u64).collect();
        let roots: Vec<u64> = (0..nodes.len() as u64).filter(|n| !children.contains(n)).collect();
        self.lists.insert("scenes".into(), json!([{"nodes": roots}]));
        self.lists.insert("scene".into(), json!(0));
        self.lists.insert(
            "asset".into(),
            json!({"version": "2.0", "generator": "obscura make_assets", "copyright": "the Obscura project, MIT or Apache-2.0"}),
        );
        self.lists.insert("buffers".into(), json!([{"byteLength": self.bytes.len()}]));
        let mut text = Value::Object(self.lists).to_string().into_bytes();
        while !text.len().is_multiple_of(4) {
            text.push(b' ');
        }
        let total = 12 + 8 + text.len() + 8 + self.bytes.len();
        let mut file = Vec::with_capacity(total);
        let chunk = |file: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]| {
            file.extend((data.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(data);
        };
        file.extend(b"glTF");
        file.extend(2u32.to_le_bytes());
        file.extend((total as u32).to_le_bytes());
        chunk(&mut file, b"JSON", &text);
        chunk(&mut file, b"BIN\0", &self.bytes);
        file
    }
}
