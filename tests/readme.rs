//! Every scene, command and output that the README shows is real.
//!
//! A `toml` block is written to the file that its first line names; of a `console` block every command is run, in the
//! order of the page, and must print what stands below it. To see what the page should say:
//! `JABUKA_UPDATE_DOCS=1 cargo test --test readme` writes the outputs into it.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test stops at the first surprise")]

#[path = "support/mod.rs"]
mod support;

use std::fs;
use std::path::Path;
use std::process::Command;

use support::root;

#[test]
fn every_command_prints_what_the_page_shows() {
    let folder = tempfile::tempdir().unwrap();
    let copy = Command::new("cp").arg("-r").arg(root().join("scenes")).arg(folder.path()).status();
    assert!(copy.unwrap().success());
    let page = fs::read_to_string(root().join("README.md")).unwrap();

    let mut real = String::new();
    let mut rest = page.as_str();
    while let Some((before, block)) = rest.split_once("```") {
        let (block, after) = block.split_once("\n```").expect("a block ends");
        let (language, text) = block.split_once('\n').expect("a block has lines");
        real.push_str(before);
        let text = match language {
            "toml" => write_scene(folder.path(), text),
            "console" => run_commands(folder.path(), text),
            _ => text.to_owned(),
        };
        real.push_str(&format!("```{language}\n{}\n```", text.trim_end()));
        rest = after;
    }
    real.push_str(rest);

    if std::env::var_os("JABUKA_UPDATE_DOCS").is_some() && untimed(&page) != untimed(&real) {
        fs::write(root().join("README.md"), &real).unwrap();
    } else {
        assert_same(&untimed(&page), &untimed(&real));
    }
    assert_same_film(&folder.path().join("figure_eight.gif"), &root().join("docs/figure_eight.gif"));
}

/// Asserts that the film that the page shows is the one that its command has made, however it is encoded.
fn assert_same_film(made: &Path, shown: &Path) {
    let pixels = |path: &Path| {
        let decode = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-fps_mode", "passthrough", "-"];
        let output =
            Command::new("ffmpeg").args(["-v", "error", "-nostdin", "-i"]).arg(path).args(decode).output();
        output.unwrap().stdout
    };
    let (new, old) = (pixels(made), pixels(shown));
    assert!(!new.is_empty(), "{} is no film", made.display());
    let difference: u64 = new.iter().zip(&old).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    // The palette of a GIF leaves less than that undecided.
    let same = new.len() == old.len() && difference < new.len() as u64;
    if !same && std::env::var_os("JABUKA_UPDATE_DOCS").is_some() {
        fs::copy(made, shown).unwrap();
    } else {
        assert!(same, "{} is another film than the README's command makes", shown.display());
    }
}

/// Writes a scene to the file that its first line names: `# ball.toml`.
fn write_scene(folder: &Path, text: &str) -> String {
    let name = text.lines().next().and_then(|line| line.strip_prefix("# ")).expect("a scene names its file");
    fs::write(folder.join(name), text).unwrap();
    text.to_owned()
}

/// Runs the commands of a block, and returns it as it should be.
fn run_commands(folder: &Path, block: &str) -> String {
    let bin = Path::new(env!("CARGO_BIN_EXE_jabuka")).parent().unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    let commands = block.lines().filter_map(|line| line.strip_prefix("$ "));
    let run = |command: &str| {
        // The binary is built already; building it in the folder of the test would need the whole project.
        let short = command.replace("cargo run --release --", "jabuka");
        let output = Command::new("bash")
            .args(["-c", &format!("exec 2>&1; {short}")])
            .current_dir(folder)
            .env("PATH", &path)
            .output()
            .unwrap();
        format!("$ {command}\n{}", String::from_utf8(output.stdout).unwrap().trim_end_matches('\n'))
    };
    commands.map(run).map(|text| text.trim_end().to_owned() + "\n").collect()
}

/// The lines of a page, without the seconds that a run took, and what depends on them.
fn untimed(page: &str) -> Vec<&str> {
    page.lines().map(untimed_line).collect()
}

fn untimed_line(line: &str) -> &str {
    const SLOWEST: &str = "slowest   ";
    if line.starts_with(SLOWEST) { SLOWEST } else { unclocked(line) }
}

/// A line without the seconds at its end.
fn unclocked(line: &str) -> &str {
    match str::strip_suffix(line, " s").and_then(|line| line.rsplit_once(" in ")) {
        Some((what, seconds)) if seconds.parse::<f64>().is_ok() => what,
        _ => line,
    }
}

/// Asserts that two pages are equal, and says where they are not.
fn assert_same(page: &[&str], real: &[&str]) {
    for (i, (line, real)) in page.iter().zip(real).enumerate() {
        assert_eq!(line, real, "README.md, line {}", i + 1);
    }
    assert_eq!(page.len(), real.len(), "the number of lines of README.md");
}
