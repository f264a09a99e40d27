//! Writes plots as SVG and PNG.

use super::failure::{Failure, code};
use super::terminal::{print_hint, print_prose};
use crate::files::atomic_file;
use crate::plots::rasterise::to_png;
use crate::plots::svg::Plot;
use std::path::Path;

/// Pixels of a PNG for each unit of its drawing.
pub(crate) const PNG_SCALE: f32 = 1.5;

/// Writes each plot as SVG and as PNG.
pub(crate) fn write(folder: &Path, plots: &[Plot]) -> Result<(), Failure> {
    atomic_file::refuse_linked_folder(folder)
        .map_err(|error| Failure::io(folder.display(), &error))?;
    std::fs::create_dir_all(folder).map_err(|error| Failure::io(folder.display(), &error))?;
    for plot in plots {
        let png = to_png(&plot.svg, PNG_SCALE).map_err(Failure::bug)?;
        for (extension, bytes) in [("svg", plot.svg.as_bytes()), ("png", &png[..])] {
            let path = folder.join(format!("{}.{extension}", plot.name));
            atomic_file::write_unlinked(&path, bytes)
                .map_err(|error| Failure::io(path.display(), &error))?;
        }
    }
    Ok(())
}

/// How a single plot is written.
#[derive(Clone, Copy)]
pub(crate) enum PlotType {
    Svg,
    Png,
}

impl PlotType {
    /// That of the file that `--plot` names.
    pub(crate) fn of(path: &Path) -> Result<Self, Failure> {
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(Failure::usage(format!(
                "--plot {}: the name must end in .svg or .png",
                path.display()
            ))),
        }
    }
}

/// Writes one plot to the file that `--plot` names.
pub(crate) fn write_one(path: &Path, plot: &Plot) -> Result<(), Failure> {
    let bytes = match PlotType::of(path)? {
        PlotType::Svg => plot.svg.as_bytes().to_vec(),
        PlotType::Png => to_png(&plot.svg, PNG_SCALE).map_err(Failure::bug)?,
    };
    atomic_file::write(path, &bytes).map_err(|error| Failure::io(path.display(), &error))
}

/// Prints the captions of the written plots.
pub(crate) fn print_captions(folder: &Path, plots: &[Plot]) -> Result<u8, Failure> {
    for plot in plots {
        print_prose(&format!("{}: {}\n", plot.name, plot.caption))?;
    }
    print_hint(&format!(
        "plots written to {} (svg and png)",
        folder.display()
    ));
    Ok(code::DONE)
}
