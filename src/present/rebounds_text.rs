//! Where the misses of a shot come down, in text.

use super::layout::{Side, TextTable, paragraph};
use crate::answers::rebounds::{ReboundGroup, ReboundsAnswer};
use crate::units::{UnitSystem, at_most_two_decimals};

/// The table of the misses by kind; empty where none comes down. `misses` are those, such as
/// `misses of the bank shot`.
#[must_use]
pub fn rebounds_text(answer: &ReboundsAnswer, misses: &str, units: UnitSystem) -> String {
    if answer.misses == 0 {
        return String::new();
    }
    let (long, metre) = units.length();
    let mut table = TextTable::new(&[
        ("miss", "", Side::Left),
        ("share", "", Side::Right),
        ("distance", long, Side::Right),
        ("middle half", "", Side::Left),
        ("beyond", "hoop", Side::Right),
        ("right of", "the line", Side::Right),
        ("time", "s", Side::Right),
    ]);
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let mut add = |group: &ReboundGroup| {
        let distance = &group.distance_m;
        table.add([
            group.miss.to_owned(),
            percent(group.share),
            format!("{:.1}", distance.median / metre),
            format!(
                "{:.1} to {:.1}",
                distance.lower_quartile / metre,
                distance.upper_quartile / metre
            ),
            percent(group.beyond_hoop),
            percent(group.right_of_line),
            format!("{:.1}", group.time_s),
        ]);
    };
    add(&answer.all);
    answer
        .groups
        .iter()
        .filter(|group| group.share >= 0.01)
        .for_each(&mut add);
    let heading = format!(
        "Where {misses} come down: the ball's centre at {} {long} above the floor, without net and players.",
        at_most_two_decimals(answer.height_m / metre).trim_end_matches(".0")
    );
    let floor = format!(
        "Half of them touch the floor {:.1} to {:.1} {long} from the hoop's centre.",
        answer.floor_distance_m.lower_quartile / metre,
        answer.floor_distance_m.upper_quartile / metre
    );
    paragraph(&heading) + &table.text() + &paragraph(&floor)
}
