//! The options of `bankshot fit`.

use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
The file has releases (speed, pitch, polar or aim), landings (entry_angle, depth, left_right) or trajectories (shot, time, x, y, z). Each column has its unit in its name, as in speed_ft_s, depth_in, time_s. Optional columns: made, shooter, session, place (a name), and its position (distance, court_angle, release_height). Units: ft_s m_s mph km_h, deg rad, rev_s rpm rad_s, ft in m cm mm, s ms.

Signs: release directions are positive to the left, landings (left_right) positive to the right. aim is measured from the line to the hoop, polar from the court's long axis.

Writes a folder with fit.json, profile.toml (for best and shot), draws.parquet, shots.csv, report.html and plots; with several players, a folder for each and shooters.csv. docs/formats.md explains every column.

Examples:
  bankshot fit docs/data/gym_sensor.csv
  bankshot fit shots.csv --map 'speed=ReleaseSpeed:mph' \\
    --map 'shooter=Player' --map 'session=Day' \\
    --distance '13.75 ft' --release-height '7 ft'
  bankshot fit tracking.csv --tracker optical_25hz --frame court_94x50 \\
    --free drag_coefficient")]
pub(crate) struct FitOptions {
    /// The measured shots: CSV or Parquet.
    pub(crate) shots: PathBuf,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Folder of the results [default: results/<name of the file>-fit, with --shooter a folder in
    /// it].
    #[arg(long = "output", short = 'o', alias = "out", value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Also estimate a value the sensor does not measure: backspin or hoop_restitution (from makes
    /// and misses), drag_coefficient (from trajectories). Repeatable. With several players, ring
    /// and air have one estimate for all.
    #[arg(long, value_name = "PARAMETER")]
    pub(crate) free: Vec<String>,
    /// Also compare normal, heavier-tailed and skewed releases: how well does each predict shots
    /// that were left out? Takes some seconds for each player.
    #[arg(long)]
    pub(crate) compare_shapes: bool,
    /// Print fit.json instead of the text.
    #[arg(long)]
    pub(crate) json: bool,
}
