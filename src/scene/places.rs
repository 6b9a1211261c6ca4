//! Places in a scene's text that errors of a run point at.

use crate::diagnostic::Span;

/// The places at which a scene names its bodies, and others that errors of a run point at.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// The name of each body, in the order of [`Scene::bodies`](super::Scene::bodies).
    pub bodies: Vec<Span>,
    /// The name of each joint, in the order of [`Scene::joints`](super::Scene::joints).
    pub joints: Vec<Span>,
    /// The value of `simulation.contacts`, if there is one.
    pub contacts: Option<Span>,
    /// The table of the main camera, if there is one.
    pub camera: Option<Span>,
    /// The value of `povray.unit`, if there is one.
    pub unit: Option<Span>,
}
