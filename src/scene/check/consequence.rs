//! Removes diagnostics that are only consequences of other errors.

use std::collections::HashSet;

use crate::diagnostic::{Code, Diagnostic, Severity, Sources, Span};

/// The codes of diagnostics that may be consequences of an unreadable part of the scene.
const OF_LACK: [Code; 6] = [
    Code::MissingKey,
    Code::UnknownName,
    Code::UndeclaredTexture,
    Code::NoBodies,
    Code::NoEffect,
    Code::SamePlace,
];

/// Drops the diagnostics in `found` that are only consequences of other errors. `unreadable` holds the diagnostics from parsing and
/// including.
pub(super) fn drop(found: &mut Vec<Diagnostic>, unreadable: &[Diagnostic], sources: &Sources) {
    let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
    if found.iter().chain(unreadable).any(is_error) {
        // Drop "no bodies": the scene may have bodies that could not be read.
        found.retain(|diagnostic| diagnostic.code != Code::NoBodies);
    }
    // A placeholder replaces a wrong location. Do not report that the placeholder is below the ground.
    let wrong: Vec<Span> = found
        .iter()
        .filter(|diagnostic| is_error(diagnostic) && diagnostic.code != Code::BelowGround)
        .filter_map(Diagnostic::span)
        .collect();
    let is_wrong = |place: Span| wrong.iter().any(|span| place.contains(*span));
    found.retain(|diagnostic| {
        diagnostic.code != Code::BelowGround || !diagnostic.span().is_some_and(is_wrong)
    });
    if unreadable
        .iter()
        .any(|diagnostic| matches!(diagnostic.code, Code::CannotInclude | Code::CyclicInclude))
    {
        // A missing key or name may be in the file that could not be included.
        found.retain(|diagnostic| !OF_LACK.contains(&diagnostic.code));
    }
    let syntax: Vec<&Diagnostic> = unreadable.iter().filter(|d| is_syntax(d.code)).collect();
    if syntax.is_empty() {
        return;
    }
    let mut lines = HashSet::new();
    let mut end = None;
    for diagnostic in syntax {
        let Some(span) = diagnostic.span() else { continue };
        let line = sources.start(span).line;
        lines.insert((span.source(), line));
        // After an unreadable table header, the parser assigns the following keys to the wrong table.
        let header = sources.line(span.source(), line).trim_start().starts_with(['[', ']', '{', '}']);
        if (header && diagnostic.code == Code::TomlSyntax) || diagnostic.code == Code::TomlUnclosed {
            end = end.into_iter().chain([span]).min();
        }
    }
    found.retain(|diagnostic| {
        let readable = diagnostic.span().is_none_or(|span| {
            let line = sources.start(span).line;
            let before = end.is_none_or(|end| span.source() != end.source() || span < end);
            before && !lines.contains(&(span.source(), line))
        });
        readable && !OF_LACK.contains(&diagnostic.code)
    });
}

fn is_syntax(code: Code) -> bool {
    matches!(code, Code::TomlSyntax | Code::TomlUnclosed | Code::DuplicateKey)
}
