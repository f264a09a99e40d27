//! `bankshot physics`: how much of the answer rests on the physics.

use crate::best_shot::{
    BestShot, NoShot, PhysicsComparison, PhysicsRow, PhysicsVariant, SameShot, SameShotProbability,
    compare_physics, physics_variants, together,
};
use crate::cli::config_files::load_profile;
use crate::cli::failure::Failure;
use crate::cli::fit_folder::{self, FitFolder};
use crate::cli::nominal_shot_flags::PlaceOptions;
use crate::cli::plot_files::{self, PlotType};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::ring_told_by_makes::ring_told_by_makes;
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::cli::value_parsers::{PhysicsArg, UnitsArg};
use crate::fitting::{
    FittedShots, Interval, Measured, ShotsUnderPhysics, advise, made_z_of_releases, wilson_interval,
};
use crate::measured_shots::source::Source;
use crate::model::{Physics, SolidId};
use crate::output::fit_files::change_in_words::changes_in_words;
use crate::output::fit_files::fit_json::interval_json;
use crate::output::json_object::object;
use crate::plots::physics_probabilities;
use crate::probability::Progress;
use crate::shooter::{NominalOverrides, NominalVariable, Profile};
use crate::units::{DEGREE_RAD, UnitSystem};
use clap::Args;
use comfy_table::{CellAlignment, LineStyle, Table, presets};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Searches the best shots under up to 25 physics: half a minute to four minutes on two cores. What nobody measured in this gym (how soft the \
ring and the board are, the friction, the drag, the height) is changed to other likely values; \"together\" is, for \
the changes that lower P and for those that raise it, the root of the sum of squares, of each quantity the change that does most. \
Of the folder of a fit it also says what the advice of `bankshot advise` gains under each physics; --json has P of the usual and of the advised shot there, and the gain, each with its 95 % interval.

Examples:
  bankshot physics player.toml
  bankshot physics robot.toml --distance '6 m'
  bankshot physics results/shots-fit --plot physics.svg")]
pub(crate) struct PhysicsOptions {
    /// The shooter's profile, or the folder of a fit.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    #[command(flatten)]
    pub(crate) location: PlaceOptions,
    /// Of a fit with several places, the number of the place [default: 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) place: Option<u32>,
    /// Draw P under each physics (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Print one JSON array (SI units).
    #[arg(long)]
    pub(crate) json: bool,
    /// Units of the output [default: the profile's].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
}

pub(crate) fn run(options: &PhysicsOptions, quiet: bool) -> Result<u8, Failure> {
    let fit = if options.profile.is_dir() {
        Some(fit_folder::read(&options.profile)?)
    } else if options.place.is_some() {
        return Err(Failure::usage(
            "--place: only the folder of a fit has places",
        ));
    } else {
        None
    };
    let place = fit
        .as_ref()
        .map_or(Ok(0), |fit| fit.place_numbered(options.place))?;
    if let Some(fit) = fit.as_ref().filter(|fit| fit.profiles.len() > 1 && !quiet) {
        print_remark(&format!(
            "the fit has {} places: this is place {}, {}",
            fit.profiles.len(),
            place + 1,
            fit.profiles[place].location().in_words(fit.units)
        ));
    }
    // A fit names its folder; its profiles are in it.
    let path = match &fit {
        Some(_) => options.profile.join(fit_folder::profile_file(place)),
        None => options.profile.clone(),
    };
    if fit.is_some() && options.location.is_given() {
        return Err(Failure::usage(format!(
            "--distance, --angle: the shots of {} were measured from their own place; give {} to move its profile",
            options.profile.display(),
            path.display()
        )));
    }
    let profile = load_profile(&path, &options.physics, quiet)?;
    let mut profile = options.location.moved(profile)?;
    if options.location.is_given() {
        profile = without_usual_shot(&profile)?;
    }
    let units_of_fit = fit.as_ref().map(|fit| fit.units);
    if let Some(units) = options.units.map(Into::into).or(units_of_fit) {
        profile = profile.with(|settings| settings.output.units = units)?;
    }
    if let Some(path) = &options.plot {
        PlotType::of(path)?;
    }
    let mut variants = physics_variants(profile.physics(), profile.output().units);
    if options.physics.physics.is_some() {
        GIVEN.clone_into(&mut variants[0].name);
    }
    let bars = ProgressBars::new(quiet);
    let mut comparison = compare_physics(&profile, &variants, &bars)?;
    let fitted = match &fit {
        Some(fit) => Some(FittedRows::new(
            (fit, place),
            &options.profile,
            &variants,
            &comparison,
            &bars,
        )?),
        None => None,
    };
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
    let told_ring = ring_told_by_makes(std::slice::from_ref(&path));
    let base = &comparison.rows[comparison.base].name;
    let base = variants.iter().find(|variant| variant.name == *base);
    let base = base.map_or(profile.physics(), |variant| &variant.physics);
    let own_ring = base.restitution_on(SolidId::Ring);
    let shares = possible_shares(&comparison, (own_ring, told_ring), fitted.as_ref());
    comparison = comparison.with_possible_shares(&shares);
    if let Some(path) = &options.plot {
        let plot = physics_probabilities::draw(&profile.shooter().name, &comparison);
        plot_files::write_one(path, &plot)?;
        if !quiet {
            print_remark(&format!("plot written to {}", path.display()));
        }
    }
    if options.json {
        let rows = rows_json(&comparison.rows, fitted.as_ref());
        print_answer(&format!("{rows:#}\n"))
    } else {
        print_prose(&comparison_text(
            (&profile, options.location.is_given()),
            &comparison,
            fitted.as_ref(),
            told_ring,
        ))
    }
}

