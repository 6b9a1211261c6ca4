//! Tests that `povray animation.ini` in an output folder renders the sequence.

use std::path::Path;

use crate::{povray, support};

/// Compiles a sequence of this number of frames, of which only the frames `written` are written.
fn compile(folder: &Path, frames: usize, written: &str) {
    let last = frames - 1;
    let scene = format!(
        "simulation.duration = {last}\nsimulation.frame_rate = 1\nsimulation.step = 1
[body.ball]\nshape.sphere.radius = 1\nlocation = [1, 2, 3]\n[output]\nsize = [8, 6]\n"
    );
    let path = folder.join("scene.toml");
    std::fs::write(&path, scene).unwrap();
    support::compile(&path, &folder.join("out"), &["--frames", written]);
}

/// Returns the names of the files with this ending, without the ending.
fn stems(folder: &Path, ending: &str) -> Vec<String> {
    let names = support::contents(folder).into_iter().map(|(name, _)| name);
    names.filter_map(|name| name.strip_suffix(ending).map(str::to_owned)).collect()
}

#[test]
fn one_command_renders_all_frames() {
    let folder = tempfile::tempdir().unwrap();
    compile(folder.path(), 5, "0-4");
    let out = folder.path().join("out");
    povray::run(&out, &["animation.ini"]).nothing("animation.ini");
    let expected = ["frame_0000", "frame_0001", "frame_0002", "frame_0003", "frame_0004"];
    assert_eq!(stems(&out, ".png"), expected);
}

/// Checks the names of the images. POV-Ray numbers images by its own rules, and does not number a single frame. The names must match the
/// scripts for any number of digits.
#[test]
fn images_are_named_as_scripts_for_sequences_of_any_length() {
    std::thread::scope(|scope| {
        for frames in [1_usize, 2, 10, 11, 100, 101, 1_000, 1_001, 10_000, 10_001] {
            scope.spawn(move || named_as_scripts(frames));
        }
    });
}

fn named_as_scripts(frames: usize) {
    let folder = tempfile::tempdir().unwrap();
    let (last_but_one, last) = (frames.saturating_sub(2), frames - 1);
    compile(folder.path(), frames, &format!("{last_but_one}-{last}"));
    let out = folder.path().join("out");
    let (from, to) = (format!("+SF{last_but_one}"), format!("+EF{last}"));
    let arguments: &[&str] = if frames > 2 { &["animation.ini", &from, &to] } else { &["animation.ini"] };
    povray::run(&out, arguments).nothing(&format!("a sequence of {frames} frames"));
    let scripts = stems(&out, ".pov").into_iter().filter(|name| name.starts_with("frame_"));
    assert_eq!(stems(&out, ".png"), scripts.collect::<Vec<_>>(), "{frames} frames");
}

/// Checks that a transparent background has alpha 0: a corner of the image is transparent, and the ball in its center is opaque.
#[test]
fn a_transparent_background_is_alpha() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let ball = "simulation.duration = 0\n[body.ball]\nshape.sphere.radius = 1\n";
    std::fs::write(&path, format!("{ball}[output]\nsize = [32, 24]\ntransparent = true\n")).unwrap();
    let out = folder.path().join("out");
    support::compile(&path, &out, &[]);
    povray::run(&out, &["animation.ini"]).nothing("animation.ini");
    let file = std::fs::File::open(out.join("frame_0000.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgba);
    let pixel = info.line_size / 32;
    let alpha = |x: usize, y: usize| bytes[y * info.line_size + x * pixel + pixel / 4 * 3];
    assert_eq!((alpha(0, 0), alpha(16, 12)), (0, 255));
}
