//! The options of commands that read measured shots.

use super::config_files::{load_physics, read_text};
use super::failure::{Failure, refuse_missing};
use super::profile_flags::{court, location_named};
use super::progress_bars::ProgressBars;
use super::terminal::{confirm, is_quiet, print_remark};
use super::value_parsers::UnitsArg;
use crate::answers::fit::FitSource;
use crate::dynamics::Simulator;
use crate::fitting::{
    AimPrior, DragEstimate, FitNote, FitOptions, PopulationPrior, RINGS_OF_GYMS, ShooterFit,
    ShooterFitError, ShooterTest, Tails, TrackedPoint, Tracker, TrackerNoise, UnseenPrior,
    fit_drag_coefficient, fit_shooters, tails_of,
};
use crate::measured_shots::column_map_proposal::{Proposal, map_proposal, names_sessions};
use crate::measured_shots::columns::{Columns, Label};
use crate::measured_shots::court_frame::{CourtFrame, OntoCourt};
use crate::measured_shots::decisions::{Decisions, can_be_sessions, decide, session_name};
use crate::measured_shots::read::{read, tracker_by_flights};
use crate::measured_shots::session_days::DateOrder;
use crate::measured_shots::shooter_shots::{ReadOptions, ShooterShots};
use crate::measured_shots::source::Source;
use crate::measured_shots::table::Table;
use crate::model::league_courts::League;
use crate::model::{DEFAULT_PRESET, Physics, SolidId};
use crate::probability::{Progress, Pulse};
use crate::units::{self, Dimension, UnitSystem};
use clap::Args;
use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};
use toml_edit::DocumentMut;

/// What a file of measured shots does not say by itself.
#[derive(Args, Clone, Debug)]
pub(crate) struct MeasuredShotsOptions {
    /// The physics: a preset (paper, ncaa, ncaa_women, nba, wnba, fiba, fiba_women, youth), or a
    /// TOML file with a [physics] table [default: ncaa, the men's college ball and hoop].
    #[arg(long, value_name = "PRESET|FILE")]
    pub(crate) physics: Option<String>,
    /// The tracker that measured the shots: lab, noah, optical_25hz, optical_60hz, or a TOML file
    /// with its noise as standard deviations. Of releases: speed = "0.05 ft/s", pitch, polar,
    /// backspin; of landings: depth = "0.5 in", left_right, entry_angle; of trajectories: position
    /// [default: lab for
    /// releases, noah for landings; for trajectories the frame rate and noise that they show].
    #[arg(long, value_name = "NAME|FILE")]
    pub(crate) tracker: Option<String>,
    /// Which column holds a quantity, where its name differs: QUANTITY=COLUMN:UNIT, such as
    /// 'speed=ReleaseSpeed:mph' or 'made=Result'. A minus before COLUMN reverses the sign, a number
    /// after UNIT is added: 'left_right=-Left:in', 'depth=PastCentre:in+9'; 'unused=COLUMN' leaves
    /// a column out. May be repeated; @FILE is a file of such maps, one a line.
    #[arg(long, value_name = "MAP")]
    pub(crate) map: Vec<String>,
    /// Take the columns as bankshot proposes them: a file whose columns have other names is refused
    /// with a proposal first.
    #[arg(long)]
    pub(crate) accept: bool,
    /// Fit only this player, for a file with several.
    #[arg(long, value_name = "NAME")]
    pub(crate) shooter: Option<String>,
    /// Fit only this session, for a file with a column "session". Repeatable; `compare` compares
    /// two.
    #[arg(long, value_name = "NAME")]
    pub(crate) session: Vec<String>,
    /// Order of day and month in dates such as 03/04/2025.
    #[arg(long, value_name = "ORDER")]
    pub(crate) dates: Option<DatesArg>,
    /// The text of a make in the results column, such as 1; all other rows, also blank ones, are
    /// misses.
    #[arg(long, value_name = "VALUE")]
    pub(crate) made: Option<String>,
    /// Coordinates of trajectories: hoop (x from the hoop's centre along the court, y to the right
    /// as you face the hoop) or court_94x50 (from a corner). z is up from the floor.
    #[arg(long, value_name = "FRAME", default_value = "hoop")]
    pub(crate) frame: String,
    /// Instead of --frame: where the hoop's centre is in the coordinates of the file, and the
    /// direction that leads from it onto the court (+x, -x, +y or -y), such as '5.25 ft,25 ft,+x'.
    /// The coordinates must be right-handed: facing +x, +y is to the left.
    #[arg(long, value_name = "X,Y,DIRECTION", allow_hyphen_values = true)]
    pub(crate) hoop: Option<String>,
    /// The place of all shots by its name, such as 'free throw' or 'left elbow', where the file
    /// does not say it.
    #[arg(long, value_name = "PLACE", conflicts_with_all = ["distance", "angle"])]
    pub(crate) at: Option<String>,
    /// The court of places by name, in --at or in the file: ncaa, nba, fiba or high_school
    /// [default: that of the physics, else ncaa].
    #[arg(long, value_name = "COURT", value_parser = court)]
    pub(crate) court: Option<League>,
    /// Distance of the place from the hoop's centre, where the file has no column for it.
    #[arg(long, value_name = "LENGTH")]
    pub(crate) distance: Option<String>,
    /// Angle of the place on the court [default: 0 deg].
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true)]
    pub(crate) angle: Option<String>,
    /// Height of the release above the floor. With several players, repeatable, one for each:
    /// 'Ana=6.9 ft'.
    #[arg(long, value_name = "[NAME=]LENGTH")]
    pub(crate) release_height: Vec<String>,
    /// Backspin, if it was not measured [default: 2.25 rev/s with a standard deviation of 0.4].
    #[arg(long, value_name = "SPIN", allow_hyphen_values = true)]
    pub(crate) backspin: Option<String>,
    /// Restitution of this gym's ring, where it was measured [default: fitted; 0.65 without
    /// results].
    #[arg(long, value_name = "NUMBER", value_parser = ring)]
    pub(crate) ring: Option<f64>,
    /// Distribution of the releases: normal, student (heavier tails), or auto (student if the shots
    /// have too many outliers for a normal distribution).
    #[arg(long, value_name = "NAME", default_value = "auto")]
    pub(crate) tails: TailsArg,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Units of the results [default: for a fit's folder its own, else imperial].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
}

