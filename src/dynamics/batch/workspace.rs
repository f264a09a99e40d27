//! The memory of a batch: the shots in progress, and the queues in which they wait.

use crate::dynamics::integrators::shot_progress::{ContactState, ShotProgress};
use crate::dynamics::outcome::{ContactSequence, Ending, Verdict};
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::FramedPart;
use std::ops::Range;

/// Shots in progress at once: enough to keep all lanes filled, and few enough to stay in the cache
/// (some 350 bytes each).
const SLOTS: usize = 1024;

/// Memory for batches. Reuse it: nothing is allocated once it has grown.
#[derive(Debug, Default)]
pub struct BatchWorkspace {
    /// The shots in progress.
    pub(super) slots: Vec<ShotProgress>,
    /// For each slot, the number of its shot in the batch.
    shots: Vec<u32>,
    free_slots: Vec<u32>,
    /// Shots of the batch that have been started.
    started: usize,
    pub(crate) verdicts: Vec<Verdict>,
    /// The slots that wait for each phase, by [`Phase::index`].
    queues: [Vec<u32>; Phase::COUNT],
    spare: Vec<u32>,
}

/// What a shot waits for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Phase {
    Flight,
    InFrame(FramedPart),
    InWorld,
}

impl Phase {
    pub(super) const COUNT: usize = FramedPart::COUNT + 2;
    /// Every phase, in the order in which they are processed.
    pub(super) const ALL: [Self; Self::COUNT] = [
        Self::Flight,
        Self::InFrame(FramedPart::BoardFace),
        Self::InFrame(FramedPart::BoardEdges),
        Self::InFrame(FramedPart::RingCircle),
        Self::InWorld,
    ];

    const fn index(self) -> usize {
        match self {
            Self::Flight => 0,
            Self::InFrame(part) => 1 + part as usize,
            Self::InWorld => 1 + FramedPart::COUNT,
        }
    }

    fn of(contact: &ContactState) -> Self {
        match contact {
            ContactState::Free => Self::Flight,
            ContactState::InFrame(part) => Self::InFrame(*part),
            ContactState::InWorld => Self::InWorld,
        }
    }
}

impl BatchWorkspace {
    /// Prepares for a batch of `count` shots.
    pub(super) fn reset(&mut self, count: usize) {
        self.shots.clear();
        self.free_slots.clear();
        for queue in &mut self.queues {
            queue.clear();
        }
        self.slots.clear();
        self.started = 0;
        self.verdicts.clear();
        self.verdicts.resize(count, PENDING);
    }

    /// The numbers of the next shots to start, at most `lanes`; none while there are fewer free
    /// slots than `lanes`.
    pub(super) fn next_starts(&mut self, lanes: usize) -> Range<usize> {
        let free = self.free_slots.len() + (SLOTS - self.slots.len());
        let first = self.started;
        if lanes <= free {
            self.started = (first + lanes).min(self.verdicts.len());
        }
        first..self.started
    }

    /// A slot for a shot that starts at `start`.
    pub(super) fn occupy(&mut self, params: &ModelParams, shot: usize, start: &BallState) -> u32 {
        if let Some(slot) = self.free_slots.pop() {
            self.slots[slot as usize].restart(params, start);
            self.shots[slot as usize] = shot as u32;
            slot
        } else {
            self.slots.push(ShotProgress::at_release(params, *start));
            self.shots.push(shot as u32);
            self.slots.len() as u32 - 1
        }
    }

    /// Whether every shot of the batch has started.
    pub(super) fn all_have_started(&self) -> bool {
        self.started == self.verdicts.len()
    }

    /// The number of shots that wait for a phase.
    pub(super) fn waiting(&self) -> usize {
        self.queues.iter().map(Vec::len).sum()
    }

    /// The slots that wait for a phase.
    pub(super) fn queue_mut(&mut self, phase: Phase) -> &mut Vec<u32> {
        &mut self.queues[phase.index()]
    }

    /// The shots in progress, and the slots that wait for a phase.
    pub(super) fn slots_and_queue(&mut self, phase: Phase) -> (&mut [ShotProgress], &mut Vec<u32>) {
        (&mut self.slots, &mut self.queues[phase.index()])
    }

    /// Whether another phase has at least `lanes` shots waiting.
    pub(super) fn other_phase_fills(&self, lanes: usize, phase: Phase) -> bool {
        Phase::ALL
            .iter()
            .any(|&other| other != phase && self.queues[other.index()].len() >= lanes)
    }

    /// Whether a block of `lanes` with `occupied` shots should let others go first: it cannot be
    /// filled, and at least as many shots as it holds wait for other phases, after which some of
    /// them may join it.
    pub(super) fn others_go_first(&self, phase: Phase, occupied: usize, lanes: usize) -> bool {
        let own = self.queues[phase.index()].len();
        occupied > 0 && occupied + own < lanes && self.waiting() - own >= occupied
    }

    /// Queues a shot for its next phase.
    pub(super) fn enqueue(&mut self, slot: u32) {
        let phase = Phase::of(&self.slots[slot as usize].contact);
        self.queue_mut(phase).push(slot);
    }

    /// Takes the queue of the flights and leaves an empty one. Return it with
    /// [`BatchWorkspace::return_queue`].
    pub(super) fn take_flights(&mut self) -> Vec<u32> {
        let spare = std::mem::take(&mut self.spare);
        std::mem::replace(self.queue_mut(Phase::Flight), spare)
    }

    pub(super) fn return_queue(&mut self, mut queue: Vec<u32>) {
        queue.clear();
        self.spare = queue;
    }

    /// Records the end of a shot.
    pub(super) fn finish(&mut self, slot: u32, ending: Ending, made: bool) {
        let verdict = self.slots[slot as usize].verdict(ending, made);
        self.record(slot, verdict);
    }

    /// Records the verdict of a shot and frees its slot.
    pub(super) fn record(&mut self, slot: u32, verdict: Verdict) {
        self.verdicts[self.shots[slot as usize] as usize] = verdict;
        self.free_slots.push(slot);
    }
}

/// A verdict that will be overwritten.
const PENDING: Verdict = Verdict {
    made: false,
    ending: Ending::Unresolved,
    contacts: ContactSequence::EMPTY,
    time_s: 0.0,
};
