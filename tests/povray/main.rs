//! Tests of the scripts in real POV-Ray: it parses all of them without warnings, and the pixels show the scene.
//!
//! A POV-Ray process sleeps for most of its 0.6 s, so tests that render several scripts start them all at once.
#![cfg(feature = "tests-with-tools")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "these are tests"
)]

mod assets;
mod coming_and_going;
mod every_script;
mod extremes;
mod hostile;
mod image;
mod layouts;
mod lens;
mod library;
mod lights;
mod looks;
mod meshes;
mod particles;
mod pinhole;
mod planes;
mod povray;
mod reuse;
mod same_pixels;
mod scales;
mod scene;
mod sequence;
mod shapes;
mod showing;
mod shutter;
mod sides;
#[allow(unreachable_pub, reason = "a test program has no outside")]
#[path = "../support/mod.rs"]
mod support;
mod surroundings;
mod trust;
mod turning;
