//! `bankshot trace`: one shot, its events and its trajectory, in words.

use super::arguments::TraceOptions;
use super::failure::Failure;
use super::plan::load;
use super::terminal::{answer, answer_bytes, tell};
use bankshot::dynamics::{
    Ending, EventKind, Kind, Outcome, Release, Simulator, Touched, Trace, Triple,
};
use bankshot::output::{self, files, number};
use bankshot::picture::shot;
use bankshot::picture::svg::{self, shortened};
use bankshot::probability::estimate::Sampler;
use bankshot::profile::{Nominal, Profile};
use bankshot::units::{DEGREE_RAD, REV_RAD, System};
use std::fmt::Write;
use std::path::Path;

/// Spacing of the trajectory in flight, s.
const INTERVAL_S: f64 = 0.005;

pub(crate) fn run(options: &TraceOptions, quiet: bool) -> Result<u8, Failure> {
    let profile = load(&options.profile)?;
    let system = options.units.unwrap_or(profile.output.units);
    let nominal = options.nominal.resolve(&profile)?;
    let simulator =
        Simulator::with_integrator(&profile.physics, profile.integrator).map_err(Failure::usage)?;
    let trace = simulator.trace(&profile.release(&nominal), INTERVAL_S);
    if let Some(path) = &options.output {
        let bytes = trajectory(&trace, system);
        if path == Path::new("-") {
            return answer_bytes(&bytes);
        }
        files::write(path, &bytes).map_err(|error| Failure::io(path.display(), &error))?;
    }
    if let Some(path) = &options.plot {
        plot(
            path,
            options.swarm,
            &profile,
            &simulator,
            (&nominal, &trace),
            system,
        )?;
    }
    let text = if options.json {
        format!("{:#}\n", json(&trace, system))
    } else {
        words(&trace, system)
    };
    answer(&text)?;
    if let (Some(path), false) = (&options.plot, quiet) {
        tell(&format!("drawn in {}", path.display()));
    }
    if let (Some(path), false) = (&options.output, quiet) {
        tell(&format!("trajectory written to {}", path.display()));
    }
    Ok(0)
}

/// Draws the shot, over a swarm of others with the shooter's errors.
fn plot(
    path: &Path,
    swarm: u32,
    profile: &Profile,
    simulator: &Simulator,
    (nominal, trace): (&Nominal, &Trace),
    system: System,
) -> Result<(), Failure> {
    let sampler = Sampler::new(profile, simulator);
    let others: Vec<Trace> = (0..u64::from(swarm))
        .map(|index| {
            let release = sampler.sample(nominal, profile.search.seed, index);
            simulator.trace(&release, INTERVAL_S)
        })
        .collect();
    let colour = |trace: &Trace| {
        if trace.outcome.verdict.made {
            shot::MADE
        } else {
            shot::MISSED
        }
    };
    let mut paths: Vec<shot::Path<'_>> = others
        .iter()
        .map(|trace| shot::Path {
            trace,
            colour: colour(trace),
            in_full: false,
        })
        .collect();
    paths.push(shot::Path {
        trace,
        colour: if swarm > 0 { "#000000" } else { colour(trace) },
        in_full: true,
    });
    let (long, foot) = system.length();
    let title = format!(
        "{}: {:.2} {long}/s, {:.1} deg, backspin {:.1} rev/s: {}",
        shortened(&profile.shooter.name, 40),
        nominal.speed_m_s / foot,
        nominal.pitch_rad / DEGREE_RAD,
        nominal.backspin_rad_s / REV_RAD,
        verdict(&trace.outcome)
    );
    let made = others
        .iter()
        .filter(|trace| trace.outcome.verdict.made)
        .count();
    let note = if swarm > 0 {
        format!(
            "Black: the shot without errors; blue: {made} made, orange: {} missed, with the shooter's errors. Marks: touches of the board (green) and the ring (yellow).",
            others.len() - made
        )
    } else {
        "Marks: the ball where it is released (dashed), touches the board (green) and the ring (yellow), and where the shot is over (dashed).".to_owned()
    };
    let picture = shot::three_views("shot", &title, &note, &profile.physics, system, &paths);
    let bytes = match path.extension().and_then(|end| end.to_str()) {
        Some("svg") => picture.svg.into_bytes(),
        Some("png") => svg::to_png(&picture.svg, 1.5).map_err(Failure::bug)?,
        _ => {
            return Err(Failure::usage(format!(
                "--plot {}: the name must end in .svg or .png",
                path.display()
            )));
        }
    };
    files::write(path, &bytes).map_err(|error| Failure::io(path.display(), &error))
}

/// Traces one release and says what happens.
pub(crate) fn show(
    simulator: &Simulator,
    release: &Release,
    system: System,
    as_json: bool,
) -> Result<u8, Failure> {
    let trace = simulator.trace(release, INTERVAL_S);
    answer(&if as_json {
        format!("{:#}\n", json(&trace, system))
    } else {
        words(&trace, system)
    })
}

fn surface(touched: Touched) -> &'static str {
    match touched {
        Touched::Board => "board",
        Touched::Ring => "ring",
    }
}

fn verdict(outcome: &Outcome) -> &'static str {
    if outcome.verdict.ending == Ending::TimeLimit {
        return "missed: not over at the time limit";
    }
    match outcome.kind {
        Kind::Swish => "made: a swish",
        Kind::RimIn => "made off the ring",
        Kind::BankIn => "made off the board",
        Kind::BankRimIn => "made off board and ring",
        Kind::InAndOut => "missed: in and out",
        Kind::Short => "missed: short",
        Kind::Long => "missed: long",
        Kind::Wide => "missed: wide",
        Kind::OverBoard => "missed: behind the board",
        Kind::Lodged => "missed: lodged between ring and board",
        Kind::Airball => "missed: touched nothing",
        Kind::Unresolved => "the numerics gave up",
    }
}

