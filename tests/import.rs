//! What is imported: from files that others made, and from small ones written here.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails may panic")]

mod gltf_files;

use std::collections::BTreeMap;

use glam::{DVec3, Vec2, Vec3};
use gltf_files::{File, data_uri, png, shared};
use obscura::geometry::Aabb;
use obscura::scene::gltf::{add_floor, load, load_bytes};
use obscura::scene::pose::pose;
use obscura::scene::{AlphaMode, AnimationChoice, Extent, Interpolation, LightKind, Property, Scene, Transform, Wrap, doctor};
use serde_json::{Value, json};

fn shared_scene(path: &str) -> Option<Scene> {
    Some(load(&shared(path)?).unwrap())
}

fn import(file: &File) -> Scene {
    let from_glb = load_bytes("test", &file.glb()).unwrap();
    let from_text = load_bytes("test", &file.text()).unwrap();
    assert_eq!(format!("{from_glb:?}"), format!("{from_text:?}"), "the container does not matter");
    from_glb
}

fn error(file: &File) -> String {
    load_bytes("test", &file.glb()).unwrap_err().to_string()
}

fn triangles(scene: &Scene) -> usize {
    scene.instances().map(|(_, _, mesh)| mesh.indices.len() / 3).sum()
}

fn bounds(scene: &Scene) -> Aabb {
    scene.bounds(&pose(scene, 0.0, scene.default_animation, &BTreeMap::new()))
}

/// The corners of a mesh's triangles.
fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    let mesh = &scene.meshes[0];
    mesh.indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(|index| mesh.positions[index as usize])).collect()
}

/// The camera sees the middle of the scene in the middle of the picture.
fn looks_at_the_scene(scene: &Scene) {
    let posed = pose(scene, 0.0, scene.default_animation, &BTreeMap::new());
    let camera = &scene.cameras[0];
    let world_from_node = posed.world_from_node[camera.node];
    let focus = world_from_node.transform_point3(DVec3::NEG_Z * camera.focus_distance);
    let bounds = scene.bounds(&posed);
    let radius = f64::from(bounds.radius());
    assert!(focus.distance(bounds.center().as_dvec3()) < 1e-3 * radius, "{focus} is not {}", bounds.center());
    for corner in bounds.corners() {
        let seen = world_from_node.inverse().transform_point3(corner);
        assert!(seen.y.abs() < -seen.z * (0.5 * camera.vertical_fov).tan(), "{corner} is out of view");
        assert!(-seen.z > camera.near);
    }
}

#[test]
fn fox() {
    let Some(scene) = shared_scene("models/Fox.glb") else { return };
    assert_eq!((scene.name.as_str(), triangles(&scene)), ("Fox", 576));
    assert_eq!((scene.skins.len(), scene.skins[0].joints.len()), (1, 24));
    let names: Vec<_> = scene.animations.iter().map(|animation| animation.name.as_str()).collect();
    assert_eq!(names, ["Survey", "Walk", "Run"]);
    assert!((scene.animations[1].duration - 0.708_333).abs() < 1e-4);
    assert_eq!(scene.default_animation, AnimationChoice::One(0));
    assert!(scene.meshes[0].flat, "it has no normals");
    assert!(scene.meshes[0].skin.iter().all(|bound| (bound.weights.iter().sum::<f32>() - 1.0).abs() < 1e-5));
    assert_eq!((scene.textures.len(), scene.materials[0].base_color_texture), (1, Some(0)));
    assert_eq!(scene.warnings, [""; 0]);
    for (index, node) in scene.nodes.iter().enumerate() {
        assert!(node.parent.is_none_or(|parent| parent < index));
    }
    looks_at_the_scene(&scene);
    let report = doctor::report(&scene);
    assert_eq!((report.triangles, report.skins, report.meshes[0].skinned), (576, 1, true));
    assert_eq!(
        report.meshes[0].closed,
        report.meshes[0].topology.border_edges + report.meshes[0].topology.non_manifold_edges == 0
    );
}

