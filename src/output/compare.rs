//! Compares the scripts that a scene gives now with the scripts in a folder, as a snapshot test that every user can run.

use std::collections::HashSet;
use std::io;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use imara_diff::{Algorithm, Diff, Hunk, InternedInput};
use rayon::iter::{ParallelBridge, ParallelIterator};

use super::{OutputError, folder};
use crate::Run;
use crate::emit::{frame_name, shutter_name};
use crate::simulate::{Exposure, Selection};
use crate::system;

/// A difference between a script that the scene gives now and the script in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The number of the frame.
    pub frame: usize,
    /// The file name of the script.
    pub name: String,
    /// How the two scripts differ.
    pub kind: Kind,
}

/// How a script of the scene and a script in a folder differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The script is missing in the folder.
    Missing,
    /// The folder contains a script that the scene does not give.
    Extra,
    /// The folder contains the script with other lines. The list holds the lines that only one of the two scripts has.
    Lines(Vec<Line>),
}

/// A line that only one of two scripts has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// The number of the line in its script, from 1.
    pub number: usize,
    /// True for a line of the scene's script, false for a line of the script in the folder.
    pub new: bool,
    /// The text of the line, without the line break.
    pub text: String,
}

/// Compares the selected scripts of a run with those in a folder, and writes nothing. `done` is called after every frame.
///
/// # Errors
/// If the folder cannot be read, a value of the run becomes non-finite, or a script cannot be made.
pub fn compare(
    run: &Run<'_>,
    path: &Path,
    selection: &Selection,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Difference>, OutputError> {
    if !path.is_dir() {
        return Err(OutputError::NoFolder(path.to_owned()));
    }
    let frames = run.scene().simulation.timeline.frames();
    let trails = Mutex::new(HashSet::new());
    let check = |exposed| -> Result<Vec<Difference>, OutputError> {
        let exposure: Exposure = exposed?;
        let frame = &exposure.frame;
        let mut scripts = vec![(frame_name(frame.index, frames), run.script(frame)?)];
        let is_seen =
            |name: &str| !trails.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned());
        let files = run.emitter().trail_files(frame, &is_seen);
        scripts.extend(files.into_iter().map(|file| (file.name, file.text)));
        let blurred = run.shutter_script(&exposure)?;
        scripts.extend(blurred.map(|script| (shutter_name(frame.index, frames), script)));
        let mut found = Vec::new();
        for (name, script) in scripts {
            let kind = difference(&path.join(&name), &script)?;
            found.extend(kind.map(|kind| Difference { frame: frame.index, name, kind }));
        }
        done();
        Ok(found)
    };
    let found: Result<Vec<_>, _> = run.recorded().exposures(selection).par_bridge().map(check).collect();
    let mut found: Vec<Difference> = found?.into_iter().flatten().collect();
    if *selection == Selection::first(frames) {
        let scripts = folder::scripts(path)?.into_iter();
        let is_ours = |(frame, name): &(usize, String)| {
            let blurred = || run.shutter().is_some() && *name == shutter_name(*frame, frames);
            *frame < frames && (*name == frame_name(*frame, frames) || blurred())
        };
        let extra = scripts.filter(|script| !is_ours(script));
        found.extend(extra.map(|(frame, name)| Difference { frame, name, kind: Kind::Extra }));
    }
    found.sort_by(|a, b| (a.frame, &a.name).cmp(&(b.frame, &b.name)));
    Ok(found)
}

fn difference(path: &Path, new: &str) -> Result<Option<Kind>, OutputError> {
    let old = match system::read(path) {
        Ok(old) => old,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Some(Kind::Missing)),
        Err(error) => return Err(OutputError::Io(path.to_owned(), error)),
    };
    if old == new.as_bytes() {
        return Ok(None);
    }
    let old = String::from_utf8_lossy(&old);
    let lines = InternedInput::new(old.as_ref(), new);
    let mut diff = Diff::compute(Algorithm::Myers, &lines);
    diff.postprocess_lines(&lines);
    let line = |number: u32, new: bool| {
        let tokens = if new { &lines.after } else { &lines.before };
        let text = lines.interner[tokens[number as usize]].trim_end_matches(['\n', '\r']).to_owned();
        Line { number: number as usize + 1, new, text }
    };
    let hunk = |hunk: Hunk| {
        let old = hunk.before.map(|number| line(number, false));
        old.chain(hunk.after.map(|number| line(number, true))).collect::<Vec<_>>()
    };
    Ok(Some(Kind::Lines(diff.hunks().flat_map(hunk).collect())))
}

impl Difference {
    /// Returns the difference as text for a terminal: the frame, and each line before and after. It shows at most 20 lines.
    pub fn to_text(&self) -> String {
        const MOST_LINES: usize = 20;
        let Difference { frame, name, kind } = self;
        match kind {
            Kind::Missing => format!("frame {frame}: {name} is missing\n"),
            Kind::Extra => format!("frame {frame}: {name} is not a script of this scene\n"),
            Kind::Lines(lines) => {
                let mut text = format!("frame {frame}: {name} differs\n");
                for line in lines.iter().take(MOST_LINES) {
                    let which = if line.new { "new" } else { "old" };
                    let shown = crate::emit::comment(&line.text);
                    text.push_str(&format!("  line {:>4} {which} | {shown}\n", line.number));
                }
                if lines.len() > MOST_LINES {
                    text.push_str(&format!("  … and {} more lines\n", lines.len() - MOST_LINES));
                }
                text
            }
        }
    }
}
