//! The marks of a scene: angles, dimension lines, swept areas, and the texts and components of arrows.

use glam::DVec3;

use super::{Color, Piece, Quantity};
use crate::physics::Anchor;

/// An angle between two directions, drawn as an arc with its name.
#[derive(Clone, Debug)]
pub struct Angle {
    /// The name of the angle, unique among angles.
    pub name: String,
    /// The point at which both legs of the angle begin.
    pub vertex: Anchor,
    /// The two legs. The angle counts from the first to the second.
    pub legs: [Leg; 2],
    /// The axis about which the angle turns, a unit vector in world axes: the angle is then that of the legs as seen along the axis, from
    /// −180° to 180°. `None` for the angle between the legs, from 0° to 180°.
    pub axis: Option<DVec3>,
    /// The radius of the arc, m. `None` for a radius that is easy to see.
    pub radius: Option<f64>,
    /// The text at the arc.
    pub text: Vec<Piece>,
    /// The color of the arc and its text. `None` for the color of texts.
    pub color: Option<Color>,
}

/// The direction of a leg of an angle, or of a component of an arrow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leg {
    /// A fixed direction, a unit vector in world axes.
    Along(DVec3),
    /// The direction from the vertex of the angle, or from the arrow's body, to a point.
    Towards(Anchor),
    /// The direction of a vector of a body.
    Of {
        /// The index of the body.
        body: usize,
        /// The quantity.
        quantity: Quantity,
        /// The size up to which the vector counts as zero, in SI units: rounding leaves a little where a vector vanishes.
        negligible: f64,
    },
}

/// A dimension line: a line with the distance that it measures.
#[derive(Clone, Debug)]
pub struct Distance {
    /// The name of the distance, unique among distances.
    pub name: String,
    /// The two points between which it is measured.
    pub between: [Anchor; 2],
    /// The direction along which it is measured, a unit vector in world axes. `None` for the direction from point to point.
    pub along: Option<DVec3>,
    /// The way from the points to the drawn line, m, in world axes.
    pub offset: DVec3,
    /// The text at the line. `None` for the distance with its unit.
    pub text: Option<Vec<Piece>>,
    /// The color of the line and its text. `None` for the color of texts.
    pub color: Option<Color>,
}

/// The areas that the line from a center to a body sweeps, drawn as sectors.
#[derive(Clone, Debug)]
pub struct Area {
    /// The name of the area, unique among areas.
    pub name: String,
    /// The body, as an index in the scene.
    pub body: usize,
    /// The center. The path of the body is that relative to the center.
    pub center: Anchor,
    /// The time at which the first sector begins, s.
    pub from: f64,
    /// The time that the line needs for a sector, s.
    pub every: f64,
    /// The time at which the last sector ends at the latest, s.
    pub until: f64,
    /// The color of the sectors. `None` for a color of the palette of curves.
    pub color: Option<Color>,
}

impl Area {
    /// The largest number of sectors.
    pub const MAX_SECTORS: f64 = 1000.0;

    /// The times (s) at which a sector begins and ends. The first sector has the number 0.
    #[allow(clippy::cast_precision_loss, reason = "there are few sectors")]
    pub fn times(&self, number: usize) -> [f64; 2] {
        [number, number + 1].map(|end| self.from + end as f64 * self.every)
    }
}

/// What is drawn with an arrow: a text at its tip, and its components.
#[derive(Clone, Debug)]
pub struct ArrowMark {
    /// The body or joint that has the arrow.
    pub owner: ArrowOwner,
    /// The quantity that the arrow shows.
    pub quantity: Quantity,
    /// The text at the tip. `None` for no text.
    pub text: Option<Vec<Piece>>,
    /// The components of the arrow. `None` if they are not drawn.
    pub components: Option<Components>,
}

/// The two components of an arrow: the one along a direction, and the one across it.
#[derive(Clone, Debug)]
pub struct Components {
    /// The direction, as seen from the center of the arrow's body, or from the beginning of the arrow of a joint.
    pub along: Leg,
    /// The texts at the tips of both components. `None` for no texts.
    pub texts: Option<[Vec<Piece>; 2]>,
}

/// The body, joint or force that has an arrow, by its index in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ArrowOwner {
    /// A body.
    Body(usize),
    /// A joint.
    Joint(usize),
    /// A named force, with an arrow at each of its bodies.
    Force(usize),
}

/// The Greek letters by their English names.
const GREEK: [(&str, &str); 24] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("iota", "ι"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("omicron", "ο"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("upsilon", "υ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
];

impl Angle {
    /// The usual text of an angle: its name, in which a word that spells a Greek letter is that letter: `alpha`, `Phi`, `omega_0`.
    pub fn usual_text(name: &str) -> String {
        let end = name.find('_').unwrap_or(name.len());
        let word = &name[..end];
        let small = word.to_lowercase();
        let Some((_, letter)) = GREEK.iter().find(|(known, _)| *known == small) else {
            return name.to_owned();
        };
        let is_capital = word.starts_with(char::is_uppercase);
        let letter = if is_capital { letter.to_uppercase() } else { (*letter).to_owned() };
        letter + &name[end..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::font::{Typeface, Weight};

    #[test]
    fn a_name_that_spells_a_greek_letter_is_written_as_the_letter() {
        for (name, text) in
            [("alpha", "α"), ("launch", "launch"), ("omega_0", "ω_0"), ("Phi", "Φ"), ("my_pi", "my_pi")]
        {
            assert_eq!(Angle::usual_text(name), text);
        }
        let font = Typeface::usual().font(Weight::Regular);
        assert!(GREEK.iter().all(|(_, letter)| letter.chars().all(|letter| font.has(letter))));
    }
}
