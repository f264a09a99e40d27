//! Which shots are from one place.

use crate::fitting::Place;
use crate::shooter::Location;

/// Two groups of shots are from one place if their middles are nearer than this, m: a player who
/// shoots from one place again and again stands within about 1.5 ft of it.
const SAME_PLACE_M: f64 = 0.9;
/// Groups with heights farther apart than this are two places, m.
const SAME_HEIGHT_M: f64 = 0.15;
/// Coordinates this near are the same, m.
const SAME_POINT_M: f64 = 0.005;
/// From so many shots on a point that the file states is a place of its own.
const STATED_SHOTS: usize = 8;
/// A group of fewer shots joins another one up to [`NEAR_PLACE_M`] away: no scatter can be seen in
/// it.
const FEWEST_SHOTS: usize = 3;
const NEAR_PLACE_M: f64 = 1.5;

/// A group of shots.
#[derive(Clone, Debug)]
struct Group {
    /// The mean of x, y and the height above the floor, m.
    middle: [f64; 3],
    shots: Vec<usize>,
    /// Whether the file states this very point for many shots.
    is_stated: bool,
}

impl Group {
    fn distance_m(&self, other: &Self) -> f64 {
        let [a, b] = [self.middle, other.middle];
        libm::hypot(a[0] - b[0], a[1] - b[1])
    }

    fn is_as_high_as(&self, other: &Self) -> bool {
        (self.middle[2] - other.middle[2]).abs() <= SAME_HEIGHT_M
    }

    fn join(&mut self, other: &Self) {
        let (own, new) = (self.shots.len() as f64, other.shots.len() as f64);
        if !self.is_stated {
            for (value, added) in self.middle.iter_mut().zip(other.middle) {
                *value = (own * *value + new * added) / (own + new);
            }
        }
        self.shots.extend(&other.shots);
    }
}

/// The shots of each place, in the order of their first shots. `is_stated`: the places are those of
/// the file's columns, not those of measured flights.
pub(super) fn shots_of_places(places: &[Place], is_stated: bool) -> Vec<Vec<usize>> {
    let mut groups = same_points(places);
    for group in &mut groups {
        group.is_stated = is_stated && group.shots.len() >= STATED_SHOTS;
    }
    // The stated places first: others join them, and they join none.
    groups.sort_by_key(|group| !group.is_stated);
    join_nearest(&mut groups, SAME_PLACE_M, |_| true);
    join_nearest(&mut groups, NEAR_PLACE_M, |group| {
        group.shots.len() < FEWEST_SHOTS
    });
    let mut shots: Vec<Vec<usize>> = groups.into_iter().map(|group| group.shots).collect();
    for of_place in &mut shots {
        of_place.sort_unstable();
    }
    shots.sort();
    shots
}

fn same_points(places: &[Place]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (shot, place) in places.iter().enumerate() {
        let (x, y) = place.location.to_xy();
        let point = [x, y, place.release_height_m];
        let is_same = |group: &&mut Group| {
            let [gx, gy, gz] = group.middle;
            libm::hypot(gx - x, gy - y) <= SAME_POINT_M && (gz - point[2]).abs() <= SAME_POINT_M
        };
        match groups.iter_mut().find(is_same) {
            Some(group) => group.shots.push(shot),
            None => groups.push(Group {
                middle: point,
                shots: vec![shot],
                is_stated: false,
            }),
        }
    }
    groups
}

/// Joins the two groups that are nearest, one of which `joins`, until none are within `limit_m`.
fn join_nearest(groups: &mut Vec<Group>, limit_m: f64, joins: impl Fn(&Group) -> bool) {
    let nearest = |groups: &[Group], i: usize| {
        let later = (i + 1..groups.len()).filter(|&j| {
            let (a, b) = (&groups[i], &groups[j]);
            a.is_as_high_as(b)
                && !(a.is_stated && b.is_stated && a.distance_m(b) > SAME_POINT_M)
                && (joins(a) || joins(b))
                && a.distance_m(b) <= limit_m
        });
        later
            .map(|j| (groups[i].distance_m(&groups[j]), j))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let mut of_each: Vec<Option<(f64, usize)>> =
        (0..groups.len()).map(|i| nearest(groups, i)).collect();
    loop {
        let pairs = of_each.iter().enumerate();
        let pairs = pairs.filter_map(|(i, pair)| pair.map(|(distance, j)| (distance, i, j)));
        let Some((_, i, j)) = pairs.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return;
        };
        let other = groups.remove(j);
        of_each.remove(j);
        groups[i].join(&other);
        of_each = of_each
            .iter()
            .enumerate()
            .map(|(k, pair)| match pair {
                // The group that grew may have come nearer; its partners are others now.
                _ if k <= i => nearest(groups, k),
                Some((_, partner)) if *partner == j => nearest(groups, k),
                Some((distance, partner)) if *partner > j => Some((*distance, partner - 1)),
                pair => *pair,
            })
            .collect();
    }
}

/// The middle of some places.
pub(super) fn middle(places: &[Place], shots: &[usize]) -> Place {
    // Of places that are all the same, exactly that.
    let first = places[shots[0]];
    if shots.iter().all(|&shot| places[shot] == first) {
        return first;
    }
    let mean = |value: &dyn Fn(&Place) -> f64| {
        shots.iter().map(|&shot| value(&places[shot])).sum::<f64>() / shots.len() as f64
    };
    let location = if shots
        .iter()
        .all(|&shot| places[shot].location == first.location)
    {
        first.location
    } else {
        let x = mean(&|place| place.location.to_xy().0);
        let y = mean(&|place| place.location.to_xy().1);
        Location {
            distance_m: libm::hypot(x, y),
            angle_rad: libm::atan2(y, x),
        }
    };
    Place {
        location,
        release_height_m: mean(&|place| place.release_height_m),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::FOOT_M;

    fn at(x_ft: f64, y_ft: f64) -> Place {
        let (x, y) = (x_ft * FOOT_M, y_ft * FOOT_M);
        Place {
            location: Location {
                distance_m: libm::hypot(x, y),
                angle_rad: libm::atan2(y, x),
            },
            release_height_m: 2.1,
        }
    }

    /// A square of +-1 ft is one place; the elbow beside it is another.
    #[test]
    fn contract_a_player_stands_within_a_foot_and_a_half() {
        let mut places = Vec::new();
        for k in 0..64 {
            let across = [f64::from(k % 8) / 3.5 - 1.0, f64::from(k / 8) / 3.5 - 1.0];
            places.push(at(13.75 + across[0], across[1]));
            places.push(at(13.75 + across[0], 6.0 + across[1]));
        }
        let shots = shots_of_places(&places, true);
        assert_eq!(shots.len(), 2, "{shots:?}");
        assert!(shots[0].iter().all(|shot| shot % 2 == 0));
        let found = middle(&places, &shots[0]);
        assert!((found.location.distance_m - 13.75 * FOOT_M).abs() < 0.01);
    }

    /// Points that the file states for many shots stay places of their own.
    #[test]
    fn contract_stated_places_stay_apart() {
        let places: Vec<Place> = (0..60).map(|k| at(12.0 + f64::from(k % 3), 0.0)).collect();
        assert_eq!(shots_of_places(&places, true).len(), 3);
        assert_eq!(shots_of_places(&places, false).len(), 1);
        assert_eq!(middle(&places, &[0, 3]), places[0]);
    }
}
