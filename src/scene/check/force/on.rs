//! Reads the bodies and the emitters that a force acts on.

use std::collections::HashSet;

use super::super::view::View;
use super::{ActsOn, Reader, chosen};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::BodyId;
use crate::scene::Emitter;
use crate::scene::grammar::forces::{constant, gravitation};

impl Reader<'_, '_> {
    /// Returns the indices of the emitters whose particles the force acts on: those in `on`, or all emitters if the force has no `on`.
    /// Springs, dipole forces and forces with `between` act on no particles. Electric forces act on charged particles only.
    pub(super) fn emitters_of(&mut self, force: &View<'_>) -> Vec<usize> {
        let Some((kind, view)) = chosen(force).filter(|(kind, _)| kind.particles != ActsOn::ItsEnds) else {
            return Vec::new();
        };
        let emitters = self.emitters;
        let able = |i: &usize| match kind.particles {
            ActsOn::Particles => true,
            ActsOn::ChargedParticles => emitters[*i].source.charge != 0.0,
            ActsOn::NoParticles | ActsOn::ItsEnds => false,
        };
        if view.takes(&gravitation::BETWEEN) && view.has(&gravitation::BETWEEN) {
            return Vec::new();
        }
        let Some(items) = view.list(&constant::ON) else { return (0..emitters.len()).filter(able).collect() };
        let mut on = Vec::new();
        for item in items {
            let named = |emitter: &Emitter| item.as_str() == Some(&*emitter.name);
            let Some(number) = emitters.iter().position(named) else { continue };
            if !able(&number) {
                let message = || format!("the force has no effect on `{}`", emitters[number].name);
                let needs_charge = kind.particles == ActsOn::ChargedParticles;
                let lack = if needs_charge { "charge" } else { "magnetic moment" };
                self.no_effect(message, item.span, format!("its particles have no {lack}"));
            } else if !on.contains(&number) {
                on.push(number);
            }
        }
        on
    }

    /// Returns the bodies in `on`, or all movable bodies if the force has no `on`. Warns of fixed bodies in `on`.
    pub(super) fn movable(&mut self, view: &View<'_>) -> Vec<BodyId> {
        let bodies = self.bodies;
        let moves = |i: usize| !bodies[i].start.fixed;
        let Some(named) = self.named(view) else {
            let all: Vec<BodyId> = (0..bodies.len()).filter(|&i| moves(i)).map(BodyId::new).collect();
            if all.is_empty() {
                self.acts_on_nothing("there is none that can move");
            }
            return all;
        };
        for &(body, span) in named.iter().filter(|(body, _)| !moves(*body)) {
            let message = || format!("the force has no effect on `{}`", bodies[body].name);
            self.no_effect(message, span, "it is fixed");
        }
        named.into_iter().map(|(body, _)| BodyId::new(body)).collect()
    }

    /// Returns the charged, movable bodies in `on`, or all such bodies of the scene if the force has no `on`. Warns of uncharged bodies in
    /// `on`.
    pub(super) fn charged(&mut self, view: &View<'_>) -> Vec<BodyId> {
        let bodies = self.bodies;
        let mut on = self.movable(view);
        for (body, span) in self.spans(view) {
            if bodies[body].start.charge == 0.0 {
                let message = || format!("the force has no effect on `{}`", bodies[body].name);
                self.no_effect(message, span, "it has no charge");
            }
        }
        let before = on.len();
        on.retain(|body| bodies[body.index()].start.charge != 0.0 && !bodies[body.index()].start.fixed);
        if on.is_empty() && before > 0 && !view.has(&constant::ON) {
            self.acts_on_nothing("there is none with a charge that can move");
        }
        on
    }

    /// Returns the index of each body in `on`, with the source span of its name.
    fn spans(&self, view: &View<'_>) -> Vec<(usize, Span)> {
        let items = view.list(&constant::ON).unwrap_or_default();
        items.iter().filter_map(|item| Some((self.body(item)?, item.span))).collect()
    }

    /// Returns the index of each body in `on`, with the source span of its name. `None` if the force has no `on`. Reports a body that is
    /// named twice.
    pub(super) fn named(&mut self, view: &View<'_>) -> Option<Vec<(usize, Span)>> {
        let items = view.list(&constant::ON)?;
        let mut seen = HashSet::with_capacity(items.len());
        let mut named = Vec::with_capacity(items.len());
        for item in items {
            let Some(body) = self.body(item) else { continue };
            if seen.insert(body) {
                named.push((body, item.span));
            } else {
                self.named_twice(body, item.span);
            }
        }
        Some(named)
    }

    /// Reports the second occurrence of a body's name in a list.
    pub(super) fn named_twice(&mut self, body: usize, span: Span) {
        let name = &self.bodies[body].name;
        let error = || Diagnostic::error(Code::NamedTwice, format!("the body `{name}` is named twice"));
        self.report(Code::NamedTwice, span, || error().at(span, "the second time"));
    }

    /// Warns that the force acts on no body. Does not warn if the scene has no bodies at all, if the force acts on particles, or if its
    /// field is drawn.
    pub(super) fn acts_on_nothing(&mut self, why: &str) {
        if !self.bodies.is_empty() && !self.has_particles && !self.is_field_drawn {
            let name = self.name;
            self.no_effect(|| format!("the force `{name}` acts on no body"), self.span, why);
        }
    }
}
