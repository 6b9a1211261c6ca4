//! The settings of a cluster job, for the bash scripts that run on the nodes. They are in the file `job.conf` of the job folder.

use std::io;
use std::path::{Path, PathBuf};

use crate::render::record::read_input;
use crate::render::{Format, Pace, Quality};
use crate::simulate::Selection;

/// The name of the settings file in a job folder.
pub const SETTINGS_FILE: &str = "job.conf";
/// The name of the file with the user's own settings. They override those of `job.conf`.
const LOCAL_SETTINGS_FILE: &str = "local.conf";

/// The keys that a settings file may contain.
const KEYS: [&str; 17] = [
    "JOB",
    "FRAMES",
    "LAST_FRAME",
    "END",
    "DIGITS",
    "FRAME_RATE",
    "CHUNK",
    "OPTIONS",
    "BLURRED",
    "TRUST",
    "LIMIT",
    "FILE",
    "POVRAY",
    "JABUKA",
    "FFMPEG",
    "VIDEO_OPTIONS",
    "PROCESSES",
];

/// The settings of a cluster job.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The name of the job: letters, digits and `-_.`.
    pub job: String,
    /// The numbers of the frames to render, in ascending order.
    pub frames: Vec<usize>,
    /// The number of the last frame of the whole scene.
    pub last_frame: usize,
    /// The simulated time of the scene's last frame, s.
    pub end: f64,
    /// The number of digits of the frame number in file names.
    pub digits: usize,
    /// The frame rate of the film, and its speed relative to the time between two frames.
    pub pace: Pace,
    /// The speed of the film relative to the scene. `None` if it changes.
    pub shown: Option<Pace>,
    /// The quality of the film's encoding.
    pub video_quality: Quality,
    /// The number of frames that one job of the engine renders.
    pub chunk: usize,
    /// The command-line options of POV-Ray that affect pixels.
    pub options: String,
    /// The files that all scripts read, as paths relative to the folder of the scripts.
    pub files: Vec<String>,
    /// True if frames have motion blur: an image is then the mean of the images of several moments.
    pub blurred: bool,
    /// True if the user trusts the scene: the scripts may then read all files, and write in the job folder.
    pub trust: bool,
    /// The time limit for rendering one frame, s.
    pub limit: u64,
}

/// The current settings of an existing job folder, with the user's changes from `local.conf`.
#[derive(Clone, Debug)]
pub(crate) struct CurrentSettings {
    pub(crate) frames: Selection,
    pub(crate) options: String,
    pub(crate) files: Vec<PathBuf>,
    /// The settings that affect the film but not its images: the frame rate and the options of ffmpeg.
    pub(crate) film: String,
}

impl Settings {
    /// Returns the settings as the text of `job.conf`.
    ///
    /// Every value is the rest of its line and is never executed. So values need no quotes, but must not contain line breaks.
    pub(super) fn to_text(&self) -> String {
        let frames: Selection = self.frames.iter().copied().collect();
        let files: Vec<String> = self.files.iter().map(|file| format!("FILE={file}")).collect();
        fill(
            include_str!("../../../templates/batch/job.conf"),
            &[
                ("job", &self.job),
                ("frames", &frames.to_string()),
                ("last", &self.last_frame.to_string()),
                ("end", &self.end.to_string()),
                ("digits", &self.digits.to_string()),
                ("video_rate", &self.pace.rate.to_string()),
                ("video_options", Format::Mp4.codec(self.video_quality)),
                ("chunk", &self.chunk.to_string()),
                ("options", &self.options),
                ("blurred", if self.blurred { "yes" } else { "no" }),
                ("trust", if self.trust { "yes" } else { "no" }),
                ("limit", &self.limit.to_string()),
                ("files", &files.join("\n")),
            ],
        )
    }
}

impl CurrentSettings {
    /// Reads the settings of a job folder. `None` if the folder has no settings file, and is therefore not a job folder.
    ///
    /// # Errors
    /// If a settings file cannot be read or understood.
    pub(crate) fn read(folder: &Path) -> io::Result<Option<CurrentSettings>> {
        let Some(mut values) = values(folder, SETTINGS_FILE)? else { return Ok(None) };
        values.extend(values_of_user(folder)?);
        let wrong = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
        // If several lines set a key, the last one counts.
        let one = |key: &str| {
            let value = values.iter().rev().find(|(set, _)| set == key).map(|(_, value)| value.as_str());
            value.ok_or_else(|| {
                wrong(format!("its `{SETTINGS_FILE}` does not set {key}: run `jabuka batch` again"))
            })
        };
        let frames =
            one("FRAMES")?.parse().map_err(|error| wrong(format!("FRAMES in its settings: {error}")))?;
        let scripts = folder.join("scripts");
        Ok(Some(CurrentSettings {
            frames,
            options: one("OPTIONS")?.to_owned(),
            files: values
                .iter()
                .filter(|(key, _)| key == "FILE")
                .map(|(_, file)| scripts.join(file))
                .collect(),
            film: format!("{} {}", one("FRAME_RATE")?, one("VIDEO_OPTIONS")?),
        }))
    }
}

