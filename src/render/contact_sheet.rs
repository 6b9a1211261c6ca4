//! Draws a contact sheet: one page that shows some images of a film, evenly spaced in time.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use resize::px::RGB;

use super::FilmError;
use super::film::Target;
use super::picture::{self, Picture, Size, light, srgb};

type Rgb = [u8; 3];

/// The margin around the page's contents, pixels.
const PAGE_MARGIN: usize = 32;
/// The gap between two images, pixels.
const IMAGE_GAP: usize = 24;
/// The vertical gap between an image and its caption, pixels.
const ABOVE_CAPTION: usize = 8;
/// The largest area of an image on the sheet, in square pixels: that of 480 × 270. Smaller images are not enlarged.
const MAX_IMAGE_AREA: f64 = 480.0 * 270.0;
/// The preferred ratio of width to height of a sheet.
const PREFERRED_ASPECT_RATIO: f64 = 16.0 / 9.0;

/// The color of the page.
const BACKGROUND_COLOR: Rgb = [247, 246, 243];
/// The color of the borders of images.
const BORDER_COLOR: Rgb = [214, 211, 204];
/// The color of the left part of a caption, which is the number of the frame.
const TEXT_COLOR: Rgb = [52, 50, 46];
/// The color of the right part of a caption, which is the time.
const FAINT_TEXT_COLOR: Rgb = [122, 118, 110];

/// An image of a film that a contact sheet may show.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// The path of the image.
    pub image: PathBuf,
    /// The number of the frame that the image shows.
    pub frame: usize,
    /// The simulated time that the image shows, s.
    pub time: f64,
}

/// A contact sheet to make: its path, and its largest number of images.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ContactSheet {
    path: PathBuf,
    most: usize,
}

impl ContactSheet {
    /// The largest number of images on a sheet, unless the user gives another.
    pub const DEFAULT_MAX_IMAGES: usize = 12;

    /// Plans a contact sheet with this path.
    ///
    /// # Errors
    /// If the path does not end in `.png`, or is that of a folder.
    pub fn new(path: impl Into<PathBuf>) -> Result<ContactSheet, FilmError> {
        let path = path.into();
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            return Err(FilmError::SheetName(path));
        }
        if path.is_dir() {
            return Err(FilmError::Folder(path));
        }
        Ok(ContactSheet { path, most: ContactSheet::DEFAULT_MAX_IMAGES })
    }

    /// Limits the number of images on the sheet. The limit is at least 1.
    #[must_use]
    pub fn of_at_most(self, images: usize) -> ContactSheet {
        ContactSheet { most: images.max(1), ..self }
    }

    /// Returns the path of the sheet.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Checks that the sheet can be written to its path. Creates the parent folder if needed.
    ///
    /// # Errors
    /// If no file can be written to this path, or another process writes the same file.
    pub fn check_place(&self) -> Result<(), FilmError> {
        Target::create(&self.path).map(drop)
    }

    /// Makes the sheet from some of the given images: the first, the last, and evenly spaced ones between them. Transparent pixels are
    /// shown on white. An existing sheet is replaced only when the new one is complete.
    ///
    /// # Errors
    /// If one of the shown images cannot be read or differs in size, or the sheet cannot be written.
    pub fn make(&self, shots: &[Shot]) -> Result<(), FilmError> {
        let chosen: Vec<&Shot> = evenly(shots.len(), self.most).into_iter().map(|i| &shots[i]).collect();
        let size = picture::common_size(chosen.iter().map(|shot| &shot.image))?;
        let target = Target::create(&self.path)?;
        let captions = captions(&chosen);
        let layout = Layout::new(chosen.len(), size, &captions);
        let images: Vec<Vec<u8>> =
            chosen.par_iter().map(|shot| scaled_down(&shot.image, layout.image)).collect::<Result<_, _>>()?;
        let mut page = Page::new(layout.page);
        for (index, (image, [left, right])) in images.iter().zip(&captions).enumerate() {
            let (x, y) = layout.place(index);
            let (width, height) = layout.image;
            page.frame((x - 1, y - 1), (width + 2, height + 2), BORDER_COLOR);
            page.put(image, (x, y), width);
            let base = y + height + ABOVE_CAPTION;
            page.write(left, (x, base), layout.letters, TEXT_COLOR);
            let end = x + layout.cell.0;
            page.write(
                right,
                (end - text_width(right, layout.letters), base),
                layout.letters,
                FAINT_TEXT_COLOR,
            );
        }
        page.save(&target)?;
        target.finish()
    }
}

/// Returns the indices of at most `most` of `count` items: the first, the last, and evenly spaced ones between them.
pub(super) fn evenly(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    let last = most.saturating_sub(1).max(1);
    (0..most).map(|i| (i * (count - 1) + last / 2) / last).collect()
}

/// The sizes and positions on a contact sheet, pixels.
struct Layout {
    page: Size,
    columns: usize,
    /// The size of an image on the sheet, without its caption.
    image: Size,
    /// The size of an image together with its caption.
    cell: Size,
    letters: RasterHeight,
}

