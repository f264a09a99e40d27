//! A player's poster: one page to print, A4 or letter.

use crate::plots::player_poster::PlayerPoster;
use crate::plots::svg::{escaped, shortened};

/// The page: the map, the sentences, and nothing else.
#[must_use]
pub fn poster_page(name: &str, poster: &PlayerPoster) -> String {
    let name = escaped(&shortened(name, 80));
    let list: String = poster
        .sentences
        .iter()
        .map(|sentence| format!("<p>{}</p>\n", escaped(sentence)))
        .collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{name}</title>\n<style>\n\
         @page {{ margin: 12mm }}\n\
         body {{ font: 20px/1.4 sans-serif; max-width: 18cm; margin: 0 auto; padding: 8px; color: #222 }}\n\
         svg {{ width: 100%; height: auto; max-height: 20cm }}\n\
         p {{ margin: 0.4em 0 }}\n\
         @media print {{ body {{ font-size: 25px }} }}\n\
         </style>\n{}\n{list}</html>\n",
        poster.map_svg
    )
}
