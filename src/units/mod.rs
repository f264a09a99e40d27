//! Units of measurement. Inside the crate everything is SI; other units exist only where input is read
//! and results are printed.

mod constants;
mod quantity;
mod unit_system;

pub use constants::{DEGREE_RAD, FOOT_M, INCH_M, POUND_FORCE_N, POUND_KG, REV_RAD, SLUG_KG};
pub use quantity::{Dimension, QuantityError, parse};
pub use unit_system::UnitSystem;
