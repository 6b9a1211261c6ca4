//! Fills current values into the texts of labels.

use super::super::number;
use super::Labels;
use crate::physics::{Balance, BodyId, BodySnapshot, Reaction, find};
use crate::scene::{Body, BodyMeasure, Format, JointState, Label, Measure, Piece, Quantity, RunMeasure};
use crate::simulate::{Frame, Ghost, ImpactCounts, shown};

/// The moment at which a label's values are evaluated: a frame, or the time of a ghost.
pub(super) struct Moment<'a> {
    time: f64,
    frame: usize,
    balance: Option<&'a Balance>,
    bodies: &'a [BodySnapshot],
    /// The constraint forces of the joints. Empty for a ghost.
    reactions: &'a [Reaction],
    /// The angles of the joints, counted through full turns, rad. Empty for a ghost.
    angles: &'a [f64],
    /// The numbers of impacts up to the moment. `None` for a ghost.
    impacts: Option<&'a ImpactCounts>,
}

impl<'a> Moment<'a> {
    /// Returns the moment of a frame, at which all values of labels are known.
    pub(super) fn now(frame: &'a Frame) -> Moment<'a> {
        Moment {
            time: frame.time,
            frame: frame.index,
            balance: Some(&frame.balance),
            bodies: &frame.bodies,
            reactions: &frame.reactions,
            angles: &frame.angles,
            impacts: Some(&frame.impacts),
        }
    }

    /// Returns the moment of a ghost, at which only the values of its body are known.
    pub(super) fn then(ghost: &'a Ghost) -> Moment<'a> {
        Moment {
            time: ghost.time,
            frame: 0,
            balance: None,
            bodies: std::slice::from_ref(&ghost.body),
            reactions: &[],
            angles: &[],
            impacts: None,
        }
    }
}

impl Labels {
    /// The text of a label, with its values at a moment.
    pub(super) fn said(&self, label: &Label, moment: &Moment<'_>) -> String {
        let mut said = String::new();
        for piece in &label.text {
            match piece {
                Piece::Words(words) => said.push_str(words),
                Piece::Value { formula, inputs, format } => {
                    let inputs: Vec<f64> =
                        inputs.iter().map(|measure| self.measure(*measure, moment)).collect();
                    said.push_str(&written(formula.eval(&inputs), *format));
                }
            }
        }
        said
    }

    #[allow(clippy::cast_precision_loss, reason = "there are fewer frames than that")]
    fn measure(&self, measure: Measure, moment: &Moment<'_>) -> f64 {
        let energy = |of: fn(&Balance) -> f64| moment.balance.map_or(f64::NAN, of);
        let impacts = |of: fn(&ImpactCounts) -> f64| moment.impacts.map_or(f64::NAN, of);
        match measure {
            Measure::Run(RunMeasure::Time) => moment.time,
            Measure::Run(RunMeasure::Frame) => moment.frame as f64,
            Measure::Run(RunMeasure::Energy) => energy(Balance::total_of_all),
            Measure::Run(RunMeasure::Kinetic) => energy(Balance::kinetic_of_all),
            Measure::Run(RunMeasure::Potential) => energy(|balance| balance.potential),
            Measure::Run(RunMeasure::Impacts) => impacts(ImpactCounts::of_run),
            Measure::Impacts(pair) => moment.impacts.map_or(f64::NAN, |impacts| impacts.of_pair(pair)),
            Measure::Body(number, BodyMeasure::Impacts) => {
                moment.impacts.map_or(f64::NAN, |impacts| impacts.of_body(number))
            }
            Measure::Body(number, measure) => {
                let at = find(moment.bodies, number);
                at.map_or(f64::NAN, |at| of_body(&self.bodies[number], at, measure))
            }
            Measure::Joint(number, measure) => {
                let Some(reaction) = moment.reactions.get(number) else { return f64::NAN };
                let body = |id: BodyId| find(moment.bodies, id.index()).copied();
                let total_angle = moment.angles.get(number).copied().unwrap_or(f64::NAN);
                measure.of(&JointState::of(self.joints[number], (*reaction, total_angle), body))
            }
        }
    }
}

/// A sample text of the largest expected length, in which numbers have up to four digits before the decimal point.
pub(super) fn longest(label: &Label) -> String {
    let piece = |piece: &Piece| match piece {
        Piece::Words(words) => words.clone(),
        Piece::Value { format: Format::Short, .. } => "0.0000".to_owned(),
        Piece::Value { format: Format::Decimals(decimals), .. } => "0".repeat(decimals + 3),
        Piece::Value { format: Format::Scientific(decimals), .. } => "0".repeat(decimals + 5),
    };
    label.text.iter().map(piece).collect()
}

fn of_body(body: &Body, at: &BodySnapshot, measure: BodyMeasure) -> f64 {
    let acceleration = shown(Quantity::Acceleration, body, at);
    let mass = body.start.mass;
    match measure {
        BodyMeasure::Location(axis) => at.location[axis],
        BodyMeasure::Speed => at.velocity.length(),
        BodyMeasure::Velocity(axis) => at.velocity[axis],
        BodyMeasure::AccelerationMagnitude => acceleration.length(),
        BodyMeasure::Acceleration(axis) => acceleration[axis],
        BodyMeasure::ForceMagnitude => at.force.length(),
        BodyMeasure::Force(axis) => at.force[axis],
        BodyMeasure::AngularSpeed => at.angular_velocity.length(),
        BodyMeasure::Mass => mass,
        BodyMeasure::Momentum => mass * at.velocity.length(),
        // Impacts are counted per run, not in the state of a body.
        BodyMeasure::Impacts => f64::NAN,
        BodyMeasure::Kinetic => {
            let turned = at.orientation * body.start.principal_axes;
            let spin = turned.conjugate() * at.angular_velocity;
            0.5 * (mass * at.velocity.length_squared() + body.start.inertia.dot(spin * spin))
        }
    }
}

/// Formats a number for a label. Non-finite numbers become `?`.
fn written(value: f64, format: Format) -> String {
    if !value.is_finite() {
        return "?".to_owned();
    }
    let text = match format {
        Format::Short => short_of(value),
        // Larger numbers would have too many digits to be read easily, and some renderers accept short texts only.
        Format::Decimals(decimals) if value.abs() < 1e15 => format!("{value:.decimals$}"),
        Format::Decimals(decimals) | Format::Scientific(decimals) => format!("{value:.decimals$e}"),
    };
    // A result that is rounded to zero gets no minus sign.
    let text = match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    };
    number::typeset(&text)
}

fn short_of(value: f64) -> String {
    let mut out = String::new();
    number::write(&mut out, value, 3);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn numbers_are_written_as_asked_for() {
        for (value, format, expected) in [
            (0.5, Format::Decimals(2), "0.50"),
            (-1.25, Format::Decimals(1), "−1.2"),
            (-0.001, Format::Decimals(2), "0.00"),
            (12345.678, Format::Short, "12300"),
            (-0.012345, Format::Short, "−0.0123"),
            (1.5e-9, Format::Scientific(1), "1.5·10⁻⁹"),
            (1e300, Format::Decimals(1), "1.0·10³⁰⁰"),
            (f64::NAN, Format::Short, "?"),
        ] {
            assert_eq!(written(value, format), expected);
        }
    }

    /// A body on a given circle: ½ m (r ω)² + ½ I ω² with m = 2 kg, r = 3 m, ω = 2 rad/s, and I = 0.4 m 0.1² of a ball that turns at 1 rad/s. A
    /// free body beside it has its own 9 J.
    #[test]
    fn the_kinetic_energy_of_the_scene_counts_bodies_with_a_given_motion() {
        let text = "simulation.duration = 1
            [body.a]\nshape.sphere.radius = 0.1\nmass = 2
            motion.formula.location = ['3*cos(2*t)', '3*sin(2*t)', 0]\nmotion.formula.orientation = [0, 'deg(t)', 0]
            [body.b]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [9, 0, 0]\nvelocity = [0, 0, 3]\n";
        let scene = Scene::parse(text).unwrap();
        for frame in crate::simulate::Frames::new(&scene).map(Result::unwrap) {
            let all: f64 = [0, 1]
                .map(|body| of_body(&scene.bodies[body], &frame.bodies[body], BodyMeasure::Kinetic))
                .iter()
                .sum();
            let found = frame.balance.kinetic_of_all();
            assert!((found - (36.0 + 0.5 * 0.4 * 2.0 * 0.01 + 9.0)).abs() < 1e-9, "{found}");
            assert!((found - all).abs() < 1e-9 && (frame.balance.total_of_all() - all).abs() < 1e-9);
            assert_eq!(frame.balance.error, 0.0);
        }
    }

    /// The kinetic energy of the only moving body equals that of the whole run, even for a tumbling compound.
    #[test]
    fn the_kinetic_energy_of_a_body_is_that_of_translation_and_rotation() {
        let scene = Scene::parse(
            "
            simulation = { duration = 1, integrator = 'rk4' }
            [body.hammer]
            mass = 3
            velocity = [1, 2, 0]
            angular_velocity = [1, 2, 3]
            shape.compound.parts = [
                { box.size = [3, 1, 2] },
                { sphere.radius = 0.5, location = [1, 2, 0] },
            ]
            ",
        )
        .unwrap();
        for frame in crate::simulate::Frames::new(&scene).map(Result::unwrap) {
            let kinetic = of_body(&scene.bodies[0], &frame.bodies[0], BodyMeasure::Kinetic);
            assert!(
                (kinetic / frame.balance.kinetic - 1.0).abs() < 1e-9,
                "{kinetic} {}",
                frame.balance.kinetic
            );
        }
    }

    /// A body that a motion guides has a kinetic energy, too: with 2 kg at 6 m/s, it is 36 J, for the body and for the scene.
    #[test]
    fn the_kinetic_energy_of_the_scene_contains_that_of_given_motions() {
        let scene = Scene::parse(
            "
            simulation = { duration = 1, gravity = [0, -10, 0] }
            [body.guided]
            shape.sphere.radius = 0.1
            mass = 2
            motion.formula.location = ['3 * cos(2 * t)', '3 * sin(2 * t)', 0]
            [body.thrown]
            shape.sphere.radius = 0.1
            mass = 2
            velocity = [3, 0, 0]
            [label.measured]
            text = '${guided.kinetic:.6} ${kinetic_energy:.6} ${energy:.6}'
            ",
        )
        .unwrap();
        let labels = Labels::new(&scene, scene.labels[0].color.unwrap_or(crate::scene::Color::WHITE));
        let frame = crate::simulate::Frames::new(&scene).next().unwrap().unwrap();
        let said = labels.said(&scene.labels[0], &Moment::now(&frame));
        assert_eq!(said, "36.000000 45.000000 45.000000");
    }
}
