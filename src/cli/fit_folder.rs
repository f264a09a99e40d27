//! The folder of a fit, read again.

use super::failure::{Failure, refuse_missing};
use super::measured_shots_flags::MeasuredShotsOptions;
use super::terminal::print_remark;
use crate::best_shot::{ShotAtPitch, TableShot};
use crate::fitting::{
    AngleOverDraws, Draw, DrawProbabilities, Interval, Values, WeightedShots, best_angles_of_draws,
    values_of,
};
use crate::present::fit_files::fit_text::probability_text;
use crate::shooter::{Nominal, NominalVariable, Profile, ShotKind};
use crate::store::fit::{FIT_FILE, Fit, SHOTS, folder_of_profile};
use crate::store::shooters::fits_within;
use crate::units::{DEGREE_RAD, with_decimals};
use std::path::Path;

/// Reads the folder of a fit.
pub(crate) fn read(folder: &Path) -> Result<Fit, Failure> {
    refuse_missing(folder)?;
    if folder.join(FIT_FILE).exists() {
        return Ok(Fit::read(folder)?);
    }
    let place = folder.display();
    Err(Failure::usage(match &fits_within(folder)?[..] {
        [] => format!(
            "{place}: holds no fit (it has no {FIT_FILE}); name a folder that `bankshot fit` wrote"
        ),
        several => {
            let names = several.iter().map(|name| name.display().to_string());
            format!(
                "{place}: holds a fit of each shooter; name one: {}",
                names.collect::<Vec<_>>().join(", ")
            )
        }
    }))
}

/// The index of the place with a number, from 1, of so many; without a number the first.
pub(crate) fn index_of_place(number: Option<u32>, places: usize) -> Result<usize, Failure> {
    let number = number.unwrap_or(1) as usize;
    if number > places {
        return Err(Failure::usage(format!(
            "--place {number}: there {}",
            match places {
                1 => "is one place".to_owned(),
                more => format!("are {more} places"),
            }
        )));
    }
    Ok(number - 1)
}

/// Refuses options that only a file of measured shots has a use for.
pub(crate) fn refuse_options_of_files(
    folder: &Path,
    options: &MeasuredShotsOptions,
) -> Result<(), Failure> {
    match options.first_about_a_file() {
        None => Ok(()),
        Some("--shooter") if !fits_within(folder)?.is_empty() => Err(Failure::usage(format!(
            "--shooter: {} has a folder of each shooter; name that folder",
            folder.display()
        ))),
        Some(option) => Err(Failure::usage(format!(
            "{option}: {} is a fit already; fit the shots again with it",
            folder.display()
        ))),
    }
}

/// Why a shot has no P over the draws of a fit.
const NO_OTHER_SPIN: &str =
    "--draws: a fit knows backspin alone; this shot has side spin or rifle spin";

/// P of a nominal shot from the profile's location over draws of the scatter.
pub(crate) fn probability_over_draws(
    draws: &[Draw],
    profile: &Profile,
    nominal: &Nominal,
    shots: usize,
) -> Result<DrawProbabilities, Failure> {
    if nominal.rifle_spin_rad_s != 0.0 || nominal.side_spin_rad_s != 0.0 {
        return Err(Failure::usage(NO_OTHER_SPIN));
    }
    let values = values_of(nominal);
    // The scatter of the speed is that at this speed.
    let here: Vec<Draw> = draws.iter().map(|draw| draw.aimed_at(values)).collect();
    let seed = profile.search().seed;
    let sample = WeightedShots::simulate(profile, (&here, 0), &[values], shots, seed);
    Ok(sample.probabilities(&here, |_| values, |draw| draw.factor_at(0)))
}

/// The fit that a profile was written by: that of its folder. `None` if there is none.
pub(crate) fn of_profile(file: &Path) -> Result<Option<Fit>, Failure> {
    Ok(folder_of_profile(file).map(Fit::read).transpose()?)
}

/// By how much a bank shot from the profile's location is better than a direct one, for each draw
/// of a fit.
pub(crate) fn bank_gain_over_draws(
    fit: &Fit,
    profile: &Profile,
    [direct, bank]: [&Nominal; 2],
) -> Result<DrawProbabilities, Failure> {
    let p = |shot| probability_over_draws(&fit.posterior.draws, profile, shot, SHOTS);
    Ok(p(bank)?.minus(&p(direct)?))
}

/// Reads the folder of `--draws`, with a warning where its fit is that of another shooter.
pub(crate) fn read_draws_of<'a>(
    folder: Option<&'a Path>,
    profile: &Profile,
) -> Result<Option<(&'a Path, Fit)>, Failure> {
    let Some(folder) = folder else {
        return Ok(None);
    };
    let fit = read(folder)?;
    let shooter = &fit.profiles[0].shooter().name;
    if *shooter != profile.shooter().name {
        print_remark(&format!(
            "warning: the draws in {} are those of {shooter}, and the profile is that of {}",
            folder.display(),
            profile.shooter().name
        ));
    }
    Ok(Some((folder, fit)))
}

/// P of a nominal shot over the draws of a fit.
pub(crate) fn shot_over_draws(
    fit: &Fit,
    profile: &Profile,
    nominal: &Nominal,
) -> Result<DrawProbabilities, Failure> {
    probability_over_draws(&fit.posterior.draws, profile, nominal, SHOTS)
}

