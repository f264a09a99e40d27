//! `bankshot simulate`: a stream of releases in, a stream of outcomes out.

use crate::cli::config_files::load_physics;
use crate::cli::failure::{Failure, code, refuse_missing};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{is_quiet, print_remark};
use crate::cli::value_parsers::PhysicsArg;
use crate::dynamics::{Integrator, Simulator};
use crate::escape::csv_cell;
use crate::files::atomic_file::{AtomicFile, same_file};
use crate::files::csv_records::Row;
use crate::files::parquet_rows::{ParquetSink, column};
use crate::files::table_rows::TableRows;
use crate::model::DEFAULT_PRESET;
use crate::present::simulation_files::outcome_columns::{
    OUTCOME_COLUMNS, OUTCOME_TYPES, outcome_cells,
};
use crate::present::simulation_files::release_columns::{ReleaseColumns, RowError};
use crate::probability::Progress;
use clap::{Args, ValueEnum};
use csv::{ByteRecord, Writer};
use parquet::basic::Type as Physical;
use rayon::prelude::*;
use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// The integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntegratorName {
    /// Closed-form flight, and contacts in steps that end on the events of friction.
    Exact,
    /// The paper's variable-step Runge-Kutta method at the paper's steps.
    Paper,
}

#[derive(Args, Debug)]
#[command(after_help = "\
Columns, by name and in any order: distance_ft, court_angle_deg, release_height_ft, speed_ft_s, \
pitch_deg, polar_deg; optional backspin_rev_s, rifle_spin_rev_s, side_spin_rev_s. The suffixes _m, \
_m_s, _rad and _rad_s are accepted instead. Other columns are copied. One that is named like a \
quantity needs --carry, so that no misspelt column is overlooked. The columns made, kind, contacts, \
n_board, n_ring, flight_time_s (to the end of the shot, bounces included), entry_angle_deg and \
first_touch_s are added. A row that cannot be simulated is reported with its line and has empty \
results; the exit code is then 3. Files named *.parquet are Parquet, others CSV.

Examples:
  bankshot simulate releases.csv --output outcomes.csv
  bankshot simulate - --output - --integrator paper <releases.csv >outcomes.csv")]
pub(crate) struct SimulateOptions {
    /// The releases, a CSV or Parquet file; - for CSV from standard input.
    pub(crate) releases: PathBuf,
    /// The file of outcomes, CSV or Parquet; - for CSV to standard output.
    #[arg(long, short, value_name = "OUT.csv|OUT.parquet")]
    pub(crate) output: PathBuf,
    /// Copy columns that are named like a quantity but are none of the release.
    #[arg(long, value_name = "COLUMN,...", value_delimiter = ',')]
    pub(crate) carry: Vec<String>,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// The integrator [default: exact, or the file's].
    #[arg(long)]
    pub(crate) integrator: Option<IntegratorName>,
}

/// Rows in memory at a time.
const BATCH_ROWS: usize = 16_384;
/// Bytes of rows in memory at a time, about.
const BATCH_BYTES: usize = 8 << 20;
/// Bad rows that are reported one by one.
const MAX_REPORTED: u64 = 20;

