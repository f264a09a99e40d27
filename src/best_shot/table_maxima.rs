//! The tops of a table of probabilities: where climbs start, and the best shot of a window.

use crate::probability::NominalProbabilities;
use crate::shooter::{Nominal, Profile, ShotKind};
use rayon::prelude::*;

/// Distance in pitch between starts, in nominal pitch angles of the table.
const START_GAP: usize = 3;

/// A nominal shot of a table with its P.
pub(super) type Candidate = (f64, Nominal);

/// For each kind: the best nominal shot at each nominal pitch angle.
pub(super) fn maxima_by_pitch(
    profile: &Profile,
    table: &NominalProbabilities,
) -> [Vec<Option<Candidate>>; 2] {
    let rows: Vec<[Option<Candidate>; 2]> = (0..table.pitch_rad.len())
        .into_par_iter()
        .map(|pitch| maxima_at_pitch(profile, table, pitch))
        .collect();
    ShotKind::ALL.map(|kind| rows.iter().map(|row| row[kind.index()]).collect())
}

/// For each kind, where the pitch angle is fixed: the best nominal shot at each speed that has
/// a higher P than those at the speeds beside it. One pitch angle can have several such
/// speeds, for example over and off the front of the ring.
pub(super) fn maxima_by_speed(
    profile: &Profile,
    table: &NominalProbabilities,
) -> [Vec<Option<Candidate>>; 2] {
    let best_at = |speed: usize| {
        let mut best: [Option<Candidate>; 2] = [None, None];
        for polar in 0..table.polar_rad.len() {
            for spin in 0..table.backspin_rad_s.len() {
                let (p, nominal) = table.at([0, polar, spin, speed]);
                if !(p > 0.0) {
                    continue;
                }
                let slot = &mut best[ShotKind::of(profile, &nominal).index()];
                if slot.is_none_or(|(most, _)| p > most) {
                    *slot = Some((p, nominal));
                }
            }
        }
        best
    };
    let rows: Vec<[Option<Candidate>; 2]> = (0..table.speed_m_s.len()).map(best_at).collect();
    let best = ShotKind::ALL.map(|kind| {
        let of_kind = rows.iter().map(|row| row[kind.index()]);
        of_kind.collect::<Vec<_>>()
    });
    best.map(|by_speed| {
        let p = |i: Option<usize>| {
            i.and_then(|i| by_speed.get(i).copied().flatten())
                .map_or(0.0, |(p, _)| p)
        };
        let is_top = |i: usize| p(Some(i)) >= p(i.checked_sub(1)) && p(Some(i)) > p(Some(i + 1));
        let tops = by_speed.iter().enumerate();
        tops.map(|(i, candidate)| candidate.filter(|_| is_top(i)))
            .collect()
    })
}

fn maxima_at_pitch(
    profile: &Profile,
    table: &NominalProbabilities,
    pitch: usize,
) -> [Option<Candidate>; 2] {
    let mut maxima: [Option<Candidate>; 2] = [None, None];
    for polar in 0..table.polar_rad.len() {
        for speed in 0..table.speed_m_s.len() {
            // The kind does not depend on spin: it is decided in flight.
            let best = (0..table.backspin_rad_s.len())
                .map(|spin| table.at([pitch, polar, spin, speed]))
                .fold((0.0, None), |best: (f64, Option<Nominal>), (p, nominal)| {
                    if p > best.0 { (p, Some(nominal)) } else { best }
                });
            let (p, Some(nominal)) = best else { continue };
            let beats = |maximum: &Option<Candidate>| maximum.is_none_or(|(most, _)| p > most);
            if !maxima.iter().any(beats) {
                continue;
            }
            let maximum = &mut maxima[ShotKind::of(profile, &nominal).index()];
            if beats(maximum) {
                *maximum = Some((p, nominal));
            }
        }
    }
    maxima
}

/// The maxima, the best first, without those that are nearer than [`START_GAP`] pitch angles (or
/// speeds) to one before.
pub(super) fn separated(maxima: &[Option<Candidate>]) -> Vec<Candidate> {
    let mut order: Vec<(usize, Candidate)> = maxima
        .iter()
        .enumerate()
        .filter_map(|(i, maximum)| maximum.map(|maximum| (i, maximum)))
        .collect();
    order.sort_by(|a, b| b.1.0.total_cmp(&a.1.0).then(a.0.cmp(&b.0)));
    let mut chosen: Vec<(usize, Candidate)> = Vec::new();
    for (i, candidate) in order {
        if chosen.iter().all(|(j, _)| i.abs_diff(*j) >= START_GAP) {
            chosen.push((i, candidate));
        }
    }
    chosen.into_iter().map(|(_, candidate)| candidate).collect()
}
