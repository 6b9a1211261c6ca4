//! Test of the preview's picture in the README.

use std::fs;
use std::path::Path;

use crate::server::Scene;
use crate::support::root;

/// Checks that the picture shows the present page. With `JABUKA_UPDATE_DOCS` set, a new picture replaces it.
#[test]
fn the_picture_of_the_readme_is_of_this_page() {
    let server = Scene::gallery("damped_spring").served();
    server.shows("screenshot.mjs", "the_picture_of_the_readme_is_of_this_page");
    let (made, shown) = (server.scene.folder().join("preview.png"), root().join("docs/preview.png"));
    let (new, old) = (pixels(&made), pixels(&shown));
    let different = new.1.iter().zip(&old.1).filter(|(a, b)| a.abs_diff(**b) > 32).count();
    // Fonts differ between machines, so some pixels may differ, but not the layout.
    let same = new.0 == old.0 && different * 30 < new.1.len();
    if !same && std::env::var_os("JABUKA_UPDATE_DOCS").is_some() {
        fs::copy(made, shown).unwrap();
    } else {
        assert!(same, "{} is another picture than that of the page: {different}", shown.display());
    }
}

/// Returns the size and the bytes of an image; empty if there is no file.
fn pixels(path: &Path) -> ((u32, u32), Vec<u8>) {
    let Ok(file) = fs::File::open(path) else { return ((0, 0), Vec::new()) };
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    ((info.width, info.height), bytes)
}
