//! Small glTF files, written by the tests that read them, and the way to files that are not ours.
#![allow(dead_code, reason = "each test file uses its part of this")]

use std::path::{Path, PathBuf};

use base64::Engine as _;
use serde_json::{Value, json};

/// A file that is not part of the project; where it is not there, the test says so and passes.
pub fn shared(path: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let from_environment = std::env::var_os("OBSCURA_SHARED").map(PathBuf::from);
    let places = from_environment.into_iter().chain([root.join("../shared"), root.join("../../shared")]);
    let found = places.map(|place| place.join(path)).find(|path| path.exists());
    if found.is_none() {
        println!("skipped: {path} is not on this machine (OBSCURA_SHARED says where)");
    }
    found
}

/// A glTF file in the making.
#[derive(Clone)]
pub struct File {
    pub json: Value,
    pub binary: Vec<u8>,
}

impl File {
    /// Nothing but a version, and the first buffer.
    pub fn new() -> Self {
        let json = json!({"asset": {"version": "2.0"}, "bufferViews": [], "accessors": []});
        Self { json, binary: Vec::new() }
    }

    /// One triangle (0 0 0, 1 0 0, 0 1 0) without indices, in one mesh of one node of one scene.
    pub fn triangle() -> Self {
        let mut file = Self::new();
        let positions = file.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
        file.show(json!({"attributes": {"POSITION": positions}}));
        file
    }

    /// One mesh of this one primitive, in one node of one scene.
    pub fn show(&mut self, primitive: Value) {
        self.json["meshes"] = json!([{"primitives": [primitive]}]);
        self.json["nodes"] = json!([{"mesh": 0}]);
        self.json["scenes"] = json!([{"nodes": [0]}]);
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()});
        self.binary.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    pub fn push(&mut self, list: &str, element: Value) -> usize {
        if self.json.get(list).is_none() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().unwrap();
        list.push(element);
        list.len() - 1
    }

    pub fn accessor(&mut self, type_: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({"bufferView": view, "componentType": component, "count": count, "type": type_}))
    }

    pub fn floats(&mut self, type_: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(type_, 5126, values.len() / width(type_), &bytes)
    }

    pub fn shorts(&mut self, type_: &str, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(type_, 5123, values.len() / width(type_), &bytes)
    }

    /// With the buffer in the BIN chunk.
    pub fn glb(&self) -> Vec<u8> {
        self.glb_with(&[])
    }

    /// With more chunks at the end.
    pub fn glb_with(&self, more: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.binary.len()}]);
        let mut text = serde_json::to_vec(&json).unwrap();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = self.binary.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let mut body = Vec::new();
        for (kind, content) in [(b"JSON", &text[..]), (b"BIN\0", &binary[..])].iter().chain(more) {
            body.extend((content.len() as u32).to_le_bytes());
            body.extend_from_slice(*kind);
            body.extend_from_slice(content);
        }
        let mut file = b"glTF".to_vec();
        file.extend(2u32.to_le_bytes());
        file.extend((12 + body.len() as u32).to_le_bytes());
        file.extend(body);
        file
    }

    /// As text, with the buffer in a data URI.
    pub fn text(&self) -> Vec<u8> {
        self.text_with(&data_uri("application/octet-stream", &self.binary))
    }

    /// As text, with the buffer at this URI.
    pub fn text_with(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.binary.len(), "uri": uri}]);
        serde_json::to_vec_pretty(&json).unwrap()
    }
}

pub fn data_uri(mime: &str, bytes: &[u8]) -> String {
    format!("data:{mime};base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
}

pub fn png(width: u32, height: u32, color: [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(width, height, image::Rgba(color)).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn width(type_: &str) -> usize {
    match type_ {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        other => panic!("{other}"),
    }
}
