//! The page of a team: who should bank from where, who is best from where, and the way to the
//! players' posters.

use crate::escape::html;
use crate::plots::svg::Plot;

/// A plain table.
pub struct PageTable {
    /// What it shows.
    pub caption: String,
    /// The names of its columns.
    pub columns: Vec<String>,
    /// Its rows. A cell may have several lines.
    pub rows: Vec<Vec<String>>,
}

/// The content of the page.
pub struct TeamPage {
    /// A row for each player: the first thing to read, and on paper all but the maps.
    pub summary: PageTable,
    /// From where each player should bank, with aims, as lines that are set in.
    pub answer: String,
    /// The title of what follows.
    pub advice_title: String,
    /// What the own shots of each measured player say, a text each.
    pub advice: Vec<String>,
    /// Tables.
    pub tables: Vec<PageTable>,
    /// The maps side by side.
    pub maps: Option<Plot>,
    /// The file of the posters, beside the page; `None` without any.
    pub posters: Option<String>,
    /// What else must be said.
    pub footer: String,
}

impl PageTable {
    /// The table alone.
    fn table(&self) -> String {
        let columns: String = self
            .columns
            .iter()
            .map(|name| format!("<th scope=\"col\" class=\"text\">{}</th>", html(name)))
            .collect();
        let row = |cells: &Vec<String>| {
            let cells = cells.iter().zip(&self.columns).map(|(cell, column)| {
                format!(
                    "<td class=\"text\" data-label=\"{}\">{}</td>",
                    html(column),
                    cell_html(cell)
                )
            });
            format!("<tr>{}</tr>\n", cells.collect::<String>())
        };
        format!(
            "<div class=\"scroll\">\n<table>\n<thead><tr>{columns}</tr></thead>\n<tbody>\n{}</tbody>\n</table>\n</div>\n",
            self.rows.iter().map(row).collect::<String>()
        )
    }

    /// The table with its caption as a heading.
    fn section(&self) -> String {
        format!("<h2>{}</h2>\n{}", html(&self.caption), self.table())
    }
}

/// The lines of a cell in one block, each set off from the one before; nothing for an empty cell,
/// which a narrow page then leaves out.
fn cell_html(cell: &str) -> String {
    let entry = |line: &str| format!("<span class=\"entry\">{}</span>", html(line));
    match cell {
        "" => String::new(),
        cell => format!(
            "<span>{}</span>",
            cell.lines().map(entry).collect::<String>()
        ),
    }
}

/// The lines of a text as blocks, set in as they are. A line that is not set in begins with a name.
fn lines(text: &str) -> String {
    let line = |line: &str| {
        let words = line.trim_start();
        let spaces = line.len() - words.len();
        match words.split_once(':') {
            Some((name, rest)) if spaces == 0 => format!(
                "<span class=\"player\"><strong>{}</strong>:{}</span>",
                html(name),
                html(rest)
            ),
            _ => format!(
                "<span class=\"line\" style=\"padding-left:{:.1}em\">{}</span>",
                0.6 * spaces as f64,
                html(words)
            ),
        }
    };
    text.trim_end().lines().map(line).collect()
}

/// The lines of a text, one below the other.
fn plain_lines(text: &str) -> String {
    let lines: Vec<String> = text.trim_end().lines().map(html).collect();
    lines.join("<br>")
}

impl TeamPage {
    /// The page as one HTML file. The posters stay a file of their own.
    #[must_use]
    pub fn html(&self) -> String {
        let posters = self.posters.as_ref().map_or_else(String::new, |file| {
            let file = html(file);
            format!(
                "<p class=\"unprinted\">A sheet to print for each player, with the points on the board to aim at: <a href=\"{file}\">{file}</a>, a file beside this page. Printed, this page is the table and the maps.</p>\n"
            )
        });
        let advice: String = self
            .advice
            .iter()
            .map(|text| {
                format!(
                    "<p class=\"advice\">{}</p>\n",
                    lines(&text.replace('\n', " "))
                )
            })
            .collect();
        let advice = match advice.is_empty() {
            true => advice,
            false => format!("<h2>{}</h2>\n{advice}", html(&self.advice_title)),
        };
        let maps = self.maps.as_ref().map_or_else(String::new, |plot| {
            format!(
                "<figure class=\"wide\">\n{}\n<figcaption>{}</figcaption>\n</figure>\n",
                &*plot.svg,
                html(&plot.caption)
            )
        });
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>The team</title>\n\
             <style>\n{css}figure.wide {{ width: 100%; }}\n\
             .answer {{ white-space: normal; font-size: 1rem; }}\n\
             .player, .line, .entry {{ display: block; }}\n\
             .entry + .entry {{ margin-top: 0.25em; }}\n\
             .player + .player, .line + .player {{ margin-top: 0.6em; }}\n\
             .advice {{ max-width: 60em; }}\n\
             .summary .scroll {{ max-height: none; }} .summary td {{ white-space: normal; vertical-align: top; }}\n\
             .summary td:first-child {{ font-weight: bold; }} .summary th {{ white-space: normal; }} .summary td:nth-child(3) {{ min-width: 13em; }}\n\
             @media print {{ td, th {{ padding: 0.5mm 1mm; }} figure.wide figcaption {{ display: none; }} figure.wide svg {{ max-height: 84mm; }} .summary table {{ font-size: 9.5px; }} .summary p {{ font-size: 9.5px; margin: 1mm 0; }} footer {{ font-size: 8.5px; }} }}\n\
             @media (max-width: 40rem) {{ figure.wide svg {{ min-width: 56rem; }} }}\n</style>\n<h1>The team</h1>\n\
             <section class=\"summary\">\n{summary}<p class=\"help-text\">{caption}</p>\n</section>\n{maps}{posters}\
             <section class=\"unprinted\">\n<h2>Where to bank, and where to aim</h2>\n<p class=\"answer\">{answer}</p>\n{advice}{tables}</section>\n\
             <footer><p>{footer}</p></footer>\n</html>\n",
            css = include_str!("../../assets/report/page.css"),
            summary = self.summary.table(),
            caption = html(&self.summary.caption),
            answer = lines(&self.answer),
            tables = self
                .tables
                .iter()
                .map(PageTable::section)
                .collect::<String>(),
            footer = plain_lines(&self.footer)
        )
    }
}
