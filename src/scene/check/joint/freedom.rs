//! Reads the limits and the motor of a hinge or a slider.

use std::sync::Arc;

use super::Reader;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{Coordinate, Freedom, Motor, Servo};
use crate::scene::check::motion;
use crate::scene::check::read::figure;
use crate::scene::check::view::View;
use crate::scene::grammar::joints::{hinge, moving, turning};
use crate::scene::grammar::{Key, KeySpec};
use crate::scene::joint::PrescribedCoordinate;
use crate::scene::value;

/// The unit, symbol and keys for the coordinate of a joint: an angle for a hinge, a distance for a slider.
struct Words {
    /// The factor that converts the coordinate from the scene's unit (degrees or meters) to SI units.
    unit: f64,
    /// The symbol of the joint coordinate's unit in diagnostics.
    symbol: &'static str,
    /// The key for the motor's maximum torque or force.
    strength: &'static Key<Option<f64>>,
    /// The key for the target angle or position of the motor.
    value: &'static Key<Option<value::Timed>>,
}

/// The words for a joint whose coordinate is an angle.
static ANGLE_WORDS: Words = Words {
    unit: std::f64::consts::PI / 180.0,
    symbol: "°",
    strength: &turning::TORQUE,
    value: &turning::ANGLE,
};
/// The words for a joint whose coordinate is a distance.
static DISTANCE_WORDS: Words =
    Words { unit: 1.0, symbol: " m", strength: &moving::FORCE, value: &moving::POSITION };

/// A full turn, in degrees.
const FULL_TURN: f64 = 360.0;

impl Reader<'_, '_> {
    /// Reads the limits and the motor of a joint with one free coordinate. A motor with a stiffness is returned separately, as a servo.
    pub(super) fn freedom(&mut self, view: &View<'_>, coordinate: Coordinate) -> (Freedom, Option<Servo>) {
        let words = if coordinate.is_angle() { &ANGLE_WORDS } else { &DISTANCE_WORDS };
        let limits = self.limits(view, words);
        let Some(motor) = view.variant(&hinge::MOTOR) else { return (Freedom { limits, motor: None }, None) };
        if let Some(value) = motor.get(words.value) {
            motion::finite(motor.node(words.value), self.simulation, self.context);
            let target = Arc::new(PrescribedCoordinate { value, unit: words.unit });
            let servo = motor.get(&turning::STIFFNESS).map(|stiffness| Servo {
                coordinate,
                target: target.clone(),
                stiffness,
                damping: motor.get(&turning::DAMPING),
            });
            self.unused(
                &motor,
                &words.strength.spec,
                &format!("with `{}`, a motor is as strong as its `stiffness`", words.value.spec.name),
            );
            if servo.is_some() {
                return (Freedom { limits, motor: None }, servo);
            }
            self.unused(
                &motor,
                &turning::DAMPING.spec,
                "without `stiffness`, the motor keeps its value exactly",
            );
            self.begins_at_zero(&motor, &target, words);
            return (Freedom { limits, motor: Some(Motor::Value(target)) }, None);
        }
        let speed = motor.get(&turning::SPEED);
        for key in [&turning::STIFFNESS.spec, &turning::DAMPING.spec]
            .into_iter()
            .filter(|_| motor.has(&turning::SPEED))
        {
            self.unused(
                &motor,
                key,
                &format!("with `speed`, a motor is as strong as its `{}`", words.strength.spec.name),
            );
        }
        let limit = motor.get(words.strength);
        if let (Some(_), None, false) = (speed, limit, motor.has(words.strength)) {
            let message = format!("the motor of the joint `{}` does not say how strong it is", self.name);
            let span = view.span(&hinge::MOTOR).unwrap_or(self.span);
            let error = Diagnostic::error(Code::MissingKey, message);
            let error = error.at(span, format!("needs `{}`", words.strength.spec.name));
            let help = format!(
                "such as `motor = {{ speed = {}, {} = 10 }}`",
                figure(speed.unwrap_or(1.0)),
                words.strength.spec.name
            );
            self.context.diagnostics.push(error.help(help));
        }
        let motor = speed.zip(limit).map(|(speed, limit)| Motor::Speed { speed, limit });
        (Freedom { limits, motor }, None)
    }

    fn limits(&mut self, view: &View<'_>, words: &Words) -> Option<[f64; 2]> {
        let [low, high] = *view.get_as::<Vec<f64>>(&hinge::LIMITS)?.as_slice() else { return None };
        let span = view.span(&hinge::LIMITS).unwrap_or(self.span);
        let Words { unit, symbol, .. } = *words;
        let mut wrong = |label: String, help: String| {
            let message = format!("the limits of the joint `{}` cannot hold", self.name);
            self.context
                .diagnostics
                .push(Diagnostic::error(Code::BadJoint, message).at(span, label).help(help));
            None
        };
        let [shown_low, shown_high] = [low, high].map(figure);
        if low >= high {
            return wrong(
                "the first must be smaller than the second".to_owned(),
                format!(
                    "`limits = [{shown_high}, {shown_low}]`, or a `fixed` joint where it must not move at all"
                ),
            );
        }
        if low > 0.0 || high < 0.0 {
            return wrong(
                format!("the joint begins at 0{symbol}, which is not between them"),
                "limits count from how the bodies stand at the start: turn or move the bodies, or the limits"
                    .to_owned(),
            );
        }
        if words.symbol == "°" && high - low >= FULL_TURN {
            return wrong(
                format!("they are {}° apart, a turn or more", figure(high - low)),
                "limits span less than 360°; without limits, a hinge turns as often as it likes".to_owned(),
            );
        }
        Some([low * unit, high * unit])
    }

    /// Reports a motor without a stiffness whose target is not 0 at time 0. The joint would have to jump, because its coordinate starts at
    /// 0.
    fn begins_at_zero(&mut self, motor: &View<'_>, target: &PrescribedCoordinate, words: &Words) {
        let value = target.value.at(0.0);
        if value.abs() * words.unit > 1e-9 {
            let message = format!("the motor of the joint `{}` would have to jump at the start", self.name);
            let span = motor.span(words.value).unwrap_or(self.span);
            let label =
                format!("it is {}{} at t = 0, and the joint begins at 0", figure(value), words.symbol);
            let help =
                "let the formula begin at 0, or give the motor a `stiffness`: then it pulls the joint there";
            self.context
                .diagnostics
                .push(Diagnostic::error(Code::BadJoint, message).at(span, label).help(help));
        }
    }

    /// Warns that a key has no effect, if the scene gives this key.
    fn unused(&mut self, view: &View<'_>, key: &KeySpec, why: &str) {
        let span: Option<Span> = view.key_span(key);
        if let Some(span) = span {
            let message = format!("`{}` has no effect here", key.name);
            self.context.diagnostics.push(Diagnostic::warning(Code::NoEffect, message).at(span, why));
        }
    }
}
