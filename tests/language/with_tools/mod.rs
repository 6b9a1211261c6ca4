//! Tests of the language that need other programs: an editor's language server, and the commands of the explanations.

mod editor;
mod explanations;
