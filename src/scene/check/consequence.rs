//! Removes errors that only follow from other errors.

use std::collections::HashSet;

use crate::diagnostic::{Code, Diagnostic, Severity, Sources, Span};

/// Errors that may only follow from an unreadable part of the scene.
const OF_LACK: [Code; 6] = [
    Code::MissingKey,
    Code::UnknownName,
    Code::UndeclaredTexture,
    Code::NoBodies,
    Code::NoEffect,
    Code::SamePlace,
];

/// Drops the diagnostics in `found` that only follow from other errors, such as unreadable text.
pub(super) fn drop(found: &mut Vec<Diagnostic>, unreadable: &[Diagnostic], sources: &Sources) {
    let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
    if found.iter().chain(unreadable).any(is_error) {
        // The scene may have bodies with errors, which are not counted.
        found.retain(|diagnostic| diagnostic.code != Code::NoBodies);
    }
    // A placeholder replaces a wrong location, and may be below the ground.
    let wrong: Vec<Span> = found
        .iter()
        .filter(|diagnostic| is_error(diagnostic) && diagnostic.code != Code::BelowGround)
        .filter_map(Diagnostic::span)
        .collect();
    let is_wrong = |place: Span| {
        let is_within =
            |span: &Span| span.source == place.source && place.start <= span.start && span.end <= place.end;
        wrong.iter().any(is_within)
    };
    found.retain(|diagnostic| {
        diagnostic.code != Code::BelowGround || !diagnostic.span().is_some_and(is_wrong)
    });
    if unreadable
        .iter()
        .any(|diagnostic| matches!(diagnostic.code, Code::CannotInclude | Code::CyclicInclude))
    {
        // What is reported as missing may be in the file that could not be included.
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
        let line = sources.position(span.source, span.start).line;
        lines.insert((span.source, line));
        // After an unreadable header, the parser assigns the keys below it to another table.
        let header = sources.line(span.source, line).trim_start().starts_with(['[', ']', '{', '}']);
        if (header && diagnostic.code == Code::TomlSyntax) || diagnostic.code == Code::TomlUnclosed {
            end = end.into_iter().chain([span]).min();
        }
    }
    found.retain(|diagnostic| {
        let readable = diagnostic.span().is_none_or(|span| {
            let line = sources.position(span.source, span.start).line;
            let before = end.is_none_or(|end| span.source != end.source || span < end);
            before && !lines.contains(&(span.source, line))
        });
        readable && !OF_LACK.contains(&diagnostic.code)
    });
}

fn is_syntax(code: Code) -> bool {
    matches!(code, Code::TomlSyntax | Code::TomlUnclosed | Code::DuplicateKey)
}