/// P over the draws of a fit of the usual shot at a place with one value given: of each draw the
/// other values are its own means.
pub(crate) fn usual_shot_over_draws(
    (fit, place): (&Fit, usize),
    profile: &Profile,
    (variable, value): (NominalVariable, f64),
) -> Result<DrawProbabilities, Failure> {
    let index = match variable {
        NominalVariable::Speed => 0,
        NominalVariable::Pitch => 1,
        NominalVariable::Polar => 2,
        NominalVariable::Backspin => 3,
        NominalVariable::SideSpin | NominalVariable::RifleSpin => {
            return Err(Failure::usage(NO_OTHER_SPIN));
        }
    };
    let with_value = |draw: &Draw| {
        let mut means = draw.means[place];
        means[index] = value;
        means
    };
    let draws = &fit.posterior.draws;
    let means: Vec<Values> = draws.iter().map(with_value).collect();
    // The scatter of the speed is that at this speed.
    let here = draws
        .iter()
        .zip(&means)
        .map(|(draw, means)| draw.aimed_at(*means));
    let here: Vec<Draw> = here.collect();
    let sample = WeightedShots::simulate(profile, (&here, 0), &means, SHOTS, profile.search().seed);
    Ok(sample.probabilities(&here, |draw| draw.means[0], |draw| draw.factor_at(0)))
}

/// P of a nominal shot over the draws of a fit, in words.
pub(crate) fn text_over_draws((folder, fit): (&Path, &Fit), p: &DrawProbabilities) -> String {
    format!("{}: {}\n", which_draws(folder, fit), probability_text(p))
}

/// P of the best shot of each kind over the draws of a fit, and of bank less direct, in words.
pub(crate) fn kinds_over_draws(
    (folder, fit): (&Path, &Fit),
    profile: &Profile,
    nominals: &[(ShotKind, &Nominal)],
) -> Result<String, Failure> {
    let mut text = format!("{}:\n", which_draws(folder, fit));
    let mut by_kind = Vec::new();
    for (kind, nominal) in nominals {
        let p = probability_over_draws(&fit.posterior.draws, profile, nominal, SHOTS)?;
        text += &format!("{}: {}\n", kind.name(), probability_text(&p));
        by_kind.push((*kind, p));
    }
    if let [(ShotKind::Direct, direct), (ShotKind::Bank, bank)] = &by_kind[..] {
        let difference = bank.minus(direct);
        let points = difference.interval().scaled(100.0);
        let sure = 100.0 * difference.share_positive();
        text += &format!(
            "bank less direct, draw by draw: {:+.1} points (95 %: {:+.1} to {:+.1}); bank is the better one in {sure:.0} of 100 draws\n",
            points.mean, points.low, points.high
        );
    }
    text += "P above uses the typical scatter. P is not linear in it, so the mean over the draws can differ by some tenths of a point.\n";
    Ok(text)
}

/// P of the best shot at each pitch angle over the draws of a fit.
pub(crate) struct OverDraws {
    pub(crate) angles: Vec<Option<AngleOverDraws>>,
    /// The first and the last of the angles between which the best one lies in 95 of 100 draws.
    best: Option<(usize, usize)>,
}

/// P of the best shot at each pitch angle over the draws of a fit.
pub(crate) fn angles_over_draws(
    fit: &Fit,
    profile: &Profile,
    rows: &[ShotAtPitch],
) -> Result<OverDraws, Failure> {
    let shots = rows.iter().map(|row| row.shot.as_ref());
    let p = |shot: Option<&TableShot>| {
        shot.map(|shot| probability_over_draws(&fit.posterior.draws, profile, &shot.nominal, SHOTS))
            .transpose()
    };
    let angles: Vec<_> = shots.map(p).collect::<Result<_, Failure>>()?;
    Ok(OverDraws {
        best: best_angles_of_draws(&angles),
        angles: AngleOverDraws::of_angles(&angles),
    })
}

/// The same in words.
pub(crate) fn angles_in_words(
    (folder, fit): (&Path, &Fit),
    rows: &[ShotAtPitch],
    over_draws: &OverDraws,
) -> String {
    let angles = rows.iter().zip(&over_draws.angles);
    let angles: Vec<(f64, AngleOverDraws)> = angles
        .filter_map(|(row, angle)| Some((row.pitch_rad / DEGREE_RAD, (*angle)?)))
        .collect();
    let mean = |(_, angle): &(f64, AngleOverDraws)| angle.probability.mean;
    let best = angles.iter().max_by(|a, b| mean(a).total_cmp(&mean(b)));
    let Some((best_deg, _)) = best else {
        return String::new();
    };
    let mut text = format!(
        "{}:\npitch (deg), P (95 %), points less than at {best_deg:.1} deg, draw by draw (95 %). That angle has the greatest mean.\n",
        which_draws(folder, fit)
    );
    for (pitch_deg, angle) in &angles {
        let [mean, low, high] = percents(&angle.probability);
        let [less, least, most] = percents(&angle.less);
        text += &format!(
            "{pitch_deg:>5.1}  {mean:>5.1} ({low:>4.1} to {high:>4.1})  {less:>5.1} ({least:>+5.1} to {most:>+5.1})\n"
        );
    }
    if let Some((low, high)) = over_draws.best {
        let [low, high] = [low, high].map(|i| rows[i].pitch_rad / DEGREE_RAD);
        text += &format!(
            "The best of these angles: {} in 95 of 100 draws.\n",
            match low < high {
                true => format!("from {low:.1} to {high:.1} deg"),
                false => format!("{low:.1} deg"),
            }
        );
    }
    text
}

/// Mean and ends in percent.
fn percents(interval: &Interval) -> [f64; 3] {
    [interval.mean, interval.low, interval.high].map(|p| with_decimals(100.0 * p, 1))
}

/// Which draws an interval is over, and what it leaves out.
fn which_draws(folder: &Path, fit: &Fit) -> String {
    format!(
        "over {} draws of the scatter in {}, the intended release being exact (the interval of P that `fit` prints has the uncertain means too; any other one is numerical)",
        fit.posterior.draws.len(),
        folder.display()
    )
}
