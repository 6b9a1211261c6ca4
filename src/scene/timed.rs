//! Numbers and vectors that may change with time.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::expression::{Code, Constants, ExpressionError, Resolved};
use crate::diagnostic::Span;
use crate::physics::{Motion, Track};

/// A constant number, or a formula of the time.
#[derive(Clone, Debug)]
pub enum Timed {
    /// A number that does not change.
    Constant(f64),
    /// A formula of the time `t`.
    Formula(Arc<TimeFormula>),
}

/// A formula of the time `t`, with its first and second derivatives.
///
/// The formulas of a body's copies differ only in their constants, so the copies share the compiled programs.
pub struct TimeFormula {
    programs: Arc<Programs>,
    written: Arc<Written>,
    /// The constants of the formula. They are inputs of the programs, after the time.
    constants: Box<[f64]>,
}

impl std::fmt::Debug for TimeFormula {
    // Omit the derivatives, because they follow from the formula.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let formula = self.programs.formula.at(&self.written.ranges);
        f.debug_tuple("TimeFormula").field(&formula).field(&self.constants).finish()
    }
}

/// The compiled programs of a formula and its first and second derivatives. Their inputs are the time and the constants of the formula.
struct Programs {
    value: Code,
    rate: Code,
    curvature: Code,
    /// The formula as a tree, from which errors about non-finite values are explained.
    formula: Resolved,
    /// The total number of operations in the programs for the value and its two derivatives.
    operations: u64,
}

/// The text of a formula as written in the scene.
#[derive(Debug, PartialEq)]
struct Written {
    text: Arc<str>,
    /// The byte range in the text of each subexpression: its start and its end.
    ranges: Box<[[u32; 2]]>,
}

/// All formulas of the time that have been read. Equal formulas share memory.
#[derive(Default)]
pub(super) struct Formulas {
    /// The compiled programs, by the encodings of their formulas.
    programs: HashMap<Vec<u64>, Arc<Programs>>,
    /// The formula that was last read at each source span. All copies of a body read their formulas at the same span.
    last: HashMap<Span, Arc<TimeFormula>>,
}

impl Formulas {
    /// Compiles a formula and its first two derivatives. The time is the formula's only input, in slot 0.
    ///
    /// # Errors
    /// If the formula is nested too deeply, or its derivatives are too long.
    pub(super) fn read(
        &mut self,
        text: Arc<str>,
        span: Span,
        resolved: &Resolved,
    ) -> Result<Arc<TimeFormula>, ExpressionError> {
        /// The maximum number of operations in a derivative. This is enough for formulas of up to a thousand characters.
        const MAX_DERIVATIVE_OPERATIONS: u64 = 100_000;
        let rate = resolved.derivative(0);
        let curvature =
            if rate.operations() > MAX_DERIVATIVE_OPERATIONS { None } else { Some(rate.derivative(0)) };
        let Some(curvature) =
            curvature.filter(|curvature| curvature.operations() <= MAX_DERIVATIVE_OPERATIONS)
        else {
            let range = 0..text.len();
            let message = "the derivatives of this formula are too long, by which velocities follow from it";
            return Err(super::expression::too_intricate(range, message));
        };
        let operations = [resolved, &rate, &curvature].into_iter().map(Resolved::operations).sum();
        let mut constants = Constants::default();
        let [value, rate, curvature] =
            [resolved, &rate, &curvature].map(|formula| formula.lifted(&mut constants));
        let mut words = Vec::new();
        [&value, &rate, &curvature].into_iter().for_each(|formula| formula.spell(&mut words));
        let written = Written { text, ranges: value.ranges() };
        let programs = match self.programs.get(&words) {
            Some(programs) => programs.clone(),
            None => {
                let curvature = curvature.code()?;
                let (rate, code) = (rate.code()?, value.code()?);
                let programs = Programs { value: code, rate, curvature, formula: value, operations };
                self.programs.entry(words).or_insert(Arc::new(programs)).clone()
            }
        };
        let constants = constants.into_values();
        let last = self.last.get(&span).filter(|last| *last.written == written);
        let is_same = |last: &&Arc<TimeFormula>| {
            Arc::ptr_eq(&last.programs, &programs) && bits(&last.constants).eq(bits(&constants))
        };
        if let Some(same) = last.filter(is_same) {
            return Ok(same.clone());
        }
        let written = last.map_or_else(|| Arc::new(written), |last| last.written.clone());
        let formula = Arc::new(TimeFormula { programs, written, constants });
        self.last.insert(span, formula.clone());
        Ok(formula)
    }
}

