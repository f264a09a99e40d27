//! The places on the court that coaches have names for.
//!
//! Marks on the floor are those of the rule book of the court (see `league_courts.rs` and
//! [`PlaceName::source`]); the others are where the name is commonly used, and say so.

use super::league_courts::{Court, League};
use crate::units::FOOT_M;

/// A place without its side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceName {
    /// On the free-throw line.
    FreeThrow,
    /// Where the free-throw line meets the lane line.
    Elbow,
    /// The block beside the lane, where the low post stands.
    Block,
    /// Level with the hoop, between the lane and the three-point line.
    ShortCorner,
    /// 15 ft from the hoop, level with it.
    Baseline,
    /// 15 ft from the hoop at 45 deg.
    Wing,
    /// On the three-point line at 45 deg.
    WingThree,
    /// On the three-point line, level with the hoop.
    CornerThree,
    /// The top of the free-throw circle.
    TopOfTheKey,
    /// The top of the three-point arc.
    TopOfTheArc,
}

/// From here to there by custom, m.
const MID_RANGE_M: f64 = 15.0 * FOOT_M;

impl PlaceName {
    /// All of them, from the hoop outwards.
    pub const ALL: [Self; 10] = [
        Self::Block,
        Self::ShortCorner,
        Self::FreeThrow,
        Self::Elbow,
        Self::Baseline,
        Self::Wing,
        Self::TopOfTheKey,
        Self::CornerThree,
        Self::WingThree,
        Self::TopOfTheArc,
    ];

    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::FreeThrow => "free throw",
            Self::Elbow => "elbow",
            Self::Block => "block",
            Self::ShortCorner => "short corner",
            Self::Baseline => "baseline",
            Self::Wing => "wing",
            Self::WingThree => "wing three",
            Self::CornerThree => "corner three",
            Self::TopOfTheKey => "top of the key",
            Self::TopOfTheArc => "top of the arc",
        }
    }

    /// Whether it lies to both sides.
    #[must_use]
    pub fn has_sides(self) -> bool {
        !matches!(
            self,
            Self::FreeThrow | Self::TopOfTheKey | Self::TopOfTheArc
        )
    }

    /// Where its numbers come from.
    #[must_use]
    pub fn source(self) -> &'static str {
        match self {
            Self::FreeThrow => "rule book: the free-throw line",
            Self::Elbow => "rule book: free-throw line and lane line",
            Self::Block => "rule book: the mark between the first two players at the lane",
            Self::CornerThree => "rule book: three-point line; level with the hoop by custom",
            Self::WingThree => "rule book: three-point line; 45 deg by custom",
            Self::TopOfTheKey => "rule book: the free-throw circle",
            Self::TopOfTheArc => "rule book: three-point line",
            Self::ShortCorner => "custom: midway between lane line and three-point line",
            Self::Baseline | Self::Wing => "custom: 15 ft from the hoop",
        }
    }

    /// x and y to the right, m.
    fn right_of(self, league: League) -> (f64, f64) {
        let court: Court = league.court();
        let diagonal = std::f64::consts::FRAC_1_SQRT_2;
        match self {
            Self::FreeThrow => (court.free_throw_x_m, 0.0),
            Self::Elbow => (court.free_throw_x_m, court.lane_half_width_m),
            Self::Block => (league.block_x_m(), court.lane_half_width_m),
            Self::ShortCorner => (
                0.0,
                0.5 * (court.lane_half_width_m + court.three_corner_y_m),
            ),
            Self::Baseline => (0.0, MID_RANGE_M),
            Self::Wing => (MID_RANGE_M * diagonal, MID_RANGE_M * diagonal),
            Self::WingThree => (
                court.three_radius_m * diagonal,
                court.three_radius_m * diagonal,
            ),
            Self::CornerThree => (0.0, court.three_corner_y_m),
            Self::TopOfTheKey => (court.free_throw_x_m + court.circle_radius_m, 0.0),
            Self::TopOfTheArc => (court.three_radius_m, 0.0),
        }
    }
}

/// A place with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPlace {
    /// Such as `left elbow`.
    pub name: String,
    /// Without the side.
    pub of: PlaceName,
    /// x from the hoop's centre towards midcourt, m.
    pub x_m: f64,
    /// To the right as the shooter faces the hoop, m.
    pub y_m: f64,
}

/// All places of a court.
#[must_use]
pub fn named_places(league: League) -> Vec<NamedPlace> {
    let place = |of: PlaceName, side: &str| {
        let (x_m, y_m) = of.right_of(league);
        NamedPlace {
            name: format!("{side}{}", of.name()),
            of,
            x_m,
            y_m: if side == "left " { -y_m } else { y_m },
        }
    };
    PlaceName::ALL
        .into_iter()
        .flat_map(|of| match of.has_sides() {
            true => vec![place(of, "left "), place(of, "right ")],
            false => vec![place(of, "")],
        })
        .collect()
}

