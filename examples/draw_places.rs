//! Draws `places.svg` and prints the table of docs/places.md:
//! `cargo run --release --example draw_places [FOLDER]`. The default folder is `docs/pictures`.

use std::path::PathBuf;

#[path = "../tests/plots/places.rs"]
mod places;

fn main() -> std::io::Result<()> {
    let folder = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/pictures")),
        PathBuf::from,
    );
    print!("{}", places::table());
    std::fs::write(folder.join("places.svg"), places::draw())
}
