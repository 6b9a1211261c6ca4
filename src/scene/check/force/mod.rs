//! Reads the forces of a scene from `[force.NAME]`.

mod fields;
mod formula;
mod on;
mod pairs;
mod spring;

use std::collections::HashSet;
use std::sync::Arc;

use super::view::View;
use super::{Context, showing};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{ConstantForce, Coulomb, Drag, Gravitation, LennardJones, Lorentz};
use crate::scene::grammar::forces::{constant, coulomb, drag, force, gravitation, lennard_jones, lorentz};
use crate::scene::grammar::marks::field;
use crate::scene::grammar::scene::scene;
use crate::scene::grammar::{Any, Key, KeySpec};
use crate::scene::source::Node;
use crate::scene::{Body, Emitter, Force, ForceKind, SimulationSettings};

/// Reads one force of any kind.
struct Reader<'a, 'c> {
    /// The name of the force.
    name: &'a str,
    span: Span,
    bodies: &'a [Body],
    emitters: &'a [Emitter],
    simulation: &'a SimulationSettings,
    /// Whether the force acts on the particles of an emitter.
    has_particles: bool,
    /// Whether the scene draws the field of the force, so that the force shows something without acting on a body.
    is_field_drawn: bool,
    /// The warning text that says why the force does not act on a body, such as "it has no charge".
    lack: &'static str,
    /// Whether this kind of force has the key `softening`.
    softens: bool,
    /// The codes and source spans of the diagnostics reported for this force. The name of a body with a `repeat` stands for all copies of
    /// the body, and one diagnostic is enough.
    reported: HashSet<(Code, Span)>,
    context: &'a mut Context<'c>,
}

/// The warning text for an electric force on an uncharged body.
const NO_CHARGE: &str = "it has no charge";

pub(super) fn read(
    root: &View<'_>,
    bodies: &[Body],
    emitters: &[Emitter],
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> Vec<Force> {
    let tables = root.named(&scene::FORCE);
    let drawn_fields: Vec<&str> =
        root.named(&scene::FIELD).iter().filter_map(|(.., view)| view.get(&field::FORCE)).collect();
    let read = |(name, span, view): (&str, Span, View<'_>)| {
        let before = context.diagnostics.len();
        let mut reader = Reader {
            name,
            span,
            bodies,
            emitters,
            simulation,
            has_particles: false,
            is_field_drawn: drawn_fields.contains(&name),
            lack: NO_CHARGE,
            softens: true,
            reported: HashSet::new(),
            context,
        };
        let emitters = reader.emitters_of(&view);
        reader.has_particles = !emitters.is_empty();
        let chosen = chosen(&view);
        let arrow = chosen.as_ref().and_then(|(_, view)| showing::arrow(view, &constant::ARROW.spec));
        let kind = chosen.and_then(|(kind, view)| (kind.read)(&mut reader, &view));
        if context.wrong_forces.contains(name) {
            // Drop the warning that the force has no effect: the key with the error may be the key that the warning calls missing.
            let mut said = context.diagnostics.split_off(before);
            said.retain(|it| it.code != Code::NoEffect || it.span() != Some(span));
            context.diagnostics.append(&mut said);
        }
        context.once(before, name, span);
        let kind = kind?;
        Some(Force { name: name.to_owned(), kind, arrow, emitters })
    };
    tables.into_iter().filter_map(read).collect()
}

/// A kind of force: its key, the particles that it acts on, and the function that reads its table.
struct Kind {
    key: &'static Key<Any>,
    particles: ActsOn,
    read: fn(&mut Reader<'_, '_>, &View<'_>) -> Option<ForceKind>,
}

/// The particles that a kind of force acts on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ActsOn {
    /// All particles.
    Particles,
    /// Particles with a charge.
    ChargedParticles,
    /// No particles, although its key `on` takes emitters.
    NoParticles,
    /// Only the bodies that it connects: it has no key `on`.
    ItsEnds,
}

/// All kinds of forces.
static KINDS: [Kind; 11] = [
    Kind { key: &force::CONSTANT, particles: ActsOn::Particles, read: |reader, view| reader.constant(view) },
    Kind { key: &force::DRAG, particles: ActsOn::Particles, read: |reader, view| reader.drag(view) },
    Kind { key: &force::SPRING, particles: ActsOn::ItsEnds, read: |reader, view| reader.spring(view) },
    Kind {
        key: &force::GRAVITATION,
        particles: ActsOn::Particles,
        read: |reader, view| reader.gravitation(view),
    },
    Kind {
        key: &force::COULOMB,
        particles: ActsOn::ChargedParticles,
        read: |reader, view| reader.coulomb(view),
    },
    Kind {
        key: &force::LORENTZ,
        particles: ActsOn::ChargedParticles,
        read: |reader, view| reader.lorentz(view),
    },
    Kind {
        key: &force::LENNARD_JONES,
        particles: ActsOn::Particles,
        read: |reader, view| reader.lennard_jones(view),
    },
    Kind { key: &force::BUOYANCY, particles: ActsOn::Particles, read: |reader, view| reader.buoyancy(view) },
    Kind { key: &force::DIPOLES, particles: ActsOn::NoParticles, read: |reader, view| reader.dipoles(view) },
    Kind { key: &force::J2, particles: ActsOn::Particles, read: |reader, view| reader.j2(view) },
    Kind { key: &force::FORMULA, particles: ActsOn::Particles, read: |reader, view| reader.formula(view) },
];

/// Returns the kind of a force, and its table. `None` if the force has no kind, which the validation has reported.
fn chosen<'a>(force: &View<'a>) -> Option<(&'static Kind, View<'a>)> {
    KINDS.iter().find_map(|kind| Some((kind, force.variant(kind.key)?)))
}

