//! Tests of the language that need other programs: editors and their language servers, and the commands of the explanations.

mod editor;
mod explanations;
mod neovim;
