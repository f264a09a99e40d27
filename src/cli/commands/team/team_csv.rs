//! `team.csv`: every place and player.

use super::player_sweep::{PlayerSweep, best_players};
use super::words::whole_percent;
use crate::sweep::probability_by_place::Preference;
use crate::units::{DEGREE_RAD, UnitSystem};

/// The table, with a header.
pub(super) fn team_csv(players: &[PlayerSweep], units: UnitSystem) -> String {
    let (unit, metre) = units.length();
    let (short, short_metre) = units.short_length();
    let quoted = |name: &str| format!("\"{}\"", name.replace('"', "\"\""));
    let mut text =
        format!("place,name,x_{unit},y_{unit},distance_{unit},court_angle_deg,best_players");
    for player in players {
        for column in [
            "direct",
            "direct error",
            "bank",
            "bank error",
            "shoot",
            "probability %",
            &format!("bank aim right of the board's middle {short}"),
            &format!("bank aim above the ring {short}"),
            "least bank gain over rings and boards",
        ] {
            text += &format!(",{}", quoted(&format!("{} {column}", player.name)));
        }
    }
    text.push('\n');
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.5}"));
    for (place, best) in best_players(players).into_iter().enumerate() {
        let known = &players[0].places[place];
        let location = known.place.location();
        text += &format!(
            "{place},{},{:.3},{:.3},{:.3},{:.2},{}",
            known.name.as_deref().map_or(String::new(), quoted),
            known.place.x_m / metre,
            known.place.y_m / metre,
            location.distance_m / metre,
            location.angle_rad / DEGREE_RAD,
            match &best[..] {
                [] => String::new(),
                best => {
                    let names: Vec<&str> = best.iter().map(|i| players[*i].name.as_str()).collect();
                    quoted(&names.join("; "))
                }
            }
        );
        for player in players {
            let chances = &player.places[place];
            for p in [chances.direct, chances.bank] {
                text += &format!(
                    ",{},{}",
                    number(p.map(|p| p.value)),
                    number(p.map(|p| p.standard_error))
                );
            }
            text += &format!(",{}", chances.preference().map_or("", Preference::name));
            let share = chances.share_of_preferred();
            text += &share.map_or(",".to_owned(), |share| format!(",{}", whole_percent(share)));
            text += &chances
                .board_aim_m
                .map_or(",,".to_owned(), |(across_m, above_m)| {
                    format!(
                        ",{:.1},{:.1}",
                        across_m / short_metre,
                        above_m / short_metre
                    )
                });
            let least = chances.least_gain;
            text += &format!(",{}", number(least.map(|least| least.gain)));
        }
        text.push('\n');
    }
    text
}
