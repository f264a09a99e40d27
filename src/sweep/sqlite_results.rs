//! The results of one process in SQLite: a row for each job, each with a checksum.
//!
//! One process writes a file; any number of processes can read it meanwhile. Every finished spot is
//! committed and synced before it is reported. So what is reported survives `kill -9` and, if the
//! file system syncs as promised, a power cut. The checksum of a row covers its configuration, its
//! job and every value, so a row can be trusted whatever happened to the rest of the file.

use super::columns::{self, Column, ColumnType};
use super::result_row::{Cell, ResultRow};
use rusqlite::{Connection, ErrorCode, OpenFlags, Statement, ToSql, params};
use std::collections::BTreeSet;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How long SQLite waits for other processes that hold the file. A writer then retries without
/// limit.
const BUSY_TIMEOUT: Duration = Duration::from_secs(60);

/// Why a store could not be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ResultsError {
    /// The file has other content than was written.
    #[error("{}: damaged: {reason}", .path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What SQLite says.
        reason: String,
    },
    /// The file could not be read or written.
    #[error("{}: {reason}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What SQLite says.
        reason: String,
    },
}

/// Sorts an error of SQLite into damage and failures of the system.
fn map_sqlite_error(path: &Path, error: &rusqlite::Error) -> ResultsError {
    let (path, reason) = (path.to_owned(), error.to_string());
    let damaged = match error {
        rusqlite::Error::SqliteFailure(failure, _) => matches!(
            failure.code,
            ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase | ErrorCode::Unknown
        ),
        // A missing column or table, or a value of the wrong type.
        _ => true,
    };
    if damaged {
        ResultsError::Damaged { path, reason }
    } else {
        ResultsError::Io { path, reason }
    }
}

/// Retries an action while another process holds the file.
fn retry_while_busy<T>(mut act: impl FnMut() -> rusqlite::Result<T>) -> rusqlite::Result<T> {
    loop {
        match act() {
            Err(rusqlite::Error::SqliteFailure(failure, _))
                if matches!(
                    failure.code,
                    ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked
                ) => {}
            result => return result,
        }
    }
}

/// The store that a process writes.
#[derive(Debug)]
pub struct ResultStore {
    connection: Connection,
    configuration: String,
    path: PathBuf,
}

impl ResultStore {
    /// Opens or creates the store of a configuration, given by its hash.
    ///
    /// # Errors
    /// It is damaged, or cannot be written.
    pub fn open(path: &Path, configuration: &str) -> Result<Self, ResultsError> {
        let open = || {
            let connection = Connection::open(path)?;
            connection.busy_timeout(BUSY_TIMEOUT)?;
            // Each commit and the removal of its journal are on disk before it is reported.
            connection
                .execute_batch("PRAGMA journal_mode = DELETE; PRAGMA synchronous = EXTRA;")?;
            connection.execute_batch(&schema())?;
            // Check that it can be written, and that its small tables are readable.
            connection.execute("DELETE FROM started WHERE spot < 0", [])?;
            for table in ["timing", "started", "suspects"] {
                let count = format!("SELECT count(*) FROM {table}");
                connection.query_row(&count, [], |row| row.get::<_, i64>(0))?;
            }
            Ok(connection)
        };
        let connection = retry_while_busy(open).map_err(|error| map_sqlite_error(path, &error))?;
        Ok(Self {
            connection,
            configuration: configuration.to_owned(),
            path: path.to_owned(),
        })
    }

