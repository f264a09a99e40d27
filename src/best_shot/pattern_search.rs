//! The pattern search that climbs from starts to local optima.

use crate::analysis::aim_past_hoop::centre_speed_m_s;
use crate::probability::Progress;
use crate::search_space::Bracket;
use crate::shooter::{Nominal, NominalVariable, Profile, ShotKind};

/// About the greatest number of shots that are tried from one start.
const MAX_TRIALS: u32 = 200;

/// Two shots whose variables differ by less are the same but for rounding, SI units.
const SAME_SHOT: f64 = 1e-9;

/// Shots to each side that are tried beside the border to the other kind.
const BORDER_STEPS: i32 = 8;
/// The border itself is found by so many halvings of a step.
const BORDER_HALVINGS: u32 = 5;

/// Step of a climb along a variable, SI units. That of the speed is relative to the parabola
/// through the hoop's centre.
pub(super) fn step(variable: NominalVariable) -> f64 {
    match variable {
        NominalVariable::Speed => 0.06,
        NominalVariable::Pitch => 0.03,
        NominalVariable::Polar => 0.01,
        NominalVariable::Backspin | NominalVariable::SideSpin | NominalVariable::RifleSpin => 3.0,
    }
}

/// Where a climb starts, and the kind of the shots that it tries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub(super) kind: ShotKind,
    pub(super) nominal: Nominal,
}

/// The search for local optima.
pub(super) struct PatternSearch<'a> {
    profile: &'a Profile,
    bracket: &'a Bracket,
    /// The variables that are searched.
    variables: Vec<NominalVariable>,
}

/// A climb in progress. It asks for the value of one shot after another.
struct Climb {
    kind: ShotKind,
    /// The best shot so far, with its value.
    best: (u64, Nominal),
    /// Where the last move came from.
    previous: Option<Nominal>,
    /// Part of the step of each variable.
    scale: f64,
    /// The next move: each variable is moved up (even numbers), then down.
    next_move: usize,
    /// The variables that were tried since the last move was taken.
    unmoved: usize,
    trials: u32,
}

impl Climb {
    fn new(start: Start, value: u64, scale: f64) -> Self {
        Self {
            kind: start.kind,
            best: (value, start.nominal),
            previous: None,
            scale,
            next_move: 0,
            unmoved: 0,
            trials: 0,
        }
    }

    /// The next shot to try; `None` at the end.
    fn next_trial(&mut self, search: &PatternSearch<'_>) -> Option<Nominal> {
        let variables = &search.variables;
        loop {
            let moves_up = self.next_move.is_multiple_of(2);
            if moves_up && (self.unmoved == variables.len() || self.trials >= MAX_TRIALS) {
                return None;
            }
            if moves_up {
                self.unmoved += 1;
            }
            let variable = variables[self.next_move / 2];
            let step = self.scale * step(variable);
            let by = if moves_up { step } else { -step };
            let next = search.moved(&self.best.1, variable, by);
            let is_same = |known: &Nominal| search.is_same(&next, known);
            let is_known = is_same(&self.best.1) || self.previous.as_ref().is_some_and(is_same);
            if is_known || ShotKind::of(search.profile, &next) != self.kind {
                self.next_move = (self.next_move + 1) % (2 * variables.len());
                continue;
            }
            self.trials += 1;
            return Some(next);
        }
    }

    /// Takes the value of the trial that was asked for.
    fn take(&mut self, trial: Nominal, value: u64, search: &PatternSearch<'_>) {
        let moves = 2 * search.variables.len();
        self.next_move = if value > self.best.0 {
            self.previous = Some(self.best.1);
            self.best = (value, trial);
            self.unmoved = 0;
            // The other direction of this variable was where it came from.
            2 * (self.next_move / 2 + 1) % moves
        } else {
            (self.next_move + 1) % moves
        };
    }
}

