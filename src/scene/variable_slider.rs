//! The sliders of variables, with which a page changes a scene.

use crate::diagnostic::Span;

/// The slider of a variable.
#[derive(Clone, Debug, PartialEq)]
pub struct VariableSlider {
    /// The name of the variable.
    pub variable: String,
    /// What stands beside the slider. `None` for the name of the variable.
    pub title: Option<String>,
    /// The unit that stands beside the value. `None` without a unit.
    pub unit: Option<String>,
    /// The value of the variable.
    pub value: f64,
    /// The lowest and the highest value.
    pub range: [f64; 2],
    /// The distance between two values. `None` for a round part of the range.
    pub step: Option<f64>,
    /// Where the value stands in the text of the scene.
    pub span: Span,
}
