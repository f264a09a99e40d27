//! Splits a CSV text into records with their line numbers, in bounded memory.
//!
//! The `csv` crate decodes the records; this scanner only finds where they end. So it can say on
//! which line a quote was opened that is never closed, and go on after that line instead of
//! swallowing the rest of the file.

use csv::ByteRecord;
use std::io::{self, Read};

/// Longest record, bytes.
pub const MAX_RECORD_BYTES: usize = 1 << 20;
/// Bytes that are read at a time.
const READ_BYTES: usize = 1 << 18;

/// One row of a file, and where it stands there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Number of its line in a CSV file, of its row in a Parquet file; from 1.
    pub number: u64,
    /// Its cells, or why it cannot be read.
    pub cells: Result<ByteRecord, String>,
}

/// The records of a CSV text.
#[derive(Debug)]
pub struct CsvRecords<R> {
    input: R,
    /// What stands between two cells.
    separator: u8,
    buffer: Vec<u8>,
    /// Where the next record starts in the buffer.
    start: usize,
    /// The line of that place, from 1.
    line: u64,
    at_end: bool,
    /// Empty lines that were passed and not reported: the first one, and their number.
    empty_lines: (u64, u64),
    /// The end of the next record, found while empty lines before it were not reported yet.
    found: Option<End>,
    bytes_read: u64,
}

/// Where a record ends.
#[derive(Debug)]
enum End {
    /// Length with the end of its line, if it has one.
    Complete(usize),
    /// A quote on this line is not closed; the length up to the end of that line.
    OpenQuote { line: u64, length: usize },
    /// Longer than [`MAX_RECORD_BYTES`].
    TooLong,
}

impl<R: Read> CsvRecords<R> {
    /// The records of a text. A byte order mark at its start is skipped.
    ///
    /// # Errors
    /// The text cannot be read.
    pub fn new(input: R) -> io::Result<Self> {
        let mut records = Self {
            input,
            separator: b',',
            buffer: Vec::new(),
            start: 0,
            line: 1,
            at_end: false,
            empty_lines: (0, 0),
            found: None,
            bytes_read: 0,
        };
        while records.buffer.len() < 3 && !records.at_end {
            records.read_more()?;
        }
        if records.buffer.starts_with(b"\xef\xbb\xbf") {
            records.start = 3;
        }
        Ok(records)
    }

    /// Records of a text whose cells may be separated by semicolons or tabs: where more of its
    /// first lines have two or more of them outside quotes than not. (A comma between digits may be
    /// a decimal comma, and a title above the table has none.)
    ///
    /// # Errors
    /// The text cannot be read.
    pub fn with_any_separator(input: R) -> io::Result<Self> {
        /// Lines that are looked at.
        const LINES: usize = 40;
        let mut records = Self::new(input)?;
        let text = &records.buffer[records.start..];
        let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let lines = text
            .split(is_end)
            .filter(|line| !line.trim_ascii().is_empty());
        let lines: Vec<&[u8]> = lines.take(LINES).collect();
        // A spreadsheet may say it above the names.
        if let Some([separator @ (b',' | b';' | b'\t')]) =
            lines.first().and_then(|line| line.strip_prefix(b"sep="))
        {
            records.separator = *separator;
            return Ok(records);
        }
        let votes = |separator| {
            let of_separator = lines
                .iter()
                .filter(|line| separator_of(line) == Some(separator));
            of_separator.count()
        };
        for separator in [b';', b'\t'] {
            if votes(separator) > votes(records.separator) {
                records.separator = separator;
            }
        }
        Ok(records)
    }

    /// What stands between two cells.
    #[must_use]
    pub fn separator(&self) -> u8 {
        self.separator
    }

    /// Bytes read so far.
    #[must_use]
    pub fn bytes_read(&self) -> u64 {
        self.bytes_read
    }

    fn read_more(&mut self) -> io::Result<()> {
        self.buffer.drain(..self.start);
        self.start = 0;
        let old = self.buffer.len();
        self.buffer.resize(old + READ_BYTES, 0);
        let read = loop {
            match self.input.read(&mut self.buffer[old..]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                result => break result,
            }
        };
        self.buffer.truncate(old + *read.as_ref().unwrap_or(&0));
        self.at_end = read? == 0;
        self.bytes_read += (self.buffer.len() - old) as u64;
        Ok(())
    }

