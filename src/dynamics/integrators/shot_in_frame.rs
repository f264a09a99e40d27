//! A shot in contact with one solid, step by step: one shot, or one in each lane.

use super::shot_progress::ShotProgress;
use crate::dynamics::contact::contact_frame_step::Contact;
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::contact::other_solid_touch::{GapAtEnd, has_arrived, passed};
use crate::dynamics::end_rules::ShotEndFlags;
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::math::real::{Mask, Real, ScalarReal};
use crate::math::real_record::{RealRecord, RecordReader, RecordWriter};
use crate::model::SolidId;
use crate::model::solids::{CONTACT_NUMBERS, ContactFrameState, FramedPart, Solid};

/// What is carried from step to step.
#[derive(Clone, Copy)]
pub(crate) struct ShotInFrame<T: Real> {
    motion: ContactFrameState<T>,
    friction: FrictionState<T>,
    crossing: HoopCrossing<T>,
    /// Length of the next step, in units of the longest.
    step_fraction: T,
    /// Time in this contact, and the time that was left at its start, s.
    contact_time_s: T,
    allowed_s: T,
}

/// Numbers and truth values of a [`ShotInFrame`].
pub(crate) const FRAME_NUMBERS: usize = CONTACT_NUMBERS + 4;
pub(crate) const FRAME_TRUTHS: usize = 4;

/// What a step led to.
pub(crate) struct FrameStep<T: Real> {
    /// The step counts; else it is repeated, shorter. What follows holds only for one that counts.
    pub(crate) accepted: T::Mask,
    /// The ball flies: it parts from the solid, or the solid does not act there and the other one
    /// is not touched.
    pub(crate) flies: T::Mask,
    /// It touches the other solid.
    pub(crate) arrived: T::Mask,
    /// It is beyond the part of the solid that the frame describes.
    pub(crate) leaves_frame: T::Mask,
    pub(crate) ends: ShotEndFlags<T>,
    /// It has fallen through the hoop, if it has fallen.
    pub(crate) made: T::Mask,
}

impl<T: Real> RealRecord<T> for ShotInFrame<T> {
    #[inline(always)]
    fn read(from: &mut impl RecordReader<T>) -> Self {
        Self {
            motion: RealRecord::read(from),
            friction: RealRecord::read(from),
            crossing: RealRecord::read(from),
            step_fraction: from.number(),
            contact_time_s: from.number(),
            allowed_s: from.number(),
        }
    }

    #[inline(always)]
    fn write(&self, to: &mut impl RecordWriter<T>) {
        self.motion.write(to);
        self.friction.write(to);
        self.crossing.write(to);
        to.number(self.step_fraction);
        to.number(self.contact_time_s);
        to.number(self.allowed_s);
    }
}

impl<T: Real> ShotInFrame<T> {
    /// The shot after one step, except where it is `given_up`.
    #[inline(always)]
    pub(crate) fn step<A: Solid<T>, B: Solid<T>>(
        &self,
        contact: &Contact<'_, T, A>,
        other: &B,
        given_up: T::Mask,
    ) -> (Self, FrameStep<T>) {
        let (params, solid) = (contact.params, contact.solid);
        let step = contact.step(&self.motion, &self.friction, self.step_fraction);
        let after = solid.to_world(&params.ball, &step.motion);
        let path = (self.motion.speed_bound() + step.motion.speed_bound()) * step.dt;
        let end = GapAtEnd::new(params, other, &after, path);
        let (mut repeats, mut fraction) = (end.is_near, params.one());
        if end.is_near.any() {
            let before = solid.to_world(&params.ball, &self.motion);
            (repeats, fraction) = passed(params, other, &before, &end, step.dt);
        }
        let rejected = repeats | given_up;
        let mut next = Self {
            motion: step.motion,
            friction: step.friction,
            step_fraction: params.one(),
            contact_time_s: self.contact_time_s + step.dt,
            ..*self
        };
        let was_below = solid.is_below_hoop(&self.motion);
        next.crossing
            .after_step(params, was_below, &after, !rejected);
        if rejected.any() {
            let repeated_fraction = contact.fraction_of_longest(fraction * step.dt);
            next.motion = self.motion.select(rejected, next.motion);
            next.friction = FrictionState::select(self.friction, rejected, next.friction);
            next.step_fraction = repeated_fraction.select(repeats, next.step_fraction);
            next.contact_time_s = self.contact_time_s.select(rejected, next.contact_time_s);
        }
        let too_late = self.allowed_s.lt(next.contact_time_s);
        let arrived = has_arrived(params, other, &after);
        let step = FrameStep {
            accepted: !rejected,
            flies: step.separates | (!solid.acts(&after) & !arrived),
            arrived,
            leaves_frame: !solid.is_in_frame(&after),
            ends: ShotEndFlags::new(params, &after, too_late),
            made: next.crossing.is_made(params, &after),
        };
        (next, step)
    }
}

impl ShotInFrame<f64> {
    /// That of a shot in contact with `solid`.
    #[inline(always)]
    pub(crate) fn of(shot: &ShotProgress, solid: SolidId, time_limit_s: f64) -> Self {
        Self {
            motion: shot.motion,
            friction: shot.friction[solid.index()],
            crossing: shot.crossing,
            step_fraction: shot.step_fraction,
            contact_time_s: shot.contact_time_s,
            allowed_s: time_limit_s - shot.time_s,
        }
    }

    /// Writes it back to the shot, which is on `part`.
    #[inline(always)]
    pub(crate) fn write_to(&self, shot: &mut ShotProgress, part: FramedPart) {
        shot.motion = self.motion;
        shot.frame = Some(part);
        shot.friction[part.solid().index()] = self.friction;
        shot.crossing = self.crossing;
        shot.step_fraction = self.step_fraction;
        shot.contact_time_s = self.contact_time_s;
    }
}

impl<T: ScalarReal> ShotInFrame<T> {
    /// The shot in another number type.
    pub(crate) fn converted<U: ScalarReal>(&self) -> ShotInFrame<U> {
        let convert = |number: T| U::from_f64(number.to_f64());
        ShotInFrame {
            motion: self.motion.map(convert),
            friction: self.friction.map(convert),
            crossing: HoopCrossing {
                has_been_above: self.crossing.has_been_above,
                rose_through: self.crossing.rose_through,
            },
            step_fraction: convert(self.step_fraction),
            contact_time_s: convert(self.contact_time_s),
            allowed_s: convert(self.allowed_s),
        }
    }
}
