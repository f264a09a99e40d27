//! How friction acts at a contact, and when it changes.

use crate::math::real::{Mask, Real};
use crate::math::real_record::{RealRecord, RecordReader, RecordWriter};
use crate::model::constants_per_ball_mass::ModelParams;

/// A slip speed up to this counts as zero, m/s.
pub(crate) const SLIP_TOLERANCE_M_S: f64 = 1e-9;
/// In a step that ends the slip, a stage with less than this fraction of the initial slip keeps the
/// initial direction: at zero slip the sliding law has none.
pub(crate) const DIRECTION_SLIP_FRACTION: f64 = 0.1;

/// How friction acts at a contact. It is carried from step to step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionState<T: Real = f64> {
    /// The ball rolls: the slip is zero and stays zero.
    pub(crate) rolling: T::Mask,
    /// Rolling needed more than mu N. The ball slides until N grows again; otherwise it would
    /// switch between the two in tiny steps.
    pub(crate) rolling_failed: T::Mask,
    /// A slip speed up to this counts as zero: what a step meant to end at zero slip may leave,
    /// m/s.
    pub(crate) slip_tolerance: T,
}

impl<T: Real> FrictionState<T> {
    /// A contact that has just begun.
    #[inline(always)]
    pub(crate) fn new(params: &ModelParams<T>) -> Self {
        let no_lanes = params.splat_mask(false);
        Self {
            rolling: no_lanes,
            rolling_failed: no_lanes,
            slip_tolerance: params.splat(SLIP_TOLERANCE_M_S),
        }
    }
}

impl<T: Real> FrictionState<T> {
    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, condition: T::Mask, other: Self) -> Self {
        Self {
            rolling: Mask::select(self.rolling, condition, other.rolling),
            rolling_failed: Mask::select(self.rolling_failed, condition, other.rolling_failed),
            slip_tolerance: self.slip_tolerance.select(condition, other.slip_tolerance),
        }
    }
}

impl<T: Real> RealRecord<T> for FrictionState<T> {
    #[inline(always)]
    fn read(from: &mut impl RecordReader<T>) -> Self {
        Self {
            rolling: from.truth(),
            rolling_failed: from.truth(),
            slip_tolerance: from.number(),
        }
    }

    #[inline(always)]
    fn write(&self, to: &mut impl RecordWriter<T>) {
        to.truth(self.rolling);
        to.truth(self.rolling_failed);
        to.number(self.slip_tolerance);
    }
}

impl<T: Real<Mask = bool>> FrictionState<T> {
    /// The friction in another number type.
    #[inline(always)]
    pub(crate) fn map<U: Real<Mask = bool>>(&self, convert: impl Fn(T) -> U) -> FrictionState<U> {
        FrictionState {
            rolling: self.rolling,
            rolling_failed: self.rolling_failed,
            slip_tolerance: convert(self.slip_tolerance),
        }
    }
}
