//! `bankshot check` and `bankshot plan`: what a profile says, and what it would cost.

use super::arguments::{CheckOptions, PlanOptions};
use super::failure::Failure;
use super::terminal::{answer, tell};
use bankshot::dynamics::{Room, Simulator};
use bankshot::output;
use bankshot::plan::Plan;
use bankshot::probability::BATCH_BYTES;
use bankshot::profile::{self, LARGEST_PROFILE_BYTES, Nominal, Profile};
use bankshot::sweep::configuration::is_sweep;
use bankshot::units::{DEGREE_RAD, REV_RAD};
use std::io::Read;
use std::path::Path;
use std::time::Instant;

/// Reads a text file of at most 16 MiB.
pub(crate) fn read_text(path: &Path) -> Result<String, Failure> {
    let shown = path.display();
    let about =
        std::fs::metadata(path).map_err(|error| Failure::usage(format!("{shown}: {error}")))?;
    if !about.is_file() {
        return Err(Failure::usage(format!(
            "{shown}: is not a file; give a TOML file"
        )));
    }
    if about.len() > LARGEST_PROFILE_BYTES {
        return Err(Failure::usage(format!(
            "{shown}: has {} bytes; at most {LARGEST_PROFILE_BYTES} are read",
            about.len()
        )));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(LARGEST_PROFILE_BYTES).read_to_end(&mut bytes))
        .map_err(|error| Failure::usage(format!("{shown}: {error}")))?;
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        Failure::usage(format!(
            "{shown}: is not UTF-8 text (byte {place}); save it as UTF-8"
        ))
    })
}

/// Reads and checks a profile.
pub(crate) fn load(path: &Path) -> Result<Profile, Failure> {
    let text = read_text(path)?;
    Ok(profile::parse(&text, &path.display().to_string())?)
}

/// Shots that the climbs and the final integrals take, about.
const SEARCH_SHOTS: u64 = 1_000_000;
/// Windows that a search takes, about: one for each kind.
const WINDOWS: u64 = 2;

pub(crate) fn check(options: &CheckOptions) -> Result<u8, Failure> {
    if is_sweep(&read_text(&options.profile)?) {
        let (configuration, _) = super::sweep::load(&options.profile)?;
        let places = configuration.spots.len();
        let (path, name) = (options.profile.display(), &configuration.name);
        return answer(&format!("{path}: fine ({name}, {places} places)\n"));
    }
    let profile = load(&options.profile)?;
    Plan::new(&profile)?;
    let (long, metre) = profile.output.units.length();
    answer(&format!(
        "{}: fine ({}, {:.2} {long} from the hoop at {:.1} deg)\n",
        options.profile.display(),
        profile.shooter.name,
        profile.place.distance_m / metre,
        profile.place.angle_rad / DEGREE_RAD
    ))
}

pub(crate) fn run(options: &PlanOptions, quiet: bool) -> Result<u8, Failure> {
    let text = read_text(&options.profile)?;
    if is_sweep(&text) {
        return super::sweep::plan(&options.profile, options.json, quiet);
    }
    let profile = load(&options.profile)?;
    let plan = Plan::new(&profile)?;
    let simulator =
        Simulator::with_integrator(&profile.physics, profile.integrator).map_err(Failure::usage)?;
    let seconds = forecast_s(&profile, &plan, &simulator);
    let wide = (options.wide_sample > 0)
        .then(|| plan.wide_sample(&profile, &simulator, options.wide_sample));
    let middle = Nominal {
        speed_m_s: plan.nominal.speed.low,
        pitch_rad: 0.5 * (plan.pitch.low + plan.pitch.high),
        polar_rad: profile.place.angle_rad,
        backspin_rad_s: 0.5 * profile.shooter.max_backspin_rad_s,
        ..Nominal::default()
    };
    let edge = Nominal {
        pitch_rad: profile.search.pitch_min_rad,
        backspin_rad_s: 0.0,
        ..middle
    };
    let mass = (
        plan.mass_outside(&profile, &middle),
        plan.mass_outside(&profile, &edge),
    );
    // The table, a batch of shots on each thread, and the program.
    let threads = rayon::current_num_threads();
    let memory = plan.memory_bytes as f64 + (threads * BATCH_BYTES) as f64 + 10e6;
    if options.json {
        let mut record = output::provenance(&profile.hash());
        record.push((
            "plan".to_owned(),
            serde_json::to_value(&plan).unwrap_or_default(),
        ));
        record.push(("forecast_s".to_owned(), output::number(seconds)));
        record.push(("memory_bytes".to_owned(), output::number(memory.round())));
        record.push((
            "wide_sample".to_owned(),
            serde_json::to_value(wide).unwrap_or_default(),
        ));
        record.push(("mass_outside_middle".to_owned(), output::number(mass.0)));
        record.push(("mass_outside_edge".to_owned(), output::number(mass.1)));
        return answer(&format!("{:#}\n", output::object(record)));
    }
    let (long, foot) = profile.output.units.length();
    let deg = |axis: bankshot::plan::Axis| {
        format!(
            "{:.1} to {:.1} deg, {} points",
            axis.low / DEGREE_RAD,
            axis.high / DEGREE_RAD,
            axis.count
        )
    };
    let mut text = format!(
        "pitch       {}\npolar       {}\nbackspin    {:.2} to {:.2} rev/s, {} points\nspeed       {} points on each line, bracketed line by line; nominal {:.2} to {:.2} {long}/s\nshots       {} in the search, {} in each window about a best\nmemory      about {:.0} MiB\ntime        about {:.1} s on {} threads, the search for the best included\nmass beyond {:.1e} in the middle of the pitch angles and backspins, {:.1e} at their lower edge\n",
        deg(plan.pitch),
        deg(plan.polar),
        plan.backspin.low / REV_RAD,
        plan.backspin.high / REV_RAD,
        plan.backspin.count,
        plan.speeds_per_line,
        plan.nominal.speed.low / foot,
        plan.nominal.speed.high / foot,
        plan.shots,
        profile.grid.points(),
        memory / f64::from(1 << 20),
        seconds,
        threads,
        mass.0,
        mass.1,
    );
    if let Some(wide) = wide {
        text.push_str(&format!(
            "bracket     of {} shots drawn wide, {} lie outside the bracket; {} of those were made\n",
            wide.drawn, wide.outside, wide.made_outside
        ));
        if wide.made_outside > 0 && !quiet {
            tell("remark: shots outside the bracket were made; raise speed_max, or report it");
        }
    }
    answer(&text)
}

/// Forecast of the time that `best` takes, from a batch of shots of the bracket.
fn forecast_s(profile: &Profile, plan: &Plan, simulator: &Simulator) -> f64 {
    const SHOTS: u32 = 65_536;
    let began = Instant::now();
    let mut starts = Vec::new();
    for i in 0..SHOTS {
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
    std::hint::black_box(simulator.verdicts(&starts, &mut Room::default()));
    let per_shot = began.elapsed().as_secs_f64() / f64::from(SHOTS);
    per_shot * (plan.shots + WINDOWS * profile.grid.points() + SEARCH_SHOTS) as f64
        / rayon::current_num_threads() as f64
}
