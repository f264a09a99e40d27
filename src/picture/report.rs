//! One HTML page of a run: the answer first, the shot in a view that turns, tables that sort, the pictures. Nothing is
//! loaded from anywhere; names are escaped wherever they stand.

use super::svg::{escaped, shortened};
use super::sweep_maps::{Picture, Sweep, number};
use crate::court::Court;
use crate::dynamics::{Simulator, Trace, Triple};
use crate::output;
use crate::physics::{Physics, PhysicsError};
use crate::probability::best::Best;
use crate::profile::{Nominal, Place, Profile};
use crate::sweep::Configuration;
use crate::sweep::jobs::Jobs;
use crate::sweep::row::{Cell, Row};
use crate::units::{DEGREE_RAD, REV_RAD, System};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

const HTML: &str = include_str!("../../assets/report/page.html");
const CSS: &str = include_str!("../../assets/report/page.css");
const JS: &str = include_str!("../../assets/report/page.js");
/// Spacing of the points of a path, s.
const INTERVAL_S: f64 = 0.04;
/// Longest name in a title.
const LONGEST_NAME: usize = 120;

/// A shot to look at.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Number of its place.
    pub place: usize,
    /// `direct` or `bank`.
    pub kind: String,
    /// From where.
    pub from: Place,
    /// What is meant.
    pub nominal: Nominal,
    /// P and its standard error.
    pub p: (f64, f64),
    /// The shot of which this one is the mirror image.
    pub mirror_of: Option<usize>,
}

/// The best shots of a place, those that were found.
#[must_use]
pub fn shots_of(profile: &Profile, best: &Best) -> Vec<Shot> {
    [&best.direct, &best.bank]
        .into_iter()
        .zip(["direct", "bank"])
        .filter_map(|(shot, kind)| {
            let shot = shot.as_ref().ok()?;
            Some(Shot {
                place: 0,
                kind: kind.to_owned(),
                from: profile.place,
                nominal: shot.nominal,
                p: (shot.estimate.probability, shot.estimate.standard_error),
                mirror_of: None,
            })
        })
        .collect()
}

/// A table of a page: the first row of cells are the names.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Names of the columns, with units.
    pub columns: Vec<String>,
    /// The shot that a row stands for, and its cells.
    pub rows: Vec<(Option<usize>, Vec<String>)>,
}

/// A page under way.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// Its title.
    pub title: String,
    /// The answer, in a sentence or two.
    pub answer: String,
    /// The shots; at least one.
    pub shots: Vec<Shot>,
    /// The place that is shown first.
    pub first_place: usize,
    /// The tables.
    pub tables: Vec<Table>,
    /// The pictures.
    pub pictures: Vec<Picture>,
    /// The world.
    pub physics: &'a Physics,
    /// The lines.
    pub court: Court,
    /// Height of the releases above the hoop, m.
    pub height_m: f64,
    /// Units of words.
    pub units: System,
    /// Where it comes from.
    pub footer: String,
}

/// A shot in words.
#[must_use]
pub fn words(shot: &Shot, units: System) -> String {
    let (long, foot) = units.length();
    let nominal = &shot.nominal;
    let mut kind = shot.kind.clone();
    if let Some(first) = kind.get_mut(0..1) {
        first.make_ascii_uppercase();
    }
    format!(
        "{kind}: P {:.3} \u{b1} {:.3}; {:.2} {long}/s, pitch {:.1} deg, polar {:.1} deg, backspin {:.1} rev/s.",
        shot.p.0,
        shot.p.1,
        nominal.speed_m_s / foot,
        nominal.pitch_rad / DEGREE_RAD,
        nominal.polar_rad / DEGREE_RAD + 0.0,
        nominal.backspin_rad_s / REV_RAD
    )
}

fn place_in_words(place: &Place, units: System) -> String {
    let (long, foot) = units.length();
    format!(
        "{:.1} {long} from the hoop at {:.0} deg",
        place.distance_m / foot,
        place.angle_rad / DEGREE_RAD + 0.0
    )
}