impl Layout {
    fn new(count: usize, (width, height): Size, captions: &[[String; 2]]) -> Layout {
        let scale = (MAX_IMAGE_AREA / (width as f64 * height as f64)).sqrt().min(1.0);
        let image = [width, height].map(|length| ((length as f64 * scale).round() as usize).max(1));
        let needed = |letters| {
            let space = get_raster_width(FontWeight::Regular, letters);
            let width =
                |[left, right]: &[String; 2]| text_width(left, letters) + text_width(right, letters) + space;
            captions.iter().map(width).max().unwrap_or(0)
        };
        let large = RasterHeight::Size20;
        let letters = if needed(large) <= image[0] { large } else { RasterHeight::Size16 };
        let cell = (image[0].max(needed(letters)), image[1] + ABOVE_CAPTION + letters.val());
        let columns = columns(count, cell);
        let rows = count.div_ceil(columns);
        let page = (
            2 * PAGE_MARGIN + columns * (cell.0 + IMAGE_GAP) - IMAGE_GAP,
            // The height of a line of text includes empty space below the letters, so a slightly smaller margin looks even.
            2 * PAGE_MARGIN + rows * (cell.1 + IMAGE_GAP) - IMAGE_GAP - letters.val() / 4,
        );
        Layout { page, columns, image: (image[0], image[1]), cell, letters }
    }

    /// Returns the upper left corner of the image with this index, pixels.
    fn place(&self, index: usize) -> (usize, usize) {
        let (column, row) = (index % self.columns, index / self.columns);
        (PAGE_MARGIN + column * (self.cell.0 + IMAGE_GAP), PAGE_MARGIN + row * (self.cell.1 + IMAGE_GAP))
    }
}

/// Returns the number of columns that gives the page a shape near [`PREFERRED_ASPECT_RATIO`] with few empty cells.
fn columns(count: usize, (width, height): Size) -> usize {
    let badness = |columns: usize| {
        let rows = count.div_ceil(columns);
        let shape = (columns * (width + IMAGE_GAP)) as f64 / (rows * (height + IMAGE_GAP)) as f64;
        let empty = (columns * rows - count) as f64 / (columns * rows) as f64;
        libm::log(shape / PREFERRED_ASPECT_RATIO).abs() + 2.0 * empty
    };
    (1..=count).min_by(|a, b| badness(*a).total_cmp(&badness(*b))).unwrap_or(1)
}

/// Returns the captions under the images: the number of the frame, and its time. The times have enough digits to distinguish neighboring
/// images.
fn captions(shots: &[&Shot]) -> Vec<[String; 2]> {
    let gaps = shots.windows(2).map(|pair| (pair[1].time - pair[0].time).abs()).filter(|gap| *gap > 0.0);
    let largest = shots.iter().map(|shot| shot.time.abs()).fold(0.0, f64::max);
    let tolerance = gaps.fold(largest, f64::min) / 100.0;
    let error = |text: &str, time: f64| (text.parse().unwrap_or(f64::INFINITY) - time).abs();
    let plain = |digits: usize| shots.iter().map(move |shot| format!("{:.digits$}", shot.time));
    let is_enough =
        |digits: &usize| plain(*digits).zip(shots).all(|(text, shot)| error(&text, shot.time) <= tolerance);
    let times: Vec<String> = match (0..=6).find(is_enough) {
        Some(digits) if plain(digits).all(|text| text.len() <= 9) => plain(digits).collect(),
        // Very long or very short times, such as those of planets and atoms, are in scientific notation.
        _ => shots.iter().map(|shot| scientific(shot.time)).collect(),
    };
    shots
        .iter()
        .zip(times)
        .map(|(shot, time)| [format!("frame {}", shot.frame), format!("t = {time} s")])
        .collect()
}

fn scientific(time: f64) -> String {
    if time == 0.0 { "0".to_owned() } else { format!("{time:.3e}") }
}

/// Reads an image and scales it down to this size. Returns its pixels, three bytes each. Averages are taken in linear light, since a mean
/// of sRGB bytes would darken fine details.
fn scaled_down(path: &Path, (width, height): Size) -> Result<Vec<u8>, FilmError> {
    let picture = Picture::read(path)?;
    let (from_width, from_height) = picture.size;
    let bytes = picture.over_white();
    if (from_width, from_height) == (width, height) {
        return Ok(bytes);
    }
    let from: Vec<RGB<f32>> =
        bytes.chunks_exact(3).map(|p| RGB::new(light(p[0]), light(p[1]), light(p[2]))).collect();
    let mut to = vec![RGB::new(0.0, 0.0, 0.0); width * height];
    // The Catmull–Rom filter is sharp without much ringing. It is a polynomial, so it gives the same bits on every platform.
    let filter = resize::Type::Catrom;
    resize::new(from_width, from_height, width, height, resize::Pixel::RGBF32, filter)
        .and_then(|mut resizer| resizer.resize(&from, &mut to))
        .map_err(|error| FilmError::Image(path.to_owned(), format!("it cannot be made smaller: {error}")))?;
    Ok(to.iter().flat_map(|p| [srgb(p.r), srgb(p.g), srgb(p.b)]).collect())
}

