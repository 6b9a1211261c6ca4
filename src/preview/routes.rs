//! The routes of the server.
//!
//! | path | answer |
//! | --- | --- |
//! | `/` and the files beside it | the page, which contains nothing of the scene |
//! | `/api/events` | the [`State`](crate::page::State), whenever it changes |
//! | `/api/runs/N/poses?from=A&to=B` | the poses of its bodies in some frames; each frame is sent as soon as it is simulated |
//! | other paths that begin with `/api/runs/` | what [`answer_of_run`] answers |
//! | `/api/text` | the text of the scene's file |
//! | `/api/save` | replaces the text |
//! | `/api/schema` | the keys of scenes, for the editor |
//! | `/api/variables` | gives a variable with a slider another value |
//! | `/api/variants` | starts a run with another integration method |
//! | `/api/render` | a frame rendered by POV-Ray |

use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::extract::{Path, Query, Request, State};
use axum::http::header::{self, HeaderValue};
use axum::http::{HeaderName, StatusCode};
use axum::middleware::{self, Next};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use serde::Deserialize;
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;
use tokio_stream::{Stream, StreamExt as _};

use super::access::{self, Refused, Token};
use super::connections;
use super::host::ServerHost;
use super::render::{Renderer, Wanted};
use super::text::{NewText, SceneFile};
use crate::page::{Answer, FILES, Failed, Frames, PageRun, RunId, Session, Variant, answer_of_run, poses};
use crate::scene::grammar;

/// The data that the server answers requests from.
#[derive(Clone)]
pub(super) struct Server {
    pub(super) session: Arc<Session>,
    pub(super) host: Arc<ServerHost>,
    pub(super) renderer: Arc<Renderer>,
    /// The file of the scene, if the page may change it.
    pub(super) file: Option<Arc<SceneFile>>,
    pub(super) token: Token,
}

/// The content security policy of the page: it can load its own files and send requests to this server, nothing else.
const CONTENT_SECURITY_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; \
    img-src 'self' blob: data:; font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The headers that the server adds to its responses. They restrict what a browser does with a response.
