//! The results of one process in SQLite: a row for each job, each with a checksum.
//!
//! One process writes a file; any number read it meanwhile. Every finished place is committed and synced
//! before it is reported, so what is reported survives `kill -9` and, where the file system keeps its word,
//! a power cut. Each row's checksum covers its configuration, its job and every value, so a row proves
//! itself, whatever happened to the file around it.

use super::row::{COLUMNS, Cell, Row, Type};
use rusqlite::{Connection, ErrorCode, OpenFlags, Statement, ToSql, params};
use std::collections::BTreeSet;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How long one attempt waits for others that hold the file; attempts of a writer go on without end.
const PATIENCE: Duration = Duration::from_secs(60);

/// Why a store could not be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StoreError {
    /// The file is not what was written.
    #[error("{}: damaged: {reason}", .path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What SQLite says.
        reason: String,
    },
    /// The system failed.
    #[error("{}: {reason}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What SQLite says.
        reason: String,
    },
}

fn told(path: &Path, error: &rusqlite::Error) -> StoreError {
    let (path, reason) = (path.to_owned(), error.to_string());
    let damaged = match error {
        rusqlite::Error::SqliteFailure(failure, _) => matches!(
            failure.code,
            ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase | ErrorCode::Unknown
        ),
        // A column or a table that is not there, or a value that is no such value.
        _ => true,
    };
    if damaged {
        StoreError::Damaged { path, reason }
    } else {
        StoreError::Io { path, reason }
    }
}

/// Acts, again and again while somebody else holds the file.
fn patiently<T>(mut act: impl FnMut() -> rusqlite::Result<T>) -> rusqlite::Result<T> {
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
pub struct Store {
    connection: Connection,
    configuration: String,
    path: PathBuf,
}

impl Store {
    /// Opens or makes the store of a configuration (its hash).
    ///
    /// # Errors
    /// When it is damaged, or cannot be written.
    pub fn open(path: &Path, configuration: &str) -> Result<Self, StoreError> {
        let open = || {
            let connection = Connection::open(path)?;
            connection.busy_timeout(PATIENCE)?;
            // Each commit and the removal of its journal are on disk before it is reported.
            connection
                .execute_batch("PRAGMA journal_mode = DELETE; PRAGMA synchronous = EXTRA;")?;
            connection.execute_batch(&schema())?;
            // Can it be written, and are its small tables sound?
            connection.execute("DELETE FROM started WHERE place < 0", [])?;
            for table in ["timing", "started", "suspects"] {
                let count = format!("SELECT count(*) FROM {table}");
                connection.query_row(&count, [], |row| row.get::<_, i64>(0))?;
            }
            Ok(connection)
        };
        let connection = patiently(open).map_err(|error| told(path, &error))?;
        Ok(Self {
            connection,
            configuration: configuration.to_owned(),
            path: path.to_owned(),
        })
    }

    fn told(&self, error: &rusqlite::Error) -> StoreError {
        told(&self.path, error)
    }

    /// Notes that a place is being computed, so that one which aborts the program can be found.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn start(&mut self, place: usize) -> Result<(), StoreError> {
        let start = "INSERT OR REPLACE INTO started VALUES (?1)";
        patiently(|| self.connection.execute(start, [place as i64]))
            .map(|_| ())
            .map_err(|error| self.told(&error))
    }

    /// Keeps the rows of a place, synced when this returns; `seconds` is what it took.
    ///
    /// # Errors
    /// When they cannot be written; then none of them is kept.
    pub fn finish(&mut self, place: usize, rows: &[Row], seconds: f64) -> Result<(), StoreError> {
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
            transaction.execute("DELETE FROM started WHERE place = ?1", [place as i64])?;
            transaction.commit()
        };
        patiently(write).map_err(|error: rusqlite::Error| told(path, &error))
    }

    /// After a run that aborted: counts an abort against each place that was being computed. Gives the
    /// places with their aborts. After a run that ended otherwise, only forgets what was being computed.
    ///
    /// # Errors
    /// When it cannot be read or written.
    pub fn suspects(&mut self, aborted: bool) -> Result<Vec<(usize, u32)>, StoreError> {
        let path = self.path.clone();
        let mut act = || {
            let transaction = self.connection.transaction()?;
            if aborted {
                transaction.execute(
                    "INSERT INTO suspects SELECT place, 1 FROM started WHERE true
                     ON CONFLICT (place) DO UPDATE SET aborts = aborts + 1",
                    [],
                )?;
            }
            transaction.execute("DELETE FROM started", [])?;
            let found = {
                let mut statement =
                    transaction.prepare("SELECT place, aborts FROM suspects ORDER BY place")?;
                let rows = statement.query_map([], |row| {
                    Ok((row.get::<_, i64>(0)? as usize, row.get::<_, u32>(1)?))
                })?;
                rows.collect::<Result<Vec<_>, _>>()?
            };
            transaction.commit()?;
            Ok(found)
        };
        patiently(&mut act).map_err(|error: rusqlite::Error| told(&path, &error))
    }

    /// Keeps rows that another store held.
    ///
    /// # Errors
    /// When they cannot be written; then none of them is kept.
    pub fn keep(&mut self, rows: &[Row]) -> Result<(), StoreError> {
        let (configuration, path) = (&self.configuration, &self.path);
        patiently(|| {
            let transaction = self.connection.transaction()?;
            for row in rows {
                insert(&transaction, configuration, row)?;
            }
            transaction.commit()
        })
        .map_err(|error| told(path, &error))
    }
}

