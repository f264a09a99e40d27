//! The answer of `fit` in text.

use super::fit_checks_text::{fit_checks_text, rests_on_priors, shapes_text};
use super::fit_note_text::{WHAT_TO_CHECK, contradiction, fit_note_text, p_value};
use crate::answers::fit::FitSource;
use crate::fitting::{
    CENTRE_DEPTH_M, Contradiction, FitNote, ShooterFit, SpinSource, WARNING_LEVEL, values_at_height,
};
use crate::measured_shots::source::Source;
use crate::present::layout::{Side, TextAnswer, TextTable, paragraph};
use crate::present::words::{
    interval_of_100, list, of_100, per_100, physics_name, simulation_error, subject, variable_name,
};
use crate::shooter::ReleaseVariable;
use crate::store::parameters::{Parameter, parameters, value_units};
use crate::units::{DEGREE_RAD, FOOT_M, UnitSystem};

/// The answer.
#[must_use]
pub fn fit_text(fit: &ShooterFit, source: &FitSource<'_>, units: UnitSystem) -> TextAnswer {
    let text = FitText { fit, source, units };
    TextAnswer {
        answer: text.answer(),
        subject: text.subject(),
        table: Some(match fit.places.len() {
            1 => text.values(),
            _ => text.places(),
        }),
        notes: text.notes(),
        details: text.details(),
        ..TextAnswer::default()
    }
}

struct FitText<'a> {
    fit: &'a ShooterFit,
    source: &'a FitSource<'a>,
    units: UnitSystem,
}

