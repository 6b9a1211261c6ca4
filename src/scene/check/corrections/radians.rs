//! Recognizes angles in radians where the scene language has degrees.

use std::f64::consts::{PI, TAU};

use super::super::Context;
use super::text::raw;
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::{KeySpec, TableSpec};
use crate::scene::source::{Node, Value};
use crate::scene::units;

/// The largest angle of view that is taken for radians, degrees. It is 92 degrees in radians.
const LARGEST_VIEW: f64 = 1.6;

/// Warns of numbers that are probably radians, in a key that is in degrees: rounded fractions of π, and an angle of view that only a
/// telescope has. Formulas are checked where they are evaluated.
pub(in crate::scene::check) fn radians(
    node: &Node,
    key: &KeySpec,
    spec: &TableSpec,
    context: &mut Context<'_>,
) {
    if key.unit != "degrees" {
        return;
    }
    if let Value::Array(items) = &node.value {
        items.iter().for_each(|item| radians(item, key, spec, context));
        return;
    }
    let text = raw(node.span, context);
    let (Some(number), Ok(_)) = (node.as_number(), text.parse::<f64>()) else { return };
    let degrees = match twelfths(text, number) {
        Some(twelfths) => 15.0 * twelfths,
        None if spec.noun == "the camera"
            && key.name == "angle"
            && number > 0.0
            && number <= LARGEST_VIEW =>
        {
            number.to_degrees().round()
        }
        None => return,
    };
    let warning = Diagnostic::warning(Code::AngleUnit, "this angle is in degrees");
    let degrees = units::written(degrees);
    let warning =
        warning.at(node.span, format!("did you mean `{degrees}`? {text} degrees are a small angle"));
    context.diagnostics.push(warning.fix(node.span, degrees).fix_is_said());
}

/// Returns the number of twelfths of π that a number of at least three digits is, rounded to its last digit. `None` for other numbers.
fn twelfths(text: &str, number: f64) -> Option<f64> {
    let decimals = text.split_once('.').map(|(_, decimals)| decimals.len())?;
    let digits = text.bytes().filter(u8::is_ascii_digit).count() - usize::from(number.abs() < 1.0);
    let is_plain = text.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+'));
    let twelfths = (number / (PI / 12.0)).round();
    let precision = libm::pow(0.1, f64::from(u32::try_from(decimals).ok()?));
    let is_near = (number - twelfths * PI / 12.0).abs() <= 0.51 * precision.max(1e-12);
    // A number without a fraction of its own, such as 0.262, may also be a small angle in degrees.
    let is_usual = twelfths % 2.0 == 0.0 || twelfths % 3.0 == 0.0;
    (is_plain && digits >= 3 && is_near && is_usual && twelfths != 0.0 && number.abs() <= TAU + 1e-2)
        .then_some(twelfths)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_fractions_of_pi_are_told_from_degrees() {
        for (text, degrees) in [
            ("1.5708", Some(90.0)),
            ("1.57", Some(90.0)),
            ("-0.785", Some(-45.0)),
            ("3.14159265358979", Some(180.0)),
            ("6.283", Some(360.0)),
            ("0.524", Some(30.0)),
            ("1.6", None),
            ("1.5", None),
            ("0.79", None),
            ("90", None),
            ("15.708", None),
            ("1.571", Some(90.0)),
            ("1.572", None),
        ] {
            assert_eq!(twelfths(text, text.parse().unwrap()).map(|it| 15.0 * it), degrees, "{text}");
        }
    }
}
