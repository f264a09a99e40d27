//! A Parquet file whose headers are possible. The library counts down lists that say they have
//! billions of elements of no bytes, and skips bytes behind the end of a file: from two thousand
//! bytes it would read for hours.
//!
//! Headers are Thrift structures in the compact protocol
//! (<https://github.com/apache/thrift/blob/master/doc/specs/thrift-compact-protocol.md>). Each
//! element of a list has a byte at least, so a header has no more elements than bytes.

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
                _ => is_possible(&bytes),
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
        if is_metadata && is_possible(&bytes).is_err() {
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

/// What is wrong with a structure.
#[derive(Debug, PartialEq)]
enum Fault {
    /// It goes on behind the bytes.
    Ends,
    Impossible,
}

/// Whether bytes begin with a structure that is possible.
fn is_possible(bytes: &[u8]) -> Result<(), Fault> {
    let mut walk = Walk {
        bytes,
        elements_left: bytes.len() as u64,
    };
    walk.structure(0, true)
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

    fn structure(&mut self, level: u32, is_page: bool) -> Result<(), Fault> {
        let mut id = 0;
        loop {
            let head = self.byte()?;
            if head & 15 == 0 {
                return Ok(());
            }
            id = match head >> 4 {
                0 => self.number()? >> 1,
                step => id + u64::from(step),
            };
            let of = head & 15;
            if is_page && id == 2 && of == 5 {
                // Its size, unpacked.
                if self.number()? >> 1 > MAX_PAGE_BYTES {
                    return Err(Fault::Impossible);
                }
            } else {
                self.value(of, level)?;
            }
        }
    }

    fn value(&mut self, of: u8, level: u32) -> Result<(), Fault> {
        if level > MOST_LEVELS {
            return Err(Fault::Impossible);
        }
        match of {
            1 | 2 => Ok(()),
            3 => self.skip(1),
            4..=6 => self.number().map(|_| ()),
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
                (0..count).try_for_each(|_| self.value(head & 15, level + 1))
            }
            11 => {
                let count = self.number()?;
                self.elements(count)?;
                let of = if count > 0 { self.byte()? } else { 0 };
                (0..count).try_for_each(|_| {
                    self.value(of >> 4, level + 1)?;
                    self.value(of & 15, level + 1)
                })
            }
            12 => self.structure(level + 1, false),
            13 => self.skip(16),
            _ => Err(Fault::Impossible),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_with_impossible_counts_are_refused() {
        // A page of 5 bytes (type 0, sizes 5 and 5) with a list of numbers and an empty structure.
        let page = [0x15, 0, 0x15, 10, 0x15, 10, 0x19, 0x25, 2, 4, 0x1c, 0, 0];
        assert_eq!(is_possible(&page), Ok(()));
        for end in 0..page.len() {
            assert_eq!(is_possible(&page[..end]), Err(Fault::Ends), "{end}");
        }
        let billion = [0x80, 0x94, 0xeb, 0xdc, 3];
        for impossible in [
            // A billion of what has no bytes: as a list, a set, and a map.
            &[&[0x19, 0xf1][..], &billion].concat(),
            &[&[0x1a, 0xf2][..], &billion].concat(),
            &[&[0x1b][..], &billion, &[0x11]].concat(),
            // A page of half a billion bytes.
            &[&[0x15, 0, 0x15][..], &billion, &[0]].concat(),
            // Lists in lists.
            &[&[0x19][..], &[0x19; 100]].concat(),
        ] {
            assert_eq!(
                is_possible(impossible),
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
