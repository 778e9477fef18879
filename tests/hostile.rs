//! Files that are broken, by accident or on purpose: each gets one line that names the file and the part,
//! and none a panic. [`load`] and [`load_bytes`] have no net below them, so a panic in them fails these
//! tests; the net itself is [`obscura::scene::open`]'s.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails may panic")]

mod gltf_files;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use gltf_files::{File, data_uri, png, shared};
use obscura::scene::gltf::{add_floor, load, load_bytes};
use obscura::scene::pose::pose;
use obscura::scene::{AnimationChoice, OpenError, Scene, doctor, open};
use obscura::settings::SceneChoice;
use proptest::prelude::*;
use serde_json::{Value, json};

/// The error, checked to be one line that starts with the file's name.
fn told(name: &str, result: Result<Scene, impl std::fmt::Display>) -> String {
    let text = result.err().unwrap_or_else(|| panic!("{name} was imported")).to_string();
    assert_eq!(text.lines().count(), 1, "{text}");
    let rest = text.strip_prefix(name).and_then(|rest| rest.strip_prefix(": "));
    rest.unwrap_or_else(|| panic!("`{text}` does not name {name}")).to_owned()
}

fn error(file: &File) -> String {
    told("test", load_bytes("test", &file.glb()))
}

fn raw(text: &[u8]) -> String {
    told("test", load_bytes("test", text))
}

fn at(path: &Path) -> String {
    told(&path.display().to_string(), load(path))
}

/// What the program does with a scene once it has one; nothing of that may fail either.
fn used(mut scene: Scene) {
    add_floor(&mut scene);
    assert!(!doctor::report(&scene).to_string().is_empty());
    for time in [0.0, 0.3, 1e9] {
        let posed = pose(&scene, time, AnimationChoice::All, &BTreeMap::new());
        assert_eq!(posed.world_from_node.len(), scene.nodes.len());
    }
}

