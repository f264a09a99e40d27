//! A shot in contact in the world frame, step by step: one shot, or one in each lane.

use super::shot_progress::ShotProgress;
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::contact::other_solid_touch::approach_in_world;
use crate::dynamics::contact::world_frame_step::{self, WorldContact, rolling_time};
use crate::dynamics::end_rules::{ShotEndFlags, ShotLimits, is_lodged};
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::math::real::Real;
use crate::math::real_record::{RealRecord, RecordReader, RecordWriter};
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{BoardEdges, Solid};
use crate::model::{BallState, SolidId};

/// What is carried from step to step. Two values are those at board and ring.
#[derive(Clone, Copy)]
pub(crate) struct ShotInWorld<T: Real> {
    pub(crate) state: BallState<T>,
    pub(crate) time_s: T,
    crossing: HoopCrossing<T>,
    touching: [T::Mask; SolidId::COUNT],
    friction: [FrictionState<T>; SolidId::COUNT],
    /// Time for which the ball has rolled on both solids without a break, s.
    rolling_time_s: T,
    /// Length of the next step, in units of the longest.
    step_fraction: T,
}

/// Numbers and truth values of a [`ShotInWorld`].
pub(crate) const WORLD_NUMBERS: usize = 14;
pub(crate) const WORLD_TRUTHS: usize = 8;

/// What a step led to.
pub(crate) struct WorldStep<T: Real> {
    /// The step counts; else it is repeated, shorter. What follows holds only for one that counts.
    pub(crate) accepted: T::Mask,
    /// Length of the step, s.
    pub(crate) dt: T,
    /// Impulses of both contacts per unit of mass, m/s.
    pub(crate) impulses: [Vec3<T>; SolidId::COUNT],
    /// The ball no longer touches each solid.
    pub(crate) separates: [T::Mask; SolidId::COUNT],
    /// It has come to each solid.
    pub(crate) arrived: [T::Mask; SolidId::COUNT],
    /// It is on one solid, in a part that a frame describes.
    pub(crate) enters_frame: T::Mask,
    pub(crate) ends: ShotEndFlags<T>,
    /// It has fallen through the hoop, if it has fallen.
    pub(crate) made: T::Mask,
    pub(crate) lodged: T::Mask,
}

impl<T: Real> RealRecord<T> for ShotInWorld<T> {
    #[inline(always)]
    fn read(from: &mut impl RecordReader<T>) -> Self {
        Self {
            state: RealRecord::read(from),
            time_s: from.number(),
            crossing: RealRecord::read(from),
            touching: [from.truth(), from.truth()],
            friction: [RealRecord::read(from), RealRecord::read(from)],
            rolling_time_s: from.number(),
            step_fraction: from.number(),
        }
    }

    #[inline(always)]
    fn write(&self, to: &mut impl RecordWriter<T>) {
        self.state.write(to);
        to.number(self.time_s);
        self.crossing.write(to);
        let ([on_board, on_ring], [at_board, at_ring]) = (self.touching, &self.friction);
        to.truth(on_board);
        to.truth(on_ring);
        at_board.write(to);
        at_ring.write(to);
        to.number(self.rolling_time_s);
        to.number(self.step_fraction);
    }
}

impl<T: Real> ShotInWorld<T> {
    /// Steps once, except where it is `given_up`.
    #[inline(always)]
    pub(crate) fn step(
        &mut self,
        params: &ModelParams<T>,
        limits: &ShotLimits,
        given_up: T::Mask,
    ) -> WorldStep<T> {
        let (board, ring) = (&params.board, &params.ring);
        let before = *self;
        let [on_board, on_ring] = self.touching;
        let [with_one_s, with_both_s] = limits.longest_world_steps_s;
        let with_both_s = params.splat(with_both_s);
        let contact = WorldContact {
            touching: self.touching,
            step_s: with_both_s.select(on_board & on_ring, params.splat(with_one_s)),
            fraction: self.step_fraction,
        };
        let solids = (board, ring);
        let (state, friction) = (&mut self.state, &mut self.friction);
        let step = world_frame_step::step(params, solids, state, friction, &contact);
        let states = (&before.state, &self.state);
        let approach = approach_in_world(params, solids, self.touching, states, step.dt);
        let rejected = approach.repeats | given_up;
        let accepted = !rejected;
        let fraction = approach.fraction * (step.dt / contact.step_s);
        self.step_fraction = fraction.select(approach.repeats, params.one());
        self.state = before.state.select(rejected, self.state);
        for i in [0, 1] {
            self.friction[i] =
                FrictionState::select(before.friction[i], rejected, self.friction[i]);
        }
        let rolling_time_s = rolling_time(&self.friction, before.rolling_time_s, step.dt);
        self.rolling_time_s = before.rolling_time_s.select(rejected, rolling_time_s);
        self.time_s = before.time_s + step.dt.select(accepted, params.zero());
        let was_below = before.state.position_m.z.is_negative();
        self.crossing
            .after_step(params, was_below, &self.state, accepted);
        let too_late = params.splat(limits.time_limit_s).lt(self.time_s);
        let separates = [
            on_board & (step.separates[0] | !board.acts(&self.state)),
            on_ring & (step.separates[1] | !ring.acts(&self.state)),
        ];
        let on_board = (on_board & !separates[0]) | approach.arrived[0];
        let on_ring = (on_ring & !separates[1]) | approach.arrived[1];
        let in_board_frame =
            board.is_in_frame(&self.state) | BoardEdges(board).is_in_frame(&self.state);
        WorldStep {
            accepted,
            dt: step.dt,
            impulses: step.impulses,
            separates,
            arrived: approach.arrived,
            enters_frame: (on_board & !on_ring & in_board_frame)
                | (on_ring & !on_board & ring.is_in_frame(&self.state)),
            ends: ShotEndFlags::new(params, &self.state, too_late),
            made: self.crossing.is_made(params, &self.state),
            lodged: is_lodged(self.rolling_time_s, limits.lodged_after_s),
        }
    }
}

impl ShotInWorld<f64> {
    /// That of a shot.
    #[inline(always)]
    pub(crate) fn of(shot: &ShotProgress) -> Self {
        Self {
            state: shot.state,
            time_s: shot.time_s,
            crossing: shot.crossing,
            touching: shot.touching,
            friction: shot.friction,
            rolling_time_s: shot.rolling_time_s,
            step_fraction: shot.step_fraction,
        }
    }

    /// Writes it back to the shot.
    #[inline(always)]
    pub(crate) fn write_to(&self, shot: &mut ShotProgress) {
        shot.state = self.state;
        shot.frame = None;
        shot.time_s = self.time_s;
        shot.crossing = self.crossing;
        shot.touching = self.touching;
        shot.friction = self.friction;
        shot.rolling_time_s = self.rolling_time_s;
        shot.step_fraction = self.step_fraction;
    }
}
