//! Checks that every scene, command, output and picture of a page is real.
//!
//! Each `toml` block is written to the file that its first line names. Each command of a `console` block is run, in the order of the page,
//! and must print the lines below it. A picture made by the commands must look like the picture that the page shows. With
//! `JABUKA_UPDATE_DOCS` set, differing outputs are written into the page, and differing pictures replace the old files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::root;

/// A page of the documentation whose commands have been run.
pub(crate) struct Page {
    /// The path of the page, relative to the root of the project.
    path: &'static str,
    /// The folder that the commands of the page run in; it holds the files that they made.
    folder: tempfile::TempDir,
}

impl Page {
    /// Runs all commands of a page, and checks everything but its pictures. The commands may also use scenes from the pages `scenes_of`.
    pub(crate) fn check(path: &'static str, scenes_of: &[&str]) -> Page {
        let page = Page { path, folder: tempfile::tempdir().unwrap() };
        let copy = Command::new("cp").arg("-r").arg(root().join("scenes")).arg(page.folder.path()).status();
        assert!(copy.unwrap().success());
        for other in scenes_of {
            page.write_scenes(&fs::read_to_string(root().join(other)).unwrap());
        }
        let shown = fs::read_to_string(root().join(path)).unwrap();
        let real = page.real(&shown);
        if is_update() && untimed(&shown) != untimed(&real) {
            fs::write(root().join(path), &real).unwrap();
        } else {
            assert_same(path, &untimed(&shown), &untimed(&real));
        }
        page
    }

    /// Compares the pictures of the page with those that its commands made. Returns the paths of the pictures that no command made.
    pub(crate) fn check_pictures(&self) -> Vec<PathBuf> {
        let text = fs::read_to_string(root().join(self.path)).unwrap();
        let links = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link);
        let is_picture = |link: &&str| link.ends_with(".png") || link.ends_with(".gif");
        let mut others = Vec::new();
        for link in links.filter(is_picture) {
            let shown = root().join(self.path).with_file_name("").join(link);
            let made = self.folder.path().join(shown.file_name().unwrap());
            if made.exists() {
                assert_same_picture(&made, &shown);
            } else {
                others.push(shown);
            }
        }
        others
    }

    /// Runs the page's commands and returns the page with their real outputs.
    fn real(&self, shown: &str) -> String {
        let mut real = String::new();
        let mut rest = shown;
        while let Some((before, block)) = rest.split_once("```") {
            let (block, after) = block.split_once("\n```").expect("a block ends");
            let (language, text) = block.split_once('\n').expect("a block has lines");
            real.push_str(before);
            let text = match language {
                "toml" => self.write_scene(text),
                "console" => self.run_commands(text),
                _ => text.to_owned(),
            };
            real.push_str(&format!("```{language}\n{}\n```", text.trim_end()));
            rest = after;
        }
        real + rest
    }

    /// Writes all scenes of a page to their files.
    fn write_scenes(&self, page: &str) {
        let blocks = page.split("```toml\n").skip(1).filter_map(|rest| rest.split("\n```").next());
        blocks.for_each(|scene| {
            self.write_scene(scene);
        });
    }

    /// Writes a scene to the file that its first line names, such as `# ball.toml`. Returns the scene's text.
    fn write_scene(&self, text: &str) -> String {
        let name = text.lines().next().and_then(|line| line.strip_prefix("# "));
        fs::write(self.folder.path().join(name.expect("a scene names its file")), text).unwrap();
        text.to_owned()
    }

    /// Runs the commands of a block, and returns the block with their real outputs.
    fn run_commands(&self, block: &str) -> String {
        let bin = Path::new(env!("CARGO_BIN_EXE_jabuka")).parent().unwrap();
        let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
        let commands = block.lines().filter_map(|line| line.strip_prefix("$ "));
        let run = |command: &str| {
            // Use the existing binary: `cargo run` would need the whole project in the folder of the test.
            let short = command.replace("cargo run --release --", "jabuka");
            // `jabuka preview` serves until it is interrupted, so the test interrupts it after a second. It must not open a browser.
            let short = match short.starts_with("jabuka preview") {
                true => format!("timeout --signal=INT 1 {short} --no-open"),
                false => short,
            };
            let output = Command::new("bash")
                .args(["-c", &format!("exec 2>&1; {short}")])
                .current_dir(self.folder.path())
                .env("PATH", &path)
                .env("JABUKA_CACHE_DIR", self.folder.path().join(".cache"))
                .output()
                .unwrap();
            format!("$ {command}\n{}", String::from_utf8(output.stdout).unwrap().trim_end_matches('\n'))
        };
        commands.map(run).map(|text| text.trim_end().to_owned() + "\n").collect()
    }
}

fn is_update() -> bool {
    std::env::var_os("JABUKA_UPDATE_DOCS").is_some()
}

/// Asserts that a picture or film of a page looks like the one that its command made. The encodings of the two files may differ.
fn assert_same_picture(made: &Path, shown: &Path) {
    let (new, old) = (pixels(made), pixels(shown));
    assert!(!new.is_empty(), "{} is no picture", made.display());
    let differs = |(a, b): &(&u8, &u8)| a.abs_diff(**b) > 32;
    let different = new.iter().zip(&old).filter(differs).count();
    // The palette of a GIF or another version of POV-Ray may change a few pixels. A body at another place changes more than 0.1 % of the
    // color values.
    let same = new.len() == old.len() && different * 1000 < new.len();
    if !same && is_update() {
        fs::copy(made, shown).unwrap();
    } else {
        assert!(same, "{} is another picture than the page's command makes: {different}", shown.display());
    }
}

/// Decodes an image or a film with ffmpeg. Returns red, green and blue of every pixel of every frame.
fn pixels(path: &Path) -> Vec<u8> {
    let decode = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-fps_mode", "passthrough", "-"];
    let output =
        Command::new("ffmpeg").args(["-v", "error", "-nostdin", "-i"]).arg(path).args(decode).output();
    output.unwrap().stdout
}

/// Returns the lines of a page without times, network addresses and other parts that differ between runs.
fn untimed(page: &str) -> Vec<&str> {
    page.lines().map(untimed_line).collect()
}

fn untimed_line(line: &str) -> &str {
    const DIFFERENT: [&str; 2] = ["slowest   ", "http://127.0.0.1:"];
    let is_different = |begin: &&str| line.starts_with(begin);
    DIFFERENT.into_iter().find(is_different).unwrap_or_else(|| unclocked(line))
}

/// Returns a line without the seconds at its end: `done in 1.2 s` becomes `done`.
fn unclocked(line: &str) -> &str {
    match str::strip_suffix(line, " s").and_then(|line| line.rsplit_once(" in ")) {
        Some((what, seconds)) if seconds.parse::<f64>().is_ok() => what,
        _ => line,
    }
}

/// Asserts that two versions of a page are equal; the message names the first differing line.
fn assert_same(path: &str, page: &[&str], real: &[&str]) {
    for (i, (line, real)) in page.iter().zip(real).enumerate() {
        assert_eq!(line, real, "{path}, line {}", i + 1);
    }
    assert_eq!(page.len(), real.len(), "the number of lines of {path}");
}
