//! What editors and whole commands make of the language.

mod editor;
mod explanations;
