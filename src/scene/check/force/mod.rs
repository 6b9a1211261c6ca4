//! Reads the forces of a scene from `[force.NAME]`.

mod fields;
mod formula;
mod on;
mod pairs;
mod spring;

use std::collections::HashSet;

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{ConstantForce, Coulomb, Drag, Gravitation, LennardJones, Lorentz};
use crate::scene::grammar::forces::{constant, coulomb, drag, gravitation, lennard_jones, lorentz};
use crate::scene::grammar::scene::scene;
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
    let read = |(name, span, view): (&str, Span, View<'_>)| {
        let before = context.diagnostics.len();
        let mut reader = Reader {
            name,
            span,
            bodies,
            emitters,
            simulation,
            has_particles: false,
            lack: NO_CHARGE,
            softens: true,
            reported: HashSet::new(),
            context,
        };
        let emitters = reader.emitters_of(&view);
        reader.has_particles = !emitters.is_empty();
        let kind = reader.kind(&view);
        if context.wrong_forces.contains(name) {
            // Drop the warning that the force has no effect: the key with the error may be the key that the warning calls missing.
            let mut said = context.diagnostics.split_off(before);
            said.retain(|it| it.code != Code::NoEffect || it.span() != Some(span));
            context.diagnostics.append(&mut said);
        }
        context.once(before, name, span);
        let kind = kind?;
        Some(Force { name: name.to_owned(), kind, emitters })
    };
    tables.into_iter().filter_map(read).collect()
}

impl Reader<'_, '_> {
    fn kind(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let (kind, view) = view.chosen()?;
        match kind {
            "constant" => Some(self.constant(&view)),
            "drag" => Some(self.drag(&view)),
            "spring" => self.spring(&view),
            "gravitation" => Some(self.gravitation(&view)),
            "coulomb" => Some(self.coulomb(&view)),
            "lorentz" => Some(self.lorentz(&view)),
            "lennard_jones" => self.lennard_jones(&view),
            "buoyancy" => self.buoyancy(&view),
            "dipoles" => Some(self.dipoles(&view)),
            "j2" => self.j2(&view),
            "formula" => self.formula(&view),
            kind => unreachable!("a `{kind}` is in the grammar, and nothing reads it"),
        }
    }

    fn constant(&mut self, view: &View<'_>) -> ForceKind {
        ForceKind::Constant(ConstantForce {
            bodies: self.movable(view),
            force: view.get(&constant::FORCE),
            torque: view.get(&constant::TORQUE),
        })
    }

    fn drag(&mut self, view: &View<'_>) -> ForceKind {
        self.needs_one_of(view, &["linear", "quadratic"]);
        ForceKind::Drag(Drag {
            bodies: self.movable(view),
            linear: view.get(&drag::LINEAR),
            quadratic: view.get(&drag::QUADRATIC),
            wind: view.get(&drag::WIND),
        })
    }

    fn gravitation(&mut self, view: &View<'_>) -> ForceKind {
        let softening = view.get(&coulomb::SOFTENING);
        let (bodies, against) = self.pairs(view, softening, |_| true);
        let constant = view.get(&gravitation::CONSTANT);
        // With an opening angle of 0, no Barnes–Hut tree is used: the force is the exact sum over all pairs of bodies.
        let opening_angle = view.get(&gravitation::OPENING_ANGLE).filter(|&angle| angle > 0.0);
        ForceKind::Gravitation(Gravitation { bodies, against, constant, softening, opening_angle })
    }

    fn coulomb(&mut self, view: &View<'_>) -> ForceKind {
        let softening = view.get(&coulomb::SOFTENING);
        let all = self.bodies;
        let (bodies, against) = self.pairs(view, softening, |i| all[i].start.charge != 0.0);
        let constant = view.get(&gravitation::CONSTANT);
        ForceKind::Coulomb(Coulomb { bodies, against, constant, softening })
    }

    fn lennard_jones(&mut self, view: &View<'_>) -> Option<ForceKind> {
        self.softens = false;
        let (bodies, against) = self.pairs(view, 0.0, |_| true);
        let (epsilon, sigma) = (view.get(&lennard_jones::EPSILON)?, view.get(&lennard_jones::SIGMA)?);
        let cutoff = view.get(&lennard_jones::CUTOFF).unwrap_or(LennardJones::CUTOFF * sigma);
        let smooth = view.get(&lennard_jones::SMOOTH);
        Some(ForceKind::LennardJones(LennardJones { bodies, against, epsilon, sigma, cutoff, smooth }))
    }

    fn lorentz(&mut self, view: &View<'_>) -> ForceKind {
        self.needs_one_of(view, &["electric", "magnetic"]);
        ForceKind::Lorentz(Lorentz {
            bodies: self.charged(view),
            electric: view.get(&lorentz::ELECTRIC),
            magnetic: view.get(&lorentz::MAGNETIC),
        })
    }

    /// Warns of a force that has none of the given keys. Such a force is zero.
    fn needs_one_of(&mut self, view: &View<'_>, keys: &[&str]) {
        if !keys.iter().any(|key| view.has(key)) {
            let name = self.name;
            let keys: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
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