pub(crate) fn run(options: &SimulateOptions) -> Result<u8, Failure> {
    let input = if options.releases == Path::new("-") {
        Path::new("/dev/stdin")
    } else {
        &options.releases
    };
    if same_file(input, &options.output) {
        return Err(Failure::usage(format!(
            "--output {}: this is the input; choose another file",
            options.output.display()
        )));
    }
    let simulator = simulator(options)?;
    if options.physics.physics.is_none() && !is_quiet() {
        print_remark(
            "physics: ncaa (the men's college ball, in air); give another with --physics nba, or a profile that has one, such as --physics robot.toml",
        );
    }
    if options.releases != Path::new("-") {
        refuse_missing(&options.releases)?;
    }
    let mut source = open(&options.releases)?;
    let header = source.header().clone();
    let columns = ReleaseColumns::new(&header, &options.carry)
        .map_err(|error| Failure::usage(format!("{}: {error}", options.releases.display())))?;
    if !columns.has_backspin() && !is_quiet() {
        print_remark(
            "warning: the backspin is not given (no column such as backspin_rev_s): no ball spins",
        );
    }
    // A bar between the rows on a terminal would stay there.
    let shows_rows = options.output == Path::new("-") && io::stdout().is_terminal();
    let bars = match shows_rows {
        true => ProgressBars::hidden(),
        false => ProgressBars::new(),
    };
    let total = std::fs::metadata(&options.releases).map_or(0, |about| about.len());
    bars.begin("simulating", total);
    let mut stream = Stream {
        options,
        simulator,
        columns,
        width: header.len(),
        bars,
        bad_rows: 0,
        rows: 0,
    };
    let refuse = |error: io::Error| Failure::io(options.output.display(), &error);
    if options.output == Path::new("-") {
        let sink = Sink::csv(BufWriter::with_capacity(1 << 16, io::stdout()), &header);
        let result = sink
            .and_then(|sink| stream.run(&mut source, sink))
            .and_then(|mut out| out.flush().map_err(StreamError::Output));
        match result {
            Err(StreamError::Output(error)) if error.kind() == io::ErrorKind::BrokenPipe => {}
            result => result.map_err(|error| error.failure(options))?,
        }
    } else {
        let out = BufWriter::new(AtomicFile::new(&options.output).map_err(refuse)?);
        let sink = if is_parquet(&options.output) {
            Sink::parquet(out, &source, &header)
        } else {
            Sink::csv(out, &header)
        };
        let out = sink
            .and_then(|sink| stream.run(&mut source, sink))
            .map_err(|error| error.failure(options))?;
        out.into_inner()
            .map_err(|error| refuse(error.into_error()))?
            .finish()
            .map_err(refuse)?;
    }
    stream.bars.end();
    stream.report()
}

fn simulator(options: &SimulateOptions) -> Result<Simulator, Failure> {
    let name = options.physics.physics.as_deref().unwrap_or(DEFAULT_PRESET);
    let (physics, from_file) = load_physics(name)?;
    let integrator = match options.integrator {
        None => from_file,
        Some(IntegratorName::Exact) if matches!(from_file, Integrator::EventDriven { .. }) => {
            from_file
        }
        Some(IntegratorName::Exact) => Integrator::EVENT_DRIVEN,
        Some(IntegratorName::Paper) if matches!(from_file, Integrator::PaperRk4 { .. }) => {
            from_file
        }
        Some(IntegratorName::Paper) => Integrator::PAPER_RK4,
    };
    Simulator::with_integrator(&physics, integrator).map_err(Failure::usage)
}

fn is_parquet(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("parquet"))
}

/// Opens the releases.
fn open(path: &Path) -> Result<TableRows, Failure> {
    let rows = match path == Path::new("-") {
        true => TableRows::of_stream(Box::new(io::stdin())),
        false => TableRows::open(path),
    };
    rows.map_err(|reason| Failure::usage(format!("{}: {reason}", path.display())))
}

/// Where the outcomes go.
enum Sink<W: Write + Send> {
    Csv(Box<Writer<W>>),
    Parquet(Box<ParquetSink<W>>),
}

impl<W: Write + Send> Sink<W> {
    fn csv(out: W, header: &ByteRecord) -> Result<Self, StreamError> {
        let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(out);
        let added = OUTCOME_COLUMNS.iter().map(|name| name.as_bytes());
        writer
            .write_record(header.iter().chain(added).map(csv_cell))
            .map_err(output_error)?;
        Ok(Self::Csv(Box::new(writer)))
    }

    /// The columns of a Parquet input keep their types; of a CSV input, those of parameters are
    /// numbers.
    fn parquet(out: W, source: &TableRows, header: &ByteRecord) -> Result<Self, StreamError> {
        let failed = |error: parquet::errors::ParquetError| StreamError::Input(error.to_string());
        let mut columns = match source.parquet_columns() {
            Some(columns) => columns.to_vec(),
            None => header
                .iter()
                .map(|cell| {
                    let name = String::from_utf8_lossy(cell.trim_ascii());
                    let is_number = ReleaseColumns::is_parameter(&name);
                    let of = if is_number {
                        Physical::DOUBLE
                    } else {
                        Physical::BYTE_ARRAY
                    };
                    column(&name, of)
                })
                .collect::<Result<_, _>>()
                .map_err(failed)?,
        };
        for (name, of) in OUTCOME_COLUMNS.iter().zip(OUTCOME_TYPES) {
            columns.push(column(name, of).map_err(failed)?);
        }
        let sink = ParquetSink::new(out, &columns).map_err(failed)?;
        Ok(Self::Parquet(Box::new(sink)))
    }

    fn write(&mut self, row: ByteRecord) -> Result<(), StreamError> {
        match self {
            Self::Csv(writer) => writer
                .write_record(row.iter().map(csv_cell))
                .map_err(output_error),
            Self::Parquet(sink) => sink.push(row).map_err(parquet_output_error),
        }
    }

