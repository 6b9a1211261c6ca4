//! Tests of plots that are written as files.

use std::fs;

use crate::support::{jabuka, stderr, stdout};

const SCENE: &str = "simulation.duration = 1\n[body.ball]\nshape.sphere.radius = 0.5
    [plot.energy]\ny = ['kinetic', 'total']\n[plot.now]\nbars = ['ball.speed', 'ball.y']\n";

#[test]
fn a_plot_is_written_as_svg_png_and_pdf() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let export = |words: &[&str]| {
        jabuka().current_dir(folder.path()).args(["export", "scene.toml"]).args(words).output().unwrap()
    };
    for (file, begin, words) in [
        ("e.svg", "<svg ".as_bytes(), "2 curves"),
        ("e.png", b"\x89PNG", "2 curves"),
        ("e.pdf", b"%PDF-1.4", "2 curves"),
    ] {
        let output = export(&["--plot", "energy", "-o", file]);
        assert_eq!(stdout(&output), format!("{file}: {words}\n"), "{}", stderr(&output));
        assert!(fs::read(folder.path().join(file)).unwrap().starts_with(begin), "{file}");
    }
    // The width of an image is that of the option. The eight bytes after those of the first chunk's name are its size.
    assert!(export(&["--plot", "now", "-o", "n.png", "--width", "300"]).status.success());
    let image = fs::read(folder.path().join("n.png")).unwrap();
    assert_eq!(image[16..20], 300_u32.to_be_bytes());
    assert_eq!(fs::read(folder.path().join("e.png")).unwrap()[16..20], 1600_u32.to_be_bytes());
}

#[test]
fn a_plot_that_is_unknown_or_has_another_extension_is_wrong_usage() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    for (plot, file, expected) in [
        ("enrgy", "e.svg", "the scene has no plot `enrgy`: did you mean `energy`?"),
        ("speed", "e.png", "the scene has no plot `speed`: it has `energy`, `now`"),
        (
            "energy",
            "e.glb",
            "`--plot` makes a drawing, `.svg`, or an image, `.png`, or a page, `.pdf`, or a table, `.csv`",
        ),
    ] {
        let words = ["export", "scene.toml", "--plot", plot, "-o", file];
        let output = jabuka().current_dir(folder.path()).args(words).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
        assert!(!folder.path().join(file).exists());
    }
}
