//! Scenes: checked texts, with the values that Python has set.

use std::path::PathBuf;
use std::sync::Arc;

use jabuka::diagnostic::Report;
use jabuka::scene::{Options, Override};
use pyo3::prelude::*;

use crate::background::Stop;
use crate::errors::{self, Class};
use crate::run::Run;

/// Where the text of a scene comes from.
#[derive(Clone)]
pub(crate) enum Source {
    File(PathBuf),
    Text(String),
}

/// How a scene is read, so that it can be read again with other values.
#[derive(Clone)]
pub(crate) struct Reading {
    source: Source,
    options: Options,
}

impl Reading {
    /// Reads and checks the scene.
    pub(crate) fn scene(&self) -> Result<jabuka::Scene, Report> {
        match &self.source {
            Source::File(path) => jabuka::Scene::from_path_with(path, &self.options),
            Source::Text(text) => jabuka::Scene::parse_with(text, &self.options),
        }
    }

    /// Returns the same with further formulas of measures.
    pub(crate) fn with_measures(&self, measures: Vec<String>) -> Reading {
        Reading { options: Options { measures, ..self.options.clone() }, ..self.clone() }
    }

    /// Returns the same with one more value set.
    pub(crate) fn with_value(&self, setting: String) -> Reading {
        let mut reading = self.clone();
        reading.options.overrides.push(Override::new(setting));
        reading
    }

    /// The path of the scene's file. `None` if the scene is a text.
    pub(crate) fn path(&self) -> Option<&PathBuf> {
        match &self.source {
            Source::File(path) => Some(path),
            Source::Text(_) => None,
        }
    }

    /// Whether the scene is trusted.
    pub(crate) fn trust(&self) -> bool {
        self.options.trust
    }
}

/// A checked scene. It never changes.
#[pyclass(frozen)]
pub(crate) struct Scene {
    reading: Reading,
    scene: Arc<jabuka::Scene>,
}

impl Scene {
    fn read(py: Python<'_>, reading: Reading) -> PyResult<Scene> {
        let scene = py.detach(|| reading.scene());
        let scene = scene.map_err(|report| errors::exception(py, Class::Scene, &report))?;
        Ok(Scene { reading, scene: Arc::new(scene) })
    }
}

#[pymethods]
impl Scene {
    /// Reads the scene in a file. `settings` are texts `KEY=VALUE` that replace values of the file.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf, settings: Vec<String>, trust: bool) -> PyResult<Scene> {
        Scene::read(py, Reading { source: Source::File(path), options: options(settings, trust) })
    }

    /// Reads the text of a scene. `settings` are texts `KEY=VALUE` that replace values of the text.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: String, settings: Vec<String>, trust: bool) -> PyResult<Scene> {
        Scene::read(py, Reading { source: Source::Text(text), options: options(settings, trust) })
    }

    /// The name of the scene: its file name without the extension.
    #[getter]
    fn name(&self) -> &str {
        &self.scene.name
    }

    /// The names of the bodies, in the order of the scene.
    #[getter]
    fn bodies(&self) -> Vec<&str> {
        self.scene.bodies.iter().map(|body| &*body.name).collect()
    }

    /// The text of the scene's file, or the given text.
    #[getter]
    fn text(&self) -> &str {
        self.scene.warnings.sources.of_scene().map_or("", |source| &source.text)
    }

    /// The number of frames of the scene's run.
    #[getter]
    fn frames(&self) -> usize {
        self.scene.simulation.timeline.frames()
    }

    /// The warnings about the text of the scene, as a text and as JSON.
    #[getter]
    fn warnings(&self) -> (String, String) {
        errors::texts(&self.scene.warnings)
    }

    /// Simulates the scene.
    #[pyo3(signature = (progress=None, stop=None))]
    fn run(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        stop: Option<&Bound<'_, Stop>>,
    ) -> PyResult<Run> {
        Run::of(py, (self.reading.clone(), &self.scene), progress, stop.map(Bound::get))
    }
}

fn options(settings: Vec<String>, trust: bool) -> Options {
    let overrides = settings.into_iter().map(Override::new).collect();
    Options { overrides, trust, ..Options::default() }
}

/// Returns the known name that is most similar to a name. `None` if none is similar.
#[pyfunction]
pub(crate) fn nearest(name: &str, known: Vec<String>) -> Option<String> {
    jabuka::diagnostic::nearest(name, known.iter().map(String::as_str)).map(str::to_owned)
}
