//! Numbers that each particle draws for itself.

use std::sync::Arc;

use super::expression::{Draw, ExpressionError, Program};
use crate::dynamics;
use crate::random::Stream;

/// A number, or a formula whose random numbers are drawn anew for each particle.
#[derive(Clone, Debug)]
pub enum Drawn {
    /// The same number for all particles.
    Constant(f64),
    /// A formula of the time and of random numbers.
    Formula(Arc<DrawnFormula>),
}

/// A formula of the time `t`, with `uniform` and `normal`. Each evaluation draws new random numbers.
#[derive(Debug)]
pub struct DrawnFormula {
    text: Arc<str>,
    program: Program,
}

impl DrawnFormula {
    /// Creates a formula. The time is its only unresolved name, in slot 0.
    pub(super) fn new(text: Arc<str>, program: Program) -> DrawnFormula {
        DrawnFormula { text, program }
    }

    /// The formula as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Explains why the formula has no finite value at time `t`, s. `None` if the value is finite.
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
    /// The number or formula in the form that the dynamics use.
    pub fn shared(&self) -> Arc<dyn dynamics::Draw> {
        match self {
            Drawn::Constant(number) => Arc::new(*number),
            Drawn::Formula(formula) => formula.clone(),
        }
    }
}
