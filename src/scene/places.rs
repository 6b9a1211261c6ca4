//! Source spans in a scene's text, for errors that occur during a run.

use std::collections::BTreeMap;

use crate::diagnostic::Span;

/// The source spans of names and values in a scene's text, for errors that occur during a run.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// The source span of each body's name, in the order of [`Scene::bodies`](super::Scene::bodies).
    pub bodies: Vec<Span>,
    /// The source span of each joint's name, in the order of [`Scene::joints`](super::Scene::joints).
    pub joints: Vec<Span>,
    /// The source span of each force's name.
    pub forces: BTreeMap<String, Span>,
    /// The source span of the value of `simulation.contacts`. `None` if the scene does not set it.
    pub contacts: Option<Span>,
    /// The source span of the key `camera`. `None` if the scene has no `[camera]` table.
    pub camera: Option<Span>,
    /// The source spans of each plot, in the order of [`Scene::plots`](super::Scene::plots).
    pub plots: Vec<PlotSpans>,
    /// The source span of the value of `povray.unit`. `None` if the scene does not set it.
    pub unit: Option<Span>,
}

/// The source spans of a plot.
#[derive(Clone, Debug)]
pub struct PlotSpans {
    /// The source span of the plot's name.
    pub name: Span,
    /// The source span of each curve's formula.
    pub curves: Vec<Span>,
    /// The source span of the value of `range`. `None` if the scene does not set it.
    pub range: Option<Span>,
    /// The source span of the value of `x_range`. `None` if the scene does not set it.
    pub x_range: Option<Span>,
}
