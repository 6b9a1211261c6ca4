//! Tests of the output that need other programs.

mod gltf;
