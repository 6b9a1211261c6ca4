//! Raw SDL, and what it may do without being trusted.
//!
//! POV-Ray does what a script says: it opens, overwrites and includes any file that its user can. So raw SDL in a
//! scene is code, and a scene from somewhere else must not get to run what reaches for files.

use crate::diagnostic::{Diagnostic, Span};
use crate::scene::grammar::Kind;
use crate::scene::sdl::{Include, after_comment, includes};
use crate::scene::source::Node;

/// Directives that open, read, write or include a file, after a `#`.
const DIRECTIVES: [&str; 5] = ["fopen", "fclose", "read", "write", "include"];
/// Macros of POV-Ray's own include files that write a file; those that begin so, too.
const MACROS: [&str; 6] =
    ["Parse_String", "ARRAYS_WriteDF3", "HF_", "HFCreate_", "BuildWriteMesh2", "MakeGrass"];
/// POV-Ray's own include files that consist of such macros.
pub(super) const WRITING_INCLUDES: [&str; 2] = ["makegrass.inc", "meshmaker.inc"];

/// Raw SDL that a scene may contain.
pub(super) fn read(node: &Node, trust: bool) -> Result<&str, Diagnostic> {
    let text = node.as_str().ok_or_else(|| super::read::wrong_type(node, &Kind::Sdl))?;
    if text.contains('\0') {
        return Err(Diagnostic::error("untrusted-sdl", "the SDL contains a NUL character").at(node.span, ""));
    }
    match first_file_access(text) {
        Some(what) if !trust => Err(untrusted(&what, node.span)),
        _ => super::braces::unbalanced(text, node.span).map_or(Ok(text), Err),
    }
}

/// That a text reaches for files.
pub(super) fn untrusted(what: &str, span: Span) -> Diagnostic {
    Diagnostic::error("untrusted-sdl", format!("the SDL reaches for files: `{what}`"))
        .at(span, "")
        .help("if you know this scene and trust it, say `--trust`")
}

/// The warning of a text that includes a file whose name only POV-Ray will know, if it does.
pub(super) fn computed_include(text: &str, span: Span) -> Option<Diagnostic> {
    let message = "the name of a file that the SDL includes is computed";
    let warning = Diagnostic::warning("computed-include", message).at(span, "");
    let help = "when that file changes, nothing tells that images are out of date";
    includes(text).contains(&Include::Computed).then(|| warning.help(help))
}

/// The first word of the text that opens, reads, writes or includes a file. Words in comments and strings count:
/// better one refusal too many than a way around it.
pub(super) fn first_file_access(text: &str) -> Option<String> {
    let directive = text.match_indices('#').find_map(|(at, _)| {
        let rest = after_blanks(&text[at + 1..]);
        if rest.is_empty() {
            // The word of this directive would be the first one of whatever text comes next.
            return Some((at, "#".to_owned()));
        }
        DIRECTIVES.into_iter().find(|word| word_at(rest) == *word).map(|word| (at, format!("#{word}")))
    });
    let macro_call =
        MACROS.into_iter().filter_map(|name| text.find(name).map(|at| (at, name.to_owned()))).min();
    directive.into_iter().chain(macro_call).min().map(|(_, what)| what)
}

/// What follows white space and comments: POV-Ray allows both between `#` and its word.
fn after_blanks(mut text: &str) -> &str {
    loop {
        text = text.trim_start_matches(|c: char| c.is_whitespace() || c.is_control());
        if let Some(comment) = text.strip_prefix("//") {
            text = comment.split_once(['\n', '\r']).map_or("", |(_, rest)| rest);
        } else if let Some(comment) = text.strip_prefix("/*") {
            // Comments nest; to look behind every `*/` would be longer and no safer than to look behind the last
            // of those that close here.
            text = after_comment(comment);
        } else {
            return text;
        }
    }
}

fn word_at(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len());
    &text[..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_a_file_is_found() {
        for text in [
            "#fopen F \"x\" write",
            "#write(F, 1)",
            "#  include \"x\"",
            "#\n\tread (F, A)",
            "#/* a /* b */ c */include \"x\"",
            "# // a\n include \"x\"",
            "a # b #fopen",
            "Parse_String(\"x\")",
            "HF_Square(f, 0, 0, 1, 1, \"x\", 0, 1)",
            "/* #include */",
            "#",
            "sphere { } # ",
            "# // x",
            "# /* x",
        ] {
            assert!(first_file_access(text).is_some(), "{text:?}");
        }
    }

    #[test]
    fn other_words_pass() {
        for text in ["", "#declare A = 1;", "texture { T_Chrome_4C }", "#included", "read write include"] {
            assert_eq!(first_file_access(text), None, "{text:?}");
        }
    }
}