const SECURITY_HEADERS: [(HeaderName, &str); 6] = [
    (header::CONTENT_SECURITY_POLICY, CONTENT_SECURITY_POLICY),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
    (header::X_FRAME_OPTIONS, "DENY"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// Makes the router, which calls a function for each path.
pub(super) fn router(server: Server) -> Router {
    let api = Router::new()
        .route("/api/events", get(events))
        .route("/api/runs/{id}", get(description))
        .route("/api/runs/{id}/poses", get(poses_of_run))
        .route("/api/runs/{id}/{what}", get(of_run))
        .route("/api/text", get(text))
        .route("/api/save", post(save))
        .route("/api/schema", get(schema))
        .route("/api/variants", post(variant))
        .route("/api/render", post(render))
        .route("/api/variables", post(variable))
        .route_layer(middleware::from_fn_with_state(server.clone(), with_token));
    let page = FILES.iter().fold(Router::new(), |router, (path, kind, content)| {
        router.route(path, get(move || async move { ([(header::CONTENT_TYPE, *kind)], *content) }))
    });
    let all = api.merge(page).layer(middleware::from_fn(connections::with_whole_body));
    all.layer(middleware::from_fn(guarded)).with_state(server)
}

/// Refuses requests from other pages, and adds the security headers to each answer.
async fn guarded(request: Request, next: Next) -> Response {
    let mut response = match access::is_own(request.headers()) {
        Ok(()) => next.run(request).await,
        Err(refused) => refused.into_response(),
    };
    for (name, value) in SECURITY_HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

async fn with_token(State(server): State<Server>, request: Request, next: Next) -> Response {
    match server.token.admits(request.uri()) {
        Ok(()) => next.run(request).await,
        Err(refused) => refused.into_response(),
    }
}

impl IntoResponse for Refused {
    fn into_response(self) -> Response {
        (StatusCode::FORBIDDEN, self.message()).into_response()
    }
}

impl Server {
    fn run(&self, id: RunId) -> Result<Arc<PageRun>, Failed> {
        self.session.run(id).ok_or(Failed::Gone)
    }

    async fn answer(self, id: RunId, what: String, frames: Frames) -> Result<Answer, Failed> {
        let run = self.run(id)?;
        blocking(move || answer_of_run(&run, &what, &frames)).await
    }
}

async fn events(
    State(server): State<Server>,
) -> Sse<impl Stream<Item = Result<Event, std::convert::Infallible>>> {
    /// The smallest interval between two events that the server sends to the page.
    const MIN_EVENT_INTERVAL: Duration = Duration::from_millis(30);
    let (sender, receiver) = mpsc::channel(1);
    tokio::spawn(async move {
        let mut pulse = server.host.pulse();
        let mut last = None;
        while !sender.is_closed() {
            let mut state = server.session.state();
            if server.file.is_none() {
                state.text = None;
            }
            if last.as_ref() != Some(&state) {
                let Ok(event) = Event::default().json_data(&state) else { return };
                if sender.send(event).await.is_err() {
                    return;
                }
                last = Some(state);
            }
            tokio::select! {
                changed = pulse.changed() => if changed.is_err() { return },
                () = sender.closed() => return,
            }
            tokio::time::sleep(MIN_EVENT_INTERVAL).await;
        }
    });
    Sse::new(ReceiverStream::new(receiver).map(Ok)).keep_alive(KeepAlive::default())
}

async fn description(
    State(server): State<Server>,
    Path(id): Path<RunId>,
    Query(frames): Query<Frames>,
) -> Result<Answer, Failed> {
    server.answer(id, String::new(), frames).await
}

async fn of_run(
    State(server): State<Server>,
    Path((id, what)): Path<(RunId, String)>,
    Query(frames): Query<Frames>,
) -> Result<Answer, Failed> {
    server.answer(id, what, frames).await
}

/// Sends the poses of frames in order, each as soon as it is simulated.
async fn poses_of_run(
    State(server): State<Server>,
    Path(id): Path<RunId>,
    Query(frames): Query<Frames>,
) -> Result<Response, Failed> {
    /// The largest size of frames that are sent together, bytes. A larger frame is sent alone.
    const MAX_BATCH_BYTES: usize = 1 << 16;
    /// The size of a pose, bytes: three numbers for the location, four for the orientation.
    const BYTES_PER_POSE: usize = 7 * size_of::<f64>();
    /// The interval between two checks for new frames.
    const POLL_INTERVAL: Duration = Duration::from_millis(4);
    let run = server.run(id)?;
    let (sender, receiver) = mpsc::channel::<std::io::Result<Bytes>>(2);
    tokio::spawn(async move {
        let (mut frame, end, bodies) = (frames.from, frames.end(&run), run.scene.bodies.len());
        // One reader serves all frames: it continues from its position, whereas a new reader starts at the beginning of a page.
        let mut reader = None;
        while frame < end && !sender.is_closed() {
            let (is_over, recorded) = (run.outcome().is_some(), run.recorded().min(end));
            if frame >= recorded {
                if is_over {
                    return;
                }
                tokio::time::sleep(POLL_INTERVAL).await;
                continue;
            }
            let many = (MAX_BATCH_BYTES / (BYTES_PER_POSE * bodies).max(1)).max(1);
            let until = recorded.min(frame + many);
            let mut mine = reader.take().unwrap_or_else(|| run.recording().read());
            let read = tokio::task::spawn_blocking(move || {
                let bytes = poses(&mut mine, bodies, frame..until).map(Bytes::from);
                (bytes, mine)
            });
            let bytes = match read.await {
                Ok((bytes, mine)) => {
                    reader = Some(mine);
                    bytes
                }
                Err(error) => Err(std::io::Error::other(error)),
            };
            if sender.send(bytes).await.is_err() {
                return;
            }
            frame = until;
        }
    });
    Ok(binary(Body::from_stream(ReceiverStream::new(receiver))))
}

async fn text(State(server): State<Server>) -> Result<Response, Failed> {
    let file = server.file.ok_or(Failed::Gone)?;
    blocking(move || Ok(Json(file.read()?).into_response())).await
}

async fn save(State(server): State<Server>, Json(new): Json<NewText>) -> Result<Response, Failed> {
    let file = server.file.ok_or(Failed::Gone)?;
    blocking(move || {
        let version = file.write(&new)?;
        // The thread that follows the files would notice the change, too, but later.
        server.session.read();
        Ok(Json(version).into_response())
    })
    .await
}

async fn schema() -> Result<Answer, Failed> {
    blocking(|| Answer::json(&grammar::schema())).await
}

async fn variant(State(server): State<Server>, Json(variant): Json<Variant>) -> Result<Response, Failed> {
    blocking(move || Ok(Json(server.session.variant(variant)?.progress()).into_response())).await
}

/// The value that a slider gives to a variable.
#[derive(Deserialize)]
struct Setting {
    variable: String,
    value: f64,
}

async fn variable(State(server): State<Server>, Json(setting): Json<Setting>) -> Result<(), Failed> {
    blocking(move || Ok(server.session.set_variable(&setting.variable, setting.value)?)).await
}

async fn render(State(server): State<Server>, Json(wanted): Json<Wanted>) -> Result<Response, Failed> {
    let run = server.run(wanted.run())?;
    // When the client closes the connection, this future and its `wish` are dropped, which stops the rendering.
    let wish = server.renderer.wish();
    let stop = wish.stop();
    let image = blocking(move || server.renderer.render(&run, &wanted, &stop)).await?;
    drop(wish);
    Ok(([(header::CONTENT_TYPE, "image/png")], image).into_response())
}

fn binary(body: Body) -> Response {
    ([(header::CONTENT_TYPE, "application/octet-stream")], body).into_response()
}

/// Runs slow work on another thread, so that it does not delay other requests.
async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Failed> + Send + 'static,
) -> Result<T, Failed> {
    let done = tokio::task::spawn_blocking(work).await;
    done.unwrap_or_else(|error| Err(Failed::Io(std::io::Error::other(error))))
}
