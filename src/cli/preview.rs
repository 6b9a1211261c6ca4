//! The command `jabuka preview`: shows a scene in the browser and updates it when the file changes.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use crate::preview::Preview;
use crate::sandbox::Launcher;

use super::scene_arguments::SceneArguments;
use super::{Failure, interrupt, terminal};

/// Show a scene in the browser while you edit it
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The port on 127.0.0.1 for the page [default: any free port]
    #[arg(long, value_name = "N")]
    port: Option<u16>,
    /// Print the address of the page, and do not open the browser
    #[arg(long)]
    no_open: bool,
    /// Do not let the page change the scene file
    #[arg(long)]
    read_only: bool,
    #[command(flatten)]
    of_scene: SceneArguments,
    /// The path of the POV-Ray program, which renders single frames [default: povray]
    #[arg(long, value_name = "PATH")]
    povray: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let stop = interrupt::watched();
    // A scene with errors can be corrected during the preview. A missing file probably means a mistyped name, so it is an error.
    if !arguments.scene.is_file() {
        arguments.of_scene.read_with(&arguments.scene, &[])?;
    }
    let preview = Preview {
        scene: arguments.scene.clone(),
        options: arguments.of_scene.options(&[]),
        cache: arguments.of_scene.cache()?,
        port: arguments.port,
        povray: arguments.povray.clone(),
        read_only: arguments.read_only,
        launcher: Launcher::of_this_program(),
    };
    let listening = |address: &str| {
        terminal::result(&format!("{address}\n"));
        if terminal::is_lost() {
            // Without the address, nobody can open the page.
            stop.store(true, Ordering::Relaxed);
            return;
        }
        terminal::error("Ctrl-C ends it.\n");
        if !arguments.no_open {
            // If the browser cannot be opened, the user can still open the printed address.
            if let Err(error) = open::that_detached(address) {
                terminal::error(&format!("no browser could be opened: {error}\n"));
            }
        }
    };
    let served = preview.serve(stop, listening, terminal::report);
    served.map_err(|error| {
        let port = arguments.port.map_or(String::new(), |port| format!(" on port {port}"));
        terminal::error(&format!("error: the page cannot be served{port}: {error}\n"));
        Failure::Errors
    })?;
    if terminal::is_lost() {
        return Err(Failure::Errors);
    }
    // The preview runs until the user interrupts it.
    Err(Failure::Interrupted)
}
