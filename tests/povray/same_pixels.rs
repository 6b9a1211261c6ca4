//! Tests that the pixels of a frame depend only on its script.

use crate::image::Image;
use crate::{povray, support};

/// The options of `animation.ini`, except for the size.
const LIKE_THE_SEQUENCE: [&str; 3] = ["+A0.1", "+AM1", "+R3"];

#[test]
fn a_frame_is_the_same_alone_and_in_its_sequence() {
    let folder = tempfile::tempdir().unwrap();
    support::compile(&support::scene("parabola"), folder.path(), &["--frames", "50-52"]);
    povray::run(folder.path(), &["animation.ini", "+SF50", "+EF52", "+W160", "+H90"]).nothing("the sequence");
    let mut frames = Vec::new();
    for number in [50, 52] {
        let name = format!("frame_{number:04}");
        let script = std::fs::read_to_string(folder.path().join(&name).with_extension("pov")).unwrap();
        let alone = povray::render_with(&script, [160, 90], &LIKE_THE_SEQUENCE);
        let in_sequence = Image::read(&folder.path().join(&name).with_extension("png"));
        assert!(alone == in_sequence, "{name} differs");
        frames.push(alone);
    }
    assert!(frames[0] != frames[1], "the frames show different moments");
}

#[test]
fn the_number_of_threads_changes_no_pixel() {
    let folder = tempfile::tempdir().unwrap();
    support::compile(&support::scene("tumbling_box"), folder.path(), &["--frames", "30"]);
    let script = std::fs::read_to_string(folder.path().join("frame_0030.pov")).unwrap();
    let with = |threads| {
        let arguments = [&LIKE_THE_SEQUENCE[..], &[threads]].concat();
        povray::render_with(&script, [160, 90], &arguments)
    };
    assert!(with("+WT1") == with("+WT2"));
}