/// A file with a bit of everything, small enough to be broken in every place.
fn everything() -> File {
    let mut file = File::triangle();
    let normals = file.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let uvs = file.floats("VEC2", &[0., 0., 1., 0., 0., 1.]);
    let joints = file.shorts("VEC4", &[0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0]);
    let weights = file.floats("VEC4", &[0.5, 0.5, 0., 0., 0.5, 0.5, 0., 0., 1., 0., 0., 0.]);
    let moved = file.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let indices = file.shorts("SCALAR", &[0, 1, 2]);
    let bind = file.floats("MAT4", &[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.].repeat(2));
    let times = file.floats("SCALAR", &[0., 1.]);
    let places = file.floats("VEC3", &[0., 0., 0., 1., 0., 0.]);
    let morphs = file.floats("SCALAR", &[0., 1.]);
    let image = file.view(&png(2, 2, [200, 100, 50, 255]));
    let sparse_indices = file.view(&[1, 0, 0, 0]);
    let sparse_values = file.view(&[0; 12]);
    file.json["accessors"][moved]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": sparse_indices, "componentType": 5121},
        "values": {"bufferView": sparse_values},
    });
    file.show(json!({
        "attributes": {"POSITION": 0, "NORMAL": normals, "TEXCOORD_0": uvs, "JOINTS_0": joints, "WEIGHTS_0": weights},
        "targets": [{"POSITION": moved}],
        "indices": indices,
        "material": 0,
    }));
    file.json["materials"] =
        json!([{"name": "m", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": "MASK"}]);
    file.json["textures"] = json!([{"source": 0, "sampler": 0}]);
    file.json["samplers"] = json!([{"wrapS": 33071}]);
    file.json["images"] = json!([{"bufferView": image, "mimeType": "image/png"}]);
    file.json["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": bind}]);
    file.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}]);
    file.json["extensions"] =
        json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"innerConeAngle": 0.2}, "intensity": 5}]}});
    file.json["nodes"] = json!([
        {"name": "a", "mesh": 0, "skin": 0, "weights": [0.5]},
        {"name": "b", "children": [2], "translation": [0, 1, 0]},
        {"name": "c", "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
        {"name": "d", "camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]},
        {"name": "e", "extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 9]},
    ]);
    file.json["scenes"] = json!([{"nodes": [0, 1, 3, 4]}]);
    file.json["animations"] = json!([{
        "channels": [
            {"sampler": 0, "target": {"node": 1, "path": "translation"}},
            {"sampler": 1, "target": {"node": 0, "path": "weights"}},
        ],
        "samplers": [{"input": times, "output": places}, {"input": times, "output": morphs}],
    }]);
    file
}

#[test]
fn the_file_that_is_broken_below_is_whole() {
    let scene = load_bytes("test", &everything().glb()).unwrap();
    assert_eq!((scene.warnings.len(), scene.animations[0].channels.len(), scene.textures.len()), (0, 2, 1));
}

#[test]
fn the_shared_ones() {
    let Some(folder) = shared("models/hostile") else { return };
    for (file, expected) in [
        ("IndexOutOfRange.gltf", "mesh 0 \"Mesh\", primitive 0: index "),
        ("MissingBin.gltf", "buffer 0: its file `BoxTextured0.bin` cannot be read: "),
        ("NoScene.gltf", "nothing to draw: there are no nodes"),
        ("badArray.gltf", "mesh 0 \"Mesh\": invalid type: map, expected a sequence"),
        ("badNumber.gltf", "material 0 \"Texture\": "),
    ] {
        let text = at(&folder.join(file));
        assert!(text.starts_with(expected), "{file}: {text}");
    }
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        at(&path);
        let opened = open(&SceneChoice::File(path.clone()), true);
        assert!(!matches!(opened, Err(OpenError::Panicked(_))), "{path:?}");
    }
}

#[test]
fn every_prefix_of_a_file() {
    for whole in [everything().glb(), everything().text()] {
        for length in 0..whole.len() {
            raw(&whole[..length]);
        }
    }
}

#[test]
fn every_single_bit_of_the_small_file() {
    for whole in [File::triangle().glb(), File::triangle().text()] {
        for bit in 0..whole.len() * 8 {
            let mut broken = whole.clone();
            broken[bit / 8] ^= 1 << (bit % 8);
            if let Err(error) = load_bytes("test", &broken) {
                assert_eq!(error.to_string().lines().count(), 1, "bit {bit}: {error}");
            }
        }
    }
}

/// Every place in the JSON where something stands, as JSON pointers.
fn places(value: &Value, here: &str, found: &mut Vec<String>) {
    found.push(here.to_owned());
    match value {
        Value::Array(elements) => {
            elements.iter().enumerate().for_each(|(index, element)| places(element, &format!("{here}/{index}"), found));
        }
        Value::Object(fields) => fields.iter().for_each(|(name, field)| places(field, &format!("{here}/{name}"), found)),
        _ => {}
    }
}

#[test]
fn every_value_replaced_by_every_bad_one() {
    let whole = everything();
    let mut all = Vec::new();
    places(&whole.json, "", &mut all);
    let bad = [
        json!(null),
        json!(-1),
        json!(0),
        json!(1),
        json!(3),
        json!(0.5),
        json!(1e39),
        json!(-1e300),
        json!(255),
        json!(4_294_967_295u64),
        json!(4_294_967_296u64),
        json!(1u64 << 40),
        json!(u64::MAX),
        json!(i64::MIN),
        json!("\n"),
        json!("../x"),
        json!([]),
        json!([0, 0, 0, 0]),
        json!({}),
        json!(true),
    ];
    let mut imported = 0;
    for place in all.iter().skip(1) {
        for bad in &bad {
            let mut broken = whole.clone();
            *broken.json.pointer_mut(place).unwrap() = bad.clone();
            match load_bytes("test", &broken.glb()) {
                Ok(scene) => {
                    used(scene);
                    imported += 1;
                }
                Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{place} = {bad}: {error}"),
            }
        }
    }
    assert!(imported > 0, "some of these are harmless");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn bytes_changed_anywhere(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12), glb: bool) {
        let mut bytes = if glb { everything().glb() } else { everything().text() };
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        let _ = load_bytes("test", &bytes).map(used);
    }

    #[test]
    fn numbers_changed_anywhere(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u64>(), 0u32..64), 1..6)) {
        let mut file = everything();
        let mut all = Vec::new();
        places(&file.json, "", &mut all);
        for (place, number, shift) in changes {
            let numbers: Vec<_> = all.iter().filter(|place| file.json.pointer(place).is_some_and(Value::is_number)).collect();
            let place = numbers[place.index(numbers.len())].clone();
            *file.json.pointer_mut(&place).unwrap() = json!(number >> shift);
        }
        let _ = load_bytes("test", &file.glb()).map(used);
    }

    #[test]
    fn vertex_data_of_any_bytes(bytes in prop::collection::vec(any::<u8>(), 64..400)) {
        let mut file = everything();
        let length = bytes.len().min(file.binary.len());
        file.binary[..length].copy_from_slice(&bytes[..length]);
        let _ = load_bytes("test", &file.glb()).map(used);
    }

    #[test]
    fn no_bytes_at_all_are_trusted(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        prop_assert!(load_bytes("test", &bytes).is_err());
    }
}