    fn finish(self) -> Result<W, StreamError> {
        match self {
            Self::Csv(writer) => writer
                .into_inner()
                .map_err(|error| StreamError::Output(error.into_error())),
            Self::Parquet(sink) => sink.finish().map_err(parquet_output_error),
        }
    }
}

/// Why a stream ended early.
enum StreamError {
    Input(String),
    Output(io::Error),
}

impl StreamError {
    fn failure(self, options: &SimulateOptions) -> Failure {
        match self {
            Self::Input(message) => Failure {
                code: code::IO,
                message: format!("{}: {message}", options.releases.display()),
            },
            Self::Output(error) => Failure::io(options.output.display(), &error),
        }
    }
}

fn output_error(error: csv::Error) -> StreamError {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => StreamError::Output(error),
        other => StreamError::Output(io::Error::other(format!("{other:?}"))),
    }
}

fn parquet_output_error(error: parquet::errors::ParquetError) -> StreamError {
    StreamError::Output(io::Error::other(error.to_string()))
}

struct Stream<'a> {
    options: &'a SimulateOptions,
    simulator: Simulator,
    columns: ReleaseColumns,
    /// Number of columns of the input.
    width: usize,
    bars: ProgressBars,
    bad_rows: u64,
    rows: u64,
}

impl Stream<'_> {
    fn run<W: Write + Send>(
        &mut self,
        source: &mut TableRows,
        mut sink: Sink<W>,
    ) -> Result<W, StreamError> {
        let mut shown = 0;
        loop {
            let batch = source
                .next_rows(BATCH_ROWS, BATCH_BYTES)
                .map_err(StreamError::Input)?;
            if batch.is_empty() {
                return sink.finish();
            }
            let rows = batch.len() as u64;
            self.write(batch, source.row_name(), &mut sink)?;
            match source.bytes_read() {
                Some(read) => {
                    self.bars.advance(read - shown);
                    shown = read;
                }
                None => self.bars.advance(rows),
            }
        }
    }

    fn outcome(&self, row: &Row) -> Result<[String; OUTCOME_COLUMNS.len()], String> {
        let cells = row.cells.as_ref().map_err(Clone::clone)?;
        if cells.len() > self.width {
            let error = RowError::too_many_fields(cells.len(), self.width);
            return Err(error.to_string());
        }
        let release = self
            .columns
            .release(cells, self.simulator.physics())
            .map_err(|error| error.to_string())?;
        // Its values are finite: they were checked one by one.
        let outcome = self
            .simulator
            .simulate(&release)
            .map_err(|error| error.to_string())?;
        Ok(outcome_cells(&outcome))
    }

    fn write<W: Write + Send>(
        &mut self,
        batch: Vec<Row>,
        row_name: &str,
        sink: &mut Sink<W>,
    ) -> Result<(), StreamError> {
        let outcomes: Vec<_> = batch.par_iter().map(|row| self.outcome(row)).collect();
        for (row, outcome) in batch.into_iter().zip(outcomes) {
            self.rows += 1;
            let cells = outcome.unwrap_or_else(|reason| {
                self.bad_rows += 1;
                if self.bad_rows <= MAX_REPORTED {
                    print_remark(&format!(
                        "{}: {row_name} {}: {reason}",
                        self.options.releases.display(),
                        row.number
                    ));
                }
                Default::default()
            });
            // A short row is filled up and a long one cut, so that the added columns keep their
            // positions. A row that cannot be read is empty.
            let mut record = row.cells.unwrap_or_default();
            record.truncate(self.width);
            while record.len() < self.width {
                record.push_field(b"");
            }
            record.extend(cells.iter().map(String::as_bytes));
            sink.write(record)?;
        }
        Ok(())
    }

    fn report(&self) -> Result<u8, Failure> {
        if self.bad_rows > MAX_REPORTED {
            print_remark(&format!("... and {} more", self.bad_rows - MAX_REPORTED));
        }
        if self.bad_rows > 0 {
            let message = format!(
                "{} of {} rows could not be simulated; the others are done",
                self.bad_rows, self.rows
            );
            return Err(Failure {
                code: code::INCOMPLETE,
                message,
            });
        }
        if !is_quiet() && self.options.output != Path::new("-") {
            print_remark(&format!(
                "{} shots written to {}",
                self.rows,
                self.options.output.display()
            ));
        }
        Ok(code::DONE)
    }
}
