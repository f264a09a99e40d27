//! Drawings as SVG, and as PNG by way of it, with a font of their own: the same bytes on every machine.

use base64::Engine;
use std::fmt::Write;
use std::sync::{Arc, LazyLock};

const REGULAR: &[u8] = include_bytes!("../../assets/DejaVuSans.ttf");
const BOLD: &[u8] = include_bytes!("../../assets/DejaVuSans-Bold.ttf");
/// Text and lines.
pub const INK: &str = "#222222";
/// Lines that stand back.
pub const FAINT: &str = "#999999";

/// Where a text stands about its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// It is centred there.
    Middle,
    /// It ends there.
    End,
}

/// A drawing under way; units are pixels, y down.
#[derive(Clone, Debug)]
pub struct Svg {
    width: f64,
    height: f64,
    body: String,
    clips: usize,
}

/// A picture that could not be turned into PNG.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the picture cannot be drawn: {0}")]
pub struct PictureError(String);

/// A number with at most two digits after the point, without trailing zeros.
fn px(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// Text safe inside SVG and HTML, without characters that XML does not know.
#[must_use]
pub fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

/// A title of bounded length.
#[must_use]
pub fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(most.saturating_sub(1)).collect();
    short.push('\u{2026}');
    short
}

impl Svg {
    /// An empty white page.
    #[must_use]
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            body: String::new(),
            clips: 0,
        }
    }

    /// A rectangle; `style` is a list of SVG attributes, here and below.
    pub fn rect(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), style: &str) {
        // Writing to a String does not fail, here and below.
        let _ = writeln!(
            self.body,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {style}/>",
            px(x),
            px(y),
            px(width),
            px(height)
        );
    }

    /// A line through points.
    pub fn polyline(&mut self, points: impl IntoIterator<Item = (f64, f64)>, style: &str) {
        let mut path = String::new();
        for (i, (x, y)) in points.into_iter().enumerate() {
            let _ = write!(
                path,
                "{}{} {}",
                if i == 0 { "M" } else { "L" },
                px(x),
                px(y)
            );
        }
        self.path(&path, style);
    }

    /// A path in SVG's own words.
    pub fn path(&mut self, path: &str, style: &str) {
        let _ = writeln!(self.body, "<path d=\"{path}\" {style}/>");
    }

    /// A circle.
    pub fn circle(&mut self, (x, y): (f64, f64), radius: f64, style: &str) {
        let _ = writeln!(
            self.body,
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {style}/>",
            px(x),
            px(y),
            px(radius)
        );
    }

    /// A line of text.
    pub fn text(&mut self, at: (f64, f64), size: f64, anchor: Anchor, text: &str) {
        self.styled_text(at, size, anchor, text, "");
    }

    /// A line of bold text.
    pub fn heading(&mut self, at: (f64, f64), size: f64, anchor: Anchor, text: &str) {
        self.styled_text(at, size, anchor, text, " font-weight=\"bold\"");
    }

    /// A line of text that reads upwards.
    pub fn upward_text(&mut self, (x, y): (f64, f64), size: f64, text: &str) {
        let _ = writeln!(
            self.body,
            // A matrix, not an angle: no sine that machines may round apart.
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
        more: &str,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = writeln!(
            self.body,
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{INK}\"{more}>{}</text>",
            px(x),
            px(y),
            px(size),
            escaped(text)
        );
    }

    /// A grid of colours, rows from the top, each a sharp rectangle.
    pub fn pixels(
        &mut self,
        (x, y): (f64, f64),
        (width, height): (f64, f64),
        (columns, rows): (usize, usize),
        colours: &[[u8; 4]],
    ) {
        let Some(png) = png(columns, rows, colours) else {
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

    /// Draws within a rectangle only.
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

    /// The drawing as an SVG file; the title is what a screen reader says.
    #[must_use]
    pub fn finish(self, title: &str) -> String {
        let (width, height) = (px(self.width), px(self.height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"DejaVu Sans, Verdana, sans-serif\" role=\"img\">\n<title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            escaped(title),
            self.body
        )
    }
}

static FONTS: LazyLock<Arc<resvg::usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = resvg::usvg::fontdb::Database::new();
    fonts.load_font_data(REGULAR.to_vec());
    fonts.load_font_data(BOLD.to_vec());
    Arc::new(fonts)
});

/// An SVG file as PNG, `scale` pixels for each of its own.
///
/// # Errors
/// When it is no SVG, or too large.
pub fn to_png(svg: &str, scale: f32) -> Result<Vec<u8>, PictureError> {
    let options = resvg::usvg::Options {
        fontdb: FONTS.clone(),
        font_family: "DejaVu Sans".to_owned(),
        ..Default::default()
    };
    let refuse = |error: String| PictureError(error);
    let tree =
        resvg::usvg::Tree::from_str(svg, &options).map_err(|error| refuse(error.to_string()))?;
    let size = tree.size();
    let (width, height) = (
        (size.width() * scale).ceil() as u32,
        (size.height() * scale).ceil() as u32,
    );
    let mut pixels = resvg::tiny_skia::Pixmap::new(width, height)
        .ok_or_else(|| refuse(format!("{width} x {height} pixels are too many")))?;
    let transform = resvg::tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels
        .encode_png()
        .map_err(|error| refuse(error.to_string()))
}

fn png(columns: usize, rows: usize, colours: &[[u8; 4]]) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns as u32, rows as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().ok()?;
    writer.write_image_data(colours.as_flattened()).ok()?;
    writer.finish().ok()?;
    Some(bytes)
}
