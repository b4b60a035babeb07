//! Answers with their headers, and the stream of events.

use axum::body::{Body, Bytes};
use axum::http::{HeaderValue, Response, StatusCode, header};
use futures_core::Stream;
use std::convert::Infallible;
use std::pin::Pin;
use std::task::{Context, Poll};
use tokio::sync::mpsc::Receiver;

/// What the page may do: run its own program and WebAssembly, and talk to this server alone.
const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; \
                      img-src 'self' data: blob:; media-src blob:; connect-src 'self' data: blob:; \
                      worker-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// An answer of a media type. Nothing is kept by the browser, nor told to other sites.
pub(super) fn answer(
    status: u16,
    media_type: &'static str,
    body: impl Into<Body>,
) -> Response<Body> {
    let mut response = Response::new(body.into());
    *response.status_mut() =
        StatusCode::from_u16(status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
    let headers = response.headers_mut();
    let mut set = |name, value| headers.insert(name, HeaderValue::from_static(value));
    set(header::CONTENT_TYPE, media_type);
    set(header::CACHE_CONTROL, "no-store");
    set(header::X_CONTENT_TYPE_OPTIONS, "nosniff");
    set(header::REFERRER_POLICY, "no-referrer");
    set(header::CONTENT_SECURITY_POLICY, POLICY);
    set(header::HeaderName::from_static("cross-origin-resource-policy"), "same-origin");
    response
}

pub(super) fn json(status: u16, value: &serde_json::Value) -> Response<Body> {
    answer(status, "application/json", value.to_string())
}

/// A refusal in one line.
pub(super) fn refusal(status: u16, why: &'static str) -> Response<Body> {
    answer(status, "text/plain; charset=utf-8", format!("{why}\n"))
}

/// A refusal of a request that was not read to its end, after which the connection is closed.
pub(super) fn cut(status: u16, why: &'static str) -> Response<Body> {
    let mut response = refusal(status, why);
    response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    response
}

/// Events as a browser's `EventSource` reads them.
pub(super) fn events(receiver: Receiver<String>) -> Response<Body> {
    answer(200, "text/event-stream", Body::from_stream(Events { receiver, begun: false }))
}

struct Events {
    receiver: Receiver<String>,
    begun: bool,
}

impl Stream for Events {
    type Item = Result<Bytes, Infallible>;

    fn poll_next(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        if !self.begun {
            self.begun = true;
            // So that the page knows at once that it listens; it asks again after a second.
            return Poll::Ready(Some(Ok(Bytes::from_static(b"retry: 1000\n\n"))));
        }
        let event = |text: String| Ok(Bytes::from(format!("data: {text}\n\n")));
        self.receiver.poll_recv(context).map(|text| text.map(event))
    }
}
