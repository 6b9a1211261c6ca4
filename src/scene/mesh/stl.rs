//! Reads STL files, binary or text, with the crate `stl_io`.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use glam::DVec3;
use stl_io::create_stl_reader;

use super::lines::{BYTE_ORDER_MARK, LinePosition, Lines};
use super::{MeshError, Triangles};

/// The size of the header of a binary STL file, in bytes. Its last four bytes are the number of triangles.
const HEADER_BYTES: usize = 84;
/// The size of a triangle in a binary STL file, in bytes.
const TRIANGLE_BYTES: u64 = 50;

/// Reads the vertices and triangles of an STL file. Each triangle has its own three vertices. Ignores the normals, because they follow
/// from the vertices.
pub(super) fn read(mut file: File) -> Result<Triangles, MeshError> {
    let mut head = Vec::with_capacity(HEADER_BYTES);
    (&mut file).take(HEADER_BYTES as u64).read_to_end(&mut head)?;
    file.seek(SeekFrom::Start(0))?;
    let length = file.metadata()?.len();
    let count = head.get(HEADER_BYTES - 4..).and_then(|bytes| bytes.try_into().ok()).map(u32::from_le_bytes);
    let claimed = count.map(|count| HEADER_BYTES as u64 + TRIANGLE_BYTES * u64::from(count));
    let words = head.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&head).trim_ascii_start();
    let says_solid = words.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // A binary file may begin with `solid`, too. Its number of triangles, however, almost always contains a zero byte, unlike text.
    if claimed == Some(length) || !says_solid || head.contains(&0) {
        return match (count, claimed) {
            (Some(_), Some(claimed)) if claimed <= length => triangles(&mut Binary(file)),
            (Some(count), Some(_)) => {
                let there = (length - HEADER_BYTES as u64) / TRIANGLE_BYTES;
                Err(MeshError::new(format!("it is cut off: it has {there} of {count} triangles")))
            }
            _ => Err(MeshError::new("it is too short for a binary STL, and does not begin with `solid`")),
        };
    }
    let mut closed = false;
    let mut lines = Lines::new(file, |line, place| as_expected(line, place, &mut closed));
    triangles(&mut lines).map_err(|error| error.at(lines.number))
}

/// Reads all triangles of an STL file with the crate `stl_io`.
fn triangles<R: Read + Seek>(file: &mut R) -> Result<Triangles, MeshError> {
    let mut positions = Vec::new();
    for triangle in create_stl_reader(file)? {
        positions.extend(triangle?.vertices.map(|vertex| DVec3::from_array(vertex.0.map(f64::from))));
    }
    let count = u32::try_from(positions.len())
        .map_err(|_| MeshError::new(format!("it has {} triangles", positions.len() / 3)))?;
    Ok((positions, (0..count / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()))
}

/// Rewrites a line of a text STL file for the crate `stl_io`: converts it to lower case, adds a name after the first `solid`, and joins
/// several solids into one, because the crate stops after the first. `closed` holds true if the last nonblank line so far was `endsolid`.
fn as_expected(line: &mut Vec<u8>, place: LinePosition, closed: &mut bool) {
    if place == LinePosition::End {
        // A truncated file lacks its final `endsolid`. It stays missing, so that the crate reports an error.
        line.extend_from_slice(if *closed { b"endsolid" } else { b"" });
        return;
    }
    line.make_ascii_lowercase();
    let word = line.trim_ascii_start();
    let (opens, closes) = (word.starts_with(b"solid"), word.starts_with(b"endsolid"));
    if !word.is_empty() {
        *closed = closes;
    }
    if opens || closes {
        line.clear();
    }
    if place == LinePosition::Line(1) {
        // The first line always becomes the header, because blank lines may precede the word `solid`.
        line.splice(.., *b"solid x");
    }
}

/// A binary STL file that is read with a 0 as its first byte. The crate would read a file that begins with `solid` as text. Apart from
/// that, the crate ignores the first bytes.
struct Binary(File);

impl Read for Binary {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let at_start = self.0.stream_position()? == 0;
        let length = self.0.read(buffer)?;
        if at_start && length > 0 {
            buffer[0] = 0;
        }
        Ok(length)
    }
}

impl Seek for Binary {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}
