//! Colours that people with any colour vision can tell apart.
//!
//! Sources: viridis and the purple-orange scale of ColorBrewer, by the crate colorous; eight names by Okabe and Ito 2008.

use crate::dynamics::Kind;

/// What has no value.
pub const NOTHING: [u8; 3] = [235, 235, 235];

/// 0 (dark) to 1 (light).
#[must_use]
pub fn sequential(part: f64) -> [u8; 3] {
    let colour = colorous::VIRIDIS.eval_continuous(part.clamp(0.0, 1.0));
    [colour.r, colour.g, colour.b]
}

/// -1 (purple) through 0 (white) to 1 (orange).
#[must_use]
pub fn diverging(part: f64) -> [u8; 3] {
    let colour = colorous::PURPLE_ORANGE.eval_continuous(0.5 * (1.0 + part.clamp(-1.0, 1.0)));
    [colour.r, colour.g, colour.b]
}

/// The colours of names, in the order of Okabe and Ito.
pub const NAMED: [[u8; 3]; 8] = [
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [240, 228, 66],
    [0, 114, 178],
    [213, 94, 0],
    [204, 121, 167],
    [90, 90, 90],
];

/// The ways of making a shot, with their colours.
pub const MADE: [(Kind, &str, [u8; 3]); 4] = [
    (Kind::Swish, "swish", NAMED[2]),
    (Kind::RimIn, "off the ring", NAMED[1]),
    (Kind::BankIn, "off the board", NAMED[0]),
    (Kind::BankRimIn, "off board and ring", NAMED[5]),
];

/// The colour of a way of ending; missed shots stand back.
#[must_use]
pub fn of_kind(kind: Kind) -> [u8; 3] {
    MADE.iter()
        .find(|(made, _, _)| *made == kind)
        .map_or(NOTHING, |(_, _, colour)| *colour)
}
