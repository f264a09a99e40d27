//! The file in which a table that is being made keeps what it has found: one finding a line, in
//! JSON, after a line that names the table. It stands beside the table and goes when that is
//! written.

use crate::best_shot::{ShotTableRequest, TableFinding};
use crate::shooter::{IdentityError, Profile, identity_hash};
use serde::{Deserialize, Serialize};
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};

/// The first line of the file.
#[derive(Serialize, Deserialize)]
struct Header {
    /// Hash of everything that the findings depend on.
    unfinished_table: String,
}

/// The findings of a table that is not finished. Another process that makes the same table at the
/// same time is refused.
#[derive(Debug)]
pub struct UnfinishedTable {
    file: File,
    path: PathBuf,
    /// What was found before.
    known: Vec<TableFinding>,
    /// Whether findings of another table were thrown away.
    has_replaced: bool,
}

impl UnfinishedTable {
    /// Where the findings of a table are kept that will be written to `output`.
    #[must_use]
    pub fn path_beside(output: &Path) -> PathBuf {
        let mut name = OsString::from(output);
        name.push(".unfinished");
        PathBuf::from(name)
    }

    /// The identity of a table: program, profile and request.
    ///
    /// # Errors
    /// A value cannot be serialised.
    pub fn identity(
        profile: &Profile,
        request: &ShotTableRequest,
    ) -> Result<String, IdentityError> {
        let program = (env!("CARGO_PKG_VERSION"), env!("BANKSHOT_COMMIT"));
        identity_hash(&(program, profile.hash(), request))
    }

    /// Opens the findings of a table, or begins them. Those of another table are thrown away.
    ///
    /// # Errors
    /// The file cannot be read or written, another process has it, or it is no such file.
    pub fn open(path: &Path, identity: &str) -> io::Result<Self> {
        let mut file = File::options()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)?;
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => {
                io::Error::other("another process makes this table; wait for it")
            }
            TryLockError::Error(error) => error,
        })?;
        let mut text = Vec::new();
        file.read_to_end(&mut text)?;
        let text = String::from_utf8_lossy(&text);
        let mut lines = text.split_inclusive('\n');
        let header = lines.next().map(serde_json::from_str::<Header>);
        let mut known = Vec::new();
        let (mut kept, mut has_replaced) = (0, false);
        match header {
            Some(Ok(header)) if header.unfinished_table == identity => {
                kept = text.find('\n').map_or(0, |end| end + 1);
                // What follows a damaged or half-written line is thrown away with it.
                for line in lines.take_while(|line| line.ends_with('\n')) {
                    let Ok(finding) = serde_json::from_str(line) else {
                        break;
                    };
                    known.push(finding);
                    kept += line.len();
                }
            }
            None => {}
            Some(Ok(_)) => has_replaced = true,
            Some(Err(_)) => {
                return Err(io::Error::other(
                    "it is in the way of what an unfinished table keeps; move it",
                ));
            }
        }
        file.set_len(kept as u64)?;
        file.seek(io::SeekFrom::End(0))?;
        let mut opened = Self {
            file,
            path: path.to_owned(),
            known,
            has_replaced,
        };
        if kept == 0 {
            let unfinished_table = identity.to_owned();
            opened.write_line(&Header { unfinished_table })?;
        }
        Ok(opened)
    }

    /// What was found before.
    #[must_use]
    pub fn known(&self) -> &[TableFinding] {
        &self.known
    }

    /// Whether findings of another table were thrown away when it was opened.
    #[must_use]
    pub fn has_replaced(&self) -> bool {
        self.has_replaced
    }

    /// Takes what was found before.
    #[must_use]
    pub fn take_known(&mut self) -> Vec<TableFinding> {
        std::mem::take(&mut self.known)
    }

    /// Keeps a finding.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn keep(&mut self, finding: &TableFinding) -> io::Result<()> {
        self.write_line(finding)
    }

    fn write_line(&mut self, value: &impl Serialize) -> io::Result<()> {
        let mut line = serde_json::to_vec(value)?;
        line.push(b'\n');
        self.file.write_all(&line)
    }

    /// Removes the file: the table is written.
    ///
    /// # Errors
    /// The file cannot be removed.
    pub fn remove(self) -> io::Result<()> {
        fs::remove_file(&self.path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shooter::{Location, Nominal, ShotKind};

    fn finding(distance_m: f64) -> TableFinding {
        TableFinding::Shot {
            kind: ShotKind::Bank,
            place: Location {
                distance_m,
                angle_rad: 0.1,
            },
            shot: None,
            optima: vec![Nominal::default()],
        }
    }

    #[test]
    fn contract_findings_come_back_exactly_and_only_for_their_table() {
        let folder = tempfile::tempdir().unwrap();
        let path = UnfinishedTable::path_beside(&folder.path().join("shots.csv"));
        assert_eq!(path.file_name().unwrap(), "shots.csv.unfinished");
        let findings = [finding(4.1), finding(std::f64::consts::PI)];
        let mut table = UnfinishedTable::open(&path, "a").unwrap();
        assert!(UnfinishedTable::open(&path, "a").is_err(), "locked");
        for finding in &findings {
            table.keep(finding).unwrap();
        }
        drop(table);
        // The program was killed in the middle of a line.
        let mut file = File::options().append(true).open(&path).unwrap();
        file.write_all(b"{\"shot\":{\"kind\"").unwrap();
        drop(file);
        let mut table = UnfinishedTable::open(&path, "a").unwrap();
        assert_eq!(table.known(), findings);
        table.keep(&finding(1.0)).unwrap();
        drop(table);
        assert_eq!(UnfinishedTable::open(&path, "a").unwrap().known().len(), 3);
        let other = UnfinishedTable::open(&path, "b").unwrap();
        assert!(other.known().is_empty() && other.has_replaced());
        drop(other);
        let table = UnfinishedTable::open(&path, "a").unwrap();
        assert!(table.known().is_empty(), "thrown away by the other table");
        table.remove().unwrap();
        assert!(!path.exists());
        fs::write(&path, "mine\n").unwrap();
        assert!(UnfinishedTable::open(&path, "a").is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "mine\n");
    }
}
