//! `bankshot physics`: how much of the answer rests on the physics.

use crate::best_shot::{
    BestShot, NoShot, PhysicsComparison, PhysicsRow, compare_physics, physics_variants,
};
use crate::cli::config_files::load_profile;
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::plot_files::{self, PlotType};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::cli::value_parsers::{PhysicsArg, UnitsArg};
use crate::plots::physics_probabilities;
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, UnitSystem};
use clap::Args;
use comfy_table::{CellAlignment, LineStyle, Table, presets};
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
Searches the best shots under 23 physics: one to four minutes on two cores. What nobody measured in this gym (how soft the \
ring and the board are, the friction, the drag, the height) is changed to other likely values; \"together\" is, for \
the changes that lower P and for those that raise it, the root of the sum of squares, of each quantity the change that does most.

Examples:
  bankshot physics player.toml
  bankshot physics results/shots-fit --plot physics.svg")]
pub(crate) struct PhysicsOptions {
    /// The shooter's profile, or the folder of a fit.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// Draw P under each physics (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Print one JSON array (SI units).
    #[arg(long)]
    pub(crate) json: bool,
    /// Units of the output [default: the profile's].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
}

pub(crate) fn run(options: &PhysicsOptions, quiet: bool) -> Result<u8, Failure> {
    // A fit names its folder; its profile is in it.
    let of_fit = options.profile.join("profile.toml");
    let path = if options.profile.join("fit.json").is_file() {
        &of_fit
    } else {
        &options.profile
    };
    let mut profile = load_profile(path, &options.physics, quiet)?;
    let units_of_fit = if path == &of_fit {
        Some(fit_folder::read(&options.profile)?.units)
    } else {
        None
    };
    if let Some(units) = options.units.map(Into::into).or(units_of_fit) {
        profile = profile.with(|settings| settings.output.units = units)?;
    }
    if let Some(path) = &options.plot {
        PlotType::of(path)?;
    }
    let variants = physics_variants(profile.physics(), profile.output().units);
    let comparison = compare_physics(&profile, &variants, &ProgressBars::new(quiet))?;
    if let Some(path) = &options.plot {
        let plot = physics_probabilities::draw(&profile.shooter().name, &comparison);
        plot_files::write_one(path, &plot)?;
        if !quiet {
            print_remark(&format!("plot written to {}", path.display()));
        }
    }
    if options.json {
        print_answer(&format!("{:#}\n", rows_json(&comparison.rows)))
    } else {
        print_prose(&comparison_text(&profile, &comparison))
    }
}

fn comparison_text(profile: &Profile, comparison: &PhysicsComparison) -> String {
    let has_air = profile.physics().air.density_kg_m3 > 0.0;
    let units = profile.output().units;
    let (long, metre) = units.length();
    let (short, short_m) = match units {
        UnitSystem::Imperial => ("in", 0.0254),
        UnitSystem::Metric => ("cm", 0.01),
    };
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()));
    table.set_header(vec![
        "physics".to_owned(),
        "direct\nP".to_owned(),
        format!("speed\n{long}/s"),
        "pitch\ndeg".to_owned(),
        format!("past\n{short}"),
        "bank\nP".to_owned(),
        "same\nshot P".to_owned(),
    ]);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let p = |shot: &Result<BestShot, NoShot>| match shot {
        Ok(shot) => format!("{:.3}", shot.estimate.probability),
        Err(_) => "none".to_owned(),
    };
    for row in &comparison.rows {
        let nominal = row.direct.as_ref().ok().map(|shot| shot.nominal);
        let number = |value: Option<f64>, digits: usize| {
            value.map_or("-".to_owned(), |value| format!("{value:.digits$}"))
        };
        table.add_row(vec![
            row.name.clone(),
            p(&row.direct),
            number(nominal.map(|shot| shot.speed_m_s / metre), 2),
            number(nominal.map(|shot| shot.pitch_rad / DEGREE_RAD), 1),
            number(row.aim_past_centre_m.map(|aim_m| aim_m / short_m), 1),
            p(&row.bank),
            number(row.same_shot.as_ref().map(|p| p.probability), 3),
        ]);
    }
    let summary = comparison.in_words().map_or_else(String::new, |words| {
        format!("{words} `bankshot fit SHOTS --free hoop_restitution` finds that one from made and missed.\n")
    });
    let error = comparison.greatest_standard_error();
    format!(
        "{table}\n{summary}Each P has a numerical standard error of at most {error:.4}. The first row is the profile's own physics; \"{}\" changes one thing of {}. past: of the ring's centre. The last column is the P of {}, released the same way everywhere. (A profile that was fitted to landings or trajectories changes with the physics: its speeds were derived with it. Fit the shots again with --physics FILE for what remains; of drag and air that is little.)\n",
        if has_air { "with" } else { "ncaa," },
        if has_air { "it" } else { "ncaa" },
        comparison.same_shot.in_words()
    )
}

fn rows_json(rows: &[PhysicsRow]) -> Value {
    let shot = |shot: &Result<BestShot, NoShot>| match shot {
        Ok(shot) => json!({
            "probability": shot.estimate.probability,
            "standard_error": shot.estimate.standard_error,
            "speed_m_s": shot.nominal.speed_m_s,
            "pitch_rad": shot.nominal.pitch_rad,
            "polar_rad": shot.nominal.polar_rad,
            "backspin_rad_s": shot.nominal.backspin_rad_s,
        }),
        Err(reason) => json!({ "none": reason.to_string() }),
    };
    rows.iter()
        .map(|row| {
            json!({
                "physics": row.name,
                "direct": shot(&row.direct),
                "bank": shot(&row.bank),
                "aim_past_centre_m": row.aim_past_centre_m,
                "same_shot_probability": row.same_shot.as_ref().map(|p| p.probability),
            })
        })
        .collect()
}
