//! Forces between all pairs of bodies.

use std::collections::HashMap;

use super::super::view::View;
use super::Reader;
use crate::diagnostic::{Diagnostic, Span};

impl Reader<'_, '_> {
    /// The bodies that act on each other: those of `on`, or all but planes. Only those that are `able` to do.
    ///
    /// A plane cannot be one of them: it has no centre. Without softening, no two may be at the same place.
    pub(super) fn pairs(
        &mut self,
        view: &View<'_>,
        softening: f64,
        able: impl Fn(usize) -> bool,
    ) -> Vec<usize> {
        let bodies = self.bodies;
        let endless = |i: usize| bodies[i].shape.is_unbounded();
        let on: Vec<(usize, Option<Span>)> = match self.named(view) {
            // What is named and has no charge is warned of, and left out.
            None => (0..bodies.len()).filter(|&i| !endless(i) && able(i)).map(|i| (i, None)).collect(),
            Some(named) => {
                for &(body, span) in &named {
                    self.one_of_pair(body, span, endless(body), able(body));
                }
                let with_centre = named.into_iter().filter(|&(body, _)| !endless(body) && able(body));
                with_centre.map(|(body, span)| (body, Some(span))).collect()
            }
        };
        let moving = on.iter().any(|&(i, _)| !bodies[i].start.fixed);
        if on.len() < 2 && !view.has("on") || on.len() == 1 {
            self.acts_on_nothing("it takes two bodies");
        } else if !moving && on.len() > 1 {
            self.acts_on_nothing("all of them are fixed");
        }
        if softening == 0.0 {
            self.apart(&on);
        }
        on.into_iter().map(|(body, _)| body).collect()
    }

    fn one_of_pair(&mut self, body: usize, span: Span, endless: bool, able: bool) {
        let name = &self.bodies[body].name;
        if endless {
            let message = format!("the plane `{name}` cannot act on other bodies: a plane is endless");
            self.context
                .diagnostics
                .push(Diagnostic::error("plane-acts", message).at(span, "it has no centre"));
        } else if !able {
            self.no_effect(format!("the force has no effect on `{name}`"), span, "it has no charge");
        }
    }

    /// Two bodies at the same place are an error, unless both stay there.
    fn apart(&mut self, on: &[(usize, Option<Span>)]) {
        let bodies = self.bodies;
        let mut places: HashMap<[u64; 3], usize> = HashMap::new();
        for &(body, span) in on {
            // Adding 0 makes 0 of −0, which is the same place.
            let place = (bodies[body].start.location + 0.0).to_array().map(f64::to_bits);
            let other = *places.entry(place).or_insert(body);
            if other == body || bodies[other].start.fixed && bodies[body].start.fixed {
                continue;
            }
            let (one, two) = (&bodies[other].name, &bodies[body].name);
            let message = format!("`{one}` and `{two}` are at the same place, where their force is infinite");
            let error = Diagnostic::error("same-place", message).at(span.unwrap_or(self.span), "");
            let help = "move one of them, or give the force a `softening`";
            self.context.diagnostics.push(error.help(help));
        }
    }
}
