//! Copies at random places in a volume, no two of them overlapping.

use std::collections::HashMap;

use glam::{DQuat, DVec3};

use super::Place;
use crate::diagnostic::{Diagnostic, Span};
use crate::scene::check::View;
use crate::scene::expand::random::Stream;

/// How copies are scattered.
pub(super) struct Scatter {
    pub(super) count: usize,
    volume: Volume,
    /// The least distance between the balls around two copies, m.
    gap: f64,
    turned: bool,
}

/// A volume around the origin; lengths in m.
enum Volume {
    Box { size: DVec3 },
    Sphere { radius: f64 },
    Cylinder { radius: f64, height: f64 },
}

/// That not all copies can be scattered.
pub(super) struct Full {
    /// The number of copies that have a place.
    placed: usize,
    /// Why the next has none.
    why: Why,
}

enum Why {
    /// It has no end.
    Endless,
    /// It is too large for the volume even alone.
    TooLarge,
    /// No place for it has been found among the others.
    Crowded,
}

impl Scatter {
    pub(super) fn read(view: &View<'_>) -> Option<Scatter> {
        let within = view.variant("within")?;
        let volume = if let Some(view) = within.variant("box") {
            Volume::Box { size: view.vector("size")? }
        } else if let Some(view) = within.variant("sphere") {
            Volume::Sphere { radius: view.number("radius")? }
        } else {
            let view = within.variant("cylinder")?;
            Volume::Cylinder { radius: view.number("radius")?, height: view.number("height")? }
        };
        Some(Scatter {
            count: usize::try_from(view.integer("count")?).ok()?,
            volume,
            gap: if view.has("gap") { view.number("gap")? } else { 0.0 },
            turned: view.boolean("turned").unwrap_or(false),
        })
    }

    /// Where copies of these sizes stand: each is placed at random until it overlaps none of those before it, so that what
    /// comes after a copy never moves it. Each draws from a stream of its own.
    pub(super) fn places(
        &self,
        sizes: &[Option<f64>],
        mut stream: impl FnMut(usize) -> Stream,
    ) -> Result<Vec<Place>, Full> {
        /// At the density at which balls of one size hardly find a place any more, one in a hundred tries succeeds.
        const TRIES: usize = 20_000;
        let largest = sizes.iter().flatten().copied().fold(0.0, f64::max);
        let mut taken = Taken { edge: 2.0 * largest + self.gap, cells: HashMap::new() };
        let mut places = Vec::with_capacity(sizes.len());
        for (placed, size) in sizes.iter().enumerate() {
            let radius = size.ok_or(Full { placed, why: Why::Endless })?;
            if !self.volume.holds(radius) {
                return Err(Full { placed, why: Why::TooLarge });
            }
            let mut stream = stream(placed);
            let turn = if self.turned { any_turn(&mut stream) } else { DQuat::IDENTITY };
            let free = (0..TRIES)
                .map(|_| self.volume.point(radius, &mut stream))
                .find(|place| taken.is_free(*place, radius + self.gap));
            let offset = free.ok_or(Full { placed, why: Why::Crowded })?;
            taken.add(offset, radius);
            places.push(Place { offset, turn });
        }
        Ok(places)
    }
}

impl Full {
    /// What is to be said of it, at the repeat.
    pub(super) fn diagnostic(&self, name: &str, count: usize, span: Span) -> Diagnostic {
        let Full { placed, why } = self;
        let (message, label) = match why {
            Why::Endless => (format!("`{name}` cannot be scattered"), "it is endless".to_owned()),
            Why::TooLarge => {
                let message = format!("`{name}[{placed}]` does not fit into the volume");
                (message, "the ball around it is larger than this".to_owned())
            }
            Why::Crowded => {
                let message = format!("only {placed} of {count} copies of `{name}` find a place");
                (message, "no more of them fit in here at random".to_owned())
            }
        };
        let error = Diagnostic::error("scatter-full", message).at(span, label);
        match why {
            Why::Endless => error,
            _ => error.help(
                "balls at random fill at most a third of a volume; more fit into a larger volume, or a `grid`",
            ),
        }
    }
}

impl Volume {
    /// Whether a ball of this radius fits. Where the volume is flat, only the centres have to lie in it.
    fn holds(&self, radius: f64) -> bool {
        let fits = |length: f64| length == 0.0 || radius <= length / 2.0;
        match self {
            Volume::Box { size } => size.to_array().into_iter().all(fits),
            Volume::Sphere { radius: outer } => radius <= *outer,
            Volume::Cylinder { radius: outer, height } => radius <= *outer && fits(*height),
        }
    }

    /// A point for the centre of a ball of this radius, any as likely.
    fn point(&self, radius: f64, stream: &mut Stream) -> DVec3 {
        let mut between = |length: f64| (2.0 * stream.uniform() - 1.0) * (length / 2.0 - radius).max(0.0);
        match self {
            Volume::Box { size } => DVec3::from_array(size.to_array().map(between)),
            Volume::Cylinder { radius: outer, height } => {
                let y = between(*height);
                let distance = (outer - radius) * stream.uniform().sqrt();
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * stream.uniform());
                DVec3::new(distance * cos, y, distance * sin)
            }
            Volume::Sphere { radius: outer } => {
                let distance = (outer - radius) * libm::cbrt(stream.uniform());
                let normal = DVec3::new(stream.normal(), stream.normal(), stream.normal());
                distance * normal.normalize_or(DVec3::X)
            }
        }
    }
}

/// A rotation, any as likely: four normal numbers have no preferred direction.
fn any_turn(stream: &mut Stream) -> DQuat {
    let [x, y, z, w] = [stream.normal(), stream.normal(), stream.normal(), stream.normal()];
    let length = (x * x + y * y + z * z + w * w).sqrt();
    if length > 0.0 {
        DQuat::from_xyzw(x / length, y / length, z / length, w / length)
    } else {
        DQuat::IDENTITY
    }
}

/// The balls that have their place, by cells of a grid that are so large that only neighbours can overlap.
struct Taken {
    edge: f64,
    cells: HashMap<[i64; 3], Vec<(DVec3, f64)>>,
}

impl Taken {
    #[allow(clippy::cast_possible_truncation, reason = "what is too far away saturates")]
    fn cell(&self, place: DVec3) -> [i64; 3] {
        (place / self.edge).floor().to_array().map(|number| number as i64)
    }

    fn is_free(&self, place: DVec3, radius: f64) -> bool {
        let [x, y, z] = self.cell(place);
        let apart = |(other, size): &(DVec3, f64)| other.distance(place) >= radius + size;
        let around = |n: i64| n.saturating_sub(1)..=n.saturating_add(1);
        around(x).all(|x| {
            around(y).all(|y| {
                around(z).all(|z| self.cells.get(&[x, y, z]).is_none_or(|balls| balls.iter().all(apart)))
            })
        })
    }

    fn add(&mut self, place: DVec3, radius: f64) {
        self.cells.entry(self.cell(place)).or_default().push((place, radius));
    }
}
