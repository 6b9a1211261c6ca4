//! Writes the script of an image with motion blur: the scripts of all its moments in one file, chosen by number.
//!
//! `povray +Ishutter_0007.pov +KFI0 +KFF15` renders sixteen moments, one after another, in one process. The mean of the moments is the
//! image that a camera takes while its shutter is open.

use crate::picture::number;
use crate::scene::Shutter;
use crate::simulate::Frame;

/// Returns the text before the first moment. It sets POV-Ray's variable `frame_number` to the number of the frame, instead of the number
/// of the moment. So the scene's POV-Ray code sees the same number as in the frame's sharp script.
pub(super) fn head(frame: &Frame, shutter: Shutter, digits: usize) -> String {
    let mut time = String::new();
    number::write(&mut time, frame.time, digits);
    let (index, samples) = (frame.index, shutter.samples);
    format!(
        "// frame {index}, t = {time} s, {samples} moments while the shutter is open\n\
         #version 3.7;\n\
         #ifndef (Shutter_Sample) #declare Shutter_Sample = frame_number; #end\n\
         #declare frame_number = {index};\n\
         #switch (Shutter_Sample)\n"
    )
}

/// Returns the text of one moment, made from the script of this moment.
pub(super) fn moment(number: usize, script: &str) -> String {
    // The first line of the script contains the number of the frame and the time, and is removed. So the scripts of equal pictures differ
    // only in the first line of the whole file.
    let script = match script.split_once('\n') {
        Some((first, rest)) if first.starts_with("//") => rest,
        _ => script,
    };
    let end = if script.ends_with('\n') { "" } else { "\n" };
    format!("#case ({number})\n{script}{end}#break\n")
}

/// Returns the text after the last moment.
pub(super) fn end(shutter: Shutter) -> String {
    let last = shutter.samples - 1;
    format!("#else\n#error \"Shutter_Sample goes from 0 to {last}\"\n#end\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_loses_the_line_that_says_its_time_and_no_other() {
        assert_eq!(moment(3, "// frame 7, t = 1 s\nsphere {}\n"), "#case (3)\nsphere {}\n#break\n");
        assert_eq!(moment(0, "#version 3.7;\n// the end"), "#case (0)\n#version 3.7;\n// the end\n#break\n");
    }
}
