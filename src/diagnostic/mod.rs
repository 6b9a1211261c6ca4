//! Errors and warnings about a scene or a run, each at its place.

mod code;
mod fix;
mod json;
mod nearest;
mod source;
mod text;
mod visible;

pub use code::Code;
pub use fix::{Edit, Fix};
pub use json::Entry;
pub use nearest::nearest;
pub use source::{Position, Source, SourceId, Sources, Span};
pub use visible::{is_invisible, visible, visible_lines, visible_path};

/// The severity of a [`Diagnostic`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene cannot be compiled.
    Error,
    /// The scene compiles, but something in it is probably unintended.
    Warning,
}

/// A remark on one place of a text.
#[derive(Clone, Debug)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// The remark; may be empty.
    pub text: String,
}

/// One error or warning.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// The kind of mistake.
    pub code: Code,
    /// The mistake, in one line.
    pub message: String,
    /// The places: first the wrong one, then related ones.
    pub labels: Vec<Label>,
    /// How to fix it, in words.
    pub help: Option<String>,
    /// How to fix it, as text to replace.
    pub fix: Option<Box<Fix>>,
}

impl Diagnostic {
    /// An error of the given kind.
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

    /// A warning of the given kind.
    pub fn warning(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, message) }
    }

    /// Adds a place: the first one added is the wrong one.
    #[must_use]
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: visible(&text.into()) });
        self
    }

    /// Adds advice on how to fix it.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(visible(&help.into()));
        self
    }

    /// Adds a replacement at a place; several are applied together.
    #[must_use]
    pub fn fix(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.fix.get_or_insert_default().edits.push(Edit { span, text: text.into() });
        self
    }

    /// Marks the fix as shown by a label already, so that the printed diagnostic does not show the fix twice.
    #[must_use]
    pub fn fix_is_said(mut self) -> Diagnostic {
        self.fix.iter_mut().for_each(|fix| fix.is_said = true);
        self
    }

    /// The place of the mistake, if it has one.
    pub fn span(&self) -> Option<Span> {
        self.labels.first().map(|label| label.span)
    }
}

/// The diagnostics of one scene, with the texts that they point into.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The texts.
    pub sources: Sources,
    /// The diagnostics, in the order of their places.
    pub diagnostics: Vec<Diagnostic>,
}

impl Report {
    /// A report of one error without a place in a text.
    pub fn of_error(code: Code, message: impl Into<String>) -> Report {
        Report { sources: Sources::default(), diagnostics: vec![Diagnostic::error(code, message)] }
    }

    /// The number of errors.
    pub fn errors(&self) -> usize {
        self.diagnostics.iter().filter(|d| d.severity == Severity::Error).count()
    }

    /// The number of warnings.
    pub fn warnings(&self) -> usize {
        self.diagnostics.len() - self.errors()
    }

    /// Sorts the diagnostics by their places; those without a place come first.
    pub fn sort(&mut self) {
        self.diagnostics.sort_by_key(Diagnostic::span);
    }

    /// The diagnostics for a terminal, in the style of rustc; `color` adds ANSI colors.
    pub fn to_text(&self, color: bool) -> String {
        text::render(self, color)
    }

    /// The diagnostics for editors; any format of serde can serialize them.
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
