//! The command-line options of POV-Ray that affect pixels.

/// The quality of images: better quality takes more rendering time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// A preview of the motion, without anti-aliasing.
    Draft,
    /// The quality that `animation.ini` sets.
    #[default]
    Good,
    /// The quality for a final film, with finer and adaptive anti-aliasing.
    Final,
}

impl Quality {
    /// Returns the options of POV-Ray for this quality.
    pub fn options(self) -> &'static str {
        match self {
            // Measured with the default look, the three qualities take 0.3, 1 and 2 to 3 times the rendering time of `Good`.
            Quality::Draft => "-A +Q9",
            Quality::Good => "+A0.1 +AM1 +R3",
            Quality::Final => "+A0.03 +AM2 +R4",
        }
    }
}

/// Returns the options of POV-Ray that affect pixels, in the order that a [record](super::Record) stores them. `size` is width and height
/// in pixels.
pub fn options(size: [u32; 2], transparent: bool, quality: Quality) -> Vec<String> {
    let [width, height] = size;
    let mut options = vec![format!("+W{width}"), format!("+H{height}")];
    options.extend(quality.options().split(' ').map(str::to_owned));
    options.extend(transparent.then(|| "+UA".to_owned()));
    options
}
