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
            Quality::Draft => "-A +Q9",
            Quality::Good => "+A0.1 +AM1 +R3",
            Quality::Final => "+A0.03 +AM2 +R4",
        }
    }
}

/// The options that decide on pixels, in the order in which a [record](super::Record) has them. The size is in pixels;
/// `transparent` says whether images have alpha.
pub fn options([width, height]: [u32; 2], transparent: bool, quality: Quality) -> String {
    let alpha = if transparent { " +UA" } else { "" };
    format!("+W{width} +H{height} {}{alpha}", quality.options())
}