/// The profile without the usual shot of its `[nominal]` table, which is that of its own place.
/// What its search keeps fixed stays.
fn without_usual_shot(profile: &Profile) -> Result<Profile, Failure> {
    let own = profile.nominal_overrides();
    let mut kept = NominalOverrides::default();
    for variable in NominalVariable::ALL {
        let is_searched = profile.search().choice.includes(variable);
        if let Some(value) = own.get(variable).filter(|_| !is_searched) {
            kept.set(variable, value);
        }
    }
    Ok(profile.with(|settings| settings.nominal = kept)?)
}

/// The name of the first row where --physics replaces the profile's own.
const GIVEN: &str = "as given";

/// A fit under each physics of a comparison.
struct FittedRows {
    /// The advised changes, in words; empty where nothing is advised.
    changes: String,
    measured: Measured,
    /// One for each row of the comparison.
    rows: Vec<Option<ShotsUnderPhysics>>,
    /// By how many standard deviations the makes of each ball differ from what is expected in each
    /// row, where releases were measured.
    made_z: Vec<Option<f64>>,
    /// Made and all measured shots with a result.
    observed: (usize, usize),
}

impl FittedRows {
    fn new(
        (fit, place): (&FitFolder, usize),
        folder: &Path,
        variants: &[PhysicsVariant],
        comparison: &PhysicsComparison,
        bars: &ProgressBars,
    ) -> Result<Self, Failure> {
        let profile = &fit.profiles[place];
        let advice = advise(profile, &fit.posterior, place, bars)?;
        let measured = match fit.source {
            Source::Releases => Measured::Release,
            Source::Landings | Source::Trajectories => Measured::Landing,
        };
        let shots = FittedShots::new((profile, &fit.posterior, place), &advice, measured);
        // Where a landing was measured, the release of each shot depends on the physics.
        let releases = match measured {
            // Without them only z is missing.
            Measured::Release => fit_folder::read_releases(folder, fit).unwrap_or_else(|failure| {
                print_remark(&format!("no z of the makes: {}", failure.message));
                Vec::new()
            }),
            Measured::Landing => Vec::new(),
        };
        let made_z = |physics: &Physics| {
            let places = fit.profiles.iter();
            let places = places.map(|profile| {
                let other = profile.with(|settings| settings.physics = physics.clone());
                other.ok()
            });
            let profiles: Vec<Profile> = places.collect::<Option<_>>()?;
            made_z_of_releases(&profiles, &releases, &[0.0; 4])
        };
        bars.begin("the advice under each physics", variants.len() as u64);
        let rows = comparison.rows.iter().map(|row| {
            // A variant under which the profile is not valid has no row.
            let variant = variants.iter().find(|variant| variant.name == row.name);
            let found = variant.and_then(|variant| shots.under(&variant.physics));
            let z = variant.and_then(|variant| made_z(&variant.physics));
            bars.advance(1);
            (found, z)
        });
        let (rows, made_z) = rows.unzip();
        bars.end();
        Ok(Self {
            changes: changes_in_words(&advice, profile.location().angle_rad, fit.units),
            measured,
            rows,
            made_z,
            observed: fit.observed[place],
        })
    }

