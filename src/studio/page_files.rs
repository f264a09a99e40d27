//! The page: built from `studio/`, and part of the program.

use super::access::sign_in;
use super::refusal::Refusal;
use super::site::Site;
use axum::extract::{RawQuery, State};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;

const HTML: &str = include_str!("../../studio/dist/index.html");
const SCRIPT: &[u8] = include_bytes!("../../studio/dist/studio.js");
const STYLE: &[u8] = include_bytes!("../../studio/dist/studio.css");

pub(super) async fn page(
    State(site): State<Arc<Site>>,
    RawQuery(query): RawQuery,
) -> Result<Response, Refusal> {
    Ok(match sign_in(&site, &query.unwrap_or_default())? {
        Some(response) => response,
        None => axum::response::Html(HTML).into_response(),
    })
}

pub(super) async fn script() -> Response {
    (
        [(header::CONTENT_TYPE, "text/javascript; charset=utf-8")],
        SCRIPT,
    )
        .into_response()
}

pub(super) async fn style() -> Response {
    ([(header::CONTENT_TYPE, "text/css; charset=utf-8")], STYLE).into_response()
}
