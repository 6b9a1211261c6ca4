//! Resolves names with dots, such as `ball.speed`, in the formulas of labels, and reports unknown names.

use std::ops::Range;

use super::{Reader, words};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::check::stepping::FEWER_BODIES_HELP;
use crate::scene::grammar::scene::{scene, simulation};
use crate::scene::{ContactLaw, JointMeasure, Measure, is_by_moreau};

impl Reader<'_, '_, '_> {
    /// Replaces each dot in names such as `ball.speed` by a letter or an underscore, because names in formulas have no dots. The
    /// replacement has the same length, so error positions in the formula stay valid. Returns the formula, and the measure for each
    /// replaced name.
    pub(super) fn without_dots(
        &mut self,
        formula: &str,
        start: usize,
    ) -> Option<(String, Vec<(String, Measure)>)> {
        let variables: Vec<&str> = self.variables().map(|(name, _)| name).collect();
        let joint = std::iter::once('_').chain('A'..='Z').find(|joint| {
            let joined = formula.replace('.', &joint.to_string());
            !variables.iter().any(|name| name.contains(*joint) && joined.contains(name))
        });
        let joint = joint.unwrap_or('_').to_string();
        let mut plain = formula.to_owned();
        let mut dotted = Vec::new();
        let mut taken = 0;
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        for (at, _) in formula.match_indices('.') {
            if at < taken {
                continue;
            }
            let Some((range, measure)) = self.measure_at(formula, start, at)? else { continue };
            taken = range.end;
            let name = &formula[range.clone()];
            let joined = name.replace(|c| !is_part(c), &joint);
            plain.replace_range(range.clone(), &joined);
            self.note(&mut dotted, joined, measure, name, start + range.start)?;
        }
        Some((plain, dotted))
    }

    /// Returns the name that the dot at the byte `at` of a formula belongs to, and its measure. The inner `None` means another dot, such as
    /// that of a number; the outer one means an error, which is reported. The formula begins at the byte `start` of the text.
    #[allow(clippy::option_option, reason = "an error ends the whole formula")]
    fn measure_at(
        &mut self,
        formula: &str,
        start: usize,
        at: usize,
    ) -> Option<Option<(Range<usize>, Measure)>> {
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let end_of_word = |begin: usize| {
            let rest = &formula[begin..];
            begin + rest.find(|c| !is_part(c)).unwrap_or(rest.len())
        };
        let (before, behind) = (&formula[..at], &formula[at + 1..]);
        let of_joint = before.strip_suffix("joint").filter(|rest| !rest.ends_with(is_part));
        if let Some((rest, name)) = of_joint.zip(joint_name(behind)) {
            let word = at + 1 + name.len() + 1;
            let end = end_of_word(word);
            let measure = self.of_joint(name, start + at + 1, &formula[word..end])?;
            return Some(Some((rest.len()..end, measure)));
        }
        if let Some((begin, name, measure)) = self.of_mark(before, behind, start + at + 1) {
            return Some(Some((begin..at + 1 + name.len(), measure?)));
        }
        if let Some(name) = self.emitter_name(before, behind) {
            let word = at + 1 + name.len() + 1;
            let end = end_of_word(word);
            let measure = self.of_emitter(name, start + at + 1, start + word..start + end)?;
            return Some(Some((at - "emitter".len()..end, measure)));
        }
        if let Some((name, rest)) = self.force_name(before, behind) {
            let (measure, length) = self.of_force(name, start + at + 1, rest)?;
            let end = at + 1 + name.len() + 1 + length;
            return Some(Some((at - "force".len()..end, measure)));
        }
        let Some(Dotted { body, word }) = dotted_at(formula, at) else { return Some(None) };
        let subject = self.subject(&formula[body.clone()], start + body.start)?;
        let (measure, end) = self.of_body(subject, formula, start, (body.start, word))?;
        Some(Some((body.start..end, measure)))
    }

    /// Adds to `dotted` a name whose dots have been replaced, with its measure. Reports an error if the replacement makes two different
    /// names equal.
    fn note(
        &mut self,
        dotted: &mut Vec<(String, Measure)>,
        joined: String,
        measure: Measure,
        name: &str,
        begin: usize,
    ) -> Option<()> {
        if dotted.iter().any(|(other, another)| *other == joined && *another != measure) {
            let message = format!("`{name}` looks like another name in this formula");
            let label = "write the two in `${…}` of their own";
            self.report(Diagnostic::error(Code::LabelSyntax, message), begin..begin + name.len(), label);
            return None;
        }
        dotted.push((joined, measure));
        Some(())
    }

    /// Returns a measure of the joint `name`, which begins at the byte `begin` of the label. `None` if the joint or the measure is
    /// unknown; then an error is reported.
    fn of_joint(&mut self, name: &str, begin: usize, measure: &str) -> Option<Measure> {
        let found = self.things.joints.iter().enumerate().find(|(_, joint)| joint.name == name);
        let Some((number, joint)) = found else {
            if self.context.names.joints.contains_key(name) {
                // The joint has an error, which has been reported.
                return None;
            }
            let names = self.things.joints.iter().map(|joint| joint.name.as_str());
            let near = crate::diagnostic::nearest(name, names.take(1000));
            let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(Code::UnknownName, format!("there is no joint `{name}`"));
            self.report(error, begin..begin + name.len(), &label);
            return None;
        };
        let its = || JointMeasure::names().filter(|(_, measure)| measure.is_of(&joint.kind));
        if let Some((_, known)) = its().find(|(known, _)| *known == measure) {
            // A servo is a force like any other, which time stepping knows.
            let is_servo = known == JointMeasure::Motor && joint.servo.is_some();
            if known.is_reaction()
                && !is_servo
                && self.root.table(&scene::SIMULATION).get(&simulation::CONTACTS)
                    == Some(ContactLaw::TimeStepping.name())
                && !is_by_moreau(self.things.bodies)
            {
                let message =
                    format!("time stepping of these bodies does not know the `{measure}` of a joint");
                let error = Diagnostic::error(Code::BadContacts, message).help(FEWER_BODIES_HELP);
                let behind = begin + name.len() + 1;
                self.report(error, behind..behind + measure.len(), "");
                return None;
            }
            return Some(Measure::Joint(number, known));
        }
        let names: Vec<&str> = its().map(|(name, _)| name).collect();
        let behind = begin + name.len() + 1;
        let here = self.at(&(behind..behind + measure.len()));
        let error = Diagnostic::error(
            Code::UnknownName,
            format!("this joint has no `{measure}` that a {} could show", self.noun),
        );
        let known = format!("there are {}", crate::scene::grammar::quoted(&names));
        let near = words::of_joint(measure).or_else(|| crate::diagnostic::nearest(measure, names));
        self.context.diagnostics.push(match near {
            Some(near) => {
                let error = error.at(here, format!("did you mean `{near}`?")).help(known);
                self.corrected(error, here, near, measure.len())
            }
            None => error.at(here, "").help(known),
        });
        None
    }

    /// Adds a fix that replaces a word of `length` bytes. In an escaped string, the span is the whole string, and no fix is added.
    pub(super) fn corrected(&self, error: Diagnostic, at: Span, word: &str, length: usize) -> Diagnostic {
        if at.len() == length { error.fix(at, word).fix_is_said() } else { error }
    }
}

