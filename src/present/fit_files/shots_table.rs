//! `shots.csv`: each measured shot, its release, its chance, and what is odd about it.

use crate::fitting::{ShooterFit, SpinSource, VALUE_NAMES, landing_of};
use crate::store::parameters::value_units;
use crate::units::{DEGREE_RAD, UnitSystem};
use std::collections::BTreeMap;

/// The bytes of the table. `labels` are the session and the name of the shots by row, `rejected`
/// the rows kept out.
#[must_use]
pub fn shots_csv(
    fit: &ShooterFit,
    labels: &BTreeMap<u64, [&str; 2]>,
    rejected: &[(u64, String)],
    units: UnitSystem,
) -> Vec<u8> {
    let of_value = value_units(units);
    let (short, inch) = units.short_length();
    let mut out = String::from("row,session,place,shot");
    for (name, (unit, _)) in VALUE_NAMES.iter().zip(of_value) {
        let unit = unit.replace('/', "_");
        out += &format!(",{name}_{unit},{name}_error_{unit}");
    }
    out += &format!(",entry_angle_deg,depth_{short},left_right_{short}");
    out += ",chance,swish_chance,made,distance_from_aim_sd,flag\n";
    for shot in &fit.makes.shots {
        let [session, name] = labels.get(&shot.row).copied().unwrap_or_default();
        out += &format!(
            "{},{},{},{}",
            shot.row,
            quoted(session),
            shot.place + 1,
            quoted(name)
        );
        if fit.posterior.spin == SpinSource::NothingMeasured {
            let made = u8::from(shot.made == Some(true));
            out += &format!("{}{:.3},,{made},,\n", ",".repeat(12), shot.chance);
            continue;
        }
        for (i, (_, size)) in of_value.iter().enumerate() {
            out += &format!(
                ",{:.4},{:.4}",
                shot.release[i] / size,
                shot.release_sd[i] / size
            );
        }
        let (simulator, place) = (
            fit.profiles[shot.place].simulator(),
            &fit.places[shot.place],
        );
        out += &landing_of(simulator, place, &shot.release).map_or(",,,".to_owned(), |landing| {
            format!(
                ",{:.2},{:.2},{:.2}",
                landing.entry_angle_rad / DEGREE_RAD,
                landing.depth_m / inch,
                landing.right_m / inch
            )
        });
        let made = shot.made.map_or("", |made| if made { "1" } else { "0" });
        // Beyond this distance are 1 in 1000 shots of a normal shooter (chi with 4 degrees of
        // freedom).
        let flag = if shot.distance > 4.3 { "far" } else { "" };
        out += &format!(
            ",{:.3},{:.3},{made},{:.2},{flag}\n",
            shot.chance, shot.swish_chance, shot.distance
        );
    }
    for (row, reason) in rejected {
        out += &format!(
            "{row}{},\"kept out: {}\"\n",
            ",".repeat(18),
            reason.replace('"', "'")
        );
    }
    out.into_bytes()
}

/// A cell with quotes where it needs them.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
