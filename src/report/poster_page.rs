//! Posters to print: one page each, A4 or letter.

use crate::escape::html;
use crate::plots::player_poster::PlayerPoster;
use crate::plots::svg::shortened;

/// The page of one player: the map, the sentences, and nothing else.
#[must_use]
pub fn poster_page(name: &str, poster: &PlayerPoster) -> String {
    page(&shortened(name, LONGEST_TITLE), [poster])
}

/// The posters of several players in one file, each on a sheet of its own.
#[must_use]
pub fn posters_page<'a>(posters: impl IntoIterator<Item = &'a PlayerPoster>) -> String {
    page("The team: posters", posters)
}

/// Longest title, in characters.
const LONGEST_TITLE: usize = 80;

fn page<'a>(title: &str, posters: impl IntoIterator<Item = &'a PlayerPoster>) -> String {
    let sheet = |poster: &PlayerPoster| {
        let sentences = poster.sentences.iter();
        let list: String = sentences
            .map(|sentence| format!("<p>{}</p>\n", html(sentence)))
            .collect();
        format!("<section>\n{}\n{list}</section>\n", poster.map_svg)
    };
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{}</title>\n<style>\n\
         @page {{ margin: 12mm }}\n\
         body {{ font: 20px/1.4 sans-serif; max-width: 18cm; margin: 0 auto; padding: 8px; color: #222 }}\n\
         svg {{ width: 100%; height: auto; max-height: 20cm }}\n\
         p {{ margin: 0.4em 0 }}\n\
         section + section {{ break-before: page; margin-top: 2em }}\n\
         @media print {{ body {{ font-size: 17px }} svg {{ max-height: 14cm }} section + section {{ margin-top: 0 }} }}\n\
         </style>\n{}</html>\n",
        html(title),
        posters.into_iter().map(sheet).collect::<String>()
    )
}
