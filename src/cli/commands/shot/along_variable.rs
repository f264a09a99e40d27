//! `bankshot shot --vary`: P of one nominal shot along one of its variables.

use super::current_place;
use super::options::ShotOptions;
use crate::analysis::miss_breakdown::classify_misses;
use crate::answers::along_variable::{AlongAnswer, PointAlong, Varied};
use crate::answers::csv::csv;
use crate::answers::json::document;
use crate::answers::nominal_shot::{ShotNote, notes_of_shot};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::nominal_shot_flags::print_notes;
use crate::cli::output_files::{self, Rendered};
use crate::cli::plot_files;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::value_lists::ascending_values;
use crate::fitting::{AngleOverDraws, best_angles_of_draws};
use crate::plots;
use crate::present::layout::TextAnswer;
use crate::present::probability_along_variable::ProbabilityAlong;
use crate::probability::{Progress, Sampler, Silent};
use crate::shooter::{Nominal, NominalVariable, Profile};
use crate::store::fit::Fit;
use serde_json::Value;

/// What `--vary` names: a variable and its values, SI.
struct VariedValues {
    of: Varied,
    values: Vec<f64>,
}

impl VariedValues {
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
            of: Varied { variable, is_aim },
            values: ascending_values("vary", list.trim(), variable.dimension())?,
        })
    }
}

pub(super) fn run(
    options: &ShotOptions,
    (profile, draws): (&Profile, Option<&Fit>),
    vary: &str,
) -> Result<u8, Failure> {
    let varied = VariedValues::parse(vary)?;
    let nominals = varied.shots(options, profile)?;
    if options.plot.is_some() && nominals.len() < 2 {
        return Err(Failure::usage("--plot: --vary needs two values or more"));
    }
    print_notes(notes(options, profile, varied.of.variable, &nominals));
    let target = options
        .standard_error
        .unwrap_or(profile.search().standard_error);
    let along = probability_along(options, (profile, draws), &varied, nominals, target)?;
    if let Some(path) = &options.plot
        && let Some(plot) = plots::probability_along_variable::draw(&along)
    {
        plot_files::write_one(path, &plot)?;
    }
    let along = Along(along, &options.scatter.scatter);
    output_files::deliver(&along, &options.output, options.json)?;
    output_files::print_written(options.output.iter().chain(&options.plot));
    let mut points = along.0.points.iter();
    Ok(
        match points.all(|point| point.estimate.standard_error <= target) {
            true => code::DONE,
            false => code::IMPRECISE,
        },
    )
}

fn answer(along: &ProbabilityAlong<'_>) -> AlongAnswer {
    let best = along.best_of_draws;
    AlongAnswer::new(along.profile, along.varied, &along.points, best)
}

/// The answer in its forms, with the changes of the scatter.
struct Along<'a>(ProbabilityAlong<'a>, &'a [String]);

impl Rendered for Along<'_> {
    fn text(&self) -> TextAnswer {
        self.0.in_text(self.1)
    }

    fn json(&self) -> Value {
        document(&answer(&self.0), self.0.profile.output().units)
    }

    fn csv(&self) -> String {
        csv(&answer(&self.0).points, self.0.profile.output().units)
    }
}

impl VariedValues {
    /// The shot with each of the values. Every one is checked before one is computed.
    fn shots(&self, options: &ShotOptions, profile: &Profile) -> Result<Vec<Nominal>, Failure> {
        let start = match self.of.is_aim {
            true => profile.location().angle_rad,
            false => 0.0,
        };
        let shot = |value: &f64| {
            let given = (self.of.variable, start + value);
            options.nominal.resolve_with(profile, given)
        };
        self.values.iter().map(shot).collect()
    }
}

/// What is doubtful about the shots.
fn notes(
    options: &ShotOptions,
    profile: &Profile,
    variable: NominalVariable,
    nominals: &[Nominal],
) -> Vec<ShotNote> {
    let of_shots = |nominal| notes_of_shot(profile, nominal);
    let mut notes: Vec<ShotNote> = nominals.iter().flat_map(of_shots).collect();
    if variable != NominalVariable::Backspin {
        let request = options.nominal.request();
        let of_flags = |nominal| request.notes(profile, nominal);
        notes.extend(nominals.iter().flat_map(of_flags));
    }
    notes
}

/// P of each of the shots.
fn probability_along<'a>(
    options: &ShotOptions,
    (profile, draws): (&'a Profile, Option<&Fit>),
    varied: &VariedValues,
    nominals: Vec<Nominal>,
    target: f64,
) -> Result<ProbabilityAlong<'a>, Failure> {
    let seed = options.seed.unwrap_or(profile.search().seed);
    let bars = ProgressBars::new();
    bars.begin("values", nominals.len() as u64);
    let mut points = Vec::new();
    let mut of_draws = Vec::new();
    // The usual shot of a fit is uncertain in its other values too.
    let usual_at = draws.and_then(|fit| current_place(options, fit, profile));
    for nominal in nominals {
        let estimate = Sampler::new(profile).estimate(&nominal, target, seed, &Silent);
        if let Some(fit) = draws {
            of_draws.push(Some(match usual_at {
                Some(place) => {
                    let given = (varied.of.variable, nominal.get(varied.of.variable));
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
        varied: varied.of,
        best_of_draws: best_angles_of_draws(&of_draws),
        points,
        is_rest_uncertain: usual_at.is_some(),
    })
}
