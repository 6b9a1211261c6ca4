//! Resolves the measures of particle emitters, such as `emitter.fountain.count`, and reports unknown ones.

use std::ops::Range;

use super::Reader;
use super::dotted::joint_name;
use crate::diagnostic::{Code, Diagnostic, nearest};
use crate::scene::grammar::quoted;
use crate::scene::grammar::scene::scene;
use crate::scene::{EmitterMeasure, Measure};

impl Reader<'_, '_, '_> {
    /// Returns the name of the emitter, if the text before a dot ends with the word `emitter` and the text behind it names a measure.
    /// `None` for other names, such as those of a body called `emitter`.
    pub(super) fn emitter_name<'t>(&self, before: &str, behind: &'t str) -> Option<&'t str> {
        let rest = before.strip_suffix("emitter")?;
        let is_longer = rest.ends_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | ']'));
        let is_body = self.context.names.bodies.contains_key("emitter");
        joint_name(behind).filter(|_| !is_longer && !is_body)
    }

    /// Returns the measure of the emitter `name` at these bytes of the text, which name the measure. Reports what is unknown. The name begins
    /// at the byte `begin`.
    pub(super) fn of_emitter(&mut self, name: &str, begin: usize, word: Range<usize>) -> Option<Measure> {
        let found = self.things.emitters.iter().position(|emitter| *emitter.name == *name);
        let Some(number) = found else {
            if self.root.named(&scene::EMITTER).iter().any(|(known, ..)| *known == name) {
                // The emitter has an error, which has been reported.
                return None;
            }
            let near = nearest(name, self.things.emitters.iter().map(|emitter| &*emitter.name));
            let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(Code::UnknownName, format!("there is no emitter `{name}`"));
            self.report(error, begin..begin + name.len(), &label);
            return None;
        };
        let measure = &self.text[word.clone()];
        if let Some((_, known, _)) = EmitterMeasure::ALL.into_iter().find(|(known, ..)| *known == measure) {
            return Some(Measure::Emitter(number, known));
        }
        let names = EmitterMeasure::ALL.map(|(known, ..)| known);
        let message = format!("an emitter has no `{measure}` that a {} could show", self.noun);
        let label = nearest(measure, names).map_or(String::new(), |near| format!("did you mean `{near}`?"));
        let error = Diagnostic::error(Code::UnknownName, message);
        self.report(error.help(format!("there are {}", quoted(&names))), word, &label);
        None
    }
}
