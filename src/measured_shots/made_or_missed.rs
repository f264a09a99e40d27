//! The words for a make and for a miss.

/// Words for a make and for a miss, in small letters.
const MADE: &[&str] = &[
    "basket",
    "bucket",
    "1",
    "1.0",
    "true",
    "t",
    "yes",
    "y",
    "made",
    "make",
    "hit",
    "in",
    "swish",
    "success",
    "successful",
    "good",
    "goal",
    "scored",
    "score",
    "wahr",
    "ja",
    "treffer",
    "vrai",
    "oui",
    "réussi",
    "verdadero",
    "sí",
    "vero",
    "made shot",
    "✓",
    "✔",
];
const MISSED: &[&str] = &[
    "no basket",
    "not made",
    "not in",
    "0",
    "0.0",
    "false",
    "f",
    "no",
    "n",
    "missed",
    "miss",
    "out",
    "airball",
    "air ball",
    "fail",
    "failed",
    "failure",
    "unsuccessful",
    "bad",
    "no goal",
    "falsch",
    "nein",
    "fehlwurf",
    "daneben",
    "faux",
    "non",
    "raté",
    "falso",
    "missed shot",
    "✗",
    "✘",
];

/// Whether a cell says made or missed; `None` where it says nothing.
///
/// # Errors
/// The cell says something else.
pub fn parse_made(cell: &str) -> Result<Option<bool>, String> {
    let lower = cell.trim().to_lowercase();
    match lower.as_str() {
        "" | "na" | "n/a" | "nan" | "null" | "none" | "-" => Ok(None),
        word if MADE.contains(&word) => Ok(Some(true)),
        word if MISSED.contains(&word) => Ok(Some(false)),
        other => Err(format!(
            "made: \"{}\" is neither made (1, true, yes, made) nor missed (0, false, no, missed)",
            other.chars().take(20).collect::<String>()
        )),
    }
}