/// The place that a text names: `left elbow`, `Right Corner 3`, `FT`; `None` of other texts, and of
/// one without the side that it needs.
#[must_use]
pub fn place_named(text: &str, league: League) -> Option<NamedPlace> {
    let lower = text
        .to_lowercase()
        .replace("3-point", "three")
        .replace("3pt", "three");
    let words: Vec<&str> = lower
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(|word| match word {
            "l" | "lt" | "lft" => "left",
            "r" | "rt" | "rgt" => "right",
            "3" | "3s" | "3p" | "threes" | "pointer" => "three",
            "freethrow" | "freethrows" | "ft" | "fts" | "foul" | "charity" => "free",
            other => other,
        })
        .collect();
    let has = |word: &str| words.contains(&word);
    let known = [
        "left", "right", "three", "free", "throw", "throws", "line", "elbow", "block", "low",
        "post", "short", "corner", "baseline", "base", "wing", "top", "of", "the", "key", "arc",
        "side", "center", "centre", "middle", "shot", "shots", "mid", "range", "midrange", "point",
        "stripe", "circle",
    ];
    if !words.iter().all(|word| known.contains(word)) {
        return None;
    }
    let of = match () {
        () if has("free") => PlaceName::FreeThrow,
        () if has("elbow") => PlaceName::Elbow,
        () if has("block") || has("low") && has("post") => PlaceName::Block,
        () if has("corner") && has("short") => PlaceName::ShortCorner,
        () if has("corner") => PlaceName::CornerThree,
        () if has("wing") && has("three") => PlaceName::WingThree,
        () if has("wing") => PlaceName::Wing,
        () if has("baseline") || has("base") => PlaceName::Baseline,
        () if has("top") && (has("key") || has("circle")) => PlaceName::TopOfTheKey,
        () if has("top") || has("three") && (has("center") || has("centre") || has("middle")) => {
            PlaceName::TopOfTheArc
        }
        () => return None,
    };
    let all = named_places(league);
    match (of.has_sides(), has("left"), has("right")) {
        (false, false, false) => all.into_iter().find(|place| place.of == of),
        (true, true, false) => all
            .into_iter()
            .find(|place| place.of == of && place.y_m < 0.0),
        (true, false, true) => all
            .into_iter()
            .find(|place| place.of == of && place.y_m > 0.0),
        _ => None,
    }
}

/// What a place may be called, for a message.
#[must_use]
pub fn place_names_in_words() -> String {
    let names: Vec<String> = PlaceName::ALL
        .into_iter()
        .map(|of| match of.has_sides() {
            true => format!("left or right {}", of.name()),
            false => of.name().to_owned(),
        })
        .collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::DEGREE_RAD;

    #[test]
    fn val_places_of_the_rule_books() {
        let polar = |text: &str, league| {
            let place = place_named(text, league).unwrap();
            (
                libm::hypot(place.x_m, place.y_m) / FOOT_M,
                libm::atan2(place.y_m, place.x_m) / DEGREE_RAD,
            )
        };
        // NCAA: 15 ft from the backboard's face and a lane of 12 ft.
        let (distance, angle) = polar("right elbow", League::Ncaa);
        assert!((distance - 15.0).abs() < 0.01 && (angle - 23.57).abs() < 0.01);
        let (distance, angle) = polar("Left Elbow", League::Nba);
        assert!((distance - 15.91).abs() < 0.01 && (angle + 30.2).abs() < 0.05);
        let (distance, _) = polar("free throw", League::Fiba);
        assert!((distance * FOOT_M - 4.225).abs() < 1e-9);
        let (distance, angle) = polar("R corner 3", League::Nba);
        assert!((distance - 22.0).abs() < 1e-9 && (angle - 90.0).abs() < 1e-9);
        let (distance, _) = polar("top of the arc", League::HighSchool);
        assert!((distance - 19.75).abs() < 1e-9);
    }

    #[test]
    fn contract_places_have_many_spellings() {
        for (text, name) in [
            ("FT", "free throw"),
            ("Free Throw", "free throw"),
            ("foul line", "free throw"),
            ("elbow (left)", "left elbow"),
            ("L Elbow", "left elbow"),
            ("Left Wing 3", "left wing three"),
            ("right wing", "right wing"),
            ("Left Corner", "left corner three"),
            ("right short corner", "right short corner"),
            ("Left Block", "left block"),
            ("low post right", "right block"),
            ("Top of Key", "top of the key"),
            ("Top 3", "top of the arc"),
        ] {
            let found = place_named(text, League::Ncaa).map(|place| place.name);
            assert_eq!(found.as_deref(), Some(name), "{text}");
        }
        for text in ["elbow", "left", "Ana", "left free throw", "drive left", ""] {
            assert_eq!(place_named(text, League::Ncaa), None, "{text}");
        }
        for place in League::ALL.into_iter().flat_map(named_places) {
            assert_eq!(
                place_named(&place.name, League::Ncaa).map(|found| found.name),
                Some(place.name)
            );
        }
    }
}
