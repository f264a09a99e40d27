//! What is doubtful about a nominal shot, in words.

use crate::answers::nominal_shot::ShotNote;
use crate::answers::requests::Note;
use crate::units::{DEGREE_RAD, REV_RAD};

/// A note in words.
#[must_use]
pub fn shot_note_text(note: &ShotNote) -> String {
    match note {
        ShotNote::BackspinNotGiven { backspin_rad_s } => format!(
            "no backspin is given; the profile's max_backspin, {:.1} rev/s, is used (change it with --backspin)",
            backspin_rad_s / REV_RAD
        ),
        ShotNote::MayPassThrough { most_m_s } => format!(
            "above {most_m_s:.1} m/s board and ring cannot stop this ball: it may pass through them"
        ),
        ShotNote::BeyondSearch { of, how } => {
            format!("the {} {how}: no search would give this shot", of.name())
        }
        ShotNote::BeyondBackspin { most_rad_s } => format!(
            "the backspin is more than shooter.max_backspin ({:.3} rev/s): no search would give this shot",
            most_rad_s / REV_RAD
        ),
        ShotNote::TouchesNothing {
            polar_rad,
            towards_rad,
        } => {
            let [polar_deg, towards_deg] = [polar_rad, towards_rad].map(|rad| rad / DEGREE_RAD);
            let direction = match (polar_deg - towards_deg).abs() > 0.005 {
                true => format!(
                    " Its polar angle is {polar_deg:.2} deg; that towards the hoop's centre is {towards_deg:.2} deg (--aim gives the angle from there)."
                ),
                false => String::new(),
            };
            format!("without errors this shot touches nothing and misses.{direction}")
        }
    }
}

/// A note beside an answer, in words.
#[must_use]
pub fn note_text(note: &Note) -> String {
    match note {
        Note::Profile(words) => words.clone(),
        Note::Shot(note) => shot_note_text(note),
        Note::Imprecise => {
            "the simulation error is larger than wanted; raise the budget or the standard error"
                .to_owned()
        }
    }
}
