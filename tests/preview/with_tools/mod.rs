//! Tests of the preview's page in a real browser.
//!
//! `tests/preview/browser` runs the tests written in JavaScript, each in its own browser and with its own server. They run in Chromium, or in the
//! browser that `JABUKA_BROWSER_NAME` names.

use std::process::Command;

use crate::server::{Scene, Server};
use crate::support::root;

/// Declares tests of a JavaScript file that preview the same scene.
macro_rules! in_the_browser {
    ($scene:expr, $script:literal: $($(#[$about:meta])* $test:ident),+ $(,)?) => {
        $(
            $(#[$about])*
            #[test]
            fn $test() {
                $scene.shows($script, stringify!($test));
            }
        )+
    };
}
mod bodies;
mod camera;
mod colors;
mod editing;
mod exports;
mod firefox;
mod large;
mod marks;
mod methods;
mod one_file;
mod page;
mod plots;
mod readme;
mod rendering;
mod saving;
mod sliders;
mod strangers;

impl Scene {
    /// Starts a preview of the scene, and asserts that a test of a JavaScript file succeeds.
    pub(super) fn shows(self, script: &str, test: &str) {
        self.served().shows(script, test);
    }
}

impl Server {
    /// Runs a test of a JavaScript file in a browser, and asserts that it succeeds. Returns its output.
    pub(super) fn shows(&self, script: &str, test: &str) -> String {
        self.shows_at(&self.address, script, test)
    }

    /// Runs a test of a JavaScript file like [`Server::shows`], but with this address instead of the server's own.
    pub(super) fn shows_at(&self, address: &str, script: &str, test: &str) -> String {
        self.shows_in(&[], address, script, test)
    }

    /// Runs a test of a JavaScript file like [`Server::shows`], in Firefox.
    fn shows_in_firefox(&self, script: &str, test: &str) {
        self.shows_in(&[("JABUKA_BROWSER_NAME", "firefox")], &self.address, script, test);
    }

    fn shows_in(&self, browser: &[(&str, &str)], address: &str, script: &str, test: &str) -> String {
        let output = Command::new(root().join("tests/preview/browser"))
            .args([script, test, address])
            .arg(self.scene.path())
            .env("JABUKA", env!("CARGO_BIN_EXE_jabuka"))
            .envs(browser.iter().copied())
            .current_dir(self.scene.folder())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success(),
            "{test} of {} {browser:?}: {said}\nthe server said: {}",
            self.scene.name,
            self.said()
        );
        String::from_utf8(output.stdout).unwrap()
    }
}

/// Checks that every test in the JavaScript files is listed in a Rust file; otherwise it would never run.
#[test]
fn every_test_in_a_script_is_run() {
    let folder = root().join("tests/preview");
    let below = |folder| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files: Vec<_> = below(folder.clone()).chain(below(folder.join("with_tools"))).collect();
    let texts = |kind: &str| {
        let of_kind = files.iter().filter(|file| file.extension().is_some_and(|found| found == kind));
        of_kind.map(|file| std::fs::read_to_string(file).unwrap()).collect::<Vec<_>>().concat()
    };
    let (scripts, tests) = (texts("mjs"), texts("rs"));
    let names = scripts.split("\n  async ").skip(1).map(|rest| rest.split('(').next().unwrap());
    let unknown: Vec<&str> = names.filter(|name| !tests.contains(name)).collect();
    assert_eq!(unknown, [""; 0]);
}
