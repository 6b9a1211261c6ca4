//! jabuka compiles a scene written in TOML into POV-Ray scripts, one per frame.
//!
//! A scene passes through these stages, in this order:
//!
//! | stage | from → to | what it knows |
//! | --- | --- | --- |
//! | [`scene`] | text → checked [`Scene`] | the scene language; reports every error at its position |
//! | [`physics`] | bodies, forces → motion | physics; no TOML and no POV-Ray |
//! | [`simulate`] | scene → world → frames | how a scene becomes a world of bodies and forces |
//! | [`report`] | scene → accuracy of its run | how runs are compared; nothing about drawing |
//! | [`picture`] | frames → contents of their pictures | camera, lights, arrows, texts, in meters; no renderer |
//! | [`emit`] | frames → scripts | POV-Ray's language; no forces and no integrators |
//! | [`output`] | scripts → files | file names; complete files even if the process is killed |
//! | [`render`] | scripts → images → film | POV-Ray's options; which images are up to date; ffmpeg |
//!
//! [`Run`] takes a scene through these stages. [`overwrite`] decides which files a command may replace. [`diagnostic`] represents the
//! errors and warnings of all stages, and [`explain`] explains their codes. [`catalog`] lists the names that scenes can use, and
//! [`starter`] writes an example scene. For programs other than POV-Ray, [`surface`] has the triangles of shapes and simple materials, and
//! [`export`] writes tables and models. [`page`] makes what a page in the browser shows of a scene, and [`preview`] serves that page while
//! the user edits the scene. [`sandbox`] confines the programs that jabuka starts. [`cli`] is the command line.
//!
//! # Features
//!
//! All features are on by default. In your own project, `default-features = false` leaves a library that reads scenes, simulates them, and
//! makes scripts, tables and models. It has about 50 dependencies, and also works in a browser (`wasm32-unknown-unknown`, `wasm32-wasip1`).
//!
//! | feature | what it adds |
//! | --- | --- |
//! | `cli` | the program `jabuka`, and the module `cli` |
//! | `fonts` | the fonts of texts; without it, call [`font::give`] before you read a scene |
//! | `render` | the modules `output`, `render`, `cache`, `overwrite` and `sandbox`: files, POV-Ray, ffmpeg |
//! | `preview` | the module `preview` |
//! | `threads` | the use of several processor cores |
//! | `time-stepping` | contacts of many bodies, `contacts = "time-stepping"` |
//!
//! # Your own forces and methods
//!
//! A type that implements [`physics::Force`] is a force, and a type that implements [`physics::Integrator`] is a method.
//! [`simulate::world`] makes the world of a scene. Add your force to the world with [`World::add_force`](physics::World::add_force), and
//! set your method with [`World::set_integrator`](physics::World::set_integrator). [`simulate::Recorded::of`] runs the world, and
//! [`Run::of`] makes scripts of the run. `examples/own_force.rs` does all of this in about a hundred lines. To advance bodies in an
//! entirely different way, implement [`physics::Dynamics`], or make single frames from snapshots with [`simulate::Frame::of`].
//!
//! # A snapshot test of a scene
//!
//! A script has the same text on every run and machine, so a test can compare it with a stored text. With [insta](https://insta.rs), the
//! last line of this example is `insta::assert_snapshot!(script)`:
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
#[cfg(feature = "cli")]
pub mod cli;
mod decimal;
pub mod diagnostic;
#[cfg(feature = "render")]
pub mod doctor;

mod drawing;
pub mod emit;
pub mod explain;
pub mod export;
pub mod font;
#[cfg(feature = "language-server")]
pub mod language_server;
pub mod lettering;
pub mod motion_warnings;
mod not_drawn;
#[cfg(feature = "render")]
pub mod output;
#[cfg(feature = "render")]
pub mod overwrite;
pub mod page;
pub mod picture;
#[cfg(feature = "preview")]
pub mod preview;

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
mod svg;
pub mod system;
mod threads;

pub use jabuka_physics as physics;
pub use run::{Run, RunError};
pub use scene::Scene;