#[test]
fn cornell_box() {
    let Some(scene) = shared_scene("models/CornellBox.glb") else { return };
    assert_eq!((scene.meshes.len(), triangles(&scene), scene.materials.len()), (4, 2 + 12 + 12 + 10, 5));
    let room = scene.meshes.iter().find(|mesh| mesh.name == "cornell_box").unwrap();
    let runs: Vec<_> = room.primitives.iter().map(|run| (run.first_index, run.index_count, run.material)).collect();
    assert_eq!(runs, [(0, 18, 2), (18, 6, 3), (24, 6, 4)]);
    assert_eq!(scene.materials[0].emissive, Vec3::splat(100.0));
    assert!(scene.materials.iter().all(|material| material.double_sided));
    // It has neither lights nor cameras. The panel in the ceiling shines, and one looks in from the front.
    let posed = pose(&scene, 0.0, scene.default_animation, &BTreeMap::new());
    assert_eq!((scene.lights.len(), scene.lights[0].name.as_str()), (1, "Light"));
    let panel = scene.nodes.iter().find(|node| node.mesh.is_some() && node.name == "Light").unwrap();
    assert!(!panel.casts_shadow);
    let below = panel.local.affine().translation - posed.lights[0].position;
    assert!(below.x.abs() < 1.0 && below.z.abs() < 1.0 && (1.0..20.0).contains(&below.y), "{below}");
    let area = 130.0 * 105.0;
    assert!((scene.lights[0].intensity / (100.0 * area) - 1.0).abs() < 0.01, "radiance times area");
    looks_at_the_scene(&scene);
    let eye = posed.world_from_node[scene.cameras[0].node].translation;
    assert!((eye.x - f64::from(bounds(&scene).center().x)).abs() < 1.0 && eye.z > 500.0, "{eye}");
}

#[test]
fn animated_morph_cube() {
    let Some(scene) = shared_scene("models/AnimatedMorphCube.gltf") else { return };
    let mesh = &scene.meshes[0];
    assert_eq!((mesh.name.as_str(), triangles(&scene), mesh.positions.len()), ("Cube", 12, 24));
    assert_eq!((mesh.morphs.len(), mesh.morph_weights.as_slice()), (2, &[0.0, 0.0][..]));
    assert!(mesh.morphs.iter().all(|morph| morph.positions.len() == 24 && morph.normals.len() == 24));
    let channel = &scene.animations[0].channels[0];
    assert_eq!((scene.animations[0].name.as_str(), channel.property, channel.times.len()), ("Square", Property::Weights, 127));
    let still = bounds(&scene).half_size();
    let later = scene.bounds(&pose(&scene, 1.5, scene.default_animation, &BTreeMap::new())).half_size();
    assert!((still - later).length() > 0.1, "{still} {later}");
    assert_eq!(doctor::report(&scene).meshes[0].volume, "closed: one side per silhouette edge");
}

#[test]
fn simple_skin() {
    let Some(scene) = shared_scene("models/SimpleSkin.gltf") else { return };
    assert_eq!((triangles(&scene), scene.skins[0].joints.len(), scene.skins[0].joints.clone()), (8, 2, vec![1, 2]));
    assert_eq!(scene.skins[0].inverse_bind[0].translation, DVec3::new(-0.5, -1.0, 0.0));
    assert_eq!((scene.nodes[2].parent, scene.nodes[1].parent, scene.nodes[0].skin), (Some(1), Some(0), Some(0)));
    assert_eq!(doctor::report(&scene).meshes[0].volume, "open or not manifold: every triangle counts, turned to face the light");
}

#[test]
fn box_textured() {
    let Some(scene) = shared_scene("models/BoxTextured.gltf") else { return };
    assert_eq!(triangles(&scene), 12);
    assert_eq!((scene.textures[0].width, scene.textures[0].height, scene.textures[0].wrap), (211, 211, [Wrap::Repeat; 2]));
    assert_eq!(scene.textures[0].rgba.len(), 211 * 211 * 4);
    assert!(matches!(scene.nodes[0].local, Transform::Affine(_)));
    assert_eq!(bounds(&scene).half_size(), Vec3::splat(0.5));
    looks_at_the_scene(&scene);
}

#[test]
fn the_peers_scenes() {
    for (name, instances, total, lights) in [
        ("s1_cubes", 76, 200 + 75 * 12, 1),
        ("s2_knots", 10, 200 + 9 * 6_000, 1),
        ("s3_dense", 2, 200 + 200_000, 1),
        ("s4_lights", 76, 200 + 75 * 12, 4),
        ("s5_inside", 77, 200 + 76 * 12, 1),
    ] {
        let Some(scene) = shared_scene(&format!("scenes/{name}.glb")) else { return };
        assert_eq!((scene.instances().count(), triangles(&scene), scene.lights.len()), (instances, total, lights), "{name}");
        let floors: Vec<_> = scene.instances().filter(|(_, node, _)| !node.casts_shadow).collect();
        assert_eq!((floors.len(), floors[0].2.name.as_str()), (1, "floor"), "{name}");
        assert_eq!((scene.cameras.len(), scene.cameras[0].name.as_str()), (1, "camera"), "{name}");
        // Their lights are made so that exposure 1 is right.
        assert!((0.7..1.5).contains(&scene.exposure), "{name}: {}", scene.exposure);
        assert_eq!(scene.warnings, [""; 0], "{name}");
        let report = doctor::report(&scene);
        assert!(report.meshes.iter().all(|mesh| mesh.closed == (mesh.name != "floor")), "{name}");
        assert_eq!(report.meshes[0].volume, "none: it casts no shadow", "{name}");
    }
}

