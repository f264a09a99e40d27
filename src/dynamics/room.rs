//! Room for the shots of a batch: who is on the way, and who waits for what.

use super::exact::{self, On, Progress, Rules};
use super::outcome::{Contacts, Ending, Verdict};
use super::state::{Law, State};

/// Shots that are on the way at once: enough that all lanes stay filled, and few enough to stay in the
/// cache (some 150 bytes each).
const SLOTS: usize = 2048;

/// Room for a batch, to be used again and again: nothing is allocated once it has grown.
#[derive(Debug, Default)]
pub struct Room {
    /// The shots on the way.
    pub(super) slots: Vec<Progress>,
    /// Which of the batch's shots a slot holds.
    shots: Vec<u32>,
    free: Vec<u32>,
    /// Shots of the batch that have been let in so far.
    admitted: usize,
    pub(super) verdicts: Vec<Verdict>,
    pub(super) flying: Vec<u32>,
    pub(super) on_board: Vec<u32>,
    pub(super) on_ring: Vec<u32>,
    pub(super) on_both: Vec<u32>,
    spare: Vec<u32>,
}

/// What the shots of a queue wait for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Phase {
    Flight,
    Board,
    Ring,
    Both,
}

impl Room {
    /// Makes ready for a batch of `count` shots.
    pub(super) fn open(&mut self, count: usize) {
        for list in [
            &mut self.shots,
            &mut self.free,
            &mut self.flying,
            &mut self.on_board,
            &mut self.on_ring,
            &mut self.on_both,
        ] {
            list.clear();
        }
        self.slots.clear();
        self.admitted = 0;
        self.verdicts.clear();
        self.verdicts.resize(count, PENDING);
    }

    /// Lets shots in while there is room for them.
    pub(super) fn admit(&mut self, law: &Law, rules: &Rules, starts: &[State]) {
        while let Some(start) = starts.get(self.admitted) {
            if exact::pressed_at_start(law, start) != (false, false) {
                self.verdicts[self.admitted] = exact::run(law, rules, *start, &mut ());
                self.admitted += 1;
                continue;
            }
            let progress = Progress::at_release(law, *start);
            let slot = if let Some(slot) = self.free.pop() {
                self.slots[slot as usize] = progress;
                self.shots[slot as usize] = self.admitted as u32;
                slot
            } else if self.slots.len() < SLOTS {
                self.slots.push(progress);
                self.shots.push(self.admitted as u32);
                self.slots.len() as u32 - 1
            } else {
                return;
            };
            self.flying.push(slot);
            self.admitted += 1;
        }
    }

    /// Nobody is on the way.
    pub(super) fn is_empty(&self) -> bool {
        self.queues().iter().all(|(_, queue)| queue.is_empty())
    }

    fn queues(&self) -> [(Phase, &Vec<u32>); 4] {
        [
            (Phase::Flight, &self.flying),
            (Phase::Board, &self.on_board),
            (Phase::Ring, &self.on_ring),
            (Phase::Both, &self.on_both),
        ]
    }

    /// The shots that wait for a phase.
    pub(super) fn queue_mut(&mut self, phase: Phase) -> &mut Vec<u32> {
        self.slots_and_queue(phase).1
    }

    /// The shots on the way, and those of them that wait for a phase.
    pub(super) fn slots_and_queue(&mut self, phase: Phase) -> (&[Progress], &mut Vec<u32>) {
        let queue = match phase {
            Phase::Flight => &mut self.flying,
            Phase::Board => &mut self.on_board,
            Phase::Ring => &mut self.on_ring,
            Phase::Both => &mut self.on_both,
        };
        (&self.slots, queue)
    }

    /// Is there enough to do elsewhere to leave a phase of which not all lanes can be filled?
    pub(super) fn others_fill(&self, lanes: usize, phase: Phase) -> bool {
        let fills = |(other, queue): &(Phase, &Vec<u32>)| *other != phase && queue.len() >= lanes;
        self.queues().iter().any(fills)
    }

    /// Queues a shot for what it is on.
    pub(super) fn enqueue(&mut self, slot: u32) {
        let phase = match self.slots[slot as usize].on {
            On::Nothing => Phase::Flight,
            On::Board(_) => Phase::Board,
            On::Ring(_) => Phase::Ring,
            On::Both { .. } => Phase::Both,
        };
        self.queue_mut(phase).push(slot);
    }

    /// Those who wait to fly, with an empty queue in their place; to be given back.
    pub(super) fn take_flying(&mut self) -> Vec<u32> {
        let spare = std::mem::take(&mut self.spare);
        std::mem::replace(&mut self.flying, spare)
    }

    pub(super) fn give_back(&mut self, mut queue: Vec<u32>) {
        queue.clear();
        self.spare = queue;
    }

    /// A shot is over.
    pub(super) fn finish(&mut self, slot: u32, ending: Ending, made: bool) {
        let progress = &self.slots[slot as usize];
        let verdict = Verdict {
            made,
            ending,
            contacts: progress.contacts,
            time_s: progress.time_s,
        };
        self.settle(slot, verdict);
    }

    /// A shot is over, with a verdict.
    pub(super) fn settle(&mut self, slot: u32, verdict: Verdict) {
        self.verdicts[self.shots[slot as usize] as usize] = verdict;
        self.free.push(slot);
    }
}

/// A verdict to be overwritten.
const PENDING: Verdict = Verdict {
    made: false,
    ending: Ending::Unresolved,
    contacts: Contacts::NONE,
    time_s: 0.0,
};
