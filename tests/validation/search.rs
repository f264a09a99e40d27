//! The search for the best shot against brute force.

use crate::common::{at, grid, load};
use bankshot::analysis::sensitivity::SensitivityTopics;
use bankshot::best_shot::{
    self, BestShot, PhysicsOf, ShotKind, TableKind, best_by_pitch, compare_physics,
    physics_variants,
};
use bankshot::model::{Physics, Preset};
use bankshot::probability::{NominalTable, Sampler, Silent};
use bankshot::search_space::{TablePlan, sample_wide};
use bankshot::shooter::{Correlation, Nominal, Profile, ReleaseVariable, SearchSettings};
use bankshot::units::FOOT_M;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

#[test]
#[ignore = "two minutes: cargo test --test validation campaign_best -- --ignored --nocapture"]
fn campaign_best_is_within_three_thousandths_of_a_brute_force_search() {
    // Authority: brute force. It simulates a table of 2.7 million shots over everything the shooter
    // can intend. Of the table's nominal shots it takes the thirty best of each kind, no two of
    // them neighbours, and integrates these to 0.0005.
    let places = [
        ("free_throw", 13.75, 0.0),
        ("free_throw", 6.0, 30.0),
        ("free_throw", 9.0, 60.0),
        ("bank_wing", 12.0, 50.0),
        ("bank_wing", 18.0, 50.0),
        ("elite", 20.0, 0.0),
        ("elite", 15.0, 75.0),
        ("novice", 10.0, 20.0),
        ("school_player", 13.75, -45.0),
        ("three_pointer", 22.0, 10.0),
    ];
    for (name, distance_ft, angle_deg) in places {
        let profile = at(&load(name), distance_ft * FOOT_M, angle_deg)
            .with(|settings| {
                settings.search = SearchSettings {
                    standard_error: Some(0.0005),
                    ..SearchSettings::default()
                };
            })
            .unwrap();
        let sampler = Sampler::new(&profile);
        let best = best_shot::find(&profile, &Silent).unwrap();
        let wide = profile
            .with(|settings| settings.grid = grid(120, 90, 84, 10))
            .unwrap();
        let plan = TablePlan::for_search(&wide).unwrap();
        let table = NominalTable::simulate(&wide, &plan, &Silent).probabilities(&wide);
        let mut order: Vec<usize> = (0..table.values.len()).collect();
        order.sort_by(|&a, &b| table.values[b].total_cmp(&table.values[a]));
        let counts = table.counts();
        let index_of = |i: usize| {
            let (rest, speed) = (i / counts[3], i % counts[3]);
            let (rest, spin) = (rest / counts[2], rest % counts[2]);
            [rest / counts[1], rest % counts[1], spin, speed]
        };
        for (kind, found) in best.by_kind() {
            let mut chosen: Vec<[usize; 4]> = Vec::new();
            let mut brute = 0.0_f64;
            for &i in &order {
                let index = index_of(i);
                let near = |other: &[usize; 4]| (0..4).all(|k| index[k].abs_diff(other[k]) <= 1);
                let (p, shot) = table.at(index);
                if chosen.len() == 30 || p == 0.0 {
                    break;
                }
                if chosen.iter().any(near) || ShotKind::of(&profile, &shot) != kind {
                    continue;
                }
                chosen.push(index);
                let estimate = sampler.estimate(&shot, 0.0005, 31, &Silent);
                brute = brute.max(estimate.probability);
            }
            let p = found.as_ref().map_or(0.0, |shot| shot.estimate.probability);
            println!(
                "{name:13} {distance_ft:5} ft {angle_deg:5} deg {:6}: best {p:.4}, \
                 brute force {brute:.4}, {:+.4}",
                kind.name(),
                p - brute
            );
            assert!(p > brute - 0.003, "{name} {kind:?}: {p} {brute}");
        }
    }
}

