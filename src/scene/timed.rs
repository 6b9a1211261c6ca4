//! Numbers that may change with time.

use std::sync::Arc;

use glam::DVec3;

use crate::dynamics::{Motion, Track};

use super::expression::{ExpressionError, Program, Resolved, Steps};

/// A number, or a formula of the time.
#[derive(Clone, Debug)]
pub enum Timed {
    /// It is always the same.
    Constant(f64),
    /// It changes.
    Formula(Arc<TimeFormula>),
}

/// A formula of the time `t`, and its first two derivatives.
pub struct TimeFormula {
    /// What is written.
    pub text: Arc<str>,
    value: Program,
    rate: Steps,
    curvature: Steps,
    /// How many operations the three have together.
    pub(super) operations: u64,
}

impl std::fmt::Debug for TimeFormula {
    // The derivatives follow from the value.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("TimeFormula").field(&self.value).finish()
    }
}

/// Three numbers that may change with time.
#[derive(Clone, Debug)]
pub enum TimedVector {
    /// Each by itself.
    Each([Timed; 3]),
    /// The place on a track.
    Track(Arc<Track>),
}

impl TimeFormula {
    /// Compiles a formula whose only name that is not known yet is the time, in slot 0.
    ///
    /// # Errors
    /// Where it is nested too deeply.
    pub(super) fn new(text: Arc<str>, resolved: Resolved) -> Result<TimeFormula, ExpressionError> {
        /// What a formula of a thousand letters may come to, and no more than is compiled at once.
        const MOST: u64 = 100_000;
        let rate = resolved.derivative(0);
        if rate.operations() > MOST || rate.derivative(0).operations() > MOST {
            let range = 0..text.len();
            let message = "the derivatives of this formula are too long, by which velocities follow from it";
            return Err(super::expression::too_intricate(range, message));
        }
        let curvature = rate.derivative(0);
        let operations = [&resolved, &rate, &curvature].into_iter().map(Resolved::operations).sum();
        Ok(TimeFormula {
            text,
            operations,
            value: resolved.compile()?,
            rate: rate.compile()?.into_steps(),
            curvature: curvature.compile()?.into_steps(),
        })
    }

    /// Why it has no finite value at a time (s); none where it has.
    pub fn explain_non_finite(&self, t: f64) -> Option<ExpressionError> {
        self.value.explain_non_finite(&[t])
    }
}

impl Timed {
    /// The value at a time, s; it may not be finite.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Timed::Constant(value) => *value,
            Timed::Formula(formula) => formula.value.eval(&[t]),
        }
    }

    /// The derivative at a time, per second.
    pub fn rate(&self, t: f64) -> f64 {
        match self {
            Timed::Constant(_) => 0.0,
            Timed::Formula(formula) => formula.rate.eval(&[t]),
        }
    }

    /// The second derivative at a time, per second squared.
    pub fn curvature(&self, t: f64) -> f64 {
        match self {
            Timed::Constant(_) => 0.0,
            Timed::Formula(formula) => formula.curvature.eval(&[t]),
        }
    }

    /// Whether it changes with time.
    pub fn changes(&self) -> bool {
        matches!(self, Timed::Formula(_))
    }
}

impl TimedVector {
    /// The value at a time, s.
    pub fn at(&self, t: f64) -> DVec3 {
        match self {
            TimedVector::Each(each) => DVec3::from_array([0, 1, 2].map(|i: usize| each[i].at(t))),
            TimedVector::Track(track) => track.at(t).location,
        }
    }

    /// The derivative at a time, per second.
    pub fn rate(&self, t: f64) -> DVec3 {
        match self {
            TimedVector::Each(each) => DVec3::from_array([0, 1, 2].map(|i: usize| each[i].rate(t))),
            TimedVector::Track(track) => track.at(t).velocity,
        }
    }

    /// The second derivative at a time, per second squared.
    pub fn curvature(&self, t: f64) -> DVec3 {
        match self {
            TimedVector::Each(each) => DVec3::from_array([0, 1, 2].map(|i: usize| each[i].curvature(t))),
            TimedVector::Track(track) => track.at(t).acceleration,
        }
    }

    /// Whether any of it changes with time.
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
