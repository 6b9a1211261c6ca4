//! Errors and warnings about a scene or a run, with their positions in the scene's text.
//!
//! `code.rs` lists the codes of errors and warnings. A `Span` carries its text and hides its offsets: other spans are made relative to it,
//! so an offset never counts in another text. The arguments of `--set` and included files are separate texts, so messages can point into
//! them.
//!
//! If the intended text can be guessed, the diagnostic contains it as a replacement (`fix.rs`). At the end of the check of a scene, each fix
//! is tried, and dropped if its text could then not be read (`scene/check/usable.rs`). `tests/language/mistakes.rs` applies the suggestions
//! and checks again.
//!
//! `visible.rs` replaces control characters, and characters that change the direction of writing, in every text for a terminal.

mod code;
mod fix;
mod json;
mod nearest;
mod source;
mod text;
mod visible;

pub use code::Code;
pub use fix::{Edit, Fix};
pub use json::{Entry, Range};
pub use nearest::nearest;
pub use source::{Position, Source, SourceId, Sources, Span};
pub use visible::{is_invisible, visible, visible_lines, visible_path};

/// The severity of a [`Diagnostic`]: error or warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// An error: the scene cannot be compiled, or the command fails.
    Error,
    /// A warning: the scene compiles, but something in it is probably unintended.
    Warning,
}

/// A remark on a range of the source text.
#[derive(Clone, Debug)]
pub struct Label {
    /// The range of the text that the remark is about.
    pub span: Span,
    /// The text of the remark. May be empty.
    pub text: String,
}

/// An error or a warning, with its positions in the source text and advice.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// The severity: error or warning.
    pub severity: Severity,
    /// The code of the diagnostic, such as `unknown-key`.
    pub code: Code,
    /// The description of the error, in one line.
    pub message: String,
    /// The labeled ranges of text: first that of the error, then related ones.
    pub labels: Vec<Label>,
    /// Advice on how to correct the error, in words.
    pub help: Option<String>,
    /// A correction that a program can apply, as replacements of text.
    pub fix: Option<Box<Fix>>,
}

impl Diagnostic {
    /// Creates an error with a code and a message, without labels or advice.
    pub fn error(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Error,
            code,
            message: visible(&message.into()),
            labels: Vec::new(),
            help: None,
            fix: None,
        }
    }

    /// Creates a warning with a code and a message, without labels or advice.
    pub fn warning(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, message) }
    }

    /// Adds a label: a range of text with a remark. The first label marks the error itself.
    #[must_use]
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: visible(&text.into()) });
        self
    }

    /// Sets the advice on how to correct the error.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(visible(&help.into()));
        self
    }

    /// Adds a replacement of a range of text to the suggested correction. Several replacements are applied together.
    #[must_use]
    pub fn fix(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.fix.get_or_insert_default().add(Edit { span, text: text.into() });
        self
    }

    /// Marks the correction as already shown by a label, so that the printed diagnostic does not show it twice.
    #[must_use]
    pub fn fix_is_said(mut self) -> Diagnostic {
        self.fix.iter_mut().for_each(|fix| fix.is_said = true);
        self
    }

    /// Returns the range of the error in the source text: that of the first label. `None` if the diagnostic has no label.
    pub fn span(&self) -> Option<Span> {
        self.labels.first().map(|label| label.span)
    }
}

/// The diagnostics of one scene, with the texts that they refer to.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The texts of the scene: its files and its `--set` arguments.
    pub sources: Sources,
    /// The errors and warnings. [`Report::sort`] orders them by position.
    pub diagnostics: Vec<Diagnostic>,
}

impl Report {
    /// Creates a report with one error that has no position in a text.
    pub fn of_error(code: Code, message: impl Into<String>) -> Report {
        Report { sources: Sources::default(), diagnostics: vec![Diagnostic::error(code, message)] }
    }

    /// Returns the number of errors in the report.
    pub fn errors(&self) -> usize {
        self.diagnostics.iter().filter(|d| d.severity == Severity::Error).count()
    }

    /// Returns the number of warnings in the report.
    pub fn warnings(&self) -> usize {
        self.diagnostics.len() - self.errors()
    }

    /// Sorts the diagnostics by their positions in the source text. Diagnostics without a position come first.
    pub fn sort(&mut self) {
        self.diagnostics.sort_by_key(Diagnostic::span);
    }

    /// Formats the diagnostics for a terminal, in the style of rustc. `color` adds ANSI colors.
    pub fn to_text(&self, color: bool) -> String {
        text::render(self, color)
    }

    /// Returns the diagnostics as data for editors. They can be serialized in any format that serde supports.
    pub fn to_json(&self) -> Vec<Entry<'_>> {
        json::entries(self)
    }
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.to_text(false))
    }
}

impl std::error::Error for Report {}
