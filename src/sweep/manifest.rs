//! The manifest of a sweep's folder: which sweep it holds, and which program computes it.

use super::sweep_toml::{SourceTexts, SweepConfig};
use crate::shooter::{IdentityError, identity_hash};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

/// Name of the file.
pub(super) const FILE_NAME: &str = "configuration.json";
/// Greatest number of listed differences.
const MAX_DIFFERENCES: usize = 20;
/// Largest manifest that is read, bytes.
const MAX_BYTES: u64 = 256 << 20;

/// The content of `configuration.json`.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Manifest {
    program: String,
    version: String,
    commit: String,
    pub(super) hash: String,
    /// BLAKE3 of the hash and the texts.
    checksum: String,
    pub(super) texts: SourceTexts,
    configuration: Value,
}

/// What was found in the place of the manifest.
pub(super) enum ManifestFile {
    Missing,
    Damaged,
    Valid(Box<Manifest>),
}

impl Manifest {
    pub(super) fn new(config: &SweepConfig, texts: &SourceTexts) -> Result<Self, IdentityError> {
        let hash = config.hash()?;
        Ok(Self {
            program: "bankshot".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("BANKSHOT_COMMIT").to_owned(),
            checksum: identity_hash(&(&hash, texts))?,
            hash,
            texts: texts.clone(),
            configuration: serde_json::to_value(config).unwrap_or_default(),
        })
    }

    /// Version and commit of the program.
    pub(super) fn program(&self) -> String {
        format!("{} ({})", self.version, self.commit)
    }

    pub(super) fn read(path: &Path) -> io::Result<ManifestFile> {
        // A dangling link would be missing and yet in the way, and a pipe would be waited for.
        let not_a_file = |what: &str| io::Error::new(io::ErrorKind::InvalidData, what);
        match (std::fs::symlink_metadata(path), std::fs::metadata(path)) {
            (Ok(_), Err(error)) if error.kind() == io::ErrorKind::NotFound => {
                return Err(not_a_file("is a link that leads nowhere; remove it"));
            }
            (_, Ok(found)) if !found.is_file() => {
                return Err(not_a_file("is not a file"));
            }
            _ => {}
        }
        let mut text = String::new();
        let file = match File::open(path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Ok(ManifestFile::Missing);
            }
            Err(error) => return Err(error),
        };
        if let Err(error) = file.take(MAX_BYTES).read_to_string(&mut text)
            && error.kind() != io::ErrorKind::InvalidData
        {
            return Err(error);
        }
        let manifest = serde_json::from_str::<Self>(&text).ok();
        Ok(match manifest.filter(Self::matches_checksum) {
            Some(manifest) => ManifestFile::Valid(Box::new(manifest)),
            None => ManifestFile::Damaged,
        })
    }

    fn matches_checksum(&self) -> bool {
        identity_hash(&(&self.hash, &self.texts)).is_ok_and(|checksum| checksum == self.checksum)
    }

    /// Whether the manifest has the same configuration, whatever program computes it.
    pub(super) fn has_configuration_of(&self, config: &SweepConfig) -> bool {
        let mut found = Vec::new();
        let new = serde_json::to_value(config).unwrap_or_default();
        collect_differences("", &self.configuration, &new, &mut found);
        found.is_empty()
    }

    /// The values that differ from those of another manifest, each with its key.
    pub(super) fn differences(&self, new: &Self) -> Vec<String> {
        let program = |manifest: &Self| serde_json::json!({"version": manifest.version, "commit": manifest.commit});
        let mut found = Vec::new();
        collect_differences("program", &program(self), &program(new), &mut found);
        collect_differences("", &self.configuration, &new.configuration, &mut found);
        if found.len() > MAX_DIFFERENCES {
            let more = found.len() - MAX_DIFFERENCES;
            found.truncate(MAX_DIFFERENCES);
            found.push(format!("  and {more} more"));
        }
        found
    }
}

fn collect_differences(key: &str, old: &Value, new: &Value, found: &mut Vec<String>) {
    use Value::{Array, Object};
    let join = |part: &str| {
        if key.is_empty() {
            part.to_owned()
        } else {
            format!("{key}.{part}")
        }
    };
    match (old, new) {
        (Object(a), Object(b)) => {
            let mut parts: Vec<&String> = a.keys().chain(b.keys()).collect();
            parts.sort();
            parts.dedup();
            for part in parts {
                let null = Value::Null;
                let (a, b) = (a.get(part).unwrap_or(&null), b.get(part).unwrap_or(&null));
                collect_differences(&join(part), a, b, found);
            }
        }
        (Array(a), Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                collect_differences(&join(&i.to_string()), a, b, found);
            }
        }
        (a, b) if a != b => {
            let short = |value: &Value| -> String { value.to_string().chars().take(60).collect() };
            found.push(format!(
                "  {key}: the folder has {}, you asked for {} (SI units)",
                short(a),
                short(b)
            ));
        }
        _ => {}
    }
}
