//! What a file of measured shots holds of each shot.

use super::column_map_proposal::{Proposal, map_proposal};
use super::columns::{Columns, Label, Quantity};
use serde::{Deserialize, Serialize};

/// What a file holds of a shot.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Its release.
    Releases,
    /// Where it fell through the height of the hoop.
    Landings,
    /// Where the ball was, frame by frame.
    Trajectories,
    /// No more than whether it went in.
    Makes,
}

impl Source {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Releases => "releases",
            Self::Landings => "landings",
            Self::Trajectories => "trajectories",
            Self::Makes => "makes",
        }
    }

    /// The tracker that is taken where none is named.
    #[must_use]
    pub fn usual_tracker(self) -> &'static str {
        match self {
            Self::Releases => "lab",
            // Of makes: what a sensor would add.
            Self::Landings | Self::Makes => "noah",
            Self::Trajectories => "optical_25hz",
        }
    }

    /// The quantities of each row that a fit uses; those of trajectories are looked at point by
    /// point.
    pub(super) fn quantities(self) -> &'static [Quantity] {
        match self {
            Self::Releases => &[Quantity::Speed, Quantity::Pitch, Quantity::Aim],
            Self::Landings => &[Quantity::EntryAngle, Quantity::Depth, Quantity::LeftRight],
            Self::Trajectories | Self::Makes => &[],
        }
    }

    /// What the columns of a file hold.
    ///
    /// # Errors
    /// What is missing.
    pub fn of(columns: &Columns) -> Result<Self, String> {
        let has = |quantity| columns.quantity(quantity).is_some();
        if has(Quantity::Time) && has(Quantity::X) && has(Quantity::Y) && has(Quantity::Z) {
            return if columns.label(Label::Shot).is_some() {
                Ok(Self::Trajectories)
            } else {
                Err("column shot is missing: it groups the points of one shot".to_owned())
            };
        }
        if has(Quantity::EntryAngle) && has(Quantity::Depth) && has(Quantity::LeftRight) {
            return Ok(Self::Landings);
        }
        if has(Quantity::Speed)
            && has(Quantity::Pitch)
            && (has(Quantity::Polar) || has(Quantity::Aim))
        {
            return Ok(Self::Releases);
        }
        // Without a direction: where no other column may hold it.
        let proposal = Proposal::of(columns);
        let may_have = |target| proposal.maps.iter().any(|map| map.target == target);
        if has(Quantity::Speed)
            && has(Quantity::Pitch)
            && !may_have("aim")
            && !may_have("polar")
            && !has(Quantity::Depth)
        {
            return Ok(Self::Releases);
        }
        let is_of_flights = |target: &str| {
            let known = Quantity::ALL
                .into_iter()
                .find(|quantity| quantity.name() == target);
            known.is_some_and(is_of_flight)
        };
        let has_flights = Quantity::ALL
            .into_iter()
            .any(|known| is_of_flight(known) && has(known))
            || proposal.maps.iter().any(|map| is_of_flights(map.target));
        let label = |label| columns.label(label).is_some();
        if !has_flights && (label(Label::Made) || label(Label::Makes) && label(Label::Attempts)) {
            return Ok(Self::Makes);
        }
        if let Some(missing) = one_missing(columns) {
            return Err(format!("{missing}{}", map_proposal(columns)));
        }
        Err(format!(
            "needs the columns of releases (speed, pitch and polar or aim), of landings (entry_angle, depth, left_right) or of \
             trajectories (shot, time, x, y, z), each with its unit, as in speed_ft_s, pitch_deg, depth_in, time_s; or makes alone (place, attempts, makes){}{}",
            some_missing(columns).unwrap_or_default(),
            map_proposal(columns)
        ))
    }
}

/// Whether a quantity says how a ball flew.
fn is_of_flight(quantity: Quantity) -> bool {
    !matches!(
        quantity,
        Quantity::Distance | Quantity::CourtAngle | Quantity::ReleaseHeight | Quantity::Backspin
    )
}

/// What is missing where a file has all columns but one of a source.
fn one_missing(columns: &Columns) -> Option<String> {
    let landings = [Quantity::EntryAngle, Quantity::Depth, Quantity::LeftRight];
    let trajectories = [Quantity::Time, Quantity::X, Quantity::Y, Quantity::Z];
    let releases = [Quantity::Speed, Quantity::Pitch, Quantity::Aim];
    let sources: [(&str, &[Quantity]); 3] = [
        ("landings", &landings),
        ("trajectories", &trajectories),
        ("releases", &releases),
    ];
    sources.into_iter().find_map(|(source, needed)| {
        let is_missing = |quantity: &&Quantity| !has_or_polar(columns, **quantity);
        let missing: Vec<&Quantity> = needed.iter().filter(is_missing).collect();
        let [missing] = missing[..] else { return None };
        Some(format!(
            "looks like a file of {source}, but no column {} was found; say which it is: --map '{}=COLUMN:UNIT'",
            missing.name(),
            missing.name()
        ))
    })
}

/// Whether a file has a quantity; the polar angle stands for the aim.
fn has_or_polar(columns: &Columns, quantity: Quantity) -> bool {
    let has = |quantity| columns.quantity(quantity).is_some();
    has(quantity) || quantity == Quantity::Aim && has(Quantity::Polar)
}

/// What is missing where a file has some columns of a source.
fn some_missing(columns: &Columns) -> Option<String> {
    let has = |quantity: &&Quantity| has_or_polar(columns, **quantity);
    let sources = [Source::Releases, Source::Landings];
    let begun = sources.into_iter().max_by_key(|source| {
        let present = source.quantities().iter().filter(has);
        present.count()
    })?;
    let names = |quantities: Vec<&Quantity>| {
        let names: Vec<&str> = quantities.iter().map(|quantity| quantity.name()).collect();
        names.join(" and ")
    };
    let (present, missing): (Vec<&Quantity>, Vec<&Quantity>) =
        begun.quantities().iter().partition(has);
    (!present.is_empty()).then(|| {
        format!(
            "; of {} it has {}, but not {}",
            begun.name(),
            names(present),
            names(missing)
        )
    })
}
