//! Files of measured shots from the page.

use super::folder::{UPLOADS, check_new_name, upload};
use super::questions::read_json;
use super::refusal::Refusal;
use super::site::Site;
use crate::answers::shot_file::{ShotFileRequest, document};
use axum::Json;
use axum::body::{Body, Bytes};
use axum::extract::{Path as UrlPath, State};
use axum::http::StatusCode;
use futures_util::StreamExt;
use serde_json::{Value, json};
use std::io::Write;
use std::sync::Arc;
use std::time::Duration;

/// The largest file, bytes.
const MAX_UPLOAD: usize = 64 << 20;
/// Bytes that are read of a larger one.
const MAX_READ: usize = 1 << 30;
/// A client may pause for this long.
const PAUSE: Duration = Duration::from_secs(20);
/// The ends of names of files that hold measured shots.
const ENDS: [&str; 9] = [
    "csv", "tsv", "txt", "parquet", "xlsx", "xlsm", "xls", "ods", "json",
];

fn too_large(name: &str) -> Refusal {
    let words = format!("{name}: is larger than 64 MiB; use bankshot fit in a terminal");
    Refusal::new(StatusCode::PAYLOAD_TOO_LARGE, words)
}

/// Keeps a file, whole or not at all. One of the same name is replaced.
pub(super) async fn receive(
    State(site): State<Arc<Site>>,
    UrlPath(name): UrlPath<String>,
    body: Body,
) -> Result<Json<Value>, Refusal> {
    check_new_name("name", &name)?;
    let end = name.rsplit_once('.').map(|(_, end)| end.to_lowercase());
    if !end.is_some_and(|end| ENDS.contains(&end.as_str())) {
        let ends = ENDS.join(", ");
        return Err(Refusal::field(
            "name",
            format!("{name}: must be a table of shots; its name ends in one of {ends}"),
        ));
    }
    let folder = site.folder.join(UPLOADS);
    let refuse = |error: std::io::Error| Refusal::io(&name, &error);
    std::fs::create_dir_all(&folder).map_err(refuse)?;
    let mut file = tempfile::NamedTempFile::new_in(&folder).map_err(refuse)?;
    let mut blocks = body.into_data_stream();
    let mut bytes = 0;
    loop {
        let block = tokio::time::timeout(PAUSE, blocks.next()).await;
        let Ok(block) = block else {
            let words = format!("{name}: nothing came for 20 seconds");
            return Err(Refusal::new(StatusCode::REQUEST_TIMEOUT, words));
        };
        let Some(block) = block else { break };
        let block: Bytes = block.map_err(|error| Refusal::bad(format!("{name}: {error}")))?;
        bytes += block.len();
        // What is too large is read and thrown away up to a limit: a client that is still sending
        // would not see the answer.
        match bytes {
            0..=MAX_UPLOAD => file.write_all(&block).map_err(refuse)?,
            _ if bytes > MAX_READ => break,
            _ => {}
        }
    }
    if bytes > MAX_UPLOAD {
        return Err(too_large(&name));
    }
    let path = folder.join(&name);
    file.persist(path).map_err(|error| refuse(error.error))?;
    Ok(Json(json!({ "name": name, "bytes": bytes })))
}

/// What a file holds.
pub(super) async fn content(
    State(site): State<Arc<Site>>,
    UrlPath(name): UrlPath<String>,
    body: Bytes,
) -> Result<Json<Value>, Refusal> {
    let request: ShotFileRequest = read_json(&body)?;
    let path = upload(&site.folder, &name)?;
    let answer = tokio::task::spawn_blocking(move || document(&request.answer(&path))).await;
    let failed = |_| Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, "the file cannot be read");
    answer.map(Json).map_err(failed)
}