    /// Records that a spot is being computed, so that one that aborts the program can be found.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn begin_spot(&mut self, spot: usize) -> Result<(), ResultsError> {
        let start = "INSERT OR REPLACE INTO started VALUES (?1)";
        retry_while_busy(|| self.connection.execute(start, [spot as i64]))
            .map(|_| ())
            .map_err(|error| map_sqlite_error(&self.path, &error))
    }

    /// Saves the rows of a spot; they are synced when this returns. `seconds` is the time that they
    /// took.
    ///
    /// # Errors
    /// They cannot be written; then none of them is saved.
    pub fn finish_spot(
        &mut self,
        spot: usize,
        rows: &[ResultRow],
        seconds: f64,
    ) -> Result<(), ResultsError> {
        let (configuration, path) = (&self.configuration, &self.path);
        let write = || {
            let transaction = self.connection.transaction()?;
            for row in rows {
                insert(&transaction, configuration, row)?;
                transaction.execute(
                    "INSERT OR REPLACE INTO timing VALUES (?1, ?2)",
                    params![row.job as i64, seconds / rows.len() as f64],
                )?;
            }
            transaction.execute("DELETE FROM started WHERE spot = ?1", [spot as i64])?;
            transaction.commit()
        };
        retry_while_busy(write).map_err(|error: rusqlite::Error| map_sqlite_error(path, &error))
    }

    /// After a run that aborted: counts an abort for each spot that was being computed. After any
    /// other run: forgets what was being computed. Returns the spots with the number of their
    /// aborts.
    ///
    /// # Errors
    /// It cannot be read or written.
    pub fn count_aborts(&mut self, aborted: bool) -> Result<Vec<(usize, u32)>, ResultsError> {
        let path = self.path.clone();
        let mut act = || {
            let transaction = self.connection.transaction()?;
            if aborted {
                transaction.execute(
                    "INSERT INTO suspects SELECT spot, 1 FROM started WHERE true
                     ON CONFLICT (spot) DO UPDATE SET aborts = aborts + 1",
                    [],
                )?;
            }
            transaction.execute("DELETE FROM started", [])?;
            let found = {
                let mut statement =
                    transaction.prepare("SELECT spot, aborts FROM suspects ORDER BY spot")?;
                let rows = statement.query_map([], |row| {
                    Ok((row.get::<_, i64>(0)? as usize, row.get::<_, u32>(1)?))
                })?;
                rows.collect::<Result<Vec<_>, _>>()?
            };
            transaction.commit()?;
            Ok(found)
        };
        retry_while_busy(&mut act).map_err(|error: rusqlite::Error| map_sqlite_error(&path, &error))
    }

    /// Saves rows of another store.
    ///
    /// # Errors
    /// They cannot be written; then none of them is saved.
    pub fn save_copies(&mut self, rows: &[ResultRow]) -> Result<(), ResultsError> {
        let (configuration, path) = (&self.configuration, &self.path);
        retry_while_busy(|| {
            let transaction = self.connection.transaction()?;
            for row in rows {
                insert(&transaction, configuration, row)?;
            }
            transaction.commit()
        })
        .map_err(|error| map_sqlite_error(path, &error))
    }
}

fn insert(connection: &Connection, configuration: &str, row: &ResultRow) -> rusqlite::Result<()> {
    let marks = vec!["?"; columns::ALL.len() + 3].join(", ");
    let mut statement =
        connection.prepare_cached(&format!("INSERT OR REPLACE INTO results VALUES ({marks})"))?;
    let (job, checksum) = (row.job as i64, row.checksum(configuration));
    let mut values: Vec<&dyn ToSql> = vec![&configuration, &job];
    values.extend(row.cells().iter().map(|cell| cell as &dyn ToSql));
    values.push(&checksum);
    statement.execute(&values[..]).map(|_| ())
}

impl ToSql for Cell {
    fn to_sql(&self) -> rusqlite::Result<rusqlite::types::ToSqlOutput<'_>> {
        match self {
            Self::Null => rusqlite::types::Null.to_sql(),
            Self::Real(value) => value.to_sql(),
            Self::Integer(value) => value.to_sql(),
            Self::Text(text) => text.to_sql(),
        }
    }
}

fn schema() -> String {
    let columns: Vec<String> = columns::ALL
        .iter()
        .map(|column| {
            let of = match column.column_type {
                ColumnType::Real => "REAL",
                ColumnType::Integer => "INTEGER",
                ColumnType::Text => "TEXT",
            };
            format!("{} {of}", column.si_name())
        })
        .collect();
    format!(
        "BEGIN;
         CREATE TABLE IF NOT EXISTS results (configuration TEXT NOT NULL, job INTEGER NOT NULL, {}, checksum BLOB NOT NULL,
             PRIMARY KEY (configuration, job)) STRICT, WITHOUT ROWID;
         CREATE TABLE IF NOT EXISTS timing (job INTEGER PRIMARY KEY, seconds REAL) STRICT;
         CREATE TABLE IF NOT EXISTS started (spot INTEGER PRIMARY KEY) STRICT;
         CREATE TABLE IF NOT EXISTS suspects (spot INTEGER PRIMARY KEY, aborts INTEGER NOT NULL) STRICT;
         COMMIT;",
        columns.join(", ")
    )
}

