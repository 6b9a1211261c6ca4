//! The two layouts give the same pictures.

use std::fs;

use crate::image::Image;
use crate::povray;
use crate::support::{compile, scene};

#[test]
fn a_shared_part_changes_no_pixel() {
    let images = ["self-contained", "shared"].map(|layout| {
        let folder = tempfile::tempdir().unwrap();
        let set = format!("output.layout={layout}");
        compile(&scene("tumbling_box"), folder.path(), &["--frames", "176", "--set", &set]);
        assert_eq!(folder.path().join("common.inc").exists(), layout == "shared");
        let arguments = ["+Iframe_0176.pov", "+Oimage.png", "+W160", "+H90"];
        povray::run(folder.path(), &arguments).nothing(layout);
        let image = Image::read(&folder.path().join("image.png"));
        fs::remove_dir_all(folder.path()).unwrap();
        image
    });
    assert_eq!(images[0].difference(&images[1]), 0.0);
}
