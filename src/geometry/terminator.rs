//! The terminator bound.
