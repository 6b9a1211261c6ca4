//! Reads forces that act between all pairs of bodies.

use std::collections::{HashMap, HashSet};

use super::super::view::View;
use super::Reader;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::BodyId;
use crate::scene::grammar::forces::gravitation;
use crate::scene::source::Value;

/// The index of a body, and the source span of its name. The span is `None` if the scene does not name the body for this force.
pub(super) type Member = (usize, Option<Span>);

impl Reader<'_, '_> {
    /// Returns the bodies that attract or repel each other: the bodies in `on`, or the two groups in `between`, or else all bodies except
    /// planes. `able` tells whether a body has the property that the force needs, such as a charge.
    ///
    /// Reports planes, because a plane has no center. Without softening, also reports two bodies at the same location.
    pub(super) fn pairs(
        &mut self,
        view: &View<'_>,
        softening: f64,
        able: impl Fn(usize) -> bool,
    ) -> (Vec<BodyId>, Option<Vec<BodyId>>) {
        self.pairs_or_one(view, softening, able, false)
    }

    /// Like [`pairs`](Self::pairs). If `alone` is true, the force also acts on a single body.
    pub(super) fn pairs_or_one(
        &mut self,
        view: &View<'_>,
        softening: f64,
        able: impl Fn(usize) -> bool,
        alone: bool,
    ) -> (Vec<BodyId>, Option<Vec<BodyId>>) {
        let bodies = self.bodies;
        let able = &|i: usize| !bodies[i].shape.is_unbounded() && able(i);
        let numbers = |group: &[Member]| group.iter().map(|(body, _)| BodyId::new(*body)).collect::<Vec<_>>();
        if let Some([first, second]) = self.groups(view) {
            let (first, second) = (self.usable(first, able), self.usable(second, able));
            let moves = |group: &[Member]| group.iter().any(|&(i, _)| !bodies[i].start.fixed);
            if first.is_empty() || second.is_empty() {
                self.acts_on_nothing("each of the two groups needs a body");
            } else if !moves(&first) && !moves(&second) {
                self.acts_on_nothing("all of them are fixed");
            }
            if softening == 0.0 {
                self.apart(&[&first, &second]);
            }
            return (numbers(&first), Some(numbers(&second)));
        }
        if view.has(&gravitation::BETWEEN) {
            // The validation has already reported the error in `between`.
            return (Vec::new(), None);
        }
        let on: Vec<Member> = match self.named(view) {
            None => (0..bodies.len()).filter(|&i| able(i)).map(|i| (i, None)).collect(),
            Some(named) => self.usable(named, able),
        };
        let moving = on.iter().any(|&(i, _)| !bodies[i].start.fixed);
        let least = if alone { 1 } else { 2 };
        if on.len() < least && !view.has(&gravitation::ON) || on.len() == 1 && !alone {
            self.acts_on_nothing("it takes two bodies");
        } else if !moving && on.len() >= least {
            self.acts_on_nothing("all of them are fixed");
        }
        if softening == 0.0 {
            self.apart(&[&on]);
        }
        (numbers(&on), None)
    }

    /// Returns the named bodies that the force can act on. Reports the reason for each body that is left out.
    fn usable(&mut self, named: Vec<(usize, Span)>, able: impl Fn(usize) -> bool) -> Vec<Member> {
        let bodies = self.bodies;
        for &(body, span) in &named {
            self.one_of_pair(body, span, bodies[body].shape.is_unbounded(), able(body));
        }
        named.into_iter().filter(|&(body, _)| able(body)).map(|(body, span)| (body, Some(span))).collect()
    }

    /// Reads the two groups of bodies in `between`. All copies of a repeated body have the span of the body's name, and form one group.
    fn groups(&mut self, view: &View<'_>) -> Option<[Vec<(usize, Span)>; 2]> {
        let items = view.list(&gravitation::BETWEEN)?;
        let mut groups: Vec<(Span, Vec<(usize, Span)>)> = Vec::new();
        for item in items {
            let members: Vec<(usize, Span)> = match &item.value {
                Value::Array(names) => {
                    names.iter().filter_map(|name| Some((self.body(name)?, name.span))).collect()
                }
                _ => self.body(item).map(|body| (body, item.span)).into_iter().collect(),
            };
            match groups.last_mut().filter(|(span, _)| *span == item.span) {
                Some((_, group)) => group.extend(members),
                None => groups.push((item.span, members)),
            }
        }
        let mut seen = HashSet::new();
        for (body, span) in groups.iter().flat_map(|(_, group)| group) {
            if !seen.insert(*body) {
                self.named_twice(*body, *span);
            }
        }
        let count = groups.len();
        match <[_; 2]>::try_from(groups) {
            Ok([(_, first), (_, second)]) => Some([first, second]),
            Err(_) => {
                let message = format!("a force acts between 2 groups, and here are {count}");
                let error = Diagnostic::error(Code::WrongLength, message);
                let help = "each is a body, the copies of one, or a list: `between = [[\"sun\", \"moon\"], \"ship\"]`";
                self.context
                    .diagnostics
                    .extend(view.span(&gravitation::BETWEEN).map(|span| error.at(span, "").help(help)));
                None
            }
        }
    }

    fn one_of_pair(&mut self, body: usize, span: Span, endless: bool, able: bool) {
        let name = &self.bodies[body].name;
        if endless {
            let message = || format!("the plane `{name}` cannot act on other bodies: a plane is endless");
            let error = || Diagnostic::error(Code::PlaneActs, message()).at(span, "it has no centre");
            self.report(Code::PlaneActs, span, error);
        } else if !able {
            self.no_effect(|| format!("the force has no effect on `{name}`"), span, self.lack);
        }
    }

    /// Reports two bodies at the same location, unless both are fixed. If there are several groups, compares only bodies of different
    /// groups.
    pub(super) fn apart(&mut self, groups: &[&[Member]]) {
        if self.context.bodies_are_wrong {
            return;
        }
        let bodies = self.bodies;
        let mut places: HashMap<[u64; 3], (usize, usize)> = HashMap::new();
        let mut said: HashSet<[&str; 2]> = HashSet::new();
        let members =
            groups.iter().enumerate().flat_map(|(group, members)| members.iter().map(move |it| (group, *it)));
        for (group, (body, span)) in members {
            // Adding 0 turns −0 into 0: both are the same coordinate, but have different bits.
            let place = (bodies[body].start.location + 0.0).to_array().map(f64::to_bits);
            let (of, other) = *places.entry(place).or_insert((group, body));
            let within_one = groups.len() > 1 && of == group;
            if other == body || within_one || bodies[other].start.fixed && bodies[body].start.fixed {
                continue;
            }
            let (one, two) = (&bodies[other].name, &bodies[body].name);
            // Report copies of the same two bodies only once.
            let groups = &self.context.groups;
            if !said.insert([one, two].map(|name| groups.original(name).unwrap_or(name))) {
                continue;
            }
            let message =
                || format!("`{one}` and `{two}` are at the same place, where their force is infinite");
            let span = span.unwrap_or(self.span);
            let help = match self.softens {
                true => "move one of them, or give the force a `softening`",
                false => "move one of them",
            };
            self.report(Code::SamePlace, span, || {
                Diagnostic::error(Code::SamePlace, message()).at(span, "").help(help)
            });
        }
    }
}
