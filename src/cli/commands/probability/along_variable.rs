//! `bankshot probability --vary`: P of one nominal shot along one of its variables.

use super::options::ProbabilityOptions;
use crate::analysis::miss_breakdown::classify_misses;
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::output_files::{self, Rendered};
use crate::cli::plot_files;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{is_quiet, print_remark};
use crate::cli::value_lists::ascending_values;
use crate::fitting::{AngleOverDraws, best_angles_of_draws};
use crate::plots;
use crate::present::best_shot_text::PROFILE_IS_EXACT;
use crate::present::probability_along_variable::{PointAlong, ProbabilityAlong};
use crate::probability::{Progress, Sampler, Silent};
use crate::shooter::{Nominal, NominalVariable, Profile};
use crate::store::fit::Fit;
use serde_json::Value;

/// What `--vary` names: a variable, whether it is the angle from the line to the hoop's centre, and
/// its values, SI.
struct Varied {
    variable: NominalVariable,
    is_aim: bool,
    values: Vec<f64>,
}

impl Varied {
    /// From `pitch=45 deg to 60 deg by 1 deg`.
    fn parse(text: &str) -> Result<Self, Failure> {
        let names = || {
            let names = NominalVariable::ALL.map(NominalVariable::name);
            format!("{}, aim", names.join(", "))
        };
        let (name, list) = text.split_once('=').ok_or_else(|| {
            Failure::usage(format!(
                "--vary: \"{text}\" has no =; write 'pitch=45 deg to 60 deg by 1 deg', or another of {}",
                names()
            ))
        })?;
        let name = name.trim().replace('-', "_");
        let is_aim = name == "aim";
        let wanted = if is_aim { "polar" } else { name.as_str() };
        let variable = NominalVariable::ALL
            .into_iter()
            .find(|variable| variable.name() == wanted)
            .ok_or_else(|| {
                Failure::usage(format!(
                    "--vary: \"{name}\" is no variable of a shot; write one of {}",
                    names()
                ))
            })?;
        Ok(Self {
            variable,
            is_aim,
            values: ascending_values("vary", list.trim(), variable.dimension())?,
        })
    }
}

pub(super) fn run(
    options: &ProbabilityOptions,
    (profile, draws): (&Profile, Option<&Fit>),
    vary: &str,
) -> Result<u8, Failure> {
    let varied = Varied::parse(vary)?;
    let nominals = varied.shots(options, profile)?;
    if options.plot.is_some() && nominals.len() < 2 {
        return Err(Failure::usage("--plot: --vary needs two values or more"));
    }
    if !is_quiet() {
        print_warnings(options, profile, varied.variable, &nominals);
    }
    let target = options.target.unwrap_or(profile.search().standard_error);
    let along = probability_along(options, (profile, draws), &varied, nominals, target)?;
    if let Some(path) = &options.plot
        && let Some(plot) = plots::probability_along_variable::draw(&along)
    {
        plot_files::write_one(path, &plot)?;
    }
    output_files::deliver(&along, &options.output, options.json)?;
    output_files::print_written(options.output.iter().chain(&options.plot));
    let mut points = along.points.iter();
    Ok(
        match points.all(|point| point.estimate.standard_error <= target) {
            true => code::DONE,
            false => code::IMPRECISE,
        },
    )
}

impl Rendered for ProbabilityAlong<'_> {
    fn text(&self) -> String {
        let is_exact = self.points.iter().all(|point| point.over_draws.is_none());
        let of_profile = if is_exact { PROFILE_IS_EXACT } else { "" };
        self.in_text() + of_profile
    }

    fn json(&self) -> Value {
        self.as_json()
    }

    fn csv(&self) -> String {
        self.as_csv()
    }
}

impl Varied {
    /// The shot with each of the values. Every one is checked before one is computed.
    fn shots(
        &self,
        options: &ProbabilityOptions,
        profile: &Profile,
    ) -> Result<Vec<Nominal>, Failure> {
        let start = match self.is_aim {
            true => profile.location().angle_rad,
            false => 0.0,
        };
        let shot = |value: &f64| {
            let given = (self.variable, start + value);
            options.nominal.resolve_with(profile, Some(given))
        };
        self.values.iter().map(shot).collect()
    }
}

/// Warns of implausible shots, once of each kind: the values share them.
fn print_warnings(
    options: &ProbabilityOptions,
    profile: &Profile,
    variable: NominalVariable,
    nominals: &[Nominal],
) {
    let of_shots = nominals.iter();
    let mut warnings: Vec<String> = of_shots
        .flat_map(|nominal| NominalOptions::warnings(profile, nominal))
        .collect();
    if variable != NominalVariable::Backspin {
        let of_flags = |nominal| options.nominal.warnings_of_flags(profile, nominal);
        warnings.extend(nominals.iter().flat_map(of_flags));
    }
    warnings.sort();
    warnings.dedup();
    for warning in &warnings {
        print_remark(warning);
    }
}

/// P of each of the shots.
fn probability_along<'a>(
    options: &ProbabilityOptions,
    (profile, draws): (&'a Profile, Option<&Fit>),
    varied: &Varied,
    nominals: Vec<Nominal>,
    target: f64,
) -> Result<ProbabilityAlong<'a>, Failure> {
    let seed = options.seed.unwrap_or(profile.search().seed);
    let bars = ProgressBars::new();
    bars.begin("values", nominals.len() as u64);
    let mut points = Vec::new();
    let mut of_draws = Vec::new();
    // The usual shot of a fit is uncertain in its other values too.
    let usual_at = draws.filter(|_| !options.nominal.has_flags());
    let usual_at = usual_at.and_then(|fit| {
        let mut places = fit.profiles.iter();
        places.position(|of| {
            of.location() == profile.location()
                && of.nominal_overrides() == profile.nominal_overrides()
        })
    });
    for nominal in nominals {
        let estimate = Sampler::new(profile).estimate(&nominal, target, seed, &Silent);
        if let Some(fit) = draws {
            of_draws.push(Some(match usual_at {
                Some(place) => {
                    let given = (varied.variable, nominal.get(varied.variable));
                    fit_folder::usual_shot_over_draws((fit, place), profile, given)?
                }
                None => fit_folder::shot_over_draws(fit, profile, &nominal)?,
            }));
        }
        points.push(PointAlong {
            misses: classify_misses(profile, &nominal, &estimate, seed),
            nominal,
            estimate,
            over_draws: None,
        });
        bars.advance(1);
    }
    bars.end();
    let over = AngleOverDraws::of_angles(&of_draws);
    for (point, over) in points.iter_mut().zip(over) {
        point.over_draws = over;
    }
    Ok(ProbabilityAlong {
        profile,
        variable: varied.variable,
        best_of_draws: best_angles_of_draws(&of_draws),
        is_aim: varied.is_aim,
        points,
        is_rest_uncertain: usual_at.is_some(),
    })
}