/// The values of `--tails`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum TailsArg {
    Auto,
    Normal,
    Student,
}

/// The values of `--dates`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum DatesArg {
    /// The day first: 14/10/2025.
    Dmy,
    /// The month first: 10/14/2025.
    Mdy,
}

impl From<DatesArg> for DateOrder {
    fn from(order: DatesArg) -> Self {
        match order {
            DatesArg::Dmy => Self::DayFirst,
            DatesArg::Mdy => Self::MonthFirst,
        }
    }
}

/// A file of measured shots, read.
pub(crate) struct MeasuredFile {
    pub(crate) shooters: Vec<ShooterShots>,
    pub(crate) physics: Physics,
    pub(crate) physics_name: String,
    /// The text of the `[physics]` table.
    pub(crate) physics_toml: String,
    /// Whether the ring was given; otherwise it is fitted.
    pub(crate) is_ring_known: bool,
    pub(crate) noise: TrackerNoise,
    pub(crate) tracker: (String, String),
    pub(crate) file: PathBuf,
    pub(crate) blake3: String,
    pub(crate) row_name: &'static str,
    pub(crate) unused: Vec<String>,
    /// What some of them may hold, as `--map` takes it.
    pub(crate) proposed: Vec<String>,
    /// Columns that may name players, with some of their texts.
    pub(crate) possible_players: Vec<(String, Vec<String>)>,
    /// What was found in the file, in words.
    pub(crate) found: Vec<String>,
    /// In which order the sessions are, where they are days.
    pub(crate) session_order: Option<String>,
    /// A column that nothing was taken from and that can tell sessions apart.
    pub(crate) sessions_column: Option<String>,
    pub(crate) seed: u64,
    pub(crate) tails: TailsArg,
    pub(crate) backspin_rad_s: Option<f64>,
    /// The sessions that were asked for; empty for all.
    pub(crate) sessions: Vec<String>,
}