    /// The end of the record at `self.start`, whose bytes are then all in the buffer; `None` at the
    /// end of the text.
    fn find_end(&mut self) -> io::Result<Option<End>> {
        let mut scan = Scan {
            separator: self.separator,
            ..Scan::default()
        };
        loop {
            let record = &self.buffer[self.start..];
            if let Some(length) = scan.advance(record, self.at_end) {
                return Ok(Some(End::Complete(length)));
            }
            let is_open = scan.is_misplaced || (scan.quote.is_some() && self.at_end);
            if is_open || record.len() > MAX_RECORD_BYTES {
                return Ok(Some(match scan.quote {
                    Some(quote) => {
                        let line = self.line + count_lines(&record[..quote]);
                        let length = line_end(record, quote);
                        End::OpenQuote { line, length }
                    }
                    None => End::TooLong,
                }));
            }
            if self.at_end {
                return Ok((!record.is_empty()).then_some(End::Complete(record.len())));
            }
            self.read_more()?;
        }
    }

    /// Skips the rest of a line that is too long to be kept.
    fn skip_line(&mut self) -> io::Result<()> {
        loop {
            if let Some(end) = memchr::memchr2(b'\n', b'\r', &self.buffer[self.start..]) {
                let is_pair = self.buffer[self.start + end..].starts_with(b"\r\n");
                self.start += end + 1 + usize::from(is_pair);
                self.line += 1;
                return Ok(());
            }
            self.start = self.buffer.len();
            if self.at_end {
                return Ok(());
            }
            self.read_more()?;
        }
    }

    /// The bytes of the next record with its line, or why it cannot be read; `None` at the end.
    fn next_bytes(&mut self) -> io::Result<Option<(u64, Result<&[u8], String>)>> {
        loop {
            let end = match self.found.take() {
                Some(end) => end,
                None => match self.find_end()? {
                    Some(end) => end,
                    // Empty lines at the end are no rows.
                    None => return Ok(None),
                },
            };
            let line = self.line;
            if let End::Complete(length) = end {
                let record = &self.buffer[self.start..self.start + length];
                if matches!(record, b"\n" | b"\r\n" | b"\r" | b"") {
                    if self.empty_lines.1 == 0 {
                        self.empty_lines.0 = line;
                    }
                    self.empty_lines.1 += 1;
                    self.start += length;
                    self.line += 1;
                    continue;
                }
            }
            if self.empty_lines.1 > 0 {
                let (line, more) = self.empty_lines;
                self.empty_lines = (line + 1, more - 1);
                self.found = Some(end);
                return Ok(Some((line, Err("is empty".to_owned()))));
            }
            return Ok(Some(match end {
                End::Complete(length) => {
                    let record = &self.buffer[self.start..self.start + length];
                    self.start += length;
                    self.line += count_lines(record);
                    (line, Ok(record))
                }
                End::OpenQuote { line, length } => {
                    let record = &self.buffer[self.start..self.start + length];
                    self.line += count_lines(record);
                    self.start += length;
                    (
                        line,
                        Err("a quote is opened here and not closed".to_owned()),
                    )
                }
                End::TooLong => {
                    self.skip_line()?;
                    let reason = format!("is longer than {MAX_RECORD_BYTES} bytes");
                    (line, Err(reason))
                }
            }));
        }
    }

    /// The next rows: at most `most`, and about `bytes` bytes.
    ///
    /// # Errors
    /// The text cannot be read.
    pub fn next_rows(&mut self, most: usize, bytes: usize) -> io::Result<Vec<Row>> {
        // The reader skips the empty line. At the start it would also skip the bytes of a byte
        // order mark.
        let mut text = b"\n".to_vec();
        let mut rows = Vec::new();
        while rows.len() < most && text.len() <= bytes {
            let Some((number, record)) = self.next_bytes()? else {
                break;
            };
            let cells = record.map(|record| {
                let end = record.strip_suffix(b"\n").unwrap_or(record);
                text.extend_from_slice(end.strip_suffix(b"\r").unwrap_or(end));
                text.push(b'\n');
                ByteRecord::new()
            });
            rows.push(Row { number, cells });
        }
        let mut decoded = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(self.separator)
            .from_reader(&text[..])
            .into_byte_records();
        for row in &mut rows {
            if let Ok(cells) = &mut row.cells {
                match decoded.next() {
                    Some(Ok(record)) => *cells = record,
                    _ => row.cells = Err("is not CSV".to_owned()),
                }
            }
        }
        Ok(rows)
    }
}

