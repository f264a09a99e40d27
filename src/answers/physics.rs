//! How much of an answer rests on the physics: the best shots, and the advice of a fit, under other
//! physics.

use super::json::{Answer, Provenance};
use crate::best_shot::{
    BestShot, BestShotError, ChangeOfP, NoShot, PhysicsChange, PhysicsComparison, PhysicsOf,
    PhysicsRow, SameShot, SameShotProbability, compare_physics, physics_variants, together,
};
use crate::fitting::{
    Advice, FittedShots, Interval, KnownRelease, Measured, ShotsUnderPhysics, Wilson, advise,
    made_z_of_releases, wilson_interval,
};
use crate::measured_shots::source::Source;
use crate::model::{Physics, SolidId};
use crate::probability::Progress;
use crate::shooter::{NominalOverrides, NominalVariable, Profile, ProfileError};
use crate::store::fit::Fit;
use serde::Serialize;

/// Makes farther from what is expected, in standard deviations, speak against a physics: about 1 of
/// 400 tests by luck.
pub const FAR_MAKES: f64 = 3.0;

/// The best shots under each physics, and what a fit says of them.
#[derive(Clone, Debug)]
pub struct PhysicsAnswer {
    /// The best shots.
    pub comparison: PhysicsComparison,
    /// The fit, if the question is about one.
    pub fitted: Option<FittedRows>,
    /// The restitutions of the ring that the makes tell, where they decide it.
    pub told_ring: Option<(f64, f64)>,
}

/// A fit under each physics of a comparison.
#[derive(Clone, Debug)]
pub struct FittedRows {
    /// What the shooter is advised.
    pub advice: Advice,
    /// What was measured.
    pub measured: Measured,
    /// One for each row of the comparison.
    pub rows: Vec<Option<ShotsUnderPhysics>>,
    /// By how many standard deviations the makes of each ball differ from what is expected in each
    /// row, where releases were measured.
    pub made_z: Vec<Option<f64>>,
    /// Made and all measured shots with a result.
    pub observed: (usize, usize),
}

/// A fit at a place, and the releases whose results are known.
#[derive(Clone, Copy, Debug)]
pub struct FittedPlace<'a> {
    /// The fit.
    pub fit: &'a Fit,
    /// The index of the place.
    pub place: usize,
    /// The releases; none where landings were measured.
    pub releases: &'a [KnownRelease],
}

/// Compares the physics of a profile with others.
///
/// # Errors
/// No shot from there can go in, or the search would be too large.
pub fn compare(
    profile: &Profile,
    own_is: PhysicsOf,
    fitted: Option<&FittedPlace<'_>>,
    told_ring: Option<(f64, f64)>,
    progress: &dyn Progress,
) -> Result<PhysicsAnswer, BestShotError> {
    let variants = physics_variants(profile.physics(), own_is);
    let mut comparison = compare_physics(profile, &variants, progress)?;
    let fitted = fitted
        .map(|place| FittedRows::new(place, &comparison, progress))
        .transpose()?;
    if let Some(fitted) = &fitted
        && fitted.measured == Measured::Landing
    {
        let of_rows = fitted.rows.iter().map(|row| {
            row.as_ref().map(|row| SameShotProbability {
                probability: row.usual.mean,
                standard_error: row.standard_error,
            })
        });
        comparison = comparison.with_same_shot(SameShot::AsMeasured, of_rows);
    }
    let shares = possible_shares(&comparison, told_ring, fitted.as_ref());
    Ok(PhysicsAnswer {
        comparison: comparison.with_possible_shares(&shares),
        fitted,
        told_ring,
    })
}

/// The profile without the current shot of its `[nominal]` table, which is that of its own place.
/// What its search keeps fixed stays.
///
/// # Errors
/// What stays makes no profile.
pub fn without_usual_shot(profile: &Profile) -> Result<Profile, ProfileError> {
    let own = profile.nominal_overrides();
    let mut kept = NominalOverrides::default();
    for variable in NominalVariable::ALL {
        let is_searched = profile.search().choice.includes(variable);
        if let Some(value) = own.get(variable).filter(|_| !is_searched) {
            kept.set(variable, value);
        }
    }
    profile.with(|settings| settings.nominal = kept)
}

