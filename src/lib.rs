//! Obscura: the architecture page is written as the parts land.

pub mod app;
pub mod cli;
pub mod frame;
pub mod geometry;
pub mod headless;
pub mod scene;
pub mod settings;
