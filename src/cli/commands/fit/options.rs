//! The options of `bankshot fit`.

use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
The file holds releases (speed, pitch, polar or aim), landings (entry_angle, depth, left_right) or trajectories (shot, \
time, x, y, z); each column has its unit in its name, as in speed_ft_s, depth_in, time_s. It can have made, shooter, \
session, place (a name), and where that is (distance, court_angle, release_height). Angles of release are positive to the shooter's left: \
aim from the line to the hoop's centre, polar from the court's long axis. left_right is positive to the right. Units: \
ft_s m_s mph km_h, deg rad, rev_s rpm rad_s, ft in m cm mm, s ms.

Writes OUT/: fit.json, profile.toml (for best and probability), draws.parquet, shots.csv, report.html and plots; with several \
shooters, one folder for each and shooters.csv. draws.parquet has a row for each draw: the parameters of fit.json with \
their units (speed_mean_ft_s, speed_sd_ft_s, corr_speed_pitch ...) and probability, P of the usual shot. \
docs/formats.md explains every column.

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
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Also ask the shots for what no sensor sees: backspin or hoop_restitution (from made and
    /// missed), or drag_coefficient (from trajectories); may be repeated. Of several shooters, the
    /// ring and the air of all together.
    #[arg(long, value_name = "PARAMETER")]
    pub(crate) free: Vec<String>,
    /// Print fit.json instead of the text.
    #[arg(long)]
    pub(crate) json: bool,
}
