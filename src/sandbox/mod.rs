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

mod confinement;
mod environment;
#[cfg_attr(not(target_os = "linux"), path = "no_landlock.rs")]
mod landlock;
mod launch;
mod readable;

pub(crate) use confinement::Needs;
pub use confinement::{Confinement, Launcher};
pub use landlock::enforced;
pub use launch::{Launch, LaunchError};
