//! POV-Ray's scene description language (SDL), as far as it can be told from a text which files it touches.
//!
//! POV-Ray restricts nothing: a script may open, overwrite and include any file of its user. So [`refusals`] holds SDL
//! of an untrusted scene against a list of words that may be used, and [`files`] lists the names of files in a text.

mod files;
mod filter;
mod reference;
mod standard;
mod tokens;
mod words;

pub use self::files::{FileKind, FileName, files};
pub use self::filter::{Refusal, Where, Why, refusals};
pub use self::reference::reference;
pub use self::standard::WRITING_MACROS;
pub(crate) use self::standard::{INCLUDES, WRITING_INCLUDES};
pub use self::tokens::{Token, Tokens, Unclosed};
pub use self::words::reserved_words;
