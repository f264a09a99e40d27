//! Files that are either complete or absent: written under a temporary name, synced, then renamed.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use tempfile::NamedTempFile;

/// The temporary files that exist now, so that an interrupted program can remove them.
static TEMPORARY_FILES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file that is being written. If it is dropped before [`AtomicFile::finish`], it leaves nothing.
#[derive(Debug)]
pub struct AtomicFile {
    target: Target,
}

#[derive(Debug)]
enum Target {
    /// A regular file, new or to be replaced.
    Regular { file: NamedTempFile, path: PathBuf },
    /// A pipe or a device, written directly.
    Stream(File),
}

impl AtomicFile {
    /// Starts a file that will appear at `path`. Links are followed.
    ///
    /// # Errors
    /// The folder cannot be written to, or `path` is a folder.
    pub fn new(path: &Path) -> io::Result<Self> {
        let existing = fs::metadata(path).ok();
        if existing.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(io::Error::new(
                io::ErrorKind::IsADirectory,
                "it is a folder",
            ));
        }
        if existing
            .as_ref()
            .is_some_and(|existing| !existing.is_file())
        {
            let file = File::options().write(true).open(path)?;
            return Ok(Self {
                target: Target::Stream(file),
            });
        }
        let path = if existing.is_some() {
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
        // Those of any new file (the umask applies), or of the file that is replaced.
        let permissions = existing
            .map(|existing| existing.permissions())
            .or_else(default_permissions);
        if let Some(permissions) = permissions {
            builder.permissions(permissions);
        }
        let file = builder.tempfile_in(folder)?;
        if let Ok(mut pending) = TEMPORARY_FILES.lock() {
            pending.push(file.path().to_owned());
        }
        Ok(Self {
            target: Target::Regular { file, path },
        })
    }

    /// Syncs the file and renames it to its path.
    ///
    /// # Errors
    /// It cannot be synced or renamed. The previous file, if any, is unchanged.
    pub fn finish(self) -> io::Result<()> {
        match self.target {
            Target::Stream(mut file) => file.flush(),
            Target::Regular { file, path } => {
                file.as_file().sync_all()?;
                let temporary = file.path().to_owned();
                file.persist(&path).map_err(|error| error.error)?;
                if let Ok(mut pending) = TEMPORARY_FILES.lock() {
                    pending.retain(|path| *path != temporary);
                }
                Ok(())
            }
        }
    }
}

impl Write for AtomicFile {
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

/// As [`write()`], only if the file does not exist; returns whether it was written.
///
/// # Errors
/// It cannot be written.
pub fn write_new(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".bankshot-");
    if let Some(permissions) = default_permissions() {
        builder.permissions(permissions);
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

/// Whether two paths lead to the same regular file.
#[must_use]
pub fn same_file(a: &Path, b: &Path) -> bool {
    let found = |path: &Path| fs::metadata(path).ok().filter(fs::Metadata::is_file);
    let (Some(first), Some(second)) = (found(a), found(b)) else {
        return false;
    };
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        // Hard links too.
        (first.dev(), first.ino()) == (second.dev(), second.ino())
    }
    #[cfg(not(unix))]
    {
        let _ = (first, second);
        fs::canonicalize(a).ok() == fs::canonicalize(b).ok()
    }
}

/// Refuses a path that exists and is no regular file: a link would lead elsewhere, and a pipe would
/// be waited for.
///
/// # Errors
/// It is a link, whatever it leads to, a pipe, a device or a folder.
pub fn refuse_special(path: &Path) -> io::Result<()> {
    refuse_unless(path, "a regular file", fs::FileType::is_file)
}

/// Refuses a path that exists and is no folder, or a link to one.
///
/// # Errors
/// It is a link, or no folder.
pub fn refuse_linked_folder(path: &Path) -> io::Result<()> {
    refuse_unless(path, "a folder", fs::FileType::is_dir)
}

fn refuse_unless(
    path: &Path,
    wanted: &str,
    holds: impl Fn(&fs::FileType) -> bool,
) -> io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "it is a link, and results are not written through links; remove it",
        )),
        Ok(found) if !holds(&found.file_type()) => Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("it is not {wanted}; remove it"),
        )),
        _ => Ok(()),
    }
}

/// As [`write()`], but refuses what [`refuse_special`] refuses.
///
/// # Errors
/// It is a link or no regular file, or cannot be written.
pub fn write_unlinked(path: &Path, bytes: &[u8]) -> io::Result<()> {
    refuse_special(path)?;
    write(path, bytes)
}

/// Removes every temporary file, for a program that is about to end.
pub fn discard_temporary_files() {
    if let Ok(pending) = TEMPORARY_FILES.lock() {
        for path in pending.iter() {
            // A file that no longer exists was finished or dropped.
            let _ = fs::remove_file(path);
        }
    }
}

#[cfg(unix)]
fn default_permissions() -> Option<fs::Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn default_permissions() -> Option<fs::Permissions> {
    None
}

/// Writes `bytes` to `path`, completely or not at all.
///
/// # Errors
/// It cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::new(path)?;
    file.write_all(bytes)?;
    file.finish()
}