impl Reader<'_, '_> {
    fn constant(&mut self, view: &View<'_>) -> Option<ForceKind> {
        Some(ForceKind::OnEach(Arc::new(ConstantForce {
            bodies: self.movable(view),
            force: view.get(&constant::FORCE),
            torque: view.get(&constant::TORQUE),
        })))
    }

    fn drag(&mut self, view: &View<'_>) -> Option<ForceKind> {
        self.needs_one_of(view, &[&drag::LINEAR.spec, &drag::QUADRATIC.spec]);
        Some(ForceKind::OnEach(Arc::new(Drag {
            bodies: self.movable(view),
            linear: view.get(&drag::LINEAR),
            quadratic: view.get(&drag::QUADRATIC),
            wind: view.get(&drag::WIND),
        })))
    }

    fn gravitation(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let softening = view.get(&gravitation::SOFTENING);
        let (bodies, against) = self.pairs(view, softening, |_| true);
        let constant = view.get(&gravitation::CONSTANT);
        // With an opening angle of 0, no Barnes–Hut tree is used: the force is the exact sum over all pairs of bodies.
        let opening_angle = view.get(&gravitation::OPENING_ANGLE).filter(|&angle| angle > 0.0);
        Some(ForceKind::Between(Arc::new(Gravitation {
            bodies,
            against,
            constant,
            softening,
            opening_angle,
        })))
    }

    fn coulomb(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let softening = view.get(&coulomb::SOFTENING);
        let all = self.bodies;
        let (bodies, against) = self.pairs(view, softening, |i| all[i].start.charge != 0.0);
        let constant = view.get(&coulomb::CONSTANT);
        Some(ForceKind::Between(Arc::new(Coulomb { bodies, against, constant, softening })))
    }

    fn lennard_jones(&mut self, view: &View<'_>) -> Option<ForceKind> {
        self.softens = false;
        let (bodies, against) = self.pairs(view, 0.0, |_| true);
        let (epsilon, sigma) = (view.get(&lennard_jones::EPSILON)?, view.get(&lennard_jones::SIGMA)?);
        let cutoff = view.get(&lennard_jones::CUTOFF).unwrap_or(LennardJones::CUTOFF * sigma);
        let smooth = view.get(&lennard_jones::SMOOTH);
        Some(ForceKind::Between(Arc::new(LennardJones { bodies, against, epsilon, sigma, cutoff, smooth })))
    }

    fn lorentz(&mut self, view: &View<'_>) -> Option<ForceKind> {
        self.needs_one_of(view, &[&lorentz::ELECTRIC.spec, &lorentz::MAGNETIC.spec]);
        Some(ForceKind::OnEach(Arc::new(Lorentz {
            bodies: self.charged(view),
            electric: view.get(&lorentz::ELECTRIC),
            magnetic: view.get(&lorentz::MAGNETIC),
        })))
    }

    /// Warns of a force that has none of the given keys. Such a force is zero.
    fn needs_one_of(&mut self, view: &View<'_>, keys: &[&KeySpec]) {
        if !keys.iter().any(|key| view.has(key)) {
            let name = self.name;
            let keys: Vec<String> = keys.iter().map(|key| format!("`{}`", key.name)).collect();
            let message = || format!("the force `{name}` has no effect");
            self.no_effect(message, self.span, format!("it has no {}", keys.join(" and no ")));
        }
    }

    /// Adds a diagnostic, unless one with the same code and span has been added for this force. The span of the force's own name may have
    /// several diagnostics.
    fn report(&mut self, code: Code, span: Span, diagnostic: impl FnOnce() -> Diagnostic) {
        if span == self.span || self.reported.insert((code, span)) {
            self.context.diagnostics.push(diagnostic());
        }
    }

    fn no_effect(&mut self, message: impl FnOnce() -> String, span: Span, why: impl Into<String>) {
        self.report(Code::NoEffect, span, || Diagnostic::warning(Code::NoEffect, message()).at(span, why));
    }

    /// Returns the index of the body that `node` names. `None` if no body has this name; validation has already reported that error.
    fn body(&self, node: &Node) -> Option<usize> {
        node.as_str().and_then(|name| self.context.names.bodies.get(name)).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::KINDS;
    use crate::scene::grammar::Rule;
    use crate::scene::grammar::forces::force;

    #[test]
    fn each_kind_of_force_in_the_grammar_is_read() {
        let Rule::ExactlyOne(names) = force::TABLE.rule else { panic!("a force has one kind") };
        let read: Vec<&str> = KINDS.iter().map(|kind| kind.key.spec.name).collect();
        assert!(names.iter().all(|name| read.contains(name)), "{names:?} {read:?}");
        assert_eq!(names.len(), read.len());
    }
}
