//! Draws lines and areas into an image, with smooth edges.

use crate::font::Step;
use crate::svg::Rgb;

/// The number of straight lines that replace a curve of a letter.
const LINES_OF_CURVE: u32 = 6;

/// An image that is being drawn. Positions are in pixels, from its upper left corner.
pub(crate) struct Canvas {
    pub(crate) width: usize,
    pub(crate) height: usize,
    rgb: Vec<u8>,
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "places are within some thousand pixels"
)]
impl Canvas {
    /// Returns an image of one color.
    pub(crate) fn new(width: usize, height: usize, background: Rgb) -> Canvas {
        Canvas { width, height, rgb: background.repeat(width * height) }
    }

    /// Returns the image as the bytes of a PNG file.
    ///
    /// # Errors
    /// If the image cannot be encoded.
    pub(crate) fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        writer.finish()?;
        Ok(bytes)
    }

    /// Blends a color into the pixel in a column and a row. `part` is the opacity of the color, 0 to 255.
    pub(crate) fn blend(&mut self, column: usize, row: usize, color: Rgb, part: u8) {
        let start = 3 * (row * self.width + column);
        if let Some(pixel) = self.rgb.get_mut(start..).and_then(<[u8]>::first_chunk_mut::<3>) {
            mix(pixel, color, part);
        }
    }

    /// Draws a level or upright line, as whole pixels.
    pub(crate) fn rule(&mut self, [one, other]: [[f64; 2]; 2], width: f64, color: Rgb) {
        let width = libm::round(width).max(1.0);
        let onto_pixels = |place: f64| libm::floor(place - width / 2.0 + 0.5);
        let along = usize::from(one[0] == other[0]);
        let mut corners = [one, other];
        corners.sort_by(|one, other| one[along].total_cmp(&other[along]));
        let across = 1 - along;
        let (first, last) = (onto_pixels(one[across]), onto_pixels(one[across]) + width);
        let [begin, end] = corners.map(|corner| corner[along]);
        let (begin, end) = (onto_pixels(begin), onto_pixels(end) + width);
        let corner = |on: f64, beside: f64| if along == 0 { [on, beside] } else { [beside, on] };
        self.area(
            &[vec![corner(begin, first), corner(end, first), corner(end, last), corner(begin, last)]],
            color,
        );
    }

    /// Fills the outlines of letters.
    pub(crate) fn letters(&mut self, steps: &[Step], color: Rgb) {
        let mut areas: Vec<Vec<[f64; 2]>> = Vec::new();
        for step in steps {
            match (*step, areas.last_mut()) {
                (Step::Move(to), _) => areas.push(vec![to]),
                (_, None) => {}
                (Step::Line(to), Some(area)) => area.push(to),
                (Step::Curve { control, to }, Some(area)) => {
                    let from = area.last().copied().unwrap_or(to);
                    area.extend((1..=LINES_OF_CURVE).map(|number| {
                        let part = f64::from(number) / f64::from(LINES_OF_CURVE);
                        let mixed = |one: f64, other: f64| one + part * (other - one);
                        [0, 1].map(|k| mixed(mixed(from[k], control[k]), mixed(control[k], to[k])))
                    }));
                }
            }
        }
        self.area(&areas, color);
    }

    /// Fills the inside of closed lines. The opacity of a pixel is the part of it that they cover: each edge adds the signed area to its right, and
    /// the sum along a row is the covered part.
    pub(crate) fn area(&mut self, areas: &[Vec<[f64; 2]>], color: Rgb) {
        let points = || areas.iter().flatten();
        let bound = |axis: usize, size: usize| {
            let (min, max) =
                points().fold((f64::MAX, f64::MIN), |(min, max), at| (min.min(at[axis]), max.max(at[axis])));
            let begin = (min.max(0.0) as usize).min(size);
            begin..(max.max(0.0).ceil() as usize).clamp(begin, size)
        };
        let (columns, rows) = (bound(0, self.width), bound(1, self.height));
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        // One column more, for what an edge in the last column leaves to its right.
        let wide = columns.len() + 1;
        let mut sums = vec![0.0_f64; wide * rows.len()];
        let moved = |[x, y]: [f64; 2]| [x - columns.start as f64, y - rows.start as f64];
        for area in areas {
            for (from, to) in area.iter().zip(area.iter().cycle().skip(1)) {
                edge(&mut sums, wide, moved(*from), moved(*to));
            }
        }
        for (row, sums) in rows.zip(sums.chunks(wide)) {
            let mut covered = 0.0;
            for (column, sum) in columns.clone().zip(sums) {
                covered += sum;
                let part = (covered.abs().min(1.0) * 255.0).round() as u8;
                if part > 0 {
                    self.blend(column, row, color, part);
                }
            }
        }
    }

    /// Draws a polyline. The opacity of a pixel follows from the distance of its center from the nearest segment.
    pub(crate) fn line(&mut self, points: &[[f64; 2]], width: f64, color: Rgb) {
        let reach = width / 2.0 + 1.0;
        let bound = |axis: usize, end: usize| {
            let places = points.iter().map(|point| point[axis]);
            let (min, max) = places.fold((f64::MAX, 0.0_f64), |(min, max), at| (min.min(at), max.max(at)));
            let begin = ((min - reach).max(0.0) as usize).min(end);
            begin..((max + reach).ceil() as usize + 1).clamp(begin, end)
        };
        let (columns, rows) = (bound(0, self.width), bound(1, self.height));
        let mut covered = vec![0.0_f32; columns.len() * rows.len()];
        for pair in points.windows(2) {
            let [[ax, ay], [bx, by]] = [pair[0], pair[1]];
            let across = (ax.min(bx) - reach).max(0.0) as usize..=(ax.max(bx) + reach).max(0.0) as usize;
            let down = (ay.min(by) - reach).max(0.0) as usize..=(ay.max(by) + reach).max(0.0) as usize;
            let (dx, dy) = (bx - ax, by - ay);
            let length = (dx * dx + dy * dy).max(1e-12);
            for y in down.filter(|y| rows.contains(y)) {
                for x in across.clone().filter(|x| columns.contains(x)) {
                    let (px, py) = (x as f64 + 0.5 - ax, y as f64 + 0.5 - ay);
                    let along = ((px * dx + py * dy) / length).clamp(0.0, 1.0);
                    let (ox, oy) = (px - along * dx, py - along * dy);
                    let part = (width / 2.0 + 0.5 - (ox * ox + oy * oy).sqrt()).clamp(0.0, 1.0) as f32;
                    let here = &mut covered[(y - rows.start) * columns.len() + x - columns.start];
                    *here = here.max(part);
                }
            }
        }
        if columns.is_empty() {
            return;
        }
        for (y, parts) in rows.zip(covered.chunks(columns.len())) {
            let row = &mut self.rgb[3 * (y * self.width + columns.start)..];
            for (pixel, part) in row.as_chunks_mut::<3>().0.iter_mut().zip(parts) {
                if *part > 0.0 {
                    mix(pixel, color, (part * 255.0).round() as u8);
                }
            }
        }
    }
}

