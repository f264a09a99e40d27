//! What a file is, by its first bytes and not by its name.

use std::path::Path;

/// A file of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// Cells between separators.
    Text,
    /// Parquet.
    Parquet,
    /// A workbook of a spreadsheet program.
    Workbook,
    /// JSON.
    Json,
}

/// Bytes at the beginning of files that are no tables, and what to do with them.
const FOREIGN: [(&[u8], &str); 6] = [
    (b"\x1f\x8b", "is a gzip archive: unpack it first"),
    (b"BZh", "is a bzip2 archive: unpack it first"),
    (b"%PDF", "is a PDF: export the numbers as CSV"),
    (b"\x89PNG", "is a picture: export the numbers as CSV"),
    (b"\xff\xd8\xff", "is a picture: export the numbers as CSV"),
    (b"SQLite format 3", "is a database: export the table as CSV"),
];

impl FileKind {
    /// The kind of a file with these first bytes (64 or more, if the file has them).
    ///
    /// # Errors
    /// The file is no table; what to do with it.
    pub fn of(path: &Path, first: &[u8]) -> Result<Self, String> {
        let first = first.strip_prefix(b"\xef\xbb\xbf").unwrap_or(first);
        if first.starts_with(b"PAR1") {
            return Ok(Self::Parquet);
        }
        // A zip archive, which new workbooks are, or the container of old ones.
        if first.starts_with(b"PK\x03\x04") || first.starts_with(b"\xd0\xcf\x11\xe0") {
            return Ok(Self::Workbook);
        }
        if let Some((_, words)) = FOREIGN.iter().find(|(magic, _)| first.starts_with(magic)) {
            return Err((*words).to_owned());
        }
        let is_c3d = first.len() > 1 && first[0] <= 16 && first[1] == 0x50;
        if is_c3d {
            return Err(
                "is a C3D file of motion capture: export the marker of the ball as CSV, with the columns shot, time_s, x_m, y_m and z_m"
                    .to_owned(),
            );
        }
        if first.trim_ascii_start().starts_with(b"{") || first.trim_ascii_start().starts_with(b"[")
        {
            return Ok(Self::Json);
        }
        let is_wide = first.starts_with(b"\xff\xfe") || first.starts_with(b"\xfe\xff");
        let zeros = first.iter().filter(|byte| **byte == 0).count();
        // Text of two bytes a letter has a zero in every other one.
        let few = zeros > 0 && zeros < first.len() / 4;
        if zeros > first.len() / 2 + 1 || few && !is_wide {
            let name = path.extension().map(|end| end.to_string_lossy());
            let name = name.map_or(String::new(), |end| format!(" (.{end})"));
            return Err(format!(
                "is no text{name}: export it as CSV, or save the sheet as CSV"
            ));
        }
        Ok(Self::Text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_the_content_says_what_a_file_is() {
        let kind = |bytes: &[u8]| FileKind::of(Path::new("shots.csv"), bytes);
        for (bytes, expected) in [
            (&b"PAR1\x15\x04"[..], FileKind::Parquet),
            (b"PK\x03\x04\x14\x00", FileKind::Workbook),
            (b"\xef\xbb\xbf [ {\"a\": 1}]", FileKind::Json),
            (b"a,b\n1,2\n", FileKind::Text),
            (b"\xff\xfea\0,\0b\0\n\0", FileKind::Text),
            (b"a\0,\0b\0\n\0", FileKind::Text),
            (b"", FileKind::Text),
        ] {
            assert_eq!(kind(bytes), Ok(expected), "{}", bytes.escape_ascii());
        }
        for (bytes, words) in [
            (&b"\x1f\x8b\x08"[..], "gzip"),
            (b"%PDF-1.7", "PDF"),
            (b"\x02\x50\x06", "C3D"),
            (b"\x7fELF\x02\x01\x01\0\0abcdefghijkl", "is no text (.csv)"),
        ] {
            let error = kind(bytes).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }
}
