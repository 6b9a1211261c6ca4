//! What other programs make of the output.

mod gltf;
