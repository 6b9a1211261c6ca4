//! SHA-256 digests. They identify files and names, and seed random numbers.

#[cfg(not(feature = "render"))]
use hmac_sha256::Hash as Implementation;
// The crate `sha2` is several times faster, which matters for large files.
#[cfg(feature = "render")]
use sha2::{Digest, Sha256 as Implementation};

/// Computes the SHA-256 digest of bytes that are added piece by piece.
pub(crate) struct Sha256(Implementation);

impl Sha256 {
    pub(crate) fn new() -> Sha256 {
        Sha256(Implementation::new())
    }

    pub(crate) fn update(&mut self, bytes: impl AsRef<[u8]>) {
        self.0.update(bytes);
    }

    pub(crate) fn finalize(self) -> [u8; 32] {
        let mut digest = [0; 32];
        digest.copy_from_slice(self.0.finalize().as_ref());
        digest
    }

    /// Returns the SHA-256 digest of the given bytes.
    pub(crate) fn digest(bytes: impl AsRef<[u8]>) -> [u8; 32] {
        let mut digest = Sha256::new();
        digest.update(bytes);
        digest.finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_is_that_of_the_standard() {
        // The digest of "abc" is an example of the standard, FIPS 180-4.
        let hex: String = Sha256::digest("abc").iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(hex, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
