//! What is asked for, by its address.

use super::answers::{answer, cut, events, json, refusal};
use super::desk::Desk;
use super::guard::Guard;
use super::messages::{Add, Edit};
use super::{LARGEST, PATIENCE};
use crate::{PAGE, asset};
use axum::Router;
use axum::body::{Body, Bytes, to_bytes};
use axum::extract::{Request, State};
use axum::http::{Method, Response, header};
use serde_json::json as value;
use std::sync::Arc;

#[derive(Clone)]
struct Shared {
    guard: Arc<Guard>,
    desk: Arc<Desk>,
}

/// All requests come to one place, where the address is compared as it was sent: nothing in it is decoded, so that no
/// spelling of `..` leads anywhere.
pub(super) fn router(guard: Arc<Guard>, desk: Arc<Desk>) -> Router {
    Router::new().fallback(asked).with_state(Shared { guard, desk })
}

async fn asked(State(shared): State<Shared>, request: Request) -> Response<Body> {
    let (head, body) = request.into_parts();
    if !shared.guard.admits(&head.uri, &head.headers) {
        return cut(403, "this server is for its own page alone");
    }
    let Some(wanted) = shared.guard.behind_token(head.uri.path()) else {
        return cut(404, "there is nothing here");
    };
    let length = head.headers.get(header::CONTENT_LENGTH);
    let length = length.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
    if length.is_some_and(|length| length > LARGEST as u64) {
        return cut(413, "the message is too long");
    }
    match head.method {
        Method::GET | Method::HEAD => got(&shared, wanted).await,
        Method::POST => posted(&shared, wanted, body).await,
        _ => cut(405, "only GET and POST are understood"),
    }
}

async fn got(shared: &Shared, wanted: &str) -> Response<Body> {
    let desk = shared.desk.clone();
    match wanted {
        "" => answer(200, "text/html; charset=utf-8", PAGE),
        "session.json" => blocking(move || answer(200, "application/json", desk.session())).await,
        "editable.json" => blocking(move || json(200, &desk.editable())).await,
        "events" => match blocking_value(move || desk.listen()).await.flatten() {
            Some(receiver) => events(receiver),
            None => refusal(503, "too many pages listen"),
        },
        "edit" | "add" | "undo" | "redo" => refusal(405, "this is asked for with POST"),
        _ => {
            if let Some(found) = wanted.strip_prefix("assets/").and_then(asset) {
                return answer(200, found.media_type, found.bytes);
            }
            let Some(name) = wanted.strip_prefix("files/").map(str::to_owned) else {
                return refusal(404, "there is nothing here");
            };
            match blocking_value(move || desk.mesh(&name)).await.flatten() {
                Some(bytes) => answer(200, "application/octet-stream", bytes),
                None => refusal(404, "there is nothing here"),
            }
        }
    }
}

async fn posted(shared: &Shared, wanted: &str, body: Body) -> Response<Body> {
    if !matches!(wanted, "edit" | "add" | "undo" | "redo") {
        return cut(404, "there is nothing here");
    }
    let body = match tokio::time::timeout(PATIENCE, to_bytes(body, LARGEST)).await {
        Ok(Ok(body)) => body,
        Ok(Err(_)) => return cut(413, "the message is too long, or it breaks off"),
        Err(_) => return cut(408, "the message does not arrive"),
    };
    let (desk, wanted) = (shared.desk.clone(), wanted.to_owned());
    blocking(move || changed(&desk, &wanted, &body)).await
}

fn changed(desk: &Desk, wanted: &str, body: &Bytes) -> Response<Body> {
    let answered = match wanted {
        "edit" => Edit::read(body).map(|edit| desk.edit(&edit)),
        "add" => Add::read(body).map(|add| desk.add(&add)),
        _ => Ok(desk.undo(wanted == "redo")),
    };
    match answered {
        Ok((status, said)) => json(status, &said),
        Err(why) => json(400, &value!({ "error": why })),
    }
}

/// What reads files or computes does so beside the connections.
async fn blocking(make: impl FnOnce() -> Response<Body> + Send + 'static) -> Response<Body> {
    let made = blocking_value(make).await;
    made.unwrap_or_else(|| cut(500, "the request could not be answered"))
}

async fn blocking_value<T: Send + 'static>(make: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    tokio::task::spawn_blocking(make).await.ok()
}
