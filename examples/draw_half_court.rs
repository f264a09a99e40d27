//! Draws `bank_and_direct.svg`, the map of the half court in the docs, from
//! `docs/data/half_court.csv`: `cargo run --release --example draw_half_court [FOLDER]`. The
//! default folder is `docs/pictures`.

use bankshot::plots::sweep_bank_direct_map;
use bankshot::plots::sweep_results::SweepResults;
use std::path::PathBuf;

#[path = "../tests/plots/half_court.rs"]
mod half_court;

fn main() -> std::io::Result<()> {
    let folder = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/pictures")),
        PathBuf::from,
    );
    let half_court::HalfCourt { config, rows } = half_court::HalfCourt::load();
    let plot = sweep_bank_direct_map::draw(&SweepResults::new(&config, &rows))
        .ok_or_else(|| std::io::Error::other("the half court has no bank or no direct shots"))?;
    std::fs::write(folder.join("bank_and_direct.svg"), plot.svg.as_bytes())
}
