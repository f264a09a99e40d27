//! SVG to PNG, and grids of colours as PNG.
//!
//! Text uses the fonts in `assets/` and never those of the machine, so the pixels are the same
//! everywhere.

use std::sync::{Arc, LazyLock};

const REGULAR_FONT: &[u8] = include_bytes!("../../assets/DejaVuSans.ttf");
const BOLD_FONT: &[u8] = include_bytes!("../../assets/DejaVuSans-Bold.ttf");

/// A plot that cannot be converted to PNG.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the plot cannot be converted to PNG: {0}")]
pub struct RasteriseError(String);

static FONTS: LazyLock<Arc<resvg::usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = resvg::usvg::fontdb::Database::new();
    fonts.load_font_data(REGULAR_FONT.to_vec());
    fonts.load_font_data(BOLD_FONT.to_vec());
    Arc::new(fonts)
});

/// Converts an SVG file to PNG with `scale` pixels for each pixel of the SVG.
///
/// # Errors
/// The text is not SVG, or the image is too large.
pub fn to_png(svg: &str, scale: f32) -> Result<Vec<u8>, RasteriseError> {
    let options = resvg::usvg::Options {
        fontdb: FONTS.clone(),
        font_family: "DejaVu Sans".to_owned(),
        ..Default::default()
    };
    let tree = resvg::usvg::Tree::from_str(svg, &options)
        .map_err(|error| RasteriseError(error.to_string()))?;
    let size = tree.size();
    let (width, height) = (
        (size.width() * scale).ceil() as u32,
        (size.height() * scale).ceil() as u32,
    );
    let mut pixels = resvg::tiny_skia::Pixmap::new(width, height)
        .ok_or_else(|| RasteriseError(format!("{width} x {height} pixels are too many")))?;
    let transform = resvg::tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels
        .encode_png()
        .map_err(|error| RasteriseError(error.to_string()))
}

/// A grid of colours (red, green, blue, opacity) as PNG, row by row from the top; `None` if the
/// number of colours does not fit.
pub(super) fn encode_pixels(columns: usize, rows: usize, colours: &[[u8; 4]]) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns as u32, rows as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().ok()?;
    writer.write_image_data(colours.as_flattened()).ok()?;
    writer.finish().ok()?;
    Some(bytes)
}
