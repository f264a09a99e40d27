//! Fitted shots, and what their advice gains, where the physics of the gym is another one than that
//! of the fit.

use super::advice::Advice;
use super::advice_steps::{Change, Shooting};
use super::interval::Interval;
use super::landing::{jacobian, landing_of, release_of_landing};
use super::measured_release::{Place, Values};
use super::posterior::{Draw, Posterior};
use crate::dynamics::Simulator;
use crate::model::Physics;
use crate::shooter::Profile;
use nalgebra::SMatrix;

/// Shots of a fit under one physics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShotsUnderPhysics {
    /// P of the current shot, a fraction of 1.
    pub usual: Interval,
    /// The numerical standard error of its mean.
    pub standard_error: f64,
    /// P of the advised shot, and that less P of the usual one, draw by draw. `None` where nothing
    /// is advised.
    pub advised: Option<[Interval; 2]>,
}

/// What a fit measured of a shot: this is the same under every physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measured {
    /// The release itself.
    Release,
    /// How the ball falls to the hoop. The release that leads there depends on the air.
    Landing,
}

/// A fit at one of its places, with the change that [`super::advise`] advises there under the
/// physics by which the shots were fitted.
#[derive(Clone, Copy)]
pub struct FittedShots<'a> {
    profile: &'a Profile,
    posterior: &'a Posterior,
    place: usize,
    measured: Measured,
    change: Option<Change>,
}

impl<'a> FittedShots<'a> {
    /// `advice` is that for `profile` at the place.
    #[must_use]
    pub fn new(
        (profile, posterior, place): (&'a Profile, &'a Posterior, usize),
        advice: &Advice,
        measured: Measured,
    ) -> Self {
        let steps = advice.steps.as_ref();
        let steps = steps.filter(|steps| steps.is_changed.contains(&true));
        Self {
            profile,
            posterior,
            place,
            measured,
            change: steps.map(|steps| Change::to(&steps.advised, |i| !steps.is_changed[i])),
        }
    }

    /// The shots under another physics. `None` if the profile is not valid under it, or if the
    /// landing of a draw has no release there.
    #[must_use]
    pub fn under(&self, physics: &Physics) -> Option<ShotsUnderPhysics> {
        let other = self
            .profile
            .with(|settings| settings.physics = physics.clone());
        let other = other.ok()?;
        let (draws, typical) = (&self.posterior.draws, self.posterior.typical());
        let probabilities = |change: Change| {
            let moved = draws.iter().map(|draw| {
                // The ring is that of the other physics.
                let mut moved = draw.clone().with_ring(None);
                let changed = change.of_draw(draw, &typical, self.place);
                moved.means[self.place] = self.release_under(&other, &changed)?;
                moved.factors[self.place] = self.factor_under(&other, draw)?;
                Some(moved)
            });
            let moved: Vec<Draw> = moved.collect::<Option<_>>()?;
            let mut shooting = Shooting::new(&other, &moved, &moved[0], self.place);
            Some(shooting.with(Change::default()).probabilities.clone())
        };
        let usual = probabilities(Change::default())?;
        let advised = match self.change {
            None => None,
            Some(change) => {
                let advised = probabilities(change)?;
                Some([advised.interval(), advised.minus(&usual).interval()])
            }
        };
        Some(ShotsUnderPhysics {
            usual: usual.interval(),
            standard_error: usual.numerical_standard_error(),
            advised,
        })
    }

    fn place(&self) -> Place {
        Place {
            location: self.profile.location(),
            release_height_m: self.profile.shooter().release_height_m,
        }
    }

    /// The release under another physics of a shot that was measured.
    fn release_under(&self, other: &Profile, values: &Values) -> Option<Values> {
        match self.measured {
            Measured::Release => Some(*values),
            Measured::Landing => {
                let simulators = [self.profile.simulator(), other.simulator()];
                same_landing(simulators, &self.place(), values)
            }
        }
    }

    /// The Cholesky factor of the covariance of a draw's releases under another physics: that which
    /// scatters the landings about the usual one as they were measured. With J the derivatives of
    /// the landing by speed, pitch and polar angle, releases change by `J_other^-1 J_own`.
    fn factor_under(&self, other: &Profile, draw: &Draw) -> Option<SMatrix<f64, 4, 4>> {
        let factor = draw.factors[self.place];
        if self.measured == Measured::Release {
            return Some(factor);
        }
        let (place, usual) = (self.place(), &draw.means[self.place]);
        let own = jacobian(self.profile.simulator(), &place, usual)?;
        let there = self.release_under(other, usual)?;
        let of_other = jacobian(other.simulator(), &place, &there)?;
        let mut moved = SMatrix::<f64, 4, 4>::identity();
        let change = of_other.try_inverse()? * own;
        moved.fixed_view_mut::<3, 3>(0, 0).copy_from(&change);
        let scattered = moved * factor;
        let covariance = scattered * scattered.transpose();
        covariance.cholesky().map(|cholesky| cholesky.l())
    }
}

/// The release that lands under the second physics as this one does under the first.
fn same_landing([from, to]: [&Simulator; 2], place: &Place, values: &Values) -> Option<Values> {
    let landing = landing_of(from, place, values)?;
    let found = release_of_landing(to, place, &landing, &[0.0; 3], values[3]);
    found.ok().map(|(values, _)| values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shooter::Location;
    use crate::units::{DEGREE_RAD, FOOT_M};

    /// Authority: the landing itself; and less drag needs less speed.
    #[test]
    fn contract_the_same_landing_under_another_drag() {
        let place = Place {
            location: Location {
                distance_m: 13.75 * FOOT_M,
                angle_rad: 0.3,
            },
            release_height_m: 7.0 * FOOT_M,
        };
        let simulator = |drag: f64| {
            let mut physics = crate::model::PRESETS
                .iter()
                .find(|preset| preset.name == "ncaa")
                .unwrap()
                .physics();
            physics.air.drag_coefficient = drag;
            Simulator::new(&physics).unwrap()
        };
        let [usual, thin] = [simulator(0.45), simulator(0.41)];
        let values = [7.4, 52.0 * DEGREE_RAD, 0.31, 15.0];
        let moved = same_landing([&usual, &thin], &place, &values).unwrap();
        let landings = [
            landing_of(&usual, &place, &values).unwrap(),
            landing_of(&thin, &place, &moved).unwrap(),
        ];
        assert!((landings[0].depth_m - landings[1].depth_m).abs() < 1e-8);
        assert!((landings[0].right_m - landings[1].right_m).abs() < 1e-8);
        assert!((landings[0].entry_angle_rad - landings[1].entry_angle_rad).abs() < 1e-8);
        assert!(moved[0] < values[0] - 0.01 && moved[3] == values[3]);
    }
}
