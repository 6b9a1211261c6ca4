//! Places in a scene's text, for the errors of a run.

use crate::diagnostic::Span;

/// The places of names and values in a scene's text, for the errors of a run.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// The name of each body, in the order of [`Scene::bodies`](super::Scene::bodies).
    pub bodies: Vec<Span>,
    /// The name of each joint, in the order of [`Scene::joints`](super::Scene::joints).
    pub joints: Vec<Span>,
    /// The value of `simulation.contacts`. `None` if the scene does not set it.
    pub contacts: Option<Span>,
    /// The table of the main camera. `None` if the scene has none.
    pub camera: Option<Span>,
    /// The value of `povray.unit`. `None` if the scene does not set it.
    pub unit: Option<Span>,
}
