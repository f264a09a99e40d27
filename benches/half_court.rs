//! The time of `best` at places of the half court under `ncaa`, over that under `paper`:
//! `cargo bench --bench half_court` (about four minutes on two cores, after its build).
//!
//! Both physics take turns at each place. A machine that becomes slower or faster for a while
//! affects both, and the time of each is the least of its rounds.

use bankshot::model::Preset;
use bankshot::probability::Silent;
use bankshot::sweep::job_list::Jobs;
use bankshot::sweep::run::compute_jobs;
use bankshot::sweep::sweep_toml::parse_sweep;
use bankshot::sweep::{SourceTexts, SweepConfig};
use std::hint::black_box;
use std::time::Instant;

/// Rounds of each place.
const ROUNDS: usize = 3;
/// Every so many of the places are computed.
const STRIDE: usize = 5;
/// The presets, the one that others are compared with first.
const PRESETS: [&str; 2] = ["paper", "ncaa"];

fn main() {
    let configs = PRESETS.map(config_under);
    let jobs = configs.each_ref().map(Jobs::new);
    let spots = (0..jobs[0].spots.len()).step_by(STRIDE);
    let mut totals_s = [0.0; PRESETS.len()];
    println!(
        "half_court_3ft.toml, {} threads, least of {ROUNDS} rounds: place, {} (s), ratio",
        rayon::current_num_threads(),
        PRESETS.join(" (s), ")
    );
    for spot in spots {
        let mut least_s = [f64::INFINITY; PRESETS.len()];
        for _ in 0..ROUNDS {
            for (least_s, (config, jobs)) in least_s.iter_mut().zip(configs.iter().zip(&jobs)) {
                let kinds: Vec<usize> = (0..jobs.kinds.len()).collect();
                let began = Instant::now();
                black_box(compute_jobs(config, jobs, spot, &kinds, &Silent).unwrap());
                *least_s = least_s.min(began.elapsed().as_secs_f64());
            }
        }
        let place = &jobs[0].spots[spot];
        let [paper_s, ncaa_s] = least_s;
        println!(
            "  {:5.2} m, {:5.2} m {paper_s:8.3} {ncaa_s:8.3} {:6.2}",
            place.x_m,
            place.y_m,
            ncaa_s / paper_s
        );
        for (total_s, least_s) in totals_s.iter_mut().zip(least_s) {
            *total_s += least_s;
        }
    }
    let [paper_s, ncaa_s] = totals_s;
    println!(
        "  all of these   {paper_s:8.3} {ncaa_s:8.3} {:6.2}",
        ncaa_s / paper_s
    );
}

/// The sweep of `configs/half_court_3ft.toml` with a preset.
fn config_under(preset: &str) -> SweepConfig {
    let texts = SourceTexts {
        sweep: include_str!("../configs/half_court_3ft.toml").to_owned(),
        shooter: Some(include_str!("../configs/free_throw.toml").to_owned()),
        places: None,
    };
    let mut config = parse_sweep(&texts, "half_court_3ft.toml").unwrap();
    config.settings.physics = Preset::named(preset).unwrap().physics();
    config
}
