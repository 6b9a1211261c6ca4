//! The names of the files of a sequence of frames.

/// The name of the script with which one `povray` command renders the whole sequence.
pub const MASTER: &str = "animation.pov";
/// The name of the file with the options for the `povray` command that renders the whole sequence.
pub const INI: &str = "animation.ini";

/// The name of the include file that all scripts share, in the layout `shared`.
pub const COMMON: &str = "common.inc";

/// The name of the folder of assets that scripts read: images, height fields, fonts.
pub const ASSETS: &str = "assets";

/// Returns the number of digits of the frame number in file names: at least 4.
pub(crate) fn width(frames: usize) -> usize {
    const MIN_DIGITS: usize = 4;
    frames.saturating_sub(1).to_string().len().max(MIN_DIGITS)
}

/// Returns the file name of a frame's script in a sequence of `frames` frames: `frame_0050.pov`.
pub fn frame_name(index: usize, frames: usize) -> String {
    format!("frame_{index:0width$}.pov", width = width(frames))
}

/// Returns the file name of the script of an image with motion blur, in a sequence of `frames` frames: `shutter_0050.pov`.
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
