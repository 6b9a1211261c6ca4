//! Shows the frames of a scene on a page in the browser, while the user edits the scene.
//!
//! | what | where |
//! | --- | --- |
//! | the last run without errors, and the current errors of the scene | `session` |
//! | the detection of changes in the scene's files | `watch` |
//! | a run that is simulated in the background | `run` |
//! | a panic of a thread, as an error on the page | `panicked` |
//! | the data of a run for the page | `describe`, `shown`, `swarms`, `samples` |
//! | the encoding of frames as bytes | `numbers` |
//! | the server, its connections, its access control, and its errors | `routes`, `connections`, `access`, `failed` |
//! | a frame rendered by POV-Ray | `render` |
//! | the page itself | `page`, and the files in the folder of that name |
//!
//! # Reading and running
//!
//! The page is part of the program (`page/`: plain modules, WebGL2, no library, no build step).
//!
//! - A thread reads the scene again whenever the size, time or inode of one of its files changes (`watch`), including files that do not
//!   exist yet. It polls the files, because the system's notifications do not work over networks, and miss editors that replace a file. A
//!   valid scene becomes the current run (`session`). For an invalid scene, the page shows the errors and keeps the last valid run. A panic
//!   while a scene is read, reported or run becomes an error on the page, and the next version is read.
//! - A thread records a run (`run`), or the run comes from the cache. A recording can be read while it grows. So going back needs no new
//!   simulation, and memory does not grow. For each frame, `picture` gives all objects besides the bodies, as for scripts.
//! - Particles are computed when the page requests them (`swarms`), from the bodies of the recorded frames. If there are too many, only
//!   every n-th is sent.
//!
//! # The page
//!
//! - Each run has a unique number. The page requests the frames of a run in pieces of at most 2 MB, and keeps 256 MB of them. If the run has
//!   been replaced, the answer is 404, and the page continues with the run that the server has announced. All that the page remembers of a
//!   picture belongs to the object of its run, so nothing of an earlier run is drawn.
//! - The page draws the triangles from `surface`, with the poses in a texture, so a frame costs one upload of numbers. The shaders compute
//!   in 32 bits, with the size of the scene as unit of length and its center as origin; the simulation uses 64 bits. If there are many
//!   balls, each is drawn as a square that faces the camera.
//! - While paused, the page draws a frame once all of it has arrived; while playing, it interpolates places and orientations.
//!
//! # Connections and access
//!
//! A request must arrive within 5 s, and at most 128 connections are open. axum's own server has no such limits. The server listens on
//! 127.0.0.1, where any web page in the user's browser can send requests. So the host must be a name of this machine, the origin must be
//! this host, and everything except the empty page needs a token that is new at each start (`access`). A content security policy limits the
//! page to its own files and this server. The page inserts the texts of a scene as text, never as HTML.
//!
//! # Dependencies
//!
//! The feature `preview`, which is on by default, brings axum and tokio; nothing else needs them. hyper holds the connections; axum uses it,
//! too. getrandom makes the token.

mod access;
mod connections;
mod describe;
mod failed;
mod numbers;
mod page;
mod panicked;
mod render;
mod routes;
mod run;
mod samples;
mod session;
mod shown;
mod swarms;
mod watch;

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use tokio::net::TcpListener;

use self::access::Token;
use self::render::Renderer;
use self::routes::Server;
use self::session::Session;
use crate::cache::Cache;
use crate::diagnostic::Report;
use crate::sandbox::{Confinement, Launcher};
use crate::scene::Options;

/// The scene to preview, and the settings of the preview.
#[derive(Clone, Debug)]
pub struct Preview {
    /// The path of the scene's file.
    pub scene: PathBuf,
    /// The options for reading the scene.
    pub options: Options,
    /// The cache that keeps runs between commands.
    pub cache: Cache,
    /// The port of the server. `None` for any free port.
    pub port: Option<u16>,
    /// The path of the POV-Ray program. `None` for `povray` in the `PATH`.
    pub povray: Option<PathBuf>,
    /// The launcher that confines POV-Ray to its files. With `None`, POV-Ray is not confined.
    pub launcher: Option<Launcher>,
}

impl Preview {
    /// Serves the page on the loopback address until `stop` is set. `listening` receives the address of the page. `said` receives the
    /// report on the scene whenever the report changes.
    ///
    /// # Errors
    /// If the port is in use, or the system refuses to open it.
    pub fn serve(
        self,
        stop: &'static AtomicBool,
        listening: impl FnOnce(&str),
        said: impl Fn(&Report) + Send + Sync + 'static,
    ) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build()?;
        let address = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), self.port.unwrap_or(0));
        let listener = runtime.block_on(TcpListener::bind(address))?;
        let (address, token) = (listener.local_addr()?, Token::new()?);
        let mut confinement = Confinement::new(self.launcher);
        if self.options.trust {
            confinement = confinement.trusting(Some(&self.scene), &[]);
        }
        let session = Session::new(self.scene, self.options, self.cache, said);
        let renderer = Arc::new(Renderer::new(self.povray, confinement));
        let server = Server { session: Arc::clone(&session), renderer: Arc::clone(&renderer), token };
        listening(&format!("http://{address}/?token={}", server.token.as_str()));
        // This thread ends with the process, so a scene that takes long to read does not delay the end.
        thread::Builder::new().name("scene".to_owned()).spawn(move || session.follow(stop))?;
        runtime.block_on(async {
            tokio::select! {
                never = connections::serve(listener, routes::router(server)) => match never {},
                () = until(stop) => {}
            }
        });
        stop.store(true, Ordering::Relaxed);
        renderer.end();
        // Open connections lose no data when they are closed.
        runtime.shutdown_timeout(Duration::from_secs(1));
        Ok(())
    }
}

async fn until(stop: &AtomicBool) {
    /// The interval between two checks of the flag `stop`.
    const POLL_INTERVAL: Duration = Duration::from_millis(50);
    while !stop.load(Ordering::Relaxed) {
        tokio::time::sleep(POLL_INTERVAL).await;
    }
}
