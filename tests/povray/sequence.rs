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

/// Returns the sorted names of the files with this ending, without the ending.
fn stems(folder: &Path, ending: &str) -> Vec<String> {
    let names =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut stems: Vec<String> =
        names.filter_map(|name| Some(name.strip_suffix(ending)?.to_owned())).collect();
    stems.sort_unstable();
    stems
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

/// A scene of 12 frames, with a view and motion blur.
const FULL: &str = "
    [simulation]
    duration = 1.1
    frame_rate = 10
    [output]
    size = [16, 12]
    [camera]
    shutter = 0.05
    samples = 2
    [view.side]
    location = [20, 0, 0]
    look_at = [0, 0, 0]
    [body.ball]
    shape.sphere.radius = 1
    velocity = [1, 0, 0]
    ";

/// Renders a folder with nothing but POV-Ray, and returns the numbers of the images.
fn rendered(folder: &Path) -> Vec<usize> {
    povray::run(folder, &["animation.ini"]).nothing(&folder.display().to_string());
    let number = |name: String| {
        let digits = name.strip_prefix("frame_").unwrap();
        assert_eq!(digits.len(), 4, "{name}");
        digits.parse().unwrap()
    };
    stems(folder, ".png").into_iter().map(number).collect()
}

/// Checks that bare POV-Ray renders the frames that have scripts, and no others: of selections, of every n-th frame, with shared scripts and
/// complete ones, of views, with motion blur, and of job folders.
#[test]
fn the_frames_that_have_scripts_are_rendered_and_no_others() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    std::fs::write(path("scene.toml"), FULL).unwrap();
    let jabuka = |arguments: &[&str]| {
        let output = support::jabuka().current_dir(place.path()).args(arguments).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {}", support::stderr(&output));
    };
    let compile = |name: &str, arguments: &[&str], expected: &[usize]| {
        jabuka(&[&["compile", "scene.toml", "-o", name][..], arguments].concat());
        assert_eq!(rendered(&path(name)), expected, "{name}");
    };
    std::thread::scope(|scope| {
        scope.spawn(|| {
            compile("range", &["--frames", "5-8"], &[5, 6, 7, 8]);
            // Another selection of the same scene joins the scripts that are there.
            compile("range", &["--frames", "9"], &[5, 6, 7, 8, 9]);
        });
        scope.spawn(|| compile("steps", &["--frames", "1,6,11"], &[1, 6, 11]));
        scope.spawn(|| compile("one", &["--frames", "3"], &[3]));
        scope.spawn(|| compile("first", &["--frames", "0"], &[0]));
        scope.spawn(|| compile("shared", &["--frames", "5-6", "--set", "output.layout=shared"], &[5, 6]));
        scope.spawn(|| {
            compile("whole", &["--frames", "10-11", "--set", "output.layout=self-contained"], &[10, 11]);
        });
        scope.spawn(|| {
            jabuka(&["compile", "scene.toml", "-o", "seen", "--frames", "2-3", "--view", "all"]);
            assert_eq!(rendered(&path("seen-side")), [2, 3]);
        });
        scope.spawn(|| {
            jabuka(&["batch", "scene.toml", "--engine", "slurm", "-o", "job", "--frames", "4-6"]);
            assert_eq!(rendered(&path("job/scripts")), [4, 5, 6]);
        });
        scope.spawn(|| {
            jabuka(&["still", "scene.toml", "-t", "0.75", "-o", "still.png"]);
            assert_eq!(rendered(&path("out/.still/scene")), [7]);
        });
        scope.spawn(|| {
            jabuka(&["render", "scene.toml", "--every", "5"]);
            assert_eq!(rendered(&path("out/scene")), [0, 5, 10]);
        });
    });
}

/// Checks that frames at unequal distances are all rendered. POV-Ray cannot skip the frames between them, so their images say what they are.
#[test]
fn frames_at_unequal_distances_are_rendered_too() {
    let folder = tempfile::tempdir().unwrap();
    compile(folder.path(), 9, "0,4,6");
    assert_eq!(rendered(&folder.path().join("out")), [0, 2, 4, 6]);
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