fn quantity(
    flag: &str,
    text: Option<&String>,
    dimension: Dimension,
) -> Result<Option<f64>, Failure> {
    text.map(|text| {
        units::parse(text, dimension).map_err(|error| Failure::usage(format!("--{flag}: {error}")))
    })
    .transpose()
}

/// The shooters that a table names; one without a name, if it has no column of them.
fn shooter_of(columns: &Columns, cells: &[String]) -> String {
    let index = columns.label(Label::Shooter);
    let cell = index.and_then(|index| cells.get(index));
    cell.map_or("", |cell| cell.trim()).to_owned()
}

/// Refuses a shooter whom the table does not have. `wanted_for`: by what they are named.
fn check_shooter(
    table: &Table,
    columns: &Columns,
    (wanted, wanted_for): (&str, &str),
) -> Result<(), String> {
    let all = table
        .rows
        .iter()
        .map(|(_, cells)| shooter_of(columns, cells));
    let known: BTreeSet<String> = all.collect();
    if known.contains(wanted) {
        return Ok(());
    }
    let all = match columns.label(Label::Shooter) {
        None => format!(
            "no column shooter (name it with --map 'shooter=COLUMN'){}",
            map_proposal(columns)
        ),
        Some(_) => listed(known.iter().map(String::as_str)),
    };
    Err(format!(
        "has no shooter \"{wanted}\"{wanted_for}; it has {all}"
    ))
}

/// Keeps the rows of some sessions; of all, if none is named.
fn keep_sessions(table: &mut Table, columns: &Columns, wanted: &[String]) -> Result<(), String> {
    if wanted.is_empty() {
        return Ok(());
    }
    let index = columns.label(Label::Session).ok_or(
        "has no column session for --session; name it with --map 'session=COLUMN'".to_owned(),
    )?;
    let session = |cells: &[String]| cells.get(index).map_or("", |cell| cell.trim()).to_owned();
    let mut is_known = HashSet::new();
    let mut known: Vec<String> = Vec::new();
    for (_, cells) in &table.rows {
        let name = session(cells);
        if is_known.insert(name.clone()) {
            known.push(name);
        }
    }
    if let Some(missing) = wanted.iter().find(|name| !known.contains(name)) {
        return Err(format!(
            "has no session {missing}; it has {}",
            known.join(", ")
        ));
    }
    table
        .rows
        .retain(|(_, cells)| wanted.contains(&session(cells)));
    Ok(())
}

/// The names of shooters, for a message.
fn names_of(shooters: &[ShooterShots]) -> String {
    listed(shooters.iter().map(|shooter| shooter.name.as_str()))
}

/// Names in a list, not all of them if they are many.
fn listed<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    /// More names than this are not listed.
    const MOST_LISTED: usize = 12;
    let more = if names.len() > MOST_LISTED {
        ", ..."
    } else {
        ""
    };
    let names: Vec<&str> = names.take(MOST_LISTED).collect();
    format!("{}{more}", names.join(", "))
}

impl MeasuredFile {
    /// The shots of the only shooter in the file.
    pub(crate) fn only_shooter(&self) -> Result<&ShooterShots, Failure> {
        match &self.shooters[..] {
            [shots] => Ok(shots),
            several => Err(Failure::usage(format!(
                "{}: has {} shooters ({}); choose one with --shooter NAME",
                self.file.display(),
                several.len(),
                names_of(several)
            ))),
        }
    }
}

impl MeasuredShotsOptions {
    /// The maps of columns, with those in files. A line of a file may be what a message proposes:
    /// with `--map`, quotes and a backslash at its end.
    fn maps(&self) -> Result<Vec<String>, Failure> {
        let mut maps = Vec::new();
        for map in &self.map {
            let Some(file) = map.strip_prefix('@') else {
                maps.push(map.clone());
                continue;
            };
            for line in read_text(Path::new(file))?.lines() {
                let line = line.trim().trim_end_matches('\\').trim_end();
                let line = line.strip_prefix("--map").map_or(line, str::trim_start);
                // Behind the closing quote a proposal shows some cells.
                let quoted = line
                    .strip_prefix('\'')
                    .and_then(|line| Some(line.rsplit_once('\'')?.0));
                if !line.is_empty() && !line.starts_with('#') {
                    maps.push(quoted.unwrap_or(line).to_owned());
                }
            }
        }
        Ok(maps)
    }

