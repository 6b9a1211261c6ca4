//! Detects angles in formulas that are probably in the wrong unit. Functions take radians, but the orientations of bodies are in degrees.

use std::ops::Range;

use super::Formula;
use super::parser::Subexpression;

/// The functions that return an angle in radians.
const GIVES_RADIANS: [&str; 5] = ["asin", "acos", "atan", "atan2", "rad"];

impl Formula {
    /// Finds an argument of `sin`, `cos` or `tan` that is probably in degrees, as in `cos(45)`. Returns the argument's byte range. `value`
    /// returns the value of a variable.
    pub(in crate::scene) fn degrees_for_radians(
        &self,
        value: impl Fn(&str) -> Option<f64>,
    ) -> Option<Range<usize>> {
        self.nodes.iter().find_map(|node| {
            let Subexpression::Call(function, arguments) = &node.part else { return None };
            let [argument] = **arguments else { return None };
            let argument = &self.nodes[argument];
            let angle = match &argument.part {
                Subexpression::Number(number) => *number,
                Subexpression::Name(range) => value(&self.text()[range.clone()])?,
                _ => return None,
            };
            // Multiples of 5 from 15 to 720 are common angles in degrees, and unlikely angles in radians.
            let is_usual = angle.abs() >= 15.0 && angle % 5.0 == 0.0 && angle.abs() <= 720.0;
            (matches!(function.name, "sin" | "cos" | "tan") && is_usual).then(|| argument.range.clone())
        })
    }

    /// Returns true if the value of the formula is probably an angle in radians: the formula uses `pi`, `tau` or a function that returns
    /// radians, and does not use `deg`.
    pub(in crate::scene) fn is_in_radians(&self) -> bool {
        let calls = |names: &[&str]| {
            self.nodes
                .iter()
                .any(|node| matches!(&node.part, Subexpression::Call(function, _) if names.contains(&function.name)))
        };
        // The `pi` in `sin(2*pi*t)` belongs to the argument of the sine. It says nothing about the unit of the result.
        let has_sine = calls(&["sin", "cos", "tan", "sinh", "cosh", "tanh"]);
        let has_pi = self.names().any(|(name, _)| matches!(name, "pi" | "tau"));
        let divides_by_it = self.text().contains("/pi") || self.text().contains("/ pi");
        !calls(&["deg"]) && !has_sine && !divides_by_it && (has_pi || calls(&GIVES_RADIANS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_and_radians_are_told_apart_where_they_can_be() {
        let value = |name: &str| (name == "theta").then_some(30.0);
        for (text, angle) in [
            ("cos(45)", Some(4..6)),
            ("2*sin(theta) + 1", Some(6..11)),
            ("cos(rad(45))", None),
            ("cos(0.5)", None),
            ("sin(10*t)", None),
            ("tan(45 + x)", None),
        ] {
            assert_eq!(Formula::parse(text).unwrap().degrees_for_radians(value), angle, "{text}");
        }
        for (text, is_in_radians) in [
            ("pi/4", true),
            ("tau*t", true),
            ("atan2(1, 2)", true),
            ("deg(pi/4)", false),
            ("180*atan(2)/pi", false),
            ("30*sin(2*pi*t)", false),
            ("45", false),
        ] {
            assert_eq!(Formula::parse(text).unwrap().is_in_radians(), is_in_radians, "{text}");
        }
    }
}
