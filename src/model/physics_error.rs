//! Why a physical constant cannot be simulated.

/// A physical constant that cannot be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("physics.{key} is {value} in SI units; it must be {allowed}")]
pub struct PhysicsError {
    /// The key of the constant in the `[physics]` table.
    pub key: &'static str,
    /// Its value, SI units.
    pub value: f64,
    /// The allowed values.
    pub allowed: &'static str,
}

impl PhysicsError {
    pub(super) fn new(key: &'static str, value: f64, allowed: &'static str) -> Self {
        Self {
            key,
            value,
            allowed,
        }
    }
}
