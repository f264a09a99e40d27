//! The dispersion of releases: standard deviations (Eq. 28 of the paper and five more) and
//! correlations.

use super::correlation::Correlation;
use super::invalid_setting::SettingChecks;
use super::nominal::Nominal;
use super::release_variable::ReleaseVariable;
use serde::Serialize;

/// Greatest speed of a release that a profile can ask for, m/s.
pub(super) const MAX_SPEED_M_S: f64 = 40.0;
/// Greatest spin that a profile can ask for, rad/s.
pub(super) const MAX_SPIN_RAD_S: f64 = 200.0;

/// Standard deviations of the release errors as functions of the nominal values (Eq. 28), and their
/// correlations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReleaseDispersion {
    /// Speed: `c10 + c11 v + c12 v^2`; c10 in m/s.
    pub c10_m_s: f64,
    /// c11, dimensionless.
    pub c11: f64,
    /// c12, s/m.
    pub c12_s_m: f64,
    /// Pitch angle, rad.
    pub c20_rad: f64,
    /// Polar angle, rad.
    pub c30_rad: f64,
    /// Backspin: `c40 + c41 w + c42 w^2`; c40 in rad/s.
    pub c40_rad_s: f64,
    /// c41, dimensionless.
    pub c41: f64,
    /// c42, s/rad.
    pub c42_s_rad: f64,
    /// Spin about the horizontal direction of the shot, rad/s.
    pub rifle_spin_rad_s: f64,
    /// Spin about the vertical, rad/s.
    pub side_spin_rad_s: f64,
    /// Distance from the hoop, m.
    pub distance_m: f64,
    /// Angle of the location on the court, rad.
    pub court_angle_rad: f64,
    /// Height of the release, m.
    pub height_m: f64,
    /// Correlations of the errors.
    pub correlation: Correlation,
}

impl ReleaseDispersion {
    /// No errors at all.
    pub const NONE: Self = Self {
        c10_m_s: 0.0,
        c11: 0.0,
        c12_s_m: 0.0,
        c20_rad: 0.0,
        c30_rad: 0.0,
        c40_rad_s: 0.0,
        c41: 0.0,
        c42_s_rad: 0.0,
        rifle_spin_rad_s: 0.0,
        side_spin_rad_s: 0.0,
        distance_m: 0.0,
        court_angle_rad: 0.0,
        height_m: 0.0,
        correlation: Correlation::NONE,
    };

    /// Standard deviation of the speed at a nominal speed, m/s.
    #[must_use]
    pub fn speed_m_s(&self, nominal_m_s: f64) -> f64 {
        self.c10_m_s + self.c11 * nominal_m_s + self.c12_s_m * nominal_m_s * nominal_m_s
    }

    /// Standard deviation of the backspin at a nominal backspin, rad/s.
    #[must_use]
    pub fn backspin_rad_s(&self, nominal_rad_s: f64) -> f64 {
        self.c40_rad_s + self.c41 * nominal_rad_s + self.c42_s_rad * nominal_rad_s * nominal_rad_s
    }

    /// Standard deviation of one variable at a nominal shot, SI units.
    #[must_use]
    pub fn sigma(&self, variable: ReleaseVariable, nominal: &Nominal) -> f64 {
        match variable {
            ReleaseVariable::Speed => self.speed_m_s(nominal.speed_m_s),
            ReleaseVariable::Pitch => self.c20_rad,
            ReleaseVariable::Polar => self.c30_rad,
            ReleaseVariable::Backspin => self.backspin_rad_s(nominal.backspin_rad_s),
            ReleaseVariable::RifleSpin => self.rifle_spin_rad_s,
            ReleaseVariable::SideSpin => self.side_spin_rad_s,
            ReleaseVariable::Distance => self.distance_m,
            ReleaseVariable::CourtAngle => self.court_angle_rad,
            ReleaseVariable::Height => self.height_m,
        }
    }

    /// The standard deviations at a nominal shot, in the order of [`ReleaseVariable::ALL`], SI
    /// units.
    #[must_use]
    pub fn sigmas(&self, nominal: &Nominal) -> [f64; ReleaseVariable::COUNT] {
        ReleaseVariable::ALL.map(|variable| self.sigma(variable, nominal))
    }

