//! The folder of a fit, read again.

use super::failure::{Failure, refuse_missing};
use super::loaded_profile::LoadedProfile;
use super::measured_shots_flags::MeasuredShotsOptions;
use super::terminal::print_remark;
use crate::best_shot::{BestShots, ShotAtPitch, TableShot};
use crate::fitting::{
    AngleOverDraws, Draw, DrawProbabilities, Values, WeightedShots, best_angles_of_draws,
};
use crate::present::best_shot_text::KindsOverDraws;
use crate::shooter::{Nominal, NominalVariable, Profile, ShotKind};
use crate::store::fit::{
    FIT_FILE, Fit, SHOTS, folder_of_profile, shot_over_draws as shot_over_draws_of,
};
use crate::store::shooters::fits_within;
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
            "{place}: is not the folder of a fit (it has no {FIT_FILE}); name a folder that `bankshot fit` wrote"
        ),
        several => {
            let names = several.iter().map(|name| name.display().to_string());
            format!(
                "{place}: has a fit for each shooter; name one: {}",
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
    "--draws: a fit has backspin only, and this shot has side spin or rifle spin";

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
    Ok(shot_over_draws_of(draws, profile, nominal, shots))
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

/// The fit whose draws say how far the scatter is known: that of `--draws`, else the one that the
/// profile was written by, unless its scatter was changed.
pub(crate) fn draws_for(
    given: Option<&Path>,
    loaded: &LoadedProfile,
    is_scatter_changed: bool,
) -> Result<Option<Fit>, Failure> {
    let Some(folder) = given else {
        return match is_scatter_changed {
            true => Ok(None),
            false => of_profile(loaded.path()),
        };
    };
    let (fit, profile) = (read(folder)?, &loaded.profile);
    let shooter = &fit.profiles[0].shooter().name;
    if *shooter != profile.shooter().name {
        print_remark(&format!(
            "warning: the draws in {} are for {shooter}, the profile is for {}",
            folder.display(),
            profile.shooter().name
        ));
    }
    Ok(Some(fit))
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

/// P of the best shot of each kind over the draws of a fit.
pub(crate) fn kinds_over_draws(
    fit: &Fit,
    profile: &Profile,
    best: &BestShots,
) -> Result<KindsOverDraws, Failure> {
    let mut by_kind = Vec::new();
    for (kind, shot) in best.by_kind() {
        if let Ok(shot) = shot {
            let p = probability_over_draws(&fit.posterior.draws, profile, &shot.nominal, SHOTS)?;
            by_kind.push((kind, p));
        }
    }
    let bank_is_better = match &by_kind[..] {
        [(ShotKind::Direct, direct), (ShotKind::Bank, bank)] => {
            Some(bank.minus(direct).share_positive())
        }
        _ => None,
    };
    let intervals = by_kind.iter().map(|(kind, p)| (*kind, p.interval()));
    Ok(KindsOverDraws {
        probabilities: intervals.collect(),
        bank_is_better,
    })
}

/// P of the best shot at each pitch angle over the draws of a fit.
pub(crate) struct OverDraws {
    pub(crate) angles: Vec<Option<AngleOverDraws>>,
    /// The first and the last of the angles between which the best one lies in 95 of 100 draws.
    pub(crate) best: Option<(usize, usize)>,
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
