//! A Parquet file whose headers are possible. The library counts down lists that say they have
//! billions of elements of no bytes, and skips bytes behind the end of a file: from two thousand
//! bytes it would read for hours.
//!
//! Headers are Thrift structures in the compact protocol
//! (<https://github.com/apache/thrift/blob/master/doc/specs/thrift-compact-protocol.md>). Each
//! element of a list has a byte at least, so a header has no more elements than bytes. The library
//! reads a field that it knows by its number, whatever type the file gives it; so these must have
//! their types, those of <https://github.com/apache/parquet-format>, `parquet.thrift`.

use bytes::Bytes;
use parquet::errors::{ParquetError, Result};
use parquet::file::reader::{ChunkReader, Length};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

/// Bytes at the end of a file: the length of its metadata, and a mark.
const END_BYTES: u64 = 8;
/// Bytes that are read of a page's header at first. Statistics can make it longer.
const HEADER_BYTES: u64 = 1 << 13;
/// Most bytes of a page, unpacked. Writers make pages of about a million bytes.
const MAX_PAGE_BYTES: u64 = 1 << 28;
/// Structures in structures, at most.
const MOST_LEVELS: u32 = 32;

/// A file that gives the library no header that is impossible.
pub(super) struct CheckedFile(pub(super) File);

impl Length for CheckedFile {
    fn len(&self) -> u64 {
        Length::len(&self.0)
    }
}

impl ChunkReader for CheckedFile {
    type T = Header;

    /// The header of a page, or the end of the file.
    fn get_read(&self, start: u64) -> Result<Header> {
        let left = Length::len(self).saturating_sub(start);
        let mut most = if left == END_BYTES {
            END_BYTES
        } else {
            HEADER_BYTES
        };
        loop {
            let mut bytes = Vec::new();
            let mut file = self.0.try_clone()?;
            file.seek(SeekFrom::Start(start))?;
            file.take(most).read_to_end(&mut bytes)?;
            let header = match left {
                END_BYTES => Ok(()),
                _ => is_possible(&bytes, PAGE),
            };
            match header {
                Err(Fault::Ends) if most < left => most *= 16,
                Err(_) => return Err(damaged()),
                Ok(()) => return Ok(Header(io::Cursor::new(bytes))),
            }
        }
    }

    /// A page, or the metadata in front of the end of the file.
    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        let bytes = self.0.get_bytes(start, length)?;
        let is_metadata = start.saturating_add(length as u64 + END_BYTES) == Length::len(self);
        if is_metadata && is_possible(&bytes, FILE).is_err() {
            return Err(damaged());
        }
        Ok(bytes)
    }
}

fn damaged() -> ParquetError {
    ParquetError::General("the file is damaged: a header is impossible".into())
}

/// Bytes whose end is an error: to skip bytes behind it must not succeed.
pub(super) struct Header(io::Cursor<Vec<u8>>);

impl Read for Header {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        match self.0.read(to)? {
            0 if !to.is_empty() => Err(io::ErrorKind::UnexpectedEof.into()),
            read => Ok(read),
        }
    }
}

