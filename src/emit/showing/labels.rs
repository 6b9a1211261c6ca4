//! Texts in the picture, with the numbers of the moment.

use super::super::screen::Screen;
use super::super::{number, sdl::Style, text};
use super::color;
use crate::dynamics::Balance;
use crate::scene::{
    Body, BodyMeasure, Color, Corner, Format, Label, LabelPlace, Measure, Piece, RunMeasure, Scene, Side,
};
use crate::simulate::{BodyFrame, Frame};

/// The distance of texts from the edges of the picture, whose width is 2.
pub(super) const MARGIN: f64 = 0.035;

/// The labels of a scene.
pub(super) struct Labels {
    labels: Vec<Planned>,
    /// The bodies of the scene, if labels look at any.
    bodies: Vec<Body>,
}

struct Planned {
    label: Label,
    /// The height of a line on the screen.
    height: f64,
    color: String,
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
    pub(super) fn new(scene: &Scene, style: Style) -> Labels {
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
            let own = label.color.unwrap_or(ink(scene));
            Planned { label: label.clone(), height, color: color(own, style), inset }
        };
        let labels: Vec<Planned> = scene.labels.iter().map(plan).collect();
        let bodies = if labels.is_empty() { Vec::new() } else { scene.bodies.clone() };
        Labels { labels, bodies }
    }

    /// Appends the labels of a frame.
    pub(super) fn write(&self, out: &mut String, frame: &Frame, screen: &Screen) {
        let now = Moment {
            time: frame.time,
            frame: frame.index,
            balance: Some(&frame.balance),
            bodies: &frame.bodies,
        };
        for planned in &self.labels {
            match planned.label.place {
                LabelPlace::Corner(corner) => self.in_corner(out, planned, corner, &now),
                LabelPlace::Body { body, side, ghosts } => {
                    for ghost in frame.past.ghosts.iter().filter(|ghost| ghosts && ghost.body.id == body) {
                        let bodies = std::slice::from_ref(&ghost.body);
                        let then = Moment { time: ghost.time, frame: 0, balance: None, bodies };
                        self.beside(out, planned, (&ghost.body, side), &then, screen);
                    }
                    self.beside(out, planned, (&frame.bodies[body], side), &now, screen);
                }
            }
        }
    }

    fn in_corner(&self, out: &mut String, planned: &Planned, corner: Corner, now: &Moment<'_>) {
        let (x, align) = across(corner);
        let mut inset = String::new();
        number::write(&mut inset, planned.inset + 0.3 * planned.height, 4);
        let y = if is_top(corner) {
            format!("Screen_top - {inset}")
        } else {
            let mut inset = String::new();
            number::write(&mut inset, planned.inset - 0.3 * planned.height, 4);
            format!("{inset} - Screen_top")
        };
        self.put(out, planned, (&short(x), &y), align, now);
    }

    fn beside(
        &self,
        out: &mut String,
        planned: &Planned,
        (at, side): (&BodyFrame, Side),
        moment: &Moment<'_>,
        screen: &Screen,
    ) {
        let shape = self.bodies[at.id].drawn();
        let reach = |direction| shape.support(at.orientation, direction).unwrap_or(0.0);
        let Some(spot) = screen.spot(at.location) else { return };
        let (up, right) = (screen.up(), screen.right());
        let (x, y, align) = match side {
            Side::Above => (0.0, reach(up) * spot.metre + 0.3 * planned.height, 0.5),
            Side::Below => (0.0, -reach(-up) * spot.metre - 0.9 * planned.height, 0.5),
            Side::Left => (-reach(-right) * spot.metre - 0.35 * planned.height, -0.3 * planned.height, 1.0),
            Side::Right => (reach(right) * spot.metre + 0.35 * planned.height, -0.3 * planned.height, 0.0),
        };
        let (x, y) = (spot.x + x, spot.y + y);
        // What is out of the picture may be far out.
        if x.abs() < 2.0 && y.abs() < 2.0 {
            self.put(out, planned, (&short(x), &short(y)), align, moment);
        }
    }

    fn put(&self, out: &mut String, planned: &Planned, at: (&str, &str), align: f64, moment: &Moment<'_>) {
        let said = self.said(&planned.label, moment);
        write(out, &said, at, planned.height, align, &planned.color);
        out.push_str(&format!(" // {}\n", text::comment(&planned.label.name)));
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
        BodyMeasure::Kinetic => 0.5 * mass * at.velocity.length_squared(),
    }
}

/// A number as a label has it, with a real minus sign. What is no number is shown as such.
fn written(value: f64, format: Format) -> String {
    if !value.is_finite() {
        return "?".to_owned();
    }
    let text = match format {
        Format::Short => short_of(value),
        // Longer numbers are no easier to read, and POV-Ray's strings are short.
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

/// A place on the screen: finer than a pixel, and no finer.
pub(super) fn short(place: f64) -> String {
    let mut out = String::new();
    number::write(&mut out, (place * 1e5).round() / 1e5, 6);
    out
}

/// Appends a text at a place on the screen: `align` is 0 if it begins there, 1 if it ends there.
pub(super) fn write(
    out: &mut String,
    said: &str,
    (x, y): (&str, &str),
    height: f64,
    align: f64,
    color: &str,
) {
    // POV-Ray knows no text without a letter.
    let said = if said.trim().is_empty() { "-" } else { said };
    let said = text::string(said);
    out.push_str(&format!("Label(\"{said}\", <{x}, {y}, 0>, {}, {}, {color})", short(height), short(align)));
}

/// The usual color of what is written.
pub(super) fn ink(scene: &Scene) -> Color {
    if scene.environment.is_dark() { Color([0.95, 0.96, 0.97]) } else { Color([0.05, 0.07, 0.10]) }
}

/// Where a text in a corner stands across the picture, and which end of it is there.
pub(super) fn across(corner: Corner) -> (f64, f64) {
    match corner {
        Corner::TopLeft | Corner::BottomLeft => (MARGIN - 1.0, 0.0),
        Corner::Top | Corner::Bottom => (0.0, 0.5),
        Corner::TopRight | Corner::BottomRight => (1.0 - MARGIN, 1.0),
    }
}

/// Whether a corner is at the top of the picture.
pub(super) fn is_top(corner: Corner) -> bool {
    matches!(corner, Corner::TopLeft | Corner::Top | Corner::TopRight)
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
}
