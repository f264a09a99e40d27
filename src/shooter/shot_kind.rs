//! Direct and bank shots.

use super::nominal::Nominal;
use super::profile::Profile;
use crate::model::SolidId;
use serde::{Deserialize, Serialize};

/// The two kinds of nominal shots. The kind depends on the first touch of the error-free flight,
/// not on the outcome.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShotKind {
    /// Touches the ring first, or nothing.
    Direct,
    /// Touches the board first.
    Bank,
}

impl ShotKind {
    /// Both kinds.
    pub const ALL: [Self; 2] = [Self::Direct, Self::Bank];

    /// `direct` or `bank`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Bank => "bank",
        }
    }

    /// Bank for direct, direct for bank.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Direct => Self::Bank,
            Self::Bank => Self::Direct,
        }
    }

    /// The kind of a nominal shot.
    #[must_use]
    pub fn of(profile: &Profile, nominal: &Nominal) -> Self {
        match profile.simulator().first_touch(&profile.release(nominal)) {
            Some(SolidId::Board) => Self::Bank,
            _ => Self::Direct,
        }
    }

    /// Position in [`ShotKind::ALL`].
    pub(crate) fn index(self) -> usize {
        self as usize
    }
}
