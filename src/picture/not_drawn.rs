//! Finds things that a scene requests but that no picture of the run shows.

use super::arrows::{LONGEST, round_down};
use super::ghosts;
use super::links::{Links, SpringSize};
use super::text::MARGIN;
use crate::decimal::decimal_step;
use crate::scene::{Quantity, Scene};
use crate::simulate::Survey;

/// The length below which an arrow is invisible, pixels.
const MIN_VISIBLE_LENGTH: f64 = 1.0;
/// The width below which a line is invisible, pixels.
const MIN_VISIBLE_WIDTH: f64 = 0.1;

/// A requested thing that is invisible in all pictures, or from some time on. Lengths are in meters.
#[derive(Clone, Debug, PartialEq)]
pub struct NotDrawn {
    /// The requested thing.
    pub what: RequestedItem,
    /// The name of the body or force that requests the thing. Empty for the scale bar.
    pub name: String,
    /// The reason why the thing is invisible.
    pub why: Reason,
    /// The number of other things of the same kind that are invisible for the same reason.
    pub others: usize,
}

/// The kind of a requested thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RequestedItem {
    /// An arrow of a body.
    Arrow(Quantity),
    /// The arrows of a force.
    ForceArrow,
    /// The coordinate axes of a body.
    Axes,
    /// The trail of a body.
    Trail,
    /// The ghosts of a body.
    Ghosts,
    /// The coil of a spring.
    Coil,
    /// The straight line of a spring.
    Line,
    /// The scale bar.
    ScaleBar,
}

/// The reason why a requested thing is invisible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The thing is too small in the picture.
    TooSmall {
        /// The largest length or width of the thing in any picture, pixels.
        pixels: f64,
        /// A value that would make the thing visible, for the key of the scene that sets its size, in the unit of this key.
        fit: f64,
    },
    /// The tip of the arrow becomes non-finite.
    Lost {
        /// The time of the first frame with a non-finite tip, s.
        time: f64,
        /// A scale that would make the arrow visible, in the unit of its key. `None` if no frame has a finite arrow.
        fit: Option<f64>,
    },
    /// The path of the body is shorter than half the width of its trail.
    Wide {
        /// The largest distance of the body from the start of its trail.
        way: f64,
        /// The width of the trail.
        width: f64,
    },
    /// The body has no contacts.
    Untouched,
    /// The body hardly moves, so its ghosts coincide with it.
    Still,
    /// The body disappears before the time of its first ghost.
    Gone,
    /// The scale bar is wider than the picture.
    TooLong {
        /// The length that the scale bar represents.
        length: f64,
        /// A length for which the picture has room.
        fit: f64,
    },
    /// The bodies at the ends of the spring are too close together to draw the spring.
    NoRoom {
        /// The radius of the spring.
        radius: f64,
        /// A radius at which the spring would be drawn. `None` if the bodies at its ends touch or overlap.
        fit: Option<f64>,
    },
}

