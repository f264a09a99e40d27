//! `bankshot table`: best shots for a grid of places, for a machine.

use crate::answers::csv::csv;
use crate::answers::json::{self, document};
use crate::answers::table_rows::place_rows;
use crate::best_shot::{
    ShotKind, ShotTable, ShotTableError, ShotTableRequest, TableFinding, TableKind,
};
use crate::cli::failure::{Failure, code};
use crate::cli::fixed_value_flags::FixedOptions;
use crate::cli::loaded_profile::LoadedProfile;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::scatter_flags::ScatterOptions;
use crate::cli::signals;
use crate::cli::terminal::{
    has_details, is_quiet, print_answer, print_hint, print_remark, time_in_words,
};
use crate::cli::value_lists::ascending_values;
use crate::cli::value_parsers::{PhysicsArg, UnitsArg};
use crate::files::atomic_file;
use crate::present::shot_table_files::notes;
use crate::present::shot_table_files::source_code::{
    Language, is_class_name, namespace_of, source_code,
};
use crate::present::shot_table_files::table_answer::table_answer;
use crate::present::shot_table_files::table_text::table_text;
use crate::present::shot_table_files::unfinished::UnfinishedTable;
use crate::shooter::{Location, NominalVariable, Profile};
use crate::units::Dimension;
use clap::{Args, ValueEnum};
use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args, Debug)]
#[command(after_help = "\
Distances and angles are a list, or a range with a step. Start with --draft: half a second for each place.

Without --draft the table is checked between its rows, where a machine interpolates. Where that costs more than --max-loss, rows are added halfway. Fifteen distances with a fixed angle take ten seconds to a minute on two cores. With --kind best it takes twice as long; with --max-loss 1, half as long. --least-probability 0.6 skips the places where fewer than 60 of 100 go in.

With --output a stopped table is not lost: its results are kept beside the file, and the same command continues.

Examples:
  bankshot table robot.toml --distances '7 ft to 20 ft by 1 ft' \\
    --pitch '60 deg' --backspin '2 rev/s'
  bankshot table robot.toml --distances '8 ft, 12 ft, 16 ft' \\
    --angles '0 deg to 60 deg by 15 deg' --kind bank
  bankshot table robot.toml --distances '6 ft to 20 ft by 1 ft' --kind best \\
    -o ShotTable.java -o table.csv")]
pub(crate) struct TableOptions {
    /// The launcher's profile.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// Distances from the hoop's centre: '6 ft, 8 ft' or '6 ft to 20 ft by 1 ft'.
    #[arg(long, value_name = "LIST|RANGE", allow_hyphen_values = true)]
    pub(crate) distances: String,
    /// Court angles [default: the profile's].
    #[arg(long, value_name = "LIST|RANGE", allow_hyphen_values = true)]
    pub(crate) angles: Option<String>,
    /// The kind of the shots; best: the better kind at each distance (needs one court angle).
    #[arg(long, value_enum, default_value_t = KindArg::Direct)]
    pub(crate) kind: KindArg,
    #[command(flatten)]
    pub(crate) fixed: FixedOptions,
    #[command(flatten)]
    pub(crate) scatter: ScatterOptions,
    /// Add rows until interpolating between them costs at most this much (0.01 is 1 make per 100)
    /// and interpolated probabilities are off by at most as much. 1 adds no rows, except where the
    /// better kind changes.
    #[arg(long, value_name = "PROBABILITY", default_value_t = 0.01, value_parser = share)]
    pub(crate) max_loss: f64,
    /// Where the probability is below this, check nothing and add no rows: many would be added at
    /// the end of a launcher's reach.
    #[arg(long, value_name = "PROBABILITY", default_value_t = 0.0, value_parser = share, conflicts_with = "draft")]
    pub(crate) least_probability: f64,
    /// A first look in a fraction of the time: do not check between the places, and add no
    /// rows (except where the better kind changes).
    #[arg(long, conflicts_with = "max_loss")]
    pub(crate) draft: bool,
    /// The form of the table [default: by the end of the output's name, else text].
    #[arg(long, value_enum)]
    pub(crate) format: Option<TableFormat>,
    /// Write the table into a file; may be repeated, for several forms of one table. (A Java class
    /// has the name of its file.)
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Vec<PathBuf>,
    /// Units of the table [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
}

/// The kinds of shots by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum KindArg {
    Direct,
    Bank,
    /// The better one.
    Best,
}