    pub(crate) fn unit_system(&self) -> UnitSystem {
        self.units_or(UnitSystem::Imperial)
    }

    /// The units that are asked for, or those of what was read.
    pub(crate) fn units_or(&self, of_input: UnitSystem) -> UnitSystem {
        self.units.map_or(of_input, UnitSystem::from)
    }

    /// The first option given that says something about a file, or about how to fit it.
    pub(crate) fn first_about_a_file(&self) -> Option<&'static str> {
        [
            ("--physics", self.physics.is_some()),
            ("--tracker", self.tracker.is_some()),
            ("--map", !self.map.is_empty()),
            ("--accept", self.accept),
            ("--shooter", self.shooter.is_some()),
            ("--session", !self.session.is_empty()),
            ("--dates", self.dates.is_some()),
            ("--made", self.made.is_some()),
            ("--hoop", self.hoop.is_some()),
            ("--at", self.at.is_some()),
            ("--court", self.court.is_some()),
            ("--distance", self.distance.is_some()),
            ("--angle", self.angle.is_some()),
            ("--release-height", !self.release_height.is_empty()),
            ("--backspin", self.backspin.is_some()),
            ("--tails", self.tails != TailsArg::Auto),
        ]
        .into_iter()
        .find_map(|(option, is_given)| is_given.then_some(option))
    }

    /// Reads the shots of a file that the options ask for.
    pub(crate) fn read(&self, path: &Path) -> Result<MeasuredFile, Failure> {
        self.read_sessions(path, &self.session)
    }

    /// Reads the shots of some sessions; of all, if none is named.
    pub(crate) fn read_sessions(
        &self,
        path: &Path,
        sessions: &[String],
    ) -> Result<MeasuredFile, Failure> {
        refuse_missing(path)?;
        let refuse = |message: String| Failure::usage(format!("{}: {message}", path.display()));
        if path.extension().is_some_and(|end| end == "toml") {
            return Err(refuse(
                "is a profile or a sweep, not measured shots; name a CSV or Parquet file, or the folder of a fit"
                    .to_owned(),
            ));
        }
        let mut table = Table::read(path).map_err(refuse)?;
        let columns = self.columns(path, &table)?;
        let release_heights_m = self.release_heights_m()?;
        let named = release_heights_m.iter().filter_map(|(name, _)| {
            let name = name.as_deref()?;
            Some((name, " for --release-height"))
        });
        let wanted = self.shooter.iter().map(|name| (name.as_str(), ""));
        for shooter in named.chain(wanted) {
            check_shooter(&table, &columns, shooter).map_err(refuse)?;
        }
        if let Some(name) = &self.shooter {
            table
                .rows
                .retain(|(_, cells)| shooter_of(&columns, cells) == *name);
        }
        let source = Source::of(&columns).map_err(refuse)?;
        let decisions = Decisions {
            dates: self.dates.map(DateOrder::from),
            made: self.made.clone(),
            has_one_distance: self.distance.is_some() || self.at.is_some(),
        };
        let session_order = decide(&mut table, &columns, source, &decisions).map_err(refuse)?;
        let wanted = sessions
            .iter()
            .map(|name| session_name(name, decisions.dates));
        keep_sessions(&mut table, &columns, &wanted.collect::<Vec<_>>()).map_err(refuse)?;
        let can_tell_sessions = |name: &&str| {
            let index = columns.names().iter().position(|column| column == name);
            names_sessions(name) && index.is_some_and(|index| can_be_sessions(&table, index))
        };
        let sessions_column = columns.unused().into_iter().find(can_tell_sessions);
        let sessions_column = sessions_column.filter(|_| source != Source::Trajectories);
        let sessions_column = sessions_column.map(str::to_owned);
        let physics_name = self
            .physics
            .clone()
            .unwrap_or_else(|| DEFAULT_PRESET.to_owned());
        let (mut physics, _) = load_physics(&physics_name)?;
        let mut physics_toml = physics_table(&physics_name)?;
        let is_ring_known = self.ring.is_some() || says_the_ring(&physics_toml);
        if let Some(ring) = self.ring {
            let set = physics.set_restitution_on(SolidId::Ring, ring);
            set.map_err(|error| Failure::usage(format!("--ring {ring}: {error}")))?;
            physics_toml = with_ring(&physics_toml, ring);
        }
        let simulator = Simulator::new(&physics).map_err(Failure::usage)?;
        let (mut noise, mut tracker) = self.noise(source)?;
        let backspin_rad_s = quantity("backspin", self.backspin.as_ref(), Dimension::Spin)?;
        let named = match &self.at {
            Some(name) => Some(location_named(name, self.court, &physics)?),
            None => None,
        };
        let distance_m = quantity("distance", self.distance.as_ref(), Dimension::Length)?;
        let court_angle_rad = quantity("angle", self.angle.as_ref(), Dimension::Angle)?;
        let mut options = ReadOptions {
            frame: self.frame()?,
            court: self.court.unwrap_or_else(|| League::of_physics(&physics)),
            distance_m: named.map(|place| place.distance_m).or(distance_m),
            court_angle_rad: named.map(|place| place.angle_rad).or(court_angle_rad),
            release_heights_m,
            backspin_rad_s,
            noise,
        };
        if self.tracker.is_none()
            && let Some(found) = tracker_by_flights(&table, &columns, &options, &simulator)
        {
            (options.noise, noise) = (found, found);
            tracker = (
                found.name_by_tracks(),
                "estimated from the flights".to_owned(),
            );
        }
        let bars = ProgressBars::new();
        let shooters = read(&table, &columns, &options, &simulator, &bars).map_err(refuse)?;
        let bytes = std::fs::read(path).map_err(|error| Failure::io(path.display(), &error))?;
        Ok(MeasuredFile {
            shooters,
            physics_toml,
            is_ring_known,
            physics,
            physics_name,
            noise,
            tracker,
            file: path.to_owned(),
            blake3: blake3::hash(&bytes).to_hex().to_string(),
            row_name: table.row_name,
            session_order,
            sessions_column,
            possible_players: Proposal::of(&columns).possible_players(),
            proposed: Proposal::of(&columns).accepted().unwrap_or_default(),
            found: table.found.clone(),
            unused: columns.unused().into_iter().map(str::to_owned).collect(),
            seed: self.seed,
            tails: self.tails,
            sessions: sessions.to_vec(),
            backspin_rad_s,
        })
    }

    /// The columns of a table, with what is proposed for those of other names where that is
    /// accepted: by the flag, or on a terminal by an answer.
    fn columns(&self, path: &Path, table: &Table) -> Result<Columns, Failure> {
        let refuse = |message: String| Failure::usage(format!("{}: {message}", path.display()));
        let mut maps = self.maps()?;
        let read = |maps: &[String]| {
            Columns::of_table(table, maps).map_err(|errors| refuse(errors.join("\n")))
        };
        let columns = read(&maps)?;
        let proposal = Proposal::of(&columns);
        let is_accepted = self.accept
            || !proposal.maps.is_empty()
                && Source::of(&columns).is_err()
                && confirm(&format!(
                    "{}:{}\nIs this right?",
                    path.display(),
                    proposal.text()
                ));
        if !is_accepted {
            return Ok(columns);
        }
        let accepted = proposal.accepted().map_err(refuse)?;
        if !accepted.is_empty() && !is_quiet() {
            print_remark(&format!("columns taken: {}", accepted.join(", ")));
        }
        maps.extend(accepted);
        read(&maps)
    }

    /// The heights of the release: of each shooter who is named, and of all others.
    fn release_heights_m(&self) -> Result<Vec<(Option<String>, f64)>, Failure> {
        let height = |text: &String| {
            let (name, length) = match text.rsplit_once('=') {
                Some((name, length)) => (Some(name.trim().to_owned()), length.trim()),
                None => (None, text.as_str()),
            };
            let height_m = units::parse(length, Dimension::Length)
                .map_err(|error| Failure::usage(format!("--release-height: {error}")))?;
            Ok((name, height_m))
        };
        let heights: Vec<(Option<String>, f64)> = self
            .release_height
            .iter()
            .map(height)
            .collect::<Result<_, Failure>>()?;
        for (k, (name, _)) in heights.iter().enumerate() {
            if heights[..k].iter().any(|(known, _)| known == name) {
                return Err(Failure::usage(match name {
                    Some(name) => format!("--release-height: {name} has two"),
                    None => {
                        "--release-height: is given twice; for several shooters write 'NAME=7 ft'"
                            .to_owned()
                    }
                }));
            }
        }
        Ok(heights)
    }

    fn frame(&self) -> Result<CourtFrame, Failure> {
        let Some(hoop) = &self.hoop else {
            return CourtFrame::named(&self.frame).ok_or_else(|| {
                Failure::usage(format!(
                    "--frame {}: must be hoop or court_94x50",
                    self.frame
                ))
            });
        };
        let refuse = || {
            Failure::usage(format!(
                "--hoop '{hoop}': must be two lengths and a direction (+x, -x, +y or -y), such as '5.25 ft,25 ft,+x'"
            ))
        };
        let parts: Vec<&str> = hoop.split(',').map(str::trim).collect();
        let [x, y, direction] = parts[..] else {
            return Err(refuse());
        };
        let length = |text: &str| units::parse(text, Dimension::Length).map_err(|_| refuse());
        let onto_court = OntoCourt::named(direction).ok_or_else(refuse)?;
        Ok(CourtFrame::HoopAt([length(x)?, length(y)?], onto_court))
    }

    fn noise(&self, source: Source) -> Result<(TrackerNoise, (String, String)), Failure> {
        tracker_noise(
            self.tracker.as_deref().unwrap_or(source.usual_tracker()),
            source,
        )
    }
}

