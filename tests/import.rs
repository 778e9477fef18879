//! What is imported from real files, and from small ones written here.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails may panic")]

use std::path::{Path, PathBuf};

use obscura::scene::gltf::load;
use obscura::scene::{AnimationChoice, Scene};

/// A file that is not part of the project; where it is not there, the test says so and passes.
fn shared(path: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let from_environment = std::env::var_os("OBSCURA_SHARED").map(PathBuf::from);
    let places = from_environment.into_iter().chain([root.join("../shared"), root.join("../../shared")]);
    let found = places.map(|place| place.join(path)).find(|path| path.exists());
    if found.is_none() {
        println!("skipped: {path} is not on this machine (OBSCURA_SHARED says where)");
    }
    found
}

fn shared_scene(path: &str) -> Option<Scene> {
    Some(load(&shared(path)?).unwrap())
}

fn triangles(scene: &Scene) -> usize {
    scene.instances().map(|(_, _, mesh)| mesh.indices.len() / 3).sum()
}

#[test]
fn fox() {
    let Some(scene) = shared_scene("models/Fox.glb") else { return };
    assert_eq!((scene.name.as_str(), triangles(&scene)), ("Fox", 576));
    assert_eq!(scene.skins.len(), 1);
    assert_eq!(scene.skins[0].joints.len(), 24);
    let names: Vec<_> = scene.animations.iter().map(|animation| animation.name.as_str()).collect();
    assert_eq!(names, ["Survey", "Walk", "Run"]);
    assert_eq!(scene.default_animation, AnimationChoice::One(0));
    assert!(scene.meshes[0].flat, "it has no normals");
    assert_eq!(scene.textures.len(), 1);
    assert_eq!(scene.warnings, [""; 0]);
    for (index, node) in scene.nodes.iter().enumerate() {
        assert!(node.parent.is_none_or(|parent| parent < index));
    }
}
