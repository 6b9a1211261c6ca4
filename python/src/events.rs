//! The impacts of a run.

use std::sync::Arc;

use jabuka::Scene;
use jabuka::simulate::SimulateError;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::background;
use crate::run::{Outcome, broken_down};

/// Impacts as columns: the names of the two bodies, and an array of the numbers. Shape: (impacts, 11). The numbers are the time, the point,
/// the normal, the impulse, and the lost energy.
pub(crate) type Events = (Vec<String>, Vec<String>, Py<PyAny>);

/// The numbers of an impact.
const NUMBERS_OF_IMPACT: usize = 11;

/// Returns the impacts of a run.
pub(crate) fn of(py: Python<'_>, scene: &Arc<Scene>, outcome: &Outcome) -> PyResult<Events> {
    if scene.simulation.contacts.is_none() {
        let message = "this scene has no impacts: `simulation.contacts = \"event-driven\"` finds them";
        return Err(PyValueError::new_err(message));
    }
    let recorded = outcome.recorded(scene);
    let read = background::run(py, None, None, |control| {
        let (mut names, mut numbers) = ([Vec::new(), Vec::new()], Vec::new());
        for impact in recorded.impacts().take_while(|_| !control.is_stopped()) {
            let impact = impact?;
            for (id, names) in impact.bodies.into_iter().zip(&mut names) {
                names.push(scene.bodies.get(id).map_or("ground", |body| &body.name).to_owned());
            }
            numbers.push(impact.time);
            for vector in [impact.place, impact.normal, impact.impulse] {
                numbers.extend(vector.to_array());
            }
            numbers.push(impact.energy);
        }
        Ok::<_, SimulateError>((names, numbers))
    });
    let ([first, second], numbers) = read?.whole()?.map_err(|error| broken_down(py, &error))?;
    let array = PyArray1::from_vec(py, numbers).reshape([first.len(), NUMBERS_OF_IMPACT])?;
    Ok((first, second, array.into_any().unbind()))
}