/// The noise of a tracker by its name or from its file, its name, and where the noise is from.
pub(crate) fn tracker_noise(
    name: &str,
    source: Source,
) -> Result<(TrackerNoise, (String, String)), Failure> {
    if let Some(tracker) = Tracker::named(name) {
        return Ok((tracker.noise, (name.to_owned(), tracker.source.to_owned())));
    }
    if let Some(noise) = TrackerNoise::named_by_tracks(name) {
        return Ok((
            noise,
            (name.to_owned(), "estimated from the flights".to_owned()),
        ));
    }
    let path = Path::new(name);
    if !path.exists() {
        let names: Vec<&str> = Tracker::ALL.iter().map(|tracker| tracker.name).collect();
        return Err(Failure::usage(format!(
            "--tracker {name}: is neither a tracker ({}) nor a file{}",
            names.join(", "),
            units::suggestion(name, names.iter().copied())
        )));
    }
    let noise = tracker_of_file(&read_text(path)?, source)
        .map_err(|error| Failure::usage(format!("{name}: {error}")))?;
    Ok((noise, (name.to_owned(), "given".to_owned())))
}

/// The noise of a tracker's TOML file. What it does not say is that of the usual tracker.
fn tracker_of_file(text: &str, source: Source) -> Result<TrackerNoise, String> {
    const KEYS: [(&str, Dimension); 8] = [
        ("speed", Dimension::Speed),
        ("pitch", Dimension::Angle),
        ("polar", Dimension::Angle),
        ("backspin", Dimension::Spin),
        ("depth", Dimension::Length),
        ("left_right", Dimension::Length),
        ("entry_angle", Dimension::Angle),
        ("position", Dimension::Length),
    ];
    let usual = Tracker::named(source.usual_tracker());
    let mut noise = usual.map(|tracker| tracker.noise).ok_or("has no default")?;
    let table: toml::Table = text
        .parse()
        .map_err(|error: toml::de::Error| error.to_string())?;
    for (key, value) in &table {
        if let Some(index) = KEYS.iter().position(|(name, _)| name == key) {
            let dimension = KEYS[index].1;
            let text = value.as_str().ok_or_else(|| {
                format!(
                    "{key}: must be a text with a unit ({})",
                    dimension.unit_names()
                )
            })?;
            let sd = units::parse(text, dimension).map_err(|error| format!("{key}: {error}"))?;
            if !(sd > 0.0) {
                return Err(format!("{key}: must be above 0"));
            }
            match index {
                0..4 => noise.release[index] = sd,
                4..7 => noise.landing[index - 4] = sd,
                _ => noise.position_m = sd,
            }
            continue;
        }
        let number = value
            .as_float()
            .or_else(|| value.as_integer().map(|n| n as f64));
        match (key.as_str(), number) {
            ("frame_correlation", Some(value)) if (0.0..0.99).contains(&value) => {
                noise.frame_correlation = value
            }
            ("frames_per_s", Some(value)) if (1.0..100_000.0).contains(&value) => {
                noise.frames_per_s = value
            }
            ("frame_correlation", _) => {
                return Err("frame_correlation: must be a number from 0 to 0.99".to_owned());
            }
            ("frames_per_s", _) => {
                return Err("frames_per_s: must be a number from 1 to 100000".to_owned());
            }
            _ => {
                let names: Vec<&str> = KEYS.iter().map(|(name, _)| *name).collect();
                return Err(format!(
                    "{key}: is no key of a tracker; the keys are {}, frame_correlation, frames_per_s",
                    names.join(", ")
                ));
            }
        }
    }
    Ok(noise)
}

