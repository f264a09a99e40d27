//! P along each part of the best shots.

use super::frame::{Frame, legend};
use super::svg::{Anchor, Svg, shortened};
use super::sweep_maps::Picture;
use crate::profile::Profile;

/// Colours of direct and bank.
const COLOURS: [(&str, [u8; 3]); 2] = [("direct", [0, 114, 178]), ("bank", [184, 92, 0])];

/// Draws the rows of `curves.csv` (kind, nominal, unit, value, probability; the header first); none where there are no
/// curves.
#[must_use]
pub fn picture(profile: &Profile, rows: &[Vec<String>]) -> Option<Picture> {
    let mut panels: Vec<(String, String)> = Vec::new();
    let points: Vec<(&str, &str, f64, f64)> = rows
        .iter()
        .skip(1)
        .filter(|row| row.len() == 5)
        .filter_map(|row| {
            let panel = (row[1].clone(), row[2].clone());
            if !panels.contains(&panel) {
                panels.push(panel);
            }
            Some((
                &row[0][..],
                &row[1][..],
                row[3].parse().ok()?,
                row[4].parse().ok()?,
            ))
        })
        .collect();
    if points.is_empty() {
        return None;
    }
    let (width, height) = (300.0, 240.0);
    let mut svg = Svg::new(panels.len() as f64 * width + 110.0, height + 60.0);
    let title = format!(
        "P along each part of the best shots: {}",
        shortened(&profile.shooter.name, 60)
    );
    svg.heading((20.0, 24.0), 15.0, Anchor::Start, &title);
    let top = points.iter().fold(0.05, |top: f64, point| top.max(point.3));
    for (i, (nominal, unit)) in panels.iter().enumerate() {
        let of = |kind: &str| -> Vec<(f64, f64)> {
            points
                .iter()
                .filter(|point| point.0 == kind && point.1 == nominal)
                .map(|point| (point.2, point.3))
                .collect()
        };
        let (low, high) = points
            .iter()
            .filter(|point| point.1 == nominal)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| {
                (low.min(point.2), high.max(point.2))
            });
        let frame = Frame {
            corner: (70.0 + i as f64 * width, 70.0),
            size: (width - 85.0, height - 90.0),
            x: (low, high),
            y: (0.0, (1.08 * top).min(1.0)),
        };
        frame.grid(&mut svg);
        svg.clipped(frame.corner, frame.size, |svg| {
            for (kind, colour) in COLOURS {
                let style = format!(
                    "stroke=\"{}\" stroke-width=\"2\" fill=\"none\"",
                    super::frame::hex(colour)
                );
                svg.polyline(of(kind).into_iter().map(|point| frame.at(point)), &style);
            }
        });
        frame.axes(&mut svg, nominal, &format!("{nominal} ({unit})"), "P");
    }
    let names: Vec<(String, [u8; 3])> = COLOURS
        .iter()
        .filter(|(kind, _)| points.iter().any(|point| point.0 == *kind))
        .map(|(kind, colour)| ((*kind).to_owned(), *colour))
        .collect();
    legend(&mut svg, (panels.len() as f64 * width + 12.0, 74.0), &names);
    let caption = "P as a function of each nominal value around the best shots, the others held.";
    Some(Picture {
        name: "curves".to_owned(),
        caption: caption.to_owned(),
        svg: svg.finish(caption),
    })
}
