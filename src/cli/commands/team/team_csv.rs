//! `team.csv`: every place and player.

use super::player_sweep::{PlayerSweep, best_players};
use super::words::whole_percent;
use crate::files::csv_text::CsvText;
use crate::sweep::probability_by_place::Preference;
use crate::units::{DEGREE_RAD, UnitSystem};

/// The table, with a header.
pub(super) fn team_csv(players: &[PlayerSweep], units: UnitSystem) -> Vec<u8> {
    let (unit, metre) = units.length();
    let (short, short_metre) = units.short_length();
    let places = ["place", "name"].map(str::to_owned).into_iter();
    let places = places.chain(["x", "y", "distance"].map(|length| format!("{length}_{unit}")));
    let places = places.chain(["court_angle_deg", "best_players"].map(str::to_owned));
    let of_player = [
        "direct",
        "direct error",
        "bank",
        "bank error",
        "shoot",
        "probability %",
        &format!("bank aim right of the board's middle {short}"),
        &format!("bank aim above the ring {short}"),
        "least bank gain over rings and boards",
    ];
    let of_players = players
        .iter()
        .flat_map(|player| of_player.map(|column| format!("{} {column}", player.name)));
    let mut table = CsvText::default();
    table.row(places.chain(of_players));
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.5}"));
    for (place, best) in best_players(players).into_iter().enumerate() {
        let known = &players[0].places[place];
        let location = known.place.location();
        let names: Vec<&str> = best.iter().map(|i| players[*i].name.as_str()).collect();
        let mut cells = vec![
            place.to_string(),
            known.name.clone().unwrap_or_default(),
            format!("{:.3}", known.place.x_m / metre),
            format!("{:.3}", known.place.y_m / metre),
            format!("{:.3}", location.distance_m / metre),
            format!("{:.2}", location.angle_rad / DEGREE_RAD),
            names.join("; "),
        ];
        for player in players {
            let chances = &player.places[place];
            for p in [chances.direct, chances.bank] {
                cells.push(number(p.map(|p| p.value)));
                cells.push(number(p.map(|p| p.standard_error)));
            }
            let preference = chances.preference().map_or("", Preference::name);
            cells.push(preference.to_owned());
            let share = chances.share_of_preferred();
            cells.push(share.map_or_else(String::new, |share| whole_percent(share).to_string()));
            let aim = chances.board_aim_m;
            let short = |length_m: f64| format!("{:.1}", length_m / short_metre);
            cells.push(aim.map_or_else(String::new, |(across_m, _)| short(across_m)));
            cells.push(aim.map_or_else(String::new, |(_, above_m)| short(above_m)));
            cells.push(number(chances.least_gain.map(|least| least.gain)));
        }
        table.row(cells);
    }
    table.into_bytes()
}
