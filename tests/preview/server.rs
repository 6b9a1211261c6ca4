//! A running preview of a scene in a temporary folder.

use std::fs::{self, File};
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::http::get;
use crate::support::{self, jabuka, root, scene};

/// A temporary folder with a scene and its files. `jabuka` runs in it, so that it writes nothing elsewhere.
pub(crate) struct Scene {
    folder: tempfile::TempDir,
    pub(crate) name: String,
    arguments: Vec<String>,
}

/// A running preview. Dropping it ends the process.
pub(crate) struct Server {
    pub(crate) scene: Scene,
    child: Child,
    /// The address that the preview has printed, with the token.
    pub(crate) address: String,
}

impl Scene {
    /// Makes a folder whose `scene.toml` has this text.
    pub(crate) fn of(text: &str) -> Scene {
        Scene { name: "scene".to_owned(), ..Scene::in_folder() }.with("scene.toml", text)
    }

    /// Makes a folder with a copy of a scene of the gallery and all meshes.
    pub(crate) fn gallery(name: &str) -> Scene {
        let text = fs::read_to_string(scene(name)).unwrap();
        let copy = Scene { name: name.to_owned(), ..Scene::in_folder() }.with(&format!("{name}.toml"), &text);
        fs::read_dir(root().join("scenes/meshes")).unwrap().fold(copy, |copy, mesh| {
            let path = mesh.unwrap().path();
            let name = format!("meshes/{}", path.file_name().unwrap().to_str().unwrap());
            copy.with(&name, fs::read(path).unwrap())
        })
    }

    fn in_folder() -> Scene {
        Scene { folder: tempfile::tempdir().unwrap(), name: String::new(), arguments: Vec::new() }
    }

    /// Adds another file to the folder.
    pub(crate) fn with(self, name: &str, contents: impl AsRef<[u8]>) -> Scene {
        let path = self.folder().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, contents).unwrap();
        self
    }

    /// Adds arguments for `jabuka preview`.
    pub(crate) fn previewed_with(mut self, arguments: &[&str]) -> Scene {
        self.arguments.extend(arguments.iter().map(|&argument| argument.to_owned()));
        self
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Returns the path of the scene's file.
    pub(crate) fn path(&self) -> PathBuf {
        self.folder().join(&self.name).with_extension("toml")
    }

    /// Returns a command that runs `jabuka` in the folder.
    pub(crate) fn jabuka(&self, arguments: &[&str]) -> Command {
        let mut command = jabuka();
        command.current_dir(self.folder()).args(arguments);
        command
    }

    /// Starts the preview.
    pub(crate) fn served(self) -> Server {
        let said = File::create(self.folder().join("stderr")).unwrap();
        // A test runner in the background may make its children ignore SIGINT, so reset it to its default.
        let mut command = Command::new("env");
        command.arg("--default-signal=INT").arg(env!("CARGO_BIN_EXE_jabuka"));
        command.arg("preview").arg(self.path()).arg("--no-open").args(&self.arguments);
        command.env("JABUKA_CACHE_SIZE", "0");
        command.current_dir(self.folder()).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(said);
        let mut child = command.spawn().unwrap();
        let mut address = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
        let server = Server { scene: self, child, address: address.trim().to_owned() };
        assert!(server.address.starts_with("http://127.0.0.1:"), "{:?}: {}", address, server.said());
        server
    }
}

/// Waits until `is_so` returns true.
///
/// # Panics
/// After two minutes.
pub(crate) fn wait_until(what: &str, is_so: impl Fn() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(120), "waited in vain for {what}");
        thread::sleep(Duration::from_millis(2));
    }
}

impl Server {
    /// Waits until the first run of the scene has begun.
    pub(crate) fn wait_for_the_run(&self) {
        wait_until("the first run", || {
            get(self.port(), &format!("/api/runs/1?token={}", self.token())).status == 200
        });
    }

    /// Returns the port from the printed address.
    pub(crate) fn port(&self) -> u16 {
        let host = self.address.strip_prefix("http://127.0.0.1:").unwrap();
        host.split('/').next().unwrap().parse().unwrap()
    }

    /// Returns the token from the printed address. Without it, the server reveals nothing of the scene.
    pub(crate) fn token(&self) -> &str {
        self.address.split_once("token=").unwrap().1
    }

    /// Returns all that the preview has written to standard error.
    pub(crate) fn said(&self) -> String {
        fs::read_to_string(self.scene.folder().join("stderr")).unwrap()
    }

    /// Returns the process ID of the preview.
    pub(crate) fn process(&self) -> u32 {
        self.child.id()
    }

    /// Sends the preview a signal by its name, and waits for its end. Returns its exit status.
    pub(crate) fn ended_by(mut self, signal: &str) -> ExitStatus {
        support::signal(signal, self.process());
        self.child.wait().unwrap()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Killing fails if the preview has already ended, which does no harm.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
