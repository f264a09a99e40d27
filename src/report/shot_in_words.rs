//! A best shot on a page, and its description in words.

use crate::plots::shot_with_probability::PlottedShot;
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
    /// One sentence with the shot's kind, P and nominal values.
    #[must_use]
    pub fn description(&self, units: UnitSystem) -> String {
        let (long, unit_m) = units.length();
        let nominal = &self.shot.nominal;
        let mut kind = self.shot.kind.name().to_owned();
        if let Some(first) = kind.get_mut(0..1) {
            first.make_ascii_uppercase();
        }
        // The numerical error, where P has no interval of its own.
        let error = match self.shot.standard_error {
            error if error > 0.0 => format!(" \u{b1} {error:.3}"),
            _ => String::new(),
        };
        format!(
            "{kind}: P {:.3}{error}; {:.2} {long}/s, pitch {:.1} deg, polar {:.1} deg, backspin {:.1} rev/s.",
            self.shot.probability,
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
