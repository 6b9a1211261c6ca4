//! The sandbox: the system limits what the programs that jabuka starts may read and write.
//!
//! POV-Ray executes any script, and its readers of images, fonts and meshes may have security holes. jabuka therefore starts POV-Ray and
//! ffmpeg through a launcher, the hidden command `jabuka sandbox`. The launcher gives up all rights that the program does not need, and
//! then becomes the program. Linux enforces the restrictions by Landlock.
//!
//! | what | where |
//! | --- | --- |
//! | the launcher, and the rights of programs with and without `--trust` | [`Launcher`], [`Confinement`] |
//! | the steps of the launcher before it becomes the program | [`Launch`] |
//! | paths that every program may read: the system's folders, and the program's own files | `readable` |
//! | the environment variables that every program receives | `environment` |
//! | the rules for the kernel, and what the running kernel can enforce | `landlock`, [`enforced`] |
//!
//! A script can make POV-Ray read and write files. The sandbox costs about 4 ms for each process.
//!
//! - A program may read the system's folders and its own files: its folder; `lib`, `share/povray*` and `etc/povray` beside a folder `bin`;
//!   `LD_LIBRARY_PATH`; `~/.povray`. Homes, `/tmp` and all other folders are not readable. POV-Ray also reads the folder of its scripts.
//! - A program receives only the environment variables that it needs, since others may hold passwords; `/proc/self/environ` is closed.
//! - POV-Ray writes only in its work folder, ffmpeg only the file of the film. Temporary files go to the work folder. TCP is refused.
//! - With `--trust`, POV-Ray reads all files, and also writes in the folder of the scene and in the folders of the results.
//! - A POV-Ray with libraries in an unusual folder cannot start under these limits. It may read all files, and a warning says so; its write
//!   access stays limited.
//! - `jabuka --version -v` shows what the kernel enforces. Before Linux 6.2, the kernel cannot forbid truncating a file; before 6.7, it
//!   cannot forbid connections; before 5.13, and on other systems, nothing is enforced. `render-chunk` uses the sandbox on nodes that have
//!   jabuka; the first line of its log says so.
//! - On Windows, the launcher cannot become the program. It starts the program with the same variables, in one job with itself, and waits.
//! - On Linux, the launcher asks the system for a signal when its parent ends. The system sends it when the parent's thread ends, so the process that
//!   starts it stays on its thread.
//!
//! The crate `landlock` sets the rules, without `unsafe` of our own.

mod confinement;
mod environment;
#[cfg_attr(not(target_os = "linux"), path = "no_landlock.rs")]
mod landlock;
mod launch;
#[cfg(target_os = "linux")]
mod readable;

pub(crate) use confinement::Needs;
pub use confinement::{Confinement, Launcher};
pub use landlock::enforced;
pub use launch::{Launch, LaunchError};
