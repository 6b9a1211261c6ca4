//! Makes images for films.

use std::fs::File;
use std::path::{Path, PathBuf};

use png::{BitDepth, ColorType, Encoder};

/// Writes a PNG with 8 bits per channel.
pub(crate) fn write(path: &Path, (width, height): (u32, u32), color: ColorType, bytes: &[u8]) {
    let mut encoder = Encoder::new(File::create(path).unwrap(), width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
}

/// Writes a PNG of one color.
pub(crate) fn plain(path: &Path, size: (u32, u32), rgb: [u8; 3]) {
    write(path, size, ColorType::Rgb, &rgb.repeat((size.0 * size.1) as usize));
}

/// Writes a sequence of images that all differ: a bright square moves over a color gradient. Returns their paths.
pub(crate) fn sequence(folder: &Path, count: usize, (width, height): (u32, u32)) -> Vec<PathBuf> {
    let image = |index: usize| {
        let path = folder.join(format!("any name % {index}.png"));
        let left = index as u32 * 3 % width;
        let pixel = |i: u32| {
            let (x, y) = (i % width, i / width);
            let inside = x.wrapping_sub(left) < 8 && y < 8;
            if inside { [250, 240, 30] } else { [(x * 255 / width) as u8, (y * 255 / height) as u8, 90] }
        };
        let bytes: Vec<u8> = (0..width * height).flat_map(pixel).collect();
        write(&path, (width, height), ColorType::Rgb, &bytes);
        path
    };
    (0..count).map(image).collect()
}