/// Authority: brute force. The best of 2000 random shots within two standard deviations of the
/// shot that was found, each with 4096 samples; the thirty best of these are integrated to 0.0005.
/// (A table, as above, has no correlated errors.)
#[test]
#[ignore = "two minutes: cargo test --test validation campaign_best -- --ignored --nocapture"]
fn campaign_best_under_correlated_errors_is_within_three_thousandths_of_random_shots() {
    let places = [
        ("free_throw", 13.75, 0.0, 0.5),
        ("free_throw", 9.0, 60.0, -0.5),
        ("bank_wing", 18.0, 50.0, 0.3),
        ("elite", 20.0, 0.0, -0.3),
        ("novice", 10.0, 20.0, 0.6),
        ("three_pointer", 22.0, 10.0, -0.6),
    ];
    for (name, distance_ft, angle_deg, speed_pitch) in places {
        let profile = at(&load(name), distance_ft * FOOT_M, angle_deg)
            .with(|settings| {
                settings.search = SearchSettings {
                    standard_error: Some(0.0005),
                    ..SearchSettings::default()
                };
                let pairs = [
                    (ReleaseVariable::Speed, ReleaseVariable::Pitch, speed_pitch),
                    (ReleaseVariable::Speed, ReleaseVariable::Polar, 0.2),
                ];
                settings.shooter.dispersion.correlation = Correlation::new(&pairs).unwrap();
            })
            .unwrap();
        let sampler = Sampler::new(&profile);
        let best = best_shot::find(&profile, &Silent).unwrap();
        for (kind, found) in best.by_kind() {
            let Ok(found) = found else {
                println!(
                    "{name:13} {distance_ft:5} ft {angle_deg:5} deg: no {}",
                    kind.name()
                );
                continue;
            };
            let mut random = ChaCha12Rng::seed_from_u64(8);
            let dispersion = &profile.shooter().dispersion;
            let centre = found.nominal;
            let (low_spin, high_spin) = profile.backspin_range_rad_s();
            let mut tried: Vec<(f64, Nominal)> = (0..2000)
                .map(|_| {
                    let mut away = |sigma: f64| sigma * random.random_range(-2.0..2.0);
                    Nominal {
                        speed_m_s: centre.speed_m_s + away(dispersion.speed_m_s(centre.speed_m_s)),
                        pitch_rad: centre.pitch_rad + away(dispersion.c20_rad),
                        polar_rad: centre.polar_rad + away(dispersion.c30_rad),
                        backspin_rad_s: (centre.backspin_rad_s + away(3.0))
                            .clamp(low_spin, high_spin),
                        ..centre
                    }
                })
                .filter(|shot| ShotKind::of(&profile, shot) == kind)
                .map(|shot| {
                    let estimate = sampler.estimate_within(&shot, 1e-6, 4096, 31, &Silent);
                    (estimate.probability, shot)
                })
                .collect();
            tried.sort_by(|a, b| b.0.total_cmp(&a.0));
            let brute = tried[..30]
                .iter()
                .map(|(_, shot)| sampler.estimate(shot, 0.0005, 32, &Silent).probability)
                .fold(0.0, f64::max);
            let p = found.estimate.probability;
            println!(
                "{name:13} {distance_ft:5} ft {angle_deg:5} deg {:6}: best {p:.4}, \
                 random shots {brute:.4}, {:+.4}",
                kind.name(),
                p - brute
            );
            assert!(p > brute - 0.003, "{name} {kind:?}: {p} {brute}");
        }
    }
}

/// Shots that were made from outside the range that a search simulates, out of `shots` drawn in a
/// wider one, at places from beside the ring to 60 ft away. (Those faster than `speed_max` are left
/// out: nobody throws the high lobs that go in from near the hoop.)
fn made_outside_the_range(physics: &Physics, shots: u64) -> u64 {
    let mut made = 0;
    for distance_ft in [1.2, 3.0, 6.0, 13.75, 25.0, 40.0, 60.0] {
        for angle_deg in [0.0, 50.0, 88.0] {
            let profile = at(&load("free_throw"), distance_ft * FOOT_M, angle_deg)
                .with(|settings| settings.physics = physics.clone())
                .unwrap();
            let plan = TablePlan::for_search(&profile).unwrap();
            let sample = sample_wide(&profile, &plan, shots);
            assert!(sample.outside > shots / 10, "{distance_ft} {angle_deg}");
            made += sample.made_outside;
        }
    }
    made
}