impl Page<'_> {
    /// The page as one HTML file.
    ///
    /// # Errors
    /// When the physics cannot be simulated.
    pub fn html(&self, simulator: &Simulator) -> Result<String, PhysicsError> {
        let mut body = String::new();
        for (i, table) in self.tables.iter().enumerate() {
            body.push_str(&table_html(i, table));
        }
        for picture in &self.pictures {
            // Several drawings in one page must not share names.
            let svg = picture
                .svg
                .replace("id=\"clip", &format!("id=\"{}-clip", picture.name))
                .replace("url(#clip", &format!("url(#{}-clip", picture.name));
            // Writing to a String does not fail.
            let _ = write!(
                body,
                "<figure class=\"wide\">\n{svg}<figcaption>{}</figcaption>\n</figure>\n",
                escaped(&picture.caption)
            );
        }
        // Inside a script element only this can end it.
        let data = self.data(simulator).to_string().replace('<', "\\u003c");
        let title = escaped(&shortened(&self.title, LONGEST_NAME));
        let parts = [
            ("title", title),
            ("css", CSS.to_owned()),
            ("answer", escaped(&self.answer)),
            ("body", body),
            ("footer", escaped(&self.footer)),
            ("data", data),
            ("js", JS.to_owned()),
        ];
        Ok(filled(HTML, &parts))
    }

    fn data(&self, simulator: &Simulator) -> Value {
        let shots: Vec<Value> = self
            .shots
            .iter()
            .map(|shot| {
                let (sin, cos) = libm::sincos(shot.from.angle_rad);
                let mut record = json!({
                    "place": shot.place,
                    "kind": shot.kind,
                    "x_m": rounded(shot.from.distance_m * cos),
                    "y_m": rounded(shot.from.distance_m * sin),
                    "where": place_in_words(&shot.from, self.units),
                    "words": words(shot, self.units),
                });
                match shot.mirror_of {
                    Some(other) => record["mirror_of"] = other.into(),
                    None => record["path"] = self.path(simulator, shot),
                }
                record
            })
            .collect();
        let mut court = serde_json::to_value(self.court).unwrap_or_default();
        court["three_break_x_m"] = output::number(self.court.three_break_x_m());
        for (name, value) in [
            ("hoop_height_m", self.physics.hoop_height_m),
            ("board_distance_m", self.physics.board_distance_m),
            ("board_width_m", self.physics.board_width_m),
            ("board_height_m", self.physics.board_height_m),
            ("board_centre_height_m", self.physics.board_centre_height_m),
            ("ring_radius_m", self.physics.ring_radius_m),
            ("ball_radius_m", self.physics.ball_radius_m),
        ] {
            court[name] = output::number(value);
        }
        let far = self
            .shots
            .iter()
            .map(|shot| shot.from.distance_m * libm::cos(shot.from.angle_rad))
            .fold(0.0, f64::max);
        json!({
            "shots": shots,
            "court": court,
            "far_x_m": rounded(far),
            "first_place": self.first_place,
        })
    }

    /// Time and place along a shot's path: `[s, x, y, z]` in cm and ms, about every [`INTERVAL_S`] and at each event.
    fn path(&self, simulator: &Simulator, shot: &Shot) -> Value {
        let release = crate::dynamics::Release {
            distance_m: shot.from.distance_m,
            court_angle_rad: shot.from.angle_rad,
            height_above_hoop_m: self.height_m,
            speed_m_s: shot.nominal.speed_m_s,
            pitch_rad: shot.nominal.pitch_rad,
            polar_rad: shot.nominal.polar_rad,
            backspin_rad_s: shot.nominal.backspin_rad_s,
            rifle_spin_rad_s: shot.nominal.rifle_spin_rad_s,
            side_spin_rad_s: shot.nominal.side_spin_rad_s,
        };
        let trace: Trace = simulator.trace(&release, INTERVAL_S);
        let mut points: Vec<(f64, Triple<f64>)> = trace
            .events
            .iter()
            .map(|event| (event.time_s, event.state.position_m))
            .collect();
        let mut last = f64::NEG_INFINITY;
        for sample in &trace.samples {
            if sample.time_s - last >= 0.9 * INTERVAL_S {
                points.push((sample.time_s, sample.state.position_m));
                last = sample.time_s;
            }
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by(|a, b| a.0 - b.0 < 0.002);
        points
            .into_iter()
            .map(|(t, Triple(x, y, z))| {
                json!([
                    (1000.0 * t).round() / 1000.0,
                    rounded(x),
                    rounded(y),
                    rounded(z)
                ])
            })
            .collect()
    }
}

/// To the centimetre.
fn rounded(value: f64) -> f64 {
    (100.0 * value).round() / 100.0 + 0.0
}

/// Puts the parts in the places of a template, each once, so that what a part holds is not taken for a place.
fn filled(template: &str, parts: &[(&str, String)]) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        page.push_str(before);
        let Some((name, after)) = after.split_once("}}") else {
            break;
        };
        if let Some((_, text)) = parts.iter().find(|(part, _)| *part == name) {
            page.push_str(text);
        }
        rest = after;
    }
    page.push_str(rest);
    page
}