/// The restitution of a ring.
fn ring(text: &str) -> Result<f64, String> {
    let number = text
        .parse()
        .ok()
        .filter(|number| (0.2..=0.98).contains(number));
    number.ok_or_else(|| "must be a number from 0.2 to 0.98".to_owned())
}

/// Whether a `[physics]` table has a ring of its own, or that of the paper.
fn says_the_ring(table: &str) -> bool {
    const KEYS: [&str; 4] = ["restitution", "hoop_restitution", "damping", "hoop_damping"];
    let document: Option<DocumentMut> = table.parse().ok();
    let physics = document
        .as_ref()
        .and_then(|document| document.get("physics"));
    physics.is_some_and(|physics| {
        let preset = physics.get("preset").and_then(|preset| preset.as_str());
        preset == Some("paper") || KEYS.iter().any(|key| physics.get(key).is_some())
    })
}

/// A `[physics]` table with this restitution of the ring.
pub(crate) fn with_ring(table: &str, restitution: f64) -> String {
    let Ok(mut document) = table.parse::<DocumentMut>() else {
        return table.to_owned();
    };
    document["physics"]["hoop_restitution"] = toml_edit::value(restitution);
    document.to_string()
}

/// The `[physics]` table of a preset or a file.
fn physics_table(name: &str) -> Result<String, Failure> {
    if crate::model::Preset::named(name).is_some() {
        return Ok(format!("[physics]\npreset = \"{name}\""));
    }
    let text = read_text(Path::new(name))?;
    let mut document: DocumentMut = text.parse().map_err(Failure::usage)?;
    document.retain(|key, _| key == "physics");
    document.set_trailing("");
    Ok(document.to_string())
}

