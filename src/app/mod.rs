//! The window: a winit loop around the same settings, scene, plan and renderer that the headless
//! commands use.
//!
//! - [`surface`] decides what to do about the window's surface, without a GPU;
//! - [`control`], [`keys`] and [`clock`] turn input into settings;
//! - [`store`] keeps settings between runs.

pub mod clock;
pub mod control;
pub mod device;
pub mod keys;
pub mod pace;
pub mod photo;
pub mod store;
pub mod surface;
pub mod ui;