fn insert(connection: &Connection, configuration: &str, row: &Row) -> rusqlite::Result<()> {
    let marks = vec!["?"; COLUMNS.len() + 3].join(", ");
    let mut statement =
        connection.prepare_cached(&format!("INSERT OR REPLACE INTO results VALUES ({marks})"))?;
    let (job, checksum) = (row.job as i64, row.checksum(configuration));
    let mut values: Vec<&dyn ToSql> = vec![&configuration, &job];
    values.extend(row.cells.iter().map(|cell| cell as &dyn ToSql));
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
    let columns: Vec<String> = COLUMNS
        .iter()
        .map(|column| {
            let of = match column.of {
                Type::Real => "REAL",
                Type::Integer => "INTEGER",
                Type::Text => "TEXT",
            };
            format!("{} {of}", column.si_name())
        })
        .collect();
    format!(
        "BEGIN;
         CREATE TABLE IF NOT EXISTS results (configuration TEXT NOT NULL, job INTEGER NOT NULL, {}, checksum BLOB NOT NULL,
             PRIMARY KEY (configuration, job)) STRICT, WITHOUT ROWID;
         CREATE TABLE IF NOT EXISTS timing (job INTEGER PRIMARY KEY, seconds REAL) STRICT;
         CREATE TABLE IF NOT EXISTS started (place INTEGER PRIMARY KEY) STRICT;
         CREATE TABLE IF NOT EXISTS suspects (place INTEGER PRIMARY KEY, aborts INTEGER NOT NULL) STRICT;
         COMMIT;",
        columns.join(", ")
    )
}

/// What reading a store showed beside its rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// What is wrong with the file; the rows that were given are sound all the same.
    pub damage: Option<String>,
    /// Sound rows of other configurations.
    pub foreign: u64,
}

/// Gives every sound row of a configuration in a store, one at a time. Where the file is damaged, each of the
/// `jobs` (numbers below this) is looked up by itself, so that one bad page costs no more than its own rows.
///
/// # Errors
/// When the system fails to read it.
pub fn read(
    path: &Path,
    configuration: &str,
    jobs: u64,
    mut give: impl FnMut(Row),
) -> Result<Reading, StoreError> {
    let mut reading = Reading::default();
    if std::fs::metadata(path).is_ok_and(|about| about.len() == 0) {
        // One that was being made when its process was killed.
        return Ok(reading);
    }
    let mut given = BTreeSet::new();
    let scan = |given: &mut BTreeSet<u64>, reading: &mut Reading, give: &mut dyn FnMut(Row)| {
        let connection = open_to_read(path)?;
        check(&connection)?;
        check_schema(path, &connection)?;
        let mut statement = connection.prepare(&format!("SELECT {} FROM results", names()))?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            match sound(row) {
                Some((found, row)) if found == configuration && row.job < jobs => {
                    given.insert(row.job);
                    give(row);
                }
                Some(_) => reading.foreign += 1,
                None => reading.damage = Some("a row does not match its checksum".to_owned()),
            }
        }
        Ok(())
    };
    if let Err(error) = scan(&mut given, &mut reading, &mut give) {
        match told(path, &error) {
            StoreError::Damaged { reason, .. } => reading.damage = Some(reason),
            error => return Err(error),
        }
    }
    if reading.damage.is_some() {
        salvage(path, configuration, jobs, &mut given, &mut give);
    }
    Ok(reading)
}

