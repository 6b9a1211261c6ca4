//! Resolves the measures of marks, such as `angle.phi` or `distance.h`, and reports unknown ones.

use super::Reader;
use crate::diagnostic::{Code, Diagnostic, nearest};
use crate::scene::Measure;
use crate::scene::grammar::scene::scene;

impl<'b> Reader<'_, 'b, '_> {
    /// Returns the first byte of the measure of a mark, its name, and the measure, if the text before a dot ends with `angle`, `distance` or `area`.
    /// The name is the word at the beginning of `behind`, which begins at the byte `begin` of the text. `None` for other names, such as
    /// those of a body called `angle`. The inner `None` means that there is no such mark; then an error is reported.
    pub(super) fn of_mark<'t>(
        &mut self,
        before: &str,
        behind: &'t str,
        begin: usize,
    ) -> Option<(usize, &'t str, Option<Measure>)> {
        let (noun, key, measure): (_, _, fn(usize) -> Measure) = [
            ("angle", &scene::ANGLE, Measure::Angle as _),
            ("distance", &scene::DISTANCE, Measure::Length as _),
            ("area", &scene::AREA, Measure::Area as _),
        ]
        .into_iter()
        .find(|(noun, ..)| before.ends_with(noun))?;
        let first = before.len() - noun.len();
        if before[..first].ends_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | ']')) {
            return None;
        }
        let end = behind.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(behind.len());
        let name = &behind[..end];
        let marks = self.root.named(key);
        if let Some(number) = marks.iter().position(|(known, ..)| *known == name) {
            return Some((first, name, Some(measure(number))));
        }
        if self.context.names.bodies.contains_key(noun) || name.is_empty() {
            return None;
        }
        let near = nearest(name, marks.iter().map(|(known, ..)| *known));
        let label = near.map_or_else(
            || format!("it would be a table of the scene: `[{noun}.{name}]`"),
            |near| format!("did you mean `{near}`?"),
        );
        let error = Diagnostic::error(Code::UnknownName, format!("there is no {noun} `{name}`"));
        self.report(error, begin..begin + end, &label);
        Some((first, name, None))
    }
}
