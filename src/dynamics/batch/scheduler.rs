//! Runs the shots of a batch, 4 to 32 to a step.
//!
//! The shots wait in queues by phase: flight, contact in the frame of one solid, contact in the
//! world frame. Flights are closed form and are done a block at a time. In contact the shots of a
//! block step together. Finished lanes are refilled at once, so short and long contacts mix without
//! waiting. Rare events (from one contact to two, the board's edges, the time limit in flight, an
//! unresolved search) are left to the scalar code; after them the shot waits in a queue again.
//!
//! A block that is not full lets the shots of other phases go first, so that they go on together.
//! When all shots have started, the last few are left to the scalar code.
//!
//! It is the same generic code as for one shot, with the same operations in the same order. So the
//! verdicts are the same, bit for bit.

use super::batch_state::{
    Batch, EightLanes, NARROW, SixteenLanes, SixteenLanesF32, ThirtyTwoLanesF32, WIDE,
};
use super::board_contact_phase::board_contact;
use super::edge_contact_phase::edge_contact;
use super::parabola_flight_phase::{fly, fly_from_release};
use super::ring_contact_phase::ring_contact;
use super::segment_flight_phase::fly_in_segments;
use super::workspace::{BatchWorkspace, Phase};
use super::world_frame_phase::in_world;
use crate::dynamics::end_rules::ShotLimits;
use crate::math::real::SimdReal;
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::FramedPart;
use fearless_simd::{Level, Simd};

/// The last shots of a batch, which the scalar code finishes.
const LAST_SHOTS: usize = 8;
/// A vector step takes about as long as scalar steps of a fifth of its lanes.
const LANES_PER_SCALAR_STEP: usize = 5;

/// Runs the shots that start at `starts` to their ends. The verdicts are then in the workspace.
/// `level` is one of those that
/// [`InstructionSet::level`](super::instruction_set::InstructionSet::level) gives.
pub(crate) fn run(
    level: Level,
    params: &ModelParams,
    limits: &ShotLimits,
    starts: &[BallState],
    workspace: &mut BatchWorkspace,
) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = level.as_avx512() {
        Batch::<_, WIDE>::run(simd, params, limits, starts, workspace);
    } else if let Some(simd) = level.as_avx2() {
        Batch::<_, NARROW>::run(simd, params, limits, starts, workspace);
    }
    #[cfg(not(target_arch = "x86_64"))]
    fearless_simd::dispatch!(level, simd => {
        Batch::<_, NARROW>::run(simd, params, limits, starts, workspace)
    });
}

impl<S: Simd, const WIDTH: u8> Batch<'_, S, WIDTH> {
    fn run(
        simd: S,
        params: &ModelParams,
        limits: &ShotLimits,
        starts: &[BallState],
        workspace: &mut BatchWorkspace,
    ) {
        workspace.reset(starts.len());
        let mut batch = Batch::<S, WIDTH> {
            simd,
            params,
            limits,
            workspace,
        };
        loop {
            match (params.has_paper_flight(), WIDTH) {
                (true, WIDE) => fly_from_release::<S, SixteenLanes<S>, WIDTH>(&mut batch, starts),
                (true, _) => fly_from_release::<S, EightLanes<S>, WIDTH>(&mut batch, starts),
                (false, WIDE) => fly_in_segments::<S, SixteenLanes<S>, WIDTH>(&mut batch, starts),
                (false, _) => fly_in_segments::<S, EightLanes<S>, WIDTH>(&mut batch, starts),
            }
            if batch.workspace.all_have_started() && batch.workspace.waiting() <= LAST_SHOTS {
                batch.finish_one_by_one();
                return;
            }
            for phase in Phase::ALL {
                batch.run_phase(phase);
            }
        }
    }

    /// Runs all shots in progress to their ends with the scalar code.
    fn finish_one_by_one(&mut self) {
        while self.workspace.waiting() > 0 {
            for phase in Phase::ALL {
                self.run_one_by_one(phase);
            }
        }
    }

    /// Simulates the shots that wait for a phase with the scalar code.
    fn run_one_by_one(&mut self, phase: Phase) {
        for _ in 0..self.workspace.queue_mut(phase).len() {
            if let Some(slot) = self.workspace.queue_mut(phase).pop() {
                self.run_scalar(slot);
            }
        }
    }

    /// Simulates the shots that wait for a phase.
    fn run_phase(&mut self, phase: Phase) {
        match phase {
            // Done above, with the shots that start.
            Phase::Flight if !self.params.has_paper_flight() => {}
            Phase::Flight if WIDTH == WIDE => {
                self.run_unless_few::<SixteenLanes<S>>(phase, fly::<S, SixteenLanes<S>, WIDTH>);
            }
            Phase::Flight => {
                self.run_unless_few::<EightLanes<S>>(phase, fly::<S, EightLanes<S>, WIDTH>);
            }
            Phase::InFrame(part) if !self.limits.single_precision => {
                self.run_unless_few::<EightLanes<S>>(phase, |batch| {
                    in_frame::<S, EightLanes<S>, WIDTH>(batch, part);
                });
            }
            Phase::InFrame(part) if WIDTH == WIDE => {
                self.run_unless_few::<ThirtyTwoLanesF32<S>>(phase, |batch| {
                    in_frame::<S, ThirtyTwoLanesF32<S>, WIDTH>(batch, part);
                });
            }
            Phase::InFrame(part) => {
                self.run_unless_few::<SixteenLanesF32<S>>(phase, |batch| {
                    in_frame::<S, SixteenLanesF32<S>, WIDTH>(batch, part);
                });
            }
            Phase::InWorld => {
                self.run_unless_few::<EightLanes<S>>(phase, in_world::<S, EightLanes<S>, WIDTH>);
            }
        }
    }

    /// Runs a phase in lanes; with the scalar code where no other shots can fill them any more.
    fn run_unless_few<T: SimdReal>(&mut self, phase: Phase, run: impl FnOnce(&mut Self)) {
        let few = T::LANES / LANES_PER_SCALAR_STEP;
        if self.workspace.all_have_started() && self.workspace.queue_mut(phase).len() <= few {
            self.run_one_by_one(phase);
        } else {
            run(self);
        }
    }
}

