//! Numbers of emitters in scenes. If such a number is random, each particle draws its own sample.

use std::sync::Arc;

use super::expression::{Draw, ExpressionError, Program};
use crate::physics;
use crate::physics::random::Stream;

/// A constant number, or a formula with random numbers that is sampled anew for each particle.
#[derive(Clone, Debug)]
pub enum SampledNumber {
    /// A number that is the same for all particles.
    Constant(f64),
    /// A formula of the time and of random numbers.
    Formula(Arc<SampledFormula>),
}

/// A formula of the time `t` with the random functions `uniform` and `normal`. Each evaluation draws new random numbers.
#[derive(Debug)]
pub struct SampledFormula {
    text: Arc<str>,
    program: Program,
}

impl SampledFormula {
    /// Creates a formula from its text and its program. Input 0 of the program is the time. The other inputs are the random numbers.
    pub(super) fn new(text: Arc<str>, program: Program) -> SampledFormula {
        SampledFormula { text, program }
    }

    /// Returns the formula as written in the scene.
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

impl physics::Draw for SampledFormula {
    fn draw(&self, t: f64, random: &mut Stream) -> f64 {
        self.program.eval(&self.inputs(t, random))
    }
}

impl SampledNumber {
    /// Returns the number or formula as a shared trait object for the dynamics.
    pub fn shared(&self) -> Arc<dyn physics::Draw> {
        match self {
            SampledNumber::Constant(number) => Arc::new(*number),
            SampledNumber::Formula(formula) => formula.clone(),
        }
    }
}