impl<'a> PatternSearch<'a> {
    pub(super) fn new(profile: &'a Profile, bracket: &'a Bracket) -> Self {
        Self {
            profile,
            bracket,
            variables: profile.search().choice.iter().collect(),
        }
    }

    /// Climbs from each start on `values`, the numbers of made shots of some shots, by a part of
    /// the usual steps; returns the local optima and their values. The climbs go side by side, so
    /// that each call of `values` has a trial of every climb: one alone has too few shots for all
    /// threads and lanes.
    pub(super) fn climb(
        &self,
        starts: &[Start],
        scale: f64,
        values: impl Fn(&[Nominal]) -> Vec<u64>,
        progress: &dyn Progress,
    ) -> (Vec<Nominal>, Vec<u64>) {
        let nominals: Vec<Nominal> = starts.iter().map(|start| start.nominal).collect();
        let mut climbs: Vec<Climb> = starts
            .iter()
            .zip(values(&nominals))
            .map(|(&start, value)| Climb::new(start, value, scale))
            .collect();
        let mut in_progress = climbs.len();
        loop {
            let (asking, trials): (Vec<usize>, Vec<Nominal>) = climbs
                .iter_mut()
                .enumerate()
                .filter_map(|(i, climb)| Some((i, climb.next_trial(self)?)))
                .unzip();
            progress.advance((in_progress - trials.len()) as u64);
            in_progress = trials.len();
            if trials.is_empty() {
                let best = climbs.into_iter().map(|climb| (climb.best.1, climb.best.0));
                return best.unzip();
            }
            for ((i, &trial), value) in asking.into_iter().zip(&trials).zip(values(&trials)) {
                climbs[i].take(trial, value, self);
            }
        }
    }

    /// Whether two shots are the same but for rounding.
    fn is_same(&self, a: &Nominal, b: &Nominal) -> bool {
        let differs = |&v: &NominalVariable| (a.get(v) - b.get(v)).abs() >= SAME_SHOT;
        !self.variables.iter().any(differs)
    }

    /// The top of the parabola through a shot and two others, `reach` to each side, along one
    /// variable after the other: near an optimum it is closer than a climb comes, which compares
    /// values that err. `values` are P of some shots, or in its place. Beside a limit the
    /// three shots end there. Where the parabola has no top, its higher end is taken. A variable
    /// stays where the other kind is within reach.
    pub(super) fn top_of_parabolas(
        &self,
        start: &Start,
        reach: impl Fn(NominalVariable) -> f64,
        values: impl Fn(&[Nominal]) -> Vec<f64>,
    ) -> Start {
        let mut best = start.nominal;
        for &variable in &self.variables {
            let limits = self.limits(variable);
            let step = reach(variable).min(0.5 * (limits.1 - limits.0));
            if !(step > 0.0) {
                continue;
            }
            let value = best.get(variable);
            let centre = value.max(limits.0 + step).min(limits.1 - step);
            let at = |value: f64| self.moved(&best, variable, value - best.get(variable));
            let shots = [centre - step, centre, centre + step].map(at);
            if !shots
                .iter()
                .all(|shot| ShotKind::of(self.profile, shot) == start.kind)
            {
                continue;
            }
            let values = values(&shots);
            let [low, middle, high] = [0, 1, 2].map(|i| values[i]);
            let curvature = low - 2.0 * middle + high;
            let part = match high - low {
                rise if curvature < 0.0 => (-0.5 * rise / curvature).clamp(-1.0, 1.0),
                0.0 => continue,
                rise => rise.signum(),
            };
            best = at(centre + part * step);
        }
        Start {
            nominal: best,
            ..*start
        }
    }

