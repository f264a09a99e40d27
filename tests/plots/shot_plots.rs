//! `trace --plot`: a shot from four sides.

use super::support::{bankshot, be_refused, printed, succeed};
use std::fs;
use std::path::Path;
use std::process::Command;

/// `bankshot trace` of a free throw with its swarm, drawn into a file.
fn trace(plot: &Path) -> Command {
    let mut command = bankshot();
    command
        .args(["trace", "configs/free_throw.toml"])
        .args(["--speed", "23.6 ft/s", "--pitch", "53.5 deg"])
        .args(["--swarm", "12", "--plot"])
        .arg(plot);
    command
}

#[test]
fn contract_a_shot_is_drawn_with_its_swarm() {
    let folder = tempfile::TempDir::new().unwrap();
    for name in ["shot.svg", "shot.png"] {
        let plot = folder.path().join(name);
        succeed(&mut trace(&plot));
        assert!(fs::metadata(plot).unwrap().len() > 10_000);
    }
    let svg = fs::read_to_string(folder.path().join("shot.svg")).unwrap();
    assert!(svg.contains("from the side") && svg.contains("facing the board"));
    let output = be_refused(&mut trace(&folder.path().join("shot.gif")));
    assert!(printed(&output).contains("must end in .svg or .png"));
}
