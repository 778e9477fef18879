//! The built-in scenes.
