//! `bankshot simulate`: a stream of releases in, a stream of outcomes out.

use crate::cli::args::{IntegratorName, SimulateOptions};
use crate::cli::config_files::read_text;
use crate::cli::failure::{Failure, code};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::print_remark;
use bankshot::config::parse_physics;
use bankshot::dynamics::{Integrator, Simulator};
use bankshot::model::Physics;
use bankshot::output::atomic_file::AtomicFile;
use bankshot::output::simulation_csv::{OUTCOME_COLUMNS, ReleaseColumns, RowError, outcome_cells};
use bankshot::probability::Progress;
use csv::{ByteRecord, Reader, Writer};
use rayon::prelude::*;
use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

/// Rows in memory at a time.
const BATCH: usize = 16_384;
/// Bad rows that are reported one by one.
const MAX_REPORTED: u64 = 20;

pub(crate) fn run(options: &SimulateOptions, quiet: bool) -> Result<u8, Failure> {
    let simulator = simulator(options)?;
    let mut reader = open(&options.releases)?;
    let header = reader
        .byte_headers()
        .map_err(|error| input_failure(options, &error))?
        .clone();
    let columns = ReleaseColumns::new(&header)
        .map_err(|error| Failure::usage(format!("{}: {error}", options.releases.display())))?;
    let bars = ProgressBars::new(quiet);
    let total = std::fs::metadata(&options.releases).map_or(0, |about| about.len());
    bars.begin("simulating", total);
    let mut stream = Stream {
        options,
        simulator,
        columns,
        bars,
        bad_rows: 0,
        rows: 0,
    };
    if options.output == Path::new("-") {
        let out = BufWriter::new(io::stdout().lock());
        match stream.run(&mut reader, &header, out) {
            Err(StreamError::Output(error)) if error.kind() == io::ErrorKind::BrokenPipe => {}
            result => {
                result.map_err(|error| error.failure(options))?;
            }
        }
    } else {
        let refuse = |error: io::Error| Failure::io(options.output.display(), &error);
        let file = AtomicFile::new(&options.output).map_err(refuse)?;
        let out = BufWriter::new(file);
        let out = stream
            .run(&mut reader, &header, out)
            .map_err(|error| error.failure(options))?;
        out.into_inner()
            .map_err(|error| refuse(error.into_error()))?
            .finish()
            .map_err(refuse)?;
    }
    stream.bars.end();
    stream.report(quiet)
}

fn simulator(options: &SimulateOptions) -> Result<Simulator, Failure> {
    let (physics, from_file) = if options.physics == "paper" {
        (Physics::paper(), Integrator::EVENT_DRIVEN)
    } else {
        let path = Path::new(&options.physics);
        if !path.exists() {
            return Err(Failure::usage(format!(
                "--physics {}: is neither the preset \"paper\" nor a file",
                options.physics
            )));
        }
        parse_physics(&read_text(path)?, &options.physics)?
    };
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

fn open(path: &Path) -> Result<Reader<Box<dyn Read>>, Failure> {
    let input: Box<dyn Read> = if path == Path::new("-") {
        Box::new(io::stdin())
    } else {
        let refuse = |error: io::Error| Failure::usage(format!("{}: {error}", path.display()));
        let file = File::open(path).map_err(refuse)?;
        if file.metadata().map_err(refuse)?.is_dir() {
            return Err(Failure::usage(format!("{}: is a folder", path.display())));
        }
        Box::new(file)
    };
    Ok(csv::ReaderBuilder::new()
        .flexible(true)
        .buffer_capacity(1 << 18)
        .from_reader(input))
}

fn input_failure(options: &SimulateOptions, error: &csv::Error) -> Failure {
    Failure {
        code: code::IO,
        message: format!("{}: {error}", options.releases.display()),
    }
}

/// Why a stream ended early.
enum StreamError {
    Input(csv::Error),
    Output(io::Error),
}

impl StreamError {
    fn failure(self, options: &SimulateOptions) -> Failure {
        match self {
            Self::Input(error) => input_failure(options, &error),
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

struct Stream<'a> {
    options: &'a SimulateOptions,
    simulator: Simulator,
    columns: ReleaseColumns,
    bars: ProgressBars,
    bad_rows: u64,
    rows: u64,
}

impl Stream<'_> {
    fn run<W: Write>(
        &mut self,
        reader: &mut Reader<Box<dyn Read>>,
        header: &ByteRecord,
        out: W,
    ) -> Result<W, StreamError> {
        let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(out);
        let added = OUTCOME_COLUMNS.iter().map(|name| name.as_bytes());
        writer
            .write_record(header.iter().chain(added))
            .map_err(output_error)?;
        let mut batch: Vec<ByteRecord> = Vec::with_capacity(BATCH);
        loop {
            batch.clear();
            let mut record = ByteRecord::new();
            let mut bytes = 0;
            while batch.len() < BATCH
                && reader
                    .read_byte_record(&mut record)
                    .map_err(StreamError::Input)?
            {
                bytes += record.as_slice().len() as u64 + record.len() as u64;
                batch.push(std::mem::take(&mut record));
            }
            if batch.is_empty() {
                break;
            }
            self.write(&batch, header.len(), &mut writer)?;
            self.bars.advance(bytes);
        }
        writer.flush().map_err(StreamError::Output)?;
        writer
            .into_inner()
            .map_err(|error| StreamError::Output(io::Error::other(error.to_string())))
    }

    fn write<W: Write>(
        &mut self,
        batch: &[ByteRecord],
        columns: usize,
        writer: &mut Writer<W>,
    ) -> Result<(), StreamError> {
        let outcomes: Vec<_> = batch
            .par_iter()
            .map(|row| {
                if row.len() > columns {
                    return Err(RowError::too_many_fields(row.len(), columns));
                }
                let release = self.columns.release(row, self.simulator.physics())?;
                let outcome = self.simulator.simulate(&release);
                // Its values are finite: they were checked one by one.
                outcome
                    .map(|outcome| outcome_cells(&outcome))
                    .map_err(|error| RowError {
                        column: "release".to_owned(),
                        reason: error.to_string(),
                    })
            })
            .collect();
        for (row, outcome) in batch.iter().zip(outcomes) {
            self.rows += 1;
            let cells = outcome.unwrap_or_else(|error| {
                self.bad_rows += 1;
                if self.bad_rows <= MAX_REPORTED {
                    print_remark(&format!(
                        "{}: row {}: {error}",
                        self.options.releases.display(),
                        self.rows
                    ));
                }
                Default::default()
            });
            // A short row is filled up, so that the added columns keep their positions.
            let fill = std::iter::repeat_n(&b""[..], columns.saturating_sub(row.len()));
            let added = cells.iter().map(String::as_bytes);
            writer
                .write_record(row.iter().take(columns).chain(fill).chain(added))
                .map_err(output_error)?;
        }
        Ok(())
    }

    fn report(&self, quiet: bool) -> Result<u8, Failure> {
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
        if !quiet && self.options.output != Path::new("-") {
            print_remark(&format!(
                "{} shots written to {}",
                self.rows,
                self.options.output.display()
            ));
        }
        Ok(code::DONE)
    }
}
