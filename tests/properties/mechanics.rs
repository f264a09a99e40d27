//! Symmetries and invariants of single shots.

use crate::common::{
    disagreements, event_driven, free_throw_uniform, release, side_uniform, verdicts,
};
use bankshot::dynamics::{
    Ending, Event, EventKind, Integrator, OutcomeKind, Precision, Release, Sample, Simulator,
    Verdict,
};
use bankshot::math::vector::Vec3;
use bankshot::model::{BallState, BoardEdge, PRESETS, Physics, Preset, SolidId};
use proptest::prelude::*;
use std::collections::HashSet;

/// A ball so fast that one step of a contact carries it across the hoop.
#[test]
fn contract_a_ball_that_the_numerics_lose_is_unresolved() {
    let mut physics = Physics {
        ball_radius_m: 0.15903711719162847,
        ball_mass_kg: 0.2796784161135271,
        ring_radius_m: 0.2534077306019684,
        ring_tube_diameter_m: 0.018,
        bracket_width_m: 9.518671372147642e-5,
        board_distance_m: 0.2669682555123216,
        gravity_m_s2: 1000.0,
        board_edge: BoardEdge::Rounded { radius_m: 0.0 },
        ..Preset::named("fiba").unwrap().physics()
    };
    physics.air.drag_coefficient = 0.001;
    physics.hoop_contact.stiffness_n_m = 29187.805874412727;
    physics.hoop_contact.damping_kg_s = 39.92315698169847;
    physics.hoop_contact.friction = 3.706622933656553e-5;
    let release = Release {
        distance_m: 4.608033875028611,
        court_angle_rad: -1.0299656672007325,
        height_above_hoop_m: -0.6795529106584268,
        speed_m_s: 78.11399385902473,
        pitch_rad: 1.1100938429846647,
        polar_rad: -1.0420495918211643,
        backspin_rad_s: 37.11146715495536,
        rifle_spin_rad_s: -16.976424811169604,
        side_spin_rad_s: 15.68551155870908,
    };
    for slope in [0.0, 1e-9] {
        physics.air.lift_slope = slope;
        let simulator = Simulator::new(&physics).unwrap();
        let verdict = simulator.simulate(&release).unwrap().verdict;
        assert_eq!(verdict.ending, Ending::Unresolved);
        assert!(verdict.time_s < 1.0 && !verdict.made, "{verdict:?}");
        let mut workspace = Default::default();
        let states = [release.state(); 9];
        let in_lanes = simulator.verdicts(&states, &mut workspace).unwrap();
        assert_eq!(in_lanes, [verdict; 9]);
    }
}