fn bits(numbers: &[f64]) -> impl Iterator<Item = u64> {
    numbers.iter().map(|number| number.to_bits())
}

impl TimeFormula {
    /// Returns the formula as written in the scene.
    pub fn text(&self) -> &str {
        &self.written.text
    }

    /// Returns the total number of operations of the formula and its first two derivatives.
    pub(super) fn operations(&self) -> u64 {
        self.programs.operations
    }

    /// Explains why the formula has no finite value at time `t` (s). `None` if the value is finite.
    pub fn explain_non_finite(&self, t: f64) -> Option<ExpressionError> {
        if self.value(t).is_finite() {
            return None;
        }
        let inputs: Vec<f64> = [t].into_iter().chain(self.constants.iter().copied()).collect();
        self.programs.formula.at(&self.written.ranges).explain_non_finite(&inputs)
    }

    fn value(&self, t: f64) -> f64 {
        self.programs.value.eval(t, &self.constants)
    }
}

impl Timed {
    /// Returns the number at time `t` (s). The result may be non-finite.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Timed::Constant(value) => *value,
            Timed::Formula(formula) => formula.value(t),
        }
    }

    /// Returns the number's first derivative with respect to time, at time `t` (s).
    pub fn rate(&self, t: f64) -> f64 {
        match self {
            Timed::Constant(_) => 0.0,
            Timed::Formula(formula) => formula.programs.rate.eval(t, &formula.constants),
        }
    }

    /// Returns the number's second derivative with respect to time, at time `t` (s).
    pub fn curvature(&self, t: f64) -> f64 {
        match self {
            Timed::Constant(_) => 0.0,
            Timed::Formula(formula) => formula.programs.curvature.eval(t, &formula.constants),
        }
    }

    /// Returns whether the number is a formula, so that it may change with time.
    pub fn changes(&self) -> bool {
        matches!(self, Timed::Formula(_))
    }
}

/// A vector of three components that may change with time.
#[derive(Clone, Debug)]
pub enum TimedVector {
    /// A number or a formula for each component.
    Each([Timed; 3]),
    /// The location on a track of keyframes.
    Track(Arc<Track>),
}

impl TimedVector {
    /// Returns the vector at time `t` (s).
    pub fn at(&self, t: f64) -> DVec3 {
        match self {
            TimedVector::Each(each) => DVec3::from_array([0, 1, 2].map(|i: usize| each[i].at(t))),
            TimedVector::Track(track) => track.at(t).location,
        }
    }

    /// Returns the vector's first derivative with respect to time, at time `t` (s).
    pub fn rate(&self, t: f64) -> DVec3 {
        match self {
            TimedVector::Each(each) => DVec3::from_array([0, 1, 2].map(|i: usize| each[i].rate(t))),
            TimedVector::Track(track) => track.at(t).velocity,
        }
    }

    /// Returns the vector's second derivative with respect to time, at time `t` (s).
    pub fn curvature(&self, t: f64) -> DVec3 {
        match self {
            TimedVector::Each(each) => DVec3::from_array([0, 1, 2].map(|i: usize| each[i].curvature(t))),
            TimedVector::Track(track) => track.at(t).acceleration,
        }
    }

    /// Returns whether any component of the vector may change with time.
    pub fn changes(&self) -> bool {
        match self {
            TimedVector::Each(each) => each.iter().any(Timed::changes),
            TimedVector::Track(_) => true,
        }
    }
}

impl From<DVec3> for TimedVector {
    fn from(vector: DVec3) -> TimedVector {
        TimedVector::Each(vector.to_array().map(Timed::Constant))
    }
}
