//! `jabuka status`: the state of the images.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::Duration;

use clap::ValueEnum;
use jabuka::diagnostic::{visible, visible_path};
use jabuka::render::Status;
use serde_json::json;

use super::{Failure, say};

/// Show which images are done, running, failed or missing
///
/// It reads the images, and asks no cluster. The exit code is 0 if all images are there, and 1 otherwise.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A folder that `jabuka batch` has written, or one with scripts and images
    folder: PathBuf,
    /// Show it again and again, until all images are there
    #[arg(long)]
    watch: bool,
    /// Read the images, too, and name those that have changed since they were rendered
    #[arg(long, conflicts_with = "watch")]
    verify: bool,
    /// How it is shown
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Text,
    /// For programs: an object; with --watch, one a line
    Json,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    /// The interval between two polls.
    const PAUSE: Duration = Duration::from_secs(2);
    // On a terminal, the new status replaces the old one.
    let redraw = std::io::stdout().is_terminal() && arguments.format == Format::Text;
    let mut shown = String::new();
    let read = if arguments.verify { Status::verified } else { Status::read };
    loop {
        let status = read(&arguments.folder).map_err(|error| {
            let (folder, why) = (visible_path(&arguments.folder), visible(&error.to_string()));
            say::error(&format!("error: the folder `{folder}`: {why}\n"));
            Failure::Errors
        })?;
        let text = match arguments.format {
            Format::Text => status.to_text(),
            Format::Json => json(&status, arguments.watch),
        };
        if text != shown {
            match arguments.format {
                Format::Json => say::json(&text),
                Format::Text if redraw => say::in_place_of(shown.lines().count(), &text),
                Format::Text => say::result(&text),
            }
            shown = text;
        }
        if status.is_complete() {
            return Ok(());
        }
        if !arguments.watch {
            return Err(Failure::Errors);
        }
        std::thread::sleep(PAUSE);
    }
}

fn json(status: &Status, one_line: bool) -> String {
    let mut object = json!({ "frames": status.frames.len(), "complete": status.is_complete() });
    if let (Some(object), Ok(serde_json::Value::Object(lists))) =
        (object.as_object_mut(), serde_json::to_value(status))
    {
        object.extend(lists);
    }
    if one_line { format!("{object}\n") } else { format!("{object:#}\n") }
}
