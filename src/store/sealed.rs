//! JSON files that know whether they, and the files beside them, are as they were written.

use super::StoreError;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The version of stored files and of the JSON of answers. A stored file of another version is
/// refused.
pub const FORMAT_VERSION: u32 = 3;

/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 256 << 20;

const VERSION: &str = "format_version";
const FILES: &str = "files";
const CHECKSUM: &str = "checksum";

fn checksum(object: &Map<String, Value>) -> String {
    blake3::hash(Value::from(object.clone()).to_string().as_bytes()).to_string()
}

/// The text of a JSON file: an object, the BLAKE3 of each of the files beside it, and that of all
/// this.
#[must_use]
pub fn seal(object: Value, files: &[(&str, &[u8])]) -> String {
    let Value::Object(mut object) = object else {
        return format!("{object:#}\n");
    };
    let hashes: Map<String, Value> = files
        .iter()
        .map(|(name, bytes)| ((*name).to_owned(), blake3::hash(bytes).to_string().into()))
        .collect();
    object.insert(VERSION.to_owned(), FORMAT_VERSION.into());
    object.insert(FILES.to_owned(), hashes.into());
    object.insert(CHECKSUM.to_owned(), checksum(&object).into());
    format!("{:#}\n", Value::from(object))
}

/// A sealed file, read.
#[derive(Debug)]
pub struct Sealed<T> {
    /// What it says.
    pub content: T,
    files: BTreeMap<String, String>,
    again: &'static str,
}

impl<T: DeserializeOwned> Sealed<T> {
    /// Reads a sealed file. `again` says what writes it anew.
    ///
    /// # Errors
    /// It cannot be read, is not as [`seal`] made it, or is of another version.
    pub fn read(path: &Path, again: &'static str) -> Result<Self, StoreError> {
        let bytes = read_bytes(path)?;
        let damaged = |what: String| StoreError::damaged(path, format!("{what}; {again}"));
        let mut object: Map<String, Value> =
            serde_json::from_slice(&bytes).map_err(|error| damaged(error.to_string()))?;
        if object.get(VERSION) != Some(&FORMAT_VERSION.into()) {
            return Err(damaged(format!(
                "{VERSION} must be {FORMAT_VERSION}; it was written by another version"
            )));
        }
        // A key of the wrong type has a better message than a wrong checksum.
        let content = serde_path_to_error::deserialize(Value::from(object.clone()))
            .map_err(|error| damaged(format!("{}: {}", error.path(), error.inner())))?;
        let stored = object.remove(CHECKSUM);
        if stored != Some(checksum(&object).into()) {
            return Err(damaged("was changed after it was written".to_owned()));
        }
        let files = object.remove(FILES).unwrap_or_default();
        let files =
            serde_json::from_value(files).map_err(|error| damaged(format!("{FILES}: {error}")))?;
        Ok(Self {
            content,
            files,
            again,
        })
    }

    /// The bytes of a file beside the sealed one, which has its BLAKE3.
    ///
    /// # Errors
    /// It cannot be read, or is not as it was written.
    pub fn file(&self, folder: &Path, name: &str) -> Result<Vec<u8>, StoreError> {
        let path = folder.join(name);
        let bytes = read_bytes(&path)?;
        let hash = blake3::hash(&bytes).to_string();
        if self.files.get(name) != Some(&hash) {
            return Err(StoreError::damaged(
                &path,
                format!("was changed after it was written; {}", self.again),
            ));
        }
        Ok(bytes)
    }
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, StoreError> {
    let refuse = |error| StoreError::io(path, error);
    let metadata = fs::metadata(path).map_err(refuse)?;
    if !metadata.is_file() || metadata.len() > MAX_BYTES {
        return Err(StoreError::damaged(path, "is not a file of this size"));
    }
    fs::read(path).map_err(refuse)
}