/// Adds an edge of an area to the changes of the covered part from pixel to pixel. `wide` is the number of pixels in a row.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "places are within some thousand pixels"
)]
fn edge(sums: &mut [f64], wide: usize, from: [f64; 2], to: [f64; 2]) {
    let (sign, [x0, y0], [x1, y1]) = if from[1] < to[1] { (1.0, from, to) } else { (-1.0, to, from) };
    let rows = sums.len() / wide;
    let most = (wide - 1) as f64;
    let x_at = |y: f64| (x0 + (x1 - x0) * (y - y0) / (y1 - y0)).clamp(0.0, most);
    for row in (y0.max(0.0) as usize)..(y1.max(0.0).ceil() as usize).min(rows) {
        let (top, bottom) = (y0.max(row as f64), y1.min(row as f64 + 1.0));
        if bottom <= top {
            continue;
        }
        let (one, other) = (x_at(top), x_at(bottom));
        let (left, right) = (one.min(other), one.max(other));
        let height = sign * (bottom - top);
        let sums = &mut sums[row * wide..(row + 1) * wide];
        // Of each pixel that the edge crosses, the part to the right of the edge is covered.
        let mut before = 0.0;
        for (column, sum) in sums.iter_mut().enumerate().skip(left as usize) {
            let begin = column as f64;
            let covered = match right - left < 1e-12 {
                true => (begin + 1.0 - left).clamp(0.0, 1.0),
                false => {
                    let [low, high] = [begin, begin + 1.0].map(|x| x.clamp(left, right));
                    let beside = (high - low) * (begin + 1.0 - (low + high) / 2.0);
                    (low - left + beside) / (right - left)
                }
            };
            *sum += height * (covered - before);
            before = covered;
            if begin >= right {
                break;
            }
        }
    }
}

