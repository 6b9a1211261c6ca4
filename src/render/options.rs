//! The options of POV-Ray that decide on pixels.

/// How good the images are, against how long they take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// For a look at the motion: no anti-aliasing.
    Draft,
    /// As `animation.ini` renders it.
    #[default]
    Good,
    /// For the film that is kept: finer anti-aliasing, adaptive.
    Final,
}

impl Quality {
    /// The options of POV-Ray that stand for it.
    pub fn options(self) -> &'static str {
        match self {
            // Measured on the default look: 0.3, 1 and 2 to 3 times the time.
            Quality::Draft => "-A +Q9",
            Quality::Good => "+A0.1 +AM1 +R3",
            Quality::Final => "+A0.03 +AM2 +R4",
        }
    }
}

/// The options that decide on pixels, in the order in which a [record](super::Record) has them.
pub fn options(size: [u32; 2], transparent: bool, quality: Quality) -> Vec<String> {
    let [width, height] = size;
    let mut options = vec![format!("+W{width}"), format!("+H{height}")];
    options.extend(quality.options().split(' ').map(str::to_owned));
    options.extend(transparent.then(|| "+UA".to_owned()));
    options
}
