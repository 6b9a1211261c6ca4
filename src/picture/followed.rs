//! The values of measures that cameras, lights and SDL follow.

use std::sync::Arc;

use crate::scene::{MeasureFormula, Scene};
use crate::simulate::{Frame, Measures, MomentState, Survey};

/// Gives the values of formulas of measures, in any frame and at the start of the run.
#[derive(Clone, Debug)]
pub(super) struct FollowedValues {
    measures: Arc<Measures>,
    /// The first frame. `None` if the survey keeps no sample of the frames.
    first: Option<Arc<Frame>>,
}

impl FollowedValues {
    /// Creates the values of a run.
    pub(super) fn new(scene: &Scene, survey: &Survey) -> FollowedValues {
        FollowedValues {
            measures: Arc::new(Measures::new(scene)),
            first: survey.samples.first().cloned().map(Arc::new),
        }
    }

    /// The measures of the scene.
    pub(super) fn measures(&self) -> &Arc<Measures> {
        &self.measures
    }

    /// The values in a frame. NaN if a measure is unknown then, such as the speed of an absent body.
    pub(super) fn at<'a>(&'a self, frame: &'a Frame) -> impl Fn(&MeasureFormula) -> f64 + 'a {
        let moment = MomentState::now(frame);
        move |formula| self.measures.value(formula, &moment)
    }

    /// The values in the first frame. An unknown value is 0, so that the plan has numbers; the script of that frame reports it.
    pub(super) fn at_start(&self) -> impl Fn(&MeasureFormula) -> f64 + '_ {
        let first = self.first.as_deref().map(|first| self.at(first));
        move |formula| first.as_ref().map(|first| first(formula)).filter(|it| it.is_finite()).unwrap_or(0.0)
    }
}
