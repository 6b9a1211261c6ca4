//! STL, binary or as a text, by the crate `stl_io`.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use glam::DVec3;
use stl_io::create_stl_reader;

use super::lines::{Lines, Place};
use super::{Triangles, Unreadable};

/// The bytes of a binary file before its triangles, of which the last four count them.
const HEAD: usize = 84;
/// The bytes of a triangle.
const TRIANGLE: u64 = 50;

/// The positions and triangles of a file; each triangle has vertices of its own. Its normals are not looked at: they
/// follow from the triangles.
pub(super) fn read(mut file: File) -> Result<Triangles, Unreadable> {
    let mut head = Vec::with_capacity(HEAD);
    (&mut file).take(HEAD as u64).read_to_end(&mut head)?;
    file.seek(SeekFrom::Start(0))?;
    let length = file.metadata()?.len();
    let count = head.get(HEAD - 4..).and_then(|bytes| bytes.try_into().ok()).map(u32::from_le_bytes);
    let claimed = count.map(|count| HEAD as u64 + TRIANGLE * u64::from(count));
    let says_solid = head.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // Binary files may begin with the word as well; but their number of triangles hardly does without a zero.
    if claimed == Some(length) || !says_solid || head.contains(&0) {
        return match (count, claimed) {
            (Some(_), Some(claimed)) if claimed <= length => triangles(&mut Binary(file)),
            (Some(count), Some(_)) => {
                let there = (length - HEAD as u64) / TRIANGLE;
                Err(Unreadable::new(format!("it is cut off: it has {there} of {count} triangles")))
            }
            _ => Err(Unreadable::new("it is too short for a binary STL, and does not begin with `solid`")),
        };
    }
    let mut closed = false;
    let mut lines = Lines::new(file, |line, place| as_expected(line, place, &mut closed));
    triangles(&mut lines).map_err(|error| error.at(lines.number))
}

/// The triangles that the crate reads.
fn triangles<R: Read + Seek>(file: &mut R) -> Result<Triangles, Unreadable> {
    let mut positions = Vec::new();
    for triangle in create_stl_reader(file)? {
        positions.extend(triangle?.vertices.map(|vertex| DVec3::from_array(vertex.0.map(f64::from))));
    }
    let count = u32::try_from(positions.len())
        .map_err(|_| Unreadable::new(format!("it has {} triangles", positions.len() / 3)))?;
    Ok((positions, (0..count / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()))
}

/// Makes a line such as the crate expects: in small letters, with a name after the first `solid`, and as if several
/// solids were one, since the crate stops behind the first.
fn as_expected(line: &mut Vec<u8>, place: Place, closed: &mut bool) {
    if place == Place::End {
        // A file that is cut off lacks its last line, and is to be told so.
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
    if place == Place::Line(1) {
        // Before the word, there may be blank lines.
        line.splice(.., *b"solid x");
    }
}

/// A binary file that does not begin with `solid`, by which the crate knows texts: of its head, nothing is looked at.
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
