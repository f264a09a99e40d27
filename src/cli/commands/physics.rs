//! `bankshot physics`: how much of the answer rests on the physics.

use crate::answers::json;
use crate::answers::physics::{FittedPlace, compare, without_usual_shot};
use crate::best_shot::PhysicsOf;
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::loaded_profile::load_profile;
use crate::cli::plot_files::{self, PlotType};
use crate::cli::profile_flags::ProfileOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{
    is_quiet, print_answer, print_hint, print_next, print_remark, print_text,
};
use crate::measured_shots::source::Source;
use crate::plots::physics_probabilities;
use crate::present::physics_text::{physics_name, physics_text};
use crate::shooter::Profile;
use crate::store::fit::{Fit, profile_file};
use crate::store::shooters::ring_told_by_makes;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
Searches the best shots under up to 25 physics: half a minute to four minutes on two cores. Values that nobody measured in this gym \
(ring, board, friction, drag, height) are changed to other likely ones. \"All together\" combines the largest change of each \
quantity, up and down, as the root of the sum of squares.

For the folder of a fit it also computes what the advice of `bankshot advise` adds under each physics.

Examples:
  bankshot physics player.toml
  bankshot physics robot.toml --distance '6 m'
  bankshot physics results/shots-fit --plot physics.svg")]
pub(crate) struct PhysicsOptions {
    #[command(flatten)]
    pub(crate) profile: ProfileOptions,
    /// The number of the place, for a fit with several places [default: 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) place: Option<u32>,
    /// Draw the makes under each physics (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Print one JSON array (SI units).
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &PhysicsOptions) -> Result<u8, Failure> {
    let source = &options.profile.path;
    let fit = read_fit(options)?;
    let (path, profile) = profile_of(options, fit.as_ref())?;
    if let Some(path) = &options.plot {
        PlotType::of(path)?;
    }
    let releases = match &fit {
        // Where a landing was measured, the release of each shot depends on the physics.
        Some((fit, _)) if fit.source == Source::Releases => fit.known_releases(source)?,
        _ => Vec::new(),
    };
    let fitted = fit.as_ref().map(|(fit, place)| FittedPlace {
        fit,
        place: *place,
        releases: &releases,
    });
    let own_is = match options.profile.physics.physics {
        Some(_) => PhysicsOf::Given,
        None => PhysicsOf::Profile,
    };
    let told_ring = ring_told_by_makes(std::slice::from_ref(&path))?;
    let bars = ProgressBars::new();
    let answer = compare(&profile, own_is, fitted.as_ref(), told_ring, &bars)?;
    let units = profile.output().units;
    if let Some(path) = &options.plot {
        let name = &profile.shooter().name;
        let plot = physics_probabilities::draw(name, &answer.comparison, units);
        plot_files::write_one(path, &plot)?;
        print_hint(&format!("plot written to {}", path.display()));
    }
    if options.json {
        let answer = answer.for_programs(&profile, |of| physics_name(of, units));
        print_answer(&json::text(&json::document(&answer, units)))
    } else {
        let is_moved = options.profile.place.is_given();
        print_text(&physics_text(&answer, &profile, is_moved))?;
        print_next(None, "");
        Ok(code::DONE)
    }
}

/// The fit of a folder, with the index of its place; `None` for a profile.
fn read_fit(options: &PhysicsOptions) -> Result<Option<(Fit, usize)>, Failure> {
    let path = &options.profile.path;
    if !path.is_dir() {
        return match options.place {
            None => Ok(None),
            Some(_) => Err(Failure::usage(
                "--place: only the folder of a fit has places",
            )),
        };
    }
    let fit = fit_folder::read(path)?;
    let place = fit_folder::index_of_place(options.place, fit.profiles.len())?;
    Ok(Some((fit, place)))
}

/// The file of the profile, and the profile where and as it is asked for.
fn profile_of(
    options: &PhysicsOptions,
    fit: Option<&(Fit, usize)>,
) -> Result<(PathBuf, Profile), Failure> {
    let (source, moved) = (&options.profile.path, &options.profile.place);
    // A fit names its folder; its profiles are in it.
    let path = match fit {
        Some((_, place)) => source.join(profile_file(*place)),
        None => source.clone(),
    };
    if let Some((fit, place)) = fit {
        if fit.profiles.len() > 1 && !is_quiet() {
            print_remark(&format!(
                "the fit has {} places: this is place {}, {}",
                fit.profiles.len(),
                place + 1,
                fit.profiles[*place].location().in_words(fit.units)
            ));
        }
        if moved.is_given() {
            return Err(Failure::usage(format!(
                "--distance, --angle: the shots of {} were measured from their own place; give {} to move its profile",
                source.display(),
                path.display()
            )));
        }
    }
    let mut profile = load_profile(&path, &options.profile.physics)?;
    if moved.is_given() {
        profile = without_usual_shot(&moved.moved(profile)?)?;
    }
    let units = options.profile.units.map(Into::into);
    if let Some(units) = units.or(fit.map(|(fit, _)| fit.units)) {
        profile = profile.with(|settings| settings.output.units = units)?;
    }
    Ok((path, profile))
}
