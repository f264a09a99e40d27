//! A table of the players, each from one place.

use super::ranking::{Ranking, Standing, own_sd, pooled};
use super::team_profiles::{load_players, warn_of};
use super::words::{LONGEST_NAME, whole_percent};
use crate::analysis::sensitivity::{Difference, SensitivityTopics};
use crate::best_shot::{ShotKind, find_kinds};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::profile_flags::PlaceOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_hint, print_text};
use crate::fitting::{Interval, shared_sd};
use crate::plots::svg::shortened;
use crate::present::layout::{Side, TextAnswer, TextTable};
use crate::present::words::{likely, list, per_100};
use crate::probability::{Progress, Pulse};
use crate::shooter::{Location, Profile};
use crate::sweep::probability_by_place::{Preference, SURE};
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

    /// What these players should do; `who` are their names, or all of several.
    fn in_words(self, who: &str) -> String {
        match self {
            Self::Prefer(Preference::Bank) => format!("{who} should bank it."),
            Self::Prefer(Preference::Direct) => format!("{who} should shoot direct."),
            Self::Prefer(Preference::Either) => format!("{who} can shoot either."),
            Self::Lean(Preference::Bank) => {
                format!("{who}: bank is more likely better, not clear yet.")
            }
            Self::Lean(_) => format!("{who}: direct is more likely better, not clear yet."),
            Self::Unsure => format!("{who}: not clear yet, the shots support neither kind."),
        }
    }
}

/// What a player makes of the best shot of a kind.
struct KindChance {
    /// P of the profile, with its numerical error.
    p: Option<Difference>,
    /// P over the draws of the player's fit, as one of the team. What the measured shots leave open
    /// is many times the error of the simulation.
    over_draws: Option<Interval>,
    /// The part of its standard deviation that all players have in common.
    shared_sd: f64,
    /// Whether more than half of its makes are of the other kind.
    is_nearly_other: bool,
}

impl KindChance {
    fn cell(&self) -> String {
        let mark = if self.is_nearly_other { "*" } else { "" };
        match (self.p, self.over_draws) {
            (_, Some(p)) => format!("{}{mark}", per_100(p.mean)),
            (Some(p), None) => format!("{}{mark}", per_100(p.value)),
            (None, None) => "-".to_owned(),
        }
    }

    fn interval(&self) -> String {
        self.over_draws.map_or("-".to_owned(), |p| {
            format!("{:.0} to {:.0}", 100.0 * p.low, 100.0 * p.high)
        })
    }

