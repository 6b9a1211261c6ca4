//! Texts in the picture, with the numbers of the moment.

use super::number;
use super::screen::Screen;
use super::text::{MARGIN, Text, Vertical, across, is_top};
use crate::dynamics::Balance;
use crate::scene::{
    Body, BodyMeasure, Color, Corner, Format, Label, LabelPlace, Measure, Piece, RunMeasure, Scene, Side,
};
use crate::simulate::{BodyFrame, Frame};

/// The labels of a scene.
#[derive(Clone, Debug)]
pub(super) struct Labels {
    labels: Vec<Planned>,
    /// The bodies of the scene, if labels look at any.
    bodies: Vec<Body>,
}

#[derive(Clone, Debug)]
struct Planned {
    label: Label,
    /// The height of a line on the screen.
    height: f64,
    color: Color,
    /// In a corner: how far its middle is from the edge, on the screen.
    inset: f64,
}

/// The moment that a label speaks of.
struct Moment<'a> {
    time: f64,
    frame: usize,
    balance: Option<&'a Balance>,
    bodies: &'a [BodyFrame],
}

impl Labels {
    /// Plans the labels for pictures of a height, as part of their width.
    pub(super) fn new(scene: &Scene, ink: Color) -> Labels {
        let aspect = f64::from(scene.output.height) / f64::from(scene.output.width);
        let mut used = [0.0; Corner::ALL.len()];
        let plan = |label: &Label| {
            let height = label.size * 2.0 * aspect;
            let mut inset = 0.0;
            if let LabelPlace::Corner(corner) = label.place {
                let used = &mut used[corner as usize];
                inset = MARGIN + *used + height / 2.0;
                *used += 1.15 * height;
            }
            Planned { label: label.clone(), height, color: label.color.unwrap_or(ink), inset }
        };
        let labels: Vec<Planned> = scene.labels.iter().map(plan).collect();
        let bodies = if labels.is_empty() { Vec::new() } else { scene.bodies.clone() };
        Labels { labels, bodies }
    }

    /// The labels of a frame, on the plane before its camera.
    pub(super) fn at<'a>(&'a self, frame: &Frame, screen: &Screen) -> Vec<Text<'a>> {
        let now = Moment {
            time: frame.time,
            frame: frame.index,
            balance: Some(&frame.balance),
            bodies: &frame.bodies,
        };
        let mut texts = Vec::new();
        for planned in &self.labels {
            match planned.label.place {
                LabelPlace::Corner(corner) => texts.push(self.in_corner(planned, corner, &now)),
                LabelPlace::Body { body, side, ghosts } => {
                    for ghost in frame.past.ghosts.iter().filter(|ghost| ghosts && ghost.body.id == body) {
                        let bodies = std::slice::from_ref(&ghost.body);
                        let then = Moment { time: ghost.time, frame: 0, balance: None, bodies };
                        texts.extend(self.beside(planned, (&ghost.body, side), &then, screen));
                    }
                    texts.extend(self.beside(planned, (&frame.bodies[body], side), &now, screen));
                }
            }
        }
        texts
    }

    fn in_corner<'a>(&'a self, planned: &'a Planned, corner: Corner, now: &Moment<'_>) -> Text<'a> {
        let (x, align) = across(corner);
        let y = match is_top(corner) {
            true => Vertical::Top(planned.inset + 0.3 * planned.height),
            false => Vertical::Bottom(planned.inset - 0.3 * planned.height),
        };
        self.text(planned, (x, y), align, now)
    }

    fn beside<'a>(
        &'a self,
        planned: &'a Planned,
        (at, side): (&BodyFrame, Side),
        moment: &Moment<'_>,
        screen: &Screen,
    ) -> Option<Text<'a>> {
        let shape = self.bodies[at.id].drawn();
        let reach = |direction| shape.support(at.orientation, direction).unwrap_or(0.0);
        let spot = screen.spot(at.location)?;
        let (up, right) = (screen.up(), screen.right());
        let (x, y, align) = match side {
            Side::Above => (0.0, reach(up) * spot.metre + 0.3 * planned.height, 0.5),
            Side::Below => (0.0, -reach(-up) * spot.metre - 0.9 * planned.height, 0.5),
            Side::Left => (-reach(-right) * spot.metre - 0.35 * planned.height, -0.3 * planned.height, 1.0),
            Side::Right => (reach(right) * spot.metre + 0.35 * planned.height, -0.3 * planned.height, 0.0),
        };
        let (x, y) = (spot.x + x, spot.y + y);
        // What is out of the picture may be far out.
        let is_near = x.abs() < 2.0 && y.abs() < 2.0;
        is_near.then(|| self.text(planned, (x, Vertical::Middle(y)), align, moment))
    }

    fn text<'a>(
        &'a self,
        planned: &'a Planned,
        (x, y): (f64, Vertical),
        align: f64,
        moment: &Moment<'_>,
    ) -> Text<'a> {
        Text {
            name: &planned.label.name,
            says: self.said(&planned.label, moment).into(),
            x,
            y,
            height: planned.height,
            align,
            color: planned.color,
        }
    }

    /// What a label says at a moment.
    fn said(&self, label: &Label, moment: &Moment<'_>) -> String {
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
        match measure {
            Measure::Run(RunMeasure::Time) => moment.time,
            Measure::Run(RunMeasure::Frame) => moment.frame as f64,
            Measure::Run(RunMeasure::Energy) => energy(|balance| balance.total),
            Measure::Run(RunMeasure::Kinetic) => energy(|balance| balance.kinetic),
            Measure::Run(RunMeasure::Potential) => energy(|balance| balance.potential),
            Measure::Body(number, measure) => {
                let mut bodies = moment.bodies.iter();
                let at = if moment.bodies.get(number).is_some_and(|body| body.id == number) {
                    moment.bodies.get(number)
                } else {
                    bodies.find(|body| body.id == number)
                };
                at.map_or(f64::NAN, |at| of_body(&self.bodies[number], at, measure))
            }
        }
    }
}