#[test]
fn huge_counts_are_refused_before_anything_is_allocated() {
    let started = Instant::now();
    for count in [1u64 << 33, 1 << 40, u64::MAX, u64::MAX / 12, 1 << 62] {
        let mut file = File::triangle();
        file.json["accessors"][0]["count"] = json!(count);
        let text = error(&file);
        assert!(text.starts_with("mesh 0, primitive 0, POSITION, accessor 0: "), "{text}");
        file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        assert!(error(&file).ends_with("are more than the file's memory budget allows"));

        let mut file = everything();
        file.json["accessors"][5]["sparse"]["count"] = json!(count);
        let text = error(&file);
        assert!(text.contains("morph target 0, POSITION, accessor 5: replaces"), "{text}");
    }
    // Zeros that fit the budget alone, but not many times.
    let mut file = File::triangle();
    file.json["accessors"] = (0..40).map(|_| json!({"componentType": 5126, "count": 30_000_000, "type": "VEC3"})).collect();
    file.json["meshes"][0]["primitives"] = (0..40).map(|accessor| json!({"attributes": {"POSITION": accessor}})).collect();
    assert!(error(&file).contains("MiB") || error(&file).contains("budget"));
    assert!(started.elapsed().as_secs() < 60, "{:?}", started.elapsed());
}

#[test]
fn offsets_strides_and_ends() {
    let with = |list: &str, key: &str, value: Value| {
        let mut file = File::triangle();
        file.json[list][0][key] = value;
        error(&file)
    };
    let start = "mesh 0, primitive 0, POSITION, accessor 0: ";
    let view = "buffer view 0 ends at byte";
    assert_eq!(
        with("bufferViews", "byteStride", json!(4)),
        format!("{start}the stride of 4 bytes in buffer view 0 is smaller than an element of 12 bytes")
    );
    assert_eq!(
        with("bufferViews", "byteStride", json!(16)),
        format!("{start}its 3 elements end at byte 44, past the 36 bytes of buffer view 0")
    );
    assert_eq!(
        with("accessors", "byteOffset", json!(u64::MAX)),
        format!("{start}its 3 elements end at byte 18446744073709551615, past the 36 bytes of buffer view 0")
    );
    assert_eq!(with("bufferViews", "byteOffset", json!(1)), format!("{start}{view} 37, past the 36 bytes of buffer 0"));
    assert!(with("bufferViews", "byteLength", json!(u64::MAX)).starts_with(&format!("{start}{view} 18446744073709551615")));
    assert_eq!(with("bufferViews", "buffer", json!(9)), format!("{start}buffer 9 does not exist"));
    assert_eq!(with("accessors", "bufferView", json!(9)), format!("{start}buffer view 9 does not exist"));
    assert_eq!(with("accessors", "componentType", json!(5124)), format!("{start}its type is not one of glTF's"));
    assert_eq!(with("accessors", "type", json!("VEC2")), format!("{start}is VEC2 of FLOAT; VEC3 was expected here"));
    let mut file = File::triangle();
    file.show(json!({"attributes": {"POSITION": 7}}));
    assert_eq!(error(&file), "mesh 0, primitive 0, POSITION, accessor 7: does not exist; the file has 1");
    let text = String::from_utf8(File::triangle().text()).unwrap().replace("\"byteLength\": 36", "\"byteLength\": 99");
    assert_eq!(raw(text.as_bytes()), "buffer 0: has 36 bytes where the file says 99");
    let mut json = File::triangle().json;
    json["buffers"] = json!([{"byteLength": 36}]);
    assert_eq!(raw(&serde_json::to_vec(&json).unwrap()), format!("{start}buffer 0 has no data"));
}

