//! Runs: recordings of simulated scenes, which Python reads as arrays.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use jabuka::Scene;
use jabuka::cache::Cache;
use jabuka::diagnostic::Report;
use jabuka::physics::PairCounter;
use jabuka::simulate::{Moments, Recorded, Recorder, Recording, SimulateError, Survey};
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{self, Quantity};
use crate::background::{self, Control, Stop};
use crate::errors::{self, Class};
use crate::events::{self, Events};
use crate::measures;
use crate::pictures::{self, Film, Look};
use crate::scene::Reading;

/// What a simulation leaves behind.
#[derive(Clone)]
pub(crate) struct Outcome {
    pub(crate) recording: Arc<Recording>,
    pub(crate) survey: Survey,
    /// The error that ended the run before its last frame.
    breakdown: Option<SimulateError>,
}

impl Outcome {
    /// Returns the run of a scene with this recording.
    pub(crate) fn recorded<'a>(&self, scene: &'a Scene) -> Recorded<'a> {
        Recorded::of_parts(scene, Arc::clone(&self.recording), self.survey.clone())
    }
}

/// Simulates a scene, frame by frame. If the work is stopped, the outcome has the frames so far, at least one.
pub(crate) fn simulate(scene: &Scene, control: &Control) -> Result<Outcome, SimulateError> {
    control.begin(scene.simulation.timeline.frames());
    let moments = Moments::of(scene);
    // The first megabyte of a recording stays in memory, and the rest goes to a temporary file.
    let store = Cache::none().spill(scene, &moments);
    let mut recorder = Recorder::new(scene, moments, &PairCounter::default(), Box::new(store));
    let recorded = loop {
        match recorder.advance() {
            Ok(Some(_)) => control.step(),
            Ok(None) => break recorder.finish()?,
            Err(breakdown) => break recorder.finish_early(breakdown)?,
        }
        if control.is_stopped() {
            break recorder.finish()?;
        }
    };
    let (survey, breakdown) = (recorded.survey().clone(), recorded.breakdown().cloned());
    Ok(Outcome { recording: Arc::clone(recorded.recording()), survey, breakdown })
}

/// A simulated run with its recorded frames.
#[pyclass(frozen)]
pub(crate) struct Run {
    reading: Reading,
    scene: Arc<Scene>,
    outcome: Outcome,
    /// The times of the recorded frames, s.
    times: Py<PyAny>,
    /// Whether Ctrl-C has ended the run.
    interrupted: bool,
    /// The arrays that have been read, one for each quantity.
    arrays: Mutex<[Option<Py<PyAny>>; Quantity::COUNT]>,
}

impl Run {
    /// Simulates a scene. Ctrl-C ends the run, and the frames so far are kept.
    pub(crate) fn of(
        py: Python<'_>,
        (reading, scene): (Reading, &Arc<Scene>),
        progress: Option<&Bound<'_, PyAny>>,
        stop: Option<&Stop>,
    ) -> PyResult<Run> {
        let ended = background::run(py, progress, stop, |control| simulate(scene, control))?;
        let interrupted = ended.interrupt.is_some();
        if let Some(interrupt) = ended.interrupt
            && !interrupt.is_instance_of::<PyKeyboardInterrupt>(py)
        {
            return Err(interrupt);
        }
        let outcome = ended.result.map_err(|error| broken_down(py, &error))?;
        let timeline = &scene.simulation.timeline;
        let times = (0..outcome.recording.frames()).map(|frame| timeline.time(frame)).collect();
        let times = arrays::constant(PyArray1::from_vec(py, times).as_any())?;
        Ok(Run { reading, scene: Arc::clone(scene), outcome, times, interrupted, arrays: Mutex::default() })
    }

    /// Whether frames of the scene are missing: after Ctrl-C or a breakdown.
    fn is_partial(&self) -> bool {
        self.outcome.recording.frames() < self.scene.simulation.timeline.frames()
    }

    /// Returns an error if a moment was not recorded and cannot be simulated.
    fn check_time(&self, time: f64) -> PyResult<()> {
        let timeline = &self.scene.simulation.timeline;
        let mut times = (0..self.outcome.recording.frames()).map(|frame| timeline.time(frame));
        #[allow(clippy::float_cmp, reason = "a frame has exactly this time")]
        if self.is_partial() && !times.clone().any(|frame| frame == time) {
            let last = times.next_back().unwrap_or_default();
            let message = format!(
                "this run ended early, at {last} s, and has no moment {time} s: take one of `run.times`"
            );
            return Err(PyValueError::new_err(message));
        }
        if !(0.0..=timeline.latest()).contains(&time) {
            let message = format!(
                "there is no moment {time} s: the run of this scene goes from 0 to {} s",
                timeline.latest()
            );
            return Err(PyValueError::new_err(message));
        }
        Ok(())
    }
}

