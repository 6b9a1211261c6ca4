//! The record of an image: a text file that tells whether the image is up to date.
//!
//! The record of `images/frame_0007.png` is `images/.jabuka/frame_0007.txt`, with seven lines:
//!
//! ```text
//! script <SHA-256 of the script without its first line, which has number and time>
//! files <SHA-256 of the bytes of all files that it reads, one after another; - if there are none>
//! options <the options of POV-Ray that matter for the pixels>
//! frame <the frame's number where the script may depend on it, or ->
//! povray <the version of POV-Ray>
//! bytes <the length of the image>
//! image <SHA-256 of the image>
//! ```
//!
//! The record and the length of an image are enough to tell whether it is up to date, so thousands of images are checked quickly.
//! `--verify` also reads the images and compares their digests. Records of earlier versions lack the last line. Their images can be up to
//! date, but cannot be verified.
//!
//! The record is written after the image. An interruption therefore leaves at most an image without a record, which is rendered again. The
//! script `render-chunk` of a cluster job writes and reads the same texts; a test checks that both agree.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use sha2::{Digest, Sha256};

use crate::system::{self, Dir, FolderError};

/// The name of the hidden folder beside the images. It contains the records, and other data about the images.
pub const HIDDEN_FOLDER: &str = ".jabuka";

/// The words that make a script's image depend on the number of its frame.
const FRAME_NUMBER_WORDS: [&str; 2] = ["frame_number", "clock"];

/// The beginning of the names of scripts that contain the moments of a frame with motion blur. Their `frame_number` is the number of the
/// moment, so they do not depend on the number of the frame.
const SHUTTER_SCRIPT_PREFIX: &str = "shutter_";

/// The record of a rendered image, or of one that is yet to be rendered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record {
    /// The SHA-256 of the script without its first line, in hexadecimal digits.
    pub script: String,
    /// The SHA-256 of the files that the script reads, in hexadecimal digits. `-` if the script reads no files.
    pub files: String,
    /// The command-line options of POV-Ray that affect pixels, in one line.
    pub options: String,
    /// The number of the frame, if the script may depend on it.
    pub frame: Option<usize>,
    /// The version of POV-Ray: the word after `POV-Ray` in the output of `povray --version`.
    pub povray: String,
    /// The length of the image in bytes. It is 0 for an image that is yet to be rendered.
    pub bytes: u64,
    /// The SHA-256 of the image in hexadecimal digits. `None` for an image that is yet to be rendered, and in a record of an earlier
    /// version.
    pub image: Option<String>,
}

/// The parts of two records that must be equal for an image to be up to date.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compare {
    /// All parts of the records.
    All,
    /// All parts except the version of POV-Ray, which is unknown if POV-Ray is not installed.
    NotPovray,
    /// Script, files and frame number, if the requested options are unknown.
    Scene,
}

/// The state of an image, compared with the image that would be rendered now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The image equals the one that would be rendered now.
    UpToDate,
    /// The image exists, but it is outdated, incomplete, or of unknown origin.
    Outdated,
    /// The image does not exist.
    Missing,
}

/// The result of checking an image against the digest in its record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The image has the bytes that were rendered.
    Intact,
    /// The image was changed or damaged after it was rendered.
    Changed,
    /// The record of the image has no digest, or there is no record.
    Unverified,
}

/// A digest of the files that a script reads, and whether an include file among them depends on the frame number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Files {
    digest: String,
    numbered: bool,
}

impl Files {
    /// Reads and digests the files, in the order of the list.
    ///
    /// # Errors
    /// If a file cannot be read. The error contains its path and the reason.
    pub fn read(files: &[PathBuf]) -> Result<Files, (PathBuf, io::Error)> {
        let mut hasher = Sha256::new();
        let mut numbered = false;
        for path in files {
            let bytes = read_input(path).map_err(|error| (path.clone(), error))?;
            hasher.update(&bytes);
            numbered |= path.extension().is_some_and(|end| end == "inc") && mentions_number(&bytes);
        }
        let digest = if files.is_empty() { "-".to_owned() } else { hex(&hasher.finalize()) };
        Ok(Files { digest, numbered })
    }
}

