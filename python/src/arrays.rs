//! The motion of all bodies as arrays of numpy, whose memory belongs to the values that Rust has read.

use std::sync::Arc;

use jabuka::physics::BodySnapshot;
use jabuka::simulate::{Recording, SimulateError};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::background::Control;

/// A quantity of a body that arrays hold.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Location,
    Velocity,
    Orientation,
    AngularVelocity,
    Force,
}

impl Quantity {
    /// The number of quantities.
    pub(crate) const COUNT: usize = 5;

    /// Finds a quantity by its name in Python.
    pub(crate) fn named(name: &str) -> Option<Quantity> {
        Some(match name {
            "location" => Quantity::Location,
            "velocity" => Quantity::Velocity,
            "orientation" => Quantity::Orientation,
            "angular_velocity" => Quantity::AngularVelocity,
            "force" => Quantity::Force,
            _ => return None,
        })
    }

    /// The number of components.
    fn components(self) -> usize {
        if self == Quantity::Orientation { 4 } else { 3 }
    }

    fn write(self, body: &BodySnapshot, into: &mut [f64]) {
        match self {
            Quantity::Location => into.copy_from_slice(&body.location.to_array()),
            Quantity::Velocity => into.copy_from_slice(&body.velocity.to_array()),
            Quantity::Orientation => into.copy_from_slice(&body.orientation.to_array()),
            Quantity::AngularVelocity => into.copy_from_slice(&body.angular_velocity.to_array()),
            Quantity::Force => into.copy_from_slice(&body.force.to_array()),
        }
    }
}

/// Reads a quantity of all bodies in all frames, ordered by body, frame and component. NaN while a body is absent. Ends early if the work is
/// stopped.
pub(crate) fn read(
    recording: &Arc<Recording>,
    (bodies, quantity): (usize, Quantity),
    control: &Control,
) -> Result<Vec<f64>, SimulateError> {
    let (frames, components) = (recording.frames(), quantity.components());
    let mut values = vec![f64::NAN; bodies * frames * components];
    let mut reader = recording.read();
    for frame in 0..frames {
        if control.is_stopped() {
            break;
        }
        for body in &reader.frame(frame)?.bodies {
            let start = (body.id * frames + frame) * components;
            quantity.write(body, &mut values[start..start + components]);
        }
    }
    Ok(values)
}

/// Returns values in this order as a read-only array. Shape: (bodies, frames, components).
pub(crate) fn of_bodies(
    py: Python<'_>,
    values: Vec<f64>,
    (bodies, frames, quantity): (usize, usize, Quantity),
) -> PyResult<Py<PyAny>> {
    let array = PyArray1::from_vec(py, values).reshape([bodies, frames, quantity.components()])?;
    constant(array.as_any())
}

/// Makes an array read-only, since all who ask for it share it.
pub(crate) fn constant(array: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    let flags = PyDict::new(array.py());
    flags.set_item("write", false)?;
    array.call_method("setflags", (), Some(&flags))?;
    Ok(array.clone().unbind())
}
