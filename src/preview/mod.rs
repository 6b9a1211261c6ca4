//! Shows the frames of a scene on a page in the browser, while the user edits the scene.
//!
//! | what | where |
//! | --- | --- |
//! | the detection of changes in the scene's files | `watch`, `follow` |
//! | the scene, runs and recordings, for the page's session | `host` |
//! | the server, its connections, its access control, and its answers | `routes`, `connections`, `access`, `responses` |
//! | a frame rendered by POV-Ray | `render` |
//! | the text of the scene, which the page edits | `text` |
//!
//! The page itself, and the data that it shows, are in `page`.
//!
//! # Reading and running
//!
//! - A thread reads the scene again whenever the size, time or inode of one of its files changes (`watch`), including files that do not
//!   exist yet. It polls the files, because the system's notifications do not work over networks, and miss editors that replace a file. A
//!   valid scene becomes the current run of the session. For an invalid scene, the page shows the errors and keeps the last valid run. A
//!   panic while a scene is read, reported or run becomes an error on the page, and the next version is read.
//! - A thread records a run (`host`), or the run comes from the cache. A recording can be read while it grows. Pages beyond the first
//!   megabyte are in a file, so memory does not grow.
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
mod follow;
mod host;
mod render;
mod responses;
mod routes;
mod text;
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
use self::follow::follow;
use self::host::ServerHost;
use self::render::Renderer;
use self::routes::Server;
use self::text::SceneFile;
use crate::cache::Cache;
use crate::diagnostic::Report;
use crate::page::Session;
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
    /// True if the page may not change the file of the scene.
    pub read_only: bool,
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
        let host = ServerHost::new(self.scene.clone(), self.cache, said);
        let session = Arc::new(Session::new(self.options, Arc::<ServerHost>::clone(&host)));
        let renderer = Arc::new(Renderer::new(self.povray, confinement));
        let file = (!self.read_only).then(|| Arc::new(SceneFile::new(self.scene.clone())));
        let server =
            Server { session: Arc::clone(&session), host, renderer: Arc::clone(&renderer), file, token };
        listening(&format!("http://{address}/?token={}", server.token.as_str()));
        // This thread ends with the process, so a scene that takes long to read does not delay the end.
        thread::Builder::new().name("scene".to_owned()).spawn(move || follow(&session, &self.scene, stop))?;
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
