//! JSON text to glTF's schema, leniently where users' files need it and strictly where they lie.
//!
//! The text becomes a [`Value`] first. There, what the crate's schema would get wrong is put right:
//! an index of 2^32 wraps to 0 in it (an error here), `3.0` is not accepted as the integer glTF
//! says it is, a scene without `nodes` and an animation channel without a node are refused although
//! glTF allows them. Then every element of the top-level lists is deserialised by itself, so that
//! an error can name it.

use gltf::json::{self, Root};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::error::{Problem, Warnings, clip, one_line, part};

/// The extensions a file may require.
const KNOWN: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Values in the whole JSON, and elements in one top-level list: a file of `{},{},{}` would
/// otherwise unpack to hundreds of times its size.
const MOST_VALUES: usize = 3_000_000;
const MOST_ELEMENTS: usize = 1 << 18;

/// Where the schema holds an index, or a number that it cuts to 32 bits.
const INDEX_KEYS: &[&str] = &[
    "buffer",
    "bufferView",
    "camera",
    "children",
    "componentType",
    "index",
    "indices",
    "input",
    "joints",
    "light",
    "magFilter",
    "material",
    "mesh",
    "minFilter",
    "mode",
    "node",
    "nodes",
    "output",
    "sampler",
    "scene",
    "skeleton",
    "skin",
    "source",
    "target",
    "texCoord",
    "wrapS",
    "wrapT",
];

/// Reads the JSON of a file.
pub(super) fn parse(json: &[u8], warnings: &mut Warnings) -> Result<Root, Problem> {
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    if values(json) > MOST_VALUES {
        return Err(Problem::TooLarge { what: "its JSON is", limit: format!("{MOST_VALUES} values") });
    }
    let value: Value = serde_json::from_slice(json).map_err(|error| Problem::Json(one_line(&error.to_string())))?;
    let Value::Object(mut object) = value else {
        return Err(Problem::Json("the outermost value is not an object".into()));
    };
    version(&object)?;
    extensions(&object, warnings)?;
    for (key, value) in &mut object {
        normalise(key, value).map_err(|(path, what)| {
            let part = if path.is_empty() { key } else { &path };
            Problem::Part { part: one_line(&clip_long(part)), what }
        })?;
    }
    lenient(&mut object, warnings);

    let root = Root {
        accessors: list(&mut object, "accessors", "accessor")?,
        animations: list(&mut object, "animations", "animation")?,
        asset: single(&mut object, "asset")?.unwrap_or_default(),
        buffers: list(&mut object, "buffers", "buffer")?,
        buffer_views: list(&mut object, "bufferViews", "buffer view")?,
        scene: single(&mut object, "scene")?,
        extensions: single(&mut object, "extensions")?,
        extras: None,
        extensions_used: Vec::new(),
        extensions_required: Vec::new(),
        cameras: list(&mut object, "cameras", "camera")?,
        images: list(&mut object, "images", "image")?,
        materials: list(&mut object, "materials", "material")?,
        meshes: list(&mut object, "meshes", "mesh")?,
        nodes: list(&mut object, "nodes", "node")?,
        samplers: list(&mut object, "samplers", "sampler")?,
        scenes: list(&mut object, "scenes", "scene")?,
        skins: list(&mut object, "skins", "skin")?,
        textures: list(&mut object, "textures", "texture")?,
    };
    Ok(root)
}

/// At most this many values: commas and colons outside strings.
fn values(json: &[u8]) -> usize {
    let (mut count, mut in_string, mut escaped) = (1usize, false, false);
    for &byte in json {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            b',' | b':' | b'[' if !in_string => count += 1,
            _ => {}
        }
    }
    count
}

