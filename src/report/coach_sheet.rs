//! A sheet to print: what to tell each player.

use crate::escape::html;

/// The page: a heading and a paragraph for each player. `source` says what it rests on.
#[must_use]
pub fn coach_sheet(players: &[(String, String)], source: &str) -> String {
    let parts: String = players
        .iter()
        .map(|(name, text)| {
            format!(
                "<section>\n<h2>{}</h2>\n<p>{}</p>\n</section>\n",
                html(name),
                html(text)
            )
        })
        .collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>What to tell each player</title>\n<style>\n\
         @page {{ margin: 15mm }}\n\
         body {{ font: 17px/1.45 sans-serif; max-width: 18cm; margin: 0 auto; padding: 8px; color: #222 }}\n\
         h1 {{ font-size: 1.5em }} h2 {{ font-size: 1.15em; margin: 1em 0 0.2em }} p {{ margin: 0.3em 0 }}\n\
         section {{ break-inside: avoid }} footer {{ color: #555; font-size: 0.8em; margin-top: 2em }}\n\
         @media print {{ body {{ font-size: 12pt }} }}\n\
         </style>\n<h1>What to tell each player</h1>\n{parts}<footer>{}</footer>\n</html>\n",
        html(source)
    )
}