impl From<KindArg> for TableKind {
    fn from(kind: KindArg) -> Self {
        match kind {
            KindArg::Direct => Self::One(ShotKind::Direct),
            KindArg::Bank => Self::One(ShotKind::Bank),
            KindArg::Best => Self::Better,
        }
    }
}

/// The forms of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// For people.
    Text,
    Csv,
    Json,
    /// A class that looks shots up.
    Java,
    /// A header that looks shots up.
    Cpp,
    /// A module that looks shots up.
    Python,
}

impl TableFormat {
    /// The form that the end of a file's name asks for.
    pub(super) fn of_output(path: &Path) -> Result<Self, Failure> {
        match path.extension().and_then(OsStr::to_str).unwrap_or("") {
            "csv" => Ok(Self::Csv),
            "json" => Ok(Self::Json),
            "java" => Ok(Self::Java),
            "h" | "hpp" | "hh" | "cpp" => Ok(Self::Cpp),
            "py" => Ok(Self::Python),
            "txt" | "md" | "" => Ok(Self::Text),
            other => Err(Failure::usage(format!(
                "--output: no form for \".{other}\"; use .csv, .json, .java, .hpp (.h, .hh, .cpp), .py or .txt, or give --format"
            ))),
        }
    }
}

pub(crate) fn run(options: &TableOptions) -> Result<u8, Failure> {
    let fixed = options.fixed.variables();
    let loaded = LoadedProfile::read_and_warn(&options.profile, &options.physics, &fixed)?;
    let loaded = options.scatter.changed(loaded)?.in_units(options.units)?;
    let profile = loaded.profile;
    let request = request(options, &profile)?;
    let outputs = outputs(options)?;
    if request.kind == TableKind::Better && request.angles_rad.len() > 1 {
        return Err(ShotTableError::SeveralAngles.into());
    }
    let mut unfinished = match &outputs[0].file {
        // A pipe or a device has no folder of its own.
        Some(file) if !file.exists() || file.is_file() => {
            Some(unfinished_table(file, &profile, &request)?)
        }
        _ => None,
    };
    let table = compute(&profile, &request, unfinished.as_mut())?;
    write(&outputs, &table, &profile)?;
    if let Some(unfinished) = unfinished {
        // What stays is thrown away by the next table.
        let _ = unfinished.remove();
    }
    if !is_quiet() {
        print_remarks(options, &outputs, &table, &profile, &request);
    }
    match missing_places(&table) {
        0 => Ok(code::DONE),
        missing => {
            print_hint(&format!(
                "no exact shot goes in from {missing} of the places, so they have no values (exit code {}); `bankshot best --distance` shows the most probable shot there",
                code::INCOMPLETE
            ));
            Ok(code::INCOMPLETE)
        }
    }
}

/// What the options ask for. A value that cannot be is named with its flag and number.
fn request(options: &TableOptions, profile: &Profile) -> Result<ShotTableRequest, Failure> {
    let distances_m = ascending_values("distances", &options.distances, Dimension::Length)?;
    let angles_rad = match &options.angles {
        Some(text) => ascending_values("angles", text, Dimension::Angle)?,
        None => vec![profile.location().angle_rad],
    };
    for (d, distance_m) in distances_m.iter().enumerate() {
        for (a, angle_rad) in angles_rad.iter().enumerate() {
            let place = Location {
                distance_m: *distance_m,
                angle_rad: *angle_rad,
            };
            place.check(profile.physics()).map_err(|error| {
                let (flag, k) = match error.key() {
                    "distance" => ("distances", d),
                    _ => ("angles", a),
                };
                Failure::usage(format!("--{flag}: value {}: {error}", k + 1))
            })?;
        }
    }
    Ok(ShotTableRequest {
        kind: options.kind.into(),
        distances_m,
        angles_rad,
        fixed: options.fixed.values(profile)?,
        max_loss: options.max_loss,
        least_probability: options.least_probability,
        is_draft: options.draft,
    })
}

/// Writes the table in each of the forms.
fn write(outputs: &[Output], table: &ShotTable, profile: &Profile) -> Result<(), Failure> {
    let units = profile.output().units;
    for output in outputs {
        let source = |language| source_code(table, (language, &output.class), (profile, units));
        let text = match output.format {
            TableFormat::Text => {
                let has_details = has_details() || output.file.is_some();
                table_text(table, profile, units).text(has_details)
            }
            TableFormat::Csv => csv(&place_rows(table), units),
            TableFormat::Json => {
                let answer = table_answer(table, profile, units);
                json::text(&document(&answer, units))
            }
            TableFormat::Java => source(Language::Java),
            TableFormat::Cpp => source(Language::Cpp),
            TableFormat::Python => source(Language::Python),
        };
        match output.file {
            None => {
                print_answer(&text)?;
            }
            Some(file) => atomic_file::write(file, text.as_bytes())
                .map_err(|error| Failure::io(file.display(), &error))?,
        }
    }
    Ok(())
}

