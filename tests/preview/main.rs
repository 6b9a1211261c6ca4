//! The page of `jabuka preview`, in a real browser, and its server.
//!
//! Tests that are written in JavaScript are run by `browser`, each in a browser of its own, against a server of its own.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests")]

#[path = "../support/mod.rs"]
mod support;

mod http;
mod server;

mod access;
mod bodies;
mod large;
mod methods;
mod page;
mod process;
mod readme;
mod rendering;
mod saving;
mod strangers;

/// Tests of a script that have the same scene.
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
pub(crate) use in_the_browser;

/// A test that nobody runs would not be missed.
#[test]
fn every_test_in_a_script_is_run() {
    let folder = support::root().join("tests/preview");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let texts = |kind: &str| {
        let of_kind = files.iter().filter(|file| file.extension().is_some_and(|found| found == kind));
        of_kind.map(|file| std::fs::read_to_string(file).unwrap()).collect::<Vec<_>>().concat()
    };
    let (scripts, tests) = (texts("mjs"), texts("rs"));
    let names = scripts.split("\n  async ").skip(1).map(|rest| rest.split('(').next().unwrap());
    let unknown: Vec<&str> = names.filter(|name| !tests.contains(name)).collect();
    assert_eq!(unknown, [""; 0]);
}
