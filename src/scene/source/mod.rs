//! Parses the texts of a scene into a tree of values that know their positions in the text.

mod brackets;
mod copied;
pub(in crate::scene) mod corrections;
pub(super) mod file;
mod foreign;
mod load;
mod overrides;
mod shared;
mod syntax;
mod toml;
mod tree;

pub use copied::CopiedTable;
pub use load::{MAX_BYTES, load};
pub use overrides::Override;
pub use shared::Shared;
pub use toml::parse;
pub use tree::{Entry, Name, Node, Table, Value};
