//! A panel with axes, and colour bars beside it.

use super::svg::{Anchor, FAINT, INK, Svg};

/// Size of the numbers at axes.
const SMALL: f64 = 11.0;
/// Size of the words at axes.
const WORDS: f64 = 12.0;

/// A rectangle of a drawing with coordinates of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its upper left corner, pixels.
    pub corner: (f64, f64),
    /// Its width and height, pixels.
    pub size: (f64, f64),
    /// Values at its left and right.
    pub x: (f64, f64),
    /// Values at its bottom and top.
    pub y: (f64, f64),
}

impl Frame {
    /// A frame of a certain width in which both axes have the same scale.
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

    /// Pixels of a point.
    #[must_use]
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let part = |value: f64, (from, to): (f64, f64)| (value - from) / (to - from);
        (
            self.corner.0 + self.size.0 * part(x, self.x),
            self.corner.1 + self.size.1 * (1.0 - part(y, self.y)),
        )
    }

    /// Pixels of a length along x.
    #[must_use]
    pub fn length(&self, length: f64) -> f64 {
        (length * self.size.0 / (self.x.1 - self.x.0)).abs()
    }

    /// Its lower right corner, pixels.
    #[must_use]
    pub fn end(&self) -> (f64, f64) {
        (self.corner.0 + self.size.0, self.corner.1 + self.size.1)
    }

    /// Draws the border, the numbers and the names of the axes, and a title above.
    pub fn axes(&self, svg: &mut Svg, title: &str, x_name: &str, y_name: &str) {
        let (right, bottom) = self.end();
        svg.rect(
            self.corner,
            self.size,
            &format!("fill=\"none\" stroke=\"{INK}\""),
        );
        let tick = format!("stroke=\"{INK}\" fill=\"none\"");
        for value in ticks(self.x) {
            let (x, _) = self.at((value, self.y.0));
            svg.polyline([(x, bottom), (x, bottom + 4.0)], &tick);
            svg.text((x, bottom + 17.0), SMALL, Anchor::Middle, &short(value));
        }
        for value in ticks(self.y) {
            let (_, y) = self.at((self.x.0, value));
            svg.polyline([(self.corner.0 - 4.0, y), (self.corner.0, y)], &tick);
            svg.text(
                (self.corner.0 - 7.0, y + 4.0),
                SMALL,
                Anchor::End,
                &short(value),
            );
        }
        let middle = 0.5 * (self.corner.0 + right);
        svg.text((middle, bottom + 35.0), WORDS, Anchor::Middle, x_name);
        svg.upward_text(
            (self.corner.0 - 42.0, 0.5 * (self.corner.1 + bottom)),
            WORDS,
            y_name,
        );
        svg.heading((middle, self.corner.1 - 9.0), 13.0, Anchor::Middle, title);
    }

    /// Draws faint lines at the numbers of the axes.
    pub fn grid(&self, svg: &mut Svg) {
        let (right, bottom) = self.end();
        let style = format!("stroke=\"{FAINT}\" stroke-opacity=\"0.35\" fill=\"none\"");
        for value in ticks(self.x) {
            let (x, _) = self.at((value, self.y.0));
            svg.polyline([(x, self.corner.1), (x, bottom)], &style);
        }
        for value in ticks(self.y) {
            let (_, y) = self.at((self.x.0, value));
            svg.polyline([(self.corner.0, y), (right, y)], &style);
        }
    }
}

/// About five round values within a range.
#[must_use]
pub fn ticks((from, to): (f64, f64)) -> Vec<f64> {
    let (low, high) = (from.min(to), from.max(to));
    let rough = (high - low) / 5.0;
    if !(rough > 0.0 && rough.is_finite()) {
        return Vec::new();
    }
    let power = libm::exp10(libm::log10(rough).floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| (high - low) / step <= 6.0)
        .unwrap_or(10.0 * power);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// A number in as few digits as it takes.
#[must_use]
pub fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    let text = if text == "-0" { "0" } else { text };
    text.replace('-', "\u{2212}")
}

/// Draws a bar of colours with its numbers to the right of a point; the name stands above it.
pub fn colour_bar(
    svg: &mut Svg,
    (x, y): (f64, f64),
    height: f64,
    range: (f64, f64),
    name: &str,
    colour: impl Fn(f64) -> [u8; 3],
) {
    const STEPS: usize = 64;
    let width = 14.0;
    let colours: Vec<[u8; 4]> = (0..STEPS)
        .map(|i| {
            let part = (i as f64 + 0.5) / STEPS as f64;
            let [r, g, b] = colour(range.1 - part * (range.1 - range.0));
            [r, g, b, 255]
        })
        .collect();
    svg.pixels((x, y), (width, height), (1, STEPS), &colours);
    svg.rect(
        (x, y),
        (width, height),
        &format!("fill=\"none\" stroke=\"{INK}\""),
    );
    for value in ticks(range) {
        let at = y + height * (range.1 - value) / (range.1 - range.0);
        svg.polyline(
            [(x + width, at), (x + width + 4.0, at)],
            &format!("stroke=\"{INK}\" fill=\"none\""),
        );
        svg.text(
            (x + width + 7.0, at + 4.0),
            SMALL,
            Anchor::Start,
            &short(value),
        );
    }
    svg.text((x, y - 9.0), WORDS, Anchor::Start, name);
}

/// Draws names with their colours, one below the other.
pub fn legend(svg: &mut Svg, (x, y): (f64, f64), entries: &[(String, [u8; 3])]) {
    for (i, (name, colour)) in entries.iter().enumerate() {
        let y = y + 18.0 * i as f64;
        let style = format!(
            "fill=\"{}\" stroke=\"{INK}\" stroke-width=\"0.5\"",
            hex(*colour)
        );
        svg.rect((x, y), (12.0, 12.0), &style);
        svg.text((x + 18.0, y + 10.5), SMALL, Anchor::Start, name);
    }
}

/// A colour as SVG writes it.
#[must_use]
pub fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_ticks_are_round_and_inside() {
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
        assert_eq!(short(-0.25), "\u{2212}0.25");
        assert_eq!(short(-0.0), "0");
    }
}