#[test]
fn strips_and_fans_keep_their_winding() {
    let zigzag = [0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0., 0., 2., 0.];
    let mut file = File::new();
    let positions = file.floats("VEC3", &zigzag);
    file.show(json!({"attributes": {"POSITION": positions}, "mode": 5}));
    let strip = import(&file);
    assert_eq!(triangles(&strip), 3);
    assert!(strip.meshes[0].normals.iter().all(|normal| *normal == Vec3::Z), "all three face the same way");

    // Indexed, with a stitch of degenerate triangles, which go.
    let indices = file.shorts("SCALAR", &[0, 1, 2, 2, 2, 3]);
    file.show(json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": 5}));
    assert_eq!(triangles(&import(&file)), 1);

    let mut file = File::new();
    let positions = file.floats("VEC3", &[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    file.show(json!({"attributes": {"POSITION": positions}, "mode": 6}));
    let fan = import(&file);
    assert_eq!(corners(&fan), [[Vec3::X, Vec3::new(1., 1., 0.), Vec3::ZERO], [Vec3::new(1., 1., 0.), Vec3::Y, Vec3::ZERO]]);
}

#[test]
fn points_and_lines_are_left_out_with_a_warning() {
    let mut file = File::triangle();
    file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(json!({"attributes": {"POSITION": 0}, "mode": 1}));
    let scene = import(&file);
    assert_eq!((triangles(&scene), scene.meshes[0].primitives.len()), (1, 1));
    assert_eq!(scene.warnings, ["mesh 0, primitive 1: points and lines are not drawn"]);
    file.show(json!({"attributes": {"POSITION": 0}, "mode": 0}));
    assert_eq!(error(&file), "test: nothing to draw: the scene's nodes show no triangles");
}

#[test]
fn sparse_accessors_replace_elements_of_a_view_or_of_zeros() {
    let mut file = File::triangle();
    let indices = file.view(&[2, 0, 0, 0]);
    let values = file.view(&[5f32, 6., 7.].iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>());
    let sparse = json!({"count": 1, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    file.json["accessors"][0]["sparse"] = sparse;
    assert_eq!(corners(&import(&file)), [[Vec3::ZERO, Vec3::X, Vec3::new(5., 6., 7.)]]);
    file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(corners(&import(&file)), [[Vec3::ZERO, Vec3::ZERO, Vec3::new(5., 6., 7.)]]);
}

#[test]
fn an_accessor_without_a_view_is_zeros() {
    let mut file = File::triangle();
    let uvs = file.push("accessors", json!({"componentType": 5126, "count": 3, "type": "VEC2"}));
    file.show(json!({"attributes": {"POSITION": 0, "TEXCOORD_0": uvs}}));
    assert_eq!(import(&file).meshes[0].uvs, [Vec2::ZERO; 3]);
}

#[test]
fn quantized_meshes() {
    let mut file = File::new();
    let bytes: Vec<u8> = [0i16, 0, 0, 0, 100, 0, 0, 0, 0, -100, 0, 0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let positions = file.accessor("VEC3", 5122, 3, &bytes);
    file.json["bufferViews"][0]["byteStride"] = json!(8);
    let normals = file.accessor("VEC3", 5120, 3, &[0, 0, 127, 0, 129, 0, 0, 0, 0, 0, 127, 0]);
    file.json["bufferViews"][1]["byteStride"] = json!(4);
    file.json["accessors"][normals]["normalized"] = json!(true);
    let uvs = file.shorts("VEC2", &[0, 0, 65535, 0, 0, 32768]);
    file.json["accessors"][uvs]["normalized"] = json!(true);
    let colors = file.accessor("VEC4", 5121, 3, &[255, 0, 0, 255, 0, 128, 0, 255, 0, 0, 255, 64]);
    file.json["accessors"][colors]["normalized"] = json!(true);
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    file.show(json!({"attributes": {"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs, "COLOR_0": colors}}));
    let scene = import(&file);
    let mesh = &scene.meshes[0];
    assert_eq!(corners(&scene), [[Vec3::ZERO, Vec3::X * 100.0, Vec3::Y * -100.0]]);
    assert_eq!(mesh.normals, [Vec3::Z, Vec3::NEG_X, Vec3::Z]);
    assert_eq!((mesh.uvs[1], mesh.uvs[2].y > 0.5), (Vec2::X, true));
    assert_eq!(mesh.colors, [[255, 0, 0, 255], [0, 128, 0, 255], [0, 0, 255, 64]]);
}

#[test]
fn buffers_beside_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = File::triangle();
    std::fs::create_dir(folder.path().join("my data")).unwrap();
    std::fs::write(folder.path().join("my data/größe 100%.bin"), &file.binary).unwrap();
    let path = folder.path().join("test.gltf");
    for uri in ["my%20data/gr%C3%B6%C3%9Fe%20100%25.bin", "my data/größe 100%.bin", "./x/../my%20data\\größe%20100%25.bin"] {
        std::fs::write(&path, file.text_with(uri)).unwrap();
        assert_eq!(triangles(&load(&path).unwrap()), 1, "{uri}");
    }
    let scene = load(&path).unwrap();
    assert_eq!(scene.name, "test");
}

#[test]
fn unknown_chunks_are_skipped() {
    let file = File::triangle().glb_with(&[(b"EXTR", b"????"), (b"BIN\0", b"not the first")]);
    assert_eq!(triangles(&load_bytes("test", &file).unwrap()), 1);
}

#[test]
fn of_several_scenes_the_default_one() {
    let mut file = File::triangle();
    file.json["nodes"] = json!([{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0, "children": [2]}, {"name": "c"}]);
    file.json["scenes"] = json!([{"nodes": [0]}, {"name": "second", "nodes": [1]}, {}]);
    let names = |file: &File| import(file).nodes.iter().take(2).map(|node| node.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&file)[0], "a");
    file.json["scene"] = json!(1);
    assert_eq!(names(&file), ["b", "c"]);
    assert_eq!(import(&file).warnings, ["the file has 3 scenes; scene 1 \"second\" is shown"]);
    file.json["scene"] = json!(2);
    assert_eq!(error(&file), "test: nothing to draw: there are no nodes in the scene");
    file.json["scene"] = json!(3);
    assert_eq!(error(&file), "test: default scene: scene 3 does not exist; the file has 3");
    file.json.as_object_mut().unwrap().remove("scenes");
    assert_eq!(import(&file).instances().count(), 2, "without scenes, all nodes");
}

#[test]
fn parents_come_before_children_whatever_the_file_says() {
    let mut file = File::triangle();
    file.json["nodes"] = json!([
        {"name": "leaf", "mesh": 0, "translation": [0, 0, 1]},
        {"name": "middle", "children": [0], "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 5, 0, 1]},
        {"name": "top", "children": [1], "rotation": [0, 0, 0, 3]},
    ]);
    file.json["scenes"] = json!([{"nodes": [2]}]);
    let scene = import(&file);
    let order: Vec<_> = scene.nodes.iter().take(3).map(|node| (node.name.as_str(), node.parent)).collect();
    assert_eq!(order, [("top", None), ("middle", Some(0)), ("leaf", Some(1))]);
    assert_eq!(bounds(&scene).min, Vec3::new(0.0, 5.0, 2.0));
}

#[test]
fn extras_say_what_gltf_has_no_word_for() {
    let mut file = File::triangle();
    file.json["nodes"] = json!([
        {"mesh": 0, "extras": {"casts_shadow": false, "other": [1, {"deep": 5e99}]}},
        {"mesh": 0, "extras": {"casts_shadow": "no"}},
        {"mesh": 0, "extras": 7},
    ]);
    file.json["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    let scene = import(&file);
    assert_eq!(scene.nodes.iter().take(3).map(|node| node.casts_shadow).collect::<Vec<_>>(), [false, true, true]);
}

#[test]
fn materials_and_what_their_alpha_means() {
    let mut file = File::triangle();
    file.json["materials"] = json!([
        {"alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true},
        {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 7, -1, 0.5], "metallicFactor": 0.25, "roughnessFactor": 0.75}},
        {"alphaMode": "MASK", "emissiveFactor": [1, 0.5, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}},
        {"extensions": {"KHR_materials_unlit": {}}},
        {"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.1, 0.2, 0.3, 1]}}},
    ]);
    file.json["meshes"][0]["primitives"] =
        json!([{"attributes": {"POSITION": 0}, "material": 1}, {"attributes": {"POSITION": 0}, "material": 0}]);
    let scene = import(&file);
    let alpha: Vec<_> = scene.materials.iter().map(|material| material.alpha).collect();
    let opaque = AlphaMode::Opaque;
    assert_eq!(alpha, [AlphaMode::Mask(0.25), AlphaMode::Blend, AlphaMode::Mask(0.5), opaque, opaque]);
    assert_eq!(scene.materials[1].base_color.to_array(), [0.5, 1.0, 0.0, 0.5]);
    assert_eq!((scene.materials[1].metallic, scene.materials[1].roughness), (0.25, 0.75));
    assert_eq!(scene.materials[2].emissive, Vec3::new(4.0, 2.0, 0.0));
    assert_eq!((scene.materials[0].double_sided, scene.materials[3].unlit), (true, true));
    assert_eq!(scene.materials[4].base_color.to_array(), [0.1, 0.2, 0.3, 1.0]);
    let casts: Vec<_> = scene.meshes[0].primitives.iter().map(|primitive| primitive.casts_shadow).collect();
    assert_eq!(casts, [false, true], "light passes blended surfaces");
    assert_eq!(scene.meshes[0].topology.triangles().len(), 1);
}

#[test]
fn images_from_views_uris_and_files() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = File::triangle();
    std::fs::write(folder.path().join("green.png"), png(2, 1, [0, 255, 0, 255])).unwrap();
    let view = file.view(&png(3, 1, [255, 0, 0, 128]));
    let uvs = file.floats("VEC2", &[0., 0., 1., 0., 0., 1.]);
    file.json["images"] = json!([
        {"bufferView": view, "name": "red"}, // no mimeType
        {"uri": "green.png"},
        {"uri": data_uri("image/png", &png(1, 1, [0, 0, 255, 255]))},
        {"uri": "missing.png"},
    ]);
    file.json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}]);
    file.json["textures"] =
        json!([{"source": 0, "sampler": 0}, {"source": 1}, {"source": 2}, {"source": 3}, {}, {"source": 0, "sampler": 0}]);
    let material = |texture: usize| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}});
    file.json["materials"] = (0..6).map(material).collect();
    file.json["meshes"][0]["primitives"] =
        (0..6).map(|material| json!({"attributes": {"POSITION": 0, "TEXCOORD_0": uvs}, "material": material})).collect();
    let path = folder.path().join("test.gltf");
    std::fs::write(&path, file.text()).unwrap();
    let scene = load(&path).unwrap();
    let sizes: Vec<_> = scene.textures.iter().map(|texture| (texture.width, texture.height)).collect();
    assert_eq!(sizes, [(3, 1), (2, 1), (1, 1), (16, 16), (16, 16)]);
    assert_eq!(scene.textures[0].rgba, [255, 0, 0, 128].repeat(3));
    assert_eq!((scene.textures[0].wrap, scene.textures[0].nearest), ([Wrap::Clamp, Wrap::Mirror], true));
    assert_eq!(scene.materials[5].base_color_texture, Some(0), "the same image with the same sampling is one texture");
    assert_eq!(scene.warnings.len(), 2);
    assert!(scene.warnings[0].starts_with("image 3: its file `missing.png` cannot be read: "), "{}", scene.warnings[0]);
    assert_eq!(scene.warnings[1], "texture 4: it has no image that can be shown; a checker stands in for it");
}

#[test]
fn texture_coordinates_as_the_material_says() {
    let mut file = File::triangle();
    let uvs = file.floats("VEC2", &[0., 0., 1., 0., 0., 1.]);
    file.json["images"] = json!([{"uri": data_uri("image/png", &png(1, 1, [9; 4]))}]);
    file.json["textures"] = json!([{"source": 0}]);
    let transform = json!({"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 4]}});
    file.json["materials"] =
        json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1, "extensions": transform}}}]);
    file.show(json!({"attributes": {"POSITION": 0, "TEXCOORD_1": uvs}, "material": 0}));
    assert_eq!(import(&file).meshes[0].uvs, [Vec2::new(0.5, 0.25), Vec2::new(2.5, 0.25), Vec2::new(0.5, 4.25)]);
}

