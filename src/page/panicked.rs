//! Turns a panic, which is a bug in jabuka, into an error on the page.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::diagnostic::{Code, Diagnostic, Report};

/// Runs work that may panic. A panic becomes an error report, and the thread continues. `doing` names the work in the report.
///
/// After a panic, the caller must not use data that the work left half done.
pub(crate) fn caught<T>(doing: &str, work: impl FnOnce() -> Result<T, Report>) -> Result<T, Report> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let message = format!("jabuka failed while {doing}: {}", message_of(&*panic));
        let help = "this is a mistake in jabuka: please report it with the scene and with what the terminal shows; \
            the scene is read again when you change it";
        let error = Diagnostic::error(Code::InternalError, message).help(help);
        Err(Report { diagnostics: vec![error], ..Report::default() })
    })
}

/// Returns the message of a panic.
fn message_of(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no reason is known")
}