/// The type of a field that the library knows.
#[derive(Clone, Copy)]
enum Of {
    Bool,
    Byte,
    /// An integer of any size.
    Number,
    /// The number of bytes of a page, unpacked.
    PageBytes,
    Double,
    Bytes,
    List(&'static Of),
    Fields(Fields),
}

/// The numbers and types of the fields of a structure that the library knows.
type Fields = &'static [(i16, Of)];

const EMPTY: Of = Of::Fields(&[]);
const STATISTICS: Of = Of::Fields(&[
    (1, Of::Bytes),
    (2, Of::Bytes),
    (3, Of::Number),
    (4, Of::Number),
    (5, Of::Bytes),
    (6, Of::Bytes),
    (7, Of::Bool),
    (8, Of::Bool),
    (9, Of::Number),
]);
/// `PageHeader`.
const PAGE: Fields = &[
    (1, Of::Number),
    (2, Of::PageBytes),
    (3, Of::Number),
    (4, Of::Number),
    (
        5,
        Of::Fields(&[
            (1, Of::Number),
            (2, Of::Number),
            (3, Of::Number),
            (4, Of::Number),
            (5, STATISTICS),
        ]),
    ),
    (6, EMPTY),
    (
        7,
        Of::Fields(&[(1, Of::Number), (2, Of::Number), (3, Of::Bool)]),
    ),
    (
        8,
        Of::Fields(&[
            (1, Of::Number),
            (2, Of::Number),
            (3, Of::Number),
            (4, Of::Number),
            (5, Of::Number),
            (6, Of::Number),
            (7, Of::Bool),
            (8, STATISTICS),
        ]),
    ),
];
/// `TimeType` and `TimestampType`.
const TIME: Of = Of::Fields(&[
    (1, Of::Bool),
    (2, Of::Fields(&[(1, EMPTY), (2, EMPTY), (3, EMPTY)])),
]);
const LOGICAL_TYPE: Of = Of::Fields(&[
    (1, EMPTY),
    (2, EMPTY),
    (3, EMPTY),
    (4, EMPTY),
    (5, Of::Fields(&[(1, Of::Number), (2, Of::Number)])),
    (6, EMPTY),
    (7, TIME),
    (8, TIME),
    (10, Of::Fields(&[(1, Of::Byte), (2, Of::Bool)])),
    (11, EMPTY),
    (12, EMPTY),
    (13, EMPTY),
    (14, EMPTY),
    (15, EMPTY),
    (16, Of::Fields(&[(1, Of::Byte)])),
    (17, Of::Fields(&[(1, Of::Bytes)])),
    (18, Of::Fields(&[(1, Of::Bytes), (2, Of::Number)])),
    (19, EMPTY),
]);
const SCHEMA_ELEMENT: Of = Of::Fields(&[
    (1, Of::Number),
    (2, Of::Number),
    (3, Of::Number),
    (4, Of::Bytes),
    (5, Of::Number),
    (6, Of::Number),
    (7, Of::Number),
    (8, Of::Number),
    (9, Of::Number),
    (10, LOGICAL_TYPE),
]);
const KEY_VALUE: Of = Of::Fields(&[(1, Of::Bytes), (2, Of::Bytes)]);
const ENCODING_STATISTICS: Of = Of::Fields(&[(1, Of::Number), (2, Of::Number), (3, Of::Number)]);
const BOUNDING_BOX: Of = Of::Fields(&[
    (1, Of::Double),
    (2, Of::Double),
    (3, Of::Double),
    (4, Of::Double),
    (5, Of::Double),
    (6, Of::Double),
    (7, Of::Double),
    (8, Of::Double),
]);
const COLUMN: Of = Of::Fields(&[
    (1, Of::Number),
    (2, Of::List(&Of::Number)),
    (3, Of::List(&Of::Bytes)),
    (4, Of::Number),
    (5, Of::Number),
    (6, Of::Number),
    (7, Of::Number),
    (8, Of::List(&KEY_VALUE)),
    (9, Of::Number),
    (10, Of::Number),
    (11, Of::Number),
    (12, STATISTICS),
    (13, Of::List(&ENCODING_STATISTICS)),
    (14, Of::Number),
    (15, Of::Number),
    (
        16,
        Of::Fields(&[
            (1, Of::Number),
            (2, Of::List(&Of::Number)),
            (3, Of::List(&Of::Number)),
        ]),
    ),
    (
        17,
        Of::Fields(&[(1, BOUNDING_BOX), (2, Of::List(&Of::Number))]),
    ),
]);
const CHUNK: Of = Of::Fields(&[
    (1, Of::Bytes),
    (2, Of::Number),
    (3, COLUMN),
    (4, Of::Number),
    (5, Of::Number),
    (6, Of::Number),
    (7, Of::Number),
]);
const ROW_GROUP: Of = Of::Fields(&[
    (1, Of::List(&CHUNK)),
    (2, Of::Number),
    (3, Of::Number),
    (
        4,
        Of::List(&Of::Fields(&[
            (1, Of::Number),
            (2, Of::Bool),
            (3, Of::Bool),
        ])),
    ),
    (5, Of::Number),
    (6, Of::Number),
    (7, Of::Number),
]);
/// `FileMetaData`.
const FILE: Fields = &[
    (1, Of::Number),
    (2, Of::List(&SCHEMA_ELEMENT)),
    (3, Of::Number),
    (4, Of::List(&ROW_GROUP)),
    (5, Of::List(&KEY_VALUE)),
    (6, Of::Bytes),
    (
        7,
        Of::List(&Of::Fields(&[(1, EMPTY), (2, EMPTY), (3, EMPTY)])),
    ),
];

impl Of {
    /// Whether values of a type in the file are read as this.
    fn is(self, wire: u8) -> bool {
        match self {
            Self::Bool => matches!(wire, 1 | 2),
            Self::Byte => wire == 3,
            Self::Number | Self::PageBytes => matches!(wire, 4..=6),
            Self::Double => wire == 7,
            Self::Bytes => wire == 8,
            Self::List(_) => wire == 9,
            Self::Fields(_) => wire == 12,
        }
    }
}

/// What is wrong with a structure.
#[derive(Debug, PartialEq)]
enum Fault {
    /// It goes on behind the bytes.
    Ends,
    Impossible,
}

/// Whether bytes begin with a structure of these fields that is possible.
fn is_possible(bytes: &[u8], fields: Fields) -> Result<(), Fault> {
    let mut walk = Walk {
        bytes,
        elements_left: bytes.len() as u64,
    };
    walk.structure(fields, 0)
}

/// A walk through a structure, as the library skips what it does not know.
struct Walk<'a> {
    bytes: &'a [u8],
    elements_left: u64,
}

