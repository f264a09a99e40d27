//! Counts of made shots. They are whole numbers, so the order in which blocks finish changes
//! nothing.

use crate::dynamics::{Ending, OutcomeKind, Verdict};

/// Counts of the shots of a block by the way they were made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(super) swish: u64,
    pub(super) ring: u64,
    pub(super) board: u64,
    pub(super) board_and_ring: u64,
    pub(super) unresolved: u64,
}

impl Counts {
    pub(crate) fn of(verdicts: &[Verdict]) -> Self {
        let mut counts = Self::default();
        for verdict in verdicts {
            if verdict.ending == Ending::Unresolved {
                counts.unresolved += 1;
            } else if verdict.made {
                match OutcomeKind::of_made(&verdict.contacts) {
                    OutcomeKind::Swish => counts.swish += 1,
                    OutcomeKind::RimIn => counts.ring += 1,
                    OutcomeKind::BankIn => counts.board += 1,
                    _ => counts.board_and_ring += 1,
                }
            }
        }
        counts
    }

    /// Number of made shots.
    pub(crate) fn made(&self) -> u64 {
        self.swish + self.ring + self.board + self.board_and_ring
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            swish: self.swish + other.swish,
            ring: self.ring + other.ring,
            board: self.board + other.board,
            board_and_ring: self.board_and_ring + other.board_and_ring,
            unresolved: self.unresolved + other.unresolved,
        }
    }
}
