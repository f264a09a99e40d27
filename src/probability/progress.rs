//! Progress of long computations.

/// Receives the progress of a long computation. Stages can overlap: threads begin and end them side
/// by side.
pub trait Progress: Sync {
    /// A stage of `total` units of work (shots, rounds of a search, bytes) begins.
    fn begin(&self, stage: &str, total: u64);
    /// `units` more are done.
    fn advance(&self, units: u64);
    /// The stage ends.
    fn end(&self);
}

/// Ignores all progress.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _stage: &str, _total: u64) {}
    fn advance(&self, _units: u64) {}
    fn end(&self) {}
}

/// Passes on only that work goes on, without an amount: for parts of a stage whose own progress is
/// counted elsewhere. A receiver that ends the work can do so here too.
#[derive(Clone, Copy)]
pub struct Pulse<'a>(pub &'a dyn Progress);

impl Progress for Pulse<'_> {
    fn begin(&self, _stage: &str, _total: u64) {
        self.0.advance(0);
    }
    fn advance(&self, _units: u64) {
        self.0.advance(0);
    }
    fn end(&self) {}
}