impl Record {
    /// Returns the record that an image of this script would get if it were rendered now. Length and digest of the image are missing.
    ///
    /// # Errors
    /// If the script cannot be read.
    pub fn expected(
        script: &Path,
        frame: usize,
        files: &Files,
        options: &str,
        povray: &str,
    ) -> io::Result<Record> {
        let mut reader = BufReader::new(system::open(script)?);
        reader.skip_until(b'\n')?;
        let mut text = Vec::new();
        reader.read_to_end(&mut text)?;
        let blurred =
            script.file_name().is_some_and(|name| name.to_string_lossy().starts_with(SHUTTER_SCRIPT_PREFIX));
        let numbered = !blurred && (files.numbered || mentions_number(&text));
        Ok(Record {
            script: hex(&Sha256::digest(&text)),
            files: files.digest.clone(),
            options: options.to_owned(),
            frame: numbered.then_some(frame),
            povray: povray.to_owned(),
            bytes: 0,
            image: None,
        })
    }

    /// Adds the length and the digest of the finished image with these bytes to the record.
    pub(super) fn of_bytes(self, image: &[u8]) -> Record {
        Record { bytes: image.len() as u64, image: Some(hex(&Sha256::digest(image))), ..self }
    }

    /// Adds the length and the digest of the finished image to the record.
    ///
    /// # Errors
    /// If the image cannot be read.
    pub fn of_image(self, image: &Path) -> io::Result<Record> {
        let (image, bytes) = digest_of_file(system::open(image)?)?;
        Ok(Record { bytes, image: Some(image), ..self })
    }

    /// Reads the image, and compares its digest with that of the record.
    ///
    /// # Errors
    /// If the image cannot be read.
    pub fn verify(&self, image: &Path) -> io::Result<Verdict> {
        self.verify_file(system::open(image)?)
    }

    pub(super) fn verify_file(&self, image: File) -> io::Result<Verdict> {
        let Some(digest) = &self.image else { return Ok(Verdict::Unverified) };
        let is = digest_of_file(image)?.0;
        Ok(if is == *digest { Verdict::Intact } else { Verdict::Changed })
    }

    /// Returns the path of an image's record. `name` is the image's name without its extension: `frame_0007`.
    pub fn path(images: &Path, name: &str) -> PathBuf {
        images.join(HIDDEN_FOLDER).join(format!("{name}.txt"))
    }

    /// Reads the record of an image. `None` if the file does not exist, or is not a record.
    pub fn read(images: &Path, name: &str) -> Option<Record> {
        Record::of_file(system::open(&Record::path(images, name)).ok()?)
    }

    /// Reads the record of an image in the folder [`HIDDEN_FOLDER`].
    pub(super) fn read_in(hidden: &Dir, name: &str) -> Option<Record> {
        Record::of_file(hidden.open_file(format!("{name}.txt")).ok()?)
    }

    fn of_file(file: File) -> Option<Record> {
        /// The largest number of bytes that are read: far more than any record needs.
        const MAX_BYTES: u64 = 64 << 10;
        let mut text = String::new();
        file.take(MAX_BYTES).read_to_string(&mut text).ok()?;
        Record::parse(&text)
    }

    /// Writes the record of an existing image under a temporary name, and renames it when it is complete. The folder [`HIDDEN_FOLDER`] must
    /// exist.
    ///
    /// # Errors
    /// If the record cannot be written.
    pub fn write(&self, images: &Path, name: &str) -> io::Result<()> {
        Ok(self.write_in(&Dir::open(&images.join(HIDDEN_FOLDER))?, name)?)
    }

