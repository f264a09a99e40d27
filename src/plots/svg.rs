//! A drawing as SVG text: rectangles, lines, circles, text and grids of colours.

use super::rasterise::encode_pixels;
use crate::escape::html;
use base64::Engine;
use std::fmt::Write;

/// A finished plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// File name without its extension.
    pub name: String,
    /// What the plot shows, in one sentence.
    pub caption: String,
    /// The SVG file.
    pub svg: Drawing,
}

/// An SVG file and its size.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    text: String,
    /// Width over height.
    pub aspect: f64,
}

impl std::ops::Deref for Drawing {
    type Target = str;

    fn deref(&self) -> &str {
        &self.text
    }
}

/// Colour of text and lines.
pub const INK: &str = "#222222";
/// Colour of lines in the background.
pub const FAINT: &str = "#999999";

/// Position of a text relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text starts at the point.
    Start,
    /// The text is centred on the point.
    Middle,
    /// The text ends at the point.
    End,
}

/// A drawing. Coordinates are in pixels from the upper left corner, y down; `style` is a list of
/// SVG attributes.
#[derive(Clone, Debug)]
pub struct Svg {
    width: f64,
    height: f64,
    body: String,
    clips: usize,
}

/// A number with at most two decimals and no trailing zeros.
fn px(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// A text of at most `max_chars` characters. An ellipsis replaces the rest.
#[must_use]
pub fn shortened(text: &str, max_chars: usize) -> String {
    if text.chars().count() <= max_chars {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(max_chars.saturating_sub(1)).collect();
    short.push('\u{2026}');
    short
}

impl Svg {
    /// An empty drawing on white.
    #[must_use]
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            body: String::new(),
            clips: 0,
        }
    }

    /// Draws a rectangle.
    pub fn rect(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), style: &str) {
        // Writing to a String never fails, here and below.
        let _ = writeln!(
            self.body,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {style}/>",
            px(x),
            px(y),
            px(width),
            px(height)
        );
    }

    /// Draws a line through points.
    pub fn polyline(&mut self, points: impl IntoIterator<Item = (f64, f64)>, style: &str) {
        let mut path = String::new();
        for (i, (x, y)) in points.into_iter().enumerate() {
            let command = if i == 0 { "M" } else { "L" };
            let _ = write!(path, "{command}{} {}", px(x), px(y));
        }
        let _ = writeln!(self.body, "<path d=\"{path}\" {style}/>");
    }

    /// Draws a circle.
    pub fn circle(&mut self, (x, y): (f64, f64), radius: f64, style: &str) {
        let _ = writeln!(
            self.body,
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {style}/>",
            px(x),
            px(y),
            px(radius)
        );
    }

    /// Writes a line of text.
    pub fn text(&mut self, at: (f64, f64), size: f64, anchor: Anchor, text: &str) {
        self.styled_text(at, size, anchor, text, "");
    }

    /// Writes a line of bold text.
    pub fn heading(&mut self, at: (f64, f64), size: f64, anchor: Anchor, text: &str) {
        self.styled_text(at, size, anchor, text, " font-weight=\"bold\"");
    }

    /// Writes a number that stays readable where lines of the drawing cross it: a pale border
    /// covers them.
    pub fn number_over_lines(&mut self, at: (f64, f64), size: f64, text: &str, is_bold: bool) {
        let weight = if is_bold { " font-weight=\"bold\"" } else { "" };
        let style = format!(
            "{weight} stroke=\"#fff\" stroke-width=\"4\" stroke-opacity=\"0.75\" stroke-linejoin=\"round\" paint-order=\"stroke\""
        );
        self.styled_text(at, size, Anchor::Middle, text, &style);
    }

    /// Writes a small line below a plot, such as where the plot comes from.
    pub fn footnote(&mut self, at: (f64, f64), text: &str) {
        self.text(at, 11.0, Anchor::Start, text);
    }

    /// Writes a line of text that reads upwards.
    pub fn upward_text(&mut self, (x, y): (f64, f64), size: f64, text: &str) {
        let _ = writeln!(
            self.body,
            // A matrix instead of an angle: machines may round the sine of an angle differently.
            "<g transform=\"matrix(0 -1 1 0 {} {})\">",
            px(x),
            px(y)
        );
        self.text((0.0, 0.0), size, Anchor::Middle, text);
        self.body.push_str("</g>\n");
    }

    fn styled_text(
        &mut self,
        (x, y): (f64, f64),
        size: f64,
        anchor: Anchor,
        text: &str,
        attributes: &str,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = writeln!(
            self.body,
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{INK}\"{attributes}>{}</text>",
            px(x),
            px(y),
            px(size),
            html(text)
        );
    }

    /// Draws a grid of colours (red, green, blue, opacity), row by row from the top, with sharp
    /// edges.
    pub fn pixels(
        &mut self,
        (x, y): (f64, f64),
        (width, height): (f64, f64),
        (columns, rows): (usize, usize),
        colours: &[[u8; 4]],
    ) {
        let Some(png) = encode_pixels(columns, rows, colours) else {
            return;
        };
        let data = base64::engine::general_purpose::STANDARD.encode(png);
        let _ = writeln!(
            self.body,
            "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" image-rendering=\"pixelated\" href=\"data:image/png;base64,{data}\"/>",
            px(x),
            px(y),
            px(width),
            px(height)
        );
    }

    /// Draws inside a rectangle only.
    pub fn clipped(
        &mut self,
        (x, y): (f64, f64),
        (width, height): (f64, f64),
        draw: impl FnOnce(&mut Self),
    ) {
        self.clips += 1;
        let clip = self.clips;
        let _ = writeln!(
            self.body,
            "<clipPath id=\"clip{clip}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n<g clip-path=\"url(#clip{clip})\">",
            px(x),
            px(y),
            px(width),
            px(height)
        );
        draw(self);
        self.body.push_str("</g>\n");
    }

    /// The drawing as an SVG file. Screen readers read the title.
    #[must_use]
    pub fn finish(self, title: &str) -> Drawing {
        let (width, height) = (px(self.width), px(self.height));
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" style=\"max-width:100%;height:auto\" font-family=\"DejaVu Sans, Verdana, sans-serif\" role=\"img\">\n<title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            html(title),
            self.body
        );
        Drawing {
            text,
            aspect: self.width / self.height,
        }
    }
}
