//! Errors in formulas.

use crate::diagnostic::Code;
use std::ops::Range;

/// One mistake in a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// The kind of mistake: `formula-syntax`.
    pub code: Code,
    /// The bytes of the formula that are wrong.
    pub range: Range<usize>,
    /// The mistake, in one line.
    pub message: String,
    /// The remark at the place; may be empty.
    pub label: String,
    /// How to mend it, if there is more to say.
    pub help: Option<String>,
    /// The text that belongs in the place of those bytes, if it is known.
    pub fix: Option<Box<str>>,
}

/// Creates an error with a code, the wrong bytes of the formula, and a message. It has no label, help or fix yet.
pub(super) fn error(code: Code, range: Range<usize>, message: impl Into<String>) -> ExpressionError {
    ExpressionError { code, range, message: message.into(), label: String::new(), help: None, fix: None }
}

/// A mistake in how a formula is written.
pub(super) fn syntax(range: Range<usize>, message: impl Into<String>) -> ExpressionError {
    error(Code::FormulaSyntax, range, message)
}

/// The error for a formula whose consequences are too many to follow.
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
