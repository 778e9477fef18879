//! Edges of welded triangles.

/// The welded triangles and edges of a mesh.
#[derive(Debug, Clone, Default)]
pub struct Topology {}
