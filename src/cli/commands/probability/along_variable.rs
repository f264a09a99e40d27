//! `bankshot probability --vary`: P of one nominal shot along one of its variables.

use super::options::ProbabilityOptions;
use crate::analysis::miss_breakdown::classify_misses;
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::output_files::{self, OutputForm};
use crate::cli::plot_files;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_remark};
use crate::cli::value_lists::ascending_values;
use crate::fitting::{AngleOverDraws, best_angles_of_draws};
use crate::plots;
use crate::present::best_shot_text::PROFILE_IS_EXACT;
use crate::present::probability_along_variable::{PointAlong, ProbabilityAlong};
use crate::probability::{Progress, Sampler, Silent};
use crate::shooter::{NominalVariable, Profile};
use crate::store::fit::Fit;

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
    quiet: bool,
) -> Result<u8, Failure> {
    let Varied {
        variable,
        is_aim,
        values,
    } = Varied::parse(vary)?;
    let start = if is_aim {
        profile.location().angle_rad
    } else {
        0.0
    };
    let search = profile.search();
    let target = options.target.unwrap_or(search.standard_error);
    let seed = options.seed.unwrap_or(search.seed);
    let bars = ProgressBars::new(quiet);
    // Every shot is checked before one is computed.
    let nominals = values
        .iter()
        .map(|value| {
            let given = (variable, start + value);
            options.nominal.resolve_with(profile, Some(given))
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    if options.plot.is_some() && nominals.len() < 2 {
        return Err(Failure::usage("--plot: --vary needs two values or more"));
    }
    if !quiet {
        // One of each kind: the values share them.
        let mut warnings: Vec<String> = nominals
            .iter()
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
                    let given = (variable, nominal.get(variable));
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
    let best_of_draws = best_angles_of_draws(&of_draws);
    let over = AngleOverDraws::of_angles(&of_draws);
    for (point, over) in points.iter_mut().zip(over) {
        point.over_draws = over;
    }
    let is_exact = points
        .iter()
        .all(|point| point.estimate.standard_error <= target);
    let along = ProbabilityAlong {
        profile,
        variable,
        best_of_draws,
        is_aim,
        points,
        is_rest_uncertain: usual_at.is_some(),
    };
    let text = || {
        let of_profile = if draws.is_none() {
            PROFILE_IS_EXACT
        } else {
            ""
        };
        along.text() + of_profile
    };
    let json = || format!("{:#}\n", along.json());
    output_files::write(&options.output, |form| match form {
        OutputForm::Csv => along.csv(),
        OutputForm::Json => json(),
        OutputForm::Text => text(),
    })?;
    if let Some(path) = &options.plot
        && let Some(plot) = plots::probability_along_variable::draw(&along)
    {
        plot_files::write_one(path, &plot)?;
    }
    print_answer(&if options.json { json() } else { text() })?;
    output_files::print_written(options.output.iter().chain(&options.plot), quiet);
    Ok(if is_exact {
        code::DONE
    } else {
        code::IMPRECISE
    })
}
