//! The text of a profile that flags have changed.

use super::failure::Failure;

/// A profile's text with other tables, which begins with the flags that changed it, earlier ones
/// first. Other comments are lost.
pub(crate) fn rewritten(text: &str, root: &toml::Table, flags: &str) -> Result<String, Failure> {
    let earlier: String = text
        .split_inclusive('\n')
        .take_while(|line| line.starts_with(WITH_FLAGS))
        .collect();
    let tables = toml::to_string_pretty(root)
        .map_err(|error| Failure::usage(format!("the profile: {error}")))?;
    Ok(format!("{earlier}{WITH_FLAGS}{flags}\n{tables}"))
}

/// What a line with flags begins with.
const WITH_FLAGS: &str = "# With";
