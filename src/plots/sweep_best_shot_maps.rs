//! The best shot of either kind over the court, one map for each of its values: P, kind, pitch
//! angle, backspin, gain from backspin, and the costliest error.

use super::colormaps::{OKABE_ITO, Rgb, sequential};
use super::colour_key::{ColourKey, ColourScale};
use super::svg::Plot;
use super::svg::{Anchor, Svg, shortened};
use super::sweep_results::{PlaceResults, SweepResults};
use crate::best_shot::ShotKind;
use crate::shooter::ReleaseVariable;
use crate::sweep::columns::{self, RealColumn};
use crate::sweep::probability_by_place::Preference;
use crate::units::{DEGREE_RAD, REV_RAD};

/// Colours of the kinds of shots.
const KIND_COLOURS: [(Preference, Rgb); 3] = [
    (Preference::Direct, OKABE_ITO[4]),
    (Preference::Bank, OKABE_ITO[0]),
    (Preference::Either, [225, 225, 225]),
];

/// The texts of a map.
struct MapTexts {
    /// File name.
    name: &'static str,
    title: &'static str,
    caption: &'static str,
}

/// A map of a column of the results.
struct ColumnMap {
    texts: MapTexts,
    column: RealColumn,
    unit: &'static str,
    /// Size of the unit in SI units.
    unit_si: f64,
}

const COLUMN_MAPS: [ColumnMap; 3] = [
    ColumnMap {
        texts: MapTexts {
            name: "best_pitch",
            title: "pitch angle of the best shot",
            caption: "The pitch angle of the best shot from each place.",
        },
        column: columns::PITCH,
        unit: "deg",
        unit_si: DEGREE_RAD,
    },
    ColumnMap {
        texts: MapTexts {
            name: "best_spin",
            title: "backspin of the best shot",
            caption: "The backspin of the best shot from each place.",
        },
        column: columns::BACKSPIN,
        unit: "rev/s",
        unit_si: REV_RAD,
    },
    ColumnMap {
        texts: MapTexts {
            name: "spin_worth",
            title: "what the best backspin adds",
            caption: "What the best backspin adds to no backspin, with the speed re-tuned.",
        },
        column: columns::BEST_BACKSPIN_OVER_NONE,
        unit: "probability gained",
        unit_si: 1.0,
    },
];

/// Draws a map of each value that the sweep computed.
#[must_use]
pub fn draw_all(results: &SweepResults<'_>) -> Vec<Plot> {
    let mut plots = Vec::new();
    plots.extend(draw_probability(results));
    plots.extend(draw_kind(results));
    for map in &COLUMN_MAPS {
        plots.extend(draw_column(results, map));
    }
    plots.extend(draw_costliest_error(results));
    plots
}

/// One map; `None` if no place has a colour.
fn draw_map(
    results: &SweepResults<'_>,
    texts: &MapTexts,
    key: &ColourKey<'_>,
    colour: &dyn Fn(&PlaceResults) -> Option<Rgb>,
) -> Option<Plot> {
    if results.places().iter().all(|place| colour(place).is_none()) {
        return None;
    }
    let map = results.court_map();
    let (width, height) = map.size();
    let mut svg = Svg::new(width + 40.0, height + 50.0);
    let title = shortened(&results.shooter_name(), 50);
    svg.heading((20.0, 24.0), 15.0, Anchor::Start, &title);
    results.draw_on(&map, &mut svg, (0.0, 30.0), texts.title, key, colour);
    let note = shortened(&results.source_note(), 90);
    svg.footnote((20.0, height + 40.0), &note);
    Some(Plot {
        name: texts.name.to_owned(),
        caption: texts.caption.to_owned(),
        svg: svg.finish(texts.caption),
    })
}

fn draw_probability(results: &SweepResults<'_>) -> Option<Plot> {
    let texts = MapTexts {
        name: "best_p",
        title: "probability of the best shot",
        caption: "Probability that the best shot from each place goes in.",
    };
    let key = ColourKey::Scale(ColourScale::PROBABILITY);
    draw_map(results, &texts, &key, &|place| {
        Some(sequential(place.best()?.real(columns::PROBABILITY)?))
    })
}

/// `None` if the sweep has one kind only.
fn draw_kind(results: &SweepResults<'_>) -> Option<Plot> {
    if !results.has_both_kinds() {
        return None;
    }
    let texts = MapTexts {
        name: "best_kind",
        title: "the best kind of shot",
        caption: "Which kind of shot is the best one from each place.",
    };
    let names = KIND_COLOURS.map(|(kind, colour)| (kind.name().to_owned(), colour));
    draw_map(results, &texts, &ColourKey::Legend(&names), &|place| {
        let [direct, bank] = ShotKind::ALL.map(|kind| results.probability(place, kind));
        let preference = Preference::of(direct, bank)?;
        let found = KIND_COLOURS.iter().find(|(known, _)| *known == preference);
        found.map(|(_, colour)| *colour)
    })
}

/// A map of a column with a scale from its least to its greatest value.
fn draw_column(results: &SweepResults<'_>, map: &ColumnMap) -> Option<Plot> {
    let value = |place: &PlaceResults| Some(place.best()?.real(map.column)? / map.unit_si);
    let (low, high) = results.places().iter().filter_map(value).fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(low, high): (f64, f64), v| (low.min(v), high.max(v)),
    );
    if !(low <= high) {
        return None;
    }
    // A scale needs a length, even if all values are the same.
    let (low, high) = if high - low < 1e-6 {
        (low - 0.5, high + 0.5)
    } else {
        (low, high)
    };
    let colour = |v: f64| sequential((v - low) / (high - low));
    let key = ColourKey::Scale(ColourScale {
        name: map.unit,
        range: (low, high),
        colour: &colour,
    });
    draw_map(results, &map.texts, &key, &|place| value(place).map(colour))
}

fn draw_costliest_error(results: &SweepResults<'_>) -> Option<Plot> {
    let texts = MapTexts {
        name: "costliest_error",
        title: "the error that costs most",
        caption: "The error that costs the best shot most from each place.",
    };
    let costliest = |place: &PlaceResults| {
        let name = place.best()?.text(columns::COSTLIEST_ERROR)?;
        Some(name.replace('_', " "))
    };
    let is_shown = |name: &String| {
        let mut names = results.places().iter().filter_map(costliest);
        names.any(|other| other == *name)
    };
    let names: Vec<(String, Rgb)> = ReleaseVariable::ALL
        .iter()
        .map(|variable| {
            // There are nine variables and eight colours: the last variable, the height, is black.
            let colour = OKABE_ITO.get(variable.index()).copied();
            (
                variable.name().replace('_', " "),
                colour.unwrap_or_default(),
            )
        })
        .filter(|(name, _)| is_shown(name))
        .collect();
    draw_map(results, &texts, &ColourKey::Legend(&names), &|place| {
        let name = costliest(place)?;
        let found = names.iter().find(|(known, _)| *known == name);
        found.map(|(_, colour)| *colour)
    })
}
