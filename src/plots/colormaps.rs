//! Colours that people with any colour vision can tell apart.
//!
//! Sources: viridis, and the purple-orange scale of ColorBrewer, both from the crate colorous; the
//! eight categorical colours of Okabe and Ito 2008.

use crate::dynamics::OutcomeKind;

/// Red, green and blue.
pub type Rgb = [u8; 3];

/// Where there is no value.
pub const NO_VALUE: Rgb = [235, 235, 235];
/// Where a difference is not significant.
pub const NOT_SIGNIFICANT: Rgb = [255, 255, 255];

/// The categorical colours in the order of Okabe and Ito; the last one is grey instead of black.
pub const OKABE_ITO: [Rgb; 8] = [
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [240, 228, 66],
    [0, 114, 178],
    [213, 94, 0],
    [204, 121, 167],
    [90, 90, 90],
];

/// The kinds of made shots with their names in legends and their colours.
pub const MADE_KINDS: [(OutcomeKind, &str, Rgb); 4] = [
    (OutcomeKind::Swish, "swish", OKABE_ITO[2]),
    (OutcomeKind::RimIn, "off the ring", OKABE_ITO[1]),
    (OutcomeKind::BankIn, "off the board", OKABE_ITO[0]),
    (OutcomeKind::BankRimIn, "off board and ring", OKABE_ITO[5]),
];

/// From 0 (dark) to 1 (light).
#[must_use]
pub fn sequential(fraction: f64) -> Rgb {
    let colour = colorous::VIRIDIS.eval_continuous(fraction.clamp(0.0, 1.0));
    [colour.r, colour.g, colour.b]
}

/// From -1 (purple) through 0 (white) to 1 (orange).
#[must_use]
pub fn diverging(fraction: f64) -> Rgb {
    let fraction = 0.5 * (1.0 + fraction.clamp(-1.0, 1.0));
    let colour = colorous::PURPLE_ORANGE.eval_continuous(fraction);
    [colour.r, colour.g, colour.b]
}

/// The colour of an outcome. All missed shots have the colour of [`NO_VALUE`], so the made ones
/// stand out.
#[must_use]
pub fn of_outcome(kind: OutcomeKind) -> Rgb {
    MADE_KINDS
        .iter()
        .find(|(made, _, _)| *made == kind)
        .map_or(NO_VALUE, |(_, _, colour)| *colour)
}

/// A colour in SVG notation.
#[must_use]
pub fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