fn in_frame<S, T, const WIDTH: u8>(batch: &mut Batch<'_, S, WIDTH>, part: FramedPart)
where
    S: Simd,
    T: SimdReal<Simd = S>,
{
    match part {
        FramedPart::BoardFace => board_contact::<S, T, WIDTH>(batch),
        FramedPart::BoardEdges => edge_contact::<S, T, WIDTH>(batch),
        FramedPart::RingCircle => ring_contact::<S, T, WIDTH>(batch),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Release, Simulator};
    use crate::model::Physics;
    use crate::units::{DEGREE_RAD, FOOT_M};

    fn check<S: Simd>(simd: S) {
        let simulator = Simulator::new(&Physics::paper()).unwrap();
        let (params, limits) = (&simulator.params, &simulator.limits);
        let starts: Vec<_> = (0..3000u32)
            .map(|i| {
                let fraction = |n: u32| f64::from((i * n) % 3000) / 3000.0;
                Release {
                    distance_m: 13.75 * FOOT_M,
                    court_angle_rad: 0.0,
                    height_above_hoop_m: -3.0 * FOOT_M,
                    speed_m_s: (22.0 + 5.0 * fraction(7)) * FOOT_M,
                    pitch_rad: (40.0 + 25.0 * fraction(13)) * DEGREE_RAD,
                    polar_rad: (6.0 * fraction(11) - 3.0) * DEGREE_RAD,
                    backspin_rad_s: 30.0 * fraction(17),
                    rifle_spin_rad_s: 0.0,
                    side_spin_rad_s: 0.0,
                }
                .state()
            })
            .collect();
        let mut workspace = BatchWorkspace::default();
        Batch::<S, WIDE>::run(simd, params, limits, &starts, &mut workspace);
        let sixteen = workspace.verdicts.clone();
        let alone: Vec<_> = starts
            .iter()
            .map(|start| simulator.verdict(*start))
            .collect();
        assert!(alone.iter().any(|v| v.made) && alone.iter().any(|v| !v.made));
        assert_eq!(sixteen, alone);
        Batch::<S, NARROW>::run(simd, params, limits, &starts, &mut workspace);
        assert_eq!(workspace.verdicts, alone);
    }

    /// Sixteen lanes also run (slowly) with AVX2.
    #[test]
    #[cfg(target_arch = "x86_64")]
    fn contract_sixteen_lanes_give_the_verdicts_of_single_shots() {
        match Level::new().as_avx2() {
            Some(simd) => check(simd),
            None => println!("skipped: this machine has no AVX2"),
        }
    }
}