    /// The best of some shots of the kind along one variable after the other, where the other kind
    /// is within reach: parabolas do not go there, and the best shot may lie at the border, which
    /// is one of them.
    pub(super) fn best_beside_other_kind(
        &self,
        start: &Start,
        reach: impl Fn(NominalVariable) -> f64,
        values: impl Fn(&[Nominal]) -> Vec<f64>,
    ) -> Start {
        let mut best = start.nominal;
        for &variable in &self.variables {
            let step = reach(variable) / f64::from(BORDER_STEPS);
            let at = |steps: f64| self.moved(&best, variable, steps * step);
            let is_of_kind = |steps: &f64| ShotKind::of(self.profile, &at(*steps)) == start.kind;
            let all: Vec<f64> = (-BORDER_STEPS..=BORDER_STEPS).map(f64::from).collect();
            let mut of_kind: Vec<f64> = all.iter().copied().filter(is_of_kind).collect();
            if of_kind.len() == all.len() {
                continue;
            }
            for pair in all.windows(2) {
                let [inside, outside] = match [0, 1].map(|i: usize| is_of_kind(&pair[i])) {
                    [true, false] => [pair[0], pair[1]],
                    [false, true] => [pair[1], pair[0]],
                    _ => continue,
                };
                let halved = |(inside, outside): (f64, f64), _| {
                    let middle = 0.5 * (inside + outside);
                    if is_of_kind(&middle) {
                        (middle, outside)
                    } else {
                        (inside, middle)
                    }
                };
                of_kind.push((0..BORDER_HALVINGS).fold((inside, outside), halved).0);
            }
            let shots: Vec<Nominal> = of_kind.into_iter().map(at).collect();
            let each = shots.iter().zip(values(&shots));
            if let Some((shot, _)) = each.max_by(|a, b| a.1.total_cmp(&b.1)) {
                best = *shot;
            }
        }
        Start {
            nominal: best,
            ..*start
        }
    }

    /// The nominal shot moved along one variable and kept within the limits. A move in pitch
    /// changes the speed too, so that the path still passes the hoop at the same point; but from
    /// the greatest speed it keeps that, or no move would lead along the limit.
    fn moved(&self, from: &Nominal, variable: NominalVariable, by: f64) -> Nominal {
        let search = self.profile.search();
        let searches_speed = search.choice.includes(NominalVariable::Speed);
        let (low, high) = self.limits(variable);
        let mut to = from.with(variable, (from.get(variable) + by).clamp(low, high));
        let is_fastest = from.speed_m_s >= self.limits(NominalVariable::Speed).1;
        if variable == NominalVariable::Pitch && searches_speed && !is_fastest {
            let before = centre_speed_m_s(self.profile, from.pitch_rad);
            let after = centre_speed_m_s(self.profile, to.pitch_rad);
            if let Some((before, after)) = before.zip(after) {
                to.speed_m_s += after - before;
            }
        }
        if searches_speed {
            let (low, high) = self.limits(NominalVariable::Speed);
            to.speed_m_s = to.speed_m_s.clamp(low, high);
        }
        to
    }

    /// A shot of another profile, kept within the limits of this one.
    pub(super) fn within_limits(&self, shot: &Nominal) -> Nominal {
        let mut within = *shot;
        for &variable in &self.variables {
            let (low, high) = self.limits(variable);
            *within.get_mut(variable) = shot.get(variable).clamp(low, high);
        }
        within
    }

    /// The allowed values of a variable.
    fn limits(&self, variable: NominalVariable) -> (f64, f64) {
        let search = self.profile.search();
        let shooter = self.profile.shooter();
        match variable {
            NominalVariable::Speed => (0.1, self.bracket.speed_max_m_s),
            NominalVariable::Pitch => (search.pitch_min_rad, search.pitch_max_rad),
            NominalVariable::Polar => self.bracket.polar_rad,
            NominalVariable::Backspin => (0.0, shooter.max_backspin_rad_s),
            NominalVariable::SideSpin | NominalVariable::RifleSpin => {
                (-shooter.max_side_spin_rad_s, shooter.max_side_spin_rad_s)
            }
        }
    }
}
