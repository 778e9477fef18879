//! Import of glTF and GLB files.