#[test]
fn primitives_with_and_without_normals_are_one_mesh() {
    let mut file = File::triangle();
    let normals = file.floats("VEC3", &[0., 0., 1., 0., 1., 0., f32::NAN, 0., 0.]);
    let indices = file.shorts("SCALAR", &[0, 1, 2, 2, 1, 0]);
    file.json["meshes"][0]["primitives"] = json!([
        {"attributes": {"POSITION": 0, "NORMAL": normals}},
        {"attributes": {"POSITION": 0}, "indices": indices},
    ]);
    let scene = import(&file);
    let mesh = &scene.meshes[0];
    assert_eq!((mesh.positions.len(), mesh.flat), (3 + 6, false));
    assert_eq!(mesh.normals[..3], [Vec3::Z, Vec3::Y, Vec3::Z], "NaN is mended with the face's");
    assert_eq!(mesh.normals[3..], [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Z, Vec3::NEG_Z]);
    assert_eq!(mesh.indices, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
}

#[test]
fn a_primitive_takes_only_the_vertices_it_uses() {
    let mut file = File::new();
    let positions: Vec<f32> = (0..300).flat_map(|i| [i as f32, (i * i % 7) as f32, 0.0]).collect();
    let positions = file.floats("VEC3", &positions);
    let indices = file.shorts("SCALAR", &[299, 0, 7, 7, 0, 5]);
    let normals = file.push("accessors", json!({"componentType": 5126, "count": 300, "type": "VEC3"}));
    file.show(json!({"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices}));
    let scene = import(&file);
    assert_eq!((scene.meshes[0].positions.len(), scene.meshes[0].indices.as_slice()), (4, &[0, 1, 2, 2, 1, 3][..]));
    assert_eq!(corners(&scene)[0][0].x, 299.0);
}

#[test]
fn lights_with_a_size_and_with_a_slide() {
    let mut file = File::triangle();
    let spot = |extras: Value| json!({"type": "spot", "extras": extras});
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "extras": {"radius": 0.5}},
        spot(json!({"size": [2, 1], "projects": 0})),
        {"type": "directional", "extras": {"radius": 0.5, "projects": 0}},
        spot(json!({"radius": -1, "projects": 9})),
    ]}});
    file.json["images"] = json!([{"uri": "no-such-image.png"}]);
    file.json["textures"] = json!([{"source": 0}]);
    let light = |light: usize| json!({"extensions": {"KHR_lights_punctual": {"light": light}}});
    let nodes = file.json["nodes"].as_array_mut().unwrap();
    nodes.extend((0..4).map(light));
    nodes.push(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}, "extras": {"radius": 2}}));
    file.json["scenes"] = json!([{"nodes": [0, 1, 2, 3, 4, 5]}]);
    let scene = import(&file);
    let lights: Vec<_> = scene.lights.iter().map(|light| (light.extent, light.slide)).collect();
    assert_eq!(
        lights,
        [
            (Extent::Round(0.5), None),
            (Extent::Rectangle([2.0, 1.0]), Some(0)),
            (Extent::Point, None),
            (Extent::Point, None),
            (Extent::Round(2.0), None),
        ],
        "what a node says goes before what its light says"
    );
    assert_eq!(scene.textures.len(), 1, "a checker stands in for the image that is not there");
    let warnings = scene.warnings.join("\n");
    for said in
        ["light 2: it is directional", "light 2: only spots project", "light 3: its size", "light 3: it projects texture 9"]
    {
        assert!(warnings.contains(said), "{said}: {warnings}");
    }
}