/// What separates the cells of a line, if anything does.
fn separator_of(line: &[u8]) -> Option<u8> {
    // Every other part between quotes is inside them.
    let parts: Vec<&[u8]> = line.split(|byte| *byte == b'"').step_by(2).collect();
    let count = |separator| -> usize {
        let counts = parts
            .iter()
            .map(|part| memchr::memchr_iter(separator, part).count());
        counts.sum()
    };
    let is_decimal = |part: &&[u8]| {
        let is_digit = |at: Option<usize>| {
            at.and_then(|at| part.get(at))
                .is_some_and(u8::is_ascii_digit)
        };
        memchr::memchr_iter(b',', part)
            .all(|at| is_digit(at.checked_sub(1)) && is_digit(Some(at + 1)))
    };
    let commas = match parts.iter().all(is_decimal) {
        true => 0,
        false => count(b','),
    };
    let other = [b';', b'\t']
        .into_iter()
        .find(|separator| count(*separator) > commas.max(1));
    other.or_else(|| (count(b',') > 0).then_some(b','))
}

/// The number of ends of lines: a line feed, a carriage return, or both.
fn count_lines(bytes: &[u8]) -> u64 {
    let ends = memchr::memchr2_iter(b'\n', b'\r', bytes);
    ends.filter(|&at| bytes[at] == b'\n' || bytes.get(at + 1) != Some(&b'\n'))
        .count() as u64
}

/// The length of a record up to the end of the line on which position `from` stands.
fn line_end(record: &[u8], from: usize) -> usize {
    let rest = &record[from..];
    memchr::memchr2(b'\n', b'\r', rest).map_or(record.len(), |end| {
        let is_pair = rest[end..].starts_with(b"\r\n");
        from + end + 1 + usize::from(is_pair)
    })
}

/// The scan of one record, from its start as far as its bytes are known.
#[derive(Default)]
struct Scan {
    separator: u8,
    /// Bytes that have been scanned.
    position: usize,
    /// Where the open quote is.
    quote: Option<usize>,
    /// A quote that spans lines is followed by more text in its cell: it was not meant to be closed
    /// there.
    is_misplaced: bool,
}