#[test]
fn coordinates_that_are_no_numbers() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut file = File::new();
        let positions = file.floats("VEC3", &[0., 0., 0., 1., bad, 0., 0., 1., 0.]);
        file.show(json!({"attributes": {"POSITION": positions}}));
        file.json["meshes"][0]["name"] = json!("Fox");
        let text = error(&file);
        assert_eq!(text, "mesh 0 \"Fox\", primitive 0, POSITION, accessor 0: element 1 holds a number that is not finite");
    }
    let node = |node: Value| {
        let mut file = File::triangle();
        file.json["nodes"] = json!([node]);
        error(&file)
    };
    assert_eq!(node(json!({"mesh": 0, "translation": [0, 1e39, 0]})), "node 0: its translation is not finite");
    let far = "what it shows lies farther than 1e12 m from the origin";
    assert_eq!(node(json!({"mesh": 0, "name": "far", "translation": [0, 1e30, 0]})), format!("node \"far\": {far}"));
    let mut file = File::triangle();
    file.json["nodes"] = json!([{"children": [1], "scale": [1e30, 1e30, 1e30]}, {"mesh": 0, "scale": [1e30, 1e30, 1e30]}]);
    assert_eq!(error(&file), format!("node \"node 1\": {far}"));
}

#[test]
fn indices_joints_and_lengths_out_of_range() {
    let change = |change: &dyn Fn(&mut File)| {
        let mut file = everything();
        change(&mut file);
        error(&file)
    };
    let bad_index = |file: &mut File| {
        let bad = file.shorts("SCALAR", &[0, 1, 3]);
        file.json["meshes"][0]["primitives"][0]["indices"] = json!(bad);
    };
    assert_eq!(change(&bad_index), "mesh 0, primitive 0: index 2 is 3, but there are 3 vertices");
    let float_index = |file: &mut File| file.json["meshes"][0]["primitives"][0]["indices"] = json!(8);
    let text = change(&float_index);
    assert_eq!(
        text,
        "mesh 0, primitive 0, indices, accessor 8: is SCALAR of FLOAT; SCALAR of unsigned integers was expected here"
    );
    let few_joints = |file: &mut File| file.json["skins"][0]["joints"] = json!([1]);
    assert_eq!(change(&few_joints), "node 0 \"a\": mesh \"mesh 0\" needs joint 1, but the skin has 1");
    let no_joint = |file: &mut File| file.json["skins"][0]["joints"] = json!([1, 99]);
    assert_eq!(change(&no_joint), "skin 0: its joint, node 99, does not exist");
    let no_joints = |file: &mut File| file.json["skins"][0]["joints"] = json!([]);
    assert_eq!(change(&no_joints), "skin 0: 0 joints; 1 to 65536 are possible");
    let wide_joints = |file: &mut File| {
        let wide = file.accessor("VEC4", 5125, 3, &[0; 48]);
        file.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(wide);
    };
    assert!(change(&wide_joints).contains("is VEC4 of UNSIGNED_INT; VEC4 of UNSIGNED_BYTE or UNSIGNED_SHORT"));
    let short = |attribute: &'static str, type_: &'static str, count: usize| {
        move |file: &mut File| {
            let short = file.floats(type_, &vec![0.5; count]);
            file.json["meshes"][0]["primitives"][0]["attributes"][attribute] = json!(short);
        }
    };
    for (attribute, type_, count) in
        [("NORMAL", "VEC3", 6), ("TEXCOORD_0", "VEC2", 4), ("WEIGHTS_0", "VEC4", 8), ("COLOR_0", "VEC3", 6)]
    {
        let text = change(&short(attribute, type_, count));
        assert!(text.contains(attribute) && text.ends_with("has 2 elements where 3 are needed"), "{text}");
    }
    let short_target = |file: &mut File| file.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = json!(9);
    assert!(change(&short_target).ends_with("morph target 0, POSITION, accessor 9: has 2 elements where 3 are needed"));
    let no_material = |file: &mut File| file.json["meshes"][0]["primitives"][0]["material"] = json!(1);
    assert_eq!(change(&no_material), "mesh 0, primitive 0: material 1 does not exist; the file has 1");
    let no_texture = |file: &mut File| file.json["textures"] = json!([]);
    assert_eq!(change(&no_texture), "material 0 \"m\": texture 0 does not exist; the file has 0");
    let no_mesh = |file: &mut File| file.json["nodes"][0]["mesh"] = json!(5);
    assert!(change(&no_mesh).starts_with("nothing to draw") || change(&no_mesh).contains("mesh 5 does not exist"));
    let no_skin = |file: &mut File| file.json["nodes"][0]["skin"] = json!(5);
    assert_eq!(change(&no_skin), "node 0 \"a\": skin 5 does not exist; the file has 1");
    let no_light = |file: &mut File| file.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([]);
    assert_eq!(change(&no_light), "node 4 \"e\": light 0 does not exist; the file has 0");
    let no_camera = |file: &mut File| file.json["cameras"] = json!([]);
    assert_eq!(change(&no_camera), "node 3 \"d\": camera 0 does not exist; the file has 0");
    let no_node = |file: &mut File| file.json["animations"][0]["channels"][0]["target"]["node"] = json!(50);
    assert_eq!(change(&no_node), "animation 0, channel 0: node 50 does not exist; the file has 5");
    let no_sampler = |file: &mut File| file.json["animations"][0]["channels"][0]["sampler"] = json!(2);
    assert_eq!(change(&no_sampler), "animation 0, channel 0: sampler 2 does not exist; there are 2");
    let few_values = |file: &mut File| file.json["animations"][0]["samplers"][1]["output"] = json!(8);
    assert!(
        load_bytes(
            "test",
            &{
                let mut f = everything();
                few_values(&mut f);
                f
            }
            .glb()
        )
        .is_ok(),
        "as many as there are keys"
    );
    let spline = |file: &mut File| file.json["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE");
    assert_eq!(change(&spline), "animation 0, channel 0, output, accessor 9: has 2 elements where 6 are needed");
    let no_scene_node = |file: &mut File| file.json["scenes"][0]["nodes"] = json!([77]);
    assert_eq!(change(&no_scene_node), "scene: node 77 does not exist; the file has 5");
}

