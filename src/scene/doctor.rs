//! What a mesh is made of, and so how its volume will be built.