/// Distance of a point from the box between two corners.
fn distance_from_box(p: [f64; 3], low: [f64; 3], high: [f64; 3]) -> f64 {
    let beyond = [0, 1, 2].map(|i| p[i] - p[i].clamp(low[i], high[i]));
    beyond.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// How much board and hoop compress the ball, m.
fn compressions(physics: &Physics, state: &BallState) -> [f64; 2] {
    let p: [f64; 3] = state.position_m.into();
    let [x, y, z] = p;
    let (radius, tube) = (physics.ball_radius_m, physics.ring_tube_radius_m());
    let (edge, level) = (physics.board_edge.radius_m(), physics.board_centre_z_m());
    let half_width = 0.5 * physics.board_width_m - edge;
    let half_height = 0.5 * physics.board_height_m - edge;
    let core_x = -physics.board_distance_m - edge;
    let from_board = distance_from_box(
        p,
        [core_x, -half_width, level - half_height],
        [core_x, half_width, level + half_height],
    );
    let in_front =
        (z - level).abs() < half_height && y.abs() < half_width && x > -physics.board_distance_m;
    let board_acts = in_front || physics.board_edge != BoardEdge::None;
    let board = if board_acts {
        radius + edge - from_board
    } else {
        0.0
    };
    let inward = physics.ring_radius_m - (x * x + y * y).sqrt();
    let mut from_hoop = (inward * inward + z * z).sqrt();
    if physics.bracket_width_m > 0.0 {
        let half = 0.5 * physics.bracket_width_m;
        let from_bracket = distance_from_box(
            p,
            [-physics.board_distance_m, -half, 0.0],
            [-physics.ring_radius_m, half, 0.0],
        );
        from_hoop = from_hoop.min(from_bracket);
    }
    [board.max(0.0), (radius + tube - from_hoop).max(0.0)]
}

/// Kinetic, rotational, gravitational and elastic energy of the ball, J.
fn energy(physics: &Physics, state: &BallState) -> f64 {
    let radius = physics.ball_radius_m;
    let inertia = physics.inertia_ratio * physics.ball_mass_kg * radius * radius;
    let [board, hoop] = compressions(physics, state);
    0.5 * physics.ball_mass_kg * state.velocity_m_s.norm_squared()
        + 0.5 * inertia * state.spin_rad_s.norm_squared()
        + physics.ball_mass_kg * physics.gravity_less_buoyancy_m_s2() * state.position_m.z
        + 0.5 * physics.board_contact.stiffness_n_m * board * board
        + 0.5 * physics.hoop_contact.stiffness_n_m * hoop * hoop
}

/// Without damping all losses come from friction. Lift does no work. Where a contact passes from
/// the ring to the bracket, the normal jumps within a step, and the energy errs in proportion to
/// that step: brackets are tested with their damping.
#[test]
fn prop_energy_never_grows() {
    for preset in &PRESETS {
        let physics = preset.physics();
        energy_never_grows(&physics, (64, 150), (of_now(&physics), 0.0));
    }
    let undamped = Physics::with_restitution(1.0).unwrap();
    energy_never_grows(&undamped, (64, 300), (of_now(&undamped), 0.0));
    let mut lifted = Preset::named("ncaa").unwrap().physics();
    lifted.air.lift_slope = 1.0;
    energy_never_grows(&lifted, (64, 300), (of_now(&lifted), 0.0));
}

/// The share of its present energy that a ball may gain between two samples at 64 steps.
fn of_now(physics: &Physics) -> f64 {
    if physics.bracket_width_m > 0.0 {
        3e-5
    } else {
        2e-6
    }
}

/// A ball that is wedged between board and hoop for long gains energy by the square of the step, so
/// the steps are short. A wedged ball can have hardly any energy: what is allowed is a share of
/// that of the release.
#[test]
fn prop_energy_never_grows_in_undamped_leagues() {
    for preset in &PRESETS {
        let mut physics = preset.physics();
        physics.bracket_width_m = 0.0;
        for id in SolidId::ALL {
            physics.set_restitution_on(id, 1.0).unwrap();
        }
        energy_never_grows(&physics, (256, 300), (0.0, 2e-5));
    }
}

/// Over the board's edges and beside it on purpose too. What is allowed are shares of the energy of
/// the sample before and of the release.
fn energy_never_grows(
    physics: &Physics,
    (steps, shots): (u32, usize),
    (of_last, of_first): (f64, f64),
) {
    let simulator = event_driven(physics, steps);
    let mut releases = [free_throw_uniform(shots, 21), side_uniform(shots, 22)].concat();
    let mut at_edges = side_uniform(shots, 23);
    for (i, release) in at_edges.iter_mut().enumerate() {
        release.speed_m_s *= 1.25;
        release.polar_rad -= 0.004 * (i % 100) as f64;
    }
    releases.extend(at_edges);
    for release in releases {
        let trace = simulator.trace(&release, 0.02).unwrap();
        // Where the paper's board would act at once on a compressed ball, the shot ends.
        let comes_from_beside = trace.outcome.verdict.ending == Ending::BehindBoard
            && physics.board_edge == BoardEdge::None;
        let count = trace.samples.len() - usize::from(comes_from_beside);
        let first = energy(physics, &trace.samples[0].state);
        let mut last = f64::INFINITY;
        for sample in &trace.samples[..count] {
            let now = energy(physics, &sample.state);
            assert!(
                now <= last * (1.0 + of_last) + first * of_first,
                "{release:?} at {}: {last} to {now}",
                sample.time_s
            );
            last = now;
        }
    }
}

/// From the contact point to the centre, for a ball in single contact.
fn arm(physics: &Physics, sample: &Sample) -> Vec3<f64> {
    let p = sample.state.position_m;
    if sample.touches(SolidId::Board) {
        return Vec3::new(p.x + physics.board_distance_m, 0.0, 0.0);
    }
    let axis = (p.x * p.x + p.y * p.y).sqrt();
    let scale = 1.0 - physics.ring_radius_m / axis;
    Vec3::new(p.x * scale, p.y * scale, p.z)
}

#[test]
fn prop_angular_momentum_about_the_contact_is_kept() {
    // All of the contact force acts at the contact point. So about it only gravity has a moment:
    // I dw + m arm x (dv + g dt k) = 0 for every step of every single contact.
    let physics = Physics::paper();
    let radius = physics.ball_radius_m;
    let inertia = physics.inertia_ratio * radius * radius;
    let simulator = event_driven(&physics, 256);
    let mut checked = 0;
    let shots = [free_throw_uniform(200, 29), side_uniform(200, 23)].concat();
    for release in shots {
        let trace = simulator.trace(&release, 0.05).unwrap();
        for pair in trace.samples.windows(2) {
            let [a, b] = pair else { unreachable!() };
            let single = a.touches(SolidId::Board) != a.touches(SolidId::Ring);
            if !single || a.in_contact != b.in_contact {
                continue;
            }
            let dt = b.time_s - a.time_s;
            let dw = b.state.spin_rad_s - a.state.spin_rad_s;
            let mut dv = b.state.velocity_m_s - a.state.velocity_m_s;
            dv.z += physics.gravity_m_s2 * dt;
            let middle = (arm(&physics, a) + arm(&physics, b)) * 0.5;
            let moment = dw * inertia + middle.cross(&dv);
            let size = dv.norm() * radius;
            assert!(
                moment.iter().all(|m| m.abs() < 2e-3 * size + 1e-9),
                "{moment} of {size} at {}",
                a.time_s
            );
            checked += 1;
        }
    }
    assert!(checked > 10_000, "{checked}");
}

#[test]
fn prop_shots_mirrored_in_the_plane_of_symmetry_end_alike() {
    let simulator = Simulator::new(&Physics::paper()).unwrap();
    let shots = [free_throw_uniform(2000, 24), side_uniform(2000, 25)].concat();
    for mut release in shots {
        release.side_spin_rad_s = 3.0;
        release.rifle_spin_rad_s = -2.0;
        let a = simulator.simulate(&release).unwrap();
        let b = simulator.simulate(&release.mirrored()).unwrap();
        assert_eq!(a.verdict, b.verdict);
        assert_eq!(a.kind, b.kind);
    }
}

#[test]
fn prop_a_scaled_world_gives_the_same_shots() {
    // Lengths times 4 and times times 2 (exact in binary) leave gravity unchanged. Stiffness and
    // damping per mass scale with the inverse square and the inverse of time.
    let physics = Physics::paper();
    let mut large = physics.clone();
    for length in [
        &mut large.ball_radius_m,
        &mut large.ring_radius_m,
        &mut large.board_distance_m,
        &mut large.board_width_m,
        &mut large.board_height_m,
        &mut large.board_centre_height_m,
    ] {
        *length *= 4.0;
    }
    large = large.with_contacts(|contact| {
        contact.stiffness_n_m /= 4.0;
        contact.damping_kg_s /= 2.0;
    });
    large.time_limit_s *= 2.0;
    large.lodged_after_s *= 2.0;
    let shots = free_throw_uniform(2000, 26);
    let scaled: Vec<Release> = shots
        .iter()
        .map(|release| Release {
            distance_m: 4.0 * release.distance_m,
            height_above_hoop_m: 4.0 * release.height_above_hoop_m,
            speed_m_s: 2.0 * release.speed_m_s,
            backspin_rad_s: 0.5 * release.backspin_rad_s,
            ..*release
        })
        .collect();
    let a = verdicts(&Simulator::new(&physics).unwrap(), &shots);
    let b = verdicts(&Simulator::new(&large).unwrap(), &scaled);
    let differ = a.iter().zip(&b).filter(|(a, b)| a.made != b.made).count();
    // The tolerances are fixed lengths and speeds, so a few chaotic shots can differ.
    assert!(differ <= 4, "{differ}");
}

#[test]
fn prop_outcomes_are_consistent() {
    let simulator = Simulator::new(&Physics::paper()).unwrap();
    let mut kinds = HashSet::new();
    for outcome in simulator
        .simulate_batch(&free_throw_uniform(20_000, 27))
        .unwrap()
    {
        let contacts = &outcome.verdict.contacts;
        kinds.insert(outcome.kind);
        assert_eq!(outcome.verdict.made, outcome.kind.is_made());
        assert_eq!(
            contacts.to_string().split_whitespace().count() as u32,
            contacts.count()
        );
        assert_ne!(outcome.kind, OutcomeKind::Unresolved);
        if matches!(outcome.kind, OutcomeKind::Swish | OutcomeKind::Airball) {
            assert_eq!(contacts.count(), 0);
        }
        if outcome.verdict.made {
            assert!(outcome.entry.unwrap().angle_rad > 0.0);
        }
    }
    for kind in [
        OutcomeKind::Swish,
        OutcomeKind::RimIn,
        OutcomeKind::BankIn,
        OutcomeKind::BankRimIn,
        OutcomeKind::InAndOut,
        OutcomeKind::Short,
        OutcomeKind::Long,
        OutcomeKind::OverBoard,
        OutcomeKind::Lodged,
    ] {
        assert!(kinds.contains(&kind), "no shot was {kind}");
    }
}

#[test]
fn prop_the_rule_for_lodged_balls_changes_no_made_shot() {
    let with = Physics::paper();
    let without = Physics {
        lodged_after_s: 0.0,
        ..Physics::paper()
    };
    let shots = free_throw_uniform(20_000, 28);
    let (with, without) = (event_driven(&with, 8), event_driven(&without, 8));
    assert_eq!(disagreements(&with, &without, &shots), 0);
}

#[test]
fn prop_grazes_are_found() {
    // Parabolas that pass the back of the ring at a least distance just below or above R. The
    // event-driven integrator must tell them apart, however small the overlap. Bisection on the
    // speed, between a swish and the first contact, finds them.
    let simulator = Simulator::new(&Physics::paper()).unwrap();
    let mut edges = 0;
    for i in 0..50 {
        let pitch = 45.0 + 0.4 * f64::from(i);
        let shoot = |speed: f64| {
            let outcome = simulator.simulate(&release(0.0, speed, pitch, 0.3, 1.0));
            outcome.unwrap()
        };
        let count = |speed: f64| shoot(speed).verdict.contacts.count();
        let swish = (2200..2700)
            .map(|v| f64::from(v) * 0.01)
            .find(|&v| shoot(v).kind == OutcomeKind::Swish);
        let Some(mut low) = swish else { continue };
        let mut high = low + 2.0;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if count(middle) == 0 {
                low = middle
            } else {
                high = middle
            }
        }
        // On both sides of the edge the answer is the one for that side, down to 1e-6 ft/s.
        for off in [1e-3, 1e-4, 1e-5, 1e-6] {
            assert_eq!(count(low - off), 0, "pitch {pitch}");
            assert!(count(high + off) > 0, "pitch {pitch}");
        }
        edges += 1;
    }
    assert!(edges >= 40, "{edges}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn prop_every_release_ends(
        distance in 0.4_f64..12.0, court in -1.5_f64..1.5, height in -3.0_f64..1.0,
        speed in 0.0_f64..30.0, pitch in -1.5_f64..1.57, polar in -3.2_f64..3.2,
        back in -60.0_f64..60.0, rifle in -60.0_f64..60.0, side in -60.0_f64..60.0,
    ) {
        let release = Release {
            distance_m: distance,
            court_angle_rad: court,
            height_above_hoop_m: height,
            speed_m_s: speed,
            pitch_rad: pitch,
            polar_rad: polar,
            backspin_rad_s: back,
            rifle_spin_rad_s: rifle,
            side_spin_rad_s: side,
        };
        let simulator = Simulator::new(&Physics::paper()).unwrap();
        let outcome = simulator.simulate(&release).unwrap();
        prop_assert!(outcome.verdict.time_s.is_finite() && outcome.apex_m.is_finite());
        prop_assert!(outcome.kind != OutcomeKind::Unresolved, "{release:?}");
    }
}

