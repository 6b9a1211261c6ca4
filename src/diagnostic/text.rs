//! Formats diagnostics as text for a terminal, in the style of rustc.

use std::collections::BTreeMap;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Patch, Renderer, Snippet};

use super::{Diagnostic, Edit, Label, Report, Severity, SourceId, Sources, is_invisible, visible};

/// The maximum number of diagnostics shown for one line of a scene. Each of them prints the line, which may be very long.
const MOST_OF_A_LINE: usize = 50;

/// Formats all diagnostics of a report, each followed by an empty line. `color` adds ANSI colors.
pub(super) fn render(report: &Report, color: bool) -> String {
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    let mut text = String::new();
    let mut lines: BTreeMap<(SourceId, usize), usize> = BTreeMap::new();
    for diagnostic in &report.diagnostics {
        if let Some(span) = diagnostic.span() {
            let line = report.sources.start(span).line;
            let shown = lines.entry((span.source, line)).or_default();
            *shown += 1;
            if *shown > MOST_OF_A_LINE {
                continue;
            }
        }
        text.push_str(&renderer.render(&groups(diagnostic, &report.sources)));
        text.push_str("\n\n");
    }
    for ((source, line), count) in lines.into_iter().filter(|(_, count)| *count > MOST_OF_A_LINE) {
        let name = visible(&report.sources.get(source).name);
        let more = count - MOST_OF_A_LINE;
        text.push_str(&format!("… and {more} more in line {line} of {name}\n\n"));
    }
    // The text contains lines of the scene, which may contain control characters. The renderer has replaced most of these, including every
    // escape character. All escape characters that remain belong to its own colors.
    let shown = |c: char| if is_invisible(c) && !matches!(c, '\n' | '\u{1b}') { '\u{fffd}' } else { c };
    text.chars().map(shown).collect()
}

fn groups<'a>(diagnostic: &'a Diagnostic, sources: &'a Sources) -> Vec<Group<'a>> {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut group = Group::with_title(level.primary_title(&diagnostic.message).id(diagnostic.code.name()));
    let mut rest = diagnostic.labels.as_slice();
    while let Some(first) = rest.first() {
        // Labels of the same text are shown together in one excerpt.
        let here = rest.iter().take_while(|label| label.span.source == first.span.source).count();
        group = group.element(snippet(&rest[..here], rest.len() == diagnostic.labels.len(), sources));
        rest = &rest[here..];
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(help));
    }
    let mut groups = vec![group];
    if let Some(fix) = diagnostic.fix.as_ref().filter(|fix| !fix.is_said && fix.is_applicable(sources)) {
        groups.push(
            Group::with_title(Level::HELP.secondary_title("write it so"))
                .element(patches(&fix.edits, sources)),
        );
    }
    groups
}

/// Makes an excerpt that shows the lines of a fix before and after the edits, which must be in one text.
fn patches<'a>(edits: &'a [Edit], sources: &'a Sources) -> Snippet<'a, Patch<'a>> {
    let source = sources.get(edits[0].span.source);
    let text = &source.text;
    let start = edits.iter().map(|edit| edit.span.start).min().unwrap_or(0);
    let end = edits.iter().map(|edit| edit.span.end).max().unwrap_or(0);
    let start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[end..].find('\n').map_or(text.len(), |newline| end + newline);
    let patch =
        |edit: &'a Edit| Patch::new(edit.span.start - start..edit.span.end - start, edit.text.as_str());
    Snippet::source(&text[start..end])
        .path(visible(&source.name))
        .line_start(sources.position(edits[0].span.source, start).line)
        .patches(edits.iter().map(patch).collect::<Vec<_>>())
}

fn snippet<'a>(
    labels: &'a [Label],
    first_is_primary: bool,
    sources: &'a Sources,
) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
    let source = sources.get(labels[0].span.source);
    let window = window(labels, &source.text);
    let line = sources.position(labels[0].span.source, window.start).line;
    let annotations = labels.iter().enumerate().map(|(i, label)| {
        let kind = if i == 0 && first_is_primary { AnnotationKind::Primary } else { AnnotationKind::Context };
        let start = boundary(&source.text, label.span.start);
        let end = boundary(&source.text, label.span.end).clamp(start, window.end.max(start));
        let text = (!label.text.is_empty()).then_some(label.text.as_str());
        kind.span(start - window.start..end - window.start).label(text)
    });
    Snippet::source(&source.text[window.clone()])
        .path(visible(&source.name))
        .line_start(line)
        .annotations(annotations.collect::<Vec<_>>())
}

