//! Resolves the measures of bodies, such as `ball.speed` or `a.distance.b`, and reports unknown ones.

use std::ops::Range;

use super::dotted::body_name;
use super::{Reader, words};
use crate::diagnostic::{Code, Diagnostic, nearest};
use crate::scene::grammar::scene::{scene, simulation};
use crate::scene::grammar::{Any, Collection, Key, quoted};
use crate::scene::{BodyMeasure, Measure, Subject};

/// The word between two bodies whose distance is meant.
const DISTANCE: &str = "distance";

/// The word between two bodies whose smallest distance so far is meant.
const CLOSEST: &str = "closest";

impl Reader<'_, '_, '_> {
    /// Returns the body that a name means. It begins at the byte `begin` of the text. Within an aggregate, the name of a repeated body means
    /// each of its copies. Reports an unknown name.
    pub(super) fn subject(&mut self, name: &str, begin: usize) -> Option<Subject> {
        if self.is_of_each(name, begin)? {
            return Some(Subject::Each);
        }
        if let Some(number) = self.context.names.bodies.get(name).copied() {
            return Some(Subject::One(number));
        }
        if self.context.groups.may_hold(name) {
            // The number of copies has an error, which has been reported.
            return None;
        }
        let names = self.things.bodies.iter().map(|body| &*body.name);
        let near = nearest(name, names.take(1000).chain(self.context.groups.originals()));
        let near = self.of_another_kind(name).or(near.map(str::to_owned));
        let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
        let is_repeated = self.context.groups.several(name).is_some();
        let mut error = Diagnostic::error(Code::UnknownName, format!("there is no body `{name}`"));
        let label = match self.context.groups.ends(Collection::Body, name) {
            Some([first, last]) => format!("its copies are `{first}` to `{last}`"),
            None => label,
        };
        let is_each = self.own.is_some_and(|own| own.body == Subject::Each);
        if is_repeated && is_each {
            error = error.help("write `speed` alone for the speed of the body that gets the color");
        } else if is_repeated {
            error = error.help(format!(
                "`sum(…)`, `mean(…)`, `max(…)` and `min(…)` make one value of all: `mean({name}.speed)`"
            ));
        }
        self.report(error, begin..begin + name.len(), &label);
        None
    }

    /// Returns the name with its kind, such as `joint.string`, if a thing of another kind than a body has it.
    fn of_another_kind(&self, name: &str) -> Option<String> {
        let kinds = [&scene::JOINT, &scene::FORCE, &scene::ANGLE, &scene::DISTANCE, &scene::AREA];
        let has = |kind: &&&Key<Any>| self.root.named(kind).into_iter().any(|(known, ..)| known == name);
        kinds.iter().find(has).map(|kind| format!("{}.{name}", kind.spec))
    }

    /// Returns a measure of a body, and the end of its name in the formula, which begins at the byte `start` of the text. The name of the
    /// body begins at `begin`; the range is that of the word behind the first dot. Reports an unknown measure.
    pub(super) fn of_body(
        &mut self,
        subject: Subject,
        formula: &str,
        start: usize,
        (begin, word): (usize, Range<usize>),
    ) -> Option<(Measure, usize)> {
        let begin_of_name = begin;
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let (measure, end) = (&formula[word.clone()], word.end);
        let other = formula[end..].strip_prefix('.').and_then(body_name);
        if matches!(measure, DISTANCE | CLOSEST) {
            let Some(other) = other else {
                let error = Diagnostic::error(Code::UnknownName, "a distance has two bodies");
                let label = format!("write `a.{measure}.b`");
                self.report(error, start + word.start..start + end, &label);
                return None;
            };
            let begin = start + end + 1;
            if other == "ground" && !self.context.names.bodies.contains_key(other) {
                let error = Diagnostic::error(Code::UnknownName, "the ground has no center");
                let help = "the height of a body is its `y`, or its `z` if that is up";
                self.report(error.help(help), begin..begin + other.len(), "needs a body");
                return None;
            }
            let Subject::One(number) = self.subject(other, begin)? else {
                let error = Diagnostic::error(Code::LabelSyntax, "the second body of a distance is one body");
                self.report(error, begin..begin + other.len(), "these are several");
                return None;
            };
            let end = end + 1 + other.len();
            if measure == DISTANCE {
                return Some((Measure::Distance(subject, number), end));
            }
            let Subject::One(one) = subject else {
                let error = Diagnostic::error(Code::LabelSyntax, "the approach of two bodies has one value");
                self.report(
                    error,
                    start + begin_of_name..start + end,
                    "needs a single body before `closest`",
                );
                return None;
            };
            return Some((self.of_approach([one, number]), end));
        }
        let known = BodyMeasure::ALL.into_iter().find(|(name, ..)| *name == measure);
        let body = match subject {
            Subject::One(body) => Some(body),
            Subject::Each => None,
        };
        let columns = &self.context.file_columns;
        if let (None, Some((column, _))) = (known, columns.names(body).find(|(_, name)| *name == measure)) {
            return Some((Measure::FileColumn(subject, column), end));
        }
        let Some((_, known, _)) = known else {
            let names: Vec<&str> =
                BodyMeasure::ALL.iter().map(|(name, ..)| *name).chain([DISTANCE, CLOSEST]).collect();
            let columns: Vec<String> = columns.names(body).map(|(_, name)| name.to_owned()).collect();
            let message = format!("a body has no `{measure}` that a {} could show", self.noun);
            let rest = formula[end..].strip_prefix('.');
            let axis = rest.map(|rest| &rest[..rest.find(|c| !is_part(c)).unwrap_or(rest.len())]);
            let other = words::of_body(measure, axis);
            let end = match (&other, axis) {
                (Some(_), Some(axis @ ("x" | "y" | "z"))) => end + 1 + axis.len(),
                _ => end,
            };
            let here = self.at(&(start + word.start..start + end));
            let error = Diagnostic::error(Code::UnknownName, message);
            let known = format!("there are {}", quoted(&names));
            let all = names.iter().copied().chain(columns.iter().map(String::as_str));
            let near = || nearest(measure, all).map(str::to_owned);
            self.context.diagnostics.push(match other.or_else(near) {
                Some(near) => {
                    let error = error.at(here, format!("did you mean `{near}`?")).help(known);
                    self.corrected(error, here, &near, end - word.start)
                }
                None => error.at(here, "").help(known),
            });
            return None;
        };
        if known.needs_contacts() {
            self.needs_contacts(start + begin..start + end)?;
        }
        if let (BodyMeasure::Impacts, Some(other)) = (known, other) {
            let Subject::One(number) = subject else {
                let error = Diagnostic::error(Code::LabelSyntax, "the impacts of two bodies have one value");
                let range = start + begin..start + end + 1 + other.len();
                self.report(error, range, "needs a single body before `impacts`");
                return None;
            };
            let measure = self.of_pair(number, other, start + end + 1)?;
            return Some((measure, end + 1 + other.len()));
        }
        Some((Measure::Body(subject, known), end))
    }

    /// Returns the measure of the smallest distance of two bodies so far.
    fn of_approach(&mut self, [one, other]: [usize; 2]) -> Measure {
        let pair = [one.min(other), one.max(other)];
        let known = &mut self.context.approaches;
        Measure::Closest(known.iter().position(|known| *known == pair).unwrap_or_else(|| {
            known.push(pair);
            known.len() - 1
        }))
    }

    /// Reports the use of a measure such as `impacts` in a scene without contacts.
    pub(super) fn needs_contacts(&mut self, range: Range<usize>) -> Option<()> {
        if self.root.table(&scene::SIMULATION).has(&simulation::CONTACTS) {
            return Some(());
        }
        let name = &self.text[range.clone()];
        let measure = name.rsplit('.').next().unwrap_or(name);
        let error = Diagnostic::error(Code::NoContacts, format!("`{measure}` needs `simulation.contacts`"))
            .help("write `contacts = \"event-driven\"` in [simulation]");
        self.report(error, range, "without it, bodies pass through each other");
        None
    }

    /// Returns the measure that counts the impacts of two bodies. The name `other` begins at the byte `begin` of the text. The name
    /// `ground` means the ground, unless a body has this name.
    fn of_pair(&mut self, body: usize, other: &str, begin: usize) -> Option<Measure> {
        let named = self.context.names.bodies.get(other).copied();
        let Some(other) = named.or_else(|| (other == "ground").then_some(self.things.bodies.len())) else {
            let names = self.things.bodies.iter().map(|body| &*body.name);
            let near = nearest(other, names.take(1000));
            let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(Code::UnknownName, format!("there is no body `{other}`"));
            self.report(error, begin..begin + other.len(), &label);
            return None;
        };
        let pair = [body.min(other), body.max(other)];
        let pairs = &mut self.context.pairs;
        let known = pairs.iter().position(|known| *known == pair);
        Some(Measure::Impacts(known.unwrap_or_else(|| {
            pairs.push(pair);
            pairs.len() - 1
        })))
    }
}
