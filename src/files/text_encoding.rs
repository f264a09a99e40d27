//! Bytes of a text as letters, whatever program wrote them.

use encoding_rs::{UTF_16BE, UTF_16LE, WINDOWS_1252};

/// The encoding of a text of two bytes a letter, by its mark or by its zeros; `None` of others.
#[must_use]
pub(super) fn wide_encoding(first: &[u8]) -> Option<&'static encoding_rs::Encoding> {
    if first.starts_with(b"\xff\xfe") {
        return Some(UTF_16LE);
    }
    if first.starts_with(b"\xfe\xff") {
        return Some(UTF_16BE);
    }
    let zeros = |from: usize| {
        first
            .iter()
            .skip(from)
            .step_by(2)
            .filter(|b| **b == 0)
            .count()
    };
    let [even, odd] = [zeros(0), zeros(1)];
    match (even, odd) {
        _ if 4 * (even + odd) < first.len() || even + odd == 0 => None,
        _ if odd > even => Some(UTF_16LE),
        _ => Some(UTF_16BE),
    }
}

/// A cell as text: UTF-8, or the letters of Western Europe that old spreadsheets write.
#[must_use]
pub(super) fn cell_text(cell: &[u8]) -> String {
    let text = match std::str::from_utf8(cell) {
        Ok(text) => text.to_owned(),
        Err(_) => WINDOWS_1252.decode(cell).0.into_owned(),
    };
    // No control character may reach a terminal.
    let text = text.replace(|c: char| c.is_control() && c != '\t' && c != '\n', "");
    text.trim_matches(|c: char| c.is_whitespace() || c == '\u{feff}')
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_texts_of_other_encodings_are_read() {
        assert_eq!(wide_encoding(b"a\0,\0b\0"), Some(UTF_16LE));
        assert_eq!(wide_encoding(b"\0a\0,\0b"), Some(UTF_16BE));
        assert_eq!(wide_encoding(b"a,b,c"), None);
        assert_eq!(wide_encoding(b""), None);
        assert_eq!(cell_text(b" Sch\xfctze\x1b "), "Schütze");
        assert_eq!(cell_text("Schütze".as_bytes()), "Schütze");
    }
}
