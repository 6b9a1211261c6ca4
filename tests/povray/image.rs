//! Reads the images that POV-Ray writes, and measures them.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use glam::DVec2;

/// An RGB image with one byte per channel.
#[derive(PartialEq)]
pub(crate) struct Image {
    pub(crate) width: usize,
    pub(crate) height: usize,
    bytes: Vec<u8>,
}

/// The red, green and blue of a pixel, 0 to 255.
pub(crate) type Rgb = [u8; 3];

impl Image {
    /// Reads a PNG image of 8 bits per channel.
    pub(crate) fn read(path: &Path) -> Image {
        let file = File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut reader = png::Decoder::new(BufReader::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
        Image { width: info.width as usize, height: info.height as usize, bytes }
    }

    /// Returns all pixels, row by row from the upper left.
    pub(crate) fn pixels(&self) -> impl Iterator<Item = Rgb> {
        self.bytes.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]])
    }

    /// Returns the pixel at a position, in pixels from the upper left corner.
    pub(crate) fn at(&self, place: DVec2) -> Rgb {
        let inside = place.x >= 0.0 && place.y >= 0.0;
        let (x, y) = (place.x as usize, place.y as usize);
        assert!(inside && x < self.width && y < self.height, "{place} is outside of the image");
        self.pixels().nth(y * self.width + x).unwrap()
    }

    /// Returns the mean brightness, 0 to 255.
    pub(crate) fn brightness(&self) -> f64 {
        self.bytes.iter().map(|&byte| f64::from(byte)).sum::<f64>() / self.bytes.len() as f64
    }

    /// Returns the mean difference from an image of the same size, 0 to 255.
    pub(crate) fn difference(&self, other: &Image) -> f64 {
        assert_eq!((self.width, self.height), (other.width, other.height));
        let difference = |(a, b): (&u8, &u8)| f64::from(a.abs_diff(*b));
        self.bytes.iter().zip(&other.bytes).map(difference).sum::<f64>() / self.bytes.len() as f64
    }

    /// Returns the centers of the pixels whose color satisfies a condition.
    pub(crate) fn spot(&self, is_wanted: impl Fn(Rgb) -> bool) -> Spot {
        let middle = |i: usize| DVec2::new((i % self.width) as f64 + 0.5, (i / self.width) as f64 + 0.5);
        Spot(self.pixels().enumerate().filter(|(_, rgb)| is_wanted(*rgb)).map(|(i, _)| middle(i)).collect())
    }
}

/// A set of pixels of an image, given by their centers in pixels from the upper left corner.
pub(crate) struct Spot(pub(crate) Vec<DVec2>);

impl Spot {
    /// Returns the centroid of the pixels.
    pub(crate) fn middle(&self) -> DVec2 {
        assert!(!self.0.is_empty(), "there is no such pixel");
        self.0.iter().sum::<DVec2>() / self.0.len() as f64
    }

    /// Returns the number of pixels.
    pub(crate) fn area(&self) -> f64 {
        self.0.len() as f64
    }
}

/// Returns true if a color is mostly red.
pub(crate) fn is_red([r, g, b]: Rgb) -> bool {
    f64::from(r) > 1.4 * f64::from(g.max(b)) && r > 40
}

/// Returns true if a color is mostly green.
pub(crate) fn is_green([r, g, b]: Rgb) -> bool {
    is_red([g, r, b])
}

/// Returns true if a color is mostly blue.
pub(crate) fn is_blue([r, g, b]: Rgb) -> bool {
    is_red([b, r, g])
}

/// Returns the brightness of a color, 0 to 255.
pub(crate) fn brightness(rgb: Rgb) -> f64 {
    rgb.map(f64::from).iter().sum::<f64>() / 3.0
}
