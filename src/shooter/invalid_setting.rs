//! A setting that is out of range.

/// A setting that is not allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key}: {message}")]
pub struct SettingError {
    /// Its key in a profile, such as `shooter.errors.c10`.
    pub key: String,
    /// What is wrong and what is allowed.
    pub message: String,
}

/// Collects the settings that are not allowed.
#[derive(Debug, Default)]
pub(super) struct SettingChecks {
    pub(super) errors: Vec<SettingError>,
}

impl SettingChecks {
    /// Records a message for `key`.
    pub(super) fn refuse(&mut self, key: &str, message: impl Into<String>) {
        self.errors.push(SettingError {
            key: key.to_owned(),
            message: message.into(),
        });
    }

    /// Records that `key` must be `allowed`, unless `holds`.
    pub(super) fn require(&mut self, key: &str, holds: bool, allowed: &str) {
        if !holds {
            self.refuse(key, format!("must be {allowed}"));
        }
    }

    /// Whether nothing is wrong with `key`.
    pub(super) fn is_valid(&self, key: &str) -> bool {
        self.errors.iter().all(|error| error.key != key)
    }
}
