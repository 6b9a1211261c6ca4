//! Converts a simulation error into a diagnostic.

use super::{SimulateError, Why};
use crate::diagnostic::{Code, Diagnostic, Report, Sources};
use crate::physics::Motor;
use crate::scene::Scene;

impl SimulateError {
    /// The diagnostic code of the error.
    pub fn code(&self) -> Code {
        match self {
            SimulateError::Diverged(_) => Code::Diverged,
            SimulateError::Undefined(undefined) => undefined.why.0,
            SimulateError::Broken(broken) if broken.time == 0.0 => Code::JointApart,
            SimulateError::Broken(_) => Code::BrokenJoint,
            SimulateError::Stuck(stuck) => match stuck.why {
                Why::Overlaps(_) => Code::OverlapAtStart,
                Why::Jams => Code::Jammed,
                Why::AddsEnergy(_) => Code::EnergyAdded,
            },
            SimulateError::Stalled(_) => Code::Stalled,
            SimulateError::Recording(_) => Code::NoRecording,
        }
    }

    /// The message of the diagnostic.
    pub fn message(&self) -> String {
        match self {
            SimulateError::Recording(message) => format!("the run could not be recorded: {message}"),
            SimulateError::Diverged(_)
            | SimulateError::Undefined(_)
            | SimulateError::Broken(_)
            | SimulateError::Stuck(_)
            | SimulateError::Stalled(_) => self.to_string(),
        }
    }

    /// Converts the error into a report with one diagnostic, which points to the bodies, joint or formula in the scene's text.
    pub fn report(&self) -> Report {
        let diagnostic = Diagnostic::error(self.code(), self.message());
        let diagnostic = match self.help() {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        };
        let (diagnostic, sources) = match self {
            SimulateError::Broken(broken) => {
                let (span, sources) = &broken.place;
                (span.iter().fold(diagnostic, |diagnostic, span| diagnostic.at(*span, "")), sources.clone())
            }
            SimulateError::Undefined(undefined) => match &undefined.place {
                (Some(span), sources) => (diagnostic.at(*span, undefined.why.2.clone()), sources.clone()),
                (None, _) => (diagnostic, Sources::default()),
            },
            SimulateError::Stalled(stalled) => {
                let (span, sources) = &stalled.place;
                (span.iter().fold(diagnostic, |diagnostic, span| diagnostic.at(*span, "")), sources.clone())
            }
            SimulateError::Stuck(stuck) => {
                let (spans, sources) = &stuck.place;
                (spans.iter().fold(diagnostic, |diagnostic, span| diagnostic.at(*span, "")), sources.clone())
            }
            SimulateError::Diverged(diverged) => {
                let (span, sources) = &diverged.place;
                let at = |diagnostic: Diagnostic, span: &_| diagnostic.at(*span, diverged.label());
                (span.iter().fold(diagnostic, at), sources.clone())
            }
            SimulateError::Recording(_) => (diagnostic, Sources::default()),
        };
        Report { sources, diagnostics: vec![diagnostic] }
    }

    /// Suggests a remedy. `None` if the error message alone is enough.
    pub fn help(&self) -> Option<String> {
        let help = match self {
            SimulateError::Diverged(diverged) => return diverged.help(),
            SimulateError::Broken(broken) if broken.time == 0.0 => Some(
                "with the other joints of its bodies, it cannot: their lengths and points contradict each other",
            ),
            SimulateError::Broken(broken) if broken.is_driven => Some(
                "bodies whose motion is given, motors or other joints pull the bodies apart: give the bodies more freedom, or change the \
                 motion",
            ),
            SimulateError::Broken(_) => {
                Some("other joints pull the bodies apart; or take a smaller `simulation.step`")
            }
            SimulateError::Stuck(stuck) => Some(match stuck.why {
                Why::Overlaps(_) => {
                    "move them apart, or join them, or let them pass through each other: `collides = false`, or the same `collision_group`"
                }
                Why::Jams => {
                    "give wedged bodies more room or a smaller `restitution`, or end the scene before that time: `--set simulation.duration=…`"
                }
                Why::AddsEnergy(_) => {
                    "take a smaller `simulation.step`, or `contacts = \"time-stepping\"`, or end the scene before that time: `--set simulation.duration=…`"
                }
            }),
            SimulateError::Stalled(_) => Some(
                "two point-like bodies may meet there: give `gravitation` or `coulomb` a `softening`, move them, or end the scene before that \
                 time: `--set simulation.duration=…`",
            ),
            SimulateError::Recording(_) => Some(
                "it goes to a file below /var/tmp, or where TMPDIR says: make room there, or name another folder",
            ),
            SimulateError::Undefined(_) => None,
        };
        help.map(str::to_owned)
    }
}

/// Returns whether the scene prescribes the motion of a body or of a joint.
pub(super) fn is_driven(scene: &Scene) -> bool {
    scene.bodies.iter().any(|body| body.motion.is_some())
        || scene.joints.iter().any(|joint| matches!(joint.kind.motor(), Some(Motor::Value(_))))
}