/// Returns the byte range of the lines that contain the labels. Passing only this excerpt to the renderer avoids a copy of the whole file
/// for each error.
fn window(labels: &[Label], text: &str) -> Range<usize> {
    let start = labels.iter().map(|l| boundary(text, l.span.start)).min().unwrap_or(0);
    // Of a label that spans many lines, only the first lines are shown.
    let end = labels.iter().map(|l| first_lines_end(l, text)).max().unwrap_or(0).max(start);
    let start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[end..].find('\n').map_or(text.len(), |newline| end + newline);
    start..end
}

fn first_lines_end(label: &Label, text: &str) -> usize {
    /// The largest number of lines that are shown of a label's text.
    const MAX_LABEL_LINES: usize = 4;
    let end = boundary(text, label.span.end);
    let start = boundary(text, label.span.start).min(end);
    text[start..end].match_indices('\n').nth(MAX_LABEL_LINES - 1).map_or(end, |(newline, _)| start + newline)
}

/// Returns the offset of the first byte of the character that contains the given byte. Beyond the text, returns the length of the text.
fn boundary(text: &str, byte: usize) -> usize {
    let byte = byte.min(text.len());
    (0..=byte).rev().find(|&byte| text.is_char_boundary(byte)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::super::{Code, Span};
    use super::*;

    #[test]
    fn a_diagnostic_shows_its_line_and_the_lines_it_has_to_do_with() {
        let mut sources = Sources::default();
        let id = sources.add("scene.toml", "a = 1\nb = 2\nc = 3\n");
        let set = sources.add("--set", "b=4");
        let diagnostic = Diagnostic::error(Code::UnknownKey, "three things")
            .at(Span::new(id, 6..7), "this")
            .at(Span::new(id, 12..13), "and this")
            .at(Span::new(set, 2..3), "and that")
            .help("mend it");
        let report = Report { sources, diagnostics: vec![diagnostic] };
        insta::assert_snapshot!(report.to_text(false), @r"
        error[unknown-key]: three things
         --> scene.toml:2:1
          |
        2 | b = 2
          | ^ this
        3 | c = 3
          | - and this
          |
         ::: --set:1:3
          |
        1 | b=4
          |   - and that
          |
          = help: mend it
        ");
    }

    #[test]
    fn a_name_and_a_line_cannot_command_the_terminal() {
        let mut sources = Sources::default();
        let hostile = "a\u{1b}[2J\u{9b}1m\u{202e}b\u{200f}c\u{61c}";
        let id = sources.add(format!("x\n{hostile}.toml"), format!("{hostile} = 1\n"));
        let diagnostic = Diagnostic::error(Code::UnknownKey, format!("unknown `{hostile}`"))
            .at(Span::new(id, 0..1), hostile)
            .help(format!("not {hostile}"));
        let report = Report { sources, diagnostics: vec![diagnostic; MOST_OF_A_LINE + 1] };
        assert!(!report.to_text(false).chars().any(|c| is_invisible(c) && c != '\n'));
        let colored = report.to_text(true);
        let escapes = colored.split('\u{1b}').skip(1);
        assert!(escapes.clone().count() > 0);
        for escape in escapes {
            let (color, _) = escape.split_once('m').unwrap();
            assert!(
                color.strip_prefix('[').unwrap().chars().all(|c| c.is_ascii_digit() || c == ';'),
                "{color:?}"
            );
        }
        assert!(!colored.chars().any(|c| is_invisible(c) && !matches!(c, '\n' | '\u{1b}')));
    }

    #[test]
    fn of_a_line_with_very_many_mistakes_not_all_are_shown() {
        let mut sources = Sources::default();
        let id = sources.add("scene.toml", "a = 1\n");
        let error = Diagnostic::error(Code::UnknownKey, "wrong").at(Span::new(id, 0..1), "");
        let report = Report { sources, diagnostics: vec![error; MOST_OF_A_LINE + 3] };
        let text = report.to_text(false);
        assert_eq!(text.matches("error[unknown-key]").count(), MOST_OF_A_LINE);
        assert!(text.ends_with("… and 3 more in line 1 of scene.toml\n\n"), "{text}");
    }

    #[test]
    fn a_place_within_a_character_or_behind_the_text_is_shown_all_the_same() {
        let mut sources = Sources::default();
        let id = sources.add("scene.toml", "π = 1\nü");
        for (start, end) in [(1, 1), (1, 2), (0, 1), (8, 99), (99, 120), (3, 1)] {
            let error = Diagnostic::error(Code::UnknownKey, "wrong").at(Span::new(id, start..end), "here");
            let report = Report { sources: sources.clone(), diagnostics: vec![error] };
            assert!(report.to_text(false).contains("scene.toml:"), "{start}..{end}");
        }
    }
}
