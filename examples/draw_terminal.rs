//! Draws `terminal.svg`, the picture of a terminal in the README, from what the program prints:
//! `cargo run --release --example draw_terminal [FOLDER]`. The default folder is `docs/pictures`.

use std::path::PathBuf;

#[path = "../tests/plots/terminal.rs"]
mod terminal;

fn main() -> std::io::Result<()> {
    let folder = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/pictures")),
        PathBuf::from,
    );
    std::fs::write(folder.join("terminal.svg"), terminal::draw()?)
}
