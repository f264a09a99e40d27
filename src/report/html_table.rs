//! Tables of a page.

use crate::escape::html;
use std::fmt::Write;

/// Longer tables are not printed.
const MOST_PRINTED_ROWS: usize = 30;

/// A table of a page.
#[derive(Clone, Debug, PartialEq)]
pub struct HtmlTable {
    /// What the table shows.
    pub caption: String,
    /// What a reader must know of it, above its rows; may be empty.
    pub note: String,
    /// Names of the columns, with units.
    pub columns: Vec<String>,
    /// The cells of each row, and the index of the shot that the row selects, if any.
    pub rows: Vec<(Option<usize>, Vec<String>)>,
    /// The table is folded until it is asked for, and not printed.
    pub is_detail: bool,
}

impl HtmlTable {
    /// Puts a name before the caption.
    pub(super) fn name(&mut self, name: &str) {
        self.caption = format!("{name}: {}", self.caption);
    }

    /// The table as HTML. `number` makes the ids of a page's tables different.
    pub(super) fn html(&self, number: usize) -> String {
        let (start, heading, end) = if self.is_detail {
            ("<details>", "summary", "</details>\n")
        } else if self.rows.len() > MOST_PRINTED_ROWS {
            ("<section class=\"unprinted\">", "h2", "</section>\n")
        } else {
            ("", "h2", "")
        };
        let note = match html(&self.note) {
            none if none.is_empty() => none,
            note => format!("<p>{note}</p>\n"),
        };
        let mut text = format!(
            "{start}<{heading} id=\"h-table-{number}\">{}</{heading}>\n{note}<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-labelledby=\"h-table-{number}\">\n<table class=\"sortable\">\n<thead><tr>",
            html(&self.caption)
        );
        let is_number = |cell: &str| cell.parse::<f64>().is_ok();
        for (i, column) in self.columns.iter().enumerate() {
            let mut cells = self.rows.iter().map(|(_, cells)| &cells[i]);
            let is_text = cells.all(|cell| !is_number(cell));
            // Writing to a String never fails, here and below.
            let _ = write!(
                text,
                "<th scope=\"col\"{}><button type=\"button\">{}</button></th>",
                if is_text { " class=\"text\"" } else { "" },
                html(column)
            );
        }
        text.push_str("</tr></thead>\n<tbody>\n");
        for (shot, cells) in &self.rows {
            text.push_str(&shot.map_or("<tr>".to_owned(), |shot| {
                format!("<tr data-shot=\"{shot}\">")
            }));
            for (cell, column) in cells.iter().zip(&self.columns) {
                let class = if is_number(cell) {
                    ""
                } else {
                    " class=\"text\""
                };
                let label = html(column);
                let _ = write!(
                    text,
                    "<td{class} data-label=\"{label}\">{}</td>",
                    html(cell)
                );
            }
            text.push_str("</tr>\n");
        }
        text.push_str("</tbody>\n</table>\n</div>\n");
        text.push_str(end);
        text
    }
}

/// A number with a fixed number of decimals, and without a sign if it rounds to zero.
pub(super) fn format_cell(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let magnitude = text.trim_start_matches('-');
    if magnitude.chars().all(|c| c == '0' || c == '.') {
        magnitude.to_owned()
    } else {
        text
    }
}
