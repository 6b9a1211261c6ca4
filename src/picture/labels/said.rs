//! Fills current values into the texts of labels.

use super::super::number;
use super::Labels;
use crate::scene::{Format, MeasureFormula, Piece};
use crate::simulate::MomentState;

impl Labels {
    /// Writes a number of a text with the decimal sign of the scene.
    pub(in crate::picture) fn with_sign(&self, number: String) -> String {
        number::with_sign(number, self.sign)
    }

    /// A text with its values at a moment.
    pub(in crate::picture) fn said(&self, text: &[Piece], moment: &MomentState<'_>) -> String {
        let mut said = String::new();
        for piece in text {
            match piece {
                Piece::Words(words) => said.push_str(words),
                Piece::Value { formula, format } => {
                    let number = written(self.measures.value(formula, moment), *format);
                    said.push_str(&number::with_sign(number, self.sign));
                    said.push_str(&unit(formula));
                }
            }
        }
        said
    }
}

/// A sample of a piece of a label with the largest expected length, in which numbers have up to four digits before the decimal point. A value
/// is one word, with its unit.
pub(super) fn sample(piece: &Piece) -> String {
    let number = |format: &Format| match format {
        Format::Short => "0.0000".to_owned(),
        Format::Decimals(decimals) => "0".repeat(decimals + 3),
        Format::Scientific(decimals) => "0".repeat(decimals + 5),
    };
    match piece {
        Piece::Words(words) => words.clone(),
        Piece::Value { formula, format } => number(format) + &unit(formula).replace(' ', "\u{a0}"),
    }
}

/// The unit behind a number, if the scene asks for one. A sign such as `°` stands at the number, and letters stand apart.
fn unit(formula: &MeasureFormula) -> String {
    formula.asked_unit.as_ref().map_or(String::new(), |asked| match &*asked.symbol {
        "°" => "°".to_owned(),
        symbol => format!(" {symbol}"),
    })
}

/// Formats a number for a label. Non-finite numbers become `?`.
fn written(value: f64, format: Format) -> String {
    if !value.is_finite() {
        return "?".to_owned();
    }
    let text = match format {
        Format::Short => short_of(value),
        // Larger numbers would have too many digits to be read easily, and some renderers accept short texts only.
        Format::Decimals(decimals) if value.abs() < 1e15 => format!("{value:.decimals$}"),
        Format::Decimals(decimals) | Format::Scientific(decimals) => format!("{value:.decimals$e}"),
    };
    let text = number::typeset(&text);
    // A result that is rounded to zero gets no minus sign.
    match text.strip_prefix('−') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}

fn short_of(value: f64) -> String {
    let mut out = String::new();
    number::write(&mut out, value, 3);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn numbers_are_written_as_asked_for() {
        for (value, format, expected) in [
            (0.5, Format::Decimals(2), "0.50"),
            (-1.25, Format::Decimals(1), "−1.2"),
            (-0.001, Format::Decimals(2), "0.00"),
            (12345.678, Format::Short, "12300"),
            (-0.012345, Format::Short, "−0.0123"),
            (1.5e-9, Format::Scientific(1), "1.5·10⁻⁹"),
            (3.917, Format::Scientific(2), "3.92"),
            (9.999, Format::Scientific(2), "1.00·10¹"),
            (-0.0, Format::Scientific(1), "0.0"),
            (1e300, Format::Decimals(1), "1.0·10³⁰⁰"),
            (f64::NAN, Format::Short, "?"),
        ] {
            assert_eq!(written(value, format), expected);
        }
    }

    /// A body that a motion guides has a kinetic energy, too: with 2 kg at 6 m/s, it is 36 J, for the body and for the scene.
    #[test]
    fn the_kinetic_energy_of_the_scene_contains_that_of_given_motions() {
        let scene = Scene::parse(
            "
            simulation = { duration = 1, gravity = [0, -10, 0] }
            [body.guided]
            shape.sphere.radius = 0.1
            mass = 2
            motion.formula.location = ['3 * cos(2 * t)', '3 * sin(2 * t)', 0]
            [body.thrown]
            shape.sphere.radius = 0.1
            mass = 2
            velocity = [3, 0, 0]
            [label.measured]
            text = '${guided.kinetic:.6} ${kinetic_energy:.6} ${energy:.6}'
            ",
        )
        .unwrap();
        let measures = std::sync::Arc::new(crate::simulate::Measures::new(&scene));
        let labels = Labels::new(&scene, crate::scene::Color::WHITE, std::iter::empty(), measures);
        let frame = crate::simulate::Frames::new(&scene).next().unwrap().unwrap();
        let said = labels.said(&scene.labels[0].text, &MomentState::now(&frame));
        assert_eq!(said, "36.000000 45.000000 45.000000");
    }
}
