//! `jabuka preview`: scene → a page in the browser.

use std::path::PathBuf;

use jabuka::preview::Preview;
use jabuka::sandbox::Launcher;

use super::scene_arguments::SceneArguments;
use super::{Failure, interrupt, say};

/// Show a scene in the browser while you write it
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The port on 127.0.0.1 [default: any that is free]
    #[arg(long, value_name = "N")]
    port: Option<u16>,
    /// Print the address, and leave the browser alone
    #[arg(long)]
    no_open: bool,
    #[command(flatten)]
    of_scene: SceneArguments,
    /// The program POV-Ray, which renders single frames [default: povray]
    #[arg(long, value_name = "PATH")]
    povray: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let stop = interrupt::watched();
    // The user can fix a scene with mistakes during the preview; a missing file means a mistyped name.
    if !arguments.scene.is_file() {
        arguments.of_scene.read_with(&arguments.scene, &[])?;
    }
    let preview = Preview {
        scene: arguments.scene.clone(),
        options: arguments.of_scene.options(&[]),
        cache: arguments.of_scene.cache()?,
        port: arguments.port,
        povray: arguments.povray.clone(),
        launcher: Launcher::of_this_program(),
    };
    let listening = |address: &str| {
        say::result(&format!("{address}\n"));
        say::error("Ctrl-C ends it.\n");
        if !arguments.no_open {
            // Without a browser, the user still has the address.
            if let Err(error) = open::that_detached(address) {
                say::error(&format!("no browser could be opened: {error}\n"));
            }
        }
    };
    let served = preview.serve(stop, listening, say::report);
    served.map_err(|error| {
        let port = arguments.port.map_or(String::new(), |port| format!(" on port {port}"));
        say::error(&format!("error: the page cannot be served{port}: {error}\n"));
        Failure::Errors
    })?;
    // Only an interrupt ends the preview.
    Err(Failure::Interrupted)
}
