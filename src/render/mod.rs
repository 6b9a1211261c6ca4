//! Scripts → images.

pub mod linear_light;
