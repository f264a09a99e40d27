//! `--plan` of `best`, and the older `bankshot plan`: what a search would simulate, and its cost.

use super::plan_sweep_time_and_memory;
use crate::answers::checks::PlanAnswer;
use crate::answers::json::{self, Provenance};
use crate::cli::config_files::read_text;
use crate::cli::failure::Failure;
use crate::cli::loaded_profile::load_profile;
use crate::cli::terminal::{is_quiet, print_answer, print_prose, print_remark};
use crate::cli::value_parsers::PhysicsArg;
use crate::dynamics::BatchWorkspace;
use crate::math::evenly_spaced::CellAxis;
use crate::probability::MAX_BATCH_BYTES;
use crate::search_space::{TablePlan, WideSample, sample_wide};
use crate::shooter::{Nominal, Profile};
use crate::sweep::sweep_toml::is_sweep;
use crate::units::{DEGREE_RAD, REV_RAD};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Args, Debug)]
pub(crate) struct PlanOptions {
    /// The shooter's profile, or a sweep.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
    /// Shots that check the search range; 0 for none.
    #[arg(long, value_name = "N", default_value_t = WIDE_SAMPLE)]
    pub(crate) wide_sample: u64,
}

/// Shots that check the search range, unless another number is given.
pub(super) const WIDE_SAMPLE: u64 = 200_000;
/// About the number of shots of the climbs and the final estimates.
const SEARCH_SHOTS: u64 = 1_000_000;
/// About the number of windows of a search: one for each kind.
const WINDOWS: u64 = 2;
/// Shots that the forecast is based on.
const FORECAST_SHOTS: u32 = 65_536;
/// About the memory of the program itself, bytes.
const PROGRAM_BYTES: f64 = 10e6;

/// What `best` would take.
struct Forecast {
    seconds: f64,
    threads: usize,
    memory_bytes: f64,
    /// Bound of the probability beyond the table: for a shot in the middle of its pitch angles and
    /// backspins, and for one at their lower edge.
    mass_outside: (f64, f64),
    wide_sample: Option<WideSample>,
}

pub(crate) fn run(options: &PlanOptions) -> Result<u8, Failure> {
    if is_sweep(&read_text(&options.profile)?) {
        return plan_sweep_time_and_memory::run(&options.profile, options.json);
    }
    let profile = load_profile(&options.profile, &options.physics)?;
    print_plan_of_search(&profile, options.wide_sample, options.json)
}

/// Prints what the search of `best` would simulate.
pub(super) fn print_plan_of_search(
    profile: &Profile,
    wide_sample: u64,
    as_json: bool,
) -> Result<u8, Failure> {
    let plan = TablePlan::for_search(profile)?;
    let forecast = forecast(profile, &plan, wide_sample);
    if as_json {
        let answer = answer(profile, plan, &forecast);
        return print_answer(&json::text(&json::document(
            &answer,
            profile.output().units,
        )));
    }
    let misses_makes = forecast
        .wide_sample
        .is_some_and(|sample| sample.made_outside > 0);
    if misses_makes && !is_quiet() {
        print_remark(
            "remark: shots outside the search range were made; raise speed_max, or report it",
        );
    }
    print_prose(&text(profile, &plan, &forecast))
}

fn forecast(profile: &Profile, plan: &TablePlan, wide_sample: u64) -> Forecast {
    let (least_spin, most_spin) = profile.backspin_range_rad_s();
    let middle = Nominal {
        speed_m_s: plan.nominal.speed.low,
        pitch_rad: 0.5 * (profile.search().pitch_min_rad + profile.search().pitch_max_rad),
        polar_rad: profile.location().angle_rad,
        backspin_rad_s: 0.5 * (least_spin + most_spin),
        ..Nominal::default()
    };
    let edge = Nominal {
        pitch_rad: profile.search().pitch_min_rad,
        backspin_rad_s: least_spin,
        ..middle
    };
    let threads = rayon::current_num_threads();
    Forecast {
        seconds: forecast_s(profile, plan),
        threads,
        // The table, a batch of shots on each thread, and the program.
        memory_bytes: plan.memory_bytes as f64 + (threads * MAX_BATCH_BYTES) as f64 + PROGRAM_BYTES,
        mass_outside: (
            plan.mass_outside(profile, &middle),
            plan.mass_outside(profile, &edge),
        ),
        wide_sample: (wide_sample > 0).then(|| sample_wide(profile, plan, wide_sample)),
    }
}

