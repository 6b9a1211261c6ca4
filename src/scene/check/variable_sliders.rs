//! Reads the sliders of `[variables]`.

use super::Context;
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::VariableSlider;
use crate::scene::grammar::scene::variable;
use crate::scene::view::View;

/// Reads the sliders of the scene's variables. Reports those whose range is empty or does not contain their value.
pub(super) fn read(root: &View<'_>, context: &mut Context<'_>) -> Vec<VariableSlider> {
    let mut sliders = Vec::new();
    for (name, view) in root.variables_with_sliders() {
        let keys = [&variable::VALUE, &variable::MIN, &variable::MAX];
        let [Some(value), Some(min), Some(max)] = keys.map(|key| view.get(key)) else { continue };
        let [Some(span), _, Some(max_span)] = keys.map(|key| view.span(key)) else { continue };
        let error = |message: String| Diagnostic::error(Code::OutOfRange, message);
        if min >= max {
            let error = error(format!("the slider of `{name}` has no range: `max` is not above `min`"));
            context.diagnostics.push(error.at(max_span, format!("`min` is {min}")));
        } else if !(min..=max).contains(&value) {
            let error = error(format!("the value of `{name}` is not within the range of its slider"));
            context.diagnostics.push(error.at(span, format!("from {min} to {max}, but this is {value}")));
        } else {
            sliders.push(VariableSlider {
                variable: name.to_owned(),
                title: view.get(&variable::TITLE).map(str::to_owned),
                unit: view.get(&variable::UNIT).map(str::to_owned),
                value,
                range: [min, max],
                step: view.get(&variable::STEP),
                span,
            });
        }
    }
    sliders
}
