//! Accepts connections, and closes those whose requests are not sent to their end.

use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::extract::Request;
use axum::http::StatusCode;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// The time in which a client must send the head of a request. It has the same time again for the body. Clients are on this machine, so
/// they need milliseconds.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(5);

/// The largest number of simultaneous connections. A page has six at most.
const MAX_CONNECTIONS: usize = 128;

/// The largest size of a request's body, bytes: that of the text of a large scene.
const MAX_BODY_BYTES: usize = 1 << 20;

/// Answers the requests of all connections. Never returns.
pub(super) async fn serve(listener: TcpListener, router: Router) -> Infallible {
    /// The pause before the next attempt to accept a connection, if the system had too little memory or too few file descriptors.
    const RETRY_DELAY: Duration = Duration::from_millis(200);
    let free = Arc::new(Semaphore::new(MAX_CONNECTIONS));
    loop {
        // If there are too many connections, the next one waits until one of them ends.
        let place = Arc::clone(&free).acquire_owned().await;
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            Err(_) => {
                tokio::time::sleep(RETRY_DELAY).await;
                continue;
            }
        };
        let router = router.clone();
        tokio::spawn(async move {
            let mut builder = http1::Builder::new();
            builder.timer(TokioTimer::new()).header_read_timeout(REQUEST_TIMEOUT);
            // A connection ends with an error if the client goes away, or is too slow.
            let _ = builder.serve_connection(TokioIo::new(stream), TowerToHyperService::new(router)).await;
            drop(place);
        });
    }
}

/// Waits for the whole body of a request before the request is answered.
pub(super) async fn with_whole_body(request: Request, next: Next) -> Response {
    let (head, body) = request.into_parts();
    match tokio::time::timeout(REQUEST_TIMEOUT, to_bytes(body, MAX_BODY_BYTES)).await {
        Ok(Ok(bytes)) => next.run(Request::from_parts(head, Body::from(bytes))).await,
        Ok(Err(_)) => {
            (StatusCode::BAD_REQUEST, "the body of the request is too long, or broken off\n").into_response()
        }
        Err(_) => (StatusCode::REQUEST_TIMEOUT, "the request was not sent to its end\n").into_response(),
    }
}
