//! Reports unmatched braces in raw SDL, the POV-Ray code of a scene. POV-Ray would report them far from the cause, in the script around the
//! SDL.

use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::sdl::{Token, Tokens};

/// Returns the error for SDL with unmatched braces. `None` if all braces match.
pub(super) fn unbalanced(text: &str, span: Span) -> Option<Diagnostic> {
    let message = match depth(text) {
        Err(()) => "the SDL closes a brace that it has not opened".to_owned(),
        Ok(0) => return None,
        Ok(1) => "the SDL opens a brace that it does not close".to_owned(),
        Ok(open) => format!("the SDL opens {open} braces that it does not close"),
    };
    Some(Diagnostic::error(Code::UnbalancedSdl, message).at(span, ""))
}

/// Returns the number of braces that are still open at the end of the text. Ignores strings and comments.
///
/// # Errors
///
/// Returns an error if a closing brace has no opening brace.
fn depth(text: &str) -> Result<usize, ()> {
    Tokens::of(text).try_fold(0usize, |open, (token, _)| match token {
        Token::Symbol('{') => Ok(open + 1),
        Token::Symbol('}') => open.checked_sub(1).ok_or(()),
        _ => Ok(open),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn braces_in_strings_and_comments_do_not_count() {
        for text in
            ["", "a { b { } }", "\"{\" {}", "\"\\\"{\"", "// {\n{}", "/* { /* { */ } */ {}", "é { } // }"]
        {
            assert_eq!(depth(text), Ok(0), "{text}");
        }
        assert_eq!(depth("a { b {"), Ok(2));
        assert_eq!(depth("} {"), Err(()));
    }
}
