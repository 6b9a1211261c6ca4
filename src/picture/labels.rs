//! Texts in the picture, with the numbers of the moment.

use std::borrow::Cow;
use std::collections::HashMap;

use super::room::{Rectangle, Room};
use super::screen::{Screen, Spot};
use super::text::{MARGIN, Text, Vertical, across, is_top, least_height, width};
use super::{grid, number};
use crate::dynamics::{Balance, BodyId, BodySnapshot, Coordinate, Reaction, find};
use crate::scene::{
    Body, BodyMeasure, Color, Corner, Format, Label, LabelPlace, Measure, Piece, RunMeasure, Scene, Side,
};
use crate::simulate::{Frame, Ghost, ImpactCounts};

/// The usual height of a line, as part of the picture's height.
const SIZE: f64 = 0.055;
/// The least height of a line where none is given, pixels.
const LEAST_PIXELS: f64 = 13.0;
/// The distance from the base line of one line of text to the next, in heights of a line.
const LINE: f64 = 1.15;

/// The labels of a scene.
#[derive(Clone, Debug)]
pub(super) struct Labels {
    labels: Vec<Planned>,
    /// The bodies of the scene, if labels look at any.
    bodies: Vec<Body>,
    /// The coordinates of hinges and sliders, by the numbers of the joints.
    joints: Vec<Option<Coordinate>>,
    /// The height of the picture, as part of its width.
    aspect: f64,
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
    bodies: &'a [BodySnapshot],
    /// What the joints do; of ghosts, that is not kept.
    reactions: &'a [Reaction],
    /// The impacts so far; of ghosts, they are not kept.
    impacts: Option<&'a ImpactCounts>,
}

impl<'a> Moment<'a> {
    /// The moment of a frame.
    fn now(frame: &'a Frame) -> Moment<'a> {
        Moment {
            time: frame.time,
            frame: frame.index,
            balance: Some(&frame.balance),
            bodies: &frame.bodies,
            reactions: &frame.reactions,
            impacts: Some(&frame.impacts),
        }
    }
}

impl Labels {
    /// Plans the labels for pictures of a height, as part of their width.
    pub(super) fn new(scene: &Scene, ink: Color) -> Labels {
        let aspect = f64::from(scene.output.height) / f64::from(scene.output.width);
        let mut taken: Vec<Taken> =
            scene.scale_bar.map(|bar| under_bar(bar.corner, aspect)).into_iter().collect();
        let plan = |label: &Label| {
            let usual = (2.0 * aspect * SIZE).max(least_height(LEAST_PIXELS, scene.output));
            let mut height = label.size.map_or(usual, |size| 2.0 * aspect * size);
            let mut inset = 0.0;
            if let LabelPlace::Corner(corner) = label.place {
                // A line that is wider than the picture is made smaller.
                let wide = width(&longest(label), 1.0);
                height = height.min(2.0 * (1.0 - MARGIN) / wide.max(1e-9));
                inset = inset_without_overlap(&mut taken, corner, [wide * height, height], 2.0 * aspect);
            }
            Planned { label: label.clone(), height, color: label.color.unwrap_or(ink), inset }
        };
        let labels: Vec<Planned> = scene.labels.iter().map(plan).collect();
        let bodies = if labels.is_empty() { Vec::new() } else { scene.bodies.clone() };
        let joints = scene.joints.iter().map(|joint| joint.kind.coordinate()).collect();
        Labels { labels, bodies, joints, aspect }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.labels.len()
    }

    /// A picture of which nothing is taken.
    pub(super) fn room(&self) -> Room {
        Room::new(self.aspect)
    }

    /// The labels of a frame that stand in corners, each with its number.
    pub(super) fn in_corners(&self, frame: &Frame) -> Vec<(usize, Text<'_>)> {
        let now = Moment::now(frame);
        let labels = self.labels.iter().enumerate();
        let text = |(number, planned)| Some((number, self.in_corner(planned, &now)?));
        labels.filter_map(text).collect()
    }

    /// The labels of a frame that stand beside bodies, each with its number, on the plane before its camera. They keep
    /// off what is taken.
    pub(super) fn beside_bodies(
        &self,
        frame: &Frame,
        screen: &Screen,
        room: &mut Room,
    ) -> Vec<(usize, Text<'_>)> {
        let now = Moment::now(frame);
        let ghosts_of = self.ghosts_by_body(frame);
        let mut crowd = self.room();
        let ghosts = frame.past.ghosts.iter().map(|ghost| &ghost.body);
        for body in frame.bodies.iter().chain(ghosts) {
            self.seen(body, screen).into_iter().for_each(|(_, area)| crowd.take(area));
        }
        let mut texts = Vec::new();
        for (number, planned) in self.labels.iter().enumerate() {
            let LabelPlace::Body { body, side, ghosts } = planned.label.place else { continue };
            let here = frame.body(body);
            let text = here.and_then(|here| self.beside(planned, (here, side), &now, screen, (room, &crowd)));
            texts.extend(text.map(|text| (number, text)));
            let its = ghosts_of.get(&body).filter(|_| ghosts);
            for ghost in its.into_iter().flatten() {
                let bodies = std::slice::from_ref(&ghost.body);
                let then = Moment {
                    time: ghost.time,
                    frame: 0,
                    balance: None,
                    bodies,
                    reactions: &[],
                    impacts: None,
                };
                let text = self.beside(planned, (&ghost.body, side), &then, screen, (room, &crowd));
                texts.extend(text.map(|text| (number, text)));
            }
        }
        texts
    }

