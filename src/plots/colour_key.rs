//! Keys beside a plot: colour bars and legends.

use super::axes::{LABEL_FONT, TICK_FONT, format_tick, ticks};
use super::colormaps::{Rgb, hex, sequential};
use super::svg::{Anchor, INK, Svg};

/// Number of colours in a colour bar.
const BAR_STEPS: usize = 64;
/// Width of a colour bar, px.
const BAR_WIDTH: f64 = 14.0;

/// A scale of colours with its name.
#[derive(Clone, Copy)]
pub struct ColourScale<'a> {
    /// Name above the bar.
    pub name: &'a str,
    /// Values at the bottom and top of the bar.
    pub range: (f64, f64),
    /// The colour of a value.
    pub colour: &'a dyn Fn(f64) -> Rgb,
}

/// Explains the colours of a map.
#[derive(Clone, Copy)]
pub enum ColourKey<'a> {
    /// Colours of numbers.
    Scale(ColourScale<'a>),
    /// Colours of names.
    Legend(&'a [(String, Rgb)]),
}

impl ColourScale<'static> {
    /// The scale of P.
    pub const PROBABILITY: Self = Self {
        name: "probability",
        range: (0.0, 1.0),
        colour: &sequential,
    };
}

impl ColourScale<'_> {
    /// Draws a colour bar of a given height from its upper left corner, with its numbers to the
    /// right.
    pub fn draw(&self, svg: &mut Svg, (x, y): (f64, f64), height: f64) {
        let range = self.range;
        let colours: Vec<[u8; 4]> = (0..BAR_STEPS)
            .map(|i| {
                let fraction = (i as f64 + 0.5) / BAR_STEPS as f64;
                let [r, g, b] = (self.colour)(range.1 - fraction * (range.1 - range.0));
                [r, g, b, 255]
            })
            .collect();
        svg.pixels((x, y), (BAR_WIDTH, height), (1, BAR_STEPS), &colours);
        svg.rect(
            (x, y),
            (BAR_WIDTH, height),
            &format!("fill=\"none\" stroke=\"{INK}\""),
        );
        let right = x + BAR_WIDTH;
        for value in ticks(range) {
            let at = y + height * (range.1 - value) / (range.1 - range.0);
            svg.polyline(
                [(right, at), (right + 4.0, at)],
                &format!("stroke=\"{INK}\" fill=\"none\""),
            );
            let text = format_tick(value);
            svg.text((right + 7.0, at + 4.0), TICK_FONT, Anchor::Start, &text);
        }
        svg.text((x, y - 9.0), LABEL_FONT, Anchor::Start, self.name);
    }
}

/// Draws names with their colours, one below the other.
pub fn draw_legend(svg: &mut Svg, (x, y): (f64, f64), entries: &[(String, Rgb)]) {
    for (i, (name, colour)) in entries.iter().enumerate() {
        let y = y + 18.0 * i as f64;
        let style = format!(
            "fill=\"{}\" stroke=\"{INK}\" stroke-width=\"0.5\"",
            hex(*colour)
        );
        svg.rect((x, y), (12.0, 12.0), &style);
        svg.text((x + 18.0, y + 10.5), TICK_FONT, Anchor::Start, name);
    }
}
