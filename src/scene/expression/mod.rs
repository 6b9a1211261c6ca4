//! The language of formulas: compiles the text of an expression into a small program that can be evaluated millions of times.
//!
//! Compiling takes three steps. [`Formula::parse`] reads the text. [`Formula::resolve`] looks up the names in a [`Scope`] and computes
//! constant subexpressions. [`Resolved::compile`] makes a [`Program`] for an inner loop. [`Program::compile`] does all three steps.
//! [`Resolved::value`] computes a value that is needed only once. It is strict: it returns an error, with its position, for the first
//! operation that has a non-finite result.
//!
//! ```
//! use jabuka::scene::expression::{Program, Scope};
//!
//! let mut scope = Scope::default();
//! scope.constant("k", 4.0);
//! let x = scope.slot("x");
//! assert_eq!(x, 0);
//! let program = Program::compile("-k*x^2", &scope).expect("it is a formula");
//! assert_eq!(program.eval(&[3.0]), -36.0);
//! let error = Program::compile("1/x", &scope).expect("so is this").explain_non_finite(&[0.0]);
//! assert_eq!(error.expect("nothing can be divided by 0").code.name(), "division-by-zero");
//! ```
//!
//! All functions come from `libm` or are exact, so values have the same bits on every platform.

mod angles;
mod corrections;
mod derive;
mod emit;
mod error;
mod explain;
mod fold;
mod function;
mod lexer;
mod lift;
mod operation;
mod parser;
mod program;
mod resolve;
mod scope;
#[cfg(test)]
mod tests;
mod wide;

pub use error::ExpressionError;
pub(in crate::scene) use error::too_intricate;
pub use function::{CONSTANTS, FUNCTIONS, Function};
pub(in crate::scene) use lift::Constants;
pub use parser::{Formula, MAX_LENGTH};
pub(in crate::scene) use program::Code;
pub use program::Program;
pub use resolve::{Draw, Resolved};
pub use scope::Scope;
pub(in crate::scene) use wide::{MAX_LANES, Output, Wide};
