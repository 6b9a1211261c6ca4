//! Resolves the measures of named forces, such as `force.air.x` or `force.air.ball.size`, and reports unknown ones.

use super::dotted::{body_name, joint_name};
use super::{Reader, words};
use crate::diagnostic::{Code, Diagnostic, nearest};
use crate::physics::BodyId;
use crate::scene::grammar::quoted;
use crate::scene::grammar::scene::scene;
use crate::scene::{Force, ForceMeasure, Measure, Subject};

impl Reader<'_, '_, '_> {
    /// Returns the name of the force, and the text behind its dot, if the text before a dot ends with the word `force` and the text behind
    /// it names a measure of a force. `None` for other names, such as measures of a body called `force`.
    pub(super) fn force_name<'t>(&self, before: &str, behind: &'t str) -> Option<(&'t str, &'t str)> {
        let rest = before.strip_suffix("force")?;
        if rest.ends_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | ']')) {
            return None;
        }
        let name = joint_name(behind)?;
        let is_body = self.context.names.bodies.contains_key("force") && self.force(name).is_none();
        (!is_body).then(|| (name, &behind[name.len() + 1..]))
    }

    /// Returns the force with this name and its index in the scene.
    fn force(&self, name: &str) -> Option<(usize, &Force)> {
        self.things.forces.iter().enumerate().find(|(_, force)| force.name == name)
    }

    /// Returns a measure of the force `name`, which begins at the byte `begin` of the text, and the length of the part of `rest` that
    /// belongs to it: a measure such as `x`, or a body and a measure, such as `ball.x`. Reports what is unknown or has no single meaning.
    pub(super) fn of_force(&mut self, name: &str, begin: usize, rest: &str) -> Option<(Measure, usize)> {
        let Some((number, force)) = self.force(name) else {
            if self.root.named(&scene::FORCE).iter().any(|(known, ..)| *known == name) {
                // The force has an error, which has been reported.
                return None;
            }
            let names = self.things.forces.iter().map(|force| force.name.as_str());
            let near = nearest(name, names.take(1000));
            let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(Code::UnknownName, format!("there is no force `{name}`"));
            self.report(error, begin..begin + name.len(), &label);
            return None;
        };
        let bodies = self.things.bodies;
        let acts_on: Vec<usize> = force
            .kind
            .bodies()
            .into_iter()
            .map(BodyId::index)
            .filter(|body| !bodies[*body].start.fixed)
            .collect();
        let behind = begin + name.len() + 1;
        let body = body_name(rest).filter(|body| rest[body.len()..].starts_with('.'));
        let (subject, skipped) = match body {
            None => (None, 0),
            Some(body) => {
                let subject = self.subject(body, behind)?;
                if let Subject::One(one) = subject
                    && !acts_on.contains(&one)
                {
                    let message = format!("the force `{name}` does not act on `{body}`");
                    let label = if bodies[one].start.fixed { "it is fixed" } else { "" };
                    let error = Diagnostic::error(Code::UnknownName, message);
                    self.report(error, behind..behind + body.len(), label);
                    return None;
                }
                (Some(subject), body.len() + 1)
            }
        };
        let word = &rest[skipped..];
        let word = &word[..word.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(word.len())];
        let here = behind + skipped..behind + skipped + word.len();
        let Some((_, measure, _)) = ForceMeasure::ALL.into_iter().find(|(known, ..)| *known == word) else {
            let names: Vec<&str> = ForceMeasure::ALL.iter().map(|(known, ..)| *known).collect();
            let message = format!("a force has no `{word}` that a {} could show", self.noun);
            let error = Diagnostic::error(Code::UnknownName, message);
            let at = self.at(&here);
            let known = format!("there are {}", quoted(&names));
            let near = words::of_force(word).or_else(|| nearest(word, names.iter().copied()));
            self.context.diagnostics.push(match near {
                Some(near) => {
                    let error = error.at(at, format!("did you mean `{near}`?")).help(known);
                    self.corrected(error, at, near, word.len())
                }
                None => error.at(at, "").help(known),
            });
            return None;
        };
        let subject = match (subject, acts_on.as_slice()) {
            (None, [only]) if measure.needs_body() => Some(Subject::One(*only)),
            (None, acts_on) if measure.needs_body() => {
                let error = match acts_on.first() {
                    None => {
                        Diagnostic::error(Code::UnknownName, format!("the force `{name}` acts on no body"))
                    }
                    Some(first) => {
                        let example = format!("force.{name}.{}.{word}", bodies[*first].name);
                        let message = format!("the force `{name}` acts on {} bodies", acts_on.len());
                        Diagnostic::error(Code::UnknownName, message)
                            .help(format!("name the body: `{example}`"))
                    }
                };
                self.report(error, here, "on which of them?");
                return None;
            }
            (subject, _) => subject,
        };
        Some((Measure::Force(number, subject, measure), skipped + word.len()))
    }
}
