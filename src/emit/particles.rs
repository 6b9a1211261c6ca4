//! Writes the particles of emitters in SDL: balls or streaks, in groups of one color and size.
//!
//! Each particle takes one short line, which POV-Ray parses fast. Its coordinates are rounded to a hundredth of its radius or finer.

use std::fmt::Write as _;
use std::sync::Arc;

use glam::DVec3;

use super::sdl::Style;
use super::text;
use crate::decimal::decimal_step;
use crate::physics::Particle;
use crate::scene::{Emitter, Scene};
use crate::simulate::Frame;

/// The largest number of age groups of an emitter's particles. Each group has one color and size, so the groups show how particles change
/// with age.
const MAX_AGE_GROUPS: usize = 32;
/// The precision of coordinates, relative to the radius of a particle.
const COORDINATE_PRECISION: f64 = 0.01;

/// The part of the particles' text that is equal in all frames.
pub(super) struct Particles {
    style: Style,
    emitters: Vec<Looks>,
}

/// The looks of an emitter's particles. `streak` is the time of motion that each particle shows as a streak, s.
struct Looks {
    name: Arc<str>,
    /// The look of the particles in each age group, from birth to death.
    groups: Vec<Look>,
    streak: f64,
}

/// The look of all particles in one age group.
struct Look {
    /// The drawn radius of a particle, m.
    radius: f64,
    /// The SDL text after the last particle of the group: the material and the closing brace.
    usage: String,
}

impl Particles {
    /// Prepares the part of the particles' text that is equal in all frames.
    pub(super) fn new(scene: &Scene, style: Style) -> Particles {
        let looks = |emitter: &Emitter| Looks {
            name: text::comment(&emitter.name).into(),
            groups: groups(emitter, style),
            streak: emitter.streak,
        };
        Particles { style, emitters: scene.emitters.iter().map(looks).collect() }
    }

    /// Appends the particles of a frame. The error is the name of an emitter with a particle whose location is not finite in POV-Ray
    /// units.
    pub(super) fn write(&self, out: &mut String, frame: &Frame) -> Result<(), &str> {
        for (looks, particles) in self.emitters.iter().zip(&frame.particles) {
            if particles.iter().any(|particle| !self.style.can_write(particle.location)) {
                return Err(&looks.name);
            }
            self.emitter(out, looks, particles, frame.time);
        }
        Ok(())
    }

    fn emitter(&self, out: &mut String, looks: &Looks, particles: &[Particle], time: f64) {
        let count = looks.groups.len();
        let mut of_group: Vec<Vec<&Particle>> = vec![Vec::new(); count];
        for particle in particles {
            of_group[group(particle.age(time), count)].push(particle);
        }
        for (look, particles) in looks.groups.iter().zip(of_group) {
            let is_seen = self.style.can_tell(DVec3::ZERO, DVec3::X * look.radius);
            // POV-Ray warns about a union of one object.
            let opening = match particles.len() {
                0 => continue,
                _ if !is_seen => continue,
                1 => "object {",
                _ => "union {",
            };
            let _ = writeln!(out, "{opening} // {}", looks.name);
            let step = decimal_step(look.radius * COORDINATE_PRECISION);
            let mut radius = String::new();
            self.style.length(&mut radius, look.radius);
            for particle in particles {
                let head = rounded(particle.location, step);
                let past = looks.streak.min(time - particle.born);
                let tail = rounded(particle.location - past * particle.velocity, step);
                if past > 0.0 && head.distance(tail) > look.radius && tail.is_finite() {
                    out.push_str("  cone { ");
                    self.style.point(out, tail);
                    out.push_str(", 0, ");
                } else {
                    out.push_str("  sphere { ");
                }
                self.style.point(out, head);
                out.push_str(", ");
                out.push_str(&radius);
                out.push_str(" }\n");
            }
            out.push_str(&look.usage);
        }
    }
}

/// Rounds a location to multiples of `step`, unless rounding overflows.
fn rounded(place: DVec3, step: f64) -> DVec3 {
    let rounded = (place / step).round() * step;
    if rounded.is_finite() { rounded } else { place }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "an age goes from 0 to 1, and groups are few"
)]
fn group(age: f64, groups: usize) -> usize {
    ((age * groups as f64) as usize).min(groups - 1)
}

/// Returns the looks of an emitter's age groups, from birth to death. There is a single look if neither color nor size changes.
fn groups(emitter: &Emitter, style: Style) -> Vec<Look> {
    let changes = emitter.colors.len() > 1 || emitter.sizes.len() > 1;
    let count = if changes && emitter.source.longest_life.is_finite() { MAX_AGE_GROUPS } else { 1 };
    let look = |number: usize| {
        // The first group has the look at birth, and the last group has the look at death. The groups between have the looks at evenly
        // spaced ages.
        #[allow(clippy::cast_precision_loss, reason = "groups are few")]
        let age = if count == 1 { 0.0 } else { number as f64 / (count - 1) as f64 };
        let color = super::showing::color(emitter.color_at(age), style);
        let usage = if emitter.glow > 0.0 {
            let mut glow = String::new();
            Style { unit: 1.0, ..style }.length(&mut glow, emitter.glow);
            format!(
                "  pigment {{ color srgb {color} }}\n  finish {{ ambient 0 diffuse 0 emission {glow} }}\n  no_shadow\n}}\n"
            )
        } else {
            format!(
                "  pigment {{ color srgb {color} }}\n  finish {{ ambient 0.2 diffuse 0.75 specular 0.3 roughness 0.02 }}\n}}\n"
            )
        };
        Look { radius: emitter.radius_at(age), usage }
    };
    (0..count).map(look).collect()
}