fn table_html(number: usize, table: &Table) -> String {
    let mut html = format!(
        "<h2 id=\"h-table-{number}\">{}</h2>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-labelledby=\"h-table-{number}\">\n<table class=\"sortable\">\n<thead><tr>",
        escaped(&table.caption)
    );
    for column in &table.columns {
        let _ = write!(
            html,
            "<th scope=\"col\"><button type=\"button\">{}</button></th>",
            escaped(column)
        );
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for (shot, cells) in &table.rows {
        html.push_str(&shot.map_or("<tr>".to_owned(), |shot| {
            format!("<tr data-shot=\"{shot}\">")
        }));
        for cell in cells {
            let class = if cell.parse::<f64>().is_ok() {
                ""
            } else {
                " class=\"text\""
            };
            let _ = write!(html, "<td{class}>{}</td>", escaped(cell));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody>\n</table>\n</div>\n");
    html
}

/// The table of shots.
fn shots_table(shots: &[Shot], units: System) -> Table {
    let (long, foot) = units.length();
    let columns = [
        "shot".to_owned(),
        format!("distance {long}"),
        "court angle deg".to_owned(),
        "P".to_owned(),
        "\u{b1}".to_owned(),
        format!("speed {long}/s"),
        "pitch deg".to_owned(),
        "polar deg".to_owned(),
        "backspin rev/s".to_owned(),
    ];
    let plain = |value: f64, digits: usize| {
        let text = format!("{value:.digits$}");
        // Nothing is not negative.
        if text
            .trim_start_matches('-')
            .chars()
            .all(|c| c == '0' || c == '.')
        {
            text.trim_start_matches('-').to_owned()
        } else {
            text
        }
    };
    let rows = shots
        .iter()
        .enumerate()
        .map(|(i, shot)| {
            let nominal = &shot.nominal;
            let cells = vec![
                shot.kind.clone(),
                plain(shot.from.distance_m / foot, 2),
                plain(shot.from.angle_rad / DEGREE_RAD, 1),
                plain(shot.p.0, 4),
                plain(shot.p.1, 4),
                plain(nominal.speed_m_s / foot, 2),
                plain(nominal.pitch_rad / DEGREE_RAD, 1),
                plain(nominal.polar_rad / DEGREE_RAD, 2),
                plain(nominal.backspin_rad_s / REV_RAD, 2),
            ];
            (Some(i), cells)
        })
        .collect();
    Table {
        caption: "Best shots".to_owned(),
        columns: columns.to_vec(),
        rows,
    }
}

/// The page of a sweep, by the program and under the hash that its results have; none where no shot was found.
#[must_use]
pub fn of_sweep<'a>(
    configuration: &'a Configuration,
    rows: &BTreeMap<u64, Row>,
    (program, hash): (&str, &str),
) -> Option<Page<'a>> {
    let template = &configuration.template;
    let units = template.output.units;
    let jobs = Jobs::new(configuration);
    let mut shots: Vec<Shot> = Vec::new();
    let mut computed: BTreeMap<u64, usize> = BTreeMap::new();
    // Those that were computed first, so that mirror images can name them.
    for mirrored in [false, true] {
        for (place, source) in jobs.sources.iter().enumerate() {
            for kind in 0..jobs.kinds.len() {
                let job = jobs.number(source.place, kind);
                let Some(row) = rows.get(&job).filter(|_| source.mirrored == mirrored) else {
                    continue;
                };
                let row = if mirrored {
                    row.mirrored()
                } else {
                    row.clone()
                };
                let value = |name: &str| number(&row, name);
                let Some(p) = value("probability") else {
                    continue;
                };
                let mirror_of = if mirrored {
                    computed.get(&job).copied()
                } else {
                    None
                };
                if !mirrored {
                    computed.entry(job).or_insert(shots.len());
                }
                shots.push(Shot {
                    place,
                    kind: jobs.kinds[kind].name().to_owned(),
                    from: source.spot.place(),
                    nominal: Nominal {
                        speed_m_s: value("speed").unwrap_or(0.0),
                        pitch_rad: value("pitch").unwrap_or(0.0),
                        polar_rad: value("polar").unwrap_or(0.0),
                        backspin_rad_s: value("backspin").unwrap_or(0.0),
                        rifle_spin_rad_s: value("rifle_spin").unwrap_or(0.0),
                        side_spin_rad_s: value("side_spin").unwrap_or(0.0),
                    },
                    p: (p, value("standard_error").unwrap_or(0.0)),
                    mirror_of,
                });
            }
        }
    }
    let by_p = |a: &&Shot, b: &&Shot| a.p.0.total_cmp(&b.p.0);
    let most = shots.iter().max_by(by_p)?;
    let mut best_at: BTreeMap<usize, &Shot> = BTreeMap::new();
    for shot in &shots {
        let best = best_at.entry(shot.place).or_insert(shot);
        if shot.p.0 > best.p.0 {
            *best = shot;
        }
    }
    let least = best_at.values().copied().min_by(by_p)?;
    let maps = Sweep::new(configuration, rows);
    let mut pictures: Vec<Picture> = maps.bank_and_direct().into_iter().collect();
    let compared = pictures
        .first()
        .map_or(String::new(), |picture| format!(" {}", picture.caption));
    pictures.extend(maps.best_maps());
    let found = |status: &str| {
        rows.values()
            .filter(|row| matches!(row.get("status"), Cell::Text(text) if text == status))
            .count()
    };
    let title = format!("{}: {}", configuration.name, template.shooter.name);
    let answer = format!(
        "The best chance is P {:.3}, {}, with the {} shot; the worst place is {}, P {:.3} with the {} shot there.{compared}",
        most.p.0,
        place_in_words(&most.from, units),
        most.kind,
        place_in_words(&least.from, units),
        least.p.0,
        least.kind
    );
    // The one nearest to the free-throw line.
    let line = configuration.league.court().free_throw_x_m;
    let off = |shot: &Shot| {
        let (sin, cos) = libm::sincos(shot.from.angle_rad);
        let (x, y) = (
            shot.from.distance_m * cos - line,
            shot.from.distance_m * sin,
        );
        x * x + y * y
    };
    let first_place = shots
        .iter()
        .min_by(|a, b| off(a).total_cmp(&off(b)))
        .map_or(0, |shot| shot.place);
    Some(Page {
        title,
        answer,
        tables: vec![shots_table(&shots, units)],
        shots,
        first_place,
        pictures,
        physics: &template.physics,
        court: configuration.league.court(),
        height_m: template.shooter.release_height_m - template.physics.hoop_height_m,
        units,
        footer: format!(
            "bankshot {program}, configuration {}; {} of {} jobs: {} found, {} without a shot that can go in, {} failed; P to {}.",
            hash.get(..12).unwrap_or(hash),
            rows.len(),
            jobs.count(),
            found("found"),
            found("none"),
            found("failed"),
            template.standard_error()
        ),
    })
}

/// The page of one place; none where no shot was found.
#[must_use]
pub fn of_place<'a>(
    profile: &'a Profile,
    shots: Vec<Shot>,
    aim: &str,
    tables: Vec<Table>,
    pictures: Vec<Picture>,
) -> Option<Page<'a>> {
    let units = profile.output.units;
    let best = shots.iter().max_by(|a, b| a.p.0.total_cmp(&b.p.0))?;
    let (long, foot) = units.length();
    let compared =
        shots
            .iter()
            .find(|shot| shot.kind != best.kind)
            .map_or(String::new(), |other| {
                format!(
                    ", {:.1} \u{b1} {:.1} points more than the {} shot",
                    100.0 * (best.p.0 - other.p.0),
                    100.0 * libm::hypot(best.p.1, other.p.1),
                    other.kind
                )
            });
    let answer = format!(
        "From {}, take the {} shot: P {:.3} \u{b1} {:.3}{compared}. Release at {:.2} {long}/s, {:.1} deg up, polar {:.2} deg, with {:.1} rev/s of backspin{aim}.",
        place_in_words(&profile.place, units),
        best.kind,
        best.p.0,
        best.p.1,
        best.nominal.speed_m_s / foot,
        best.nominal.pitch_rad / DEGREE_RAD,
        best.nominal.polar_rad / DEGREE_RAD + 0.0,
        best.nominal.backspin_rad_s / REV_RAD
    );
    let mut all = vec![shots_table(&shots, units)];
    all.extend(tables);
    Some(Page {
        title: profile.shooter.name.clone(),
        answer,
        first_place: 0,
        tables: all,
        shots,
        pictures,
        physics: &profile.physics,
        court: crate::court::League::Ncaa.court(),
        height_m: profile.height_above_hoop_m(),
        units,
        footer: format!(
            "bankshot {} ({}), profile {}.",
            env!("CARGO_PKG_VERSION"),
            env!("BANKSHOT_COMMIT"),
            &profile.hash()[..12]
        ),
    })
}