#[test]
fn lights_and_cameras_with_bad_numbers_put_right() {
    let mut file = File::triangle();
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 40, "color": [1, 0.5, 0.25], "range": 12, "name": "lamp"},
        {"type": "directional", "intensity": 3, "range": 5},
        {"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.4}},
        {"type": "spot", "spot": {"innerConeAngle": 2, "outerConeAngle": 9}, "intensity": -1, "range": 0},
        {"type": "laser"},
    ]}});
    file.json["cameras"] = json!([
        {"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.5}, "name": "front"},
        {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "znear": 0, "zfar": 10}},
        {"type": "perspective", "perspective": {"yfov": -1, "znear": -1}},
    ]);
    let light = |light: usize| json!({"extensions": {"KHR_lights_punctual": {"light": light}}});
    let nodes = file.json["nodes"].as_array_mut().unwrap();
    nodes.extend((0..5).map(light));
    nodes.extend((0..3).map(|camera| json!({"camera": camera, "translation": [0.5, 0.5, 4]})));
    file.json["scenes"] = json!([{"nodes": [0, 1, 2, 3, 4, 5, 6, 7, 8]}]);
    let scene = import(&file);
    let endless = f32::INFINITY;
    let lights: Vec<_> =
        scene.lights.iter().map(|light| (light.name.as_str(), light.kind, light.intensity, light.range)).collect();
    let half = std::f32::consts::FRAC_PI_2;
    assert_eq!(
        lights,
        [
            ("lamp", LightKind::Point, 40.0, 12.0),
            ("light 1", LightKind::Directional, 3.0, endless),
            ("light 2", LightKind::Spot { inner: 0.2, outer: 0.4 }, 1.0, endless),
            ("light 3", LightKind::Spot { inner: half, outer: half }, 0.0, endless),
        ]
    );
    assert_eq!((scene.lights[0].color, scene.lights[0].node), (Vec3::new(1.0, 0.5, 0.25), 1));
    assert_eq!(scene.cameras.iter().map(|camera| camera.name.as_str()).collect::<Vec<_>>(), ["front", "camera 1", "camera 2"]);
    let front = &scene.cameras[0];
    assert!((front.vertical_fov - 0.7).abs() < 1e-6 && front.near == 0.5 && (front.focus_distance - 4.0).abs() < 1e-6);
    let stand_in = &scene.cameras[1];
    assert!((stand_in.vertical_fov - 2.0 * 0.25f64.atan()).abs() < 1e-6, "it sees as much at the focus");
    assert!(scene.cameras.iter().all(|camera| camera.near > 0.0 && camera.vertical_fov > 0.0));
    assert_eq!(scene.warnings.len(), 6, "{:?}", scene.warnings);
}

