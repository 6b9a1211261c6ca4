//! Tests of hostile file names: they cannot control the terminal, and suggested commands can be pasted into a shell.

use std::fs;
use std::process::Command;

use crate::scene::{Place, SCENE};
use crate::support::{stderr, stdout};

/// A file name that would clear the screen, start a new line, reverse the direction of writing, and end a quoted word of a shell.
const HOSTILE: &str = "-a b'$(touch PWNED)\nerror\u{1b}[2J\u{9b}31m\u{202e}\u{2066}\u{200f}";

/// Returns true if a text contains no control characters except for line breaks and tabs, and no characters that change the direction of
/// writing.
fn is_harmless(text: &str) -> bool {
    !text.chars().any(|c| {
        c.is_control() && !matches!(c, '\n' | '\t')
            || matches!(c, '\u{200e}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    })
}

#[test]
fn no_command_lets_a_name_command_the_terminal() {
    let place = Place::new(SCENE);
    let scene = format!("./{HOSTILE}.toml");
    fs::write(place.path(&scene), SCENE).unwrap();
    let bad = SCENE.replace("[body.ball]", "color = '\u{202e}\u{9b}'\n[body.'\u{202e}\u{200f}']");
    fs::write(place.path(&format!("{HOSTILE}bad.toml")), bad).unwrap();
    let (bad, folder) = (format!("./{HOSTILE}bad.toml"), format!("out/{HOSTILE}"));
    let named = |ending: &str| format!("./{HOSTILE}{ending}");
    let (png, mp4, csv) = (named(".png"), named(".mp4"), named(".csv"));
    let commands: &[&[&str]] = &[
        &["check", &scene],
        &["check", &scene, "--format", "json"],
        &["check", &bad],
        &["check", &bad, "--format", "json"],
        &["check", HOSTILE],
        &["compile", &scene, "--frames", "0-1"],
        &["compile", &scene, "--frames", "0-1", "--check"],
        &["compile", &scene, "-o", &scene],
        &["render", &scene, "--frames", "0-1", "--video", &mp4, "--contact-sheet", &png],
        &["render", &folder, "--frames", "0-1", "--every", "2"],
        &["render", &scene, "--povray", HOSTILE],
        &["render", HOSTILE],
        &["still", &scene, "-o", &png],
        &["still", &scene, "-o", &csv],
        &["status", &folder],
        &["status", &scene],
        &["batch", &folder, "--engine", "slurm"],
        &["batch", &scene, "--engine", "openjd", "--frames", "0"],
        &["average", "-o", &png, &scene],
        &["export", &scene, "-o", &csv],
        &["export", &scene, "-o", &scene],
        &["new", HOSTILE],
        &["new", &named("")],
        &["explain", HOSTILE],
        &["list", HOSTILE],
        &["templates", &scene],
        &["preview", HOSTILE],
        &[HOSTILE],
        &[&scene],
    ];
    for command in commands {
        let output = place.run(command);
        let (result, said) = (stdout(&output), stderr(&output));
        assert!(is_harmless(&result) && is_harmless(&said), "{command:?}\n{result:?}\n{said:?}");
        let starts = |line: &str| line.starts_with("error\\") || line == "error";
        assert!(!result.lines().chain(said.lines()).any(starts), "{command:?} {result:?}{said:?}");
        assert!(!(result + &said).is_empty(), "{command:?}");
    }
    assert!(!place.path("PWNED").exists());
    // JSON for programs holds the name unchanged.
    let json = stdout(&place.run(&["check", &bad, "--format", "json"]));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json[0]["file"], bad.as_str());
}

#[test]
fn a_suggested_command_can_be_pasted() {
    let place = Place::new(SCENE);
    fs::write(place.path(&format!("./{HOSTILE}.toml")), SCENE).unwrap();
    let said = stdout(&place.succeed(&["compile", &format!("./{HOSTILE}.toml"), "--frames", "0"]));
    let command = said.lines().find_map(|line| line.strip_prefix("render    jabuka ")).unwrap();
    let command = format!("{} {command} --size 16x9", env!("CARGO_BIN_EXE_jabuka"));
    let output = Command::new("bash").args(["-c", &command]).current_dir(place.path(".")).output().unwrap();
    assert!(output.status.success(), "{command}\n{}", stderr(&output));
    assert!(place.path(&format!("out/{HOSTILE}/images/frame_0000.png")).exists());
    assert!(!place.path("PWNED").exists());
}
