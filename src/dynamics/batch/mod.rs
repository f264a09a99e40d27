//! Many shots at once in SIMD lanes, with the same bits as one at a time.

mod instruction_set;
mod lane_block;
mod scheduler;
mod workspace;

pub use instruction_set::InstructionSet;
pub(crate) use scheduler::run;
pub use workspace::BatchWorkspace;
