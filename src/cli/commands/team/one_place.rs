//! A table of the players, each from one place.

use super::ranking::{Ranking, Standing};
use super::team_profiles::{load_players, warn_of};
use super::words::{LONGEST_NAME, in_hundred, table_of, whole_percent};
use crate::analysis::sensitivity::{Difference, SensitivityTopics};
use crate::best_shot::{ShotKind, find_kinds};
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::profile_flags::PlaceOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_hint, print_prose};
use crate::fitting::Interval;
use crate::plots::svg::shortened;
use crate::shooter::Profile;
use crate::sweep::probability_by_place::{Preference, SURE};
use crate::units::DEGREE_RAD;
use std::path::{Path, PathBuf};

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

/// What a player makes of the best shot of a kind.
struct KindChance {
    /// P of the profile, with its numerical error.
    p: Option<Difference>,
    /// P over the draws of the player's fit. What the measured shots leave open is many times the
    /// error of the simulation.
    over_draws: Option<Interval>,
    /// Whether more than half of its makes are of the other kind.
    is_nearly_other: bool,
}

impl KindChance {
    fn in_words(&self) -> String {
        let mark = if self.is_nearly_other { " *" } else { "" };
        match (self.p, self.over_draws) {
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
    }

    fn standing(&self) -> Option<Standing> {
        let p = self.p?;
        Some(match self.over_draws {
            Some(draws) => Standing {
                value: draws.mean,
                standard_error: draws.sd,
            },
            None => Standing {
                value: p.value,
                standard_error: p.standard_error,
            },
        })
    }
}

/// A player's best shots from a place.
struct PlayerShots {
    name: String,
    place: String,
    /// Direct and bank.
    kinds: [KindChance; 2],
    preference: Option<Preference>,
    has_fit: bool,
    /// In which share of the draws the preferred kind is the better one, of a player with a fit.
    share_of_draws: Option<f64>,
}

impl PlayerShots {
    fn find(path: &Path, profile: &Profile, bars: &ProgressBars) -> Result<Self, Failure> {
        let (_, shots) = find_kinds(profile, &ShotKind::ALL, SensitivityTopics::NONE, bars)?;
        let fit = fit_folder::of_profile(path)?;
        let chance = |kind: ShotKind| {
            let shot = shots[kind.index()].as_ref().ok();
            let over_draws = match (&fit, shot) {
                (Some(fit), Some(shot)) => {
                    let p = fit_folder::shot_over_draws(fit, profile, &shot.nominal)?;
                    Some(p.interval())
                }
                _ => None,
            };
            Ok::<_, Failure>(KindChance {
                p: shot.map(|shot| Difference {
                    value: shot.estimate.probability,
                    standard_error: shot.estimate.standard_error,
                }),
                over_draws,
                is_nearly_other: shot.is_some_and(|shot| shot.share_of_other_kind(kind) > 0.5),
            })
        };
        let kinds = [chance(ShotKind::Direct)?, chance(ShotKind::Bank)?];
        let preference = Preference::of(kinds[0].p, kinds[1].p);
        let share_of_draws = match (&shots[..], preference, &fit) {
            (_, Some(Preference::Either), _) => None,
            ([Ok(direct), Ok(bank)], _, Some(fit)) => {
                let nominals = [&direct.nominal, &bank.nominal];
                let gain = fit_folder::bank_gain_over_draws(fit, profile, nominals)?;
                Some(match preference {
                    Some(Preference::Bank) => gain.share_positive(),
                    _ => 1.0 - gain.share_positive(),
                })
            }
            _ => None,
        };
        Ok(Self {
            name: shortened(&profile.shooter().name, LONGEST_NAME),
            place: place_in_words(profile),
            kinds,
            preference,
            has_fit: fit.is_some(),
            share_of_draws,
        })
    }

    /// What the player is told.
    fn verdict(&self) -> Option<Verdict> {
        let preference = self.preference?;
        Some(match self.share_of_draws.unwrap_or(1.0) {
            share if share >= SURE => Verdict::Prefer(preference),
            share if share >= LIKELY => Verdict::Lean(preference),
            _ => Verdict::Unsure,
        })
    }

    /// The better of the two kinds.
    fn standing(&self) -> Standing {
        let of_kinds = self.kinds.iter().filter_map(KindChance::standing);
        let best = of_kinds.max_by(|a, b| a.value.total_cmp(&b.value));
        best.unwrap_or(Standing {
            value: 0.0,
            standard_error: 0.0,
        })
    }

