//! The values of formulas of measures in the frames of a run.

use std::sync::Arc;

use jabuka::Scene;
use jabuka::cache;
use jabuka::diagnostic::{Code, Report};
use jabuka::simulate::{Frame, Measures, MomentState, SimulateError};
use pyo3::prelude::*;

use crate::background::{self, Control};
use crate::errors::{self, Class};
use crate::run::{Outcome, broken_down, simulate};
use crate::scene::Reading;

/// The values of a formula in each frame, and its unit, if jabuka knows it.
type Measured = (Vec<f64>, Option<String>);

/// Why formulas have no values.
enum Failure {
    Scene(Report),
    Run(SimulateError),
}

impl From<SimulateError> for Failure {
    fn from(error: SimulateError) -> Failure {
        Failure::Run(error)
    }
}

/// Computes formulas of measures, written as in plots.
pub(crate) fn of(
    py: Python<'_>,
    (reading, scene): (&Reading, &Arc<Scene>),
    outcome: &Outcome,
    formulas: Vec<String>,
) -> PyResult<Vec<Measured>> {
    let reading = reading.with_measures(formulas);
    let measured =
        background::run(py, None, None, |control| values(&reading, scene, outcome, control))?.whole()?;
    measured.map_err(|failure| match failure {
        Failure::Scene(report) => errors::exception(py, Class::Scene, &report),
        Failure::Run(error) => broken_down(py, &error),
    })
}

fn values(
    reading: &Reading,
    scene: &Scene,
    outcome: &Outcome,
    control: &Control,
) -> Result<Vec<Measured>, Failure> {
    let asking = reading.scene().map_err(Failure::Scene)?;
    if asking.digest != scene.digest {
        return Err(Failure::Scene(changed()));
    }
    // Contact forces and impacts of pairs are recorded only if a formula names them.
    let again = match cache::have_same_recording(&asking, scene) {
        true => None,
        false => Some(simulate(&asking, control)?),
    };
    let frames = outcome.recording.frames();
    let outcome = again.as_ref().unwrap_or(outcome);
    let measures = Measures::new(&asking);
    let mut columns = vec![Vec::with_capacity(frames); asking.measures.len()];
    let mut add = |frame: &Frame| {
        let now = MomentState::now(frame);
        for (formula, column) in asking.measures.iter().zip(&mut columns) {
            column.push(measures.value(formula, &now));
        }
    };
    if asking.areas.is_empty() && asking.approaches.is_empty() {
        let mut reader = outcome.recording.read();
        for frame in (0..frames).take_while(|_| !control.is_stopped()) {
            add(&reader.seen(frame).map_err(SimulateError::from)?);
        }
    } else {
        // Only these measures depend on earlier frames.
        let recorded = outcome.recorded(&asking);
        for frame in recorded.frames().take(frames).take_while(|_| !control.is_stopped()) {
            add(&frame?);
        }
    }
    let units = asking.measures.iter().map(|formula| formula.unit().map(str::to_owned));
    Ok(columns.into_iter().zip(units).collect())
}

/// The error that the file of a scene is no longer that of its run.
pub(crate) fn changed() -> Report {
    Report::of_error(
        Code::CannotRead,
        "a file of the scene has changed since it was read: load the scene and run it again",
    )
}