    fn standing(&self) -> Option<Standing> {
        let p = self.p?;
        Some(match self.over_draws {
            Some(draws) => Standing {
                value: draws.mean,
                standard_error: own_sd(draws.sd, self.shared_sd),
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
    location: Location,
    /// Direct and bank.
    kinds: [KindChance; 2],
    preference: Option<Preference>,
    has_fit: bool,
    /// In which share of the draws the preferred kind is the better one, of a player with a fit.
    share_of_draws: Option<f64>,
}

impl PlayerShots {
    fn find(path: &Path, profile: &Profile, progress: &dyn Progress) -> Result<Self, Failure> {
        let (_, shots) = find_kinds(profile, &ShotKind::ALL, SensitivityTopics::NONE, progress)?;
        let fit = fit_folder::of_profile(path)?;
        let chance = |kind: ShotKind| {
            let shot = shots[kind.index()].as_ref().ok();
            let over_draws = match (&fit, shot) {
                (Some(fit), Some(shot)) => {
                    let p = fit_folder::shot_over_draws(fit, profile, &shot.nominal)?;
                    let shared = shared_sd(&fit.posterior.draws, &p.of_draws);
                    Some((p.interval(), shared))
                }
                _ => None,
            };
            Ok::<_, Failure>(KindChance {
                p: shot.map(|shot| Difference {
                    value: shot.estimate.probability,
                    standard_error: shot.estimate.standard_error,
                }),
                over_draws: over_draws.map(|(p, _)| p),
                shared_sd: over_draws.map_or(0.0, |(_, shared)| shared),
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
            location: profile.location(),
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

    fn row(&self, has_fits: bool) -> Vec<String> {
        let advice = match (self.verdict(), self.preference) {
            (Some(Verdict::Lean(_) | Verdict::Unsure), Some(preference)) => {
                format!("not clear, {}", preference.name())
            }
            (_, Some(preference)) => preference.name().to_owned(),
            (_, None) => "no shot".to_owned(),
        };
        let share = self
            .share_of_draws
            .map(|share| format!(" {} %", whole_percent(share)));
        let mut row = vec![self.name.clone(), self.place.clone()];
        for kind in &self.kinds {
            row.push(kind.cell());
            if has_fits {
                row.push(kind.interval());
            }
        }
        row.push(advice + &share.unwrap_or_default());
        row
    }
}

/// A place in a cell.
fn place_in_words(profile: &Profile) -> String {
    let words = profile.location().in_words(profile.output().units);
    words.replace(" from the hoop", "")
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
            "Fits with several places: the first place is used; --place 2 uses the second, --sweep COURT.toml any place.",
        );
    }
    let bars = ProgressBars::new();
    bars.begin("players", profiles.len() as u64);
    let find = |(path, profile): (PathBuf, Profile)| {
        let shots = PlayerShots::find(&path, &from.moved(profile)?, &Pulse(&bars));
        bars.advance(1);
        shots
    };
    let players: Result<Vec<PlayerShots>, Failure> = profiles.into_iter().map(find).collect();
    bars.end();
    let mut players = players?;
    pool(&mut players);
    print_text(&team_text(&players))?;
    print_hint(
        "Whole court, maps and posters: `bankshot new sweep sweep.toml`, then add --sweep sweep.toml",
    );
    Ok(code::DONE)
}

/// Whether the players of a team shoot from one place.
fn is_one_place(players: &[PlayerShots]) -> bool {
    /// Places as near as this are one.
    const NEAR_M: f64 = 0.01;
    let first = &players[0].location;
    players.iter().all(|player| {
        let there = &player.location;
        (there.distance_m - first.distance_m).abs() < NEAR_M
            && there.distance_m * (there.angle_rad - first.angle_rad).abs() < NEAR_M
    })
}

/// Players who shoot from one place are drawn towards the team's mean, as far as their shots leave
/// open where they are: the better kind of each, and the other one with it.
fn pool(players: &mut [PlayerShots]) {
    if !is_one_place(players) {
        return;
    }
    let alone: Vec<Standing> = players.iter().map(PlayerShots::standing).collect();
    for ((player, alone), pooled) in players.iter_mut().zip(&alone).zip(pooled(&alone)) {
        let by = pooled.value - alone.value;
        let narrower = match alone.standard_error > 0.0 {
            true => pooled.standard_error / alone.standard_error,
            false => 1.0,
        };
        for kind in &mut player.kinds {
            let Some(p) = &mut kind.over_draws else {
                continue;
            };
            let own = narrower * own_sd(p.sd, kind.shared_sd);
            let sd = libm::hypot(own, kind.shared_sd);
            // The shape of its distribution stays.
            let factor = if p.sd > 0.0 { sd / p.sd } else { 1.0 };
            let at = |end: f64| (p.mean + by + (end - p.mean) * factor).clamp(0.0, 1.0);
            *p = Interval {
                low: at(p.low),
                high: at(p.high),
                mean: at(p.mean),
                sd,
            };
        }
    }
}

/// What each player should do, then a table of their best shots.
fn team_text(players: &[PlayerShots]) -> TextAnswer {
    let standings: Vec<Standing> = players.iter().map(PlayerShots::standing).collect();
    let ranking = Ranking::of(&standings);
    let in_order = || {
        ranking
            .order
            .iter()
            .map(|&number| (number, &players[number]))
    };
    let mut answer = Vec::new();
    for verdict in Verdict::ALL {
        let names = in_order().filter(|(_, player)| player.verdict() == Some(verdict));
        let names: Vec<String> = names.map(|(_, player)| player.name.clone()).collect();
        match names.len() {
            0 => {}
            n if n == players.len() && n > 1 => answer.push(verdict.in_words("All players")),
            _ => answer.push(verdict.in_words(&list(&names))),
        }
    }
    let has_fits = players.iter().any(|player| player.has_fit);
    let mut columns = vec![("player", "", Side::Left), ("place", "", Side::Left)];
    for kind in ["direct", "bank"] {
        columns.push((kind, "", Side::Right));
        if has_fits {
            columns.push(("95 %", "", Side::Left));
        }
    }
    columns.push(("shoot it", "", Side::Left));
    let is_ranked = has_fits && players.len() > 1;
    if is_ranked {
        columns.push(("best of all", "", Side::Right));
    }
    let mut table = TextTable::new(&columns);
    for (number, player) in in_order() {
        let mut row = player.row(has_fits);
        if is_ranked {
            row.push(likely(ranking.is_best[number]));
        }
        table.add(row);
    }
    TextAnswer {
        answer,
        subject: format!(
            "Makes per 100 with each player's best shot, {}.",
            ranking.in_words()
        ),
        table: Some(table),
        notes: notes(players),
        ..TextAnswer::default()
    }
}

/// What the table means, as far as it needs words.
fn notes(players: &[PlayerShots]) -> Vec<String> {
    let any = |is: &dyn Fn(&PlayerShots) -> bool| players.iter().any(is);
    let has_fits = any(&|player| player.has_fit);
    let fits = players.iter().filter(|player| player.has_fit).count();
    let is_pooled = fits > 1 && is_one_place(players);
    let notes = [
        (
            true,
            "These are the best shots, not the ones the players take now (`bankshot advise`).",
        ),
        (
            any(&|player| player.preference == Some(Preference::Either)),
            "either: the two differ by less than 1 per 100.",
        ),
        (
            any(&|player| player.kinds.iter().any(|kind| kind.is_nearly_other)),
            "*: more than half of these makes are of the other kind.",
        ),
        (
            any(&|player| player.share_of_draws.is_some()),
            "shoot it: with the probability that this kind is better; below 90 % it is not clear.",
        ),
        (
            has_fits && players.len() > 1,
            "best of all: the probability that no other player's best shot makes more.",
        ),
        (
            is_pooled,
            "Makes are drawn towards the team's average, as far as a player's shots leave them open.",
        ),
        (!has_fits, "Each profile is taken as exact."),
        (has_fits, "This assumes a standard ring."),
    ];
    let there = notes.into_iter().filter(|(is_there, _)| *is_there);
    there.map(|(_, note)| note.to_owned()).collect()
}
