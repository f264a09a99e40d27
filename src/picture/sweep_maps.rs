//! The maps of a sweep: P of bank and direct and their difference, and what is best where.

use super::colours::{NAMED, diverging, sequential};
use super::court_map::{Ground, Key, Spot, footnote};
use super::svg::{Anchor, Svg, shortened};
use crate::profile::ERROR_NAMES;
use crate::sweep::jobs::Jobs;
use crate::sweep::row::{Cell, Row};
use crate::sweep::{Configuration, Region};
use crate::units::{DEGREE_RAD, REV_RAD};
use std::collections::BTreeMap;

/// Standard errors that a difference must exceed to be coloured.
pub const SURE: f64 = 2.0;

/// A picture with the name of its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Without its ending.
    pub name: String,
    /// What it shows, in one sentence.
    pub caption: String,
    /// The SVG file.
    pub svg: String,
}

/// A place of the sweep with the rows of its kinds.
#[derive(Clone, Debug)]
pub struct At {
    /// x, m.
    pub x_m: f64,
    /// y, m.
    pub y_m: f64,
    /// The rows by the order of the kinds; none where there is no shot.
    pub rows: Vec<Option<Row>>,
}

/// A number of a row.
#[must_use]
pub fn number(row: &Row, name: &str) -> Option<f64> {
    match row.get(name) {
        Cell::Real(value) => Some(*value),
        _ => None,
    }
}

/// A sweep as its maps need it.
pub struct Sweep<'a> {
    configuration: &'a Configuration,
    places: Vec<At>,
    kinds: Vec<&'static str>,
}