/// Says what was written, and what the forms without text leave out.
fn print_remarks(
    options: &TableOptions,
    outputs: &[Output],
    table: &ShotTable,
    profile: &Profile,
    request: &ShotTableRequest,
) {
    for file in &options.output {
        print_remark(&format!("written: {}", file.display()));
    }
    let mut formats = outputs.iter().map(|output| output.format);
    if formats.all(|format| format != TableFormat::Text) {
        for note in notes(table, profile, profile.output().units) {
            print_remark(&note);
        }
    }
    if table.worst().is_some_and(|worst| worst > request.max_loss) {
        print_remark(&great_loss_warning(profile, request));
    }
}

/// Opens the file beside `output` that keeps what is found, and says that it does.
fn unfinished_table(
    output: &Path,
    profile: &Profile,
    request: &ShotTableRequest,
) -> Result<UnfinishedTable, Failure> {
    let path = UnfinishedTable::path_beside(output);
    let failure = |error| Failure::io(path.display(), &error);
    let identity = UnfinishedTable::identity(profile, request)
        .map_err(|error| failure(io::Error::other(error)))?;
    let unfinished = UnfinishedTable::open(&path, &identity).map_err(|error| {
        if error.kind() == io::ErrorKind::NotFound {
            Failure::io(output.display(), &error)
        } else {
            failure(error)
        }
    })?;
    if unfinished.has_replaced() {
        print_hint(&format!(
            "begins anew: what {} had kept was of another table (profile, request or program)",
            path.display()
        ));
    }
    let places = places_of(unfinished.known());
    if places > 0 {
        print_hint(&format!(
            "goes on with the {places} places that were computed before ({})",
            path.display()
        ));
    }
    signals::set_exit_remark(move || {
        format!(
            "stopped: what was computed is kept in {}; the same command goes on with it",
            path.display()
        )
    });
    Ok(unfinished)
}

/// The number of places whose best shots are among some findings.
fn places_of(findings: &[TableFinding]) -> usize {
    let is_shot = |finding: &&TableFinding| matches!(finding, TableFinding::Shot { .. });
    findings.iter().filter(is_shot).count()
}

/// Computes the table, and keeps what it finds on the way.
fn compute(
    profile: &Profile,
    request: &ShotTableRequest,
    mut unfinished: Option<&mut UnfinishedTable>,
) -> Result<ShotTable, Failure> {
    let known = match &mut unfinished {
        Some(unfinished) => unfinished.take_known(),
        None => Vec::new(),
    };
    let mut failed = false;
    let mut forecast = TimeForecast::new(request, places_of(&known));
    let mut keep = |finding: &TableFinding| {
        if matches!(finding, TableFinding::Shot { .. })
            && let Some(words) = forecast.after_a_place()
        {
            print_hint(&words);
        }
        if let Some(unfinished) = &mut unfinished
            && !failed
            && let Err(error) = unfinished.keep(finding)
        {
            failed = true;
            print_remark(&format!(
                "warning: what is computed cannot be kept ({error}); a stopped table begins anew"
            ));
        }
    };
    let progress = ProgressBars::new();
    let table = ShotTable::resume((profile, request), &known, &mut keep, &progress)?;
    Ok(table)
}

/// About how long a table takes, told by its first places.
struct TimeForecast {
    began: Instant,
    computed: usize,
    /// Searches for a shot.
    searches: usize,
}

impl TimeForecast {
    /// It is told after so many places.
    const PLACES: usize = 3;
    /// A shorter time is not told.
    const LEAST_S: f64 = 20.0;

    /// That of a table of which `known` shots were found before.
    fn new(request: &ShotTableRequest, known: usize) -> Self {
        let nodes = request.distances_m.len() * request.angles_rad.len();
        let kinds = match request.kind {
            TableKind::One(_) => 1,
            TableKind::Better => 2,
        };
        // The shots between the nodes are searched too.
        let of_node = if request.is_draft { 1 } else { 2 };
        Self {
            began: Instant::now(),
            computed: 0,
            searches: (nodes * kinds * of_node).saturating_sub(known),
        }
    }

