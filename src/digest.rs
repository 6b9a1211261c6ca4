//! SHA-256: the digests by which files, names and random numbers are known.

#[cfg(not(feature = "render"))]
use hmac_sha256::Hash as Implementation;
// It is several times faster, which counts for large files.
#[cfg(feature = "render")]
use sha2::{Digest, Sha256 as Implementation};

/// A digest of bytes that come one after another.
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

    /// The digest of these bytes.
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
        // FIPS 180-4: the digest of "abc".
        let hex: String = Sha256::digest("abc").iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(hex, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
