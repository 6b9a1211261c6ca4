//! Analyzes SDL, POV-Ray's scene description language, to find the files that a text accesses.
//!
//! POV-Ray has no restrictions of its own: a script may open, overwrite and include any file of its user. [`refusals`] therefore compares
//! the SDL of an untrusted scene with a list of allowed words, and [`files`] lists the names of files in a text.

mod files;
mod filter;
mod reference;
mod standard;
mod tokens;
mod words;

pub use self::files::{FileKind, FileName, files};
pub use self::filter::{Refusal, RefusalReason, Where, refusals};
pub use self::reference::reference;
pub use self::standard::WRITING_MACROS;
pub(crate) use self::standard::{INCLUDES, WRITING_INCLUDES};
pub use self::tokens::{Token, Tokens, Unclosed};
pub use self::words::reserved_words;