impl FitText<'_> {
    /// How many go in, and what was counted.
    fn answer(&self) -> Vec<String> {
        let (fit, makes) = (self.fit, &self.fit.makes);
        if let Some(doubt) = Contradiction::of_fit(&fit.notes, makes.labelled) {
            return vec![
                format!("Do not use this fit yet: {}.", contradiction(&doubt)),
                WHAT_TO_CHECK.to_owned(),
            ];
        }
        let mut answer: Vec<String> = self.caution().into_iter().collect();
        let p = fit.probabilities[0].interval();
        let from = match fit.places.len() {
            1 => String::new(),
            _ => format!(" from {}", self.place_name(0)),
        };
        answer.push(format!(
            "{} of 100 shots go in{from} (95 % interval {}), from {} {} shots.",
            of_100(p.mean),
            interval_of_100(p.low, p.high),
            fit.posterior.shots,
            match self.source.kind {
                Source::Makes => "counted",
                _ => "measured",
            }
        ));
        if self.source.kind == Source::Makes {
            answer.push(format!(
                "Counted: {} of {} went in. No flight was measured: scatter and aim are those of an average player who makes as many.",
                makes.made, makes.labelled
            ));
        } else if makes.labelled > 0 {
            let without = match fit.posterior.shots - makes.labelled {
                0 => String::new(),
                n => format!(" ({n} shots have no result.)"),
            };
            answer.push(format!(
                "Counted: {} of {} went in. By their measurements {:.0} should have, so the two agree.{without}",
                makes.made, makes.labelled, makes.expected
            ));
        }
        answer
    }

    /// What is wrong with the shots, for which no interval makes up.
    fn caution(&self) -> Option<String> {
        let fit = self.fit;
        if let Some(now) = &fit.at_the_end[0] {
            let now = now.interval();
            return Some(format!(
                "The shot drifted during the session: at its end {} of 100 go in (95 % interval {}). What follows is the whole session.",
                of_100(now.mean),
                interval_of_100(now.low, now.high)
            ));
        }
        let reason = fit.notes.iter().find_map(|note| match note {
            FitNote::NotNormal { .. } => Some("the shots are not normally distributed"),
            FitNote::OtherNoise { .. } => Some("the tracker's noise is not what was stated"),
            FitNote::TooSure { .. } => Some("the chances of single shots are overconfident"),
            _ => None,
        })?;
        Some(format!("Take this fit with care: {reason}."))
    }

    /// A place in a sentence.
    fn place_name(&self, index: usize) -> String {
        match self.source.place_names[index].as_str() {
            "" => format!("place {}", index + 1),
            name => name.to_owned(),
        }
    }

    fn subject(&self) -> String {
        let profile = &self.fit.profiles[0];
        match self.fit.places.len() {
            1 => {
                let name = match self.source.place_names[0].as_str() {
                    "" => String::new(),
                    name => format!(" Place: {name}."),
                };
                subject(profile, self.units) + &name
            }
            n => format!(
                "{}: {n} places. Physics: {}.",
                self.fit.name,
                physics_name(profile)
            ),
        }
    }

    /// Average and scatter of each value.
    fn values(&self) -> TextTable {
        let mut table = TextTable::new(&[
            ("", "", Side::Left),
            ("average", "", Side::Right),
            ("95 % interval", "", Side::Left),
            ("scatter", "", Side::Right),
            ("95 % interval", "", Side::Left),
            ("", "", Side::Left),
        ]);
        let (posterior, place) = (&self.fit.posterior, &self.fit.places[0]);
        let value_units = value_units(self.units);
        for (i, (unit, size)) in value_units.into_iter().enumerate() {
            let variable = ReleaseVariable::ALL[i];
            let start = match variable {
                ReleaseVariable::Polar => place.location.angle_rad,
                _ => 0.0,
            };
            let mean = posterior
                .summary(|draw| draw.means[0][i] - start)
                .scaled(1.0 / size);
            let sd = posterior.summary(|draw| draw.sds[i]).scaled(1.0 / size);
            let name = match variable {
                ReleaseVariable::Polar => "direction (deg left)".to_owned(),
                _ => format!("{} ({unit})", variable_name(variable)),
            };
            let decimals = if i == 0 { 2 } else { 1 };
            let number = |value: f64| format!("{:.decimals$}", value + 0.0);
            let source = match (variable, posterior.spin) {
                (ReleaseVariable::Polar, SpinSource::AssumedWithDirection)
                | (
                    ReleaseVariable::Backspin,
                    SpinSource::Assumed | SpinSource::AssumedWithDirection,
                ) => "assumed",
                (ReleaseVariable::Backspin, SpinSource::Given) => "given",
                (_, SpinSource::NothingMeasured) => "population",
                _ => "",
            };
            table.add([
                name,
                number(mean.mean),
                format!("{} to {}", number(mean.low), number(mean.high)),
                significant(sd.mean, sd.mean),
                format!(
                    "{} to {}",
                    significant(sd.low, sd.mean),
                    significant(sd.high, sd.mean)
                ),
                source.to_owned(),
            ]);
        }
        table
    }

    /// The makes from each place.
    fn places(&self) -> TextTable {
        let mut table = TextTable::new(&[
            ("place", "", Side::Left),
            ("makes", "per 100", Side::Right),
            ("95 %", "interval", Side::Left),
            ("went in", "", Side::Right),
            ("predicted", "", Side::Right),
        ]);
        for (index, p) in self.fit.probabilities.iter().enumerate() {
            let (p, makes) = (p.interval(), self.fit.makes.at_place(index));
            let counted = match makes.labelled {
                0 => ["-".to_owned(), "-".to_owned()],
                _ => [
                    format!("{} of {}", makes.made, makes.labelled),
                    format!("{:.0}", makes.expected),
                ],
            };
            let [made, expected] = counted;
            let where_it_is = self.fit.places[index].location.in_words(self.units);
            let place = match self.source.place_names[index].as_str() {
                "" => format!("{}: {where_it_is}", index + 1),
                name => format!("{name}\n{where_it_is}"),
            };
            table.add([
                place,
                per_100(p.mean),
                format!("{} to {}", per_100(p.low), per_100(p.high)),
                made,
                expected,
            ]);
        }
        table
    }

    /// What can change the decision.
    fn notes(&self) -> Vec<String> {
        let (fit, source) = (self.fit, self.source);
        let mut notes = Vec::new();
        if fit.places.len() > 1 {
            let sds = (0..3).map(|i| {
                let (unit, size) = value_units(self.units)[i];
                let sd = fit.posterior.summary(|draw| draw.sds[i]).mean / size;
                format!(
                    "{} {} {unit}",
                    variable_name(ReleaseVariable::ALL[i]),
                    significant(sd, sd)
                )
            });
            notes.push(format!(
                "Scatter, the same at all places: {}.",
                list(&sds.collect::<Vec<_>>())
            ));
        }
        let shown = fit
            .notes
            .iter()
            .filter(|note| !matches!(note, FitNote::OtherMakes { .. }));
        let warnings: Vec<String> = shown
            .map(|note| format!("Warning: {}.", fit_note_text(note)))
            .collect();
        let checks = 2 + fit.trends.iter().map(number_of_tests).sum::<usize>();
        let is_of_checks = |note: &FitNote| {
            matches!(
                note,
                FitNote::NotNormal { .. }
                    | FitNote::Drift { .. }
                    | FitNote::SessionsDiffer { .. }
                    | FitNote::ScatterDiffers { .. }
                    | FitNote::SerialCorrelation { .. }
                    | FitNote::OtherMakes { .. }
            )
        };
        let passed = match fit.notes.iter().any(is_of_checks) {
            true => String::new(),
            false => format!(
                " The data passed all {checks} checks: normal distribution, no drift, no shot influenced by the one before."
            ),
        };
        notes.push(match source.kind {
            Source::Makes => "Makes alone do not tell angle, speed and direction apart: how the scatter divides is that of other players. A sensor would tell (`bankshot sample-size`).".to_owned(),
            _ => format!(
            "Scatter: standard deviation from shot to shot, with the sensor's noise ({}, {}) removed.{passed}",
            source.tracker.0, source.tracker.1
        ),
        });
        if fit.posterior.spin == SpinSource::AssumedWithDirection {
            notes.push(
                "The direction was not measured: its aim and scatter are those of other players (assumed)."
                    .to_owned(),
            );
        }
        notes.extend(warnings);
        notes.extend(shapes_text(fit));
        notes.push(self.what_is_counted());
        notes
    }

    /// What the intervals rest on beside the shots.
    fn what_is_counted(&self) -> String {
        let posterior = &self.fit.posterior;
        let mut counted = Vec::new();
        if posterior.draws[0].ring_restitution.is_some() {
            let ring = posterior.summary(|draw| draw.ring_restitution.unwrap_or_default());
            let from = match self.fit.makes.labelled {
                0 => "a guess: no results",
                _ => "from the results",
            };
            counted.push(format!(
                "the ring's bounce ({:.2}, {:.2} to {:.2}, {from})",
                ring.mean, ring.low, ring.high
            ));
        }
        if self.source.unseen.constant_error.is_some() {
            counted.push("a constant error of the sensor".to_owned());
        }
        if !matches!(posterior.spin, SpinSource::Measured | SpinSource::Given) {
            counted.push("an unmeasured backspin".to_owned());
        }
        const LEFT_OUT: &str = "leave out another board, ball or air (`bankshot physics`).";
        let counts = match counted.is_empty() {
            true => format!("The intervals {LEFT_OUT}"),
            false => format!("The intervals count {}. They {LEFT_OUT}", list(&counted)),
        };
        counts + &rests_on_priors(self.fit)
    }

    fn details(&self) -> String {
        let (fit, source) = (self.fit, self.source);
        let posterior = &fit.posterior;
        let mut table = TextTable::new(&[
            ("parameter", "", Side::Left),
            ("mean", "", Side::Right),
            ("2.5 %", "", Side::Right),
            ("97.5 %", "", Side::Right),
            ("unit", "", Side::Left),
            ("source", "", Side::Left),
        ]);
        let listed = parameters(posterior, source.kind.name()).into_iter();
        for parameter in listed.map(|parameter| parameter.in_results(self.units)) {
            table.add(cells(&parameter));
        }
        let mut text = table.text();
        let mut add = |words: String| text += &paragraph(&words);
        for (index, p) in fit.probabilities.iter().enumerate() {
            add(format!(
                "Makes per 100 from {}: {}, simulation error {}.",
                self.place_name(index),
                per_100(p.interval().mean),
                simulation_error(p.numerical_standard_error())
            ));
        }
        self.add_measured(&mut add);
        if fit.makes.labelled > 0 && source.kind != Source::Makes {
            add(self.chances());
        }
        let [speed, pitch, polar, _] = posterior.prior_weights.map(|weight| 100.0 * weight);
        let bulk = posterior.bulk_effective_sample_size;
        let sizes = match source.kind {
            // The weights of the draws have one size alone.
            Source::Makes => format!("{bulk:.0}"),
            _ => {
                let tails = posterior.tail_effective_sample_size;
                format!("{bulk:.0} of the middle and {tails:.0} of the tails")
            }
        };
        add(format!(
            "Sampler: {} draws, R-hat {:.3}, effective sample size {sizes}. Weight of the prior: {speed:.0} % (speed), {pitch:.0} % (angle), {polar:.0} % (direction).",
            posterior.draws.len(),
            posterior.r_hat,
        ));
        if let Some(unseen) = posterior.unseen {
            add(format!(
                "What no sensor sees: effective sample size {:.0}, Pareto k {:.2}.",
                unseen.effective_sample_size, unseen.pareto_k
            ));
        }
        if self.source.kind != Source::Makes {
            add(tests_text(fit));
        }
        fit_checks_text(fit)
            .iter()
            .for_each(|words| add(words.clone()));
        text
    }

    /// What was measured, and how the release follows from it.
    fn add_measured(&self, add: &mut dyn FnMut(String)) {
        let (fit, source) = (self.fit, self.source);
        if !source.found.is_empty() {
            add(format!("File: {}.", source.found.join(", ")));
        }
        if source.kind == Source::Landings {
            let (unit, size) = self.units.short_length();
            add(format!(
                "Depth is measured from the front of the ring; {:.1} {unit} is its centre.",
                CENTRE_DEPTH_M / size
            ));
        }
        if let Some(residuals) = &fit.residuals {
            let shots = fit.posterior.shots;
            add(format!(
                "Flights: {shots} of {} used. Their points lie {:.2} times as far from the fitted flights as the tracker's noise predicts (chi-square {:.0}, expected {:.0}).",
                shots + source.rejected.len(),
                residuals.ratio(),
                residuals.chi_square,
                residuals.expected
            ));
        }
        if source.kind == Source::Trajectories {
            for index in 0..fit.places.len() {
                if let Some(words) = at_another_height(fit, index, self.units) {
                    add(words);
                }
            }
        }
        let of_value = value_units(self.units);
        for difference in source.differences {
            let (unit, size) = of_value[difference.value];
            add(format!(
                "Column {}: {:+.2} {unit} (standard error {:.2}) compared with the {} that the landings give under {} ({} shots).",
                difference.column,
                difference.mean / size,
                difference.standard_error / size,
                variable_name(ReleaseVariable::ALL[difference.value]),
                source.physics,
                difference.shots
            ));
        }
    }

    /// How well the chances of the measured shots predict the makes.
    fn chances(&self) -> String {
        let makes = &self.fit.makes;
        let share = &makes.share;
        let z = makes
            .made_z()
            .map_or_else(String::new, |z| format!(", z {z:+.1}"));
        let auc = makes
            .area_under_curve
            .map_or_else(|| "-".to_owned(), |auc| format!("{auc:.2}"));
        let calibration = makes.calibration_z.map_or_else(String::new, |z| {
            format!(" Calibration z {z:+.1}; above 3 the chances would be overconfident.")
        });
        let swishes = match makes.swishes {
            (0, _) => "No shot was predicted to be a swish.".to_owned(),
            (all, made) => format!("Of {all} shots predicted to be swishes, {made} went in."),
        };
        format!(
            "Counted: {} of {} ({:.1} %, 95 % interval {:.1} to {:.1}); predicted {:.1} (standard deviation {:.1}{z}). Predicted chances: Brier score {:.3} ({:.3} if every shot had the average chance), log loss {:.3} ({:.3}), AUC {auc}.{calibration} {swishes}",
            makes.made,
            makes.labelled,
            100.0 * share.share,
            100.0 * share.low,
            100.0 * share.high,
            makes.expected,
            makes.expected_sd,
            makes.brier,
            makes.losses_of_share[0],
            makes.log_loss,
            makes.losses_of_share[1]
        )
    }
}