#[test]
fn exposure_fits_the_light_and_the_ambient_light_fits_the_exposure() {
    let scene_with = |candela: f64| {
        let mut file = File::triangle();
        file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": candela}]}});
        let light = json!({"translation": [0, 0, 100], "extensions": {"KHR_lights_punctual": {"light": 0}}});
        file.json["nodes"].as_array_mut().unwrap().push(light);
        file.json["scenes"] = json!([{"nodes": [0, 1]}]);
        import(&file)
    };
    for candela in [1.0, 1e4, 1e7] {
        let scene = scene_with(candela);
        let shown = f64::from(scene.exposure) * candela / 1e4 / std::f64::consts::PI;
        assert!((shown - 0.8).abs() < 0.02, "{candela} cd: a white surface is shown at {shown}");
        let ambient = scene.environment.ambient_sky.y * scene.exposure;
        assert!((ambient - obscura::scene::Environment::default().ambient_sky.y).abs() < 1e-5);
    }
    assert_eq!(scene_with(0.0).exposure, 1.0);
}

#[test]
fn what_a_file_leaves_out_fits_its_size() {
    for scale in [1e-3, 1.0, 1e5] {
        let mut file = File::triangle();
        file.json["nodes"] = json!([{"mesh": 0, "scale": [scale, scale, scale], "translation": [3.0 * scale, 0, 0]}]);
        let mut scene = import(&file);
        looks_at_the_scene(&scene);
        assert_eq!((scene.lights.len(), scene.exposure), (2, 1.0));
        let posed = pose(&scene, 0.0, scene.default_animation, &BTreeMap::new());
        let distance = posed.lights[0].position.distance(bounds(&scene).center().as_dvec3());
        let irradiance = f64::from(scene.lights[0].intensity) / (distance * distance);
        assert!((irradiance / std::f64::consts::PI - 0.8).abs() < 0.01, "at {scale}: {irradiance}");

        let before = bounds(&scene);
        add_floor(&mut scene);
        let floor = scene.nodes.last().unwrap();
        assert_eq!((floor.name.as_str(), floor.casts_shadow), ("floor", false));
        let after = bounds(&scene);
        let gap = (before.min.y - after.min.y) / before.radius();
        assert!((1e-4..1e-2).contains(&gap), "{gap}");
        assert!(after.half_size().x > 2.0 * before.half_size().x);
        assert!((after.center().x - before.center().x).abs() < 0.01 * before.radius());
    }
}

