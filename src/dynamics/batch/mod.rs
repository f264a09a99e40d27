//! Many shots at once in SIMD lanes, with the same bits as one at a time.

mod batch_state;
mod board_contact_phase;
mod contact_frame_phase;
mod edge_contact_phase;
mod flight_block;
mod instruction_set;
mod lane_block;
mod lift_flight;
mod parabola_flight_phase;
mod ring_contact_phase;
mod scheduler;
mod segment_flight_phase;
mod workspace;
mod world_frame_phase;

pub use instruction_set::InstructionSet;
pub(crate) use scheduler::run;
pub use workspace::BatchWorkspace;
