//! Tests that the colors of a film are those of its images.

use png::ColorType;

use super::images::{plain, write};
use super::probe::{make, pixels};

#[test]
fn colors_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("image.png");
    let film = |extension: &str| folder.path().join("film").with_extension(extension);
    let colors = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [128; 3], [0; 3], [255; 3], [200, 120, 40]];
    for color in colors {
        plain(&image, (64, 64), color);
        for extension in ["mp4", "webm", "gif"] {
            make(&film(extension), &vec![image.clone(); 2], 25.0);
            for pixel in pixels(&film(extension), "rgb24").chunks(3) {
                let near = pixel.iter().zip(&color).all(|(a, b)| a.abs_diff(*b) <= 3);
                assert!(near, "{extension}: {color:?} came back as {pixel:?}");
            }
        }
    }
}

#[test]
fn images_of_all_kinds_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let image = |name: &str, color, bytes: &[u8]| {
        let path = folder.path().join(name);
        write(&path, (16, 16), color, &bytes.repeat(256));
        path
    };
    let images = [
        image("gray.png", ColorType::Grayscale, &[100]),
        image("gray-alpha.png", ColorType::GrayscaleAlpha, &[100, 255]),
        image("rgb.png", ColorType::Rgb, &[100; 3]),
        image("rgba.png", ColorType::Rgba, &[100, 100, 100, 255]),
    ];
    for extension in ["mp4", "webm", "gif"] {
        let film = folder.path().join("film").with_extension(extension);
        make(&film, &images, 25.0);
        let pixels = pixels(&film, "rgb24");
        assert_eq!(pixels.len(), 4 * 256 * 3);
        assert!(pixels.iter().all(|byte| byte.abs_diff(100) <= 3), "{extension}");
    }
}

#[test]
fn what_is_transparent_is_shown_before_white() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("image.png");
    // Half-transparent black on white leaves half of the light, which is 188 in sRGB.
    for (rgba, expected) in [([0, 0, 0, 0], 255), ([0, 0, 0, 128], 187), ([40, 40, 40, 255], 40)] {
        write(&image, (16, 16), ColorType::Rgba, &rgba.repeat(256));
        for extension in ["mp4", "webm"] {
            let film = folder.path().join("film").with_extension(extension);
            make(&film, std::slice::from_ref(&image), 25.0);
            let pixels = pixels(&film, "rgb24");
            assert!(pixels.iter().all(|byte| byte.abs_diff(expected) <= 3), "{rgba:?} {}", pixels[0]);
        }
    }
}