/// The result of reading a store, besides its rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReadReport {
    /// What is wrong with the file. The rows that were read are valid all the same.
    pub damage: Option<String>,
    /// Valid rows of other configurations.
    pub foreign: u64,
}

/// Reads every valid row of a configuration in a store. If the file is damaged, each job with a
/// number below `jobs` is looked up separately, so that one bad page costs no more than its own
/// rows.
///
/// # Errors
/// The file cannot be read.
pub fn read_rows(
    path: &Path,
    configuration: &str,
    jobs: u64,
    mut receive: impl FnMut(ResultRow),
) -> Result<ReadReport, ResultsError> {
    let mut report = ReadReport::default();
    if std::fs::metadata(path).is_ok_and(|metadata| metadata.len() == 0) {
        // Its process was killed while it was created.
        return Ok(report);
    }
    let mut found = BTreeSet::new();
    let all = read_all(path, configuration, jobs, &mut |row| match row {
        Some(row) => {
            found.insert(row.job);
            receive(row);
        }
        None => report.foreign += 1,
    });
    match all {
        Ok(Integrity::Valid) => {}
        Ok(Integrity::BadRow) => {
            report.damage = Some("a row does not match its checksum".to_owned());
        }
        Err(error) => match map_sqlite_error(path, &error) {
            ResultsError::Damaged { reason, .. } => report.damage = Some(reason),
            error @ ResultsError::Io { .. } => return Err(error),
        },
    }
    if report.damage.is_some() {
        salvage(path, configuration, jobs, &mut found, &mut receive);
    }
    Ok(report)
}

/// Whether the rows of a store match their checksums.
enum Integrity {
    Valid,
    BadRow,
}

/// Gives every valid row of a configuration to `receive`, and `None` for each one of another.
fn read_all(
    path: &Path,
    configuration: &str,
    jobs: u64,
    receive: &mut dyn FnMut(Option<ResultRow>),
) -> rusqlite::Result<Integrity> {
    let connection = open_to_read(path)?;
    check_pages(&connection)?;
    check_schema(path, &connection)?;
    let query = format!("SELECT {} FROM results", column_names());
    let mut statement = connection.prepare(&query)?;
    let mut rows = statement.query([])?;
    let mut integrity = Integrity::Valid;
    while let Some(row) = rows.next()? {
        match valid_row(row) {
            Some((of, row)) => {
                receive((of == configuration && row.job < jobs).then_some(row));
            }
            None => integrity = Integrity::BadRow,
        }
    }
    Ok(integrity)
}

/// Looks up each job separately. A failure leaves a job to be computed again.
fn salvage(
    path: &Path,
    configuration: &str,
    jobs: u64,
    found: &mut BTreeSet<u64>,
    receive: &mut dyn FnMut(ResultRow),
) {
    let Ok(connection) = open_to_read(path) else {
        return;
    };
    let query = format!(
        "SELECT {} FROM results WHERE configuration = ?1 AND job = ?2",
        column_names()
    );
    for job in 0..jobs {
        if found.contains(&job) {
            continue;
        }
        let one = |statement: &mut Statement<'_>| {
            let mut rows = statement.query(params![configuration, job as i64])?;
            Ok::<_, rusqlite::Error>(rows.next()?.and_then(valid_row))
        };
        let row = connection
            .prepare_cached(&query)
            .and_then(|mut statement| one(&mut statement));
        if let Ok(Some((of, row))) = row
            && of == configuration
            && row.job == job
        {
            found.insert(job);
            receive(row);
        }
    }
}

