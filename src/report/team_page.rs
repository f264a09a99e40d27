//! The page of a team: who should bank from where, who is best from where, and the way to the
//! players' posters.

use crate::plots::svg::{Plot, escaped};

/// A plain table.
pub struct PageTable {
    /// What it shows.
    pub caption: String,
    /// The names of its columns.
    pub columns: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
    /// Whether it is on paper too.
    pub is_printed: bool,
}

/// The content of the page.
pub struct TeamPage {
    /// From where each player should bank, a line each.
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
    fn html(&self) -> String {
        let columns: String = self
            .columns
            .iter()
            .map(|name| format!("<th scope=\"col\" class=\"text\">{}</th>", escaped(name)))
            .collect();
        let row = |cells: &Vec<String>| {
            let cells = cells.iter().zip(&self.columns).map(|(cell, column)| {
                format!(
                    "<td class=\"text\" data-label=\"{}\">{}</td>",
                    escaped(column),
                    escaped(cell)
                )
            });
            format!("<tr>{}</tr>\n", cells.collect::<String>())
        };
        format!(
            "<section{}>\n<h2>{}</h2>\n<div class=\"scroll\">\n<table>\n<thead><tr>{columns}</tr></thead>\n<tbody>\n{}</tbody>\n</table>\n</div>\n</section>\n",
            if self.is_printed {
                ""
            } else {
                " class=\"unprinted\""
            },
            escaped(&self.caption),
            self.rows.iter().map(row).collect::<String>()
        )
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
                escaped(name),
                escaped(rest)
            ),
            _ => format!(
                "<span class=\"line\" style=\"padding-left:{:.1}em\">{}</span>",
                0.6 * spaces as f64,
                escaped(words)
            ),
        }
    };
    text.trim_end().lines().map(line).collect()
}

/// The lines of a text, one below the other.
fn plain_lines(text: &str) -> String {
    let lines: Vec<String> = text.trim_end().lines().map(escaped).collect();
    lines.join("<br>")
}

impl TeamPage {
    /// The page as one HTML file. The posters stay a file of their own.
    #[must_use]
    pub fn html(&self) -> String {
        let posters = self.posters.as_ref().map_or_else(String::new, |file| {
            let file = escaped(file);
            format!(
                "<p>A poster to print for each player: <a href=\"{file}\">{file}</a>, a file beside this page.</p>\n"
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
            false => format!(
                "<h2>{}</h2>\n<section class=\"advices\">\n{advice}</section>\n",
                escaped(&self.advice_title)
            ),
        };
        let maps = self.maps.as_ref().map_or_else(String::new, |plot| {
            format!(
                "<figure class=\"wide\">\n{}\n<figcaption>{}</figcaption>\n</figure>\n",
                plot.svg,
                escaped(&plot.caption)
            )
        });
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>The team</title>\n\
             <style>\n{}figure.wide {{ width: 100%; }}\n\
             .answer {{ white-space: normal; }}\n\
             .player, .line {{ display: block; }}\n\
             .player + .player, .line + .player {{ margin-top: 0.6em; }}\n\
             .advice {{ max-width: 60em; }}\n\
             @media print {{ .answer, .advices {{ columns: 2; }} .advice {{ margin: 0 0 2mm; }} td, th {{ padding: 0.3mm 1mm; }} }}\n\
             @media (max-width: 40rem) {{ figure.wide svg {{ min-width: 56rem; }} }}\n</style>\n<h1>The team</h1>\n\
             <p class=\"answer\">{}</p>\n{advice}{}{maps}{posters}\
             <footer><p>{}</p></footer>\n</html>\n",
            include_str!("../../assets/report/page.css"),
            lines(&self.answer),
            self.tables.iter().map(PageTable::html).collect::<String>(),
            plain_lines(&self.footer)
        )
    }
}
