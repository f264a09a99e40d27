//! Which sweeps the plots in a folder are of.

use super::StoreError;
use super::sealed::{Sealed, seal};
use crate::files::atomic_file;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

const FILE: &str = "of_sweep.json";

/// The folder of a sweep, and that of the sweep it is compared with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SweepLink {
    /// The sweep.
    pub sweep: PathBuf,
    /// The other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against: Option<PathBuf>,
}

impl SweepLink {
    /// The link beside the plots of a folder; `None` if there is none.
    ///
    /// # Errors
    /// It is damaged.
    pub fn read(folder: &Path) -> Result<Option<Self>, StoreError> {
        let file = folder.join(FILE);
        let exists = file.is_file();
        let sealed = exists.then(|| Sealed::read(&file, "run `bankshot map` again"));
        Ok(sealed.transpose()?.map(|sealed| sealed.content))
    }

    /// Writes it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), StoreError> {
        let file = folder.join(FILE);
        let object = serde_json::to_value(self).unwrap_or_default();
        atomic_file::write_unlinked(&file, seal(object, &[]).as_bytes())
            .map_err(|error| StoreError::io(&file, error))
    }

    /// Removes that of an earlier comparison.
    pub fn remove(folder: &Path) {
        let _ = std::fs::remove_file(folder.join(FILE));
    }
}