fn answer(profile: &Profile, plan: TablePlan, forecast: &Forecast) -> PlanAnswer {
    let (mass_outside_middle, mass_outside_edge) = forecast.mass_outside;
    PlanAnswer {
        provenance: Provenance::of(profile),
        plan,
        forecast_s: forecast.seconds,
        memory_bytes: forecast.memory_bytes.round(),
        wide_sample: forecast.wide_sample,
        mass_outside_middle,
        mass_outside_edge,
    }
}

fn text(profile: &Profile, plan: &TablePlan, forecast: &Forecast) -> String {
    let (long, metre) = profile.output().units.length();
    let angles = |axis: CellAxis| {
        format!(
            "{:.1} to {:.1} deg, {} points",
            axis.low / DEGREE_RAD,
            axis.high / DEGREE_RAD,
            axis.count
        )
    };
    let mut text = [
        format!("pitch       {}\n", angles(plan.pitch)),
        format!("polar       {}\n", angles(plan.polar)),
        format!(
            "backspin    {:.2} to {:.2} rev/s, {} points\n",
            plan.backspin.low / REV_RAD,
            plan.backspin.high / REV_RAD,
            plan.backspin.count
        ),
        format!(
            "speed       {} points for each angle, direction and backspin; over the whole table {:.2} to {:.2} {long}/s\n",
            plan.speeds_per_line,
            plan.nominal.speed.low / metre,
            plan.nominal.speed.high / metre
        ),
        format!(
            "shots       {} in the first search, then {} around each best shot\n",
            plan.shots,
            profile.grid().points()
        ),
        format!(
            "memory      about {:.0} MiB\n",
            forecast.memory_bytes / f64::from(1 << 20)
        ),
        format!(
            "time        about {:.1} s on {} threads, the whole search\n",
            forecast.seconds, forecast.threads
        ),
        format!(
            "outside     the chance that a shot falls outside the table: {:.1e} from its middle, {:.1e} from its lower edge\n",
            forecast.mass_outside.0, forecast.mass_outside.1
        ),
    ]
    .concat();
    if let Some(sample) = forecast.wide_sample {
        text.push_str(&format!(
            "range       {} shots were tried over a wider range; {} lay outside the search range, and {} of those went in\n",
            sample.drawn, sample.outside, sample.made_outside
        ));
        if sample.made_too_fast > 0 {
            let (long, metre) = profile.output().units.length();
            text.push_str(&format!(
                "            {} were made faster than the search looks, {:.1} {long}/s ([search] speed_max)\n",
                sample.made_too_fast,
                plan.bracket.speed_max_m_s / metre
            ));
        }
    }
    text
}

/// Forecast of the time of `best`, from a batch of shots of the bracket.
fn forecast_s(profile: &Profile, plan: &TablePlan) -> f64 {
    let mut starts = Vec::new();
    for i in 0..FORECAST_SHOTS {
        // A Kronecker sequence.
        let part = |step: f64| (f64::from(i) * step).fract();
        let pitch_rad = plan.pitch.low + part(0.754_877_666) * (plan.pitch.high - plan.pitch.low);
        let polar_rad = plan.polar.low + part(0.569_840_291) * (plan.polar.high - plan.polar.low);
        let Some((least, most)) = plan.bracket.speeds_m_s(pitch_rad, polar_rad) else {
            continue;
        };
        let nominal = Nominal {
            speed_m_s: least + part(0.323_447_311) * (most - least),
            pitch_rad,
            polar_rad,
            backspin_rad_s: plan.backspin.value(i as usize % plan.backspin.count, 0.5),
            ..Nominal::default()
        };
        starts.push(profile.release(&nominal).state());
    }
    let mut workspace = BatchWorkspace::default();
    let began = Instant::now();
    let _ = std::hint::black_box(profile.simulator().verdicts(&starts, &mut workspace));
    let per_shot = began.elapsed().as_secs_f64() / f64::from(FORECAST_SHOTS);
    per_shot * (plan.shots + WINDOWS * profile.grid().points() + SEARCH_SHOTS) as f64
        / rayon::current_num_threads() as f64
}