/// Returns the exception of a run that broke down.
pub(crate) fn broken_down(py: Python<'_>, error: &SimulateError) -> PyErr {
    errors::exception(py, Class::Run, &error.report())
}

#[pymethods]
impl Run {
    /// The times of the frames, s. Shape: (frames,).
    #[getter]
    fn times(&self, py: Python<'_>) -> Py<PyAny> {
        self.times.clone_ref(py)
    }

    /// The number of recorded frames.
    #[getter]
    fn frames(&self) -> usize {
        self.outcome.recording.frames()
    }

    /// Whether Ctrl-C has ended the run.
    #[getter]
    fn interrupted(&self) -> bool {
        self.interrupted
    }

    /// The largest energy error, relative to an energy of the scene.
    #[getter]
    fn drift(&self) -> f64 {
        self.outcome.survey.drift
    }

    /// The exception of the breakdown that ended the run early. `None` without a breakdown.
    #[getter]
    fn breakdown(&self, py: Python<'_>) -> Option<PyErr> {
        self.outcome.breakdown.as_ref().map(|error| broken_down(py, error))
    }

    /// The warnings about the motion, as a text and as JSON.
    #[getter]
    fn warnings(&self, py: Python<'_>) -> (String, String) {
        py.detach(|| {
            let diagnostics = jabuka::motion_warnings::all(&self.scene, &self.outcome.survey);
            errors::texts(&Report { sources: self.scene.warnings.sources.clone(), diagnostics })
        })
    }

    /// A quantity of all bodies, by its name. Shape: (bodies, frames, 3), or 4 for `orientation`. It is read once.
    fn array(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyAny>> {
        let quantity = Quantity::named(name)
            .ok_or_else(|| PyValueError::new_err(format!("there is no quantity `{name}`")))?;
        let known = || self.arrays.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(array) = &known()[quantity as usize] {
            return Ok(array.clone_ref(py));
        }
        let (recording, bodies) = (&self.outcome.recording, self.scene.bodies.len());
        let read =
            background::run(py, None, None, |control| arrays::read(recording, (bodies, quantity), control));
        let values = read?.whole()?.map_err(|error| broken_down(py, &error))?;
        let array = arrays::of_bodies(py, values, (bodies, recording.frames(), quantity))?;
        known()[quantity as usize] = Some(array.clone_ref(py));
        Ok(array)
    }

    /// The values of formulas of measures in each frame, and the unit of each, or `None` if jabuka does not know it.
    fn measure(&self, py: Python<'_>, formulas: Vec<String>) -> PyResult<Vec<(Py<PyAny>, Option<String>)>> {
        let measured = measures::of(py, (&self.reading, &self.scene), &self.outcome, formulas)?;
        let array = |(values, unit): (Vec<f64>, _)| {
            Ok((arrays::constant(PyArray1::from_vec(py, values).as_any())?, unit))
        };
        measured.into_iter().map(array).collect()
    }

    /// The impacts of the run.
    fn events(&self, py: Python<'_>) -> PyResult<Events> {
        events::of(py, &self.scene, &self.outcome)
    }

    /// Renders the image of a moment. Returns it as PNG, and the texts of warnings. `size` is width and height in pixels.
    #[allow(clippy::too_many_arguments, reason = "Python passes each by its name")]
    #[pyo3(signature = (time, *, size, quality, view, povray, progress))]
    fn still(
        &self,
        py: Python<'_>,
        time: f64,
        size: Option<[u32; 2]>,
        quality: &str,
        view: Option<String>,
        povray: Option<PathBuf>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(Vec<u8>, Vec<String>)> {
        self.check_time(time)?;
        let look = Look::new((size, quality), view, povray)?;
        pictures::still(py, (&self.reading, &self.scene, &self.outcome), time, &look, progress)
    }

    /// Returns the run as a page in HTML.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        if self.is_partial() {
            return Err(PyValueError::new_err("this run ended early, and a page holds whole runs"));
        }
        pictures::page(py, &self.scene, &self.outcome)
    }

    /// Renders a film into a file, and returns the texts of warnings. `rate` is its number of frames per second, and `every` renders every n-th frame of the run.
    #[pyo3(signature = (path, *, size, quality, view, povray, progress, rate, every, folder))]
    #[allow(clippy::too_many_arguments, reason = "Python passes each by its name")]
    fn film(
        &self,
        py: Python<'_>,
        path: PathBuf,
        size: Option<[u32; 2]>,
        quality: &str,
        view: Option<String>,
        povray: Option<PathBuf>,
        progress: Option<&Bound<'_, PyAny>>,
        rate: Option<f64>,
        every: usize,
        folder: Option<PathBuf>,
    ) -> PyResult<Vec<String>> {
        let look = Look::new((size, quality), view, povray)?;
        let film = Film { path, rate, every, folder };
        pictures::film(py, (&self.reading, &self.scene, &self.outcome), &film, &look, progress)
    }
}