    /// The ghosts of a frame by the numbers of their bodies, if a label stands at ghosts.
    fn ghosts_by_body<'a>(&self, frame: &'a Frame) -> HashMap<usize, Vec<&'a Ghost>> {
        let mut by_body: HashMap<usize, Vec<&Ghost>> = HashMap::new();
        let at_ghosts =
            |planned: &Planned| matches!(planned.label.place, LabelPlace::Body { ghosts: true, .. });
        if self.labels.iter().any(at_ghosts) {
            frame.past.ghosts.iter().for_each(|ghost| by_body.entry(ghost.body.id).or_default().push(ghost));
        }
        by_body
    }

    fn in_corner<'a>(&'a self, planned: &'a Planned, now: &Moment<'_>) -> Option<Text<'a>> {
        let LabelPlace::Corner(corner) = planned.label.place else { return None };
        let (x, align) = across(corner);
        let y = match is_top(corner) {
            true => Vertical::Top(planned.inset + 0.3 * planned.height),
            false => Vertical::Bottom(planned.inset - 0.3 * planned.height),
        };
        Some(planned.text(self.said(&planned.label, now).into(), (x, y), align))
    }

    /// Where a body or a ghost is seen, and the part of the picture that it takes: nothing, if it is a plane.
    fn seen(&self, at: &BodySnapshot, screen: &Screen) -> Option<(Spot, Rectangle)> {
        let shape = self.bodies[at.id].drawn();
        let spot = screen.spot(at.location)?;
        let reach = |direction| shape.support(at.orientation, direction).unwrap_or(0.0) * spot.metre;
        let (up, right) = (screen.up(), screen.right());
        let area = Rectangle {
            left: spot.x - reach(-right),
            right: spot.x + reach(right),
            bottom: spot.y - reach(-up),
            top: spot.y + reach(up),
        };
        Some((spot, area))
    }

    /// A label beside a body, if the body is in the picture. It stays inside the picture; and it stands on another side
    /// or farther away where it would lie on an arrow or on another text; and on another side where it would lie on
    /// another body, if it can stay near.
    fn beside<'a>(
        &'a self,
        planned: &'a Planned,
        (at, side): (&BodySnapshot, Side),
        moment: &Moment<'_>,
        screen: &Screen,
        (room, crowd): (&mut Room, &Room),
    ) -> Option<Text<'a>> {
        let (spot, area) = self.seen(at, screen)?;
        if area.right < -1.0 || area.left > 1.0 || area.top < -self.aspect || area.bottom > self.aspect {
            return None;
        }
        let height = planned.height;
        let at_side = |side: Side, farther: f64| match side {
            Side::Above => (spot.x, area.top + 0.3 * height + farther, 0.5),
            Side::Below => (spot.x, area.bottom - 0.9 * height - farther, 0.5),
            Side::Left => (area.left - 0.35 * height - farther, spot.y - 0.3 * height, 1.0),
            Side::Right => (area.right + 0.35 * height + farther, spot.y - 0.3 * height, 0.0),
        };
        let said = self.said(&planned.label, moment);
        let candidate = |side: Side, lines: f64| {
            let (x, y, align) = at_side(side, lines * LINE * height);
            self.kept_inside(planned.text(said.as_str().into(), (x, Vertical::Middle(y)), align))
        };
        let others = match side {
            Side::Above | Side::Below => [side, opposite(side), Side::Right, Side::Left],
            Side::Left | Side::Right => [side, opposite(side), Side::Above, Side::Below],
        };
        // A line farther on its own side, or on the opposite one, before the other two sides.
        let near = [0, 1].into_iter().flat_map(|lines| [0, 1].map(|side| (others[side], lines)));
        let far = (0..=8).flat_map(|lines| others.map(|side| (side, lines)));
        let candidates =
            near.clone().chain(far.clone()).map(|(side, lines)| candidate(side, f64::from(lines)));
        let aside = near.chain([(others[2], 0), (others[3], 0)]);
        let aside = aside.map(|(side, lines)| candidate(side, f64::from(lines)));
        let corners = [Side::Above, Side::Below].into_iter().flat_map(|side| {
            let y = Vertical::Middle(at_side(side, 0.0).1);
            [(area.right, 0.0), (area.left, 1.0)]
                .map(|(x, align)| self.kept_inside(planned.text(said.as_str().into(), (x, y), align)))
        });
        let farther = far.filter(|(_, lines)| *lines <= 3);
        let farther = farther.map(|(side, lines)| candidate(side, f64::from(lines)));
        let free = aside
            .chain(corners)
            .chain(farther)
            .find(|text| room.has_room_for(text) && crowd.has_room_for(text))
            .or_else(|| candidates.into_iter().find(|text| room.has_room_for(text)));
        let text = free.unwrap_or_else(|| candidate(side, 0.0));
        room.take_text(&text);
        let Text { x, y, align, .. } = text;
        Some(planned.text(said.into(), (x, y), align))
    }

    /// A text that would leave the picture, moved to its edge.
    fn kept_inside<'a>(&self, text: Text<'a>) -> Text<'a> {
        let area = text.area(self.aspect);
        let edge = 1.0 - MARGIN / 2.0;
        let shift = |low: f64, high: f64, edge: f64| {
            if high - low > 2.0 * edge {
                -(low + high) / 2.0
            } else {
                (edge - high).min(0.0) + (-edge - low).max(0.0)
            }
        };
        let x = text.x + shift(area.left, area.right, edge);
        let y = text.y.raised(shift(area.bottom, area.top, self.aspect - MARGIN / 2.0));
        Text { x, y, ..text }
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
        let impacts = |of: fn(&ImpactCounts) -> f64| moment.impacts.map_or(f64::NAN, of);
        match measure {
            Measure::Run(RunMeasure::Time) => moment.time,
            Measure::Run(RunMeasure::Frame) => moment.frame as f64,
            Measure::Run(RunMeasure::Energy) => energy(|balance| balance.total),
            Measure::Run(RunMeasure::Kinetic) => energy(|balance| balance.kinetic),
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
                let coordinate = self.joints[number].and_then(|joint| joint.seen(body));
                measure.of(reaction, coordinate.unwrap_or([f64::NAN; 2]))
            }
        }
    }
}

