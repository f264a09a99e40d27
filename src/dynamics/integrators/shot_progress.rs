//! A shot in progress: what is kept of it between its phases.

use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::dynamics::outcome::{ContactSequence, Ending, Verdict};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{BoardEdges, ContactFrameState, FramedPart, Solid};
use crate::model::{BallState, SolidId};

/// The contacts of the ball at present.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContactState {
    /// In flight, or about to be.
    Free,
    /// On the face or an edge of the board, or on the ring's circle alone: in the frame of the
    /// contact.
    InFrame(FramedPart),
    /// On the bracket, at a corner of the board, or on both solids: in the world frame.
    InWorld,
}

/// A shot in progress.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShotProgress {
    /// In the world frame. If `frame` names a part, `motion` holds the state and this is out of
    /// date, except right after a step was reported.
    pub(crate) state: BallState,
    /// The ball in the frame of a contact.
    pub(crate) motion: ContactFrameState,
    pub(crate) frame: Option<FramedPart>,
    pub(crate) contact: ContactState,
    /// The solids that a ball in contact in the world frame touches, by [`SolidId::index`].
    pub(crate) touching: [bool; SolidId::COUNT],
    /// Friction at the board and at the ring.
    pub(crate) friction: [FrictionState; SolidId::COUNT],
    /// Length of the next step in contact, in units of the longest.
    pub(crate) step_fraction: f64,
    /// Time in the present contact with one solid; not yet counted in `time_s`.
    pub(crate) contact_time_s: f64,
    /// Time for which the ball has rolled on both solids without a break, s.
    pub(crate) rolling_time_s: f64,
    pub(crate) time_s: f64,
    pub(crate) contacts: ContactSequence,
    pub(crate) crossing: HoopCrossing,
    /// Phases so far. (In a batch, a contact in the lanes is not counted; the limit is far away
    /// in any case.)
    pub(crate) phases: u32,
    /// Steps in contact so far.
    pub(crate) steps: u32,
}

impl ShotProgress {
    /// At the release.
    #[inline(always)]
    pub(crate) fn at_release(params: &ModelParams, start: BallState) -> Self {
        let friction = FrictionState::new(params);
        Self {
            state: start,
            motion: ContactFrameState::ZERO,
            frame: None,
            contact: ContactState::Free,
            touching: [false; SolidId::COUNT],
            friction: [friction; SolidId::COUNT],
            step_fraction: 1.0,
            contact_time_s: 0.0,
            rolling_time_s: 0.0,
            time_s: 0.0,
            contacts: ContactSequence::default(),
            crossing: HoopCrossing::at_release(params, &start),
            phases: 0,
            steps: 0,
        }
    }

    /// Makes it another shot, at its release. (Field by field: a shot that is made on the stack and
    /// then copied waits for its own stores, 1 to 2 % of the time of a batch. The motion in a frame
    /// is set when a contact begins.)
    #[inline(always)]
    pub(crate) fn restart(&mut self, params: &ModelParams, start: &BallState) {
        let fresh = FrictionState::new(params);
        let Self {
            state,
            motion: _,
            frame,
            contact,
            touching,
            friction,
            step_fraction,
            contact_time_s,
            rolling_time_s,
            time_s,
            contacts,
            crossing,
            phases,
            steps,
        } = self;
        *state = *start;
        (*frame, *contact, *touching) = (None, ContactState::Free, [false; SolidId::COUNT]);
        *friction = [fresh; SolidId::COUNT];
        *step_fraction = 1.0;
        (*contact_time_s, *rolling_time_s, *time_s) = (0.0, 0.0, 0.0);
        *contacts = ContactSequence::default();
        *crossing = HoopCrossing::at_release(params, start);
        (*phases, *steps) = (0, 0);
    }

    /// Begins a contact with one solid. `motion` and `friction` are set by the caller.
    #[inline(always)]
    pub(crate) fn begin_single_contact(&mut self, part: FramedPart) {
        self.contact = ContactState::InFrame(part);
        self.frame = Some(part);
        self.step_fraction = 1.0;
        self.contact_time_s = 0.0;
    }

    /// Ends a contact with one solid; the ball is free, or on both solids.
    #[inline(always)]
    pub(crate) fn end_single_contact(&mut self, contact: ContactState) {
        self.contact = contact;
        self.time_s += self.contact_time_s;
        self.contact_time_s = 0.0;
        self.rolling_time_s = 0.0;
    }

