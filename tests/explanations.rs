//! Every code is explained, and what its explanation shows is true.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod support;

use std::collections::BTreeSet;

use jabuka::diagnostic::{Diagnostic, Report};
use jabuka::explain::{EXPLANATIONS, Explanation};
use jabuka::output::OutputError;
use jabuka::{Run, Scene};
use support::{jabuka, root, stderr, stdout};

#[test]
fn every_code_has_a_file_and_every_file_a_code() {
    let codes = support::codes(&root().join("src"));
    assert!(codes.len() > 40, "{codes:?}");
    let explained: BTreeSet<String> = EXPLANATIONS.iter().map(|entry| entry.code.to_owned()).collect();
    let lacking: Vec<_> =
        codes.difference(&explained).map(|code| format!("explanations/{code}.md")).collect();
    assert!(lacking.is_empty(), "src/ makes codes that lack their explanations; write {lacking:?}");
    let stale: Vec<_> = explained.difference(&codes).map(|code| format!("explanations/{code}.md")).collect();
    assert!(stale.is_empty(), "nothing in src/ makes the codes of {stale:?}");
}

#[test]
fn every_explanation_has_its_parts_and_fits_a_terminal() {
    for entry in EXPLANATIONS {
        let text = entry.to_string();
        let title = entry.title();
        assert!(title.starts_with(char::is_uppercase) && !title.ends_with('.'), "{}: {title}", entry.code);
        let parts: Vec<_> = ["\n\nWrong:\n\n    ", "\n\nRight:\n\n    "].map(|part| text.find(part)).into();
        assert!(parts[0].is_some() && parts[0] < parts[1], "explanations/{}.md: {parts:?}", entry.code);
        let longest = text.lines().map(|line| line.chars().count()).max();
        assert!(longest <= Some(80), "explanations/{}.md has a line of {longest:?}", entry.code);
    }
}

#[test]
fn what_an_explanation_calls_wrong_gets_the_code_and_what_it_calls_right_gets_none() {
    for entry in EXPLANATIONS {
        let Explanation { code, .. } = entry;
        let (wrong, right) = (entry.wrong(), entry.right());
        let commands = |text: &str| text.lines().all(|line| line.starts_with("$ "));
        if commands(&wrong) {
            assert!(commands(&right), "explanations/{code}.md: one is a scene, the other are commands");
            continue;
        }
        let found = diagnostics(&wrong);
        assert!(
            found.iter().any(|diagnostic| diagnostic.code == *code),
            "explanations/{code}.md: what is wrong gets {found:?}"
        );
        let found = diagnostics(&right);
        assert!(found.is_empty(), "explanations/{code}.md: what is right gets {found:?}");
    }
}

/// All that is said of a scene from its text to its last script.
fn diagnostics(scene: &str) -> Vec<Diagnostic> {
    let failure = |error: OutputError| vec![Diagnostic::error(error.code(), error.to_string())];
    let scene = match Scene::parse(scene) {
        Ok(scene) => scene,
        Err(Report { diagnostics, .. }) => return diagnostics,
    };
    let run = match Run::new(&scene) {
        Ok(run) => run,
        Err(error) => return failure(error.into()),
    };
    for frame in run.frames() {
        if let Err(error) = run.script(&frame.unwrap()) {
            return failure(error.into());
        }
    }
    scene.warnings.diagnostics.iter().cloned().chain(run.warnings()).collect()
}

#[test]
fn explain_prints_the_text_of_a_code() {
    let output = jabuka().args(["explain", "zero-length"]).output().unwrap();
    insta::assert_snapshot!(stdout(&output), @r"
    zero-length: A direction that points nowhere

    Only the direction of these numbers counts, not their length; where all are 0
    there is none.

    Wrong:

        [body.floor]
        shape.plane.normal = [0, 0, 0]

    Right:

        [body.floor]
        shape.plane.normal = [0, 1, 0]
    ");
    assert!(output.status.success());
}

#[test]
fn explain_alone_lists_every_code() {
    let output = jabuka().arg("explain").output().unwrap();
    let said = stdout(&output);
    assert!(output.status.success());
    assert_eq!(said.lines().count(), EXPLANATIONS.len());
    for (line, entry) in said.lines().zip(EXPLANATIONS) {
        assert!(line.starts_with(entry.code) && line.ends_with(entry.title()), "{line}");
    }
}

#[test]
fn a_code_that_there_is_not_is_an_error() {
    let output = jabuka().args(["explain", "unknown-kee"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stderr(&output), "error: there is no code `unknown-kee`; did you mean `unknown-key`?\n");
    let output = jabuka().args(["explain", "xyzzy"]).output().unwrap();
    assert_eq!(stderr(&output), "error: there is no code `xyzzy`\n");
    assert_eq!((output.status.code(), stdout(&output)), (Some(1), String::new()));
}