impl Planned {
    /// The label, with what it says.
    fn text<'a>(&'a self, says: Cow<'a, str>, (x, y): (f64, Vertical), align: f64) -> Text<'a> {
        Text { name: &self.label.name, says, x, y, height: self.height, align, color: self.color }
    }
}

/// The other side of a body.
fn opposite(side: Side) -> Side {
    match side {
        Side::Above => Side::Below,
        Side::Below => Side::Above,
        Side::Left => Side::Right,
        Side::Right => Side::Left,
    }
}

/// A text as long as what a label may say at any moment: numbers have up to four digits before their point.
fn longest(label: &Label) -> String {
    let piece = |piece: &Piece| match piece {
        Piece::Words(words) => words.clone(),
        Piece::Value { format: Format::Short, .. } => "0.0000".to_owned(),
        Piece::Value { format: Format::Decimals(decimals), .. } => "0".repeat(decimals + 3),
        Piece::Value { format: Format::Scientific(decimals), .. } => "0".repeat(decimals + 5),
    };
    label.text.iter().map(piece).collect()
}

/// What is taken at the upper edge, or at the lower one.
struct Taken {
    is_top: bool,
    /// From where to where across the picture.
    across: [f64; 2],
    /// From how far to how far from the edge.
    inset: [f64; 2],
}

/// What a scale bar takes, whose length is a quarter of the picture at most.
fn under_bar(corner: Corner, aspect: f64) -> Taken {
    let (x, align) = across(corner);
    let left = x - 0.5 * align;
    Taken {
        is_top: is_top(corner),
        across: [left, left + 0.5],
        inset: [0.0, MARGIN + 4.0 * aspect * grid::SIZE],
    }
}

/// How far the middle of a line of text in a corner is from the edge: as near as the lines there leave room. Beyond the
/// other edge of the picture, at `most`, nothing is seen, so no room is kept.
fn inset_without_overlap(taken: &mut Vec<Taken>, corner: Corner, [wide, height]: [f64; 2], most: f64) -> f64 {
    let (x, align) = across(corner);
    let across = [x - align * wide, x - align * wide + wide];
    let overlap = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] - 1e-9 && b[0] < a[1] - 1e-9;
    let mut begin = MARGIN;
    loop {
        let down = [begin, begin + LINE * height];
        let hidden = taken.iter().filter(|line| {
            let [left, right] = line.across;
            line.is_top == is_top(corner)
                && overlap([left - height / 2.0, right + height / 2.0], across)
                && overlap(line.inset, down)
        });
        match hidden.map(|line| line.inset[1]).reduce(f64::max) {
            Some(end) if end > most => return end + height / 2.0,
            Some(end) => begin = end,
            None => {
                taken.push(Taken { is_top: is_top(corner), across, inset: down });
                return begin + height / 2.0;
            }
        }
    }
}

fn of_body(body: &Body, at: &BodySnapshot, measure: BodyMeasure) -> f64 {
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
        // Frames count them.
        BodyMeasure::Impacts => f64::NAN,
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
