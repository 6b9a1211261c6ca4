//! Functions that all fuzz targets share. `tests/fuzz` calls the same functions with inputs of its own.
//!
//! With a nightly toolchain and `cargo install cargo-fuzz`, from the folder of the repository:
//!
//! ```sh
//! cargo +nightly fuzz list
//! mkdir -p fuzz/corpus/scene
//! cargo +nightly fuzz run scene fuzz/corpus/scene scenes tests/bad tests/mistakes -- -timeout=10 -rss_limit_mb=2048
//! ```
//!
//! Without nightly, `cargo test --test fuzz` tries the same functions; see the top of `tests/fuzz/main.rs`.

#[path = "../../tests/fuzz/targets.rs"]
pub mod targets;

use std::path::Path;
use std::sync::OnceLock;

/// Returns a temporary folder for input files, which exists as long as the program runs.
pub fn folder() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    FOLDER.get_or_init(|| tempfile::tempdir().expect("there is room for small files")).path()
}