    /// The interval of a value of the base row, wider by what the changes that nobody measured in
    /// this gym may do to it together.
    fn with_physics(
        &self,
        comparison: &PhysicsComparison,
        of: impl Fn(&ShotsUnderPhysics) -> Option<Interval>,
    ) -> Option<(f64, f64)> {
        let base = of(self.rows[comparison.base].as_ref()?)?;
        let rows = comparison.rows.iter().zip(&self.rows);
        let changes: Vec<(&str, f64)> = rows
            .filter(|(row, _)| row.is_unmeasured)
            .filter_map(|(row, own)| {
                let by = of(own.as_ref()?)?.mean - base.mean;
                Some((row.name.as_str(), row.possible_share * by))
            })
            .collect();
        let [down, up] = together(&changes);
        Some((
            base.mean - libm::hypot(base.mean - base.low, down),
            base.mean + libm::hypot(base.high - base.mean, up),
        ))
    }

    /// Whether the makes speak against a row: the makes of each ball where releases were measured,
    /// and else the intervals of P and of the share of makes, if they do not meet.
    fn do_makes_contradict(&self, row: usize) -> bool {
        match self.made_z[row] {
            Some(z) => z.abs() > FAR_MAKES,
            None => self.gap(row).is_some_and(|gap| gap > 0.0),
        }
    }