fn open_to_read(path: &Path) -> rusqlite::Result<Connection> {
    // For writing if possible, so that an unfinished transaction of a killed process is rolled
    // back.
    let flags = OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(path, flags | OpenFlags::SQLITE_OPEN_READ_WRITE)
        .or_else(|_| {
        Connection::open_with_flags(path, flags | OpenFlags::SQLITE_OPEN_READ_ONLY)
    })?;
    connection.busy_timeout(BUSY_TIMEOUT)?;
    Ok(connection)
}

/// Asks SQLite to check the pages of the file.
fn check_pages(connection: &Connection) -> rusqlite::Result<()> {
    let answer: String = connection.query_row("PRAGMA quick_check(1)", [], |row| row.get(0))?;
    if answer == "ok" {
        return Ok(());
    }
    // A page that could not be read, such as "unable to get the page. error code=266".
    let code = answer
        .rsplit_once("error code=")
        .and_then(|(_, code)| code.trim().parse::<i32>().ok());
    Err(match code {
        Some(code) => rusqlite::Error::SqliteFailure(rusqlite::ffi::Error::new(code), Some(answer)),
        None => rusqlite::Error::InvalidColumnName(answer),
    })
}

/// Checks the tables and the header of the file. Reading rows would not detect that they are wrong.
fn check_schema(path: &Path, connection: &Connection) -> rusqlite::Result<()> {
    let layout = |connection: &Connection| -> rusqlite::Result<Vec<String>> {
        let mut statement =
            connection.prepare("SELECT sql FROM sqlite_schema WHERE sql NOT NULL ORDER BY name")?;
        let rows = statement.query_map([], |row| row.get(0))?;
        rows.collect()
    };
    let expected = Connection::open_in_memory()?;
    expected.execute_batch(&schema())?;
    let wrong = |what: &str| Err(rusqlite::Error::InvalidColumnName(what.to_owned()));
    if layout(connection)? != layout(&expected)? {
        return wrong("its tables are not those of a sweep");
    }
    // Bytes 18 and 19 of the header: the versions of the format for writing and reading.
    let mut header = [0; 20];
    let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut header));
    if read.is_ok()
        && !header[18..20]
            .iter()
            .all(|version| matches!(version, 1 | 2))
    {
        return wrong("its header has no known version");
    }
    Ok(())
}

fn column_names() -> String {
    let columns: Vec<String> = columns::ALL.iter().map(Column::si_name).collect();
    format!("configuration, job, {}, checksum", columns.join(", "))
}

/// The row with its configuration, if it matches its checksum.
fn valid_row(row: &rusqlite::Row<'_>) -> Option<(String, ResultRow)> {
    let configuration: String = row.get(0).ok()?;
    let job = u64::try_from(row.get::<_, i64>(1).ok()?).ok()?;
    let cells = columns::ALL
        .iter()
        .enumerate()
        .map(|(i, column)| {
            let index = i + 2;
            match column.column_type {
                ColumnType::Real => row
                    .get::<_, Option<f64>>(index)
                    .ok()
                    .map(|value| value.map(Cell::Real)),
                ColumnType::Integer => row
                    .get::<_, Option<i64>>(index)
                    .ok()
                    .map(|value| value.map(Cell::Integer)),
                ColumnType::Text => row
                    .get::<_, Option<String>>(index)
                    .ok()
                    .map(|value| value.map(Cell::Text)),
            }
            .map(|value| value.unwrap_or(Cell::Null))
        })
        .collect::<Option<Vec<_>>>()?;
    let checksum: Vec<u8> = row.get(columns::ALL.len() + 2).ok()?;
    let row = ResultRow::from_cells(job, cells)?;
    (row.checksum(&configuration) == checksum).then_some((configuration, row))
}

/// The number of computed jobs in a store, and their total time, s; zeros if it cannot be read.
#[must_use]
pub fn job_times(path: &Path) -> (u64, f64) {
    let read = || {
        open_to_read(path)?.query_row(
            "SELECT count(*), total(seconds) FROM timing WHERE seconds > 0",
            [],
            |row| Ok((row.get::<_, i64>(0)? as u64, row.get(1)?)),
        )
    };
    read().unwrap_or((0, 0.0))
}