    /// Writes the record into the folder [`HIDDEN_FOLDER`], as [`Record::write`] does.
    pub(super) fn write_in(&self, hidden: &Dir, name: &str) -> Result<(), FolderError> {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let unique = (std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        // A leftover does no harm: it is hidden, and does not have the name of a record.
        let temporary = format!(".{name}.{}-{}.tmp", unique.0, unique.1);
        let path = format!("{name}.txt");
        hidden.write_as(Path::new(&temporary), Path::new(&path), |file| {
            let written = file.write_all(self.to_text().as_bytes());
            written.map_err(|error| FolderError::Io(hidden.path().join(&path), error))
        })
    }

    /// Returns the state of an existing or missing image. The image is up to date if its own record agrees with this one in the parts that
    /// `compare` selects.
    pub fn state(&self, images: &Path, name: &str, compare: Compare) -> State {
        let about = fs::symlink_metadata(images.join(format!("{name}.png"))).ok();
        let image = about.map(|about| (about.is_file(), about.len()));
        self.state_of(image, Record::read(images, name).as_ref(), compare)
    }

    /// Returns the state of an image. `image` tells whether it is a regular file, and its length; `record` is its own record.
    pub(super) fn state_of(
        &self,
        image: Option<(bool, u64)>,
        record: Option<&Record>,
        compare: Compare,
    ) -> State {
        let is = |record: &Record| image == Some((true, record.bytes)) && record.is_of(self, compare);
        match image {
            None => State::Missing,
            Some(_) if record.is_some_and(is) => State::UpToDate,
            Some(_) => State::Outdated,
        }
    }

    /// Returns true if two records agree in the parts that `compare` selects. Lengths and digests of the images do not matter.
    pub fn is_of(&self, other: &Record, compare: Compare) -> bool {
        self.script == other.script
            && self.files == other.files
            && self.frame == other.frame
            && (compare == Compare::Scene || self.options == other.options)
            && (compare != Compare::All || self.povray == other.povray)
    }

    /// Returns the record as the text of its file.
    pub fn to_text(&self) -> String {
        let frame = self.frame.map_or_else(|| "-".to_owned(), |frame| frame.to_string());
        let Record { script, files, options, povray, bytes, .. } = self;
        let image = self.image.as_ref().map_or_else(String::new, |image| format!("image {image}\n"));
        format!(
            "script {script}\nfiles {files}\noptions {options}\nframe {frame}\npovray {povray}\nbytes {bytes}\n{image}"
        )
    }

    fn parse(text: &str) -> Option<Record> {
        let mut lines = text.strip_suffix('\n')?.split('\n');
        let mut value = |key: &str| lines.next()?.strip_prefix(key)?.strip_prefix(' ');
        let record = Record {
            script: value("script")?.to_owned(),
            files: value("files")?.to_owned(),
            options: value("options")?.to_owned(),
            frame: match value("frame")? {
                "-" => None,
                number => Some(number.parse().ok()?),
            },
            povray: value("povray")?.to_owned(),
            bytes: value("bytes")?.parse().ok()?,
            image: None,
        };
        let image = match lines.next() {
            None => None,
            Some(line) => Some(line.strip_prefix("image ").filter(|digest| is_digest(digest))?.to_owned()),
        };
        lines.next().is_none().then_some(Record { image, ..record })
    }
}

/// Reads a file that a script reads. A link is followed, since POV-Ray follows it, too. A pipe would block, and is an error.
pub(super) fn read_input(path: &Path) -> io::Result<Vec<u8>> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "it is not a regular file"));
    }
    fs::read(path)
}

/// Returns true if a text contains a word that makes the image depend on the number of its frame.
fn mentions_number(text: &[u8]) -> bool {
    let is_word = |byte: Option<&u8>| byte.is_some_and(|b| b.is_ascii_alphanumeric() || *b == b'_');
    let at = |start: usize, word: &str| {
        text[start..].starts_with(word.as_bytes())
            && !is_word(text.get(start.wrapping_sub(1)))
            && !is_word(text.get(start + word.len()))
    };
    (0..text.len()).any(|start| FRAME_NUMBER_WORDS.iter().any(|word| at(start, word)))
}