#[test]
fn contract_a_ball_released_below_the_ring_and_falling_ends_at_once() {
    let release = Release {
        distance_m: 3.0,
        court_angle_rad: 0.0,
        height_above_hoop_m: -1.0,
        speed_m_s: 2.0,
        pitch_rad: -0.5,
        polar_rad: 0.0,
        backspin_rad_s: 0.0,
        rifle_spin_rad_s: 0.0,
        side_spin_rad_s: 0.0,
    };
    for integrator in [Integrator::EVENT_DRIVEN, Integrator::PAPER_RK4] {
        let simulator = Simulator::with_integrator(&Physics::paper(), integrator).unwrap();
        let verdict = simulator.simulate(&release).unwrap().verdict;
        assert_eq!(verdict.ending, Ending::NeverRose, "{integrator:?}");
        assert!(verdict.time_s < 0.1, "{integrator:?}");
    }
}

#[test]
fn prop_a_board_that_ends_above_the_ring_takes_no_more_steps() {
    // A ball on the ring below the board is not about to touch it. Steps that waited for the touch
    // made this board 40 times slower.
    let steps = |board_height_m: f64| {
        let physics = Physics {
            board_height_m,
            ..Physics::paper()
        };
        let simulator = Simulator::new(&physics).unwrap();
        let shots = free_throw_uniform(3000, 8);
        let samples = |release: &Release| simulator.trace(release, 10.0).unwrap().samples.len();
        shots.iter().map(samples).max().unwrap()
    };
    let (standard, short) = (steps(Physics::paper().board_height_m), steps(0.31));
    println!("most steps of a shot: {standard}, with the short board {short}");
    assert!(short < 2 * standard, "{standard} {short}");
}

