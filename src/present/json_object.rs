//! Named values in order, as JSON objects.

use crate::units::rounded;
use serde_json::Value;

/// Named values in the order in which they are written.
pub type Record = Vec<(String, Value)>;

/// A number as JSON, with 12 significant digits; null if it is not finite.
#[must_use]
pub fn number(value: f64) -> Value {
    serde_json::Number::from_f64(rounded(value)).map_or(Value::Null, Value::Number)
}

/// A record as a JSON object.
#[must_use]
pub fn object(record: Record) -> Value {
    Value::Object(record.into_iter().collect())
}

/// The program, its version and commit, and the hash of the configuration: every result carries
/// them.
#[must_use]
pub fn provenance(hash: &str) -> Record {
    vec![
        ("program".to_owned(), "bankshot".into()),
        ("version".to_owned(), env!("CARGO_PKG_VERSION").into()),
        ("commit".to_owned(), env!("BANKSHOT_COMMIT").into()),
        ("configuration_blake3".to_owned(), hash.into()),
    ]
}
