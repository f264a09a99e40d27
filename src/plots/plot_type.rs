//! A finished plot.

/// A finished plot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plot {
    /// File name without its extension.
    pub name: String,
    /// What the plot shows, in one sentence.
    pub caption: String,
    /// The SVG file.
    pub svg: String,
}