#[test]
fn hierarchies_that_are_none() {
    let nodes = |nodes: Value, roots: Value| {
        let mut file = File::triangle();
        (file.json["nodes"], file.json["scenes"]) = (nodes, json!([{"nodes": roots}]));
        error(&file)
    };
    assert_eq!(nodes(json!([{"mesh": 0, "children": [0]}]), json!([0])), "node 0: each is a child of another in a circle");
    let circle = json!([{"mesh": 0}, {"name": "a", "children": [2]}, {"name": "b", "children": [3]}, {"children": [1]}]);
    assert_eq!(
        nodes(circle, json!([0])),
        "node 1 \"a\", node 2 \"b\", node 3: each is a child of another in a circle",
        "also where the scene does not reach"
    );
    let both = json!([{"name": "a", "children": [2]}, {"name": "b", "children": [2]}, {"mesh": 0}]);
    assert_eq!(nodes(both, json!([0, 1])), "node 2: is a child of both node 0 \"a\" and node 1 \"b\"");
    assert_eq!(nodes(json!([{"children": [1, 1]}, {"mesh": 0}]), json!([0])), "node 1: is twice a child of node 0");
    assert_eq!(nodes(json!([{"children": [4]}]), json!([0])), "node 0: its child 4 does not exist; the file has 1 nodes");

    // Deep is no fault: ten thousand generations, and no recursion to overflow.
    let mut file = File::triangle();
    let depth = 10_000;
    file.json["nodes"] =
        (0..depth).map(|i| if i + 1 < depth { json!({"children": [i + 1]}) } else { json!({"mesh": 0}) }).collect();
    assert_eq!(load_bytes("test", &file.glb()).unwrap().instances().next().unwrap().0, depth - 1);
}

