//! Texts of strangers, made harmless for the place where they stand.
//!
//! Names of shooters, places, sessions and columns, and parts of files that messages quote, are
//! text and nothing else. There is one function for each place: a page, a cell, a source, a
//! terminal. `tests/import_layers` finds outputs that go past them.

use std::borrow::Cow;

/// Whether a character steers a terminal or the direction of text: a name with one could show
/// itself, or what stands after it, as something else.
#[must_use]
pub fn is_control_or_direction(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// For HTML and SVG, as text or as the value of an attribute in quotes. Characters that XML forbids
/// become spaces.
#[must_use]
pub fn html(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

/// JSON inside a script element, where only a tag can end the element.
#[must_use]
pub fn json_in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// A cell of a CSV file, before it gets quotes. A spreadsheet runs a cell that begins with `=`,
/// `+`, `-`, `@` or a tab; an apostrophe makes it text. Numbers stay as they are, and control
/// characters become question marks.
#[must_use]
pub fn csv_cell(cell: &[u8]) -> Cow<'_, [u8]> {
    let is_number = || std::str::from_utf8(cell).is_ok_and(|text| text.parse::<f64>().is_ok());
    let runs = matches!(cell.first(), Some(b'=' | b'+' | b'-' | b'@' | b'\t' | b'\r'))
        && !is_number()
        // The wide forms of the same characters.
        || [b"\xef\xbc\x9d", b"\xef\xbc\x8b", b"\xef\xbc\x8d", b"\xef\xbc\xa0"]
            .iter()
            .any(|wide| cell.starts_with(*wide));
    let steers = |byte: &u8| byte.is_ascii_control() && !b"\t\r\n".contains(byte);
    // U+0080 to U+009F.
    let is_second = |pair: &[u8]| pair[0] == 0xc2 && (0x80..0xa0).contains(&pair[1]);
    let has_control = cell.iter().any(steers) || cell.windows(2).any(is_second);
    if !runs && !has_control {
        return Cow::Borrowed(cell);
    }
    let mut safe = Vec::with_capacity(cell.len() + 1);
    safe.extend(runs.then_some(b'\''));
    let mut rest = cell;
    while let Some(byte) = rest.first() {
        let length = if rest.len() > 1 && is_second(&rest[..2]) {
            2
        } else {
            1
        };
        match length == 2 || steers(byte) {
            true => safe.push(b'?'),
            false => safe.push(*byte),
        }
        rest = &rest[length..];
    }
    Cow::Owned(safe)
}

/// A line of a comment in Java, C++ or Python, in the letters that every compiler takes: others
/// become `\u00e9`. Nothing in it ends the comment or goes on in the next line.
#[must_use]
pub fn source_comment(line: &str) -> String {
    let mut safe = String::with_capacity(line.len());
    for c in line.chars() {
        match c {
            // A backslash begins a character in Java, and goes on in the next line in C++.
            '\\' => safe.push('/'),
            // Two question marks are half of a character of old C++.
            '?' if safe.ends_with('?') => safe.push_str(" ?"),
            c if c.is_control() => safe.push(' '),
            c if c.is_ascii() => safe.push(c),
            c => {
                for unit in c.encode_utf16(&mut [0; 2]) {
                    safe += &format!("\\u{unit:04x}");
                }
            }
        }
    }
    safe
}

/// A string of TOML, with its quotes, on one line.
#[must_use]
pub fn toml_string(text: &str) -> String {
    serde_json::Value::from(text)
        .to_string()
        .replace('\u{7f}', "\\u007f")
}

/// For a terminal: characters that steer it or turn the direction of text are written as their
/// numbers. Lines and tabs stay.
#[must_use]
pub fn terminal(text: &str) -> Cow<'_, str> {
    let steers = |c: char| !matches!(c, '\n' | '\t') && is_control_or_direction(c);
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match steers(c) {
            true => safe.extend(c.escape_unicode()),
            false => safe.push(c),
        }
    }
    Cow::Owned(safe)
}

