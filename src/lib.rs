//! jabuka compiles a scene written in TOML into POV-Ray scripts, one per frame.
//!
//! The stages, in the order in which a scene passes through them:
//!
//! | stage | from → to | what it knows |
//! | --- | --- | --- |
//! | [`scene`] | text → checked [`Scene`] | the scene language; every mistake at its place |
//! | [`dynamics`] | bodies, forces → motion | physics; no TOML and no POV-Ray |
//! | [`simulate`] | scene → world → frames | the only place where a scene meets a world |
//! | [`report`] | scene → how right its run is | how runs are compared; nothing that draws scenes |
//! | [`picture`] | frames → what their pictures show | camera, lights, arrows, texts, in metres; no program that draws |
//! | [`emit`] | frames → scripts | POV-Ray's words; no force and no integrator |
//! | [`output`] | scripts → files | names, whole files, a folder that survives a kill |
//! | [`render`] | scripts → images → film | POV-Ray's options; which images are up to date; ffmpeg |
//!
//! [`Run`] takes a scene through them. [`overwrite`] decides which files a command may replace. [`diagnostic`] is what all of them say errors with, and [`explain`] what the codes of errors mean; [`catalog`] is
//! what there is to choose from, and [`starter`] a scene to start from. [`surface`] has the triangles of shapes and plain looks of materials, and
//! [`export`] tables and models, for programs that are not POV-Ray; [`preview`] shows a scene in the browser while it is written.
//! [`sandbox`] confines the programs that jabuka starts.
//!
//! # Features
//!
//! All are on by default. In a project of your own, `default-features = false` leaves a library that reads scenes, simulates them, and makes
//! scripts, tables and models, with about 40 crates, also for a browser (`wasm32-unknown-unknown`).
//!
//! | feature | what it brings |
//! | --- | --- |
//! | `cli` | the program `jabuka` |
//! | `render` | the modules `output`, `render`, `cache`, `overwrite` and `sandbox`: files, POV-Ray, ffmpeg |
//! | `preview` | the module `preview` |
//! | `threads` | several processor cores |
//! | `time-stepping` | contacts of many bodies, `contacts = "time-stepping"` |
//!
//! # Forces and methods of your own
//!
//! A type that implements [`dynamics::Force`] is a force, and one that implements [`dynamics::Integrator`] a method. [`simulate::world`] makes the world
//! of a scene. Add your force to it with [`World::add_force`](dynamics::World::add_force), and set your method with
//! [`World::set_integrator`](dynamics::World::set_integrator). [`simulate::Recorded::of`] runs that world, and [`Run::of`] makes scripts of the run.
//! `examples/own_force.rs` does all this in about a hundred lines. If you advance bodies in your own way altogether, implement [`dynamics::Dynamics`],
//! or make single frames from snapshots with [`simulate::Frame::of`].
//!
//! # A snapshot test of a scene
//!
//! A script is text that is the same on every run and machine, so a test can hold it against a stored one. With
//! [insta](https://insta.rs), the last line of this example is `insta::assert_snapshot!(script)`:
//!
//! ```
//! use jabuka::Scene;
//!
//! let scene = Scene::parse(
//!     "
//!     [body.ball]
//!     shape.sphere.radius = 0.5
//!     velocity = [1, 0, 0]
//!     ",
//! )?;
//! let run = jabuka::Run::new(&scene)?;
//! let frame = run.frames().nth(50).expect("ten seconds have 251 frames")?;
//! let script = run.script(&frame)?;
//!
//! assert!(script.starts_with("// frame 50, t = 2 s\n"));
//! assert!(script.contains("sphere { <2, 0, 0>, 0.5"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "render")]
pub mod cache;
pub mod catalog;
pub mod diagnostic;
mod digest;
pub mod dynamics;
pub mod emit;
pub mod explain;
pub mod export;
mod not_drawn;
#[cfg(feature = "render")]
pub mod output;
#[cfg(feature = "render")]
pub mod overwrite;
pub mod picture;
#[cfg(feature = "preview")]
pub mod preview;
pub mod random;
#[cfg(feature = "render")]
pub mod render;
pub mod report;
mod run;
#[cfg(feature = "render")]
pub mod sandbox;
pub mod scene;
pub mod simulate;
pub mod starter;
pub mod surface;
mod threads;

pub use run::{Run, RunError};
pub use scene::Scene;
