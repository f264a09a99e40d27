//! `bankshot figures`: the paper's Figs. 7 to 15.

use crate::cli::failure::Failure;
use crate::cli::plot_files;
use crate::plots::paper_figures;
use std::path::Path;

pub(crate) fn run(out: &Path) -> Result<u8, Failure> {
    let plots = paper_figures::draw_all().map_err(Failure::bug)?;
    plot_files::write(out, &plots)?;
    plot_files::print_captions(out, &plots)
}