impl MeasuredFile {
    pub(crate) fn source<'a>(&'a self, shots: &'a ShooterShots) -> FitSource<'a> {
        FitSource {
            kind: shots.source,
            file: self.file.display().to_string(),
            found: &self.found,
            file_blake3: self.blake3.clone(),
            tracker: self.tracker.clone(),
            noise: self.noise,
            prior: self.prior(),
            unseen: self.unseen_prior(shots),
            physics: self.physics_name.clone(),
            seed: self.seed,
            is_shooter_named: !shots.name.is_empty(),
            rejected: &shots.rejected,
            differences: &shots.differences,
            place_names: &shots.place_names,
        }
    }

    /// The prior, with the backspin that was given.
    fn prior(&self) -> PopulationPrior {
        let mut prior = PopulationPrior::MEASURED;
        if let Some(backspin) = self.backspin_rad_s {
            prior.backspin.mean = backspin;
        }
        prior
    }

    /// Options of the fit of a shooter.
    pub(crate) fn fit_options(&self, shots: &ShooterShots) -> FitOptions {
        FitOptions {
            prior: self.prior(),
            spin: shots.spin,
            tails: match self.tails {
                _ if shots.source == Source::Makes => Tails::Normal,
                TailsArg::Auto => tails_of(&shots.shots, shots.places.len()),
                TailsArg::Normal => Tails::Normal,
                TailsArg::Student => Tails::Student,
            },
            seed: self.seed,
            ..FitOptions::default()
        }
    }