    fn row(&self) -> Vec<String> {
        let advice = self.preference.map_or("no clean shot", Preference::name);
        let share = self.share_of_draws;
        let share = share.map_or_else(String::new, |of| format!(" ({} %)", whole_percent(of)));
        vec![
            self.name.clone(),
            self.place.clone(),
            self.kinds[0].in_words(),
            self.kinds[1].in_words(),
            format!("{advice}{share}"),
        ]
    }
}

/// A place in two lines.
fn place_in_words(profile: &Profile) -> String {
    let (long, metre) = profile.output().units.length();
    let location = profile.location();
    let side = match location.angle_rad / DEGREE_RAD {
        angle if angle >= 0.5 => format!("{angle:.0} deg right"),
        angle if angle <= -0.5 => format!("{:.0} deg left", -angle),
        _ => "in front".to_owned(),
    };
    format!("{:.2} {long},\n{side}", location.distance_m / metre)
}

/// Prints a table of the players, each from a place of their own or all `from` one.
pub(super) fn run(
    players: &[PathBuf],
    place: Option<u32>,
    from: &PlaceOptions,
) -> Result<u8, Failure> {
    let profiles = load_players(players, place)?;
    for (path, player) in &profiles {
        warn_of(path, player)?;
    }
    let has_further_places = |(path, _): &(PathBuf, Profile)| {
        path.ends_with("profile.toml") && path.with_file_name("profile_place_2.toml").is_file()
    };
    if place.is_none() && profiles.iter().any(has_further_places) {
        print_hint(
            "of fits with several places: each player shoots from the first one; --place 2 takes the second, and --sweep COURT.toml any (a region \"places\" takes a list of them)",
        );
    }
    let bars = ProgressBars::new();
    let find = |(path, profile): (PathBuf, Profile)| {
        PlayerShots::find(&path, &from.moved(profile)?, &bars)
    };
    let players: Vec<PlayerShots> = profiles.into_iter().map(find).collect::<Result<_, _>>()?;
    let mut text = String::new();
    for verdict in Verdict::ALL {
        let told = players
            .iter()
            .filter(|player| player.verdict() == Some(verdict));
        let names: Vec<&str> = told.map(|player| player.name.as_str()).collect();
        if !names.is_empty() {
            text += &format!("{}: {}.\n", verdict.in_words(), names.join(", "));
        }
    }
    print_prose(&(text + &table_in_words(&players) + &notes(&players)))
}

/// The players in the order of their best shots.
fn table_in_words(players: &[PlayerShots]) -> String {
    let standings: Vec<Standing> = players.iter().map(PlayerShots::standing).collect();
    let ranking = Ranking::of(&standings);
    let names_best = players.len() > 1;
    let header = ["player", "place", "direct", "bank", "shoot it"];
    let best_column = names_best.then_some("is best");
    let header = header.into_iter().chain(best_column).map(str::to_owned);
    let mut table = table_of(header.collect());
    for &number in &ranking.order {
        let mut row = players[number].row();
        if names_best {
            row.push(format!("{} %", whole_percent(ranking.is_best[number])));
        }
        table.add_row(row);
    }
    format!(
        "\nmakes in 100 of each one's best shot (not of the usual one), {}\n{}\n",
        ranking.in_words(),
        table.trim_fmt()
    )
}

/// What the marks of the table mean, those that are in it.
fn notes(players: &[PlayerShots]) -> String {
    let any = |is: &dyn Fn(&PlayerShots) -> bool| players.iter().any(is);
    [
        (
            any(&|player| player.preference == Some(Preference::Either)),
            "either: the two differ by less than 1 in 100, or by less than twice the error of their difference\n",
        ),
        (
            any(&|player| player.kinds.iter().any(|kind| kind.is_nearly_other)),
            "*: nearly the other kind: more than half of the makes of this bank shot do not touch the board first, or of this direct one do\n",
        ),
        (
            any(&|player| !player.has_fit),
            "\u{b1}: numerical; the profile is taken as exact\n",
        ),
        (
            any(&|player| player.has_fit),
            "(low to high): 95 % interval of the player's measured shots\n",
        ),
        (
            players.len() > 1,
            "is best: the probability that nobody's best shot makes more\n",
        ),
        (
            any(&|player| player.share_of_draws.is_some()),
            "in brackets: in how many of 100 draws of the fit this kind is the better one; from 90 on it is sure\n",
        ),
    ]
    .into_iter()
    .filter_map(|(is_there, note)| is_there.then_some(note))
    .collect()
}