impl Scan {
    /// Scans on; returns the length of the record with the end of its line, once that is known.
    /// `at_end`: the record has all bytes of the text.
    fn advance(&mut self, record: &[u8], at_end: bool) -> Option<usize> {
        while !self.is_misplaced && self.position < record.len() {
            let rest = &record[self.position..];
            if let Some(quote) = self.quote {
                let Some(next) = memchr::memchr(b'"', rest) else {
                    self.position = record.len();
                    break;
                };
                let at = self.position + next;
                if record.get(at + 1) == Some(&b'"') {
                    self.position = at + 2;
                    continue;
                }
                // What follows decides whether this quote closes the cell. Blanks may stand
                // between.
                let is_blank =
                    |byte: &&u8| matches!(byte, b' ' | b'\t') && **byte != self.separator;
                let blanks = record[at + 1..].iter().take_while(is_blank).count();
                let closes = match record.get(at + 1 + blanks) {
                    None if !at_end => {
                        self.position = at;
                        break;
                    }
                    None | Some(b'\n' | b'\r') => true,
                    Some(byte) if *byte == self.separator => true,
                    Some(_) => memchr::memchr2(b'\n', b'\r', &record[quote..at]).is_none(),
                };
                if closes {
                    self.quote = None;
                    self.position = at + 1;
                } else {
                    self.is_misplaced = true;
                }
                continue;
            }
            let Some(next) = memchr::memchr3(b'"', b'\n', b'\r', rest) else {
                self.position = record.len();
                break;
            };
            let at = self.position + next;
            match record[at] {
                b'\n' => return Some(at + 1),
                b'\r' => match record.get(at + 1) {
                    Some(b'\n') => return Some(at + 2),
                    None if !at_end => {
                        self.position = at;
                        break;
                    }
                    _ => return Some(at + 1),
                },
                _ => {
                    self.position = at + 1;
                    if at == 0 || record[at - 1] == self.separator {
                        self.quote = Some(at);
                    }
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives its bytes one at a time, so that every boundary of a read is tried.
    struct Drip<'a>(&'a [u8]);

    impl Read for Drip<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let n = self.0.len().min(1);
            buffer[..n].copy_from_slice(&self.0[..n]);
            self.0 = &self.0[n..];
            Ok(n)
        }
    }

    fn rows(text: &[u8]) -> Vec<(u64, Result<Vec<String>, String>)> {
        let read = |input: &mut dyn Read| -> Vec<Row> {
            let mut records = CsvRecords::new(input).unwrap();
            let mut all = Vec::new();
            loop {
                let rows = records.next_rows(2, 1 << 20).unwrap();
                if rows.is_empty() {
                    return all;
                }
                all.extend(rows);
            }
        };
        let all = read(&mut &text[..]);
        assert_eq!(all, read(&mut Drip(text)));
        let cells = |record: ByteRecord| {
            let cells = record
                .iter()
                .map(|cell| String::from_utf8_lossy(cell).into_owned());
            cells.collect()
        };
        all.into_iter()
            .map(|row| (row.number, row.cells.map(cells)))
            .collect()
    }

    fn cells(cells: &[&str]) -> Result<Vec<String>, String> {
        Ok(cells.iter().map(|cell| (*cell).to_owned()).collect())
    }

    #[test]
    fn contract_rows_have_the_lines_of_the_file() {
        let text = b"\xef\xbb\xbfa,b\r\n\"x\n\"\"y\",1\n\n\n2,3\nq\"q,4\n5,6";
        let empty = || Err("is empty".to_owned());
        let expected = vec![
            (1, cells(&["a", "b"])),
            (2, cells(&["x\n\"y", "1"])),
            (4, empty()),
            (5, empty()),
            (6, cells(&["2", "3"])),
            (7, cells(&["q\"q", "4"])),
            (8, cells(&["5", "6"])),
        ];
        assert_eq!(rows(text), expected);
        assert_eq!(rows(b"a\n\n\n"), vec![(1, cells(&["a"]))]);
        assert_eq!(rows(b""), vec![]);
    }

    #[test]
    fn contract_an_open_quote_costs_one_line() {
        let open = || Err("a quote is opened here and not closed".to_owned());
        let expected = vec![(1, cells(&["1"])), (2, open()), (3, cells(&["3", "4"]))];
        assert_eq!(rows(b"1\n2,\"x\n3,4\n"), expected);
        // The quote of another row does not close it.
        let expected = vec![(1, open()), (2, cells(&["2"])), (3, cells(&["3", "b"]))];
        assert_eq!(rows(b"1,\"a\n2\n3,\"b\"\n"), expected);
    }

    #[test]
    fn contract_every_end_of_a_line_and_of_the_text_is_known() {
        let expected = vec![
            (1, cells(&["a", "b"])),
            (2, cells(&["1", "x"])),
            (3, cells(&["2", "y"])),
        ];
        for text in [
            &b"a,b\n1,x\n2,y\n"[..],
            b"a,b\r1,x\r2,y",
            b"a,b\r\n1,x\r\n2,\"y\"",
            b"a,b\r1,\"x\"\r\n2,\"y\"\r",
        ] {
            assert_eq!(rows(text), expected, "{}", text.escape_ascii());
        }
        let blank = (2, Err("is empty".to_owned()));
        assert_eq!(rows(b"a\n\r\r\nb\n")[1], blank);
        // Text after a closing quote, on one line and after blanks.
        assert_eq!(rows(b"\"a\" ,b\n")[0].1, cells(&["a ", "b"]));
        assert_eq!(rows(b"\"a\nc\" ,b\n2\n")[1], (3, cells(&["2"])));
    }

    #[test]
    fn contract_a_record_is_of_bounded_length() {
        let mut text = b"1\n".to_vec();
        text.resize(MAX_RECORD_BYTES + READ_BYTES + 100, b'x');
        text.extend_from_slice(b"\n3\n");
        let found = {
            let mut records = CsvRecords::new(&text[..]).unwrap();
            records.next_rows(10, 1 << 22).unwrap()
        };
        assert_eq!(found.len(), 3);
        assert!(
            found[1]
                .cells
                .as_ref()
                .is_err_and(|reason| reason.contains("longer than"))
        );
        assert_eq!(found[2].number, 3);
    }

    /// A separator in quotes belongs to its cell, and a comma in a name does not make a table of
    /// commas.
    #[test]
    fn contract_semicolons_and_tabs_separate_cells() {
        let cells_of = |text: &str| -> Vec<Vec<String>> {
            let mut records = CsvRecords::with_any_separator(text.as_bytes()).unwrap();
            let rows = records.next_rows(10, 1000).unwrap().into_iter();
            rows.filter_map(|row| row.cells.ok())
                .map(|cells| {
                    cells
                        .iter()
                        .map(|c| String::from_utf8_lossy(c).into())
                        .collect()
                })
                .collect()
        };
        for (text, expected) in [
            (
                "\na;\"b;, c\";d\n1,5;2;3\n",
                [["a", "b;, c", "d"], ["1,5", "2", "3"]],
            ),
            (
                "a\t\"b\tc\"\td\n\"1\"\t2\t3\n",
                [["a", "b\tc", "d"], ["1", "2", "3"]],
            ),
            (
                "a,\"b;c;d\",e\n1,2,3\n",
                [["a", "b;c;d", "e"], ["1", "2", "3"]],
            ),
        ] {
            assert_eq!(cells_of(text), expected, "{text:?}");
        }
    }
}
