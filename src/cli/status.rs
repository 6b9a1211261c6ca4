//! The command `jabuka status`: shows how many images of a folder are rendered.

use std::path::PathBuf;
use std::time::Duration;

use crate::diagnostic::{visible, visible_path};
use crate::render::Status;
use clap::ValueEnum;
use serde_json::json;

use super::{Failure, terminal};

/// Show which images are done, running, failed or missing
///
/// The command reads the folder of images, and does not contact the cluster. The exit code is 0 if all images are done, and 1 otherwise.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A folder written by `jabuka batch`, or a folder with scripts and images
    folder: PathBuf,
    /// Repeat until all images are done
    #[arg(long)]
    watch: bool,
    /// Also check the content of the images, and list those that have changed since they were rendered
    #[arg(long, conflicts_with = "watch")]
    verify: bool,
    /// The format of the status
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Text for people
    Text,
    /// JSON for programs: an object; with --watch, one object per line
    Json,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    /// The interval at which `--watch` reads the status again.
    const POLL_INTERVAL: Duration = Duration::from_secs(2);
    // On a terminal, each new status replaces the previous one.
    let redraw = terminal::is_interactive() && arguments.format == Format::Text;
    let mut shown = String::new();
    let read = if arguments.verify { Status::verified } else { Status::read };
    loop {
        let status = read(&arguments.folder).map_err(|error| {
            let (folder, why) = (visible_path(&arguments.folder), visible(&error.to_string()));
            terminal::error(&format!("error: the folder `{folder}`: {why}\n"));
            Failure::Errors
        })?;
        let text = match arguments.format {
            Format::Text => status.to_text(),
            Format::Json => json(&status, arguments.watch),
        };
        if text != shown {
            match arguments.format {
                Format::Json => terminal::json(&text),
                Format::Text if redraw => terminal::in_place_of(shown.lines().count(), &text),
                Format::Text => terminal::result(&text),
            }
            shown = text;
        }
        if status.is_complete() {
            return Ok(());
        }
        if !arguments.watch || terminal::is_lost() {
            return Err(Failure::Errors);
        }
        std::thread::sleep(POLL_INTERVAL);
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