/// A number with as many decimals as two significant digits of another one need.
fn significant(value: f64, of: f64) -> String {
    let decimals = match of.abs() {
        of if of >= 9.95 => 0,
        of if of >= 0.995 => 1,
        of if of >= 0.0995 => 2,
        _ => 3,
    };
    format!("{value:.decimals$}")
}

fn cells(parameter: &Parameter) -> [String; 6] {
    let interval = &parameter.interval;
    let [mean, low, high] =
        [interval.mean, interval.low, interval.high].map(|value| format!("{value:.3}"));
    [
        parameter.name.clone(),
        mean,
        low,
        high,
        parameter.unit.name().to_owned(),
        parameter.source.to_owned(),
    ]
}

/// The tests of one value.
fn number_of_tests(trend: &crate::fitting::SessionTrend) -> usize {
    2 + usize::from(trend.sessions_p.is_some()) + usize::from(trend.spreads_p.is_some())
}

/// The tests of the shots in a sentence, whether a warning comes of them or not.
#[must_use]
pub fn tests_text(fit: &ShooterFit) -> String {
    let all = fit.trends.iter().flat_map(|trend| {
        let name = variable_name(trend.of);
        [
            Some((format!("a drift in {name}"), trend.drift_p)),
            Some((
                format!("{name} depends on that of the shot before"),
                trend.serial_p,
            )),
            trend
                .sessions_p
                .map(|p| (format!("{name} differs between sessions"), p)),
            trend
                .spreads_p
                .map(|p| (format!("the scatter of {name} differs between sessions"), p)),
        ]
    });
    let all: Vec<(String, f64)> = all.flatten().collect();
    let least = all.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let order = least.map_or_else(String::new, |(what, p)| {
        format!(
            " Closest of {} tests of the order: {what}, {}.",
            all.len(),
            p_value(*p)
        )
    });
    format!(
        "Tests (limit {WARNING_LEVEL}): normal distribution (Mardia), skewness {}, kurtosis {}.{order}",
        p_value(fit.shape.skewness_p),
        p_value(fit.shape.kurtosis_p)
    )
}

/// How speed and angle depend on the height at which the release is taken, where balls were
/// tracked.
fn at_another_height(fit: &ShooterFit, place: usize, units: UnitSystem) -> Option<String> {
    let (long, metre) = units.length();
    let by_m = match units {
        UnitSystem::Imperial => 0.1 * FOOT_M,
        UnitSystem::Metric => 0.03,
    };
    let (at, usual) = (&fit.places[place], &fit.typical.means[place]);
    let simulator = fit.profiles[place].simulator();
    let higher = values_at_height(simulator, at, usual, at.release_height_m + by_m)?;
    Some(format!(
        "Speed and angle are those at a height of {:.2} {long}; {:.2} {long} higher they are {:.2} {long}/s and {:.1} deg less. The makes hardly depend on it.",
        at.release_height_m / metre,
        by_m / metre,
        (usual[0] - higher[0]) / metre,
        (usual[1] - higher[1]) / DEGREE_RAD
    ))
}