    /// The same dispersion with the standard deviation of one variable multiplied by `factor`.
    #[must_use]
    pub fn scaled(mut self, variable: ReleaseVariable, factor: f64) -> Self {
        match variable {
            ReleaseVariable::Speed => {
                self.c10_m_s *= factor;
                self.c11 *= factor;
                self.c12_s_m *= factor;
            }
            ReleaseVariable::Pitch => self.c20_rad *= factor,
            ReleaseVariable::Polar => self.c30_rad *= factor,
            ReleaseVariable::Backspin => {
                self.c40_rad_s *= factor;
                self.c41 *= factor;
                self.c42_s_rad *= factor;
            }
            ReleaseVariable::RifleSpin => self.rifle_spin_rad_s *= factor,
            ReleaseVariable::SideSpin => self.side_spin_rad_s *= factor,
            ReleaseVariable::Distance => self.distance_m *= factor,
            ReleaseVariable::CourtAngle => self.court_angle_rad *= factor,
            ReleaseVariable::Height => self.height_m *= factor,
        }
        self
    }

    /// Whether the errors of a shot's mirror image are distributed like those of the shot. They are
    /// not if an error that changes its sign in the mirror is correlated with one that does not.
    #[must_use]
    pub fn is_mirror_symmetric(&self) -> bool {
        ReleaseVariable::ALL.iter().all(|a| {
            ReleaseVariable::ALL.iter().all(|b| {
                a.is_odd_in_mirror() == b.is_odd_in_mirror()
                    || self.correlation.coefficient(*a, *b) == 0.0
            })
        })
    }

    /// Whether there are only the four errors of Eq. 25, and these are independent.
    #[must_use]
    pub fn is_of_eq_25(&self) -> bool {
        let others = [
            self.rifle_spin_rad_s,
            self.side_spin_rad_s,
            self.distance_m,
            self.court_angle_rad,
            self.height_m,
        ];
        others.iter().all(|&sigma| sigma == 0.0) && self.correlation == Correlation::NONE
    }

    pub(super) fn check(&self, checks: &mut SettingChecks, max_backspin_rad_s: f64) {
        let key = |name: &str| format!("shooter.errors.{name}");
        for (name, value) in [
            ("c10", self.c10_m_s),
            ("c20", self.c20_rad),
            ("c30", self.c30_rad),
            ("c40", self.c40_rad_s),
        ] {
            checks.require(&key(name), value >= 0.0, "0 or more");
        }
        for (name, value) in [("c20", self.c20_rad), ("c30", self.c30_rad)] {
            checks.require(&key(name), value < 0.5, "below 0.5 rad (28.6 deg)");
        }
        for (name, value) in [
            ("rifle_spin", self.rifle_spin_rad_s),
            ("side_spin", self.side_spin_rad_s),
        ] {
            let holds = (0.0..=MAX_SPIN_RAD_S).contains(&value);
            checks.require(&key(name), holds, "from 0 to 200 rad/s (31.8 rev/s)");
        }
        for (name, value) in [("distance", self.distance_m), ("height", self.height_m)] {
            let holds = (0.0..=1.0).contains(&value);
            checks.require(&key(name), holds, "from 0 to 1 m (3.28 ft)");
        }
        let holds = (0.0..=0.5).contains(&self.court_angle_rad);
        checks.require(&key("court_angle"), holds, "from 0 to 0.5 rad (28.6 deg)");
        // Eq. 28 must be a plausible standard deviation at every nominal value.
        let is_plausible = |to: f64, most: f64, sigma: &dyn Fn(f64) -> f64| {
            (0..=200).all(|i| (0.0..=most).contains(&sigma(to * f64::from(i) / 200.0)))
        };
        if checks.is_valid(&key("c10"))
            && !is_plausible(MAX_SPEED_M_S, 10.0, &|v| self.speed_m_s(v))
        {
            let blamed = if self.c12_s_m != 0.0 {
                "c12"
            } else if self.c11 != 0.0 {
                "c11"
            } else {
                "c10"
            };
            checks.refuse(
                &key(blamed),
                "the error of the speed, c10 + c11 v + c12 v^2, must be from 0 to 10 m/s for every speed v up to 40 m/s; a share of the speed (c11, or speed in %) from 0 to 25 %",
            );
        }
        if checks.is_valid(&key("c40"))
            && checks.is_valid("shooter.max_backspin")
            && !is_plausible(max_backspin_rad_s, MAX_SPIN_RAD_S, &|w| {
                self.backspin_rad_s(w)
            })
        {
            checks.refuse(
                &key("c40"),
                "c40 + c41 w + c42 w^2 must be from 0 to 200 rad/s for every backspin up to max_backspin",
            );
        }
    }
}
