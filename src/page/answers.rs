//! The answers to the page's requests about runs.
//!
//! | request | answer |
//! | --- | --- |
//! | `/api/runs/N` | the constant data of a run |
//! | `/api/runs/N/forms` | the triangles of its base shapes |
//! | `/api/runs/N/fonts` | the files of the fonts that its labels have of their own, one after another |
//! | `/api/runs/N/ghosts` | the earlier poses that the run shows as ghosts |
//! | `/api/runs/N/poses?from=A&to=B` | the poses of its bodies in some frames |
//! | `/api/runs/N/balance`, `…/series?body=I` | its energies and momenta, the motion of a body |
//! | `/api/runs/N/contacts?body=I&from=A&to=B` | the points at which a body touches others in some frames, and the forces there |
//! | `/api/runs/N/shown?from=A&to=B` | the objects drawn beside the bodies in some frames |
//! | `/api/runs/N/particles?from=A&to=B` | its particles in some frames |
//! | `/api/runs/N/scripts?from=A&to=B` | the scripts of some frames, and the files that they include |
//! | `/api/runs/N/model`, `…/table`, `…/page` | the model, the table and the web page that `jabuka export` writes |

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::run::PageRun;
use super::session::Session;
use super::{Failed, describe, exports, numbers, samples, scripts, shown, swarms};
use crate::export::{MODEL, TABLE};
use crate::font::Weight;

/// The answer to a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Text in JSON.
    Json(Vec<u8>),
    /// Bytes.
    Binary(Vec<u8>),
}

impl Answer {
    /// Writes a value as JSON.
    ///
    /// # Errors
    /// If the value cannot be written, which does not happen for the values of a page.
    pub fn json(value: &impl Serialize) -> Result<Answer, Failed> {
        serde_json::to_vec(value).map(Answer::Json).map_err(|error| Failed::Io(error.into()))
    }

    /// The media type of the answer.
    pub fn kind(&self) -> &'static str {
        match self {
            Answer::Json(_) => "application/json",
            Answer::Binary(_) => "application/octet-stream",
        }
    }

    /// The bytes of the answer.
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Answer::Json(bytes) | Answer::Binary(bytes) => bytes,
        }
    }
}

/// The parameters of a request for some frames of a run.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(default)]
pub struct Frames {
    /// The first frame.
    pub from: usize,
    /// The end of the range of frames, exclusive. `None` for the end of the run.
    pub to: Option<usize>,
    /// The stride: only every n-th frame is included.
    pub every: usize,
    /// The index of the body, for requests about one body.
    pub body: usize,
    /// The index of the camera: 0 for the main camera, then the views in their order.
    pub view: usize,
}

impl Default for Frames {
    fn default() -> Frames {
        Frames { from: 0, to: None, every: 1, body: 0, view: 0 }
    }
}

impl Frames {
    /// Returns the end of the range of frames, at most the end of the run.
    pub fn end(&self, run: &PageRun) -> usize {
        self.to.unwrap_or(usize::MAX).min(run.scene.simulation.timeline.frames())
    }

    /// Yields the numbers of the requested frames that have been simulated.
    pub(super) fn recorded(&self, run: &PageRun) -> impl Iterator<Item = usize> + use<> {
        (self.from..self.end(run).min(run.recorded())).step_by(self.every.max(1))
    }
}

/// Answers a request about a run, such as `/api/runs/3/poses`.
///
/// # Errors
/// If there is no such run, frame or body, or the recording cannot be read.
pub fn answer(session: &Session, path: &str, frames: &Frames) -> Result<Answer, Failed> {
    let rest = path.strip_prefix("/api/runs/").ok_or(Failed::Gone)?;
    let (id, what) = rest.split_once('/').unwrap_or((rest, ""));
    let run = id.parse().ok().and_then(|id| session.run(id)).ok_or(Failed::Gone)?;
    answer_of_run(&run, what, frames)
}

/// Answers a request about a run. `what` is the last part of its path, which is empty for the constant data.
///
/// # Errors
/// If there is no such frame or body, or the recording cannot be read.
pub fn answer_of_run(run: &Arc<PageRun>, what: &str, frames: &Frames) -> Result<Answer, Failed> {
    let recorded = frames.recorded(run);
    Ok(match what {
        "" => Answer::json(&describe::describe(run))?,
        "forms" => Answer::Binary(describe::triangles(&run.scene)),
        "fonts" => {
            let files = describe::fonts(&run.scene).map(|font| font.font(Weight::Regular).bytes());
            Answer::Binary(files.collect::<Vec<_>>().concat())
        }
        "ghosts" => Answer::json(&shown::ghosts(run))?,
        "poses" => {
            Answer::Binary(numbers::poses(&mut run.recording().read(), run.scene.bodies.len(), recorded)?)
        }
        "balance" => Answer::Binary(samples::balance(run, recorded)?),
        "series" if frames.body < run.scene.bodies.len() => {
            Answer::Binary(samples::of_body(run, frames.body, recorded)?)
        }
        "contacts" if frames.body < run.scene.bodies.len() => {
            Answer::Binary(samples::contacts_of(run, frames.body, recorded)?)
        }
        "shown" => Answer::json(&shown::frames(run, frames.view, recorded)?)?,
        "particles" => Answer::Binary(swarms::frames(run, recorded)?),
        "model" => Answer::Binary(exports::file(run, &MODEL)?),
        "table" => Answer::Binary(exports::file(run, &TABLE)?),
        #[cfg(feature = "render")]
        "page" => Answer::Binary(exports::written(run, &super::OneFile)?),
        "scripts" => Answer::Binary(scripts::of_frames(run, frames)?),
        _ => return Err(Failed::Gone),
    })
}