fn text_width(text: &str, letters: RasterHeight) -> usize {
    text.chars().count() * get_raster_width(FontWeight::Regular, letters)
}

/// The page of a contact sheet as pixels, three bytes each.
struct Page {
    size: Size,
    rgb: Vec<u8>,
}

impl Page {
    fn new(size: Size) -> Page {
        Page { size, rgb: BACKGROUND_COLOR.repeat(size.0 * size.1) }
    }

    fn pixel(&mut self, (x, y): (usize, usize)) -> &mut [u8] {
        let start = 3 * (y * self.size.0 + x);
        &mut self.rgb[start..start + 3]
    }

    /// Draws the outline of a rectangle.
    fn frame(&mut self, (left, top): (usize, usize), (width, height): Size, color: Rgb) {
        for x in left..left + width {
            self.pixel((x, top)).copy_from_slice(&color);
            self.pixel((x, top + height - 1)).copy_from_slice(&color);
        }
        for y in top..top + height {
            self.pixel((left, y)).copy_from_slice(&color);
            self.pixel((left + width - 1, y)).copy_from_slice(&color);
        }
    }

    /// Copies an image of this width onto the page. `(x, y)` is its upper left corner.
    fn put(&mut self, image: &[u8], (x, y): (usize, usize), width: usize) {
        for (row, bytes) in image.chunks_exact(3 * width).enumerate() {
            let start = 3 * ((y + row) * self.size.0 + x);
            self.rgb[start..start + 3 * width].copy_from_slice(bytes);
        }
    }

    /// Writes a line of ASCII text. `(x, y)` is its upper left corner.
    fn write(&mut self, text: &str, (x, y): (usize, usize), letters: RasterHeight, ink: Rgb) {
        let advance = get_raster_width(FontWeight::Regular, letters);
        let glyphs = text.chars().map(|c| get_raster(c, FontWeight::Regular, letters));
        for (index, glyph) in glyphs.enumerate() {
            let Some(glyph) = glyph else { continue };
            for (row, line) in glyph.rows().enumerate() {
                for (column, part) in line.iter().enumerate() {
                    let place = (x + index * advance + column, y + row);
                    for (byte, ink) in self.pixel(place).iter_mut().zip(ink) {
                        // The letters are designed for blending sRGB bytes. Blended in linear light, they would be too thin.
                        let (ground, ink, part) = (u32::from(*byte), u32::from(ink), u32::from(*part));
                        *byte = ((ground * (255 - part) + ink * part + 127) / 255) as u8;
                    }
                }
            }
        }
    }

    fn save(&self, target: &Target) -> Result<(), FilmError> {
        let (width, height) = self.size;
        // The page is first encoded in memory, which cannot fail, so that any error comes from the disk.
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let encoded = encoder.write_header().and_then(|mut writer| {
            writer.write_image_data(&self.rgb)?;
            writer.finish()
        });
        let written = encoded.map_err(io::Error::from).and_then(|()| target.file().write_all(&bytes));
        written.map_err(FilmError::io(target.path()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_and_the_last_are_among_the_chosen() {
        assert_eq!(evenly(251, 12), [0, 23, 45, 68, 91, 114, 136, 159, 182, 205, 227, 250]);
        assert_eq!(evenly(3, 12), [0, 1, 2]);
        assert_eq!(evenly(13, 12).len(), 12);
        assert_eq!(evenly(100, 2), [0, 99]);
        assert_eq!(evenly(100, 1), [0]);
        assert_eq!(evenly(0, 12), [0; 0]);
    }

    #[test]
    fn the_grid_suits_the_images() {
        let wide = (480, 298);
        assert_eq!([1, 2, 4, 6, 9, 12, 20].map(|count| columns(count, wide)), [1, 2, 2, 3, 3, 4, 5]);
        assert_eq!(columns(12, (360, 388)), 4);
        assert_eq!(columns(12, (270, 508)), 6);
    }

    #[test]
    fn times_have_the_digits_that_tell_them_apart() {
        let times = |times: &[f64]| -> Vec<String> {
            let shots: Vec<Shot> =
                times.iter().map(|time| Shot { image: PathBuf::new(), frame: 7, time: *time }).collect();
            captions(&shots.iter().collect::<Vec<_>>()).into_iter().map(|[_, time]| time).collect()
        };
        assert_eq!(times(&[0.0, 1.0, 2.0]), ["t = 0 s", "t = 1 s", "t = 2 s"]);
        assert_eq!(times(&[0.0, 0.04]), ["t = 0.00 s", "t = 0.04 s"]);
        assert_eq!(times(&[0.0, 1.0 / 24.0]), ["t = 0.000 s", "t = 0.042 s"]);
        assert_eq!(times(&[0.0, 2.4e-16]), ["t = 0 s", "t = 2.400e-16 s"]);
        assert_eq!(times(&[9.0e8]), ["t = 900000000 s"]);
        assert_eq!(times(&[3.5]), ["t = 3.5 s"], "one alone");
    }
}