/// The accepted physics with a given mass, contact time and restitution, without gravity.
fn bouncing(mass_kg: f64, contact_time_s: f64, restitution: f64) -> Option<Physics> {
    let decrement = -libm::log(restitution) / std::f64::consts::PI;
    let frequency = std::f64::consts::PI / contact_time_s;
    let mut physics = Physics {
        ball_mass_kg: mass_kg,
        gravity_m_s2: 1e-9,
        ..Physics::paper()
    }
    .with_contacts(|contact| {
        contact.stiffness_n_m = mass_kg * frequency * frequency * (1.0 + decrement * decrement);
    });
    physics.set_restitution(restitution).ok()?;
    physics.errors().is_empty().then_some(physics)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    /// Authority: the closed form exp(-pi alpha/omega) (the paper's Appendix 1), over the whole
    /// range of accepted masses, contact times and restitutions.
    #[test]
    fn prop_a_head_on_bounce_has_its_restitution(
        mass in -3.0..2.0,
        time in -4.0..-0.3,
        restitution in prop_oneof![0.001..1.0, 0.99..1.0],
        speed in -1.0..1.0,
    ) {
        let power = |exponent: f64| libm::exp(exponent * std::f64::consts::LN_10);
        let Some(physics) = bouncing(power(mass), power(time), restitution) else {
            return Ok(());
        };
        let speed = power(speed);
        let deepest = speed * (physics.ball_mass_kg / physics.board_contact.stiffness_n_m).sqrt();
        if deepest > 0.5 * physics.ball_radius_m {
            return Ok(());
        }
        let start = BallState {
            position_m: Vec3::new(0.0, 0.3, 0.6),
            velocity_m_s: Vec3::new(-speed, 0.0, 0.0),
            spin_rad_s: Vec3::zeros(),
        };
        let trace = Simulator::new(&physics).unwrap().trace_state(start, 1.0).unwrap();
        let parted = |event: &&Event| matches!(event.kind, EventKind::Part { .. });
        let after = trace.events.iter().find(parted).unwrap().state.velocity_m_s.x;
        prop_assert!((after / speed - physics.restitution()).abs() < 1e-6);
    }
}