    /// How far the interval of P of a row is from that of the share of makes; negative where they
    /// meet.
    fn gap(&self, row: usize) -> Option<f64> {
        let (made, shots) = self.observed;
        let share = wilson_interval(made, shots);
        let usual = self.rows[row].as_ref().map(|own| own.usual);
        let usual = usual.filter(|_| shots > 0)?;
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

    /// The intervals of the fit and of the physics in one, and what the makes say.
    fn together_in_words(&self, comparison: &PhysicsComparison) -> String {
        let Some((low, high)) = self.with_physics(comparison, |own| Some(own.usual)) else {
            return String::new();
        };
        let mut text = format!(
            "With what the shots leave open and what nobody measured in this gym together, P of the usual shot{} is {low:.2} to {high:.2}",
            match comparison.base {
                0 => String::new(),
                base => format!(" under {}", comparison.rows[base].name),
            }
        );
        if let Some((low, high)) = self.with_physics(comparison, |own| Some(own.advised?[1])) {
            text += &format!(
                ", and the gain {:+.1} to {:+.1} points",
                in_points(low),
                in_points(high)
            );
        }
        text += " (95 % interval of the fit, and the changes taken together: the root of the sum of squares; a constant error of the tracker is not in it: see `bankshot fit`).\n";
        let (made, shots) = self.observed;
        if shots == 0 {
            return text;
        }
        let share = wilson_interval(made, shots);
        text += &format!(
            "Of the measured shots {made} of {shots} went in: {:.2} (95 %: {:.2} to {:.2}).",
            share.share, share.low, share.high
        );
        let rows = comparison.rows.iter().enumerate();
        let contradicted = rows.filter(|(i, _)| self.do_makes_contradict(*i));
        let contradicted: Vec<&str> = contradicted.map(|(_, row)| row.name.as_str()).collect();
        let has_z = self.made_z.iter().any(Option::is_some);
        text += &match (&contradicted[..], has_z) {
            ([], _) => " They speak against none of the rows.\n".to_owned(),
            (rows, true) => format!(
                " The makes speak against these, where the balls that went in differ by more than {FAR_MAKES:.0} standard deviations from what is expected of their releases (z in the last table): {}.\n",
                rows.join(", ")
            ),
            (rows, false) => format!(
                " They speak against these, where the intervals do not meet: {}. (A fit with --physics tells more: its z says whether the makes of each ball agree.)\n",
                rows.join(", ")
            ),
        };
        text
    }

    /// What the advice gains as far towards a row as the gym may be.
    fn possible_gain(&self, comparison: &PhysicsComparison, row: usize) -> Option<Interval> {
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
    fn gain(&self, row: usize) -> Option<Interval> {
        let [_, gain] = self.rows[row]?.advised?;
        Some(gain)
    }

    /// The usual shot and the gain under each physics, with their 95 % intervals.
    fn table(&self, comparison: &PhysicsComparison) -> Table {
        let mut header = vec!["physics", "usual\nP", "95 %"];
        if !self.changes.is_empty() {
            header.extend(["advice\ngains", "95 %"]);
        }
        let has_z = self.made_z.iter().any(Option::is_some);
        if has_z {
            header.push("z");
        }
        let mut table = table_with(header.into_iter().map(str::to_owned).collect());
        if let Some(names) = table.column_mut(0).filter(|_| has_z) {
            names.set_padding((0, 1));
        }
        for ((row, own), z) in comparison.rows.iter().zip(&self.rows).zip(&self.made_z) {
            let interval = |of: Option<Interval>, text: &dyn Fn(f64) -> String| {
                of.map_or(["-".to_owned(), "-".to_owned()], |of| {
                    [
                        text(of.mean),
                        format!("{} to {}", text(of.low), text(of.high)),
                    ]
                })
            };
            let mut cells = vec![row.name.clone()];
            let usual = own.as_ref().map(|own| own.usual);
            // Room for z in 80 columns.
            let [p_decimals, gain_decimals] = if has_z { [2, 0] } else { [3, 1] };
            cells.extend(interval(usual, &|p| format!("{p:.p_decimals$}")));
            if !self.changes.is_empty() {
                let gain = own.as_ref().and_then(|own| Some(own.advised?[1]));
                cells.extend(interval(gain, &|p| {
                    format!("{:+.gain_decimals$}", in_points(p))
                }));
            }
            if has_z {
                cells.push(z.map_or("-".to_owned(), |z| format!("{z:+.1}")));
            }
            table.add_row(cells);
        }
        table
    }

    /// Whether the advice is sure under the physics that nobody measured in this gym.
    fn is_sure_in_words(&self, comparison: &PhysicsComparison) -> String {
        if self.changes.is_empty() {
            return "`bankshot advise` advises no change to this shooter.\n".to_owned();
        }
        let names = |wanted: &dyn Fn(Option<Interval>) -> bool| {
            let rows = comparison.rows.iter().enumerate();
            let rows = rows
                .filter(|(i, row)| row.is_unmeasured && wanted(self.possible_gain(comparison, *i)));
            rows.map(|(_, row)| change(row)).collect::<Vec<_>>()
        };
        let unsure = names(&|gain| gain.is_some_and(|gain| gain.low <= 0.0));
        let unknown = names(&|gain| gain.is_none());
        let of = match comparison.base {
            0 => "what nobody measured in this gym",
            _ => "ncaa in what nobody measured in this gym (the fit's physics has no air)",
        };
        let as_far = match comparison.rows.iter().any(PhysicsRow::is_ruled_out) {
            true => ", as far as the makes leave it",
            false => "",
        };
        let mut text = match (&unsure[..], &unknown[..]) {
            ([], []) => format!(
                "The advice holds under each change of {of}{as_far}: the 95 % interval of its gain lies above 0.\n"
            ),
            ([], _) => String::new(),
            _ => format!(
                "The advice is not sure under some changes of {of}: {}. There the 95 % interval of its gain reaches below 0.\n",
                unsure.join(", ")
            ),
        };
        if !unknown.is_empty() {
            text += &format!("No gain could be computed with {}.\n", unknown.join(", "));
        }
        let lost: Vec<String> = (1..comparison.rows.len())
            .filter(|&i| !comparison.rows[i].is_unmeasured && !self.do_makes_contradict(i))
            .filter(|&i| self.gain(i).is_some_and(|gain| gain.low <= 0.0))
            .map(|i| change(&comparison.rows[i]))
            .collect();
        if !lost.is_empty() {
            text += &format!(
                "(With other balls, hoops or air it does not gain for sure, or loses: {}. They matter only where one of them is yours.)\n",
                lost.join(", ")
            );
        }
        text
    }

    /// What the advice gains under the physics of the profile, and under those that nobody measured
    /// in this gym; empty where nothing is advised.
    fn gains_in_words(&self, comparison: &PhysicsComparison) -> String {
        if self.changes.is_empty() {
            return String::new();
        }
        let points = |gain: &Interval| {
            let [mean, low, high] = [gain.mean, gain.low, gain.high].map(in_points);
            format!("{mean:+.1} points (95 %: {low:+.1} to {high:+.1})")
        };
        let mut text = format!("The advice ({})", self.changes);
        if let Some(own) = self.gain(0) {
            text += &format!(" gains {} under the first row's physics", points(&own));
        }
        let rows = comparison.rows.iter().enumerate();
        let unmeasured = rows.filter(|(_, row)| row.is_unmeasured);
        let gains: Vec<(String, Interval)> = unmeasured
            .filter_map(|(i, row)| Some((possible_change(row), self.possible_gain(comparison, i)?)))
            .collect();
        let by_mean =
            |a: &&(String, Interval), b: &&(String, Interval)| a.1.mean.total_cmp(&b.1.mean);
        let ends = [gains.iter().min_by(by_mean), gains.iter().max_by(by_mean)];
        if let [Some(least), Some(most)] = ends {
            text += &format!(
                "; of the changes that nobody measured, least {} with {}, most {} with {}",
                points(&least.1),
                least.0,
                points(&most.1),
                most.0
            );
        }
        text += match self.measured {
            Measured::Release => ". The measured release is the same in every row.\n",
            Measured::Landing => {
                ". What was measured is how the ball falls to the hoop: it does so in every row, and the release is the one that leads there.\n"
            }
        };
        text
    }
}

/// Makes farther from what is expected, in standard deviations, speak against a physics: about 1 of
/// 400 tests by luck.
const FAR_MAKES: f64 = 3.0;

/// How far towards each row the gym may be, 0 to 1: as far as the makes of the fitted shots, and
/// the ring that `--free` found, leave it. `own_ring` is the restitution of the base row's.
fn possible_shares(
    comparison: &PhysicsComparison,
    (own_ring, told_ring): (f64, Option<(f64, f64)>),
    fitted: Option<&FittedRows>,
) -> Vec<f64> {
    let of_row = |(i, row): (usize, &PhysicsRow)| {
        if !row.is_unmeasured {
            return 1.0;
        }
        let by_makes = fitted.map_or(1.0, |fitted| fitted.possible_share(comparison.base, i));
        let restitution = row.name.split_once("hoop_restitution ");
        let restitution = restitution.and_then(|(_, value)| value.parse::<f64>().ok());
        let by_ring = restitution
            .zip(told_ring)
            .map_or(1.0, |(ring, (low, high))| {
                let end = ring.clamp(low, high);
                ((end - own_ring) / (ring - own_ring)).clamp(0.0, 1.0)
            });
        by_makes.min(by_ring)
    };
    comparison.rows.iter().enumerate().map(of_row).collect()
}

/// Which of the changes that nobody measured are ruled out, and what that means.
fn ruled_out_in_words(comparison: &PhysicsComparison, told_ring: Option<(f64, f64)>) -> String {
    let rows = comparison.rows.iter();
    let ruled_out: Vec<String> = rows
        .filter(|row| row.is_ruled_out())
        .map(|row| format!("{} ({:.0} %)", change(row), 100.0 * row.possible_share))
        .collect();
    if ruled_out.is_empty() {
        return String::new();
    }
    let ring = told_ring.map_or_else(String::new, |(low, high)| {
        format!(" (the ring's restitution is {low:.2} to {high:.2}, as `fit --free` found)")
    });
    format!(
        "The makes of the measured shots rule some changes out{ring}; every range goes only as far towards them as the makes leave it: {}.\n",
        ruled_out.join(", ")
    )
}

/// What a row changes: `hoop_restitution 0.41` of `with hoop_restitution 0.41`, or of `ncaa,
/// hoop_restitution 0.41` where the profile's physics has no air.
fn change(row: &PhysicsRow) -> String {
    let words = row.name.split_once(' ');
    words.map_or(row.name.clone(), |(_, change)| change.to_owned())
}

/// The same as far as the gym may have it: `56 % of the way to drag_coefficient 0.54`.
fn possible_change(row: &PhysicsRow) -> String {
    match row.is_ruled_out() {
        true => format!(
            "{:.0} % of the way to {}",
            100.0 * row.possible_share,
            change(row)
        ),
        false => change(row),
    }
}

/// A difference of P in makes of 100, rounded. (0 is added: no negative zero.)
fn in_points(p: f64) -> f64 {
    libm::round(1000.0 * p) / 10.0 + 0.0
}

/// A table whose first column is text, and the others numbers.
fn table_with(header: Vec<String>) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()));
    table.set_header(header);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

