//! jabuka in a browser: a session of a scene in a Web Worker, which answers the requests of the page.
//!
//! The worker's script (`web/worker.js`) puts the files of a scene into a virtual folder, and calls the functions of this module. A request
//! and its answer are bytes in the memory of the module:
//!
//! 1. [`room`] returns the address where the script writes the request: JSON with the fields of `Request`.
//! 2. [`ask`] answers it, and returns a status of HTTP.
//! 3. [`answer`] and [`answer_length`] tell where the answer is. It stays there until the next request.
//!
//! Before the first request, the script writes two font files to the address of [`room`], and calls [`take_fonts`]. The module contains no
//! fonts itself, because the page downloads these files for its own texts.
//!
//! Between requests, the script calls [`advance`], which simulates for some milliseconds.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use jabuka::Scene;
use jabuka::diagnostic::Report;
use jabuka::page::{Answer, Failed, Frames, Host, PageRun, RunWork, Session, Variant};
use jabuka::scene::{Options, grammar};
use serde::Deserialize;

/// A request of the page. Its path is `/api/state`, `/api/schema`, `/api/variants`, or one that [`jabuka::page::answer`] knows.
#[derive(Deserialize)]
struct Request {
    path: String,
    /// The parameters of a request for frames of a run.
    #[serde(default)]
    frames: Frames,
    /// What to run, for a request for a variant of the run.
    variant: Option<Variant>,
    /// The path of the scene in the virtual folder, for a request to read it.
    scene: Option<String>,
}

/// What the worker knows.
#[derive(Default)]
struct Worker {
    session: Option<Session>,
    host: Arc<WorkerHost>,
    /// The work of the runs that have not ended, in the order in which they were started.
    works: VecDeque<RunWork>,
    request: Vec<u8>,
    answer: Vec<u8>,
}

/// The host of the worker's session.
#[derive(Default)]
struct WorkerHost {
    scene: Mutex<PathBuf>,
    /// The runs that were started, and whose work has not begun.
    started: Mutex<Vec<Arc<PageRun>>>,
}

impl Host for WorkerHost {
    fn read(&self, options: &Options) -> Result<Scene, Report> {
        let path = self.scene.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Scene::from_path_with(&path, options)
    }

    fn start(&self, run: Arc<PageRun>) -> io::Result<()> {
        self.started.lock().unwrap_or_else(PoisonError::into_inner).push(run);
        Ok(())
    }

    fn changed(&self) {}

    fn report(&self, _report: &Report) {}
}

impl Worker {
    fn respond(&mut self) -> Result<Answer, Failed> {
        let request: Request =
            serde_json::from_slice(&self.request).map_err(|error| Failed::Io(error.into()))?;
        if let Some(scene) = request.scene {
            *self.host.scene.lock().unwrap_or_else(PoisonError::into_inner) = PathBuf::from(scene);
            let host = Arc::clone(&self.host);
            self.session.get_or_insert_with(|| Session::new(Options::default(), host)).read();
            self.fetch_started();
        }
        if request.path == "/api/schema" {
            return Answer::json(&grammar::schema());
        }
        let session = self.session.as_ref().ok_or(Failed::Gone)?;
        match (request.path.as_str(), &request.variant) {
            ("/api/state", _) => Answer::json(&session.state()),
            ("/api/variants", Some(variant)) => {
                let progress = session.variant(variant.clone())?.progress();
                self.fetch_started();
                Answer::json(&progress)
            }
            (path, _) => jabuka::page::answer(session, path, &request.frames),
        }
    }

    fn fetch_started(&mut self) {
        let mut started = self.host.started.lock().unwrap_or_else(PoisonError::into_inner);
        self.works.extend(started.drain(..).map(|run| run.work()));
    }

    fn advance(&mut self, time: Duration) -> bool {
        let begun = Instant::now();
        while let Some(work) = self.works.front_mut() {
            if !work.advance() {
                self.works.pop_front();
            }
            if begun.elapsed() >= time {
                break;
            }
        }
        !self.works.is_empty()
    }
}

thread_local! {
    static WORKER: RefCell<Worker> = RefCell::default();
}

/// Makes room for a request of `length` bytes, and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *mut u8 {
    WORKER.with_borrow_mut(|worker| {
        worker.request = vec![0; length];
        worker.request.as_mut_ptr()
    })
}

/// Takes two files from the place of the request: DejaVu Sans, of `length` bytes, and after it DejaVu Sans Bold.
#[unsafe(no_mangle)]
pub extern "C" fn take_fonts(length: usize) {
    WORKER.with_borrow_mut(|worker| {
        let mut regular = std::mem::take(&mut worker.request);
        let bold = regular.split_off(length.min(regular.len()));
        jabuka::font::give([regular, bold]);
    });
}

/// Answers the request, and returns its status: 200, or the status of HTTP that fits the error.
#[unsafe(no_mangle)]
pub extern "C" fn ask() -> u32 {
    WORKER.with_borrow_mut(|worker| {
        let (status, answer) = match worker.respond() {
            Ok(answer) => (200, answer.into_bytes()),
            Err(failed) => (failed.status(), failed.message().into_bytes()),
        };
        worker.answer = answer;
        u32::from(status)
    })
}

/// Returns the address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    WORKER.with_borrow(|worker| worker.answer.as_ptr())
}

/// Returns the length of the answer, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn answer_length() -> usize {
    WORKER.with_borrow(|worker| worker.answer.len())
}

/// Simulates for about `milliseconds`. Returns 1 if there is more to simulate, otherwise 0.
#[unsafe(no_mangle)]
pub extern "C" fn advance(milliseconds: f64) -> u32 {
    let time = Duration::from_secs_f64(milliseconds.max(0.0) / 1e3);
    WORKER.with_borrow_mut(|worker| u32::from(worker.advance(time)))
}
