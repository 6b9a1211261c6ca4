//! Writes the bytes of a `.glb` file: a header, a chunk of JSON, and a chunk of binary numbers.

use std::io::{self, Write};

use super::document::Document;
use super::geometry::Geometry;
use super::motion::SampledMotion;
use crate::export::ExportError;

/// The size of the largest possible `.glb` file, bytes. The format stores the length of the file in 32 bits.
pub(super) const MAX_FILE_SIZE: u64 = u32::MAX as u64;

/// Writes a `.glb` file, and returns its length in bytes. A file that would be too large is refused before anything is written.
pub(super) fn write(
    document: &Document,
    geometry: &Geometry,
    motion: &SampledMotion,
    out: &mut impl Write,
) -> Result<u64, ExportError> {
    let mut json = serde_json::to_vec(document).map_err(io::Error::from)?;
    // The length of a chunk must be a multiple of four.
    json.resize(json.len().next_multiple_of(4), b' ');
    let binary = document.buffers.first().map_or(0, |buffer| buffer.byte_length);
    let chunk_of_numbers = if binary > 0 { 8 + binary } else { 0 };
    let total = 12 + 8 + json.len() as u64 + chunk_of_numbers;
    let length = u32::try_from(total).map_err(|_| ExportError::TooLarge(total))?;
    out.write_all(b"glTF")?;
    out.write_all(&2u32.to_le_bytes())?;
    out.write_all(&length.to_le_bytes())?;
    // These casts are safe: the length of the whole file fits into 32 bits, so the lengths of its chunks fit as well.
    out.write_all(&(json.len() as u32).to_le_bytes())?;
    out.write_all(b"JSON")?;
    out.write_all(&json)?;
    if binary > 0 {
        out.write_all(&(binary as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        numbers(geometry, motion, document.animations.is_empty(), out)?;
    }
    Ok(total)
}

/// Writes the binary numbers: the triangles, and the keyframes unless the scene is `still`.
fn numbers(geometry: &Geometry, motion: &SampledMotion, still: bool, out: &mut impl Write) -> io::Result<()> {
    for number in geometry.vertices.iter().flatten() {
        out.write_all(&number.to_le_bytes())?;
    }
    for index in &geometry.indices {
        out.write_all(&index.to_le_bytes())?;
    }
    if still {
        return Ok(());
    }
    for number in motion.numbers().flatten() {
        out.write_all(&number.to_le_bytes())?;
    }
    Ok(())
}