#[test]
fn uris_that_lead_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let outside = folder.path().join("outside.bin");
    let inside = folder.path().join("inside");
    std::fs::create_dir_all(inside.join("folder")).unwrap();
    let file = File::triangle();
    std::fs::write(&outside, &file.binary).unwrap();
    let path = inside.join("test.gltf");
    let with = |uri: &str| {
        std::fs::write(&path, file.text_with(uri)).unwrap();
        at(&path)
    };
    for uri in
        ["../outside.bin", "%2e%2e/outside.bin", "x/../../outside.bin", "..\\outside.bin", "/dev/zero", "%2Fdev%2Fzero", ""]
    {
        assert_eq!(with(uri), format!("buffer 0: its URI `{uri}` leads out of the file's folder"));
    }
    for uri in ["file:///dev/zero", "https://example.org/x.bin", "C:\\x.bin"] {
        assert!(with(uri).ends_with("is not a file beside this one: only relative paths and data: are read"));
    }
    assert_eq!(with("%ff.bin"), "buffer 0: its URI `%ff.bin` is not UTF-8 once decoded");
    assert_eq!(with("%00"), "buffer 0: its URI `%00` leads out of the file's folder");
    assert!(with("folder").ends_with("cannot be read: it is a folder, not a regular file"));
    assert!(with("%zz.bin").starts_with("buffer 0: its file `%zz.bin` cannot be read: "), "a bad escape is part of the name");
    assert!(with("data:;base64,%%%").contains("base64"));
    assert_eq!(with("data:;base64,AAAA"), "buffer 0: has 3 bytes where the file says 36");
    let long = with(&"x".repeat(10_000));
    assert!(long.len() < 300, "{long}");
    let in_memory = load_bytes("test", &file.text_with("outside.bin"));
    assert!(told("test", in_memory).ends_with("needs a file, but this model is in memory"));
}

#[cfg(unix)]
#[test]
fn only_regular_files_below_the_folder_are_opened() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("inside");
    std::fs::create_dir(&inside).unwrap();
    let file = File::triangle();
    std::fs::write(folder.path().join("outside.bin"), &file.binary).unwrap();
    std::fs::write(inside.join("real.bin"), &file.binary).unwrap();
    symlink("../outside.bin", inside.join("leaves.bin")).unwrap();
    symlink("/dev/zero", inside.join("zero.bin")).unwrap();
    symlink("real.bin", inside.join("stays.bin")).unwrap();
    symlink("loop.bin", inside.join("loop.bin")).unwrap();
    let pipe = inside.join("pipe.bin");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let path = inside.join("test.gltf");
    let write = |uri: &str| std::fs::write(&path, file.text_with(uri)).unwrap();

    write("stays.bin");
    load(&path).unwrap();
    for uri in ["leaves.bin", "zero.bin"] {
        write(uri);
        assert_eq!(at(&path), format!("buffer 0: its file `{uri}` is a link out of the file's folder"));
    }
    write("loop.bin");
    assert!(at(&path).starts_with("buffer 0: its file `loop.bin` cannot be read: "));
    write("pipe.bin");
    assert!(at(&path).ends_with("it is a pipe, a socket or a device, not a regular file"));

    // The file itself.
    let not_regular = "cannot be read: it is a pipe, a socket or a device, not a regular file";
    assert_eq!(at(&pipe), not_regular);
    assert_eq!(at(Path::new("/dev/zero")), not_regular);
    assert_eq!(at(&inside), "cannot be read: it is a folder, not a regular file");
    let link = folder.path().join("link.gltf");
    write("real.bin");
    symlink(&path, &link).unwrap();
    load(&link).expect("a link to the file itself is the user's choice");
}

