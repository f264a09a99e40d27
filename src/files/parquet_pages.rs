//! Pages of a Parquet file whose counts are possible: the library makes room for as many values as
//! a page says it has, and a few bytes can say billions.

use parquet::basic::Encoding;
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};

/// Most values of a page. Writers make pages of about a million bytes.
const MAX_VALUES: usize = 1 << 24;

/// The pages of a column, checked.
pub(super) struct CheckedPages {
    pages: Box<dyn PageReader>,
    /// Whether cells of the column can be null.
    is_optional: bool,
}

impl CheckedPages {
    pub(super) fn new(pages: Box<dyn PageReader>, is_optional: bool) -> Self {
        Self { pages, is_optional }
    }

    fn check(&self, page: &Page) -> Result<()> {
        let refuse = |what: &str| {
            Err(ParquetError::General(format!(
                "the file is damaged: {what}"
            )))
        };
        let (values, encoding) = (page.num_values() as usize, page.encoding());
        if values > MAX_VALUES {
            return refuse("a page has too many values");
        }
        match page {
            // Each value has a byte at least.
            Page::DictionaryPage { buf, .. } if values > buf.len() => {
                refuse("a dictionary has more values than bytes")
            }
            Page::DictionaryPage { .. } => Ok(()),
            _ if encoding == Encoding::DELTA_BYTE_ARRAY => Err(ParquetError::General(
                "has texts that are stored as differences; write it without this encoding".into(),
            )),
            _ if encoding == Encoding::DELTA_LENGTH_BYTE_ARRAY => {
                let counted = self.values_of(page).and_then(count_of_differences);
                match counted.is_some_and(|count| count <= values as u64) {
                    true => Ok(()),
                    false => refuse("a page has other values than it says"),
                }
            }
            _ => Ok(()),
        }
    }

    /// The bytes of the values of a data page, behind those that say which ones are null.
    fn values_of<'a>(&self, page: &'a Page) -> Option<&'a [u8]> {
        match page {
            Page::DataPage { buf, .. } if self.is_optional => {
                let length = buf
                    .first_chunk::<4>()
                    .map(|bytes| u32::from_le_bytes(*bytes))?;
                buf.get(4..)?.get(length as usize..)
            }
            Page::DataPageV2 {
                buf,
                def_levels_byte_len,
                rep_levels_byte_len,
                ..
            } => {
                let levels = def_levels_byte_len.checked_add(*rep_levels_byte_len)?;
                buf.get(levels as usize..)
            }
            Page::DataPage { buf, .. } | Page::DictionaryPage { buf, .. } => Some(buf),
        }
    }
}

/// The number of values that a list of differences says it has: the third number of its head, after
/// the sizes of its blocks.
fn count_of_differences(bytes: &[u8]) -> Option<u64> {
    let mut bytes = bytes.iter();
    let mut number = || {
        let mut value = 0_u64;
        for shift in (0..63).step_by(7) {
            let byte = bytes.next()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    };
    number()?;
    number()?;
    number()
}

impl Iterator for CheckedPages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

impl PageReader for CheckedPages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let page = self.pages.get_next_page()?;
        page.as_ref().map_or(Ok(()), |page| self.check(page))?;
        Ok(page)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.pages.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.pages.skip_next_page()
    }

    fn at_record_boundary(&mut self) -> Result<bool> {
        self.pages.at_record_boundary()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct NoPages;

    impl Iterator for NoPages {
        type Item = Result<Page>;
        fn next(&mut self) -> Option<Self::Item> {
            None
        }
    }

    impl PageReader for NoPages {
        fn get_next_page(&mut self) -> Result<Option<Page>> {
            Ok(None)
        }
        fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
            Ok(None)
        }
        fn skip_next_page(&mut self) -> Result<()> {
            Ok(())
        }
    }

    fn page(bytes: &[u8], num_values: u32, encoding: Encoding) -> Page {
        Page::DataPage {
            buf: bytes.to_vec().into(),
            num_values,
            encoding,
            def_level_encoding: Encoding::RLE,
            rep_level_encoding: Encoding::RLE,
            statistics: None,
        }
    }

    #[test]
    fn contract_pages_with_impossible_counts_are_refused() {
        let pages = |is_optional| CheckedPages::new(Box::new(NoPages), is_optional);
        let dictionary = |num_values| Page::DictionaryPage {
            buf: vec![0; 16].into(),
            num_values,
            encoding: Encoding::PLAIN,
            is_sorted: false,
        };
        assert!(pages(false).check(&dictionary(16)).is_ok());
        assert!(pages(false).check(&dictionary(17)).is_err());
        assert!(
            pages(false)
                .check(&page(&[], u32::MAX, Encoding::RLE))
                .is_err()
        );
        // Blocks of 128 in 4 parts; 3 values, then a billion.
        let texts = Encoding::DELTA_LENGTH_BYTE_ARRAY;
        let (few, many) = ([0x80, 1, 4, 3, 0], [0x80, 1, 4, 0x80, 0x94, 0xeb, 0xdc, 3]);
        assert!(pages(false).check(&page(&few, 3, texts)).is_ok());
        assert!(pages(false).check(&page(&few, 2, texts)).is_err());
        assert!(pages(false).check(&page(&many, 3, texts)).is_err());
        let with_nulls = [&[2, 0, 0, 0, 6, 1][..], &few].concat();
        assert!(pages(true).check(&page(&with_nulls, 3, texts)).is_ok());
        assert!(pages(true).check(&page(&[9, 0, 0, 0], 3, texts)).is_err());
    }
}
