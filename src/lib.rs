//! Obscura: the architecture page is written as the parts land.

pub mod app;
pub mod cli;
pub mod director;
pub mod frame;
pub mod geometry;
pub mod gpu;
pub mod headless;
pub mod scene;
pub mod settings;
pub mod techniques;