impl Walk<'_> {
    fn byte(&mut self) -> Result<u8, Fault> {
        let (first, rest) = self.bytes.split_first().ok_or(Fault::Ends)?;
        self.bytes = rest;
        Ok(*first)
    }

    fn skip(&mut self, count: u64) -> Result<(), Fault> {
        let count = usize::try_from(count).map_err(|_| Fault::Impossible)?;
        self.bytes = self.bytes.get(count..).ok_or(Fault::Ends)?;
        Ok(())
    }

    fn number(&mut self) -> Result<u64, Fault> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(Fault::Impossible)
    }

    /// Takes some elements of a list from those that there can be.
    fn elements(&mut self, count: u64) -> Result<(), Fault> {
        self.elements_left = self
            .elements_left
            .checked_sub(count)
            .ok_or(Fault::Impossible)?;
        Ok(())
    }

    fn structure(&mut self, fields: Fields, level: u32) -> Result<(), Fault> {
        let mut id = 0_i16;
        loop {
            let head = self.byte()?;
            let wire = head & 15;
            if wire == 0 {
                return Ok(());
            }
            id = match head >> 4 {
                0 => {
                    let number = self.number()?;
                    ((number >> 1) as i64 ^ -((number & 1) as i64)) as i16
                }
                step => id.checked_add(step.into()).ok_or(Fault::Impossible)?,
            };
            let known = fields.iter().find(|(known, _)| *known == id);
            self.value(wire, known.map(|(_, of)| *of), level + 1)?;
        }
    }

    /// A value of a type of the file, of a field that the library knows, or skips.
    fn value(&mut self, wire: u8, known: Option<Of>, level: u32) -> Result<(), Fault> {
        if level > MOST_LEVELS || known.is_some_and(|of| !of.is(wire)) {
            return Err(Fault::Impossible);
        }
        match wire {
            1 | 2 => Ok(()),
            3 => self.skip(1),
            4..=6 => {
                let bytes = self.number()? >> 1;
                match known {
                    Some(Of::PageBytes) if bytes > MAX_PAGE_BYTES => Err(Fault::Impossible),
                    _ => Ok(()),
                }
            }
            7 => self.skip(8),
            8 => {
                let length = self.number()?;
                self.skip(length)
            }
            9 | 10 => {
                let head = self.byte()?;
                let count = match head >> 4 {
                    15 => self.number()?,
                    count => u64::from(count),
                };
                self.elements(count)?;
                let of = match known {
                    Some(Of::List(of)) => Some(*of),
                    _ => None,
                };
                (0..count).try_for_each(|_| self.value(head & 15, of, level + 1))
            }
            11 => {
                let count = self.number()?;
                self.elements(count)?;
                let of = if count > 0 { self.byte()? } else { 0 };
                (0..count).try_for_each(|_| {
                    self.value(of >> 4, None, level + 1)?;
                    self.value(of & 15, None, level + 1)
                })
            }
            12 => {
                let fields = match known {
                    Some(Of::Fields(fields)) => fields,
                    _ => &[],
                };
                self.structure(fields, level)
            }
            13 => self.skip(16),
            _ => Err(Fault::Impossible),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_headers_with_impossible_counts_are_refused() {
        // A page of 5 bytes (type 0, sizes 5 and 5) with an unknown list of numbers and structure.
        let page = [0x15, 0, 0x15, 10, 0x15, 10, 0xd9, 0x25, 2, 4, 0x1c, 0, 0];
        assert_eq!(is_possible(&page, PAGE), Ok(()));
        for end in 0..page.len() {
            assert_eq!(is_possible(&page[..end], PAGE), Err(Fault::Ends), "{end}");
        }
        let billion = [0x80, 0x94, 0xeb, 0xdc, 3];
        for impossible in [
            // A billion of what has no bytes: as a list, a set, and a map.
            &[&[0xd9, 0xf1][..], &billion].concat(),
            &[&[0xda, 0xf2][..], &billion].concat(),
            &[&[0xdb][..], &billion, &[0x11]].concat(),
            // A page of half a billion bytes.
            &[&[0x15, 0, 0x15][..], &billion, &[0]].concat(),
            // Lists in lists.
            &[&[0xd9][..], &[0x19; 100]].concat(),
            // A list in the place of the size of a page.
            &[0x15, 0, 0x19, 0x15, 10, 0].to_vec(),
        ] {
            assert_eq!(
                is_possible(impossible, PAGE),
                Err(Fault::Impossible),
                "{impossible:?}"
            );
        }
        // Bytes behind the end cannot be skipped.
        let mut header = Header(io::Cursor::new(vec![1, 2]));
        let copied = io::copy(&mut header.by_ref().take(1 << 40), &mut io::sink());
        assert!(copied.is_err());
    }
}