/// Names that Windows keeps for devices, with or without a digit behind them.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];

/// Whether Windows takes a file or folder of this name for a device.
#[must_use]
pub fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().to_lowercase();
    DEVICES.contains(&stem.trim_end_matches(|c: char| c.is_ascii_digit()))
}

/// The name of a file or folder: letters, digits and dashes, so that a name never becomes a path.
/// Different names can give the same one.
#[must_use]
pub fn file_name(name: &str) -> String {
    /// Longer names are cut.
    const MAX_CHARS: usize = 40;
    let mut safe = String::new();
    for c in name.chars().take(MAX_CHARS) {
        if c.is_ascii_alphanumeric() {
            safe.push(c.to_ascii_lowercase());
        } else if !safe.ends_with('-') {
            safe.push('-');
        }
    }
    match safe.trim_matches('-') {
        "" => "shooter".to_owned(),
        device if is_device(device) => format!("{device}-shooter"),
        name => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_html_has_no_tag_and_no_open_quote() {
        assert_eq!(
            html("<script>'\"&\u{1b}\u{0}"),
            "&lt;script&gt;&#39;&quot;&amp;  "
        );
        assert_eq!(
            json_in_script("{\"a\":\"</script>\"}"),
            "{\"a\":\"\\u003c/script>\"}"
        );
    }

    #[test]
    fn contract_cells_are_no_formulas_and_numbers_stay() {
        for formula in [
            "=1+1", "+1-1", "-x", "@SUM(A1)", "\t=1", "\r=1", "＝1", "-1+2",
        ] {
            let cell = csv_cell(formula.as_bytes());
            assert_eq!(cell[0], b'\'', "{formula}");
            assert_eq!(&cell[1..], formula.as_bytes());
        }
        for text in ["-1.5", "+3", "-1e-7", "", "a=1", "a, b", "-inf", "Jörg"] {
            assert_eq!(&*csv_cell(text.as_bytes()), text.as_bytes());
        }
        assert_eq!(&*csv_cell(b"a\x1b[2J\xc2\x9bb\xff"), b"a?[2J?b\xff");
    }

    #[test]
    fn contract_a_comment_stays_a_comment() {
        assert_eq!(source_comment("a\\u000a b\\"), "a/u000a b/");
        assert_eq!(source_comment("what???/\n x"), "what? ? ?/  x");
        assert_eq!(source_comment("Jörg 🏀"), "J\\u00f6rg \\ud83c\\udfc0");
    }

    #[test]
    fn contract_toml_strings_are_read_again() {
        for text in ["", "a\"b\\c", "two\nlines\r\t\u{7f}\u{1}", "'''", "Jörg 🏀"] {
            let written = format!("a = {}\n", toml_string(text));
            assert_eq!(written.lines().count(), 1);
            let read: toml::Table = written.parse().unwrap();
            assert_eq!(read["a"].as_str(), Some(text));
        }
    }

    #[test]
    fn contract_no_code_reaches_a_terminal() {
        assert_eq!(terminal("a\n\tb"), "a\n\tb");
        assert_eq!(
            terminal("\u{1b}[31m\u{9b}\u{202e}\r"),
            "\\u{1b}[31m\\u{9b}\\u{202e}\\u{d}"
        );
    }

    #[test]
    fn contract_file_names_stay_in_their_folder() {
        let names = [
            "../../x",
            "/etc/passwd",
            "C:\\x",
            "..",
            "Jörg",
            "a\u{0}b",
            "CON",
            "lpt1.txt",
            "a.",
        ];
        let files = names.map(file_name);
        let wanted = [
            "x",
            "etc-passwd",
            "c-x",
            "shooter",
            "j-rg",
            "a-b",
            "con-shooter",
            "lpt1-txt",
            "a",
        ];
        assert_eq!(files, wanted);
        assert!(is_device("LPT1.txt") && !is_device("console"));
    }
}
