//! `bankshot studio`: the engine behind a page in the browser.

use crate::cli::failure::{Failure, code, refuse_file};
use crate::cli::signals::set_exit_remark;
use crate::cli::terminal::print_remark;
use crate::studio::{Commands, Studio, StudioOptions as Options};
use clap::Args;
use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
The page moves with the release: makes per 100, the paths of simulated shots, the best shot. It reads exports of measured shots, fills a court while a sweep runs, and makes a launcher's table. It computes what the commands compute, and keeps its results in FOLDER, as they do. Nothing leaves this machine. Ctrl-C ends the studio.

Examples:
  bankshot studio
  bankshot studio season --port 8080 --no-browser")]
pub(crate) struct StudioOptions {
    /// The folder of the results.
    #[arg(default_value = "results")]
    pub(crate) folder: PathBuf,
    /// The port; if it is taken, the next free one.
    #[arg(long, default_value_t = 4747)]
    pub(crate) port: u16,
    /// The address to listen on. With another than this machine's own, everybody in the network who
    /// has the link can use the studio.
    #[arg(long, value_name = "IP", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub(crate) address: IpAddr,
    /// Print the link, and do not open a browser.
    #[arg(long)]
    pub(crate) no_browser: bool,
}

pub(crate) fn run(options: &StudioOptions, commands: Commands) -> Result<u8, Failure> {
    refuse_file(&options.folder)?;
    let wanted = Options {
        address: options.address,
        port: options.port,
        folder: options.folder.clone(),
    };
    let place = format!("the studio at {}", options.address);
    let studio = Studio::open(&wanted, commands).map_err(|error| Failure::io(&place, &error))?;
    if !options.address.is_loopback() {
        print_remark(
            "warning: everybody in the network who has the link can use this studio and read its folder",
        );
    }
    let folder = options.folder.display().to_string();
    set_exit_remark(move || format!("the studio has ended; its results are in {folder}"));
    let url = studio.url();
    print_remark(&format!("The studio is open at {url}\nCtrl-C ends it."));
    if !options.no_browser && open::that_detached(&url).is_err() {
        print_remark("no browser could be opened; open the link yourself");
    }
    studio
        .serve()
        .map_err(|error| Failure::io(&place, &error))?;
    Ok(code::DONE)
}
