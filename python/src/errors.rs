//! Converts errors of the library to Python exceptions.

use jabuka::diagnostic::Report;
use pyo3::prelude::*;

/// The exception classes of `jabuka.errors` that errors of the library become.
#[derive(Clone, Copy)]
pub(crate) enum Class {
    /// The text of a scene has mistakes.
    Scene,
    /// A run broke down.
    Run,
    /// An image or a film could not be made.
    Render,
}

impl Class {
    fn name(self) -> &'static str {
        match self {
            Class::Scene => "SceneError",
            Class::Run => "RunError",
            Class::Render => "RenderError",
        }
    }
}

/// Returns the diagnostics of a report as its text and as JSON, from which Python makes its own objects.
pub(crate) fn texts(report: &Report) -> (String, String) {
    // Serialization fails only for maps whose keys are no strings. Diagnostics contain no maps.
    let json = serde_json::to_string(&report.to_json()).unwrap_or_else(|_| "[]".to_owned());
    (report.to_text(false), json)
}

/// Returns the exception of a report.
pub(crate) fn exception(py: Python<'_>, class: Class, report: &Report) -> PyErr {
    let (text, json) = texts(report);
    let made = py
        .import("jabuka.errors")
        .and_then(|errors| errors.getattr(class.name())?.call_method1("_of", (text, json)));
    made.map_or_else(|error| error, PyErr::from_value)
}
