//! The built-in scenes.

use super::Scene;
use super::gltf::ImportError;

/// A scene that is built in.
pub struct StockScene {
    /// What users call it.
    pub name: &'static str,
    /// One sentence on what it shows.
    pub about: &'static str,
    /// Makes it.
    pub build: fn() -> Result<Scene, ImportError>,
}

/// All built-in scenes, in the order people see them.
pub static TABLE: &[StockScene] = &[];

/// The built-in scene of that name.
#[must_use]
pub fn build(name: &str) -> Option<Result<Scene, ImportError>> {
    TABLE.iter().find(|scene| scene.name == name).map(|scene| (scene.build)())
}
