//! What a sweep guarantees: the same bytes whatever interrupts it, and clear messages when
//! something is wrong.
//!
//! No test depends on how fast the machine is. A test that interrupts a sweep makes it wait at a
//! spot with `--fault wait:SPOT:FILE`, and acts once the program says that it is there.

mod configuration;
mod damage;
mod interruptions;
mod results;
mod shards;
mod signals;
mod support;
mod system_call_faults;
