//! What the page of a scene shows, and the page itself. The page runs in a browser; its data come from here.
//!
//! | what | where |
//! | --- | --- |
//! | the last run without errors, and the current errors of the scene | `session` |
//! | what a session needs from the program around it | `host` |
//! | a run that is simulated piece by piece | `run` |
//! | how an unfinished run looks | `provisional` |
//! | a panic, as an error on the page | `panicked` |
//! | the answers to the page's requests | `answers`, `failed` |
//! | the data of a run for the page | `describe`, `shown`, `swarms`, `samples` |
//! | the scripts, the table and the model of a run, for users who take them along | `scripts`, `exports` |
//! | the encoding of frames as bytes | `numbers` |
//! | the page and a run as one file | `one_file` |
//! | the files of the page | `files`, and the folder `web` |
//!
//! # One page, three sources
//!
//! The page does not know where its data come from. `jabuka preview` serves it from a local server (`preview`); `playground/` compiles this
//! library for the browser, and answers the same requests in a worker beside the page. Both implement [`Host`], and both give a request to
//! [`answer`]. A third one needs no program at all: a run that was saved as one file ([`OneFile`]) has all answers in the page.
//!
//! # Runs
//!
//! - A run is simulated in pieces of a frame ([`RunWork`]). The server does them in a thread, the worker between two requests. A recording
//!   can be read while it grows. So going back needs no new simulation.
//! - For each frame, `picture` gives all objects besides the bodies, as for scripts.
//! - Particles are computed when the page requests them (`swarms`), from the bodies of the recorded frames. If there are too many, only
//!   every n-th is sent.
//!
//! # The page
//!
//! - The page is plain modules and WebGL2, without a build step. In `web`, `run` fetches a run, `picture` draws it, `plots` draws its numbers,
//!   `body` shows what one wants to know of a body, `text` edits the scene, and `saving` makes files to take along. `libraries/build`
//!   bundles its libraries, such as the editor. The bundles are committed, so building jabuka needs no npm. The page loads each when it needs it.
//! - The page edits the text of the scene where its host lets it (`web/text/scene_text.js`). Each text has a version, so that nothing is overwritten
//!   that another program has written meanwhile.
//! - A picture that is saved is drawn as one of the page, in another size; what stands over it is painted to a canvas (`web/picture/overlay.js`).
//! - Each run has a unique number. The page requests the frames of a run in pieces of at most 2 MB, and keeps 256 MB of them. If the run has
//!   been replaced, the answer says so, and the page continues with the run that the session has announced. All that the page remembers of a
//!   picture belongs to the object of its run, so nothing of an earlier run is drawn.
//! - The page draws the triangles from `surface`, with the poses in a texture, so a frame costs one upload of numbers. The shaders compute
//!   in 32 bits, with the size of the scene as unit of length and its center as origin; the simulation uses 64 bits. If there are many
//!   balls, each is drawn as a square that faces the camera.
//! - While paused, the page draws a frame once all of it has arrived; while playing, it interpolates places and orientations.

mod answers;
mod describe;
mod exports;
mod failed;
#[cfg(feature = "fonts")]
mod files;
mod host;
mod numbers;
#[cfg(feature = "render")]
mod one_file;
mod panicked;
mod provisional;
mod run;
mod samples;
mod scripts;
mod session;
mod shown;
mod swarms;

pub use answers::{Answer, Frames, answer, answer_of_run};
pub use failed::Failed;
#[cfg(feature = "fonts")]
pub use files::FILES;
pub use host::{Host, RunStorage};
#[cfg(feature = "preview")]
pub(crate) use numbers::poses;
#[cfg(feature = "render")]
pub use one_file::{OneFile, WEB_PAGE};
#[cfg(feature = "preview")]
pub(crate) use panicked::caught;
pub use run::{Outcome, PageRun, Progress, RunId, RunWork};
pub use session::{Session, State, Variant, text_version};