    /// What is known of what no sensor sees.
    pub(crate) fn unseen_prior(&self, shots: &ShooterShots) -> UnseenPrior {
        UnseenPrior {
            ring: (!self.is_ring_known).then_some(RINGS_OF_GYMS),
            ring_of_others: None,
            constant_error: match shots.source {
                Source::Makes => None,
                source => Some(self.noise.constant_error(source == Source::Releases)),
            },
            aim: Some(AimPrior::POPULATION),
        }
    }

    /// Fits one shooter.
    pub(crate) fn fit(
        &self,
        shots: &ShooterShots,
        progress: &dyn Progress,
    ) -> Result<ShooterFit, ShooterFitError> {
        let mut fits = self.fit_all(std::slice::from_ref(shots), progress);
        fits.swap_remove(0)
    }

    /// Fits shooters who shot at one ring.
    pub(crate) fn fit_all(
        &self,
        shooters: &[ShooterShots],
        progress: &dyn Progress,
    ) -> Vec<Result<ShooterFit, ShooterFitError>> {
        // Two fits of one file must not have one title.
        let title = |shots| {
            let parts = std::iter::once(self.name_of(shots)).chain(self.sessions.clone());
            parts.collect::<Vec<String>>().join(", ")
        };
        let names: Vec<String> = shooters.iter().map(title).collect();
        let tests: Vec<_> = std::iter::zip(shooters, &names)
            .map(|(shots, name)| {
                let test = ShooterTest {
                    name,
                    places: &shots.places,
                    place_scatter: &shots.place_scatter,
                    shots: &shots.shots,
                    sessions: &shots.sessions,
                    speed_unit: shots.speed_unit,
                    chi_squares: &shots.chi_squares,
                };
                (test, self.fit_options(shots), self.unseen_prior(shots))
            })
            .collect();
        let mut fits = fit_shooters(&tests, &self.physics, progress);
        let tracked = fits.iter_mut().zip(shooters);
        let mut tracked: Vec<(&mut ShooterFit, &ShooterShots)> = tracked
            .filter_map(|(fit, shots)| Some((fit.as_mut().ok()?, shots)))
            .filter(|(_, shots)| !shots.tracks.is_empty())
            .collect();
        if let [(fit, shots)] = &mut tracked[..] {
            fit.notes.extend(self.drag_note(shots, progress));
        }
        if tracked.len() < 2 {
            return fits;
        }
        progress.begin("finding the drag", tracked.len() as u64);
        for (fit, shots) in tracked {
            fit.notes.extend(self.drag_note(shots, &Pulse(progress)));
            progress.advance(1);
        }
        progress.end();
        fits
    }

    /// The drag coefficient that the flights of shooters fit best; `None` where they do not tell
    /// it.
    pub(crate) fn drag_of_flights(
        &self,
        shooters: &[&ShooterShots],
        progress: &dyn Progress,
    ) -> Option<DragEstimate> {
        let tracks = shooters.iter().flat_map(|shots| &shots.tracks);
        let tracks: Vec<&[TrackedPoint]> = tracks.map(Vec::as_slice).collect();
        let backspin = self.backspin_rad_s.unwrap_or(0.0);
        fit_drag_coefficient(&self.physics, &tracks, &self.noise, backspin, progress)
    }

    fn drag_note(&self, shots: &ShooterShots, progress: &dyn Progress) -> Option<FitNote> {
        /// So many standard errors are worth a warning: 3 in 1000 of right drags.
        const FAR: f64 = 3.0;
        let found = self.drag_of_flights(&[shots], progress)?;
        let own = self.physics.air.drag_coefficient;
        let is_far = (found.best - own).abs() > FAR * found.standard_error;
        is_far.then_some(FitNote::OtherDrag {
            best: found.best,
            low: found.interval[0],
            high: found.interval[1],
            of_physics: own,
        })
    }

    /// The name of a shooter, or that of the file.
    pub(crate) fn name_of(&self, shots: &ShooterShots) -> String {
        if shots.name.is_empty() {
            let stem = self.file.file_stem();
            stem.map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
        } else {
            shots.name.clone()
        }
    }
}
