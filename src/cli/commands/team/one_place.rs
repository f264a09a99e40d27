//! A table of the players, each from one place.

use super::ranking::{Ranking, Standing};
use super::team_profiles::load_players;
use super::words::{LONGEST_NAME, in_hundred, table_of, whole_percent};
use crate::analysis::sensitivity::{Difference, SensitivityTopics};
use crate::best_shot::{ShotKind, find_kinds};
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::profile_flags::PlaceOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_prose, print_remark};
use crate::fitting::Interval;
use crate::plots::svg::shortened;
use crate::shooter::Profile;
use crate::sweep::probability_by_place::{Preference, SURE};
use crate::units::DEGREE_RAD;
use std::path::PathBuf;

/// The share of the draws from which on a kind that is not sure is still named.
const LIKELY: f64 = 0.75;

/// What a player is told about bank and direct.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Prefer(Preference),
    /// The measured shots leave both open, but more of the draws say so.
    Lean(Preference),
    /// The measured shots leave both open.
    Unsure,
}

impl Verdict {
    const ALL: [Self; 6] = [
        Self::Prefer(Preference::Bank),
        Self::Prefer(Preference::Direct),
        Self::Prefer(Preference::Either),
        Self::Lean(Preference::Bank),
        Self::Lean(Preference::Direct),
        Self::Unsure,
    ];

    fn in_words(self) -> &'static str {
        match self {
            Self::Prefer(Preference::Bank) => "Bank it",
            Self::Prefer(Preference::Direct) => "Shoot it direct",
            Self::Prefer(Preference::Either) => "Either is as good",
            Self::Lean(Preference::Bank) => "Rather bank it, but that is not sure",
            Self::Lean(_) => "Rather shoot it direct, but that is not sure",
            Self::Unsure => "Not sure yet, the measured shots leave both open",
        }
    }
}