fn comparison_text(
    (profile, is_moved): (&Profile, bool),
    comparison: &PhysicsComparison,
    fitted: Option<&FittedRows>,
    told_ring: Option<(f64, f64)>,
) -> String {
    let has_air = profile.physics().air.density_kg_m3 > 0.0;
    let units = profile.output().units;
    let (long, metre) = units.length();
    let (short, short_m) = match units {
        UnitSystem::Imperial => ("in", 0.0254),
        UnitSystem::Metric => ("cm", 0.01),
    };
    let mut table = table_with(vec![
        "physics".to_owned(),
        "direct\nP".to_owned(),
        format!("speed\n{long}/s"),
        "pitch\ndeg".to_owned(),
        format!("past\n{short}"),
        "bank\nP".to_owned(),
        "same\nshot P".to_owned(),
    ]);
    let p = |shot: &Result<BestShot, NoShot>| match shot {
        Ok(shot) => format!("{:.3}", shot.estimate.probability),
        Err(_) => "none".to_owned(),
    };
    for row in &comparison.rows {
        let nominal = row.direct.as_ref().ok().map(|shot| shot.nominal);
        let number = |value: Option<f64>, digits: usize| {
            value.map_or("-".to_owned(), |value| format!("{value:.digits$}"))
        };
        table.add_row(vec![
            row.name.clone(),
            p(&row.direct),
            number(nominal.map(|shot| shot.speed_m_s / metre), 2),
            number(nominal.map(|shot| shot.pitch_rad / DEGREE_RAD), 1),
            number(row.aim_past_centre_m.map(|aim_m| aim_m / short_m), 1),
            p(&row.bank),
            number(row.same_shot.map(|p| p.probability), 3),
        ]);
    }
    let mut answer = comparison
        .in_words()
        .map_or_else(String::new, |words| words + "\n\n");
    answer += &ruled_out_in_words(comparison, told_ring);
    if let Some(fitted) = fitted {
        answer += &format!(
            "{}\n{}\n",
            fitted.together_in_words(comparison),
            fitted.is_sure_in_words(comparison)
        );
    }
    let error = comparison.greatest_standard_error();
    let last_column = format!(
        "the P of {}, {}.\n",
        comparison.same_shot.in_words(),
        comparison.same_shot.what_stays()
    );
    let of_fit = match fitted {
        Some(fitted) => format!(
            "\nP of the usual shot, and what the advice adds in makes of 100, with 95 % intervals of what the fit leaves open:\n{}\n{}",
            fitted.table(comparison).trim_fmt(),
            fitted.gains_in_words(comparison)
        ),
        None if is_moved => "\n(Of a profile that was fitted to landings or trajectories the speeds were derived with the physics; here the scatter stays the same in each row.)\n".to_owned(),
        None => "\n(Of a profile that was fitted to landings or trajectories, give the folder of the fit: its speeds were derived with the physics, and change with it.)\n".to_owned(),
    };
    let first_row = match comparison.rows.first() {
        Some(row) if row.name == GIVEN => "The first row is the physics of --physics",
        _ => "The first row is the profile's own physics",
    };
    format!(
        "{answer}{}\n{}\nEach P has a numerical standard error of at most {error:.4}. {first_row}; \"{}\" changes one thing of {}. past: of the ring's centre. The last column is {last_column}{of_fit}",
        table.trim_fmt(),
        changes_text(comparison),
        if has_air { "with" } else { "ncaa," },
        if has_air { "it" } else { "ncaa" },
    )
}

