//! The columns of a sweep's results: the one definition behind the store, the CSV and the Parquet
//! tables.
//!
//! Each column is a constant with the type of its values, so a wrong name or type does not compile.

use crate::shooter::ReleaseVariable;
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// The type of a column's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnType {
    /// Floating-point numbers.
    Real,
    /// Whole numbers.
    Integer,
    /// Text.
    Text,
}

/// The unit of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnUnit {
    /// No unit.
    None,
    /// Lengths on the court: m in the store; m or ft.
    Length,
    /// Lengths near the ring: m in the store; cm or in.
    ShortLength,
    /// m/s in the store; m/s or ft/s.
    Speed,
    /// rad in the store; deg.
    Angle,
    /// rad/s in the store; rev/s.
    Spin,
    /// s.
    Time,
}

impl ColumnUnit {
    /// The suffix of a column's name in the store.
    fn si_suffix(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Length | Self::ShortLength => "_m",
            Self::Speed => "_m_s",
            Self::Angle => "_rad",
            Self::Spin => "_rad_s",
            Self::Time => "_s",
        }
    }

    /// The suffix of a column's name in the tables, and the size of the unit in SI units.
    #[must_use]
    pub fn in_system(self, system: UnitSystem) -> (String, f64) {
        let (long, metre) = system.length();
        let (short, short_metre) = system.short_length();
        match self {
            Self::None => (String::new(), 1.0),
            Self::Length => (format!("_{long}"), metre),
            Self::ShortLength => (format!("_{short}"), short_metre),
            Self::Speed => (format!("_{long}_s"), metre),
            Self::Angle => ("_deg".to_owned(), DEGREE_RAD),
            Self::Spin => ("_rev_s".to_owned(), REV_RAD),
            Self::Time => ("_s".to_owned(), 1.0),
        }
    }
}

/// One column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name without the unit.
    pub name: &'static str,
    /// The type of its values.
    pub column_type: ColumnType,
    /// Its unit.
    pub unit: ColumnUnit,
    /// Whether the sign changes in the mirror image (y -> -y).
    pub is_odd_in_mirror: bool,
}

impl Column {
    /// Its name in the store.
    #[must_use]
    pub fn si_name(&self) -> String {
        format!("{}{}", self.name, self.unit.si_suffix())
    }

    /// Its name in the tables.
    #[must_use]
    pub fn name_in(&self, system: UnitSystem) -> String {
        format!("{}{}", self.name, self.unit.in_system(system).0)
    }
}

/// A column of floating-point numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RealColumn(usize);

/// A column of whole numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IntegerColumn(usize);

/// A column of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextColumn(usize);

impl RealColumn {
    pub(super) const fn index(self) -> usize {
        self.0
    }
}

impl IntegerColumn {
    pub(super) const fn index(self) -> usize {
        self.0
    }
}

impl TextColumn {
    pub(super) const fn index(self) -> usize {
        self.0
    }
}

/// Defines a constant for each column, and the list of all of them in this order.
macro_rules! columns {
    ($($constant:ident: $handle:ident = $name:literal, $type:ident, $unit:ident $(, $odd:ident)?;)+) => {
        #[allow(non_camel_case_types, clippy::upper_case_acronyms)]
        enum Index { $($constant),+ }
        $(
            #[doc = concat!("The column `", $name, "`.")]
            pub const $constant: $handle = $handle(Index::$constant as usize);
        )+
        /// Every column in the order of the tables.
        pub const ALL: &[Column] = &[$(Column {
            name: $name,
            column_type: ColumnType::$type,
            unit: ColumnUnit::$unit,
            is_odd_in_mirror: columns!(@odd $($odd)?),
        }),+];
    };
    (@odd odd) => { true };
    (@odd) => { false };
}

