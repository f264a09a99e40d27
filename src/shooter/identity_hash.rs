//! The identity of a configuration: a hash of everything that a result depends on.

use serde::Serialize;

/// A configuration that cannot be serialised, so it has no identity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the configuration cannot be serialised: {0}")]
pub struct IdentityError(String);

/// BLAKE3 of a value as JSON, in hexadecimal. Two values with the same meaning have the same hash.
///
/// # Errors
/// The value cannot be serialised.
///
/// ```
/// use bankshot::shooter::identity_hash;
/// assert_eq!(identity_hash(&1)?, identity_hash(&1)?);
/// assert_ne!(identity_hash(&1)?, identity_hash(&2)?);
/// # Ok::<(), bankshot::shooter::IdentityError>(())
/// ```
pub fn identity_hash(value: &impl Serialize) -> Result<String, IdentityError> {
    let json = serde_json::to_string(value).map_err(|error| IdentityError(error.to_string()))?;
    Ok(blake3::hash(json.as_bytes()).to_hex().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_value_that_cannot_be_serialised_has_no_hash() {
        // JSON has no keys that are lists. Such a value used to get the hash of an empty text.
        let map = std::collections::BTreeMap::from([(vec![1], 2)]);
        let error = identity_hash(&map).unwrap_err();
        assert!(error.to_string().contains("cannot be serialised"));
    }
}