/// Finds the requested things that no picture shows. `view` is the smallest width in view of the camera, m. `bar` is the length of the
/// scale bar, m, and its width at the start in the image plane, where the picture has a width of 2.
pub(super) fn find(
    scene: &Scene,
    survey: &Survey,
    links: &Links,
    view: f64,
    bar: Option<(f64, f64)>,
) -> Vec<NotDrawn> {
    let pixel = view / f64::from(scene.output.width);
    let mut found = Found::default();
    for arrow in &survey.requested.arrows {
        let body = &scene.bodies[arrow.body];
        let kind = Quantity::OF_BODIES.iter().position(|quantity| *quantity == arrow.quantity);
        let scale = kind.and_then(|kind| body.showing.arrows[kind]?.scale);
        let fit = (arrow.longest > 0.0).then(|| round_down(LONGEST * view / arrow.longest));
        let why = match (arrow.lost, scale, fit) {
            (Some(time), ..) => Reason::Lost { time, fit },
            (None, Some(scale), Some(fit)) if arrow.longest * scale < MIN_VISIBLE_LENGTH * pixel => {
                Reason::TooSmall { pixels: arrow.longest * scale / pixel, fit }
            }
            _ => continue,
        };
        found.add(RequestedItem::Arrow(arrow.quantity), &body.name, why);
    }
    for arrow in &survey.requested.loads {
        let body = &scene.bodies[arrow.body];
        let kind = Quantity::OF_LOADS.iter().position(|quantity| *quantity == arrow.quantity);
        let scale = kind.and_then(|kind| body.showing.loads[kind]?.scale);
        let why = match scale {
            // A body without normal force had no contact. Friction can be zero in spite of a contact.
            _ if arrow.quantity == Quantity::Normal && arrow.longest == 0.0 => Reason::Untouched,
            Some(scale) if arrow.longest > 0.0 && arrow.longest * scale < MIN_VISIBLE_LENGTH * pixel => {
                let fit = round_down(LONGEST * view / arrow.longest);
                Reason::TooSmall { pixels: arrow.longest * scale / pixel, fit }
            }
            _ => continue,
        };
        found.add(RequestedItem::Arrow(arrow.quantity), &body.name, why);
    }
    for (number, longest) in &survey.requested.forces {
        let force = &scene.forces[*number];
        let scale = force.arrow.and_then(|arrow| arrow.scale);
        if let Some(scale) =
            scale.filter(|scale| *longest > 0.0 && longest * scale < MIN_VISIBLE_LENGTH * pixel)
        {
            let fit = round_down(LONGEST * view / longest);
            found.add(
                RequestedItem::ForceArrow,
                &force.name,
                Reason::TooSmall { pixels: longest * scale / pixel, fit },
            );
        }
    }
    for body in &scene.bodies {
        let Some(length) = body.showing.axes.and_then(|axes| axes.length) else { continue };
        if length < MIN_VISIBLE_LENGTH * pixel {
            let why = Reason::TooSmall { pixels: length / pixel, fit: decimal_step(0.2 * view) };
            found.add(RequestedItem::Axes, &body.name, why);
        }
    }
    for trail in &survey.requested.trails {
        let body = &scene.bodies[trail.body];
        let Some(width) = body.showing.trail.and_then(|trail| trail.width) else { continue };
        if width < MIN_VISIBLE_WIDTH * pixel {
            let why = Reason::TooSmall { pixels: width / pixel, fit: decimal_step(6.0 * pixel) };
            found.add(RequestedItem::Trail, &body.name, why);
        } else if trail.largest_distance > 0.0 && trail.largest_distance <= width / 2.0 {
            found.add(RequestedItem::Trail, &body.name, Reason::Wide { way: trail.largest_distance, width });
        }
    }
    for asked in &survey.requested.ghosts {
        let body = &scene.bodies[asked.body];
        let why = match asked.largest_distance {
            None => Reason::Gone,
            Some(way) if way <= ghosts::near(body) && !ghosts::is_turned(asked.turn) => Reason::Still,
            Some(_) => continue,
        };
        // Ghosts of a fixed body are invisible as expected, so no warning is needed.
        if !body.start.fixed {
            found.add(RequestedItem::Ghosts, &body.name, why);
        }
    }
    for (spring, size) in survey.requested.springs.iter().zip(links.springs()) {
        let SpringSize { radius, room, is_coil } = *size;
        let what = if is_coil { RequestedItem::Coil } else { RequestedItem::Line };
        if room >= spring.largest_gap {
            let fit = (spring.largest_gap > 0.0).then(|| decimal_step(0.3 * spring.largest_gap));
            found.add(what, &spring.force, Reason::NoRoom { radius, fit });
        } else if is_coil && 2.0 * radius < MIN_VISIBLE_WIDTH * pixel {
            let why = Reason::TooSmall {
                pixels: 2.0 * radius / pixel,
                fit: decimal_step(0.1 * spring.largest_gap),
            };
            found.add(what, &spring.force, why);
        }
    }
    if let Some((length, wide)) = bar.filter(|(_, wide)| *wide > 2.0 - 2.0 * MARGIN) {
        let why = Reason::TooLong { length, fit: decimal_step(0.5 * length / wide) };
        found.add(RequestedItem::ScaleBar, "", why);
    }
    found.0
}

/// The invisible things found so far. For each kind of thing and each reason, only the first is kept, and the others are counted.
#[derive(Default)]
struct Found(Vec<NotDrawn>);

impl Found {
    fn add(&mut self, what: RequestedItem, name: &str, why: Reason) {
        let is_same = |known: &&mut NotDrawn| {
            known.what == what && std::mem::discriminant(&known.why) == std::mem::discriminant(&why)
        };
        match self.0.iter_mut().find(is_same) {
            // A spring force with several links counts once.
            Some(known) if known.name == name => {}
            Some(known) => known.others += 1,
            None => self.0.push(NotDrawn { what, name: name.to_owned(), why, others: 0 }),
        }
    }
}