/// Single precision is chosen for balls like those in play. There it must give the same shares of
/// made shots as double precision: 4e-4 of the shots of either disagree with tiny steps
/// (docs/performance.md), so two of them disagree on 8e-4 at most, 24 of 30,000. More than 45
/// disagree by chance (binomial) for 1 of 20,000 choices of seeds. Their numbers of made shots
/// differ by less than the root of the disagreements times four.
#[test]
fn prop_single_precision_gives_the_shots_of_double_precision() {
    let stiff = |stiffness_n_m| {
        Physics::paper().with_contacts(|contact| contact.stiffness_n_m = stiffness_n_m)
    };
    let (soft, hard) = (stiff(3000.0), stiff(2_000_000.0));
    let light = Physics {
        ball_mass_kg: 0.136,
        ..Physics::paper()
    };
    for physics in [
        Physics::paper(),
        Physics::with_restitution(0.3).unwrap(),
        Physics::with_restitution(0.95).unwrap(),
        soft,
        hard,
        light,
    ] {
        let at = |precision| {
            let integrator = Integrator::EventDriven {
                steps_per_contact: 4,
                precision,
            };
            Simulator::with_integrator(&physics, integrator).unwrap()
        };
        let shots = free_throw_uniform(30_000, 41);
        let single = verdicts(&at(Precision::Automatic), &shots);
        let double = verdicts(&at(Precision::Double), &shots);
        let count = |from: &[Verdict], to: &[Verdict]| {
            from.iter()
                .zip(to)
                .filter(|(a, b)| a.made && !b.made)
                .count()
        };
        let (gained, lost) = (count(&single, &double), count(&double, &single));
        println!("{} gained, {} lost", gained, lost);
        assert_ne!(single, double, "single precision was not used");
        assert!(gained + lost <= 45, "{gained} {lost}");
        let difference = gained.abs_diff(lost) as f64;
        assert!(difference <= 4.0 * ((gained + lost) as f64).sqrt());
    }
}
