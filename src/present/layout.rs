//! The form that every answer in text has: the answer, how certain it is, what it is about, one
//! table, and what can change the decision.

/// Columns of a terminal of the usual width.
pub const COLUMNS: usize = 80;

/// An answer in text.
#[derive(Clone, Debug, Default)]
pub struct TextAnswer {
    /// The answer, then how certain it is: a sentence or two in each.
    pub answer: Vec<String>,
    /// Who, where, and under which physics.
    pub subject: String,
    /// Labels and what belongs to them, where a table would have one row.
    pub labelled: Vec<(&'static str, String)>,
    /// The table.
    pub table: Option<TextTable>,
    /// What can change the decision: at most four.
    pub notes: Vec<String>,
    /// Everything else, for those who ask for it.
    pub details: String,
}

impl TextAnswer {
    /// The text, at most 80 columns wide, with the details if they are asked for.
    #[must_use]
    pub fn text(&self, has_details: bool) -> String {
        let mut text = paragraphs(&self.answer);
        if !self.subject.is_empty() {
            text += &format!("\n{}", paragraph(&self.subject));
        }
        if !self.labelled.is_empty() {
            text += "\n";
        }
        for (label, words) in &self.labelled {
            text += &labelled(label, words);
        }
        if let Some(table) = &self.table {
            text += &format!("\n{}", table.text());
        }
        if !self.notes.is_empty() {
            text += &format!("\n{}", paragraphs(&self.notes));
        }
        if has_details && !self.details.is_empty() {
            text += &format!("\nDetails\n{}", self.details);
        }
        text
    }
}

/// A sentence or two in lines of at most 80 columns. A number keeps its unit, and what can be
/// pasted into a shell stays in one piece.
#[must_use]
pub fn paragraph(text: &str) -> String {
    wrapped(text, "")
}

/// A label, and beside it what belongs to it.
#[must_use]
pub fn labelled(label: &str, words: &str) -> String {
    const WIDTH: usize = 10;
    wrapped(&format!("{label:<WIDTH$}{words}"), &" ".repeat(WIDTH))
}

fn wrapped(text: &str, indentation: &str) -> String {
    const NO_BREAK_SPACE: char = '\u{a0}';
    let mut bound = String::with_capacity(text.len());
    let mut is_code = false;
    let mut words = text.split(' ').peekable();
    while let Some(word) = words.next() {
        bound += word;
        is_code ^= word.matches('`').count() % 2 == 1;
        let Some(next) = words.peek() else { break };
        let is_value = is_number(word) && is_unit(next);
        bound.push(if is_code || is_value {
            NO_BREAK_SPACE
        } else {
            ' '
        });
    }
    let options = textwrap::Options::new(COLUMNS)
        .subsequent_indent(indentation)
        .break_words(false)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    textwrap::fill(&bound, options).replace(NO_BREAK_SPACE, " ") + "\n"
}

fn is_number(word: &str) -> bool {
    word.trim_start_matches(['(', '+']).parse::<f64>().is_ok()
}

fn is_unit(word: &str) -> bool {
    const UNITS: [&str; 13] = [
        "%", "ft", "in", "m", "cm", "deg", "ft/s", "m/s", "rev/s", "s", "min", "MB", "h",
    ];
    UNITS.contains(&word.trim_end_matches([',', ';', '.', ':', ')']))
}

/// Each of these as a paragraph.
#[must_use]
pub fn paragraphs(texts: &[String]) -> String {
    texts.iter().map(|text| paragraph(text)).collect()
}

/// To which side the cells of a column stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Text.
    Left,
    /// Numbers.
    Right,
}

/// A table: two lines of header, the second of which has the units, and rows. A cell can have
/// several lines.
#[derive(Clone, Debug)]
pub struct TextTable {
    columns: Vec<(String, String, Side)>,
    rows: Vec<Vec<String>>,
}

impl TextTable {
    /// A table of these columns: name, unit, side.
    #[must_use]
    pub fn new(columns: &[(&str, &str, Side)]) -> Self {
        let column = |(name, unit, side): &(&str, &str, Side)| {
            ((*name).to_owned(), (*unit).to_owned(), *side)
        };
        Self {
            columns: columns.iter().map(column).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row, a cell for each column.
    pub fn add(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Whether it has no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The lines of the table, each with as much room as its cells need.
    #[must_use]
    pub fn text(&self) -> String {
        let names = self.columns.iter().map(|(name, ..)| name.clone());
        let units = self.columns.iter().map(|(_, unit, _)| unit.clone());
        let (names, units): (Vec<_>, Vec<_>) = (names.collect(), units.collect());
        let mut lines = vec![names];
        if units.iter().any(|unit| !unit.is_empty()) {
            lines.push(units);
        }
        for row in &self.rows {
            let cells: Vec<Vec<&str>> = row.iter().map(|cell| cell.split('\n').collect()).collect();
            let height = cells.iter().map(Vec::len).max().unwrap_or(1);
            lines.extend((0..height).map(|line| {
                let part = |cell: &Vec<&str>| cell.get(line).copied().unwrap_or("").to_owned();
                cells.iter().map(part).collect::<Vec<String>>()
            }));
        }
        let width = |column: usize| {
            let cells = lines.iter().filter_map(|line| line.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let mut text = String::new();
        for line in &lines {
            let cells = line.iter().zip(&widths).zip(&self.columns);
            let cells = cells.map(|((cell, width), (.., side))| match side {
                Side::Left => format!("{cell:<width$}"),
                Side::Right => format!("{cell:>width$}"),
            });
            text += cells.collect::<Vec<_>>().join("  ").trim_end();
            text += "\n";
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_table_has_as_much_room_as_it_needs() {
        let mut table = TextTable::new(&[("kind", "", Side::Left), ("speed", "ft/s", Side::Right)]);
        table.add(["bank\nshot".to_owned(), "24.2".to_owned()]);
        table.add(["direct".to_owned(), "8.1".to_owned()]);
        assert_eq!(
            table.text(),
            "kind    speed\n         ft/s\nbank     24.2\nshot\ndirect    8.1\n"
        );
    }

    #[test]
    fn contract_paragraphs_keep_numbers_with_units_and_commands_whole() {
        let text = format!("{} 24.35 ft/s and more", "word ".repeat(14).trim());
        let lines = paragraph(&text);
        assert!(lines.contains("24.35 ft/s"), "{lines}");
        let command = format!(
            "{} `bankshot report results/a/1`.",
            "a longer word ".repeat(4).trim()
        );
        assert!(paragraph(&command).contains("\n`bankshot report results/a/1`."));
        assert!(
            paragraph(&text)
                .lines()
                .all(|line| line.chars().count() <= COLUMNS)
        );
    }
}