columns! {
    KIND: TextColumn = "kind", Text, None;
    X: RealColumn = "x", Real, Length;
    Y: RealColumn = "y", Real, Length, odd;
    DISTANCE: RealColumn = "distance", Real, Length;
    COURT_ANGLE: RealColumn = "court_angle", Real, Angle, odd;
    STATUS: TextColumn = "status", Text, None;
    REASON: TextColumn = "reason", Text, None;
    SPEED: RealColumn = "speed", Real, Speed;
    PITCH: RealColumn = "pitch", Real, Angle;
    POLAR: RealColumn = "polar", Real, Angle, odd;
    BACKSPIN: RealColumn = "backspin", Real, Spin;
    RIFLE_SPIN: RealColumn = "rifle_spin", Real, Spin, odd;
    SIDE_SPIN: RealColumn = "side_spin", Real, Spin, odd;
    PROBABILITY: RealColumn = "probability", Real, None;
    STANDARD_ERROR: RealColumn = "standard_error", Real, None;
    SHOTS: IntegerColumn = "shots", Integer, None;
    SHARE_SWISH: RealColumn = "share_swish", Real, None;
    SHARE_RING: RealColumn = "share_ring", Real, None;
    SHARE_BOARD: RealColumn = "share_board", Real, None;
    SHARE_BOARD_AND_RING: RealColumn = "share_board_and_ring", Real, None;
    UNRESOLVED: IntegerColumn = "unresolved", Integer, None;
    SEARCH_PROBABILITY: RealColumn = "search_probability", Real, None;
    ERROR_FREE_KIND: TextColumn = "error_free_kind", Text, None;
    ENTRY_ANGLE: RealColumn = "entry_angle", Real, Angle;
    AIM_PAST_CENTRE: RealColumn = "aim_past_centre", Real, ShortLength;
    BOARD_AIM_ACROSS: RealColumn = "board_aim_across", Real, ShortLength, odd;
    BOARD_AIM_ABOVE_HOOP: RealColumn = "board_aim_above_hoop", Real, ShortLength;
    APEX_ABOVE_FLOOR: RealColumn = "apex_above_floor", Real, Length;
    FLIGHT_TIME: RealColumn = "flight_time", Real, Time;
    MASS_OUTSIDE_BRACKET: RealColumn = "mass_outside_bracket", Real, None;
    AT_LIMITS: TextColumn = "at_limits", Text, None;
    BEST_BACKSPIN_OVER_NONE: RealColumn = "best_backspin_over_none", Real, None;
    BEST_BACKSPIN_OVER_NONE_ERROR: RealColumn = "best_backspin_over_none_error", Real, None;
    COSTLIEST_ERROR: TextColumn = "costliest_error", Text, None;
    GAIN_WITHOUT_COSTLIEST: RealColumn = "gain_without_costliest", Real, None;
    GAIN_WITHOUT_COSTLIEST_ERROR: RealColumn = "gain_without_costliest_error", Real, None;
    GAIN_WITHOUT_SPEED: RealColumn = "gain_without_speed", Real, None;
    GAIN_WITHOUT_SPEED_ERROR: RealColumn = "gain_without_speed_error", Real, None;
    GAIN_WITHOUT_PITCH: RealColumn = "gain_without_pitch", Real, None;
    GAIN_WITHOUT_PITCH_ERROR: RealColumn = "gain_without_pitch_error", Real, None;
    GAIN_WITHOUT_POLAR: RealColumn = "gain_without_polar", Real, None;
    GAIN_WITHOUT_POLAR_ERROR: RealColumn = "gain_without_polar_error", Real, None;
    GAIN_WITHOUT_BACKSPIN: RealColumn = "gain_without_backspin", Real, None;
    GAIN_WITHOUT_BACKSPIN_ERROR: RealColumn = "gain_without_backspin_error", Real, None;
    GAIN_WITHOUT_RIFLE_SPIN: RealColumn = "gain_without_rifle_spin", Real, None;
    GAIN_WITHOUT_RIFLE_SPIN_ERROR: RealColumn = "gain_without_rifle_spin_error", Real, None;
    GAIN_WITHOUT_SIDE_SPIN: RealColumn = "gain_without_side_spin", Real, None;
    GAIN_WITHOUT_SIDE_SPIN_ERROR: RealColumn = "gain_without_side_spin_error", Real, None;
    GAIN_WITHOUT_DISTANCE: RealColumn = "gain_without_distance", Real, None;
    GAIN_WITHOUT_DISTANCE_ERROR: RealColumn = "gain_without_distance_error", Real, None;
    GAIN_WITHOUT_COURT_ANGLE: RealColumn = "gain_without_court_angle", Real, None;
    GAIN_WITHOUT_COURT_ANGLE_ERROR: RealColumn = "gain_without_court_angle_error", Real, None;
    GAIN_WITHOUT_HEIGHT: RealColumn = "gain_without_height", Real, None;
    GAIN_WITHOUT_HEIGHT_ERROR: RealColumn = "gain_without_height_error", Real, None;
}

/// Gain in P without the error in a variable, and its standard error.
#[must_use]
pub const fn gain_without(variable: ReleaseVariable) -> [RealColumn; 2] {
    match variable {
        ReleaseVariable::Speed => [GAIN_WITHOUT_SPEED, GAIN_WITHOUT_SPEED_ERROR],
        ReleaseVariable::Pitch => [GAIN_WITHOUT_PITCH, GAIN_WITHOUT_PITCH_ERROR],
        ReleaseVariable::Polar => [GAIN_WITHOUT_POLAR, GAIN_WITHOUT_POLAR_ERROR],
        ReleaseVariable::Backspin => [GAIN_WITHOUT_BACKSPIN, GAIN_WITHOUT_BACKSPIN_ERROR],
        ReleaseVariable::RifleSpin => [GAIN_WITHOUT_RIFLE_SPIN, GAIN_WITHOUT_RIFLE_SPIN_ERROR],
        ReleaseVariable::SideSpin => [GAIN_WITHOUT_SIDE_SPIN, GAIN_WITHOUT_SIDE_SPIN_ERROR],
        ReleaseVariable::Distance => [GAIN_WITHOUT_DISTANCE, GAIN_WITHOUT_DISTANCE_ERROR],
        ReleaseVariable::CourtAngle => [GAIN_WITHOUT_COURT_ANGLE, GAIN_WITHOUT_COURT_ANGLE_ERROR],
        ReleaseVariable::Height => [GAIN_WITHOUT_HEIGHT, GAIN_WITHOUT_HEIGHT_ERROR],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_each_column_has_its_own_name_and_the_gains_have_theirs() {
        let mut names: Vec<_> = ALL.iter().map(|column| column.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), ALL.len());
        for variable in ReleaseVariable::ALL {
            let [gain, error] = gain_without(variable);
            let expected = format!("gain_without_{}", variable.name());
            assert_eq!(ALL[gain.index()].name, expected);
            assert_eq!(ALL[error.index()].name, format!("{expected}_error"));
        }
    }
}
