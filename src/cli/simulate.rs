//! `bankshot simulate`: releases in, outcomes out, as a stream.

use super::arguments::{IntegratorName, SimulateOptions};
use super::failure::{Failure, code};
use super::plan::read_text;
use super::progress::Bars;
use super::terminal::tell;
use bankshot::dynamics::{Integrator, Simulator};
use bankshot::output::files::Pending;
use bankshot::output::releases::{self, Layout};
use bankshot::physics::Physics;
use bankshot::probability::Progress;
use bankshot::profile;
use csv::{ByteRecord, Reader, Writer};
use rayon::prelude::*;
use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

/// Rows that are held in memory at a time.
const BATCH: usize = 16_384;
/// Bad rows that are named one by one.
const NAMED: u64 = 20;

pub(crate) fn run(options: &SimulateOptions, quiet: bool) -> Result<u8, Failure> {
    let (physics, simulator) = simulator(options)?;
    let mut reader = open(&options.releases)?;
    let header = reader
        .byte_headers()
        .map_err(|error| input_failure(options, &error))?
        .clone();
    let layout = Layout::new(&header)
        .map_err(|error| Failure::usage(format!("{}: {error}", options.releases.display())))?;
    let bars = Bars::new(quiet);
    let total = std::fs::metadata(&options.releases).map_or(0, |about| about.len());
    bars.begin("simulating", total);
    let mut stream = Stream {
        options,
        physics,
        simulator,
        layout,
        bars,
        bad: 0,
        rows: 0,
    };
    if options.output == Path::new("-") {
        let out = BufWriter::new(io::stdout().lock());
        match stream.run(&mut reader, &header, out) {
            Err(Stop::Output(error)) if error.kind() == io::ErrorKind::BrokenPipe => {}
            result => {
                result.map_err(|stop| stop.failure(options))?;
            }
        }
    } else {
        let refuse = |error: io::Error| Failure::io(options.output.display(), &error);
        let pending = Pending::new(&options.output).map_err(refuse)?;
        let out = BufWriter::new(pending);
        let out = stream
            .run(&mut reader, &header, out)
            .map_err(|stop| stop.failure(options))?;
        out.into_inner()
            .map_err(|error| refuse(error.into_error()))?
            .finish()
            .map_err(refuse)?;
    }
    stream.bars.end();
    stream.conclude(quiet)
}

fn simulator(options: &SimulateOptions) -> Result<(Physics, Simulator), Failure> {
    let (physics, from_file) = if options.physics == "paper" {
        (Physics::paper(), Integrator::EXACT)
    } else {
        let path = Path::new(&options.physics);
        if !path.exists() {
            return Err(Failure::usage(format!(
                "--physics {}: is neither the preset \"paper\" nor a file",
                options.physics
            )));
        }
        profile::parse_physics(&read_text(path)?, &options.physics)?
    };
    let integrator = match options.integrator {
        None => from_file,
        Some(IntegratorName::Exact) if matches!(from_file, Integrator::Exact { .. }) => from_file,
        Some(IntegratorName::Exact) => Integrator::EXACT,
        Some(IntegratorName::Paper) if matches!(from_file, Integrator::Paper { .. }) => from_file,
        Some(IntegratorName::Paper) => Integrator::PAPER,
    };
    let simulator = Simulator::with_integrator(&physics, integrator).map_err(Failure::usage)?;
    Ok((physics, simulator))
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

/// Why a stream stopped before its end.
enum Stop {
    Input(csv::Error),
    Output(io::Error),
}

impl Stop {
    fn failure(self, options: &SimulateOptions) -> Failure {
        match self {
            Self::Input(error) => input_failure(options, &error),
            Self::Output(error) => Failure::io(options.output.display(), &error),
        }
    }
}

fn output(error: csv::Error) -> Stop {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => Stop::Output(error),
        other => Stop::Output(io::Error::other(format!("{other:?}"))),
    }
}

struct Stream<'a> {
    options: &'a SimulateOptions,
    physics: Physics,
    simulator: Simulator,
    layout: Layout,
    bars: Bars,
    bad: u64,
    rows: u64,
}

impl Stream<'_> {
    fn run<W: Write>(
        &mut self,
        reader: &mut Reader<Box<dyn Read>>,
        header: &ByteRecord,
        out: W,
    ) -> Result<W, Stop> {
        let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(out);
        let added = releases::ADDED.iter().map(|name| name.as_bytes());
        writer
            .write_record(header.iter().chain(added))
            .map_err(output)?;
        let mut batch: Vec<ByteRecord> = Vec::with_capacity(BATCH);
        loop {
            batch.clear();
            let mut record = ByteRecord::new();
            let mut bytes = 0;
            while batch.len() < BATCH
                && reader.read_byte_record(&mut record).map_err(Stop::Input)?
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
        writer.flush().map_err(Stop::Output)?;
        writer
            .into_inner()
            .map_err(|error| Stop::Output(io::Error::other(error.to_string())))
    }

    fn write<W: Write>(
        &mut self,
        batch: &[ByteRecord],
        columns: usize,
        writer: &mut Writer<W>,
    ) -> Result<(), Stop> {
        let outcomes: Vec<_> = batch
            .par_iter()
            .map(|row| {
                if row.len() > columns {
                    return Err(releases::RowError::surplus(row.len(), columns));
                }
                let release = self.layout.release(row, &self.physics)?;
                Ok::<_, releases::RowError>(releases::cells(&self.simulator.shoot(&release)))
            })
            .collect();
        for (row, outcome) in batch.iter().zip(outcomes) {
            self.rows += 1;
            let cells = outcome.unwrap_or_else(|error| {
                self.bad += 1;
                if self.bad <= NAMED {
                    tell(&format!(
                        "{}: row {}: {error}",
                        self.options.releases.display(),
                        self.rows
                    ));
                }
                Default::default()
            });
            // A short row keeps the added columns in their place.
            let fill = std::iter::repeat_n(&b""[..], columns.saturating_sub(row.len()));
            let added = cells.iter().map(String::as_bytes);
            writer
                .write_record(row.iter().take(columns).chain(fill).chain(added))
                .map_err(output)?;
        }
        Ok(())
    }

    fn conclude(&self, quiet: bool) -> Result<u8, Failure> {
        if self.bad > NAMED {
            tell(&format!("... and {} more", self.bad - NAMED));
        }
        if self.bad > 0 {
            let message = format!(
                "{} of {} rows could not be simulated; the others are done",
                self.bad, self.rows
            );
            return Err(Failure {
                code: code::INCOMPLETE,
                message,
            });
        }
        if !quiet && self.options.output != Path::new("-") {
            tell(&format!(
                "{} shots written to {}",
                self.rows,
                self.options.output.display()
            ));
        }
        Ok(code::WHOLE)
    }
}
