//! The committed models are what their generator makes, and what it makes is sound.

// Test code: a failed expectation is the report.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../examples/make_assets/models/mod.rs"]
mod models;

use std::path::Path;

#[test]
fn committed_models_are_the_generated_ones() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let made = models::all();
    for (name, bytes) in &made {
        let committed = std::fs::read(folder.join(name)).unwrap_or_else(|error| panic!("assets/{name}: {error}"));
        assert!(committed == *bytes, "assets/{name} is not what `cargo run --example make_assets` writes");
    }
    let mut on_disk: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".glb"))
        .collect();
    on_disk.sort();
    let mut names: Vec<_> = made.iter().map(|(name, _)| (*name).to_string()).collect();
    names.sort();
    assert_eq!(on_disk, names, "every model in assets/ has its maker");
}

#[test]
fn models_stay_small() {
    let total: usize = models::all().iter().map(|(_, bytes)| bytes.len()).sum();
    assert!(total < 3 << 20, "{total} bytes of models are embedded in the program");
}
