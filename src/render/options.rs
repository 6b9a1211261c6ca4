//! The options of POV-Ray that affect pixels.

/// The quality of the images, traded for time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// For a look at the motion: no anti-aliasing.
    Draft,
    /// As `animation.ini` renders it.
    #[default]
    Good,
    /// For the final film: finer anti-aliasing, adaptive.
    Final,
}

impl Quality {
    /// The corresponding options of POV-Ray.
    pub fn options(self) -> &'static str {
        match self {
            // Measured on the default look: 0.3, 1 and 2 to 3 times the time.
            Quality::Draft => "-A +Q9",
            Quality::Good => "+A0.1 +AM1 +R3",
            Quality::Final => "+A0.03 +AM2 +R4",
        }
    }
}

/// The options that affect pixels, in the order in which a [record](super::Record) has them.
pub fn options(size: [u32; 2], transparent: bool, quality: Quality) -> Vec<String> {
    let [width, height] = size;
    let mut options = vec![format!("+W{width}"), format!("+H{height}")];
    options.extend(quality.options().split(' ').map(str::to_owned));
    options.extend(transparent.then(|| "+UA".to_owned()));
    options
}