    /// The ball leaves the part of `solid` that the frame of the contact describes.
    pub(crate) fn leave_frame(&mut self, params: &ModelParams, solid: SolidId) {
        self.end_single_contact(ContactState::InWorld);
        self.update_state(params);
        self.step_fraction = 1.0;
        self.set_touching(params, SolidId::ALL.map(|id| id == solid));
    }

    /// The ball now also touches `arrived`.
    pub(crate) fn arrive(&mut self, params: &ModelParams, arrived: SolidId) {
        self.end_single_contact(ContactState::InWorld);
        self.update_state(params);
        self.touching = [true; SolidId::COUNT];
        self.step_fraction = 1.0;
        self.contacts.push(arrived);
        self.friction[arrived.index()] = FrictionState::new(params);
    }

    /// In the world frame the ball has left some solids and come to others, by
    /// [`SolidId::index`].
    pub(crate) fn change_contacts(
        &mut self,
        params: &ModelParams,
        left: [bool; SolidId::COUNT],
        arrived: [bool; SolidId::COUNT],
    ) {
        let mut touching = self.touching;
        for solid in SolidId::ALL {
            let i = solid.index();
            touching[i] = (touching[i] && !left[i]) || arrived[i];
            if arrived[i] {
                self.contacts.push(solid);
                self.friction[i] = FrictionState::new(params);
            }
        }
        self.set_touching(params, touching);
    }

    /// Sets the solids that the ball touches: it then flies, or is in contact in the frame of one
    /// solid where there is one.
    pub(crate) fn set_touching(&mut self, params: &ModelParams, touching: [bool; SolidId::COUNT]) {
        self.touching = touching;
        self.contact = ContactState::InWorld;
        let (board, ring) = (&params.board, &params.ring);
        let edges = BoardEdges(board);
        match touching {
            [false, false] => self.contact = ContactState::Free,
            [true, false] if board.is_in_frame(&self.state) => {
                self.motion = board.to_contact(&params.ball, &self.state);
                self.begin_single_contact(FramedPart::BoardFace);
            }
            [true, false] if edges.is_in_frame(&self.state) => {
                self.motion = edges.to_contact(&params.ball, &self.state);
                self.begin_single_contact(FramedPart::BoardEdges);
            }
            [false, true] if ring.is_in_frame(&self.state) => {
                self.motion = ring.to_contact(&params.ball, &self.state);
                self.begin_single_contact(FramedPart::RingCircle);
            }
            _ => {}
        }
    }

    /// Brings `state` up to date.
    #[inline(always)]
    pub(crate) fn update_state(&mut self, params: &ModelParams) {
        match self.frame {
            None => return,
            Some(FramedPart::BoardFace) => {
                self.state = params.board.to_world(&params.ball, &self.motion);
            }
            Some(FramedPart::BoardEdges) => {
                self.state = BoardEdges(&params.board).to_world(&params.ball, &self.motion);
            }
            Some(FramedPart::RingCircle) => {
                self.state = params.ring.to_world(&params.ball, &self.motion);
            }
        }
        self.frame = None;
    }

    /// The verdict of a shot that ends like this; `made` counts only for a ball that fell.
    pub(crate) fn verdict(&self, ending: Ending, made: bool) -> Verdict {
        Verdict {
            made: ending == Ending::Fell && made,
            ending,
            contacts: self.contacts,
            time_s: self.time_s + self.contact_time_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::Vec3;
    use crate::model::Physics;

    /// But for the motion in a frame, a shot that starts in a used slot is one at its release.
    #[test]
    fn contract_a_used_slot_starts_like_a_new_one() {
        let params = ModelParams::new(&Physics::paper());
        let start = |speed: f64| BallState {
            position_m: Vec3::new(4.0, 0.0, -1.0),
            velocity_m_s: Vec3::new(-speed, 0.0, 6.0),
            spin_rad_s: Vec3::new(0.0, 10.0, 0.0),
        };
        let mut used = ShotProgress::at_release(&params, start(4.0));
        used.contacts.push(SolidId::Ring);
        used.begin_single_contact(FramedPart::RingCircle);
        used.friction[0].rolling = true;
        used.crossing.rose_through = true;
        (used.step_fraction, used.contact_time_s, used.rolling_time_s) = (0.5, 0.1, 0.2);
        (used.time_s, used.phases, used.steps) = (1.0, 3, 20);
        used.touching = [true; SolidId::COUNT];
        used.restart(&params, &start(5.0));
        let new = ShotProgress::at_release(&params, start(5.0));
        assert_eq!(format!("{used:?}"), format!("{new:?}"));
    }
}