fn words(trace: &Trace, system: System) -> String {
    let (long, metre) = system.length();
    let outcome = &trace.outcome;
    let mut text = String::new();
    // Writing to a String does not fail.
    let _ = writeln!(
        text,
        "The shot is {}, after {:.3} s; the ball's centre rose to {:.2} {long} above the ring.",
        verdict(outcome),
        outcome.verdict.time_s,
        outcome.apex_m / metre
    );
    if let Some(entry) = outcome.entry {
        let (x, y) = entry.offset_m;
        let (short, inch) = system.short_length();
        let _ = writeln!(
            text,
            "It last came down through the ring's plane at {:.1} deg, {:.1} {short} from the centre (x {:+.1}, y {:+.1}).",
            entry.angle_rad / DEGREE_RAD,
            (x * x + y * y).sqrt() / inch,
            x / inch,
            y / inch
        );
    }
    let _ = writeln!(
        text,
        "\n   time s  event                    x, y, z {long}               speed {long}/s"
    );
    for event in &trace.events {
        let Triple(x, y, z) = event.state.position_m;
        let Triple(vx, vy, vz) = event.state.velocity_m_s;
        let name = match event.kind {
            EventKind::Release => "release".to_owned(),
            EventKind::Touch(touched) => format!("touches the {}", surface(touched)),
            EventKind::Part {
                surface: touched,
                lasted_s,
                ..
            } => {
                format!(
                    "leaves the {} ({:.1} ms)",
                    surface(touched),
                    1000.0 * lasted_s
                )
            }
            EventKind::End => ending(outcome.verdict.ending).to_owned(),
        };
        let _ = writeln!(
            text,
            "{:9.4}  {name:24} {:7.3} {:7.3} {:7.3}   {:7.2}",
            event.time_s,
            x / metre,
            y / metre,
            z / metre,
            (vx * vx + vy * vy + vz * vz).sqrt() / metre
        );
    }
    text
}

fn ending(ending: Ending) -> &'static str {
    match ending {
        Ending::Fell => "below the ring",
        Ending::NeverRose => "never reached the ring",
        Ending::BehindBoard => "behind the board",
        Ending::Wedged => "at rest on both",
        Ending::TimeLimit => "time limit",
        Ending::Unresolved => "gave up",
    }
}

fn json(trace: &Trace, system: System) -> serde_json::Value {
    let (long, metre) = system.length();
    let outcome = &trace.outcome;
    let place = |Triple(x, y, z): Triple<f64>| {
        serde_json::Value::Array([x, y, z].map(|v| number(v / metre)).to_vec())
    };
    let events = trace.events.iter().map(|event| {
        let mut record = vec![
            ("time_s".to_owned(), number(event.time_s)),
            (format!("position_{long}"), place(event.state.position_m)),
            (
                format!("velocity_{long}_s"),
                place(event.state.velocity_m_s),
            ),
        ];
        let name = match event.kind {
            EventKind::Release => "release",
            EventKind::Touch(Touched::Board) => "touch board",
            EventKind::Touch(Touched::Ring) => "touch ring",
            EventKind::Part {
                surface: touched,
                impulse_n_s: Triple(x, y, z),
                lasted_s,
            } => {
                record.push(("lasted_s".to_owned(), number(lasted_s)));
                let impulse = [x, y, z].map(number).to_vec();
                record.push(("impulse_n_s".to_owned(), impulse.into()));
                if touched == Touched::Board {
                    "leave board"
                } else {
                    "leave ring"
                }
            }
            EventKind::End => "end",
        };
        record.insert(0, ("event".to_owned(), name.into()));
        output::object(record)
    });
    output::object(vec![
        ("made".to_owned(), outcome.verdict.made.into()),
        ("kind".to_owned(), outcome.kind.name().into()),
        (
            "contacts".to_owned(),
            outcome.verdict.contacts.to_string().into(),
        ),
        ("flight_time_s".to_owned(), number(outcome.verdict.time_s)),
        (
            format!("apex_above_ring_{long}"),
            number(outcome.apex_m / metre),
        ),
        (
            "entry_angle_deg".to_owned(),
            outcome.entry.map_or(serde_json::Value::Null, |e| {
                number(e.angle_rad / DEGREE_RAD)
            }),
        ),
        ("events".to_owned(), events.collect::<Vec<_>>().into()),
    ])
}

/// The trajectory as CSV.
fn trajectory(trace: &Trace, system: System) -> Vec<u8> {
    let (long, metre) = system.length();
    let mut text = format!(
        "time_s,x_{long},y_{long},z_above_ring_{long},vx_{long}_s,vy_{long}_s,vz_{long}_s,spin_x_rev_s,spin_y_rev_s,spin_z_rev_s,on_board,on_ring\n"
    );
    for sample in &trace.samples {
        let Triple(x, y, z) = sample.state.position_m;
        let Triple(vx, vy, vz) = sample.state.velocity_m_s;
        let Triple(wx, wy, wz) = sample.state.spin_rad_s;
        let _ = write!(text, "{}", sample.time_s);
        for value in [x, y, z, vx, vy, vz] {
            let _ = write!(text, ",{}", value / metre);
        }
        for value in [wx, wy, wz] {
            let _ = write!(text, ",{}", value / REV_RAD);
        }
        let _ = writeln!(
            text,
            ",{},{}",
            u8::from(sample.on_board),
            u8::from(sample.on_ring)
        );
    }
    text.into_bytes()
}
