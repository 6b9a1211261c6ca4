//! Tests that contact sheets show the right images in their colors.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use jabuka::render::{ContactSheet, FilmError, Shot};

use super::images::plain;

/// Writes images of one color each, whose red value is the frame's number. Returns them as the shots of a contact sheet.
fn shots(folder: &Path, count: usize, size: (u32, u32)) -> Vec<Shot> {
    let shot = |frame: usize| {
        let image = folder.join(format!("{frame}.png"));
        plain(&image, size, [frame as u8, 160, 40]);
        Shot { image, frame, time: frame as f64 / 25.0 }
    };
    (0..count).map(shot).collect()
}

/// Returns the width and the bytes of an image.
fn read(path: &Path) -> (usize, Vec<u8>) {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width as usize, bytes)
}

#[test]
fn twelve_evenly_spaced_images_stand_in_four_columns() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = ContactSheet::new(folder.path().join("sheet.png")).unwrap();
    sheet.make(&shots(folder.path(), 111, (960, 540))).unwrap();
    let (width, bytes) = read(sheet.path());
    assert_eq!(
        (width, bytes.len() / 3 / width),
        (2 * 32 + 4 * 480 + 3 * 24, 2 * 32 + 3 * (270 + 28) + 2 * 24 - 5)
    );
    for index in 0..12 {
        let (x, y) = (32 + index % 4 * 504 + 240, 32 + index / 4 * 322 + 135);
        let pixel = &bytes[3 * (y * width + x)..][..3];
        assert_eq!(pixel, [10 * index as u8, 160, 40], "image {index}");
    }
    // The caption below the last image has dark pixels, the margin has none.
    let is_dark =
        |from: usize, to: usize| bytes[3 * width * from..3 * width * to].iter().any(|byte| *byte < 60);
    let bottom = bytes.len() / 3 / width;
    assert!(is_dark(bottom - 27 - 20, bottom - 27) && !is_dark(bottom - 24, bottom));
}

#[test]
fn what_is_fine_keeps_its_light() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("checks.png");
    let pixel = |i: usize| if (i % 960 + i / 960).is_multiple_of(2) { [255; 3] } else { [60; 3] };
    let bytes: Vec<u8> = (0..960 * 540).flat_map(pixel).collect();
    super::images::write(&image, (960, 540), png::ColorType::Rgb, &bytes);
    let sheet = ContactSheet::new(folder.path().join("sheet.png")).unwrap();
    sheet.make(&[Shot { image, frame: 0, time: 0.0 }]).unwrap();
    let (width, bytes) = read(sheet.path());
    let middle = bytes[3 * (150 * width + 200)];
    assert!(middle.abs_diff(191) <= 1, "the mean of their light is 191 in sRGB, not {middle}");
}

#[test]
fn few_small_or_narrow_images_make_a_sheet_too() {
    let folder = tempfile::tempdir().unwrap();
    for (count, size) in [(1, (1, 1)), (5, (40, 30)), (7, (3, 900)), (2, (2000, 10))] {
        let sheet = ContactSheet::new(folder.path().join("sheet.png")).unwrap().of_at_most(6);
        sheet.make(&shots(folder.path(), count, size)).unwrap();
    }
}

#[test]
fn mistakes_are_told_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let error = ContactSheet::new("sheet.jpg").unwrap_err().to_string();
    assert_eq!(error, "the name of a contact sheet ends in `.png`, and `sheet.jpg` does not");
    let sheet = ContactSheet::new(folder.path().join("sheet.png")).unwrap();
    fs::write(sheet.path(), "yesterday's").unwrap();
    assert!(matches!(sheet.make(&[]), Err(FilmError::NoImages)));
    let mut shots = shots(folder.path(), 3, (64, 48));
    fs::write(&shots[1].image, &fs::read(&shots[1].image).unwrap()[..60]).unwrap();
    assert!(matches!(sheet.make(&shots), Err(FilmError::Image(path, _)) if path == shots[1].image));
    plain(&shots[1].image, (64, 50), [0; 3]);
    assert!(matches!(sheet.make(&shots), Err(FilmError::Sizes { .. })));
    shots.remove(1);
    assert_eq!(fs::read_to_string(sheet.path()).unwrap(), "yesterday's");
    sheet.make(&shots).unwrap();
    let left = fs::read_dir(folder.path())
        .unwrap()
        .filter(|entry| entry.as_ref().unwrap().file_name().to_string_lossy().starts_with('.'));
    assert_eq!(left.count(), 0);
}
