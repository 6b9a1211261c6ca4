//! The reasons why a request to the server fails, as answers of HTTP.

use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};

use crate::output::OutputError;
use crate::page::{Answer, Failed};
use crate::render::RenderError;

impl From<OutputError> for Failed {
    fn from(error: OutputError) -> Failed {
        Failed::Report(error.report())
    }
}

impl From<RenderError> for Failed {
    fn from(error: RenderError) -> Failed {
        Failed::Report(error.report())
    }
}

impl IntoResponse for Failed {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.status()).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        (status, self.message()).into_response()
    }
}

impl IntoResponse for Answer {
    fn into_response(self) -> Response {
        ([(axum::http::header::CONTENT_TYPE, self.kind())], self.into_bytes()).into_response()
    }
}
