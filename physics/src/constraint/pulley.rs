//! A pulley: a rope that runs over points.

use glam::DVec3;

use super::super::{Anchor, BodyId};
use super::member::End;
use super::{Constraint, Equations, Law, Members, Scale, parts};

/// A massless, frictionless rope that runs from one end over points to the other end. The points belong to bodies or to the world. The rope
/// can be slack. Each part of it keeps a smallest length, unless both of its ends are on the same body or points of the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Pulley {
    /// The points of the rope in order: its first end, the points over which it runs, and its second end.
    path: Vec<Anchor>,
    /// The bodies of the points, each once, in the order of the points.
    bodies: Vec<BodyId>,
    /// For each point, the index of its body among the bodies. `None` for a point of the world.
    body_of: Vec<Option<usize>>,
    /// How much the last part of the rope counts. It is positive. With 2, the other parts gain two meters for each that the last part loses,
    /// as in a block and tackle.
    pub ratio: f64,
    /// ℓ: the length of the rope, in which the last part counts `ratio` times, m.
    pub length: f64,
}

/// A part of the rope of a pulley: the straight line from one of its points to the next.
#[derive(Clone, Copy, Debug)]
pub struct PulleyPart {
    /// The two points.
    pub ends: [Anchor; 2],
    /// How much the part counts in the length of the rope.
    pub factor: f64,
    /// True if the length of the part can change: its ends are not on the same body, nor both points of the world.
    pub can_change: bool,
    body_of: [Option<usize>; 2],
}

impl PulleyPart {
    fn ends<'a>(&self, members: &'a Members<'_>) -> [End<'a>; 2] {
        [0, 1].map(|i| End::of(self.ends[i], self.body_of[i], members))
    }
}

impl Pulley {
    /// The smallest length of a part of the rope, as a fraction of the mean length of its parts.
    pub const NEAREST: f64 = 0.01;

    /// Creates a rope of a length (m) with two ends and the points over which it runs. The last part counts `ratio` times.
    #[must_use]
    pub fn new(between: [Anchor; 2], over: &[Anchor], ratio: f64, length: f64) -> Pulley {
        let path: Vec<Anchor> = between[..1].iter().chain(over).chain(&between[1..]).copied().collect();
        let bodies = parts::bodies(&path);
        let of = |anchor: &Anchor| bodies.iter().position(|id| Some(*id) == anchor.body());
        let body_of = path.iter().map(of).collect();
        Pulley { path, bodies, body_of, ratio, length }
    }

    /// Returns the points of the rope in order: its first end, the points over which it runs, and its second end.
    #[must_use]
    pub fn path(&self) -> &[Anchor] {
        &self.path
    }

    /// Returns the two ends of the rope.
    #[must_use]
    pub fn between(&self) -> [Anchor; 2] {
        let end = |end: Option<&Anchor>| end.copied().unwrap_or(Anchor::Point(DVec3::ZERO));
        [end(self.path.first()), end(self.path.last())]
    }

    /// Returns the parts of the rope in order.
    pub fn parts(&self) -> impl Iterator<Item = PulleyPart> {
        let last = self.path.len().saturating_sub(2);
        let parts = self.path.windows(2).zip(self.body_of.windows(2)).enumerate();
        parts.map(move |(number, (ends, body_of))| PulleyPart {
            ends: [ends[0], ends[1]],
            factor: if number == last { self.ratio } else { 1.0 },
            can_change: body_of[0] != body_of[1],
            body_of: [body_of[0], body_of[1]],
        })
    }

    /// Returns the smallest length of a part whose length can change, m.
    #[must_use]
    pub fn nearest(&self) -> f64 {
        Pulley::NEAREST * self.mean()
    }

    /// Returns the mean length of a part of the taut rope, m.
    fn mean(&self) -> f64 {
        self.length / self.parts().map(|part| part.factor).sum::<f64>()
    }
}

impl Constraint for Pulley {
    fn ends(&self) -> Vec<Anchor> {
        self.path.clone()
    }

    fn bodies(&self) -> Vec<BodyId> {
        self.bodies.clone()
    }

    fn rows(&self) -> usize {
        1 + self.parts().filter(|part| part.can_change).count()
    }

    fn law(&self, _: usize) -> Law {
        Law::Inequality
    }

    /// Writes c = ℓ − Σ fᵢ |dᵢ| ≥ 0, where dᵢ is the vector along part i of the rope, and fᵢ tells how much the part counts. Another row
    /// for each part that can change keeps |dᵢ| above the smallest length.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let (typical, nearest) = (self.mean(), self.nearest());
        let (mut left, mut bias, mut scale) = (self.length, 0.0, Scale::length(self.length, self.length));
        for part in self.parts() {
            let ends = part.ends(members);
            let way = parts::EndToEndVector::new(&ends, typical);
            left -= part.factor * way.length;
            bias -= if part.can_change { part.factor * way.bias } else { 0.0 };
            scale = scale.max(way.scale);
        }
        equations.row(0, left, bias, scale);
        for (i, part) in self.parts().filter(|part| part.can_change).enumerate() {
            let ends = part.ends(members);
            let way = parts::EndToEndVector::new(&ends, typical);
            way.write(-part.factor, 0, equations);
            equations.row(1 + i, way.length - nearest, way.bias, way.scale.at_least(self.length));
            way.write(1.0, 1 + i, equations);
        }
    }

    /// Returns the pull of the last part: the rope may also act elsewhere on the body of its second end.
    fn force_on_last_end(&self, members: &Members<'_>, multipliers: &[f64]) -> Option<DVec3> {
        let last = self.parts().last()?;
        let ends = last.ends(members);
        let way = parts::EndToEndVector::new(&ends, self.mean());
        let stop = if last.can_change { *multipliers.last()? } else { 0.0 };
        Some((stop - last.factor * multipliers.first()?) * way.direction())
    }
}
