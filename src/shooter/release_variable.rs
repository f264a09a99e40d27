//! The variables of a release by name.

use crate::units::Dimension;
use serde::{Deserialize, Serialize};

/// The nine random variables of Eq. 23, in the order in which their errors are drawn.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReleaseVariable {
    /// Speed.
    Speed,
    /// Pitch angle.
    Pitch,
    /// Polar angle.
    Polar,
    /// Backspin.
    Backspin,
    /// Spin about the horizontal direction of the shot.
    RifleSpin,
    /// Spin about the vertical.
    SideSpin,
    /// Distance from the hoop.
    Distance,
    /// Angle of the location on the court.
    CourtAngle,
    /// Height of the release.
    Height,
}

impl ReleaseVariable {
    /// Number of variables.
    pub const COUNT: usize = 9;
    /// Every variable in order.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Speed,
        Self::Pitch,
        Self::Polar,
        Self::Backspin,
        Self::RifleSpin,
        Self::SideSpin,
        Self::Distance,
        Self::CourtAngle,
        Self::Height,
    ];

    /// The name in profiles, tables and files, such as `rifle_spin`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Pitch => "pitch",
            Self::Polar => "polar",
            Self::Backspin => "backspin",
            Self::RifleSpin => "rifle_spin",
            Self::SideSpin => "side_spin",
            Self::Distance => "distance",
            Self::CourtAngle => "court_angle",
            Self::Height => "height",
        }
    }

    /// The physical dimension.
    #[must_use]
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::Speed => Dimension::Speed,
            Self::Pitch | Self::Polar | Self::CourtAngle => Dimension::Angle,
            Self::Backspin | Self::RifleSpin | Self::SideSpin => Dimension::Spin,
            Self::Distance | Self::Height => Dimension::Length,
        }
    }

    /// Position in [`ReleaseVariable::ALL`].
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Whether the sign changes in the mirror image of a shot (y -> -y).
    #[must_use]
    pub const fn is_odd_in_mirror(self) -> bool {
        matches!(
            self,
            Self::Polar | Self::RifleSpin | Self::SideSpin | Self::CourtAngle
        )
    }
}

/// The variables of a nominal shot: what the shooter can intend.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NominalVariable {
    /// Speed.
    Speed,
    /// Pitch angle.
    Pitch,
    /// Polar angle.
    Polar,
    /// Backspin.
    Backspin,
    /// Spin about the vertical.
    SideSpin,
    /// Spin about the horizontal direction of the shot.
    RifleSpin,
}

impl NominalVariable {
    /// Every variable.
    pub const ALL: [Self; 6] = [
        Self::Speed,
        Self::Pitch,
        Self::Polar,
        Self::Backspin,
        Self::SideSpin,
        Self::RifleSpin,
    ];
    /// The variables that a search can choose.
    pub const SEARCHABLE: [Self; 5] = [
        Self::Speed,
        Self::Pitch,
        Self::Polar,
        Self::Backspin,
        Self::SideSpin,
    ];
    /// The axes of a table of nominal shots, from the outermost to the innermost.
    pub const TABLE_AXES: [Self; 4] = [Self::Pitch, Self::Polar, Self::Backspin, Self::Speed];

    /// The name in profiles, tables and files, such as `side_spin`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.as_release_variable().name()
    }

    /// The physical dimension.
    #[must_use]
    pub const fn dimension(self) -> Dimension {
        self.as_release_variable().dimension()
    }

    pub(crate) const fn as_release_variable(self) -> ReleaseVariable {
        match self {
            Self::Speed => ReleaseVariable::Speed,
            Self::Pitch => ReleaseVariable::Pitch,
            Self::Polar => ReleaseVariable::Polar,
            Self::Backspin => ReleaseVariable::Backspin,
            Self::SideSpin => ReleaseVariable::SideSpin,
            Self::RifleSpin => ReleaseVariable::RifleSpin,
        }
    }
}
