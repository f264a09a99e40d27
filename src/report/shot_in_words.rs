//! A best shot on a page, and its description in words.

use crate::plots::shot_with_probability::PlottedShot;
use crate::present::words::capitalised;
use crate::shooter::Location;
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem, with_decimals};

/// A best shot on a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportShot {
    /// Number of its place on the page.
    pub place: usize,
    /// The location of the shooter.
    pub location: Location,
    /// The shot with its probability.
    pub shot: PlottedShot,
    /// The index of the shot whose mirror image this is, if any.
    pub mirror_of: Option<usize>,
}

impl ReportShot {
    /// One sentence with the shot's kind, probability and nominal values.
    #[must_use]
    pub fn description(&self, units: UnitSystem) -> String {
        let (long, unit_m) = units.length();
        let nominal = &self.shot.nominal;
        let kind = capitalised(self.shot.kind.name());
        // The simulation error, where the probability has no interval of its own.
        let error = match self.shot.standard_error {
            error if error > 0.0 => format!(" (simulation error {:.1})", 100.0 * error),
            _ => String::new(),
        };
        format!(
            "{kind}: {:.1} of 100 go in{error}; {:.2} {long}/s, angle {:.1} deg, direction {:.1} deg, backspin {:.1} rev/s.",
            100.0 * self.shot.probability,
            nominal.speed_m_s / unit_m,
            nominal.pitch_rad / DEGREE_RAD,
            with_decimals(nominal.polar_rad / DEGREE_RAD, 1),
            nominal.backspin_rad_s / REV_RAD
        )
    }
}

/// The shot with the largest P.
pub(super) fn most_probable(shots: &[ReportShot]) -> Option<&ReportShot> {
    shots
        .iter()
        .max_by(|a, b| a.shot.probability.total_cmp(&b.shot.probability))
}