/// How far towards each row the gym may be, 0 to 1: as far as the makes of the fitted shots, and
/// the ring that `--free` found, leave it.
fn possible_shares(
    comparison: &PhysicsComparison,
    told_ring: Option<(f64, f64)>,
    fitted: Option<&FittedRows>,
) -> Vec<f64> {
    let base = &comparison.rows[comparison.base];
    let own_ring = base.physics.restitution_on(SolidId::Ring);
    let of_row = |(i, row): (usize, &PhysicsRow)| {
        let Some(change) = row.of.unmeasured() else {
            return 1.0;
        };
        let by_makes = fitted.map_or(1.0, |fitted| fitted.possible_share(comparison.base, i));
        let by_ring = match (change, told_ring) {
            (PhysicsChange::RingRestitution(ring), Some((low, high))) => {
                let end = ring.clamp(low, high);
                ((end - own_ring) / (ring - own_ring)).clamp(0.0, 1.0)
            }
            _ => 1.0,
        };
        by_makes.min(by_ring)
    };
    comparison.rows.iter().enumerate().map(of_row).collect()
}

impl FittedRows {
    fn new(
        fitted: &FittedPlace<'_>,
        comparison: &PhysicsComparison,
        progress: &dyn Progress,
    ) -> Result<Self, BestShotError> {
        let &FittedPlace {
            fit,
            place,
            releases,
        } = fitted;
        let profile = &fit.profiles[place];
        let advice = advise(profile, &fit.posterior, place, progress)?;
        let measured = match fit.source {
            Source::Releases => Measured::Release,
            Source::Landings | Source::Trajectories | Source::Makes => Measured::Landing,
        };
        let shots = FittedShots::new((profile, &fit.posterior, place), &advice, measured);
        let made_z = |physics: &Physics| {
            let places = fit.profiles.iter();
            let places = places.map(|profile| {
                let other = profile.with(|settings| settings.physics = physics.clone());
                other.ok()
            });
            let profiles: Vec<Profile> = places.collect::<Option<_>>()?;
            made_z_of_releases(&profiles, releases, &[0.0; 4])
        };
        let count = comparison.rows.len() as u64;
        progress.begin("the advice under each physics", count);
        let rows = comparison.rows.iter().map(|row| {
            let found = shots.under(&row.physics);
            let z = made_z(&row.physics);
            progress.advance(1);
            (found, z)
        });
        let (rows, made_z) = rows.unzip();
        progress.end();
        Ok(Self {
            advice,
            measured,
            rows,
            made_z,
            observed: fit.observed[place],
        })
    }

    /// The interval of a value of the base row, wider by what the changes that nobody measured in
    /// this gym may do to it together.
    pub fn with_physics(
        &self,
        comparison: &PhysicsComparison,
        of: impl Fn(&ShotsUnderPhysics) -> Option<Interval>,
    ) -> Option<(f64, f64)> {
        let base = of(self.rows[comparison.base].as_ref()?)?;
        let changes: Vec<ChangeOfP> =
            comparison.unmeasured_changes(|index, _| Some(of(self.rows[index].as_ref()?)?.mean));
        let [down, up] = together(&changes);
        Some((
            base.mean - libm::hypot(base.mean - base.low, down),
            base.mean + libm::hypot(base.high - base.mean, up),
        ))
    }

    /// Whether z of the makes is known.
    #[must_use]
    pub fn has_z(&self) -> bool {
        self.made_z.iter().any(Option::is_some)
    }

    /// The share of makes, if there are results.
    #[must_use]
    pub fn share_of_makes(&self) -> Option<Wilson> {
        let (made, shots) = self.observed;
        (shots > 0).then(|| wilson_interval(made, shots))
    }

    /// Whether the makes speak against a row: the makes of each ball where releases were measured,
    /// and else the intervals of P and of the share of makes, if they do not meet.
    #[must_use]
    pub fn do_makes_contradict(&self, row: usize) -> bool {
        match self.made_z[row] {
            Some(z) => z.abs() > FAR_MAKES,
            None => self.gap(row).is_some_and(|gap| gap > 0.0),
        }
    }

    /// How far the interval of P of a row is from that of the share of makes; negative where they
    /// meet.
    fn gap(&self, row: usize) -> Option<f64> {
        let share = self.share_of_makes()?;
        let usual = self.rows[row].as_ref()?.usual;
        Some((usual.low - share.high).max(share.low - usual.high))
    }

    /// How far towards a row the gym may be by the makes, 0 to 1: z, or the gap, is taken to change
    /// evenly on the way from the base.
    fn possible_share(&self, base: usize, row: usize) -> f64 {
        if !self.do_makes_contradict(row) {
            return 1.0;
        }
        let (here, there) = match (self.made_z[base], self.made_z[row]) {
            (Some(base), Some(z)) => {
                let side = z.signum();
                (side * base - FAR_MAKES, side * z - FAR_MAKES)
            }
            _ => match (self.gap(base), self.gap(row)) {
                (Some(here), Some(there)) => (here, there),
                _ => return 1.0,
            },
        };
        // A base that the makes contradict is no place to measure from.
        match there > 0.0 && here < 0.0 {
            true => here / (here - there),
            false => 1.0,
        }
    }

