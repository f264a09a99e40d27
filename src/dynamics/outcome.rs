//! How a shot ended: made or missed, in what way, and what it touched.

use serde::Serialize;
use std::fmt;

/// What the ball can touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Touched {
    /// The backboard.
    Board,
    /// The ring.
    Ring,
}

/// The contacts of a shot in their order: the first 64 exactly, and how many there were.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contacts {
    board_bits: u64,
    boards: u32,
    rings: u32,
}

impl Contacts {
    /// No contact yet.
    pub(crate) const NONE: Self = Self {
        board_bits: 0,
        boards: 0,
        rings: 0,
    };
    /// Contacts that are kept with their order; later ones are only counted.
    pub const KEPT: u32 = 64;

    pub(crate) fn push(&mut self, touched: Touched) {
        let place = self.count();
        match touched {
            Touched::Board => {
                if place < Self::KEPT {
                    self.board_bits |= 1 << place;
                }
                self.boards += 1;
            }
            Touched::Ring => self.rings += 1,
        }
    }

    /// Number of contacts.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.boards + self.rings
    }

    /// Number of contacts with the board.
    #[must_use]
    pub fn boards(&self) -> u32 {
        self.boards
    }

    /// Number of contacts with the ring.
    #[must_use]
    pub fn rings(&self) -> u32 {
        self.rings
    }

    /// The first contact.
    #[must_use]
    pub fn first(&self) -> Option<Touched> {
        self.iter().next()
    }

    /// The contacts in order (the first [`Contacts::KEPT`]).
    pub fn iter(&self) -> impl Iterator<Item = Touched> + use<> {
        let bits = self.board_bits;
        (0..self.count().min(Self::KEPT)).map(move |i| {
            if bits >> i & 1 == 1 {
                Touched::Board
            } else {
                Touched::Ring
            }
        })
    }
}

impl fmt::Display for Contacts {
    /// `board ring ring`; empty for a shot that touches nothing.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, touched) in self.iter().enumerate() {
            let gap = if i == 0 { "" } else { " " };
            let name = match touched {
                Touched::Board => "board",
                Touched::Ring => "ring",
            };
            write!(f, "{gap}{name}")?;
        }
        if self.count() > Self::KEPT {
            write!(f, " ...")?;
        }
        Ok(())
    }
}

/// How the simulation of a shot came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The centre fell through `z = -R`, below which the ring cannot touch the ball.
    Fell,
    /// The ball never rose to `z = -R`.
    NeverRose,
    /// The centre is behind the face of the board.
    BehindBoard,
    /// The ball rolled on board and ring at once for the physics' `lodged_after_s`.
    Wedged,
    /// The time limit was reached.
    TimeLimit,
    /// The numerics gave up: the search for a touch did not end. Counted apart, never as a miss.
    Unresolved,
}

/// The short answer of one shot: all that a probability needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// The ball went in.
    pub made: bool,
    /// How the simulation ended.
    pub ending: Ending,
    /// What was touched, in order.
    pub contacts: Contacts,
    /// Time from the release to the end, s.
    pub time_s: f64,
}

/// Made or missed, and in which way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Made, nothing touched.
    Swish,
    /// Made off the ring, the board not first.
    RimIn,
    /// Made off the board, the ring never touched.
    BankIn,
    /// Made off the board and then the ring.
    BankRimIn,
    /// Missed: was below the plane of the hoop inside the ring, and came out.
    InAndOut,
    /// Missed on the shooter's side of the hoop (of a bank shot: between hoop and board).
    Short,
    /// Missed beyond the hoop (of a bank shot: came too far off the board).
    Long,
    /// Missed to one side by more than short or long.
    Wide,
    /// Missed behind the board.
    OverBoard,
    /// Came to rest on ring and board, or had not ended at the time limit.
    Lodged,
    /// Missed and touched nothing.
    Airball,
    /// The numerics gave up.
    Unresolved,
}

impl Kind {
    /// Every kind, made ones first.
    pub const ALL: [Kind; 12] = [
        Kind::Swish,
        Kind::RimIn,
        Kind::BankIn,
        Kind::BankRimIn,
        Kind::InAndOut,
        Kind::Short,
        Kind::Long,
        Kind::Wide,
        Kind::OverBoard,
        Kind::Lodged,
        Kind::Airball,
        Kind::Unresolved,
    ];

    /// The name in tables and files, such as `bank-rim-in`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Kind::Swish => "swish",
            Kind::RimIn => "rim-in",
            Kind::BankIn => "bank-in",
            Kind::BankRimIn => "bank-rim-in",
            Kind::InAndOut => "in-and-out",
            Kind::Short => "short",
            Kind::Long => "long",
            Kind::Wide => "wide",
            Kind::OverBoard => "over-board",
            Kind::Lodged => "lodged",
            Kind::Airball => "airball",
            Kind::Unresolved => "unresolved",
        }
    }

    /// The kind of a made shot with these contacts.
    #[must_use]
    pub fn of_made(contacts: &Contacts) -> Self {
        match (contacts.first(), contacts.rings()) {
            (None, _) => Kind::Swish,
            (Some(Touched::Ring), _) => Kind::RimIn,
            (Some(Touched::Board), 0) => Kind::BankIn,
            (Some(Touched::Board), _) => Kind::BankRimIn,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Where and how the ball last came down through the plane of the hoop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// Angle of the centre's path below the horizontal, rad (0 to pi/2).
    pub angle_rad: f64,
    /// Place of the centre relative to the hoop's centre, x (away from the board) and y, m.
    pub offset_m: (f64, f64),
}

/// The whole answer of one shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Made, the ending, the contacts and the time.
    pub verdict: Verdict,
    /// Made or missed, and in which way.
    pub kind: Kind,
    /// The last fall through the plane of the hoop, if there was one.
    pub entry: Option<Entry>,
    /// Greatest height of the centre above the plane of the hoop, m.
    pub apex_m: f64,
    /// Place of the centre at the first touch of the board (x, y, z), m.
    pub board_point_m: Option<(f64, f64, f64)>,
    /// How far to the right of the hoop's centre, facing the hoop (of a bank shot: the board), the
    /// undisturbed path (of a bank shot: the path off the board) meets the plane of the hoop, m.
    pub aside_m: f64,
}