/// Returns the SHA-256 of a file in hexadecimal digits, and its length in bytes.
fn digest_of_file(file: File) -> io::Result<(String, u64)> {
    let mut reader = BufReader::with_capacity(1 << 16, file);
    let (mut hasher, mut bytes) = (Sha256::new(), 0);
    loop {
        let part = reader.fill_buf()?;
        if part.is_empty() {
            return Ok((hex(&hasher.finalize()), bytes));
        }
        hasher.update(part);
        let length = part.len();
        bytes += length as u64;
        reader.consume(length);
    }
}

fn is_digest(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

fn hex(digest: &[u8]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const OPTIONS: &str = "+W320 +H180 +A0.1 +AM1 +R3";

    fn expected(folder: &Path, script: &str) -> Record {
        fs::write(folder.join("frame_0007.pov"), script).unwrap();
        let files = Files::read(&[]).unwrap();
        Record::expected(&folder.join("frame_0007.pov"), 7, &files, OPTIONS, "3.7.0.10.unofficial").unwrap()
    }

    #[test]
    fn a_record_is_seven_lines_and_reads_back() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join(HIDDEN_FOLDER)).unwrap();
        let image = folder.path().join("image.png");
        fs::write(&image, "twelve bytes").unwrap();
        let record = expected(folder.path(), "// frame 7\nabc\n").of_image(&image).unwrap();
        // The digest of the script was computed by `echo abc | sha256sum`.
        let text = "script edeaaff3f1774ad2888673770c6d64097e391bc362d7d6fb34982ddf0efd18cb\n\
                    files -\noptions +W320 +H180 +A0.1 +AM1 +R3\nframe -\npovray 3.7.0.10.unofficial\nbytes 12\n\
                    image d4ce2c527afe674c7a086bd74e256019e3d5dcdb31eeb6eaadef5ada8c4383b9\n";
        assert_eq!(record.to_text(), text);
        record.write(folder.path(), "frame_0007").unwrap();
        assert_eq!(Record::read(folder.path(), "frame_0007"), Some(record.clone()));
        assert_eq!(
            fs::read_dir(folder.path().join(HIDDEN_FOLDER)).unwrap().count(),
            1,
            "no temporary file is left"
        );
        let capitals = text.replace("image d4", "image Z4");
        for broken in ["", "script x\n", &text[..text.len() - 1], &format!("{text}more\n"), &capitals] {
            assert_eq!(Record::parse(broken), None, "{broken}");
        }
        // Earlier versions wrote records without the last line.
        let old = text.split_inclusive('\n').take(6).collect::<String>();
        assert_eq!(Record::parse(&old), Some(Record { image: None, ..record.clone() }));
        assert_eq!(Record::parse(&old).unwrap().to_text(), old);
        let numbered = Record { frame: Some(7), ..record };
        assert_eq!(Record::parse(&numbered.to_text()), Some(numbered));
    }

    #[test]
    fn the_first_line_is_of_no_account_and_all_others_are() {
        let folder = tempfile::tempdir().unwrap();
        let first = expected(folder.path(), "// frame 7\nabc\n");
        assert_eq!(expected(folder.path(), "// frame 8, t = 1 s\nabc\n"), first);
        assert_ne!(expected(folder.path(), "// frame 7\nabd\n").script, first.script);
        assert_ne!(expected(folder.path(), "// frame 7").script, first.script);
    }

    #[test]
    fn a_script_that_knows_its_number_is_no_other_frames() {
        let folder = tempfile::tempdir().unwrap();
        let frame = |script: &str| expected(folder.path(), &format!("// frame 7\n{script}\n")).frame;
        assert_eq!(frame("sphere { <clock, 0, 0>, 1 }"), Some(7));
        assert_eq!(frame("#if (frame_number>3)"), Some(7));
        assert_eq!(frame("clock"), Some(7));
        assert_eq!(frame("#declare Oclock = clocks + my_clock + clock_2; // oclock"), None);
        assert_eq!(frame("// five o'clocké"), Some(7), "once too often does no harm");
        fs::write(folder.path().join("common.inc"), "rotate y * clock").unwrap();
        fs::write(folder.path().join("photo.png"), "rotate y * clock").unwrap();
        let with = |names: &[&str], script: &str| {
            let files: Vec<_> = names.iter().map(|name| folder.path().join(name)).collect();
            fs::write(folder.path().join(script), "// frame 7\nframe_number\n").unwrap();
            let files = Files::read(&files).unwrap();
            Record::expected(&folder.path().join(script), 7, &files, OPTIONS, "3.7").unwrap()
        };
        assert_eq!(with(&[], "shutter_0007.pov").frame, None, "its number is that of a moment");
        fs::write(folder.path().join("frame_0007.pov"), "// frame 7\nabc\n").unwrap();
        let plain = |names: &[&str]| {
            let files: Vec<_> = names.iter().map(|name| folder.path().join(name)).collect();
            let files = Files::read(&files).unwrap();
            Record::expected(&folder.path().join("frame_0007.pov"), 7, &files, OPTIONS, "3.7").unwrap()
        };
        assert_eq!(plain(&["common.inc"]).frame, Some(7));
        assert_eq!(plain(&["photo.png"]).frame, None);
        assert_eq!(plain(&["photo.png"]).files, plain(&["common.inc"]).files);
        assert_ne!(plain(&["photo.png", "common.inc"]).files, plain(&["common.inc"]).files);
    }

    #[test]
    fn an_image_is_up_to_date_if_everything_is_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join(HIDDEN_FOLDER)).unwrap();
        let now = expected(folder.path(), "// frame 7\nabc\n");
        let state = |record: &Record, compare| record.state(folder.path(), "frame_0007", compare);
        assert_eq!(state(&now, Compare::All), State::Missing);
        fs::write(folder.path().join("frame_0007.png"), "an image").unwrap();
        assert_eq!(state(&now, Compare::Scene), State::Outdated, "there is no record");
        Record { bytes: 8, ..now.clone() }.write(folder.path(), "frame_0007").unwrap();
        assert_eq!(state(&now, Compare::All), State::UpToDate);

        let other = |change: &dyn Fn(&mut Record)| {
            let mut record = now.clone();
            change(&mut record);
            [Compare::All, Compare::NotPovray, Compare::Scene].map(|c| state(&record, c) == State::UpToDate)
        };
        assert_eq!(other(&|r| r.povray = "3.8".to_owned()), [false, true, true]);
        assert_eq!(other(&|r| r.options = "+A".to_owned()), [false, false, true]);
        assert_eq!(other(&|r| r.script = "0".to_owned()), [false, false, false]);
        assert_eq!(other(&|r| r.files = "0".to_owned()), [false, false, false]);
        assert_eq!(other(&|r| r.frame = Some(7)), [false, false, false]);

        fs::write(folder.path().join("frame_0007.png"), "an imag").unwrap();
        assert_eq!(state(&now, Compare::All), State::Outdated, "the image was cut off");
    }

    #[test]
    fn an_image_of_which_one_byte_has_changed_is_found_by_its_digest() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join(HIDDEN_FOLDER)).unwrap();
        let image = folder.path().join("frame_0007.png");
        fs::write(&image, "an image").unwrap();
        let now = expected(folder.path(), "// frame 7\nabc\n");
        let record = now.clone().of_image(&image).unwrap();
        record.write(folder.path(), "frame_0007").unwrap();
        assert_eq!(record.verify(&image).unwrap(), Verdict::Intact);
        fs::write(&image, "an imagE").unwrap();
        assert_eq!(now.state(folder.path(), "frame_0007", Compare::All), State::UpToDate, "it is not read");
        assert_eq!(record.verify(&image).unwrap(), Verdict::Changed);
        assert_eq!(Record { image: None, ..record }.verify(&image).unwrap(), Verdict::Unverified);
    }
}
