//! Reads the unit that a scene asks for, such as `km/h` in `${ball.speed:km/h}`.

use std::ops::Range;

use super::Reader;
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::quoted;
use crate::scene::{AskedUnit, Measure, MeasureFormula, units};

impl Reader<'_, '_, '_> {
    /// Reads a formula with an optional unit behind a colon, such as `ball.speed:km/h`.
    pub(in crate::scene::check) fn formula_with_unit(
        &mut self,
        range: Range<usize>,
    ) -> Option<MeasureFormula> {
        let Some((formula, unit)) = self.text[range.clone()].rsplit_once(':') else {
            return self.formula(range);
        };
        let behind = range.start + formula.len() + 1;
        let mut read = self.formula(range.start..range.start + formula.len())?;
        let unit = behind + unit.len() - unit.trim_start().len()..behind + unit.trim_end().len();
        if unit.is_empty() {
            let error = Diagnostic::error(Code::LabelSyntax, "a unit is missing behind the colon");
            self.report(error, behind - 1..behind, "such as `ball.speed:km/h`");
            return None;
        }
        self.ask_unit(&mut read, unit)?;
        Some(read)
    }

    /// Converts the values of a formula to the unit in a byte range of the text. Reports a unit that does not fit.
    pub(in crate::scene::check) fn ask_unit(
        &mut self,
        formula: &mut MeasureFormula,
        range: Range<usize>,
    ) -> Option<()> {
        let symbol = &self.text[range.clone()];
        let Some(own) = formula.own_unit else {
            let message = "only a single measure has a unit that jabuka knows";
            let help = "write the factor into the formula, and the unit behind it";
            let error = Diagnostic::error(Code::LabelSyntax, message).help(help);
            self.report(error, range, "asked of a formula");
            return None;
        };
        if own.is_empty() {
            let error = Diagnostic::error(Code::LabelSyntax, "this measure is a pure number");
            self.report(error, range, "it has no unit");
            return None;
        }
        // The scene language writes degrees as a word.
        let of = if own == "°" { "degrees" } else { own };
        let Some(size) = units::factor(symbol, of) else {
            let message = if units::is_unit(symbol) {
                format!("`{symbol}` is no unit of this measure, which is in {own}")
            } else {
                format!("`{symbol}` is no unit that jabuka knows")
            };
            let usual = units::usual(of);
            // A single letter is near to every other one.
            let near = crate::diagnostic::nearest(symbol, usual.iter().copied()).filter(|_| symbol.len() > 1);
            let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(Code::LabelSyntax, message);
            self.report(error.help(format!("units that fit: {}", quoted(&usual))), range, &label);
            return None;
        };
        formula.asked_unit = Some(AskedUnit { symbol: symbol.into(), size });
        Some(())
    }

    /// Returns the own unit of a measure, and whether the measure is a count.
    pub(super) fn unit_of(&self, measure: Measure) -> (&'static str, bool) {
        match measure {
            Measure::Run(measure) => (measure.unit(), measure.is_count()),
            Measure::Body(_, measure) => (measure.unit(), measure.is_count()),
            Measure::Joint(joint, measure) => (measure.unit_of(&self.things.joints[joint].kind), false),
            Measure::Force(_, _, measure) => (measure.unit(), false),
            Measure::Impacts(_) => ("", true),
            Measure::FileColumn(_, column) => (self.context.file_columns.unit(column), false),
            Measure::Emitter(_, measure) => (measure.unit(), measure.is_count()),
            Measure::Distance(..) | Measure::Closest(_) | Measure::Length(_) => ("m", false),
            Measure::Angle(_) => ("°", false),
            Measure::Area(_) => ("m²", false),
            Measure::Aggregate(number) => {
                let aggregate = &self.context.aggregates[number];
                let is_count = aggregate.formula.is_count && aggregate.how != crate::scene::Aggregation::Mean;
                (aggregate.formula.own_unit.unwrap_or_default(), is_count)
            }
        }
    }
}