    /// What the advice gains as far towards a row as the gym may be.
    #[must_use]
    pub fn possible_gain(&self, comparison: &PhysicsComparison, row: usize) -> Option<Interval> {
        let (there, share) = (self.gain(row)?, comparison.rows[row].possible_share);
        if share >= 1.0 {
            return Some(there);
        }
        let here = self.gain(comparison.base)?;
        let between = |here: f64, there: f64| here + share * (there - here);
        Some(Interval {
            mean: between(here.mean, there.mean),
            sd: between(here.sd, there.sd),
            low: between(here.low, there.low),
            high: between(here.high, there.high),
        })
    }

    /// What the advice gains in a row.
    #[must_use]
    pub fn gain(&self, row: usize) -> Option<Interval> {
        let [_, gain] = self.rows[row]?.advised?;
        Some(gain)
    }
}

/// A best shot under a physics, for programs.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ShotOfRow {
    /// The shot.
    Found {
        /// Its P.
        probability: f64,
        /// Its numerical standard error.
        standard_error: f64,
        /// Its speed.
        speed_m_s: f64,
        /// Above the horizontal.
        pitch_rad: f64,
        /// From the court's long axis.
        polar_rad: f64,
        /// Its backspin.
        backspin_rad_s: f64,
    },
    /// Why there is none.
    None {
        /// The reason.
        none: String,
    },
}

impl From<&Result<BestShot, NoShot>> for ShotOfRow {
    fn from(shot: &Result<BestShot, NoShot>) -> Self {
        match shot {
            Ok(shot) => Self::Found {
                probability: shot.estimate.probability,
                standard_error: shot.estimate.standard_error,
                speed_m_s: shot.nominal.speed_m_s,
                pitch_rad: shot.nominal.pitch_rad,
                polar_rad: shot.nominal.polar_rad,
                backspin_rad_s: shot.nominal.backspin_rad_s,
            },
            Err(reason) => Self::None {
                none: reason.to_string(),
            },
        }
    }
}

/// A fit under a physics, for programs.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FitOfRow {
    /// P of the current shot.
    pub current_probability: Interval,
    /// P of the suggested shot.
    pub suggested_probability: Option<Interval>,
    /// What the advice gains.
    pub gain: Option<Interval>,
    /// By how many standard deviations the makes differ from what is expected.
    pub made_z: Option<f64>,
}

/// A physics and its shots, for programs.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PhysicsRowAnswer {
    /// Which physics it is.
    pub physics: String,
    /// The best direct shot.
    pub direct: ShotOfRow,
    /// The best bank shot.
    pub bank: ShotOfRow,
    /// Where the undisturbed path of the direct shot falls past the hoop's centre.
    pub aim_past_centre_short_m: Option<f64>,
    /// P of the shot that is the same in every row.
    pub same_shot_probability: Option<f64>,
    /// The fit.
    pub fit: Option<FitOfRow>,
}

/// The best shots under each physics, for programs.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PhysicsRows {
    /// Who shoots.
    pub shooter: String,
    /// The index of the row with the physics of the profile.
    pub base: usize,
    /// The physics.
    pub rows: Vec<PhysicsRowAnswer>,
    /// All shots that were simulated for this answer, and for earlier ones of the same profile.
    pub simulated_shots: u64,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl Answer for PhysicsRows {
    const NAME: &'static str = "physics";
}

impl PhysicsAnswer {
    /// The answer for programs; `name` says which physics a row is.
    pub fn for_programs(
        &self,
        profile: &Profile,
        name: impl Fn(PhysicsOf) -> String,
    ) -> PhysicsRows {
        let of_fit = |i: usize| {
            let fitted = self.fitted.as_ref()?;
            let row = fitted.rows[i].as_ref()?;
            Some(FitOfRow {
                current_probability: row.usual,
                suggested_probability: row.advised.map(|[advised, _]| advised),
                gain: row.advised.map(|[_, gain]| gain),
                made_z: fitted.made_z[i],
            })
        };
        let rows = self.comparison.rows.iter().enumerate();
        let rows = rows.map(|(i, row)| PhysicsRowAnswer {
            physics: name(row.of),
            direct: (&row.direct).into(),
            bank: (&row.bank).into(),
            aim_past_centre_short_m: row.aim_past_centre_m,
            same_shot_probability: row.same_shot_p(),
            fit: of_fit(i),
        });
        PhysicsRows {
            shooter: profile.shooter().name.clone(),
            base: self.comparison.base,
            rows: rows.collect(),
            simulated_shots: profile.simulator().simulated_shots(),
            provenance: Provenance::of(profile),
        }
    }
}
