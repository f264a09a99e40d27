//! The results of a sweep by place, as its plots need them.

use super::colormaps::{NOT_SIGNIFICANT, Rgb, diverging};
use super::colour_key::ColourKey;
use super::court_map::{ColouredPlace, CourtMap, MapStyle};
use super::svg::{Svg, shortened};
use crate::analysis::sensitivity::Difference;
use crate::best_shot::ShotKind;
use crate::model::league_courts::Court;
use crate::sweep::bank_direct_difference::is_significant;
use crate::sweep::columns;
use crate::sweep::job_list::Jobs;
use crate::sweep::probability_by_place::PlaceProbabilities;
use crate::sweep::result_row::ResultRow;
use crate::sweep::{CourtPlace, Region, SweepConfig};
use crate::units::UnitSystem;
use std::collections::BTreeMap;

/// The results at one place.
pub(super) struct PlaceResults {
    pub(super) place: CourtPlace,
    /// One for each kind of the sweep; `None` if the job has no result yet.
    rows: Vec<Option<ResultRow>>,
}

impl PlaceResults {
    /// The row with the largest P of all kinds.
    pub(super) fn best(&self) -> Option<&ResultRow> {
        let p = |row: &ResultRow| row.real(columns::PROBABILITY);
        self.rows
            .iter()
            .flatten()
            .filter(|row| p(row).is_some())
            .reduce(|a, b| if p(b) > p(a) { b } else { a })
    }
}

/// With more places than this their circles are small, however far apart they are: all pairs would
/// take too long.
const FEW_PLACES: usize = 2000;

/// The results of a sweep by place.
pub struct SweepResults<'a> {
    config: &'a SweepConfig,
    court: Court,
    places: Vec<PlaceResults>,
    chances: Vec<PlaceProbabilities>,
    kinds: Vec<ShotKind>,
}

impl<'a> SweepResults<'a> {
    /// From the rows by the number of their job.
    #[must_use]
    pub fn new(config: &'a SweepConfig, rows: &BTreeMap<u64, ResultRow>) -> Self {
        let jobs = Jobs::new(config);
        let places = jobs
            .sources
            .iter()
            .map(|source| PlaceResults {
                place: source.place,
                rows: (0..jobs.kinds.len())
                    .map(|kind| {
                        let row = rows.get(&jobs.number(source.computed, kind))?;
                        Some(if source.mirrored {
                            row.mirrored()
                        } else {
                            row.clone()
                        })
                    })
                    .collect(),
            })
            .collect();
        Self {
            config,
            court: config.league.court(),
            places,
            chances: PlaceProbabilities::of_sweep(config, rows),
            kinds: jobs.kinds,
        }
    }

    /// The results with chances of bank and direct, each known to be clear or not.
    #[must_use]
    pub fn with_chances(self, chances: Vec<PlaceProbabilities>) -> Self {
        Self { chances, ..self }
    }

    pub(super) fn places(&self) -> &[PlaceResults] {
        &self.places
    }

    /// The chances at each place.
    pub(super) fn chances(&self) -> &[PlaceProbabilities] {
        &self.chances
    }

    /// Units of the axes and of words.
    pub(super) fn units(&self) -> UnitSystem {
        self.config.settings.output.units
    }

    /// Whether the sweep has bank and direct shots.
    pub(super) fn has_both_kinds(&self) -> bool {
        self.kinds.len() == ShotKind::ALL.len()
    }

    /// P of the best shot of a kind at a place.
    pub(super) fn probability(&self, place: &PlaceResults, kind: ShotKind) -> Option<Difference> {
        let kind = self.kinds.iter().position(|&other| other == kind)?;
        place.rows[kind].as_ref()?.probability()
    }

    /// The shooter, as the title of a plot.
    pub(super) fn shooter_name(&self) -> String {
        shortened(&self.config.settings.shooter.name, 60)
    }

    /// The shooter and the sweep, to tell two sweeps apart.
    pub(super) fn name(&self) -> String {
        format!(
            "{} ({})",
            shortened(&self.config.settings.shooter.name, 40),
            shortened(&self.config.name, 30)
        )
    }

    /// The program, the shooter and the size of the sweep, for footnotes.
    pub(super) fn source_note(&self) -> String {
        format!(
            "bankshot {}, {}, {} court, {} places, simulation error {}",
            env!("CARGO_PKG_VERSION"),
            self.shooter_name(),
            self.config.league.name().to_uppercase(),
            self.places.len(),
            self.config.settings.search.standard_error()
        )
    }

    /// As [`Self::source_note`], for several players on the same places.
    pub(super) fn team_note(&self, players: usize) -> String {
        format!(
            "bankshot {}, {players} players, {} court, {} places. Each profile is taken as exact.",
            env!("CARGO_PKG_VERSION"),
            self.config.league.name().to_uppercase(),
            self.places.len(),
        )
    }

    /// A map of the court that shows every place.
    pub(super) fn court_map(&self) -> CourtMap<'_> {
        let settings = &self.config.settings;
        let places = self.places.iter();
        let at = |results: &PlaceResults| (results.place.x_m, results.place.y_m);
        let gap = |a: (f64, f64), b: (f64, f64)| libm::hypot(a.0 - b.0, a.1 - b.1);
        let gaps = self.places.iter().enumerate().flat_map(|(i, a)| {
            let before = self.places[..i].iter();
            before.map(move |b| gap(at(a), at(b)))
        });
        let region = &self.config.region;
        let is_grid = matches!(region, Region::HalfCourt { .. } | Region::Rectangle { .. });
        let least_gap_m = if is_grid || self.places.len() > FEW_PLACES {
            0.0
        } else {
            gaps.fold(f64::INFINITY, f64::min)
        };
        CourtMap {
            court: &self.court,
            physics: &settings.physics,
            units: settings.output.units,
            least_gap_m,
            step_m: match self.config.region {
                Region::HalfCourt { step_m, .. } | Region::Rectangle { step_m, .. } => Some(step_m),
                _ => None,
            },
            far_x_m: places.fold(0.0, |far: f64, results| far.max(results.place.x_m)),
            style: MapStyle::Plot,
        }
    }

    /// Draws a colour for each place on a map.
    pub(super) fn draw_on(
        &self,
        map: &CourtMap<'_>,
        svg: &mut Svg,
        corner: (f64, f64),
        title: &str,
        key: &ColourKey<'_>,
        colour: &dyn Fn(&PlaceResults) -> Option<Rgb>,
    ) {
        let places: Vec<ColouredPlace> = self
            .places
            .iter()
            .map(|results| ColouredPlace {
                x_m: results.place.x_m,
                y_m: results.place.y_m,
                colour: colour(results),
            })
            .collect();
        map.draw(svg, corner, title, &places, key);
    }
}

/// The largest absolute value of some differences, for the ends of a colour scale.
pub(super) fn largest_difference(differences: impl Iterator<Item = Difference>) -> f64 {
    differences.fold(0.0, |largest: f64, by| largest.max(by.value.abs()))
}

/// The colour of a difference on a scale from `-largest` to `largest`.
pub(super) fn difference_colour(difference: Difference, largest: f64) -> Rgb {
    if is_significant(difference) {
        diverging(difference.value / largest)
    } else {
        NOT_SIGNIFICANT
    }
}
