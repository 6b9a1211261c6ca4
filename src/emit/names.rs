//! The names of the files of a sequence.

/// The script with which one `povray` command renders the whole sequence.
pub const MASTER: &str = "animation.pov";
/// The options for the `povray` command that renders the whole sequence.
pub const INI: &str = "animation.ini";

/// The file that all scripts share, if there is one.
pub const COMMON: &str = "common.inc";

/// The folder of files that scripts read, if there are any.
pub const ASSETS: &str = "assets";

/// The number of digits in the names of the scripts: at least 4.
pub(crate) fn width(frames: usize) -> usize {
    const LEAST: usize = 4;
    frames.saturating_sub(1).to_string().len().max(LEAST)
}

/// The name of a frame's script in a sequence of `frames` frames: `frame_0050.pov`.
pub fn frame_name(index: usize, frames: usize) -> String {
    format!("frame_{index:0width$}.pov", width = width(frames))
}

/// The name of the script of an image with motion blur, in a sequence of `frames` frames: `shutter_0050.pov`.
pub fn shutter_name(index: usize, frames: usize) -> String {
    format!("shutter_{index:0width$}.pov", width = width(frames))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_sort_in_the_order_of_frames() {
        assert_eq!(frame_name(50, 501), "frame_0050.pov");
        assert_eq!(frame_name(9_999, 10_000), "frame_9999.pov");
        assert_eq!(frame_name(9_999, 10_001), "frame_09999.pov");
        assert_eq!(shutter_name(50, 501), "shutter_0050.pov");
    }
}
