//! Units in SI, all exact by definition.

use std::f64::consts::PI;

/// One foot, m.
pub const FOOT_M: f64 = 0.3048;
/// One inch, m.
pub const INCH_M: f64 = 0.0254;
/// One avoirdupois pound, kg.
pub const POUND_KG: f64 = 0.453_592_37;
/// One pound-force, N.
pub const POUND_FORCE_N: f64 = POUND_KG * 9.806_65;
/// One slug (lbf s^2/ft), kg.
pub const SLUG_KG: f64 = POUND_FORCE_N / FOOT_M;
/// One degree, rad.
pub const DEGREE_RAD: f64 = PI / 180.0;
/// One revolution per second, rad/s.
pub const REV_RAD: f64 = 2.0 * PI;
