//! Tests that every error code has an explanation, and that the examples of the explanations do what the text says.

use std::fs;

use crate::support::{self, commands, jabuka, root, stderr, stdout};
use jabuka::diagnostic::{Code, Diagnostic, Report};
use jabuka::explain::explanations;
use jabuka::output::OutputError;
use jabuka::{Run, Scene};

/// Checks that `src/` uses every code, and that every file of `explanations/` belongs to a code. The compiler ensures that every code has
/// a file.
#[test]
fn every_code_is_made_somewhere_and_every_file_is_of_a_code() {
    let made = support::codes(&root().join("src"));
    let unused: Vec<_> = Code::ALL.iter().filter(|code| !made.contains(code)).collect();
    assert!(unused.is_empty(), "nothing in src/ makes {unused:?}");
    for entry in fs::read_dir(root().join("explanations")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert!(Code::named(name).is_some(), "{name} is no code: see src/diagnostic/code.rs");
    }
}

#[test]
fn every_explanation_has_its_parts_and_fits_a_terminal() {
    for entry in explanations() {
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
    for entry in explanations() {
        let code = entry.code;
        let (wrong, right) = (entry.wrong(), entry.right());
        if commands::are(&wrong) {
            assert!(commands::are(&right), "explanations/{code}.md: one is a scene, the other are commands");
            continue;
        }
        let found = diagnostics(&wrong);
        assert!(
            found.iter().any(|diagnostic| diagnostic.code == code),
            "explanations/{code}.md: what is wrong gets {found:?}"
        );
        let found = diagnostics(&right);
        assert!(found.is_empty(), "explanations/{code}.md: what is right gets {found:?}");
    }
}

/// Returns all diagnostics of a scene: those of the check, of the run, and of its scripts.
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
    assert_eq!(said.lines().count(), explanations().len());
    for (line, entry) in said.lines().zip(explanations()) {
        assert!(line.starts_with(entry.code.name()) && line.ends_with(entry.title()), "{line}");
    }
}

#[test]
fn a_code_that_there_is_not_is_an_error() {
    let output = jabuka().args(["explain", "unknown-kee"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(
        said.starts_with("error: there is no code or key `unknown-kee`; did you mean `unknown-key`?\n"),
        "{said}"
    );
    let output = jabuka().args(["explain", "xyzzy"]).output().unwrap();
    assert!(stderr(&output).starts_with("error: there is no code or key `xyzzy`\n"), "{}", stderr(&output));
    assert_eq!((output.status.code(), stdout(&output)), (Some(1), String::new()));
}

#[test]
fn every_command_of_an_explanation_is_one_that_jabuka_has() {
    for entry in explanations() {
        for (text, is_right) in [(entry.wrong(), false), (entry.right(), true)] {
            for command in text.lines().filter_map(|line| line.strip_prefix("$ ")).flat_map(commands::of_line)
            {
                let Err(why) = commands::parses(&command) else { continue };
                // The value of an option may be the mistake that the example shows; an unknown option never is.
                let about_a_value = why.starts_with("error: invalid value");
                assert!(!is_right && about_a_value, "explanations/{}.md: `{command}`: {why}", entry.code);
            }
        }
    }
}