/// Returns the name of a joint at the beginning of a text such as `knee.force` or `string[3].force`. `None` if no measure follows the
/// name.
pub(super) fn joint_name(text: &str) -> Option<&str> {
    let letters = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_')?;
    let indices = match text[letters..].strip_prefix('[') {
        Some(rest) => rest.find(']')? + 2,
        None => 0,
    };
    let name = &text[..letters + indices];
    let measure = text[name.len()..].strip_prefix('.')?;
    let is_name = !name.is_empty() && measure.starts_with(|c: char| c.is_ascii_alphabetic());
    is_name.then_some(name)
}

/// The byte ranges of the two parts of a name such as `ball.speed` or `brick[3,1].x`.
pub(super) struct Dotted {
    pub(super) body: Range<usize>,
    pub(super) word: Range<usize>,
}

/// Returns the parts of the name whose dot is at the byte `at` of a formula. `None` for other dots, such as that of a number.
pub(super) fn dotted_at(formula: &str, at: usize) -> Option<Dotted> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    // The name of a copy ends with its indices, such as `ball[0]` or `brick[3,1]`.
    let indices = formula[..at].ends_with(']').then(|| formula[..at].rfind('[')).flatten();
    let begin = formula[..indices.unwrap_or(at)].trim_end_matches(is_part).len();
    let rest = &formula[at + 1..];
    let end = at + 1 + rest.find(|c| !is_part(c)).unwrap_or(rest.len());
    let letter = |word: &str| word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let is_name = letter(&formula[begin..at]) && letter(&formula[at + 1..end]);
    is_name.then_some(Dotted { body: begin..at, word: at + 1..end })
}

/// Returns the name of a body at the beginning of a text, with the indices of a copy.
pub(super) fn body_name(text: &str) -> Option<&str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let end = text.find(|c| !is_part(c)).unwrap_or(text.len());
    let indices = match text[end..].strip_prefix('[') {
        Some(rest) => rest.find(']')? + 2,
        None => 0,
    };
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_').then(|| &text[..end + indices])
}