fn version(object: &Map<String, Value>) -> Result<(), Problem> {
    let Some(asset) = object.get("asset") else {
        return Err(Problem::Json("there is no `asset`, so this is not glTF".into()));
    };
    match asset.get("version") {
        Some(Value::String(version)) if version.starts_with("2.") => Ok(()),
        Some(Value::String(version)) => Err(Problem::Version(one_line(&clip(version)))),
        _ => Err(Problem::Json("`asset` has no `version`, so this is not glTF 2".into())),
    }
}

fn extensions(object: &Map<String, Value>, warnings: &mut Warnings) -> Result<(), Problem> {
    let names = |key: &str| -> Vec<String> {
        let listed = object.get(key).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let unknown = listed.iter().filter_map(Value::as_str).filter(|name| !KNOWN.contains(name));
        unknown.take(12).map(|name| one_line(&clip(name))).collect()
    };
    let required = names("extensionsRequired");
    if !required.is_empty() {
        return Err(Problem::Extensions(required.join(", ")));
    }
    let used = names("extensionsUsed");
    if !used.is_empty() {
        warnings.push(format!("what these extensions add is not shown: {}", used.join(", ")));
    }
    Ok(())
}

/// Whole numbers become integers, and indices past 32 bits errors (path and reason). `extras` are
/// the user's. Recursion is bounded by the JSON parser's own limit.
fn normalise(key: &str, value: &mut Value) -> Result<(), (String, String)> {
    if key == "extras" {
        return Ok(());
    }
    let below =
        |(path, what): (String, String), here: String| (if path.is_empty() { here } else { format!("{here}.{path}") }, what);
    match value {
        Value::Number(number) => {
            #[expect(clippy::cast_possible_truncation, reason = "whole and within 2^53, as just asked")]
            if let Some(whole) = number.as_f64().filter(|_| number.is_f64()).filter(|f| f.fract() == 0.0 && f.abs() < 9.0e15) {
                *number = (whole as i64).into();
            }
            let is_index = INDEX_KEYS.contains(&key);
            match number.as_u64() {
                Some(index) if is_index && index > u64::from(u32::MAX) => {
                    Err((String::new(), format!("{index} is too large a number here")))
                }
                _ => Ok(()),
            }
        }
        Value::Array(elements) => {
            // Elements are what the list is: `children` holds indices.
            for (index, element) in elements.iter_mut().enumerate() {
                normalise(key, element).map_err(|error| below(error, format!("{}[{index}]", clip(key))))?;
            }
            Ok(())
        }
        Value::Object(fields) => {
            // Attribute names are free, their values are all indices.
            let attributes = key == "attributes" || key == "targets";
            for (name, field) in fields {
                let as_key = if attributes && field.is_number() { "index" } else { name };
                let in_list = field.is_array();
                normalise(as_key, field).map_err(|error| if in_list { error } else { below(error, clip(name)) })?;
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Supplies what glTF lets a file leave out and the schema does not.
fn lenient(object: &mut Map<String, Value>, warnings: &mut Warnings) {
    for scene in elements(object, "scenes") {
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    for (index, animation) in elements(object, "animations").enumerate() {
        let Some(Value::Array(channels)) = animation.get_mut("channels") else { continue };
        let before = channels.len();
        channels.retain(|channel| {
            let target = channel.get("target").and_then(Value::as_object);
            target.is_none_or(|target| target.contains_key("node") && target.get("path") != Some(&"pointer".into()))
        });
        if channels.len() < before {
            let name = animation.get("name").and_then(Value::as_str);
            let left_out = part("animation", index, name);
            warnings.push(format!("{left_out}: channels that move no node are left out"));
        }
    }
    // An older way to say base colour; its highlights are not shown anyway.
    for material in elements(object, "materials").filter(|material| !material.contains_key("pbrMetallicRoughness")) {
        let Some(old) = material.get("extensions").and_then(|all| all.get("KHR_materials_pbrSpecularGlossiness")) else {
            continue;
        };
        let mut base = Map::new();
        for (from, to) in [("diffuseFactor", "baseColorFactor"), ("diffuseTexture", "baseColorTexture")] {
            if let Some(value) = old.get(from) {
                base.insert(to.into(), value.clone());
            }
        }
        base.insert("metallicFactor".into(), 0.into());
        material.insert("pbrMetallicRoughness".into(), Value::Object(base));
    }
}

fn elements<'a>(object: &'a mut Map<String, Value>, key: &str) -> impl Iterator<Item = &'a mut Map<String, Value>> {
    object.get_mut(key).and_then(Value::as_array_mut).into_iter().flatten().filter_map(Value::as_object_mut)
}

fn single<T: DeserializeOwned>(object: &mut Map<String, Value>, key: &str) -> Result<Option<T>, Problem> {
    let Some(value) = object.remove(key) else { return Ok(None) };
    json::deserialize::from_value(value).map_err(|error| schema(key.to_owned(), &error))
}

fn list<T: DeserializeOwned>(object: &mut Map<String, Value>, key: &str, kind: &str) -> Result<Vec<T>, Problem> {
    let Some(value) = object.remove(key) else { return Ok(Vec::new()) };
    let Value::Array(elements) = value else {
        return Err(Problem::Part { part: key.to_owned(), what: "is not a list".into() });
    };
    if elements.len() > MOST_ELEMENTS {
        return Err(Problem::TooLarge { what: "one of its lists is", limit: format!("{MOST_ELEMENTS} elements") });
    }
    let read = |(index, element): (usize, Value)| {
        let name = element.get("name").and_then(Value::as_str).map(str::to_owned);
        json::deserialize::from_value(element).map_err(|error| schema(part(kind, index, name.as_deref()), &error))
    };
    elements.into_iter().enumerate().map(read).collect()
}

fn schema(part: String, error: &json::Error) -> Problem {
    Problem::Part { part, what: clip_long(&one_line(&error.to_string())) }
}

/// Messages quote the file, which may be long.
fn clip_long(text: &str) -> String {
    if text.chars().count() <= 200 { text.to_owned() } else { text.chars().take(200).chain("...".chars()).collect() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    fn error(json: &str) -> String {
        parse(json.as_bytes(), &mut Warnings::default()).unwrap_err().to_string()
    }

    #[test]
    fn an_index_of_two_to_the_32_does_not_wrap() {
        let text = error(r#"{"asset":{"version":"2.0"},"meshes":[{"primitives":[{"attributes":{"POSITION":4294967296}}]}]}"#);
        assert_eq!(text, "meshes[0].primitives[0].attributes.POSITION: 4294967296 is too large a number here");
        let text = error(r#"{"asset":{"version":"2.0"},"nodes":[{"children":[1, 4294967296.0]}]}"#);
        assert_eq!(text, "nodes[0].children[1]: 4294967296 is too large a number here");
    }

    #[test]
    fn whole_numbers_written_as_fractions_are_integers_as_gltf_says() {
        let root =
            parse(br#"{"asset":{"version":"2.0"},"scene":0.0,"nodes":[{"mesh":1e0}],"scenes":[{}]}"#, &mut Warnings::default());
        let root = root.unwrap();
        assert_eq!(root.scene.unwrap().value(), 0);
        assert_eq!(root.nodes[0].mesh.unwrap().value(), 1);
        assert!(root.scenes[0].nodes.is_empty());
    }

    #[test]
    fn errors_name_the_part() {
        assert_eq!(
            error(r#"{"asset":{"version":"2.0"},"meshes":[{"primitives":[]},{"name":"Fox","primitives":7}]}"#),
            "mesh 1 \"Fox\": invalid type: integer `7`, expected a sequence"
        );
        assert_eq!(error(r#"{"asset":{"version":"1.0"}}"#), "is glTF 1.0; only version 2 can be read");
        assert_eq!(
            error(r#"{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression","KHR_mesh_quantization"]}"#),
            "needs glTF extensions that this program does not have: KHR_draco_mesh_compression"
        );
    }
}
