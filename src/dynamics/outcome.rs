//! How a shot ended: made or missed, in what way, and what it touched.
//!
//! The types build on each other. An [`Ending`] says why the simulation stopped. A [`Verdict`] adds
//! made or missed, and the contacts: all that a probability needs, and all that a batch computes.
//! An [`Outcome`] adds what people ask about one shot: its [`OutcomeKind`] (swish, long, in-and-out
//! ...), its entry and its apex.

use crate::model::SolidId;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The contacts of a shot in order: the first [`ContactSequence::KEPT`] by name, and the number
/// with each solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactSequence {
    /// Two bits for each contact, from the lowest.
    codes: [u64; Self::WORDS],
    counts: [u32; SolidId::COUNT],
}

impl ContactSequence {
    /// Contacts that are kept in order. Later ones are only counted.
    pub const KEPT: u32 = 64;
    const BITS: u32 = 2;
    const WORDS: usize = (Self::KEPT * Self::BITS / u64::BITS) as usize;
    const PER_WORD: u32 = u64::BITS / Self::BITS;

    /// No contact.
    pub(crate) const EMPTY: Self = Self {
        codes: [0; Self::WORDS],
        counts: [0; SolidId::COUNT],
    };

    pub(crate) fn push(&mut self, solid: SolidId) {
        let position = self.count();
        if position < Self::KEPT {
            let shift = position % Self::PER_WORD * Self::BITS;
            self.codes[(position / Self::PER_WORD) as usize] |= (solid.index() as u64) << shift;
        }
        self.counts[solid.index()] += 1;
    }

    /// Number of contacts.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.counts.iter().sum()
    }

    /// Number of contacts with one solid.
    #[must_use]
    pub fn count_of(&self, solid: SolidId) -> u32 {
        self.counts[solid.index()]
    }

    /// The first contact.
    #[must_use]
    pub fn first(&self) -> Option<SolidId> {
        self.iter().next()
    }

    /// The contacts in order, the first [`ContactSequence::KEPT`] of them.
    pub fn iter(&self) -> impl Iterator<Item = SolidId> + use<> {
        let codes = self.codes;
        (0..self.count().min(Self::KEPT)).map(move |i| {
            let word = codes[(i / Self::PER_WORD) as usize];
            let code = word >> (i % Self::PER_WORD * Self::BITS) & ((1 << Self::BITS) - 1);
            SolidId::ALL[code as usize]
        })
    }
}

const _: () = assert!(SolidId::COUNT <= 1 << ContactSequence::BITS);

impl fmt::Display for ContactSequence {
    /// `board ring ring`; empty for a shot that touches nothing.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, solid) in self.iter().enumerate() {
            let gap = if i == 0 { "" } else { " " };
            write!(f, "{gap}{}", solid.name())?;
        }
        if self.count() > Self::KEPT {
            write!(f, " ...")?;
        }
        Ok(())
    }
}

/// Why the simulation of a shot ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The centre fell through `z = -reach` (the radius of the ball and that of the rod), below
    /// which the ring cannot touch the ball.
    Fell,
    /// The ball never rose to `z = -reach`.
    NeverRose,
    /// The centre passed behind the board: its face or, with round edges, the plane one edge radius
    /// behind the face.
    BehindBoard,
    /// The ball rolled on two solids at once for the physics' `lodged_after_s`.
    Lodged,
    /// The time limit was reached.
    TimeLimit,
    /// The numerics gave up: an iteration limit was reached. The shot counts neither as made nor as
    /// missed.
    Unresolved,
}

/// The result of one shot that a probability needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// The ball went in.
    pub made: bool,
    /// How the simulation ended.
    pub ending: Ending,
    /// What the ball touched, in order.
    pub contacts: ContactSequence,
    /// Time from the release to the end, s.
    pub time_s: f64,
}

/// How a shot was made or missed.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutcomeKind {
    /// Made, nothing touched.
    Swish,
    /// Made after touching the ring first.
    RimIn,
    /// Made after touching the board and never the ring.
    BankIn,
    /// Made after touching the board first and the ring later.
    BankRimIn,
    /// Missed: the ball was below the plane of the hoop inside the ring and came out again.
    InAndOut,
    /// Missed on the shooter's side of the hoop (a bank shot: between hoop and board).
    Short,
    /// Missed beyond the hoop (a bank shot: it came too far off the board).
    Long,
    /// Missed more to the side than short or long.
    Wide,
    /// Missed: the ball went behind the board ([`Ending::BehindBoard`]), over it or past its edge.
    OverBoard,
    /// Missed: the ball never came off ring and board ([`Ending::Lodged`]), or was still in play at
    /// the time limit.
    Lodged,
    /// Missed without touching anything.
    Airball,
    /// The numerics gave up.
    Unresolved,
}

impl OutcomeKind {
    /// Every kind; the ways to make a shot come first.
    pub const ALL: [Self; 12] = [
        Self::Swish,
        Self::RimIn,
        Self::BankIn,
        Self::BankRimIn,
        Self::InAndOut,
        Self::Short,
        Self::Long,
        Self::Wide,
        Self::OverBoard,
        Self::Lodged,
        Self::Airball,
        Self::Unresolved,
    ];

    /// Whether the shot went in.
    #[must_use]
    pub fn is_made(self) -> bool {
        matches!(
            self,
            Self::Swish | Self::RimIn | Self::BankIn | Self::BankRimIn
        )
    }

    /// The name in tables and files, such as `bank-rim-in`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Swish => "swish",
            Self::RimIn => "rim-in",
            Self::BankIn => "bank-in",
            Self::BankRimIn => "bank-rim-in",
            Self::InAndOut => "in-and-out",
            Self::Short => "short",
            Self::Long => "long",
            Self::Wide => "wide",
            Self::OverBoard => "over-board",
            Self::Lodged => "lodged",
            Self::Airball => "airball",
            Self::Unresolved => "unresolved",
        }
    }

    /// The kind of a made shot from its contacts.
    #[must_use]
    pub fn of_made(contacts: &ContactSequence) -> Self {
        match (contacts.first(), contacts.count_of(SolidId::Ring)) {
            (None, _) => Self::Swish,
            (Some(SolidId::Ring), _) => Self::RimIn,
            (Some(SolidId::Board), 0) => Self::BankIn,
            (Some(SolidId::Board), _) => Self::BankRimIn,
        }
    }
}

impl fmt::Display for OutcomeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The last fall of the ball through the plane of the hoop, inside or outside the ring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// Angle of the path below the horizontal, rad (0 to pi/2).
    pub angle_rad: f64,
    /// Position of the ball's centre relative to the hoop's: x (away from the board) and y, m.
    pub offset_m: (f64, f64),
}

/// The full result of one shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Made or missed, the ending, the contacts and the time.
    pub verdict: Verdict,
    /// How the shot was made or missed.
    pub kind: OutcomeKind,
    /// The last fall through the plane of the hoop, if any.
    pub entry: Option<Entry>,
    /// Greatest height of the centre above the plane of the hoop, m.
    pub apex_m: f64,
    /// Time from the release to the first touch of a solid, if any, s.
    pub first_touch_s: Option<f64>,
    /// Position of the centre at the first touch of the board (x, y, z), m.
    pub board_point_m: Option<(f64, f64, f64)>,
    /// Where the undisturbed path (a bank shot: the path off the board) meets the plane of the
    /// hoop: distance to the right of the centre, facing the hoop (a bank shot: the board), m; 0 if
    /// it does not meet the plane.
    pub right_of_centre_m: f64,
}
