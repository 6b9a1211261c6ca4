//! Removes the date of rendering from PNG images, so that equal pictures have equal bytes.
//!
//! POV-Ray writes the date twice: into the chunk `tIME`, and into a text that begins with `Render Date`. All other chunks stay as they are. The
//! script `render-chunk` of a cluster job removes the same chunks.

/// The bytes with which every PNG begins.
const PNG_SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Returns the bytes of a PNG without the date. `None` if the PNG has no date, or if the bytes are not those of a PNG.
pub(super) fn undated(png: &[u8]) -> Option<Vec<u8>> {
    let mut rest = png.strip_prefix(&PNG_SIGNATURE)?;
    let mut kept = PNG_SIGNATURE.to_vec();
    while !rest.is_empty() {
        // A chunk has the length of its data, its type, its data, and a checksum.
        let (length, after) = rest.split_first_chunk::<4>()?;
        let length = usize::try_from(u32::from_be_bytes(*length)).ok()?;
        let (kind, data) = after.split_first_chunk::<4>()?;
        let data = data.get(..length)?;
        let (chunk, next) = rest.split_at_checked(length + 12)?;
        if !is_date(kind, data) {
            kept.extend_from_slice(chunk);
        }
        rest = next;
    }
    (kept.len() < png.len()).then_some(kept)
}

/// Returns true if a chunk holds the date of rendering.
fn is_date(kind: &[u8; 4], data: &[u8]) -> bool {
    kind == b"tIME" || kind == b"tEXt" && data.starts_with(b"Comment\0Render Date")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a chunk whose checksum is left out: it is 0.
    fn chunk(kind: &[u8], data: &[u8]) -> Vec<u8> {
        [&u32::try_from(data.len()).unwrap().to_be_bytes(), kind, data, &[0; 4]].concat()
    }

    #[test]
    fn dates_go_and_all_else_stays() {
        let head =
            [&PNG_SIGNATURE[..], &chunk(b"IHDR", b"x"), &chunk(b"tEXt", b"Comment\0Date of birth")].concat();
        let date = [chunk(b"tIME", &[1; 7]), chunk(b"tEXt", b"Comment\0Render Date: 2026-01-01")].concat();
        let rest =
            [chunk(b"tEXt", b"Software\0POV-Ray"), chunk(b"IDAT", b"tIME"), chunk(b"IEND", b"")].concat();
        let expected = [&head[..], &rest].concat();
        assert_eq!(undated(&[&head[..], &date, &rest].concat()), Some(expected.clone()));
        assert_eq!(undated(&expected), None, "there is no date");
        let cut = [&head[..], &date, &rest[..rest.len() - 1]].concat();
        assert_eq!(undated(&cut), None, "an incomplete image stays as it is");
        assert_eq!(undated(b"no image"), None);
    }
}
