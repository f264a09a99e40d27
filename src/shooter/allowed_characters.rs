//! Which characters a name may have.

/// Whether a character steers a terminal or the direction of text: a name with one could show
/// itself, or what stands after it, as something else.
#[must_use]
pub fn is_control_or_direction(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}