/// What can still be found, job by job; every failure is a job that is computed again.
fn salvage(
    path: &Path,
    configuration: &str,
    jobs: u64,
    given: &mut BTreeSet<u64>,
    give: &mut dyn FnMut(Row),
) {
    let Ok(connection) = open_to_read(path) else {
        return;
    };
    let query = format!(
        "SELECT {} FROM results WHERE configuration = ?1 AND job = ?2",
        names()
    );
    for job in 0..jobs {
        if given.contains(&job) {
            continue;
        }
        let one = |statement: &mut Statement<'_>| {
            let mut rows = statement.query(params![configuration, job as i64])?;
            Ok::<_, rusqlite::Error>(rows.next()?.and_then(sound))
        };
        let found = connection
            .prepare_cached(&query)
            .and_then(|mut statement| one(&mut statement));
        if let Ok(Some((of, row))) = found
            && of == configuration
            && row.job == job
        {
            given.insert(job);
            give(row);
        }
    }
}

fn open_to_read(path: &Path) -> rusqlite::Result<Connection> {
    // To write if possible, so that what a killed process left half done is rolled back.
    let flags = OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(path, flags | OpenFlags::SQLITE_OPEN_READ_WRITE)
        .or_else(|_| {
        Connection::open_with_flags(path, flags | OpenFlags::SQLITE_OPEN_READ_ONLY)
    })?;
    connection.busy_timeout(PATIENCE)?;
    Ok(connection)
}

fn check(connection: &Connection) -> rusqlite::Result<()> {
    let answer: String = connection.query_row("PRAGMA quick_check(1)", [], |row| row.get(0))?;
    if answer == "ok" {
        return Ok(());
    }
    // A page that the system did not give, such as "unable to get the page. error code=266".
    let code = answer
        .rsplit_once("error code=")
        .and_then(|(_, code)| code.trim().parse::<i32>().ok());
    Err(match code {
        Some(code) => rusqlite::Error::SqliteFailure(rusqlite::ffi::Error::new(code), Some(answer)),
        None => rusqlite::Error::InvalidColumnName(answer),
    })
}

/// Is it laid out as we do, and marked as one that may be written? Reading alone would not show it.
fn check_schema(path: &Path, connection: &Connection) -> rusqlite::Result<()> {
    let layout = |connection: &Connection| -> rusqlite::Result<Vec<String>> {
        let mut statement =
            connection.prepare("SELECT sql FROM sqlite_schema WHERE sql NOT NULL ORDER BY name")?;
        let rows = statement.query_map([], |row| row.get(0))?;
        rows.collect()
    };
    let ours = Connection::open_in_memory()?;
    ours.execute_batch(&schema())?;
    let wrong = |what: &str| Err(rusqlite::Error::InvalidColumnName(what.to_owned()));
    if layout(connection)? != layout(&ours)? {
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
        return wrong("its header is of no known version");
    }
    Ok(())
}

fn names() -> String {
    let columns: Vec<String> = COLUMNS.iter().map(super::row::Column::si_name).collect();
    format!("configuration, job, {}, checksum", columns.join(", "))
}

/// The row and its configuration, if it matches its checksum.
fn sound(row: &rusqlite::Row<'_>) -> Option<(String, Row)> {
    let configuration: String = row.get(0).ok()?;
    let job = u64::try_from(row.get::<_, i64>(1).ok()?).ok()?;
    let cells = COLUMNS
        .iter()
        .enumerate()
        .map(|(i, column)| {
            let place = i + 2;
            match column.of {
                Type::Real => row
                    .get::<_, Option<f64>>(place)
                    .ok()
                    .map(|value| value.map(Cell::Real)),
                Type::Integer => row
                    .get::<_, Option<i64>>(place)
                    .ok()
                    .map(|value| value.map(Cell::Integer)),
                Type::Text => row
                    .get::<_, Option<String>>(place)
                    .ok()
                    .map(|value| value.map(Cell::Text)),
            }
            .map(|value| value.unwrap_or(Cell::Null))
        })
        .collect::<Option<Vec<_>>>()?;
    let checksum: Vec<u8> = row.get(COLUMNS.len() + 2).ok()?;
    let row = Row { job, cells };
    (row.checksum(&configuration) == checksum).then_some((configuration, row))
}

/// What the jobs of a store took: how many, and seconds in all; nothing where it cannot be read.
#[must_use]
pub fn timing(path: &Path) -> (u64, f64) {
    let read = || {
        open_to_read(path)?.query_row(
            "SELECT count(*), total(seconds) FROM timing WHERE seconds > 0",
            [],
            |row| Ok((row.get::<_, i64>(0)? as u64, row.get(1)?)),
        )
    };
    read().unwrap_or((0, 0.0))
}