#[test]
fn the_floor_lies_below_every_moment() {
    let mut file = File::triangle();
    let times = file.floats("SCALAR", &[0., 1., 2.]);
    let places = file.floats("VEC3", &[0., 0., 0., 0., -7., 0., 0., 0., 0.]);
    file.json["animations"] = json!([{
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [{"input": times, "output": places}],
    }]);
    let mut scene = import(&file);
    add_floor(&mut scene);
    assert!(bounds(&scene).min.y < -7.0);
}

#[test]
fn animations_keep_what_they_can() {
    let mut file = File::triangle();
    let times = file.floats("SCALAR", &[0.5, 1.0, 1.0, 2.0]);
    let places = file.floats("VEC3", &[0., 0., 0., 1., 0., 0., 9., 9., 9., 2., 0., 0.]);
    let turns = file.accessor("VEC4", 5120, 4, &[0, 0, 0, 127, 0, 0, 127, 0, 0, 0, 0, 127, 0, 129, 0, 0]);
    file.json["accessors"][turns]["normalized"] = json!(true);
    let tangents: Vec<f32> = (0..36).map(|i| i as f32).collect();
    let tangents = file.floats("VEC3", &tangents);
    let channel = |sampler: usize, path: &str| json!({"sampler": sampler, "target": {"node": 0, "path": path}});
    file.json["animations"] = json!([
        {"channels": [{"sampler": 0, "target": {"path": "pointer", "extensions": {}}}], "samplers": [{"input": times, "output": places}]},
        {
            "name": "all",
            "channels": [channel(0, "translation"), channel(1, "rotation"), channel(2, "scale"), channel(0, "weights"), channel(0, "odd")],
            "samplers": [
                {"input": times, "output": places, "interpolation": "STEP"},
                {"input": times, "output": turns},
                {"input": times, "output": tangents, "interpolation": "CUBICSPLINE"},
            ],
        },
    ]);
    let scene = import(&file);
    assert_eq!((scene.animations.len(), scene.animations[0].name.as_str(), scene.animations[0].duration), (1, "all", 2.0));
    let channels = &scene.animations[0].channels;
    let kinds: Vec<_> = channels.iter().map(|channel| (channel.property, channel.interpolation)).collect();
    assert_eq!(
        kinds,
        [
            (Property::Translation, Interpolation::Step),
            (Property::Rotation, Interpolation::Linear),
            (Property::Scale, Interpolation::CubicSpline)
        ]
    );
    assert_eq!((channels[0].times.as_slice(), channels[0].values.len()), (&[0.5, 1.0, 2.0][..], 9));
    assert_eq!(channels[0].values[3..6], [1.0, 0.0, 0.0], "of two keys at one time the first counts");
    assert_eq!((channels[1].values[6], channels[2].values.len()), (1.0, 27));
    assert!(scene.warnings.iter().any(|warning| warning.contains("animation 0")), "{:?}", scene.warnings);
}