fn of_body(body: &Body, at: &BodyFrame, measure: BodyMeasure) -> f64 {
    let acceleration = crate::simulate::shown(crate::scene::Quantity::Acceleration, body, at);
    let mass = body.start.mass;
    match measure {
        BodyMeasure::Location(axis) => at.location[axis],
        BodyMeasure::Speed => at.velocity.length(),
        BodyMeasure::Velocity(axis) => at.velocity[axis],
        BodyMeasure::Accelerating => acceleration.length(),
        BodyMeasure::Acceleration(axis) => acceleration[axis],
        BodyMeasure::Pull => at.force.length(),
        BodyMeasure::Force(axis) => at.force[axis],
        BodyMeasure::Spin => at.angular_velocity.length(),
        BodyMeasure::Mass => mass,
        BodyMeasure::Momentum => mass * at.velocity.length(),
        BodyMeasure::Kinetic => {
            let turned = at.orientation * body.start.principal_axes;
            let spin = turned.conjugate() * at.angular_velocity;
            0.5 * (mass * at.velocity.length_squared() + body.start.inertia.dot(spin * spin))
        }
    }
}

/// A number as a label has it, with a real minus sign. What is no number is shown as such.
fn written(value: f64, format: Format) -> String {
    if !value.is_finite() {
        return "?".to_owned();
    }
    let text = match format {
        Format::Short => short_of(value),
        // Longer numbers are no easier to read, and what draws them may know short texts only.
        Format::Decimals(decimals) if value.abs() < 1e15 => format!("{value:.decimals$}"),
        Format::Decimals(decimals) | Format::Scientific(decimals) => format!("{value:.decimals$e}"),
    };
    // −0.00 would be a sign without a number.
    let text = match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    };
    text.replace('-', "–")
}

fn short_of(value: f64) -> String {
    let mut out = String::new();
    number::write(&mut out, value, 3);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_asked_for() {
        for (value, format, expected) in [
            (0.5, Format::Decimals(2), "0.50"),
            (-1.25, Format::Decimals(1), "–1.2"),
            (-0.001, Format::Decimals(2), "0.00"),
            (12345.678, Format::Short, "12300"),
            (-0.012345, Format::Short, "–0.0123"),
            (1.5e-9, Format::Scientific(1), "1.5e–9"),
            (1e300, Format::Decimals(1), "1.0e300"),
            (f64::NAN, Format::Short, "?"),
        ] {
            assert_eq!(written(value, format), expected);
        }
    }

    /// The kinetic energy of the only body that moves is that of the run, also while a compound tumbles.
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
}
