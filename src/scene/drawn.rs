//! Numbers that every particle has of its own.

use std::sync::Arc;

use super::expression::{Draw, ExpressionError, Program};
use crate::dynamics;
use crate::random::Stream;

/// A number, or a formula with random numbers that are drawn anew each time.
#[derive(Clone, Debug)]
pub enum Drawn {
    /// It is always the same.
    Constant(f64),
    /// It follows from the time and from random numbers.
    Formula(Arc<DrawnFormula>),
}

/// A formula of the time `t` with `uniform` and `normal`, which give other numbers each time.
#[derive(Debug)]
pub struct DrawnFormula {
    text: Arc<str>,
    program: Program,
}

impl DrawnFormula {
    /// A formula whose only name that is not known yet is the time, in slot 0.
    pub(super) fn new(text: Arc<str>, program: Program) -> DrawnFormula {
        DrawnFormula { text, program }
    }

    /// The text as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Why a draw has no finite value; none where it has.
    pub(super) fn explain_non_finite(&self, t: f64, random: &mut Stream) -> Option<ExpressionError> {
        self.program.explain_non_finite(&self.inputs(t, random))
    }

    fn inputs(&self, t: f64, random: &mut Stream) -> Vec<f64> {
        let draw = |draw: &Draw| match draw {
            Draw::Uniform => random.uniform(),
            Draw::Normal => random.normal(),
        };
        std::iter::once(t).chain(self.program.resolved().draws().iter().map(draw)).collect()
    }
}

impl dynamics::Draw for DrawnFormula {
    fn draw(&self, t: f64, random: &mut Stream) -> f64 {
        self.program.eval(&self.inputs(t, random))
    }
}

impl Drawn {
    /// The same as the dynamics take it.
    pub fn shared(&self) -> Arc<dyn dynamics::Draw> {
        match self {
            Drawn::Constant(number) => Arc::new(*number),
            Drawn::Formula(formula) => formula.clone(),
        }
    }
}