#[test]
fn files_that_are_something_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two\nlines.gltf");
    let name = path.display().to_string().replace('\n', "\\n");
    std::fs::write(&path, "").unwrap();
    assert_eq!(told(&name, load(&path)), "is empty");
    std::fs::write(&path, "v 0 0 0\nf 1 2 3\n").unwrap();
    assert_eq!(told(&name, load(&path)), "is neither a GLB nor a glTF file: it starts with neither `glTF` nor `{`");
    assert!(at(&folder.path().join("missing.glb")).starts_with("cannot be read: "));
    let sparse_file = folder.path().join("huge.glb");
    std::fs::File::create(&sparse_file).unwrap().set_len(1 << 40).unwrap();
    assert_eq!(at(&sparse_file), "the file is too large: the limit is 512 MiB");
    assert!(raw(b"glTF\x01\0\0\0\x14\0\0\0\0\0\0\0\0\0\0\0").contains("only version 2 can be read"));
    assert!(raw(b"[1]").starts_with("is neither"));
    assert!(raw(b"{}").contains("this is not glTF"));
    assert_eq!(raw(br#"{"asset":{"version":"1.0"}}"#), "is glTF 1.0; only version 2 can be read");
}

#[test]
fn json_that_is_deep_or_wide() {
    let deep = format!(r#"{{"asset":{{"version":"2.0"}},"extras":{}{}}}"#, "[".repeat(100_000), "]".repeat(100_000));
    assert!(raw(deep.as_bytes()).starts_with("damaged JSON: recursion limit exceeded"));
    let wide = format!(r#"{{"asset":{{"version":"2.0"}},"nodes":[{}{{}}]}}"#, "{},".repeat(1_000_000));
    assert_eq!(raw(wide.as_bytes()), "one of its lists is too large: the limit is 262144 elements");
    let wider = format!(r#"{{"asset":{{"version":"2.0"}},"extras":[{}0]}}"#, "0,".repeat(4_000_000));
    assert_eq!(raw(wider.as_bytes()), "its JSON is too large: the limit is 3000000 values");
    let many_targets = json!(vec![json!({}); 100_000]);
    let mut file = File::triangle();
    file.show(json!({"attributes": {"POSITION": 0}, "targets": many_targets}));
    assert_eq!(error(&file), "mesh 0: 100000 morph targets; the limit is 4096");
}

#[test]
fn extensions_that_are_required_and_not_there() {
    let mut file = File::triangle();
    file.json["extensionsRequired"] =
        json!(["KHR_lights_punctual", "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu", "A\nB"]);
    assert_eq!(
        error(&file),
        "needs glTF extensions that this program does not have: \
         KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_texture_basisu, A\\nB"
    );
}

#[test]
fn image_bombs_become_checkers() {
    // A PNG that says it is 60000 x 60000, one that is 8192 x 8192 of zeros in 16 bits, one cut off, and no image.
    let mut huge = png(1, 1, [0; 4]);
    huge[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
    let mut cut = png(64, 64, [9; 4]);
    cut.truncate(50);
    let mut deep = std::io::Cursor::new(Vec::new());
    image::ImageBuffer::<image::Rgba<u16>, _>::from_raw(8192, 8192, vec![0u16; 8192 * 8192 * 4])
        .unwrap()
        .write_to(&mut deep, image::ImageFormat::Png)
        .unwrap();
    let bombs = [huge, deep.into_inner(), cut, b"GIF89a".to_vec(), Vec::new()];
    let mut file = File::triangle();
    file.json["images"] = bombs.iter().map(|bytes| json!({"uri": data_uri("image/png", bytes)})).collect();
    file.json["images"].as_array_mut().unwrap().extend([json!({"bufferView": 99}), json!({})]);
    file.json["textures"] = (0..7).map(|image| json!({"source": image})).collect();
    file.json["materials"] =
        (0..7).map(|texture| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}})).collect();
    file.json["meshes"][0]["primitives"] =
        (0..7).map(|material| json!({"attributes": {"POSITION": 0}, "material": material})).collect();
    let scene = load_bytes("test", &file.glb()).unwrap();
    assert!(scene.textures.iter().all(|texture| (texture.width, texture.height, texture.rgba.len()) == (16, 16, 1024)));
    assert_eq!((scene.textures.len(), scene.warnings.len()), (7, 7), "{:?}", scene.warnings);
    let told: Vec<_> = scene.warnings.iter().map(|warning| warning.split(':').next().unwrap()).collect();
    assert_eq!(told, ["image 0", "image 1", "image 2", "image 3", "image 4", "image 5", "image 6"]);
}

#[test]
fn many_images_share_one_budget() {
    let large = data_uri("image/png", &png(8192, 8192, [1; 4]));
    let mut file = File::triangle();
    file.json["images"] = (0..5).map(|_| json!({"uri": large})).collect();
    file.json["textures"] = (0..5).map(|image| json!({"source": image})).collect();
    file.json["materials"] =
        (0..5).map(|texture| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}})).collect();
    file.json["meshes"][0]["primitives"] =
        (0..5).map(|material| json!({"attributes": {"POSITION": 0}, "material": material})).collect();
    let scene = load_bytes("test", &file.glb()).unwrap();
    assert_eq!(scene.textures.iter().filter(|texture| texture.width == 8192).count(), 3);
    assert_eq!(scene.warnings.len(), 2);
    assert!(scene.warnings[0].contains("more than 768 MiB"), "{:?}", scene.warnings);
}
