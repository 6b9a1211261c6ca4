//! Makes the numbers and points of cameras and lights that may follow measures.

use std::sync::Arc;

use super::Context;
use super::marks::Known;
use super::measures::Reader;
use crate::scene::read::UncheckedVarying;
use crate::scene::timed::Timed;
use crate::scene::varying::{Varying, VaryingPoint};

impl Known<'_, '_> {
    /// Makes a number of what is written. `noun` is what it belongs to, for messages. A number with an error reads as NaN, so that no
    /// other error follows from it.
    pub(super) fn number(
        self,
        noun: &'static str,
        written: UncheckedVarying<'_>,
        context: &mut Context<'_>,
    ) -> Varying {
        match written {
            UncheckedVarying::Timed(timed) => Varying::Timed(timed),
            UncheckedVarying::Measured(text, span) => {
                let mut reader = Reader::new(noun, (text, span), self.root, None, self.things, context);
                let formula = reader.formula_with_unit(0..text.len());
                formula
                    .map_or(Varying::Timed(Timed::Constant(f64::NAN)), |it| Varying::Measured(Arc::new(it)))
            }
        }
    }

    /// Makes a point of what is written, as [`number`](Known::number).
    pub(super) fn point(
        self,
        noun: &'static str,
        written: [UncheckedVarying<'_>; 3],
        context: &mut Context<'_>,
    ) -> VaryingPoint {
        VaryingPoint::of(written.map(|coordinate| self.number(noun, coordinate, context)))
    }
}