/// Blends a color into a pixel. `part` is the opacity of the color, 0 to 255.
fn mix(pixel: &mut [u8; 3], color: Rgb, part: u8) {
    for (byte, ink) in pixel.iter_mut().zip(color) {
        let (ground, ink, part) = (u32::from(*byte), u32::from(ink), u32::from(part));
        let mixed = (ground * (255 - part) + ink * part + 127) / 255;
        *byte = u8::try_from(mixed).unwrap_or(u8::MAX);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum of the opacity of all pixels, and the opacity of one.
    fn drawn(draw: impl Fn(&mut Canvas)) -> (f64, impl Fn(usize, usize) -> f64) {
        let mut canvas = Canvas::new(20, 20, [0; 3]);
        draw(&mut canvas);
        let sum = canvas.rgb.chunks(3).map(|pixel| f64::from(pixel[0]) / 255.0).sum();
        let rgb = canvas.rgb;
        (sum, move |x: usize, y: usize| f64::from(rgb[3 * (y * 20 + x)]) / 255.0)
    }

    /// A square, a triangle and a square with a hole cover what geometry says.
    #[test]
    fn areas_cover_their_parts_of_pixels() {
        let square = |low: f64, high: f64| vec![[low, low], [high, low], [high, high], [low, high]];
        let (sum, at) = drawn(|canvas| canvas.area(&[square(2.25, 6.5)], [255; 3]));
        assert!((sum - 4.25 * 4.25).abs() < 0.1, "{sum}");
        assert!(
            (at(2, 2) - 0.5625).abs() < 0.01
                && (at(6, 4) - 0.5).abs() < 0.01
                && at(4, 4) == 1.0
                && at(8, 8) == 0.0
        );
        let (sum, at) = drawn(|canvas| canvas.area(&[vec![[1.0, 1.0], [11.0, 1.0], [1.0, 11.0]]], [255; 3]));
        assert!((sum - 50.0).abs() < 0.1 && (at(5, 6) - 0.5).abs() < 0.01, "{sum}");
        let (sum, _) = drawn(|canvas| canvas.area(&[vec![[3.3, 2.1], [15.2, 7.7], [9.9, 18.4]]], [255; 3]));
        // The shoelace formula.
        let expected = 0.5 * ((15.2_f64 - 3.3) * (18.4 - 2.1) - (9.9 - 3.3) * (7.7 - 2.1)).abs();
        assert!((sum - expected).abs() < 0.3, "{sum}, not {expected}");
        let hole: Vec<[f64; 2]> = square(4.0, 8.0).into_iter().rev().collect();
        let (sum, at) = drawn(|canvas| canvas.area(&[square(2.0, 10.0), hole.clone()], [255; 3]));
        assert!((sum - 48.0).abs() < 0.1 && at(5, 5) == 0.0 && at(3, 3) == 1.0, "{sum}");
        // What leaves the image is cut at its edge.
        let (sum, _) = drawn(|canvas| canvas.area(&[square(-5.0, 30.0)], [255; 3]));
        assert!((sum - 400.0).abs() < 0.1, "{sum}");
    }

    #[test]
    fn rules_are_whole_pixels() {
        let (sum, at) = drawn(|canvas| canvas.rule([[2.3, 5.4], [12.3, 5.4]], 1.0, [255; 3]));
        assert!(sum == 11.0 && at(2, 5) == 1.0 && at(12, 5) == 1.0 && at(2, 4) == 0.0, "{sum}");
        let (sum, at) = drawn(|canvas| canvas.rule([[7.5, 2.0], [7.5, 9.0]], 2.0, [255; 3]));
        assert!(sum == 18.0 && at(7, 5) == 1.0, "{sum}");
    }
}