/// Prints a table of the players, each from a place of their own or all `from` one.
pub(super) fn run(
    (players, place): (&[PathBuf], Option<u32>),
    from: &PlaceOptions,
    quiet: bool,
) -> Result<u8, Failure> {
    let profiles = load_players((players, place), quiet)?;
    let has_further_places = |(path, _): &(PathBuf, Profile)| {
        path.ends_with("profile.toml") && path.with_file_name("profile_place_2.toml").is_file()
    };
    if !quiet && place.is_none() && profiles.iter().any(has_further_places) {
        print_remark(
            "of fits with several places: each player shoots from the first one; --place 2 takes the second, and --sweep COURT.toml any (a region \"places\" takes a list of them)",
        );
    }
    let header = ["player", "place", "direct", "bank", "shoot it"];
    let names_best = profiles.len() > 1;
    let best_column = names_best.then_some("is best");
    let header = header.into_iter().chain(best_column).map(str::to_owned);
    let mut table = table_of(header.collect());
    let bars = ProgressBars::new(quiet);
    let (mut any_either, mut any_draws, mut any_nearly_other) = (false, false, false);
    let (mut any_fit, mut any_exact) = (false, false);
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut standings: Vec<Standing> = Vec::new();
    let mut verdicts: Vec<(Verdict, String)> = Vec::new();
    for (path, profile) in profiles {
        let profile = &from.moved(profile)?;
        let (_, shots) = find_kinds(profile, &ShotKind::ALL, SensitivityTopics::NONE, &bars)?;
        let p: Vec<Option<Difference>> = shots
            .iter()
            .map(|shot| {
                let estimate = &shot.as_ref().ok()?.estimate;
                Some(Difference {
                    value: estimate.probability,
                    standard_error: estimate.standard_error,
                })
            })
            .collect();
        let fit = fit_folder::of_profile(&path)?;
        any_fit |= fit.is_some();
        any_exact |= fit.is_none();
        // What the measured shots leave open is many times the error of the simulation.
        let over_draws: Vec<Option<Interval>> = shots
            .iter()
            .map(|shot| match (&fit, shot) {
                (Some(fit), Ok(shot)) => {
                    let p = fit_folder::shot_over_draws(fit, profile, &shot.nominal)?;
                    Ok(Some(p.interval()))
                }
                _ => Ok(None),
            })
            .collect::<Result<_, Failure>>()?;
        let mut text = |kind: ShotKind| {
            let is_nearly_other = shots[kind.index()]
                .as_ref()
                .is_ok_and(|shot| shot.share_of_other_kind(kind) > 0.5);
            any_nearly_other |= is_nearly_other;
            let mark = if is_nearly_other { " *" } else { "" };
            match (p[kind.index()], over_draws[kind.index()]) {
                (_, Some(p)) => format!(
                    "{:.0} ({:.0} to {:.0}){mark}",
                    100.0 * p.mean,
                    100.0 * p.low,
                    100.0 * p.high
                ),
                (Some(p), None) => format!(
                    "{} \u{b1} {}{mark}",
                    in_hundred(p.value),
                    in_hundred(p.standard_error)
                ),
                (None, None) => "-".to_owned(),
            }
        };
        let preference = Preference::of(p[0], p[1]);
        any_either |= preference == Some(Preference::Either);
        let mut advice = preference
            .map_or("no clean shot", Preference::name)
            .to_owned();
        let mut share_of_draws = 1.0;
        if let [Ok(direct), Ok(bank)] = &shots[..]
            && preference != Some(Preference::Either)
            && let Some(fit) = &fit
        {
            let nominals = [&direct.nominal, &bank.nominal];
            let bank_is_better =
                fit_folder::bank_gain_over_draws(fit, profile, nominals)?.share_positive();
            let share = match preference {
                Some(Preference::Bank) => bank_is_better,
                _ => 1.0 - bank_is_better,
            };
            advice += &format!(" ({} %)", whole_percent(share));
            share_of_draws = share;
            any_draws = true;
        }
        let (long, metre) = profile.output().units.length();
        let location = profile.location();
        let name = shortened(&profile.shooter().name, LONGEST_NAME);
        verdicts.extend(preference.map(|preference| {
            let verdict = match share_of_draws {
                share if share >= SURE => Verdict::Prefer(preference),
                share if share >= LIKELY => Verdict::Lean(preference),
                _ => Verdict::Unsure,
            };
            (verdict, name.clone())
        }));
        let of_kinds = p.iter().zip(&over_draws).filter_map(|(p, draws)| {
            let p = (*p)?;
            Some(draws.map_or(
                Standing {
                    value: p.value,
                    standard_error: p.standard_error,
                },
                |draws| Standing {
                    value: draws.mean,
                    standard_error: draws.sd,
                },
            ))
        });
        let best = of_kinds.max_by(|a, b| a.value.total_cmp(&b.value));
        let row = vec![
            name,
            format!(
                "{:.2} {long},\n{}",
                location.distance_m / metre,
                match location.angle_rad / DEGREE_RAD {
                    angle if angle >= 0.5 => format!("{angle:.0} deg right"),
                    angle if angle <= -0.5 => format!("{:.0} deg left", -angle),
                    _ => "in front".to_owned(),
                }
            ),
            text(ShotKind::Direct),
            text(ShotKind::Bank),
            advice,
        ];
        standings.push(best.unwrap_or(Standing {
            value: 0.0,
            standard_error: 0.0,
        }));
        rows.push(row);
    }
    let ranking = Ranking::of(&standings);
    for &number in &ranking.order {
        let mut row = std::mem::take(&mut rows[number]);
        if names_best {
            row.push(format!("{} %", whole_percent(ranking.is_best[number])));
        }
        table.add_row(row);
    }
    let mut text = String::new();
    for verdict in Verdict::ALL {
        let told = verdicts.iter().filter(|(of, _)| *of == verdict);
        let names: Vec<&str> = told.map(|(_, name)| name.as_str()).collect();
        if !names.is_empty() {
            text += &format!("{}: {}.\n", verdict.in_words(), names.join(", "));
        }
    }
    text += &format!(
        "\nmakes in 100 of each one's best shot (not of the usual one), {}\n{}\n",
        ranking.in_words(),
        table.trim_fmt()
    );
    if any_either {
        text += "either: the two differ by less than 1 in 100, or by less than twice the error of their difference\n";
    }
    if any_nearly_other {
        text += "*: nearly the other kind: more than half of the makes of this bank shot do not touch the board first, or of this direct one do\n";
    }
    if any_exact {
        text += "\u{b1}: numerical; the profile is taken as exact\n";
    }
    if any_fit {
        text += "(low to high): 95 % interval of the player's measured shots\n";
    }
    if names_best {
        text += "is best: the probability that nobody's best shot makes more\n";
    }
    if any_draws {
        text += "in brackets: in how many of 100 draws of the fit this kind is the better one; from 90 on it is sure\n";
    }
    print_prose(&text)
}