impl<'a> Sweep<'a> {
    /// From every result that is there.
    #[must_use]
    pub fn new(configuration: &'a Configuration, rows: &BTreeMap<u64, Row>) -> Self {
        let jobs = Jobs::new(configuration);
        let places = jobs
            .sources
            .iter()
            .map(|source| At {
                x_m: source.spot.x_m,
                y_m: source.spot.y_m,
                rows: (0..jobs.kinds.len())
                    .map(|kind| {
                        let row = rows.get(&jobs.number(source.place, kind))?;
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
            configuration,
            places,
            kinds: jobs.kinds.iter().map(|kind| kind.name()).collect(),
        }
    }

    /// Its places.
    #[must_use]
    pub fn places(&self) -> &[At] {
        &self.places
    }

    fn step_m(&self) -> Option<f64> {
        match self.configuration.region {
            Region::HalfCourt { step_m, .. } | Region::Rectangle { step_m, .. } => Some(step_m),
            _ => None,
        }
    }

    fn far_x_m(&self) -> f64 {
        self.places.iter().fold(0.0, |far: f64, at| far.max(at.x_m))
    }

    fn title(&self) -> String {
        shortened(&self.configuration.template.shooter.name, 60)
    }

    /// The shooter, and the sweep where it has a name of its own.
    fn named(&self) -> String {
        let sweep = shortened(&self.configuration.name, 30);
        format!(
            "{} ({sweep})",
            shortened(&self.configuration.template.shooter.name, 40)
        )
    }

    /// P and its standard error of a kind at a place.
    fn p(&self, at: &At, kind: &str) -> Option<(f64, f64)> {
        let kind = self.kinds.iter().position(|name| *name == kind)?;
        let row = at.rows[kind].as_ref()?;
        Some((number(row, "probability")?, number(row, "standard_error")?))
    }

    /// The row with the largest P.
    fn best<'b>(&self, at: &'b At) -> Option<&'b Row> {
        let p = |row: &&Row| number(row, "probability").unwrap_or(-1.0);
        at.rows
            .iter()
            .flatten()
            .filter(|row| p(row) >= 0.0)
            .reduce(|a, b| if p(&b) > p(&a) { b } else { a })
    }

    /// Which sweep a picture comes from.
    fn source(&self) -> String {
        let template = &self.configuration.template;
        format!(
            "bankshot {}, {}, {} court, {} places, P to {}",
            env!("CARGO_PKG_VERSION"),
            self.title(),
            self.configuration.league.name().to_uppercase(),
            self.places.len(),
            template.standard_error()
        )
    }

    fn draw(
        &self,
        ground: &Ground<'_>,
        svg: &mut Svg,
        corner: (f64, f64),
        title: &str,
        key: &Key<'_>,
        colour: &dyn Fn(&At) -> Option<[u8; 3]>,
    ) {
        let spots: Vec<Spot> = self
            .places
            .iter()
            .map(|at| Spot {
                x_m: at.x_m,
                y_m: at.y_m,
                colour: colour(at),
            })
            .collect();
        ground.draw(svg, corner, title, &spots, key);
    }

    fn with_ground<T>(&self, far_x_m: f64, act: impl FnOnce(&Ground<'_>) -> T) -> T {
        let template = &self.configuration.template;
        act(&Ground {
            court: &self.configuration.league.court(),
            physics: &template.physics,
            units: template.output.units,
            step_m: self.step_m(),
            far_x_m,
        })
    }

    /// Bank and direct side by side with their difference, the area where the bank shot wins outlined.
    #[must_use]
    pub fn bank_and_direct(&self) -> Option<Picture> {
        if self.kinds.len() < 2 {
            return None;
        }
        let gain = |at: &At| {
            let ((direct, a), (bank, b)) = (self.p(at, "direct")?, self.p(at, "bank")?);
            Some((bank - direct, libm::hypot(a, b)))
        };
        let sure = |at: &At| gain(at).filter(|(by, error)| by.abs() > SURE * error);
        // The same number of points on both sides, at most 10: beyond it the colour is full.
        let most = self
            .places
            .iter()
            .filter_map(gain)
            .fold(0.0, |most: f64, (by, _)| most.max(by.abs()))
            .clamp(0.02, 0.1);
        let wins: Vec<&At> = self
            .places
            .iter()
            .filter(|at| sure(at).is_some_and(|(by, _)| by > 0.0))
            .collect();
        let sentence = format!(
            "The bank shot is the better one at {} of {} places, by more than {SURE} standard errors.",
            wins.len(),
            self.places.iter().filter(|at| gain(at).is_some()).count()
        );
        let svg = self.with_ground(self.far_x_m(), |ground| {
            let (width, height) = ground.size();
            let mut svg = Svg::new(3.0 * width, height + 62.0);
            svg.heading((20.0, 24.0), 16.0, Anchor::Start, &format!("Bank and direct: {}", self.title()));
            let top = 34.0;
            for (i, kind) in ["direct", "bank"].into_iter().enumerate() {
                let bar = Key::Bar("P", (0.0, 1.0), &sequential);
                let corner = (i as f64 * width, top);
                self.draw(ground, &mut svg, corner, &format!("P of the best {kind} shot"), &bar, &|at| {
                    self.p(at, kind).map(|(p, _)| sequential(p))
                });
            }
            let corner = (2.0 * width, top);
            let colour = |by: f64| diverging(by / most);
            let bar = Key::Bar("bank \u{2212} direct", (-most, most), &colour);
            self.draw(ground, &mut svg, corner, "bank less direct", &bar, &|at| {
                // No colour where the difference is below its error.
                gain(at)?;
                Some(sure(at).map_or([255, 255, 255], |(by, _)| colour(by)))
            });
            let inside: Vec<(f64, f64)> = wins.iter().map(|at| (at.x_m, at.y_m)).collect();
            ground.outline(&mut svg, corner, &inside);
            footnote(&mut svg, (20.0, top + height + 6.0), &format!("{sentence} Outlined: there. White: the difference is below {SURE} standard errors; full colour from {:.0} points.", 100.0 * most));
            footnote(&mut svg, (20.0, top + height + 22.0), &self.source());
            svg.finish(&sentence)
        });
        Some(Picture {
            name: "bank_and_direct".to_owned(),
            caption: sentence,
            svg,
        })
    }

    /// What is best where: P, kind, pitch angle, backspin, and, where they were computed, spin's worth and the
    /// costliest error.
    #[must_use]
    pub fn best_maps(&self) -> Vec<Picture> {
        let mut pictures = Vec::new();
        let mut add = |name: &str,
                       title: &str,
                       caption: &str,
                       key: &Key<'_>,
                       colour: &dyn Fn(&At) -> Option<[u8; 3]>| {
            if self.places.iter().all(|at| colour(at).is_none()) {
                return;
            }
            let svg = self.with_ground(self.far_x_m(), |ground| {
                let (width, height) = ground.size();
                let mut svg = Svg::new(width + 40.0, height + 50.0);
                svg.heading(
                    (20.0, 24.0),
                    15.0,
                    Anchor::Start,
                    &shortened(&self.title(), 50),
                );
                self.draw(ground, &mut svg, (0.0, 30.0), title, key, colour);
                footnote(
                    &mut svg,
                    (20.0, height + 40.0),
                    &shortened(&self.source(), 90),
                );
                svg.finish(caption)
            });
            pictures.push(Picture {
                name: name.to_owned(),
                caption: caption.to_owned(),
                svg,
            });
        };
        add(
            "best_p",
            "P of the best shot",
            "The probability of the best shot from each place.",
            &Key::Bar("P", (0.0, 1.0), &sequential),
            &|at| Some(sequential(number(self.best(at)?, "probability")?)),
        );
        let kinds = [("direct", NAMED[4]), ("bank", NAMED[0])];
        let names: Vec<(String, [u8; 3])> = kinds
            .iter()
            .map(|(name, colour)| ((*name).to_owned(), *colour))
            .collect();
        if self.kinds.len() == 2 {
            add(
                "best_kind",
                "the best kind of shot",
                "Which kind of shot is the best one from each place.",
                &Key::Names(&names),
                &|at| {
                    let Cell::Text(kind) = self.best(at)?.get("kind") else {
                        return None;
                    };
                    kinds
                        .iter()
                        .find(|(name, _)| name == kind)
                        .map(|(_, colour)| *colour)
                },
            );
        }
        self.range_map(
            "best_pitch",
            "pitch angle of the best shot",
            "deg",
            "pitch",
            DEGREE_RAD,
            "The pitch angle of the best shot from each place.",
            &mut add,
        );
        self.range_map(
            "best_spin",
            "backspin of the best shot",
            "rev/s",
            "backspin",
            REV_RAD,
            "The backspin of the best shot from each place.",
            &mut add,
        );
        self.range_map(
            "spin_worth",
            "what the best backspin gains over none",
            "gain in P",
            "best_backspin_over_none",
            1.0,
            "What the best backspin gains over none, speed aimed anew.",
            &mut add,
        );
        let seen: Vec<(String, [u8; 3])> = ERROR_NAMES
            .iter()
            .enumerate()
            .map(|(i, name)| {
                let colour = NAMED.get(i).copied().unwrap_or_default();
                (name.replace('_', " "), colour)
            })
            .filter(|(name, _)| {
                self.places
                    .iter()
                    .any(|at| self.costliest(at).as_ref() == Some(name))
            })
            .collect();
        add(
            "costliest_error",
            "the error that costs most",
            "Which of the errors costs the best shot most.",
            &Key::Names(&seen),
            &|at| {
                let name = self.costliest(at)?;
                seen.iter()
                    .find(|(seen, _)| *seen == name)
                    .map(|(_, colour)| *colour)
            },
        );
        pictures
    }

    fn costliest(&self, at: &At) -> Option<String> {
        match self.best(at)?.get("costliest_error") {
            Cell::Text(name) => Some(name.replace('_', " ")),
            _ => None,
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn range_map(
        &self,
        name: &str,
        title: &str,
        unit: &str,
        column: &str,
        scale: f64,
        caption: &str,
        add: &mut dyn FnMut(&str, &str, &str, &Key<'_>, &dyn Fn(&At) -> Option<[u8; 3]>),
    ) {
        let value = |at: &At| Some(number(self.best(at)?, column)? / scale);
        let (low, high) = self.places.iter().filter_map(value).fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high): (f64, f64), v| (low.min(v), high.max(v)),
        );
        if !(low <= high) {
            return;
        }
        // A range that is not a point.
        let (low, high) = if high - low < 1e-6 {
            (low - 0.5, high + 0.5)
        } else {
            (low, high)
        };
        let colour = |v: f64| sequential((v - low) / (high - low));
        add(
            name,
            title,
            caption,
            &Key::Bar(unit, (low, high), &colour),
            &|at| value(at).map(colour),
        );
    }
}

/// The best shots of two sweeps over the same places side by side, with their difference; none where no place is
/// common to both.
#[must_use]
pub fn against(one: &Sweep<'_>, other: &Sweep<'_>) -> Option<Picture> {
    let bits = |at: &At| (at.x_m.to_bits(), at.y_m.to_bits());
    let theirs: BTreeMap<(u64, u64), &At> = other.places.iter().map(|at| (bits(at), at)).collect();
    let value = |sweep: &Sweep<'_>, at: &At| {
        let row = sweep.best(at)?;
        Some((number(row, "probability")?, number(row, "standard_error")?))
    };
    let gain = |at: &At| {
        let (a, b) = (value(one, at)?, value(other, theirs.get(&bits(at))?)?);
        Some((b.0 - a.0, libm::hypot(a.1, b.1)))
    };
    let gains: Vec<(f64, f64)> = one.places.iter().filter_map(gain).collect();
    if gains.is_empty() {
        return None;
    }
    let most = gains
        .iter()
        .fold(0.0, |most: f64, (by, _)| most.max(by.abs()))
        .clamp(0.02, 0.5);
    let mean = gains.iter().map(|(by, _)| by).sum::<f64>() / gains.len() as f64;
    let (first, second) = (one.named(), other.named());
    let sentence = format!(
        "{second} less {first}: {:+.1} points of P on average over {} places.",
        100.0 * mean,
        gains.len()
    );
    let svg = one.with_ground(one.far_x_m(), |ground| {
        let (width, height) = ground.size();
        let mut svg = Svg::new(3.0 * width, height + 62.0);
        let title = format!("{first} and {second}");
        svg.heading((20.0, 24.0), 16.0, Anchor::Start, &title);
        let bar = Key::Bar("P", (0.0, 1.0), &sequential);
        let p = |sweep: &Sweep<'_>, at: &At| value(sweep, at).map(|(p, _)| sequential(p));
        one.draw(ground, &mut svg, (0.0, 34.0), &shortened(&first, 40), &bar, &|at| p(one, at));
        other.draw(ground, &mut svg, (width, 34.0), &shortened(&second, 40), &bar, &|at| p(other, at));
        let colour = |by: f64| diverging(by / most);
        let bar = Key::Bar("second \u{2212} first", (-most, most), &colour);
        one.draw(ground, &mut svg, (2.0 * width, 34.0), "second less first", &bar, &|at| {
            let (by, error) = gain(at)?;
            Some(if by.abs() > SURE * error { colour(by) } else { [255, 255, 255] })
        });
        let note = format!("{sentence} P of the best shot of either kind; white: the difference is below {SURE} standard errors.");
        footnote(&mut svg, (20.0, 34.0 + height + 6.0), &note);
        footnote(&mut svg, (20.0, 34.0 + height + 22.0), &one.source());
        svg.finish(&sentence)
    });
    Some(Picture {
        name: "against".to_owned(),
        caption: sentence,
        svg,
    })
}
