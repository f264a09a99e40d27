//! The pattern search that climbs from a start to a local optimum.

use crate::analysis::aim_past_hoop::centre_speed_m_s;
use crate::search_space::Bracket;
use crate::shooter::{Nominal, NominalVariable, Profile, ShotKind};

/// Greatest number of shots that are tried from one start.
const MAX_TRIALS: u32 = 200;

/// Two shots whose variables differ by less are the same but for rounding, SI units.
const SAME_SHOT: f64 = 1e-9;

/// The steps of a climb, as multiples of the first step of each variable; each is half the one
/// before.
#[derive(Clone, Copy)]
pub(super) struct Steps(&'static [f64]);

impl Steps {
    /// From a start on a coarse grid.
    pub(super) const ALL: Self = Self(&[1.0, 0.5, 0.25]);
    /// From an optimum that was found with fewer points.
    pub(super) const SMALL: Self = Self(&[0.5, 0.25]);
}

/// First step along a variable, SI units. That of the speed is relative to the parabola through the
/// hoop's centre.
fn first_step(variable: NominalVariable) -> f64 {
    match variable {
        NominalVariable::Speed => 0.06,
        NominalVariable::Pitch => 0.03,
        NominalVariable::Polar => 0.01,
        NominalVariable::Backspin | NominalVariable::SideSpin | NominalVariable::RifleSpin => 3.0,
    }
}

/// The limits of a climb.
pub(super) struct Climb<'a> {
    pub(super) profile: &'a Profile,
    pub(super) bracket: &'a Bracket,
}

impl Climb<'_> {
    /// Climbs from a start on `value`, the number of made shots; returns the local optimum of the
    /// same kind.
    pub(super) fn run(
        &self,
        kind: ShotKind,
        start: Nominal,
        steps: Steps,
        value: impl Fn(&Nominal) -> u64,
    ) -> Nominal {
        let choice = self.profile.search().choice;
        let variables: Vec<NominalVariable> = choice.iter().collect();
        let mut best = (value(&start), start);
        let mut trials = 0;
        for scale in steps.0 {
            // Where the last move came from, and the variables that were tried since without one.
            let mut previous = None;
            let mut unmoved = 0;
            for &variable in variables.iter().cycle() {
                if unmoved == variables.len() || trials >= MAX_TRIALS {
                    break;
                }
                unmoved += 1;
                let step = scale * first_step(variable);
                for by in [step, -step] {
                    let next = self.moved(&best.1, variable, by);
                    let is_same = |known: &Nominal| {
                        variables
                            .iter()
                            .all(|&v| (next.get(v) - known.get(v)).abs() < SAME_SHOT)
                    };
                    let is_known = is_same(&best.1) || previous.as_ref().is_some_and(is_same);
                    if is_known || ShotKind::of(self.profile, &next) != kind {
                        continue;
                    }
                    trials += 1;
                    let made = value(&next);
                    if made > best.0 {
                        previous = Some(best.1);
                        best = (made, next);
                        unmoved = 0;
                        break;
                    }
                }
            }
        }
        best.1
    }

    /// The top of the parabola through a shot and two others, `reach` to each side, along one
    /// variable after the other. `value` is the number of made shots. A variable stays where a
    /// limit or the other kind is within reach, or the parabola has no top.
    pub(super) fn top_of_parabolas(
        &self,
        kind: ShotKind,
        optimum: Nominal,
        reach: impl Fn(NominalVariable) -> f64,
        value: impl Fn(&Nominal) -> u64,
    ) -> Nominal {
        let mut best = optimum;
        for variable in self.profile.search().choice.iter() {
            let step = reach(variable);
            let sides = [-step, step].map(|by| self.moved(&best, variable, by));
            let is_free = |side: &Nominal| {
                let moved = (side.get(variable) - best.get(variable)).abs();
                moved > 0.999 * step && ShotKind::of(self.profile, side) == kind
            };
            if step == 0.0 || !sides.iter().all(is_free) {
                continue;
            }
            let [low, middle, high] = [&sides[0], &best, &sides[1]].map(|shot| value(shot) as f64);
            let curvature = low - 2.0 * middle + high;
            if curvature < 0.0 {
                let part = (0.5 * (low - high) / curvature).clamp(-1.0, 1.0);
                best = self.moved(&best, variable, part * step);
            }
        }
        best
    }

    /// The nominal shot moved along one variable and kept within the limits. A move in pitch
    /// changes the speed too, so that the path still passes the hoop at the same point.
    fn moved(&self, from: &Nominal, variable: NominalVariable, by: f64) -> Nominal {
        let search = self.profile.search();
        let searches_speed = search.choice.includes(NominalVariable::Speed);
        let (low, high) = self.limits(variable);
        let mut to = from.with(variable, (from.get(variable) + by).clamp(low, high));
        if variable == NominalVariable::Pitch && searches_speed {
            let before = centre_speed_m_s(self.profile, from.pitch_rad);
            let after = centre_speed_m_s(self.profile, to.pitch_rad);
            if let Some((before, after)) = before.zip(after) {
                to.speed_m_s += after - before;
            }
        }
        if searches_speed {
            to.speed_m_s = to.speed_m_s.clamp(0.1, self.bracket.speed_max_m_s);
        }
        to
    }

    /// The allowed values of a variable.
    fn limits(&self, variable: NominalVariable) -> (f64, f64) {
        let search = self.profile.search();
        let shooter = self.profile.shooter();
        match variable {
            // Applied after a change of the pitch angle.
            NominalVariable::Speed => (f64::NEG_INFINITY, f64::INFINITY),
            NominalVariable::Pitch => (search.pitch_min_rad, search.pitch_max_rad),
            NominalVariable::Polar => self.bracket.polar_rad,
            NominalVariable::Backspin => (0.0, shooter.max_backspin_rad_s),
            NominalVariable::SideSpin | NominalVariable::RifleSpin => {
                (-shooter.max_side_spin_rad_s, shooter.max_side_spin_rad_s)
            }
        }
    }
}
