//! The errors that parsing and evaluating a formula can report.

use crate::diagnostic::Code;
use std::ops::Range;

/// An error in a formula, with its position and advice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// The code of the error, such as `formula-syntax`.
    pub code: Code,
    /// The byte range of the mistake within the formula.
    pub range: Range<usize>,
    /// The description of the mistake, in one line.
    pub message: String,
    /// The remark that is shown below the marked text. May be empty.
    pub label: String,
    /// Advice on how to correct the formula, if there is more to say than in the label.
    pub help: Option<String>,
    /// The text that should replace the bytes in `range`, if a correction is known.
    pub fix: Option<Box<str>>,
}

/// Creates an error from a code, the byte range of the mistake, and a message. The error has no label, help or fix yet.
pub(super) fn error(code: Code, range: Range<usize>, message: impl Into<String>) -> ExpressionError {
    ExpressionError { code, range, message: message.into(), label: String::new(), help: None, fix: None }
}

/// Creates an error for wrong syntax in a formula.
pub(super) fn syntax(range: Range<usize>, message: impl Into<String>) -> ExpressionError {
    error(Code::FormulaSyntax, range, message)
}

/// Creates the error for a formula of a motion that is too complicated to analyze.
pub(in crate::scene) fn too_intricate(range: Range<usize>, message: &str) -> ExpressionError {
    syntax(range, message).help("write it in a simpler way, or give the motion by keyframes or a file")
}

impl ExpressionError {
    #[must_use]
    pub(super) fn label(mut self, label: impl Into<String>) -> ExpressionError {
        self.label = label.into();
        self
    }

    #[must_use]
    pub(super) fn fix(mut self, text: impl Into<Box<str>>) -> ExpressionError {
        self.fix = Some(text.into());
        self
    }

    #[must_use]
    pub(super) fn help(mut self, help: impl Into<String>) -> ExpressionError {
        self.help = Some(help.into());
        self
    }
}

impl std::fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ExpressionError {}