#[test]
fn an_animated_matrix_becomes_translation_rotation_and_scale() {
    let mut file = File::triangle();
    let times = file.floats("SCALAR", &[0.]);
    let scales = file.floats("VEC3", &[1., 1., 1.]);
    file.json["nodes"][0]["matrix"] = json!([0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1]);
    file.json["animations"] = json!([{
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}],
        "samplers": [{"input": times, "output": scales}],
    }]);
    let scene = import(&file);
    let Transform::Trs { translation, scale, .. } = scene.nodes[0].local else { panic!("{:?}", scene.nodes[0].local) };
    assert!(translation == DVec3::new(1., 2., 3.) && scale.abs_diff_eq(DVec3::splat(2.0), 1e-9));
}

#[test]
fn eight_joints_become_the_four_that_weigh_most() {
    let mut file = File::triangle();
    let joints = file.shorts("VEC4", &[0, 1, 999, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    let more_joints = file.shorts("VEC4", &[2, 3, 4, 999, 0, 0, 0, 0, 0, 0, 0, 0]);
    let weights = file.floats("VEC4", &[0.1, 0.2, 0., 0., 1., 0., 0., 0., 0., 0., 0., 0.]);
    let more_weights = file.floats("VEC4", &[0.3, 0.15, 0.25, 0., 0., 0., 0., 0., 0., 0., 0., 0.]);
    let attributes =
        json!({"POSITION": 0, "JOINTS_0": joints, "WEIGHTS_0": weights, "JOINTS_1": more_joints, "WEIGHTS_1": more_weights});
    file.show(json!({"attributes": attributes}));
    file.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {}, {}, {}, {}, {}]);
    file.json["skins"] = json!([{"joints": [1, 2, 3, 4, 5]}]);
    let scene = import(&file);
    assert_eq!(scene.skins[0].joints.len(), 5, "joints outside the scene come along");
    // The mesh is flat, but one triangle's corners keep their order.
    let bound = scene.meshes[0].skin[0];
    assert_eq!(bound.joints, [2, 4, 1, 3]);
    assert!((bound.weights[0] - 0.3 / 0.9).abs() < 1e-6);
    assert_eq!(scene.meshes[0].skin[2].weights, [1.0, 0.0, 0.0, 0.0], "no weight at all is all on the first");
    file.json["skins"] = json!([{"joints": [1, 2, 3, 4]}]);
    assert_eq!(error(&file), "test: node 0: mesh \"mesh 0\" needs joint 4, but the skin has 4");
}

#[test]
fn what_is_not_shown_of_used_extensions_is_told() {
    let mut file = File::triangle();
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_clearcoat", "X_Y"]);
    assert_eq!(import(&file).warnings, ["what these extensions add is not shown: KHR_materials_clearcoat, X_Y"]);
}

#[test]
fn the_report_reads_well() {
    let report = doctor::report(&import(&File::triangle()));
    let start = "\
test
  nodes       4 (1 show a mesh)
  triangles   1 (3 vertices)
  materials   1 (0 blended)
  textures    none
  lights      key light (point, ";
    let text = report.to_string();
    assert!(text.starts_with(start), "{text}");
    assert!(text.contains("1 components, 0 closed; 3 border edges, 0 non-manifold edges, 0 degenerate triangles"), "{text}");
    assert!(text.contains("volume: open or not manifold: every triangle counts, turned to face the light"), "{text}");
    assert_eq!(serde_json::to_value(&report).unwrap()["meshes"][0]["topology"]["border_edges"], 3);
}