/// What each change that nobody measured does to P of the best direct shot and of the usual one.
fn changes_text(comparison: &PhysicsComparison) -> String {
    // Of the kind that is the better one.
    let base = &comparison.rows[comparison.base];
    let [direct, bank] = [
        PhysicsComparison::direct_p(base),
        PhysicsComparison::bank_p(base),
    ];
    let (title, best) = match bank > direct {
        true => (
            "best\nbank shot",
            comparison.unmeasured_changes(PhysicsComparison::bank_p),
        ),
        false => (
            "best\ndirect shot",
            comparison.unmeasured_changes(PhysicsComparison::direct_p),
        ),
    };
    let same = comparison.unmeasured_changes(PhysicsComparison::same_shot_p);
    if best.is_empty() && same.is_empty() {
        return String::new();
    }
    let of = |changes: &[(&str, f64)], name: &str| {
        let change = changes.iter().find(|(of, _)| *of == name);
        change.map_or("-".to_owned(), |(_, by)| format!("{:+.1}", in_points(*by)))
    };
    let header = ["change", title, "same\nshot"];
    let mut table = table_with(header.map(str::to_owned).to_vec());
    // Those that do most first.
    let most = |name: &str| {
        let both = best.iter().chain(&same);
        let of_name = both.filter(|(of, _)| *of == name);
        of_name.fold(0.0_f64, |most, (_, by)| most.max(by.abs()))
    };
    let rows = comparison.rows.iter().filter(|row| row.is_unmeasured);
    let mut names: Vec<&str> = rows.map(|row| row.name.as_str()).collect();
    names.sort_by(|a, b| most(b).total_cmp(&most(a)));
    for &name in &names {
        let change = name.split_once(' ').map_or(name, |(_, change)| change);
        let row = comparison.rows.iter().find(|row| row.name == name);
        let change = row.map_or_else(|| change.to_owned(), possible_change);
        table.add_row(vec![change, of(&best, name), of(&same, name)]);
    }
    let ring_is_asked = names.iter().any(|name| name.contains("hoop_restitution"));
    let both = [&best, &same].map(|changes| {
        let [down, up] = together(changes).map(|by| libm::round(100.0 * by) + 0.0);
        format!("{down:+.0} to {up:+.0}")
    });
    let [of_best, of_same] = both;
    table.add_row(vec!["together about".to_owned(), of_best, of_same]);
    format!(
        "\nWhat nobody measured in this gym, by what it does to P, in makes of 100{}:\n{}\n",
        match ring_is_asked {
            true => {
                " (`bankshot fit SHOTS --free hoop_restitution` finds that one from made and missed)"
            }
            false => "",
        },
        table.trim_fmt()
    )
}

