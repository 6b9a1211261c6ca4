//! Drops fixes that cannot be applied, or after which the text could not be read.

use std::collections::HashMap;

use super::corrections::is_file;
use crate::diagnostic::{Code, Diagnostic, Fix, Report, Severity, SourceId, Sources};
use crate::scene::source::{self, Override};

/// The number of bytes of text that are parsed at most to try fixes. Further fixes of a large scene with very many errors are dropped.
const MAX_BYTES: usize = 32 << 20;

/// The number of preceding errors whose fixes are tried together with one that is of no use alone.
const MAX_PRECEDING_FIXES: usize = 8;

/// Drops each fix of a report whose edits overlap or are in several texts, and each fix after which its text has more errors of syntax than
/// before. Such a fix would, for example, add a key that the table has already. In a `--set` argument, it would add a second setting.
///
/// A fix that is of use only together with that of a preceding error gets its edits, too: `radius = 1` becomes `shape.sphere.radius = 1`
/// only where `shape = "sphere"` is removed.
pub(super) fn drop_other(report: &mut Report) {
    let mut trial = Trial { sources: &report.sources, known: HashMap::new(), bytes: 0 };
    let mut good: Vec<Fix> = Vec::new();
    for diagnostic in &mut report.diagnostics {
        let Some(fix) = diagnostic.fix.take() else { continue };
        let is_syntax = is_syntax(diagnostic);
        let alone = trial.is_usable(&fix, is_syntax).then(|| fix.clone());
        let together = || {
            let both = good.iter().rev().take(MAX_PRECEDING_FIXES).filter_map(|other| fix.with(other));
            both.into_iter().find(|both| trial.is_usable(both, is_syntax)).map(Box::new)
        };
        diagnostic.fix = alone.or_else(together);
        good.extend(diagnostic.fix.as_deref().cloned());
    }
}

/// Tries fixes.
struct Trial<'a> {
    sources: &'a Sources,
    /// The number of errors of syntax in each text.
    known: HashMap<SourceId, usize>,
    /// The number of bytes that have been parsed.
    bytes: usize,
}

impl Trial<'_> {
    /// Returns true if a text can be read after a fix. `is_syntax` is true for the fix of an error of syntax.
    fn is_usable(&mut self, fix: &Fix, is_syntax: bool) -> bool {
        if self.bytes >= MAX_BYTES {
            return false;
        }
        match fix.applied(self.sources) {
            Some((source, text)) if is_file(source, self.sources) => {
                self.bytes += text.len();
                let of_source = || errors(&self.sources.get(source).text, source);
                let before = *self.known.entry(source).or_insert_with(of_source);
                errors(&text, source) <= before.saturating_sub(usize::from(is_syntax))
            }
            Some((_, text)) => Override::new(text).is_setting(),
            None => false,
        }
    }
}

/// Returns the number of errors of syntax in a text.
fn errors(text: &str, source: SourceId) -> usize {
    let mut said = Vec::new();
    source::parse(text, source, &mut said);
    said.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).count()
}

fn is_syntax(diagnostic: &Diagnostic) -> bool {
    matches!(diagnostic.code, Code::TomlSyntax | Code::TomlUnclosed | Code::Toml11 | Code::DuplicateKey)
}
