//! The sandbox: the system limits what the programs that jabuka starts may read and write.
//!
//! POV-Ray executes any script, and reads images, fonts and meshes with code that may have faults. So jabuka starts
//! POV-Ray and ffmpeg through a launcher, the hidden command `jabuka sandbox`. The launcher gives up all rights that
//! the program does not need, and then becomes the program. Linux enforces this by Landlock.
//!
//! | what | where |
//! | --- | --- |
//! | the launcher and the rights of a program, with those that `--trust` adds | [`Launcher`], [`Confinement`] |
//! | the launcher's steps before it becomes the program | [`Launch`] |
//! | paths readable by every program: the system's folders, and the program's own files | `readable` |
//! | the rules for the kernel, and what this kernel can enforce | `landlock`, [`enforced`] |

mod confinement;
#[cfg_attr(not(target_os = "linux"), path = "no_landlock.rs")]
mod landlock;
mod launch;
mod readable;

pub(crate) use confinement::Needs;
pub use confinement::{Confinement, Launcher};
pub use landlock::enforced;
pub use launch::{Launch, LaunchError};
