//! A web server that serves the static page, as any other would.

use std::io::{BufRead as _, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

use crate::support::root;

/// Declares tests of a script, each with a server of its own. A second argument is the method of [`Site`] that runs them.
macro_rules! in_the_browser {
    ($script:literal: $($tests:tt)+) => {
        in_the_browser! { $script, shows: $($tests)+ }
    };
    ($script:literal, $shows:ident: $($(#[$about:meta])* $test:ident),+ $(,)?) => {
        $(
            $(#[$about])*
            #[test]
            fn $test() {
                $crate::site::Site::served().$shows($script, stringify!($test), "");
            }
        )+
    };
}

/// Returns the path of the page's folder.
///
/// # Panics
/// If `playground/build` has not made it.
pub(crate) fn folder() -> PathBuf {
    let folder = root().join("playground/dist");
    assert!(folder.join("jabuka.wasm").is_file(), "run `playground/build` first: it makes the page");
    folder
}

/// Returns the path of the module.
pub(crate) fn module() -> PathBuf {
    folder().join("jabuka.wasm")
}

/// A running server. Dropping it ends the process.
pub(crate) struct Site {
    child: Child,
    pub(crate) address: String,
}

impl Site {
    /// Starts a server of the page.
    pub(crate) fn served() -> Site {
        let mut command = Command::new("node");
        command.arg(root().join("tests/playground/site.mjs")).arg(folder());
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
        let mut address = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
        Site { child, address: address.trim().to_owned() }
    }

    /// Returns the process ID of the server.
    pub(crate) fn process(&self) -> String {
        self.child.id().to_string()
    }

    /// Runs a test of a script in a browser, and asserts that it succeeds. `argument` is for the test.
    pub(crate) fn shows(&self, script: &str, test: &str, argument: &str) {
        self.shows_in(&[], script, test, argument);
    }

    /// Runs a test like [`Site::shows`], in Firefox.
    pub(crate) fn shows_in_firefox(&self, script: &str, test: &str, argument: &str) {
        self.shows_in(&[("JABUKA_BROWSER_NAME", "firefox")], script, test, argument);
    }

    fn shows_in(&self, browser: &[(&str, &str)], script: &str, test: &str, argument: &str) {
        let output = Command::new(root().join("tests/preview/browser"))
            .args([format!("../playground/{script}").as_str(), test, &self.address, argument])
            .envs(browser.iter().copied())
            .output()
            .unwrap();
        assert!(output.status.success(), "{test} {browser:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

impl Drop for Site {
    fn drop(&mut self) {
        // Killing fails if the server has already ended, which does no harm.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
