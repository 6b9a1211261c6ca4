//! The scene as written: converts texts to a tree of values with their places.

mod brackets;
mod copied;
pub(super) mod file;
pub(in crate::scene) mod habits;
mod load;
mod overrides;
mod shared;
mod syntax;
mod toml;
mod tree;
mod yaml;

pub use copied::CopiedTable;
pub use load::{MAX_BYTES, load};
pub use overrides::Override;
pub use shared::Shared;
pub use toml::parse;
pub use tree::{Entry, Name, Node, Table, Value};
