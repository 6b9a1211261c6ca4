//! Converts a simulation error into a diagnostic.

use super::SimulateError;
use crate::diagnostic::{Code, Diagnostic, Report, Sources};
use crate::dynamics::Motor;
use crate::scene::{ForceKind, JointKind, Scene};

impl SimulateError {
    /// The diagnostic code of the error.
    pub fn code(&self) -> Code {
        match self {
            SimulateError::Diverged(_) => Code::Diverged,
            SimulateError::Undefined(undefined) => undefined.why.0,
            SimulateError::Broken(broken) if broken.time == 0.0 => Code::JointApart,
            SimulateError::Broken(_) => Code::BrokenJoint,
            SimulateError::Stuck(stuck) if stuck.depth.is_some() => Code::OverlapAtStart,
            SimulateError::Stuck(_) => Code::Jammed,
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
            SimulateError::Diverged(_) | SimulateError::Recording(_) => (diagnostic, Sources::default()),
        };
        Report { sources, diagnostics: vec![diagnostic] }
    }

    /// Suggests a remedy. `None` if the error message alone is enough.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            SimulateError::Diverged(diverged) => Some(diverged.remedy),
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
            SimulateError::Stuck(stuck) if stuck.depth.is_some() => Some(
                "move them apart, or join them, or let them pass through each other: `collides = false`, or the same \
                 `collision_group`",
            ),
            SimulateError::Stuck(_) => Some(
                "give wedged bodies more room or a smaller `restitution`, or end the scene before that time: `--set simulation.duration=…`",
            ),
            SimulateError::Stalled(_) => Some(
                "two point-like bodies may meet there: give `gravitation` or `coulomb` a `softening`, move them, or end the scene before that \
                 time: `--set simulation.duration=…`",
            ),
            SimulateError::Recording(_) => Some(
                "it goes to a file below /var/tmp, or where TMPDIR says: make room there, or name another folder",
            ),
            SimulateError::Undefined(_) => None,
        }
    }
}

/// Returns the advice for a run that diverged. Recommends a smaller step only where one can help.
pub(super) fn remedy(scene: &Scene) -> &'static str {
    let simulation = &scene.simulation;
    if simulation.method.adaptive {
        return "the integrator chooses its own steps, so the motion itself leaves the range of numbers: look for a force that grows \
                without bound";
    }
    // The largest step, relative to the time scale of a spring or a damper, that is surely stable.
    const STABLE: f64 = 0.1;
    let step = simulation.step;
    let lightest = scene.bodies.iter().map(|body| body.start.mass).fold(f64::INFINITY, f64::min);
    let needs_step = |kind: &ForceKind| match kind {
        ForceKind::Constant(_) => false,
        ForceKind::Spring { links, .. } => links.iter().any(|link| {
            link.stiffness * step * step > STABLE * lightest || link.damping * step > STABLE * lightest
        }),
        ForceKind::Drag(drag) => drag.quadratic > 0.0 || drag.linear * step > STABLE * lightest,
        _ => true,
    };
    let is_bound = !scene.joints.is_empty() || simulation.contacts.is_some();
    if is_bound || scene.forces.iter().any(|force| needs_step(&force.kind)) {
        "take a smaller `simulation.step`: below √(mass / stiffness) for a stiff spring, and below 2 mass / damping for a strong damper"
    } else {
        "a smaller step does not help: a force, a velocity or a mass is so extreme that the motion leaves the range of numbers"
    }
}

/// Returns whether the scene prescribes the motion of a body or of a joint.
pub(super) fn is_driven(scene: &Scene) -> bool {
    let has_motor = |kind: &JointKind| {
        let motor = match kind {
            JointKind::Hinge(hinge) => hinge.freedom.motor.as_ref(),
            JointKind::Slider(slider) => slider.freedom.motor.as_ref(),
            _ => None,
        };
        matches!(motor, Some(Motor::Value(_)))
    };
    scene.bodies.iter().any(|body| body.motion.is_some())
        || scene.joints.iter().any(|joint| has_motor(&joint.kind))
}
