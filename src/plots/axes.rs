//! A panel of a plot: a rectangle with axes.

use super::svg::{Anchor, FAINT, INK, Svg};

/// Font size of the numbers on axes, px.
pub(super) const TICK_FONT: f64 = 11.0;
/// Font size of the labels of axes, px.
pub(super) const LABEL_FONT: f64 = 12.0;

/// A rectangle of a drawing with its own coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// Upper left corner, px.
    pub corner: (f64, f64),
    /// Width and height, px.
    pub size: (f64, f64),
    /// Values at the left and right edges.
    pub x: (f64, f64),
    /// Values at the bottom and top edges.
    pub y: (f64, f64),
}

impl Axes {
    /// Axes of a given width with the same scale along x and y.
    #[must_use]
    pub fn to_scale(corner: (f64, f64), width: f64, x: (f64, f64), y: (f64, f64)) -> Self {
        let height = width * (y.1 - y.0).abs() / (x.1 - x.0).abs();
        Self {
            corner,
            size: (width, height),
            x,
            y,
        }
    }

    /// The pixel of a point.
    #[must_use]
    pub fn pixel(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let fraction = |value: f64, (from, to): (f64, f64)| (value - from) / (to - from);
        (
            self.corner.0 + self.size.0 * fraction(x, self.x),
            self.corner.1 + self.size.1 * (1.0 - fraction(y, self.y)),
        )
    }

    /// A length along x in pixels.
    #[must_use]
    pub fn pixels_of_length(&self, length: f64) -> f64 {
        (length * self.size.0 / (self.x.1 - self.x.0)).abs()
    }

    /// Lower right corner, px.
    #[must_use]
    pub fn lower_right(&self) -> (f64, f64) {
        (self.corner.0 + self.size.0, self.corner.1 + self.size.1)
    }

    /// Draws the border, the ticks with their numbers, the labels, and a title above.
    pub fn draw(&self, svg: &mut Svg, title: &str, x_label: &str, y_label: &str) {
        let (right, bottom) = self.lower_right();
        svg.rect(
            self.corner,
            self.size,
            &format!("fill=\"none\" stroke=\"{INK}\""),
        );
        let style = format!("stroke=\"{INK}\" fill=\"none\"");
        for value in ticks(self.x) {
            let (x, _) = self.pixel((value, self.y.0));
            svg.polyline([(x, bottom), (x, bottom + 4.0)], &style);
            let text = format_tick(value);
            svg.text((x, bottom + 17.0), TICK_FONT, Anchor::Middle, &text);
        }
        for value in ticks(self.y) {
            let (_, y) = self.pixel((self.x.0, value));
            svg.polyline([(self.corner.0 - 4.0, y), (self.corner.0, y)], &style);
            let at = (self.corner.0 - 7.0, y + 4.0);
            svg.text(at, TICK_FONT, Anchor::End, &format_tick(value));
        }
        let middle = 0.5 * (self.corner.0 + right);
        svg.text((middle, bottom + 35.0), LABEL_FONT, Anchor::Middle, x_label);
        svg.upward_text(
            (self.corner.0 - 42.0, 0.5 * (self.corner.1 + bottom)),
            LABEL_FONT,
            y_label,
        );
        svg.heading((middle, self.corner.1 - 9.0), 13.0, Anchor::Middle, title);
    }

    /// Draws faint lines at the ticks.
    pub fn draw_grid(&self, svg: &mut Svg) {
        let (right, bottom) = self.lower_right();
        let style = format!("stroke=\"{FAINT}\" stroke-opacity=\"0.35\" fill=\"none\"");
        for value in ticks(self.x) {
            let (x, _) = self.pixel((value, self.y.0));
            svg.polyline([(x, self.corner.1), (x, bottom)], &style);
        }
        for value in ticks(self.y) {
            let (_, y) = self.pixel((self.x.0, value));
            svg.polyline([(self.corner.0, y), (right, y)], &style);
        }
    }
}

/// About five round values within a range.
#[must_use]
pub fn ticks((from, to): (f64, f64)) -> Vec<f64> {
    let (low, high) = (from.min(to), from.max(to));
    let rough_step = (high - low) / 5.0;
    if !(rough_step > 0.0 && rough_step.is_finite()) {
        return Vec::new();
    }
    let power = libm::exp10(libm::log10(rough_step).floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| (high - low) / step <= 6.0)
        .unwrap_or(10.0 * power);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// A number with at most three decimals and no trailing zeros.
#[must_use]
pub fn format_tick(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    let text = if text == "-0" { "0" } else { text };
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_ticks_are_round_and_inside_the_range() {
        for (low, high) in [
            (0.0, 1.0),
            (-0.06, 0.05),
            (21.0, 29.3),
            (40.0, 65.0),
            (0.998, 1.0),
        ] {
            let found = ticks((low, high));
            assert!((3..=7).contains(&found.len()), "{low} {high}: {found:?}");
            assert!(found.iter().all(|&v| v >= low - 1e-9 && v <= high + 1e-9));
        }
        assert!(ticks((1.0, 1.0)).is_empty());
        assert_eq!(format_tick(-0.25), "\u{2212}0.25");
        assert_eq!(format_tick(-0.0), "0");
    }
}
