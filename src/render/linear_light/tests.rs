use std::fs::{self, File};

use super::*;

/// Writes a PNG of 2 × 1 pixels, and returns its path.
fn image(folder: &Path, name: &str, color: ColorType, depth: BitDepth, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    let mut encoder = Encoder::new(File::create(&path).unwrap(), 2, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
    path
}

fn opaque(folder: &Path, name: &str, bytes: [u8; 6]) -> PathBuf {
    image(folder, name, ColorType::Rgb, BitDepth::Eight, &bytes)
}

/// Writes a PNG of 2 × 1 pixels with 16 bits per channel and alpha.
fn covering(folder: &Path, name: &str, numbers: [u16; 8]) -> PathBuf {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_be_bytes()).collect();
    image(folder, name, ColorType::Rgba, BitDepth::Sixteen, &bytes)
}

#[test]
fn half_black_and_half_white_is_188_of_255() {
    let folder = tempfile::tempdir().unwrap();
    let black = opaque(folder.path(), "black.png", [0, 0, 0, 10, 20, 30]);
    let white = opaque(folder.path(), "white.png", [255, 255, 255, 10, 20, 30]);
    let mean = mean(&[black, white]).unwrap();
    assert_eq!(mean, Image { width: 2, height: 1, alpha: false, bytes: vec![188, 188, 188, 10, 20, 30] });
}

#[test]
fn the_mean_of_one_is_that_one() {
    let folder = tempfile::tempdir().unwrap();
    for byte in 0..=255 {
        let path = opaque(folder.path(), "one.png", [byte; 6]);
        assert_eq!(mean(&[path]).unwrap().bytes, [byte; 6]);
        let number = u16::from(byte) * 257;
        let path = covering(folder.path(), "two.png", [number, number, number, 65535, 0, 0, 0, 65535]);
        assert_eq!(mean(&[path]).unwrap().bytes, [byte, byte, byte, 255, 0, 0, 0, 255]);
    }
}

#[test]
fn numbers_are_the_nearest_ones() {
    for i in 0..=100_000 {
        let light = f64::from(i) / 100_000.0;
        let srgb =
            if light <= 0.0031308 { 12.92 * light } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 };
        let exact = srgb * 255.0;
        let found = f64::from(number(light as f32));
        assert!((found - exact).abs() < 0.5 + 1e-3, "{light}: {found}, not {exact}");
    }
}

#[test]
fn light_adds_up() {
    let folder = tempfile::tempdir().unwrap();
    let mut paths = Vec::new();
    let mut expected = [0.0; 6];
    // These pseudo-random bytes are the same in every run of the test.
    let mut random = 1u32;
    for i in 0..50 {
        let bytes = [0; 6].map(|_: u8| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 24) as u8
        });
        for (sum, byte) in expected.iter_mut().zip(bytes) {
            *sum += linear(f64::from(byte) / 255.0) / 50.0;
        }
        paths.push(opaque(folder.path(), &format!("{i}.png"), bytes));
    }
    let mean = mean(&paths).unwrap();
    for (byte, expected) in mean.bytes.iter().zip(expected) {
        let light = linear(f64::from(*byte) / 255.0);
        assert!((light / expected - 1.0).abs() < 0.01, "{light}, not {expected}");
    }
}

#[test]
fn a_color_counts_as_much_as_it_covers() {
    let folder = tempfile::tempdir().unwrap();
    const MAX_CHANNEL: u16 = 65535;
    // The first pixel is red in one image of four, so its mean is fully red with a quarter of the opacity. The second pixel is red in two
    // images and green in two, so its mean is half of each. The color of a transparent pixel does not count.
    let red =
        covering(folder.path(), "0.png", [MAX_CHANNEL, 0, 0, MAX_CHANNEL, MAX_CHANNEL, 0, 0, MAX_CHANNEL]);
    let green = covering(folder.path(), "1.png", [0, MAX_CHANNEL, 0, 0, 0, MAX_CHANNEL, 0, MAX_CHANNEL]);
    let mut images = vec![red, green];
    images.push(covering(folder.path(), "2.png", [0, 0, MAX_CHANNEL, 0, MAX_CHANNEL, 0, 0, MAX_CHANNEL]));
    images.push(covering(folder.path(), "3.png", [9, 9, 9, 0, 0, MAX_CHANNEL, 0, MAX_CHANNEL]));
    let mean = mean(&images).unwrap();
    assert_eq!((mean.alpha, mean.bytes), (true, vec![255, 0, 0, 64, 188, 188, 0, 255]));
}

#[test]
fn what_is_no_image_of_the_kind_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let fine = opaque(folder.path(), "fine.png", [1; 6]);
    let gray = image(folder.path(), "gray.png", ColorType::Grayscale, BitDepth::Eight, &[1, 2]);
    let alpha = covering(folder.path(), "alpha.png", [0; 8]);
    let text = folder.path().join("text.png");
    fs::write(&text, "no image").unwrap();
    let short = folder.path().join("short.png");
    let bytes = fs::read(&fine).unwrap();
    fs::write(&short, &bytes[..bytes.len() - 20]).unwrap();
    let dim = folder.path().join("dim.png");
    let mut encoder = Encoder::new(File::create(&dim).unwrap(), 2, 1);
    encoder.set_color(ColorType::Rgb);
    encoder.set_source_gamma(png::ScaledFloat::new(1.0));
    encoder.write_header().unwrap().write_image_data(&[1; 6]).unwrap();

    let said = |path: &PathBuf| mean(&[fine.clone(), path.clone()]).unwrap_err().to_string();
    assert!(said(&gray).contains("its pixels are Grayscale of 8 bits"), "{}", said(&gray));
    assert!(said(&alpha).contains("another size or kind"), "{}", said(&alpha));
    assert!(said(&text).contains("is no image"), "{}", said(&text));
    assert!(said(&short).contains("short.png"), "{}", said(&short));
    assert!(said(&dim).contains("not sRGB"), "{}", said(&dim));
    assert!(said(&folder.path().join("none.png")).contains("none.png`: "));
    assert!(matches!(mean(&[]), Err(ImageError::None)));
}

#[test]
fn what_is_written_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mean.png");
    for (alpha, bytes) in [(false, vec![0, 1, 2, 253, 254, 255]), (true, vec![9, 8, 7, 6, 5, 4, 3, 2])] {
        let image = Image { width: 2, height: 1, alpha, bytes };
        // A temporary file left by a killed process must not prevent writing.
        fs::write(folder.path().join(".jabuka-mean.png.tmp"), "half").unwrap();
        image.write(&path).unwrap();
        let mut reader = Decoder::new(BufReader::new(File::open(&path).unwrap())).read_info().unwrap();
        assert!(reader.info().srgb.is_some());
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        assert_eq!(bytes, image.bytes);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
