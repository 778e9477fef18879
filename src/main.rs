//! Obscura.
fn main() {}