/// The physics whose flights differ most: a vacuum, air, and air with lift.
fn physics_with_and_without_air() -> [(&'static str, Physics); 3] {
    let named = |name: &str| Preset::named(name).unwrap().physics();
    let mut lift = named("ncaa");
    lift.air.lift_slope = 1.0;
    [
        ("paper", named("paper")),
        ("ncaa", named("ncaa")),
        ("ncaa with lift", lift),
    ]
}

/// Authority: brute force. `prop_no_made_shot_lies_outside_the_bracket` is the small test of it,
/// under the paper's physics.
#[test]
#[ignore = "four minutes: cargo test --test validation campaign_no_made_shot -- --ignored --nocapture"]
fn campaign_no_made_shot_lies_outside_the_range_of_a_search() {
    let mut found = 0;
    for (name, physics) in physics_with_and_without_air() {
        let made = made_outside_the_range(&physics, 200_000);
        println!("{name}: 21 places, 4.2 million releases; {made} made outside the range");
        found += made;
    }
    assert_eq!(found, 0);
}

/// By how much P of shots exceeds that of full searches.
#[derive(Default)]
struct Gains {
    /// Of shots that were followed from neighbours.
    followed: Vec<f64>,
    /// Of shots that full searches with another seed find: the luck of a search on a flat top.
    other_seed: Vec<f64>,
}

impl Gains {
    /// Takes the followed shot and that of a full search of the profile. P of all shots is
    /// estimated with the seed of the profile.
    fn take(
        &mut self,
        profile: &Profile,
        followed: Option<Nominal>,
        search: impl Fn(&Profile) -> Option<Nominal>,
        other_seed: Option<u64>,
    ) {
        let settings = profile.search();
        let sampler = Sampler::new(profile);
        let probability = |shot: Option<Nominal>| {
            shot.map_or(0.0, |shot| {
                let error = settings.standard_error;
                let estimate = sampler.estimate(&shot, error, settings.seed, &Silent);
                estimate.probability
            })
        };
        let full = probability(search(profile));
        self.followed.push(probability(followed) - full);
        if let Some(seed) = other_seed {
            let other = profile.with(|settings| settings.search.seed = Some(seed));
            let other = probability(search(&other.unwrap()));
            self.other_seed.push(other - full);
        }
    }
}

/// The gains of some kinds at some pitch angles, and of both under every so many changes of the
/// physics.
fn gains_of_following(
    name: &str,
    (kinds, pitches_deg): (&[ShotKind], &[f64]),
    physics_steps: usize,
    other_seed: Option<u64>,
) -> Gains {
    let profile = load(name);
    let mut gains = Gains::default();
    let pitches: Vec<f64> = pitches_deg.iter().map(|pitch| pitch.to_radians()).collect();
    for kind in kinds {
        let kind = TableKind::One(*kind);
        let rows = |profile: &Profile, pitches: &[f64]| {
            let rows = best_by_pitch(profile, kind, pitches, &Silent).unwrap();
            let shots = rows.into_iter().map(|row| {
                let clean = row.shot.map(|shot| shot.nominal);
                clean.or(row.not_clean.map(|shot| shot.nominal))
            });
            shots.collect::<Vec<Option<Nominal>>>()
        };
        for (pitch, followed) in pitches.iter().zip(rows(&profile, &pitches)) {
            // Of one angle alone all shots are searched.
            let search = |profile: &Profile| rows(profile, &[*pitch])[0];
            gains.take(&profile, followed, search, other_seed);
        }
    }
    let variants = physics_variants(profile.physics(), PhysicsOf::Profile);
    let variants: Vec<_> = variants.into_iter().step_by(physics_steps).collect();
    let rows = compare_physics(&profile, &variants, &Silent).unwrap().rows;
    for row in rows {
        let other = profile.with(|settings| settings.physics = row.physics.clone());
        let other = other.unwrap();
        for (kind, followed) in ShotKind::ALL.into_iter().zip([row.direct, row.bank]) {
            let search = |profile: &Profile| {
                let topics = SensitivityTopics::NONE;
                let found = best_shot::find_kinds(profile, &[kind], topics, &Silent).unwrap();
                let [shot] = found.1.try_into().unwrap();
                shot.ok().map(|shot: BestShot| shot.nominal)
            };
            let followed = followed.ok().map(|shot| shot.nominal);
            gains.take(&other, followed, search, other_seed);
        }
    }
    gains
}

/// Authority: full searches. Each P has a standard error of 0.001, the same random numbers on both
/// sides; a loss of 0.005 is none by chance. The seed is fixed: no false alarm.
#[test]
fn val_optima_that_are_followed_are_those_of_full_searches() {
    let pitches = [45.0, 50.0, 55.0, 60.0];
    let kinds = [ShotKind::Direct];
    let gains = gains_of_following("free_throw", (&kinds, &pitches), 12, None).followed;
    let least = gains.iter().copied().fold(0.0, f64::min);
    println!("{} shots, least gain {least:.4}", gains.len());
    assert!(least > -0.005, "{gains:?}");
}

/// A speed limit holds where shots are followed, too: those of steep and flat angles are faster.
#[test]
fn contract_followed_shots_keep_the_limits() {
    let most_m_s = 23.8 * FOOT_M;
    let limited = load("free_throw").with(|settings| {
        settings.search.speed_max_m_s = Some(most_m_s);
        settings.search.standard_error = Some(0.005);
    });
    let pitches = [50.0, 54.0, 58.0, 62.0_f64].map(f64::to_radians);
    let kind = TableKind::One(ShotKind::Direct);
    let rows = best_by_pitch(&limited.unwrap(), kind, &pitches, &Silent).unwrap();
    let speeds: Vec<f64> = rows
        .iter()
        .map(|row| {
            let clean = row.shot.as_ref().map(|shot| shot.nominal);
            let any = clean.or(row.not_clean.map(|shot| shot.nominal));
            any.map_or(0.0, |shot| shot.speed_m_s)
        })
        .collect();
    assert!(speeds.iter().all(|speed| *speed <= most_m_s), "{speeds:?}");
    // At 58 deg 24.0 ft/s are best.
    assert!(speeds[2] > 0.999 * most_m_s, "{speeds:?}");
}

/// As the optima above, for nine shooters, all pitch angles and every change of the physics. On a
/// flat top a search ends up here or there by luck: with another seed, full searches are lower, too,
/// which is printed beside. At most 1 % of the followed shots may be lower by more than 0.003, and
/// no more often than with another seed, but for three standard deviations of the two counts. All
/// seeds are fixed: no false alarm.
#[test]
#[ignore = "20 minutes: cargo test --test validation campaign_followed -- --ignored --nocapture"]
fn campaign_followed_optima_are_those_of_full_searches() {
    const LOSS: f64 = 0.003;
    let pitches: Vec<f64> = (0..13).map(|k| 42.0 + 2.0 * f64::from(k)).collect();
    let mut all = Gains::default();
    let say = |name: &str, gains: &Gains| {
        [
            ("followed", &gains.followed),
            ("other seed", &gains.other_seed),
        ]
        .map(|(which, gains)| {
            let mean = gains.iter().sum::<f64>() / gains.len() as f64;
            let least = gains.iter().copied().fold(0.0, f64::min);
            let lower = gains.iter().filter(|gain| **gain < -LOSS).count();
            let higher = gains.iter().filter(|gain| **gain > LOSS).count();
            println!(
                "{name}, {which}: {} shots, mean {mean:+.5}, least {least:+.4}, \
                 {lower} lower and {higher} higher by more than {LOSS}",
                gains.len()
            );
            (mean, least, lower as f64)
        })
    };
    for name in [
        "free_throw",
        "bank_wing",
        "big_at_the_elbow",
        "elite",
        "novice",
        "school_player",
        "three_pointer",
        "underhand",
        "youth",
    ] {
        let gains = gains_of_following(name, (&ShotKind::ALL, &pitches), 1, Some(2));
        say(name, &gains);
        all.followed.extend(gains.followed);
        all.other_seed.extend(gains.other_seed);
    }
    let [(mean, least, lower), (_, _, lower_by_luck)] = say("all", &all);
    assert!(mean > -0.0005, "{mean}");
    assert!(least > -0.01, "{least}");
    assert!(lower <= all.followed.len() as f64 / 100.0, "{lower}");
    let luck = lower_by_luck + 3.0 * (lower + lower_by_luck).sqrt();
    assert!(lower <= luck, "{lower}, {lower_by_luck} with another seed");
}