/// Reads the user's own settings of a job folder. They are empty if `local.conf` does not exist.
fn values_of_user(folder: &Path) -> io::Result<Vec<(String, String)>> {
    Ok(values(folder, LOCAL_SETTINGS_FILE)?.unwrap_or_default())
}

/// Reads the keys and values of a settings file, by the same rules as `settings.sh`. `None` if the file does not exist.
fn values(folder: &Path, name: &str) -> io::Result<Option<Vec<(String, String)>>> {
    let bytes = match read_input(&folder.join(name)) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(io::Error::new(error.kind(), format!("its `{name}`: {error}"))),
    };
    let text = String::from_utf8_lossy(&bytes);
    let mut values = Vec::new();
    for (index, line) in text.split('\n').enumerate() {
        let line = line.strip_suffix('\r').unwrap_or(line);
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        let wrong = |what: &str| {
            let message = format!("its `{name}`, line {}: {what}", index + 1);
            io::Error::new(io::ErrorKind::InvalidData, message)
        };
        let is_key = |key: &str| !key.is_empty() && key.chars().all(|c| c.is_ascii_uppercase() || c == '_');
        let pair = line.split_once('=').filter(|(key, _)| is_key(key));
        let (key, value) = pair.ok_or_else(|| wrong("expected KEY=value"))?;
        if !KEYS.contains(&key) {
            return Err(wrong(&format!("unknown setting `{key}`")));
        }
        let value = match value.chars().next() {
            Some(quote @ ('\'' | '"')) => value[1..].strip_suffix(quote).ok_or_else(|| {
                wrong("the quote at the start of the value must be closed at the end of the line")
            })?,
            _ => value,
        };
        values.push((key.to_owned(), value.to_owned()));
    }
    Ok(Some(values))
}

/// Replaces each `@key@` in a text by its value. This happens in one pass, so that keys inside of values stay as they are.
pub(super) fn fill(text: &str, values: &[(&str, &str)]) -> String {
    let mut filled = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('@') {
        filled.push_str(before);
        let found = values.iter().find_map(|(key, value)| {
            let after = after.strip_prefix(key)?.strip_prefix('@')?;
            Some((value, after))
        });
        match found {
            Some((value, after)) => {
                filled.push_str(value);
                rest = after;
            }
            None => {
                filled.push('@');
                rest = after;
            }
        }
    }
    filled + rest
}

#[cfg(test)]
pub(super) mod tests {
    use std::fs;
    use std::process::Command;

    use super::*;

    pub(in crate::render) fn settings() -> Settings {
        Settings {
            job: "jabuka-it's $HOME".to_owned(),
            frames: vec![0, 1, 2, 7],
            last_frame: 9,
            end: 0.36,
            digits: 4,
            pace: Pace::new(25.0, None),
            shown: None,
            video_quality: Quality::Good,
            chunk: 10,
            options: "+W64 +H36 +A0.1 +AM1 +R3".to_owned(),
            files: vec!["common.inc".to_owned(), "assets/a b 'c'.png".to_owned()],
            blurred: false,
            trust: false,
            limit: 3600,
        }
    }

    /// Returns every value as `settings.sh` reads it, each followed by `|`. Returns the error message if `settings.sh` fails.
    fn read_by_bash(folder: &Path) -> Result<String, String> {
        fs::write(folder.join("settings.sh"), include_str!("../../../templates/batch/settings.sh")).unwrap();
        let print = "set -euo pipefail; export LC_ALL=C; source ./settings.sh; printf '%s|' \"$JOB\" \"$FRAMES\" \
                     \"$LAST_FRAME\" \"$END\" \"$DIGITS\" \"$FRAME_RATE\" \"$CHUNK\" \"$OPTIONS\" \"${FILES[@]}\" \
                     \"$BLURRED\" \"$LIMIT\" \"$POVRAY\" \"$VIDEO_OPTIONS\"";
        let output = Command::new("bash").args(["-c", print, "test"]).current_dir(folder).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        if output.status.success() { Ok(text(output.stdout)) } else { Err(text(output.stderr)) }
    }

