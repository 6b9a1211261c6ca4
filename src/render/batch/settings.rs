//! The settings of a job folder, `job.conf`: what jabuka tells the scripts that run on the nodes.

use std::fs;
use std::path::{Path, PathBuf};

use crate::simulate::Selection;

/// The name of the file in its folder.
pub const SETTINGS: &str = "job.conf";
/// The name of the file of the user's own settings, which come after those.
const OWN: &str = "local.conf";

/// The settings of a job.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The name of the job: that of the scene, after `jabuka-`.
    pub job: String,
    /// The frames that are to be rendered, in their order.
    pub frames: Vec<usize>,
    /// The number of the last frame of the whole scene.
    pub last_frame: usize,
    /// The time of that frame, s.
    pub end: f64,
    /// The number of digits in the names of frames.
    pub digits: usize,
    /// Frames per second.
    pub frame_rate: f64,
    /// The number of frames that one job of the engine renders.
    pub chunk: usize,
    /// The options of POV-Ray that matter for the pixels.
    pub options: String,
    /// The files that all scripts read, by their names in the folder of the scripts.
    pub files: Vec<String>,
    /// Whether some frames are averages of several moments.
    pub blurred: bool,
    /// The longest that one frame may take, s.
    pub limit: u64,
}

/// The settings that matter for what is there: what a user may have changed, too.
#[derive(Clone, Debug)]
pub(crate) struct InForce {
    pub(crate) frames: Selection,
    pub(crate) options: String,
    pub(crate) files: Vec<PathBuf>,
    /// What decides on the film beside its images: frame rate and options of ffmpeg.
    pub(crate) film: String,
}

impl Settings {
    /// The settings as the scripts read them.
    pub(super) fn to_text(&self) -> String {
        let frames: Selection = self.frames.iter().copied().collect();
        let files: Vec<String> = self.files.iter().map(|file| quoted(file)).collect();
        include_str!("../../../templates/batch/job.conf")
            .replace("@job@", &quoted(&self.job))
            .replace("@frames@", &quoted(&frames.to_string()))
            .replace("@last@", &self.last_frame.to_string())
            .replace("@end@", &self.end.to_string())
            .replace("@digits@", &self.digits.to_string())
            .replace("@frame_rate@", &self.frame_rate.to_string())
            .replace("@chunk@", &self.chunk.to_string())
            .replace("@options@", &quoted(&self.options))
            .replace("@blurred@", if self.blurred { "yes" } else { "no" })
            .replace("@limit@", &self.limit.to_string())
            .replace("@files@", &format!("({})", files.join(" ")))
    }
}

impl InForce {
    /// Reads the settings of a job folder; none if it is no job folder.
    pub(crate) fn read(folder: &Path) -> Option<InForce> {
        let mut text = fs::read_to_string(folder.join(SETTINGS)).ok()?;
        text.push('\n');
        text.push_str(&fs::read_to_string(folder.join(OWN)).unwrap_or_default());
        // The last line that sets something is the one that counts.
        let words = |key: &str| {
            let set = |line: &str| line.strip_prefix(key)?.strip_prefix('=').map(words);
            text.lines().rev().find_map(set)
        };
        let one = |key: &str| words(key)?.into_iter().next();
        let scripts = folder.join("scripts");
        Some(InForce {
            frames: one("FRAMES")?.parse().ok()?,
            options: one("OPTIONS")?,
            files: words("FILES")?.into_iter().map(|file| scripts.join(file)).collect(),
            film: format!("{} {}", one("FRAME_RATE")?, one("VIDEO_OPTIONS")?),
        })
    }
}

/// A word as bash reads it, whatever it contains.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// The words of a value as [`quoted`] writes them, alone or in parentheses; also in double quotes, as people write them.
fn words(value: &str) -> Vec<String> {
    let value = value.trim();
    let value = value.strip_prefix('(').and_then(|value| value.strip_suffix(')')).unwrap_or(value);
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut chars = value.chars();
    let mut quote = None;
    while let Some(c) = chars.next() {
        match (quote, c) {
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (Some(open), c) if c == open => quote = None,
            (None, '\\') => word.get_or_insert_default().extend(chars.next()),
            (None, '#') if word.is_none() => break,
            (None, c) if c.is_whitespace() => words.extend(word.take()),
            (_, c) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

#[cfg(test)]
pub(super) mod tests {
    use std::process::Command;

    use super::*;

    pub(in crate::render) fn settings() -> Settings {
        Settings {
            job: "jabuka-it's $HOME".to_owned(),
            frames: vec![0, 1, 2, 7],
            last_frame: 9,
            end: 0.36,
            digits: 4,
            frame_rate: 25.0,
            chunk: 10,
            options: "+W64 +H36 +A0.1 +AM1 +R3".to_owned(),
            files: vec!["common.inc".to_owned(), "assets/a b 'c'.png".to_owned()],
            blurred: false,
            limit: 3600,
        }
    }

    #[test]
    fn bash_reads_the_settings_as_they_are_meant() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(SETTINGS), settings().to_text()).unwrap();
        let print = "set -eu; source ./job.conf; printf '%s|' \"$JOB\" \"$FRAMES\" \"$LAST_FRAME\" \"$END\" \
                     \"$DIGITS\" \"$FRAME_RATE\" \"$CHUNK\" \"$OPTIONS\" \"${FILES[@]}\" \"$BLURRED\" \"$LIMIT\"";
        let output = Command::new("bash").args(["-c", print]).current_dir(folder.path()).output().unwrap();
        assert_eq!(
            String::from_utf8(output.stdout).unwrap(),
            "jabuka-it's $HOME|0-2,7|9|0.36|4|25|10|+W64 +H36 +A0.1 +AM1 +R3|common.inc|assets/a b 'c'.png|no|3600|"
        );
        let read = InForce::read(folder.path()).unwrap();
        assert_eq!(read.frames.to_string(), "0-2,7");
        assert_eq!(read.options, settings().options);
        let scripts = folder.path().join("scripts");
        assert_eq!(read.files, [scripts.join("common.inc"), scripts.join("assets/a b 'c'.png")]);
        assert_eq!(read.film, "25 -c:v libx264 -crf 18");
    }

    #[test]
    fn what_the_user_sets_counts() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(SETTINGS), Settings { files: Vec::new(), ..settings() }.to_text())
            .unwrap();
        fs::write(folder.path().join(OWN), "OPTIONS=\"+W32 +H18\" # small\n").unwrap();
        let read = InForce::read(folder.path()).unwrap();
        assert_eq!((read.options.as_str(), read.files.len()), ("+W32 +H18", 0));
    }
}