fn rows_json(rows: &[PhysicsRow], fitted: Option<&FittedRows>) -> Value {
    let shot = |shot: &Result<BestShot, NoShot>| match shot {
        Ok(shot) => json!({
            "probability": shot.estimate.probability,
            "standard_error": shot.estimate.standard_error,
            "speed_m_s": shot.nominal.speed_m_s,
            "pitch_rad": shot.nominal.pitch_rad,
            "polar_rad": shot.nominal.polar_rad,
            "backspin_rad_s": shot.nominal.backspin_rad_s,
        }),
        Err(reason) => json!({ "none": reason.to_string() }),
    };
    let of_fit = |i: usize| {
        let row = fitted.and_then(|fitted| Some((fitted.rows[i].as_ref()?, fitted.made_z[i])));
        row.map(|(row, made_z)| {
            let [advised, gain] = match &row.advised {
                Some(advised) => advised.map(|p| object(interval_json(&p))),
                None => [Value::Null, Value::Null],
            };
            json!({
                "usual_probability": object(interval_json(&row.usual)),
                "advised_probability": advised,
                "gain": gain,
                "made_z": made_z,
            })
        })
    };
    rows.iter()
        .enumerate()
        .map(|(i, row)| {
            json!({
                "physics": row.name,
                "direct": shot(&row.direct),
                "bank": shot(&row.bank),
                "aim_past_centre_m": row.aim_past_centre_m,
                "same_shot_probability": row.same_shot.map(|p| p.probability),
                "fit": of_fit(i),
            })
        })
        .collect()
}