    /// Values that a shell or a second substitution would execute or replace.
    const HOSTILE: [&str; 9] = [
        "a$(touch PWNED)",
        "a`touch PWNED`",
        "'; touch PWNED; '",
        "\"; touch PWNED; \"",
        "x@options@y@files@",
        "-rf",
        "LINENO[$(touch PWNED)]",
        "# \\ ~ *",
        "ü \u{202e}",
    ];

    #[test]
    fn bash_and_jabuka_read_the_settings_as_they_are_meant() {
        let folder = tempfile::tempdir().unwrap();
        for hostile in HOSTILE {
            let settings = Settings {
                job: format!("jabuka-{hostile}"),
                options: format!("+W64 {hostile}"),
                files: vec!["common.inc".to_owned(), format!("assets/{hostile}")],
                ..settings()
            };
            fs::write(folder.path().join(SETTINGS_FILE), settings.to_text()).unwrap();
            assert_eq!(
                read_by_bash(folder.path()).unwrap(),
                format!(
                    "jabuka-{hostile}|0-2,7|9|0.36|4|25|10|+W64 {hostile}|common.inc|assets/{hostile}|no|3600|povray|\
                     -c:v libx264 -preset medium -crf 18|"
                )
            );
            let read = CurrentSettings::read(folder.path()).unwrap().unwrap();
            assert_eq!(read.frames.to_string(), "0-2,7");
            assert_eq!(read.options, settings.options);
            let scripts = folder.path().join("scripts");
            assert_eq!(read.files, [scripts.join("common.inc"), scripts.join(format!("assets/{hostile}"))]);
            assert_eq!(read.film, "25 -c:v libx264 -preset medium -crf 18");
            assert!(!folder.path().join("PWNED").exists(), "{hostile}");
        }
    }

    #[test]
    fn what_the_user_sets_counts() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(SETTINGS_FILE), settings().to_text()).unwrap();
        fs::write(
            folder.path().join(LOCAL_SETTINGS_FILE),
            "# mine\r\n\nOPTIONS=\"+W32 +H18\"\r\nLIMIT=010\nPOVRAY=$(x)/a b",
        )
        .unwrap();
        let read = CurrentSettings::read(folder.path()).unwrap().unwrap();
        assert_eq!(read.options, "+W32 +H18");
        let bash = read_by_bash(folder.path()).unwrap();
        assert!(bash.contains("|+W32 +H18|") && bash.contains("|10|$(x)/a b|"), "{bash}");
    }

    #[test]
    fn bash_and_jabuka_refuse_the_same_lines() {
        let folder = tempfile::tempdir().unwrap();
        for (line, said) in [
            ("LIMIT 600", "line 1: expected KEY=value"),
            ("touch PWNED", "line 1: expected KEY=value"),
            ("PATH=/tmp", "line 1: unknown setting `PATH`"),
            ("FILES=(a b)", "line 1: unknown setting `FILES`"),
            ("POVRAY=\"a\" # mine", "line 1: the quote at the start"),
            ("POVRAY=\"", "line 1: the quote at the start"),
            ("FRAMES=LINENO[$(touch PWNED)]", "FRAMES"),
        ] {
            fs::write(folder.path().join(SETTINGS_FILE), settings().to_text()).unwrap();
            fs::write(folder.path().join(LOCAL_SETTINGS_FILE), line).unwrap();
            let bash = read_by_bash(folder.path()).unwrap_err();
            assert!(bash.starts_with("test: local.conf, line 1") && bash.contains(said), "{bash}");
            let rust = CurrentSettings::read(folder.path()).unwrap_err().to_string();
            assert!(rust.contains(said), "{rust}");
        }
        // In arithmetic, bash executes commands in the index of an array variable, so these values must be refused.
        for key in
            ["LAST_FRAME", "DIGITS", "CHUNK", "LIMIT", "PROCESSES", "END", "FRAME_RATE", "BLURRED", "TRUST"]
        {
            fs::write(folder.path().join(LOCAL_SETTINGS_FILE), format!("{key}=LINENO[$(touch PWNED)]"))
                .unwrap();
            assert!(read_by_bash(folder.path()).unwrap_err().contains(key));
        }
        assert!(!folder.path().join("PWNED").exists());
    }

    #[test]
    fn what_is_put_into_a_place_is_not_looked_at_again() {
        let values = [("a", "@b@"), ("b", "@a@"), ("a_b", "3")];
        assert_eq!(fill("@a@@b@ @a_b@ @c@ a@b @", &values), "@b@@a@ 3 @c@ a@b @");
    }
}