    /// What to say after one more place.
    fn after_a_place(&mut self) -> Option<String> {
        self.computed += 1;
        let each_s = self.began.elapsed().as_secs_f64() / self.computed as f64;
        let whole_s = each_s * self.searches as f64;
        (self.computed == Self::PLACES && whole_s > Self::LEAST_S).then(|| {
            format!(
                "the searches take about {}; the checks between the places, ends of the shots and added places come on top",
                time_in_words(whole_s)
            )
        })
    }
}

/// The number of places without a shot, of those that were asked for.
fn missing_places(table: &ShotTable) -> usize {
    let mut missing = 0;
    for (a, angle_rad) in table.angles_rad.iter().enumerate() {
        for (d, distance_m) in table.distances_m.iter().enumerate() {
            let is_added = table.added_distances_m.contains(distance_m)
                || table.added_angles_rad.contains(angle_rad);
            missing += usize::from(!is_added && table.at(a, d).is_none());
        }
    }
    missing
}

/// Where a table goes, and in which form.
struct Output<'a> {
    /// None for standard output.
    file: Option<&'a Path>,
    format: TableFormat,
    /// The name of the class or namespace in a source.
    class: String,
}

fn outputs(options: &TableOptions) -> Result<Vec<Output<'_>>, Failure> {
    if options.output.is_empty() {
        return Ok(vec![Output {
            file: None,
            format: options.format.unwrap_or(TableFormat::Text),
            class: source_name(None, options.format.unwrap_or(TableFormat::Text))?,
        }]);
    }
    if options.format.is_some() && options.output.len() > 1 {
        return Err(Failure::usage(
            "--format: with several outputs the end of each name tells its form; leave --format out",
        ));
    }
    options
        .output
        .iter()
        .map(|file| {
            let format = match (options.format, TableFormat::of_output(file)) {
                    (Some(format), Ok(of_name))
                        if format != of_name && file.extension().is_some() =>
                    {
                        return Err(Failure::usage(format!(
                            "--format: the name {} asks for another form; leave --format out, or name the file otherwise",
                            file.display()
                        )));
                    }
                    (Some(format), _) => format,
                    (None, of_name) => of_name?,
                };
            Ok(Output {
                file: Some(file.as_path()),
                format,
                class: source_name(Some(file.as_path()), format)?,
            })
        })
        .collect()
}

/// The name of a Java class or of a C++ namespace: that of the file, where it has one.
fn source_name(path: Option<&Path>, format: TableFormat) -> Result<String, Failure> {
    let stem = path.and_then(Path::file_stem);
    let (Some(path), Some(stem)) = (path, stem) else {
        let name = if format == TableFormat::Cpp {
            "shot_table"
        } else {
            "ShotTable"
        };
        return Ok(name.to_owned());
    };
    let name = stem.to_string_lossy();
    if format == TableFormat::Cpp {
        return Ok(namespace_of(&name));
    }
    if path.extension().is_none_or(|end| end != "java") {
        return Ok("ShotTable".to_owned());
    }
    if is_class_name(&name) {
        Ok(name.into_owned())
    } else {
        Err(Failure::usage(format!(
            "--output: \"{}\" is the name of no Java class; use letters, digits and _, such as ShotTable.java",
            path.display()
        )))
    }
}

/// A share from 0 to 1.
fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1.0).contains(&value) => Ok(value),
        _ => Err("give a number from 0 to 1".to_owned()),
    }
}

/// What to do where interpolation costs much: neighbours are then shots of different sorts, unless
/// what they differ in is fixed.
fn great_loss_warning(profile: &Profile, request: &ShotTableRequest) -> String {
    let is_fixed = |variable| {
        !profile.search().choice.includes(variable)
            || request.fixed.iter().any(|(fixed, _)| *fixed == variable)
    };
    let free: Vec<String> = [NominalVariable::Pitch, NominalVariable::Backspin]
        .into_iter()
        .filter(|variable| !is_fixed(*variable))
        .map(|variable| format!("--{}", variable.name()))
        .collect();
    let fix = if free.is_empty() {
        String::new()
    } else {
        format!(", or fix {}", free.join(" and "))
    };
    format!(
        "warning: between some places interpolation costs more than {} of 100 shots; take a smaller step{fix}",
        100.0 * request.max_loss
    )
}
