//! `shots.csv`: each measured shot, its release, its chance, and what is odd about it.

use crate::files::csv_text::CsvText;
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
    let mut header = ["row", "session", "place", "shot"]
        .map(str::to_owned)
        .to_vec();
    for (name, (unit, _)) in VALUE_NAMES.iter().zip(of_value) {
        let unit = unit.replace('/', "_");
        header.extend([format!("{name}_{unit}"), format!("{name}_error_{unit}")]);
    }
    header.push("entry_angle_deg".to_owned());
    header.extend([format!("depth_{short}"), format!("left_right_{short}")]);
    let last = [
        "chance",
        "swish_chance",
        "made",
        "distance_from_aim_sd",
        "flag",
    ];
    header.extend(last.map(str::to_owned));
    let empty =
        |cells: &mut Vec<String>, count: usize| cells.resize(cells.len() + count, String::new());
    let mut table = CsvText::default();
    table.row(&header);
    for shot in &fit.makes.shots {
        let [session, name] = labels.get(&shot.row).copied().unwrap_or_default();
        let mut cells = vec![
            shot.row.to_string(),
            session.to_owned(),
            (shot.place + 1).to_string(),
            name.to_owned(),
        ];
        if fit.posterior.spin == SpinSource::NothingMeasured {
            empty(&mut cells, 2 * of_value.len() + 3);
            let made = u8::from(shot.made == Some(true));
            cells.extend([
                format!("{:.3}", shot.chance),
                String::new(),
                made.to_string(),
            ]);
            empty(&mut cells, 2);
            table.row(cells);
            continue;
        }
        for (i, (_, size)) in of_value.iter().enumerate() {
            cells.push(format!("{:.4}", shot.release[i] / size));
            cells.push(format!("{:.4}", shot.release_sd[i] / size));
        }
        let (simulator, place) = (
            fit.profiles[shot.place].simulator(),
            &fit.places[shot.place],
        );
        match landing_of(simulator, place, &shot.release) {
            Some(landing) => cells.extend([
                format!("{:.2}", landing.entry_angle_rad / DEGREE_RAD),
                format!("{:.2}", landing.depth_m / inch),
                format!("{:.2}", landing.right_m / inch),
            ]),
            None => empty(&mut cells, 3),
        }
        let made = shot.made.map_or("", |made| if made { "1" } else { "0" });
        // Beyond this distance are 1 in 1000 shots of a normal shooter (chi with 4 degrees of
        // freedom).
        let flag = if shot.distance > 4.3 { "far" } else { "" };
        cells.extend([
            format!("{:.3}", shot.chance),
            format!("{:.3}", shot.swish_chance),
            made.to_owned(),
            format!("{:.2}", shot.distance),
            flag.to_owned(),
        ]);
        table.row(cells);
    }
    for (row, reason) in rejected {
        let mut cells = vec![row.to_string()];
        empty(&mut cells, header.len() - 2);
        cells.push(format!("kept out: {}", reason.replace('"', "'")));
        table.row(cells);
    }
    table.into_bytes()
}
