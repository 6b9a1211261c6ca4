//! The sandbox: what the programs that jabuka starts may read and write, enforced by the system.
//!
//! POV-Ray does whatever a script says, and reads images, fonts and meshes with code that may have faults. So jabuka
//! starts POV-Ray and ffmpeg through a launcher, the hidden command `jabuka sandbox`. The launcher gives up all rights
//! that the program does not need, and then becomes the program. Linux enforces this by Landlock.
//!
//! | what | where |
//! | --- | --- |
//! | the launcher as its callers see it, and what `--trust` adds | [`Launcher`], [`Confinement`] |
//! | what the launcher does before it becomes the program | [`Launch`] |
//! | what every program may read: the system's folders, and its own files | `readable` |
//! | the rules as the kernel takes them, and what this kernel can enforce | `landlock`, [`enforced`] |

mod confinement;
#[cfg_attr(not(target_os = "linux"), path = "no_landlock.rs")]
mod landlock;
mod launch;
mod readable;

pub(crate) use confinement::Needs;
pub use confinement::{Confinement, Launcher};
pub use landlock::enforced;
pub use launch::{Launch, LaunchError};
