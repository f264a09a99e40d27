//! Files that are either whole or not there: written beside their place, synced, then renamed.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use tempfile::NamedTempFile;

/// Temporary files that exist now, so that an interrupted program can remove them.
static PENDING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file on its way; dropped before [`Pending::finish`], it leaves nothing.
#[derive(Debug)]
pub struct Pending {
    target: Target,
}

#[derive(Debug)]
enum Target {
    /// A regular file, new or to be replaced.
    Regular { file: NamedTempFile, path: PathBuf },
    /// A pipe or a device: written straight through.
    Stream(File),
}

impl Pending {
    /// Starts a file that will appear at `path`; links are followed.
    ///
    /// # Errors
    /// When the folder cannot be written to, or `path` is a folder.
    pub fn new(path: &Path) -> io::Result<Self> {
        let there = fs::metadata(path).ok();
        if there.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(io::Error::new(
                io::ErrorKind::IsADirectory,
                "it is a folder",
            ));
        }
        if there.as_ref().is_some_and(|there| !there.is_file()) {
            let file = File::options().write(true).open(path)?;
            return Ok(Self {
                target: Target::Stream(file),
            });
        }
        let path = if there.is_some() {
            fs::canonicalize(path)?
        } else {
            path.to_owned()
        };
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".bankshot-");
        // As for any new file (the mask applies), or as the file that is replaced.
        let usual = there
            .map(|there| there.permissions())
            .or_else(usual_permissions);
        if let Some(usual) = usual {
            builder.permissions(usual);
        }
        let file = builder.tempfile_in(folder)?;
        if let Ok(mut pending) = PENDING.lock() {
            pending.push(file.path().to_owned());
        }
        Ok(Self {
            target: Target::Regular { file, path },
        })
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// When it cannot be synced or renamed; what stood there before still does.
    pub fn finish(self) -> io::Result<()> {
        match self.target {
            Target::Stream(mut file) => file.flush(),
            Target::Regular { file, path } => {
                file.as_file().sync_all()?;
                let temporary = file.path().to_owned();
                file.persist(&path).map_err(|error| error.error)?;
                if let Ok(mut pending) = PENDING.lock() {
                    pending.retain(|path| *path != temporary);
                }
                Ok(())
            }
        }
    }
}

impl Write for Pending {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.target {
            Target::Regular { file, .. } => file.write(bytes),
            Target::Stream(file) => file.write(bytes),
        }
    }
    fn flush(&mut self) -> io::Result<()> {
        match &mut self.target {
            Target::Regular { file, .. } => file.flush(),
            Target::Stream(file) => file.flush(),
        }
    }
}

/// As [`write()`], only where there is no such file yet; was it written?
///
/// # Errors
/// When it cannot be written.
pub fn write_new(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".bankshot-");
    if let Some(usual) = usual_permissions() {
        builder.permissions(usual);
    }
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    match file.persist_noclobber(path) {
        Ok(_) => Ok(true),
        Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
        Err(error) => Err(error.error),
    }
}

/// Removes every temporary file; for a program that is about to end.
pub fn discard_pending() {
    if let Ok(pending) = PENDING.lock() {
        for path in pending.iter() {
            // One that is already gone was finished or dropped.
            let _ = fs::remove_file(path);
        }
    }
}

#[cfg(unix)]
fn usual_permissions() -> Option<fs::Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual_permissions() -> Option<fs::Permissions> {
    None
}

/// Writes `bytes` to `path`, whole or not at all.
///
/// # Errors
/// When it cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut pending = Pending::new(path)?;
    pending.write_all(bytes)?;
    pending.finish()
}
