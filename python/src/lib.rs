//! The compiled part of the Python package `jabuka`.
//!
//! The classes here hold what the library computes, and return numpy arrays and texts. The Python files in `package/jabuka/` make the
//! public interface of them: names, tables, pictures for notebooks. While the library computes, other Python threads can run
//! (`background`).

mod arrays;
mod background;
mod command;
mod errors;
mod events;
mod measures;
mod pictures;
mod run;
mod scene;
mod toml_text;

/// The compiled part of the package `jabuka`. Use the package instead: its names are documented.
#[pyo3::pymodule]
mod _jabuka {
    #[pymodule_export]
    use super::background::Stop;
    #[pymodule_export]
    use super::command::{command, set_launcher};
    #[pymodule_export]
    use super::run::Run;
    #[pymodule_export]
    use super::scene::{Scene, nearest};
    #[pymodule_export]
    use super::toml_text::{toml_document, toml_value};
}
