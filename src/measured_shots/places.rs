//! Which shots are from one place.

use crate::fitting::Place;
use crate::shooter::Location;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

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
/// the file's columns, not those of measured flights. `goes_on` is called now
/// and then.
pub(super) fn shots_of_places(
    places: &[Place],
    is_stated: bool,
    goes_on: &dyn Fn(),
) -> Vec<Vec<usize>> {
    let mut groups = same_points(places);
    for group in &mut groups {
        group.is_stated = is_stated && group.shots.len() >= STATED_SHOTS;
    }
    // The stated places first: others join them, and they join none.
    groups.sort_by_key(|group| !group.is_stated);
    join_nearest(&mut groups, SAME_PLACE_M, |_| true, goes_on);
    let is_small = |group: &Group| group.shots.len() < FEWEST_SHOTS;
    join_nearest(&mut groups, NEAR_PLACE_M, is_small, goes_on);
    let mut shots: Vec<Vec<usize>> = groups.into_iter().map(|group| group.shots).collect();
    for of_place in &mut shots {
        of_place.sort_unstable();
    }
    shots.sort();
    shots
}

/// Squares of the floor, or cubes of the room, and what is in them: what is nearer than the length
/// of an edge is in one of the squares around.
struct Cells<const D: usize> {
    edge_m: f64,
    groups: HashMap<[i64; D], Vec<usize>>,
}

impl<const D: usize> Cells<D> {
    fn new(distance_m: f64) -> Self {
        Self {
            // A little longer: quotients are rounded.
            edge_m: 1.001 * distance_m,
            groups: HashMap::new(),
        }
    }

    fn cell(&self, group: &Group) -> [i64; D] {
        std::array::from_fn(|k| (group.middle[k] / self.edge_m).floor() as i64)
    }

    fn insert(&mut self, index: usize, group: &Group) {
        self.groups.entry(self.cell(group)).or_default().push(index);
    }

    fn remove(&mut self, index: usize, group: &Group) {
        if let Some(inside) = self.groups.get_mut(&self.cell(group)) {
            inside.retain(|other| *other != index);
        }
    }

    /// The groups in the cells around one, and in its own.
    fn around(&self, group: &Group) -> impl Iterator<Item = usize> {
        let own = self.cell(group);
        let all = (0..3_usize.pow(D as u32)).map(move |number| {
            std::array::from_fn(|k| own[k] + (number / 3_usize.pow(k as u32) % 3) as i64 - 1)
        });
        all.filter_map(|cell: [i64; D]| self.groups.get(&cell))
            .flatten()
            .copied()
    }
}

fn same_points(places: &[Place]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut cells = Cells::<3>::new(SAME_POINT_M);
    for (shot, place) in places.iter().enumerate() {
        let (x, y) = place.location.to_xy();
        let new = Group {
            middle: [x, y, place.release_height_m],
            shots: vec![shot],
            is_stated: false,
        };
        let is_same = |index: &usize| {
            let group = &groups[*index];
            let higher = group.middle[2] - new.middle[2];
            group.distance_m(&new) <= SAME_POINT_M && higher.abs() <= SAME_POINT_M
        };
        match cells.around(&new).filter(is_same).min() {
            Some(index) => groups[index].shots.push(shot),
            None => {
                cells.insert(groups.len(), &new);
                groups.push(new);
            }
        }
    }
    groups
}

/// Two groups that may be joined: those of the least distance first, of these the first ones.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Pair {
    /// The bits of a number that is not negative are in its order.
    distance_bits: u64,
    groups: [usize; 2],
    /// How many shots they had: if a group has grown since, the pair is out of date.
    shots: [usize; 2],
    /// Which of the two has no nearer one.
    owner: usize,
}

/// Joins the two groups that are nearest, one of which `joins`, until none are within `limit_m`.
fn join_nearest(
    groups: &mut Vec<Group>,
    limit_m: f64,
    joins: impl Fn(&Group) -> bool,
    goes_on: &dyn Fn(),
) {
    let distance_to_join_m = |a: &Group, b: &Group| -> Option<f64> {
        let may_join = a.is_as_high_as(b) && (joins(a) || joins(b));
        let limit_m = match a.is_stated && b.is_stated {
            true => SAME_POINT_M,
            false => limit_m,
        };
        let distance_m = may_join.then(|| a.distance_m(b))?;
        (distance_m <= limit_m).then_some(distance_m)
    };
    let mut cells = Cells::<2>::new(limit_m);
    for (index, group) in groups.iter().enumerate() {
        cells.insert(index, group);
    }
    let nearest = |groups: &[Group], cells: &Cells<2>, index: usize| -> Option<Pair> {
        goes_on();
        let own = &groups[index];
        let mut nearest: Option<(u64, [usize; 2])> = None;
        let mut least_m = limit_m;
        for other in cells.around(own).filter(|&other| other != index) {
            // Most are farther along one axis alone, by more than rounding.
            let enough_m = 1.000_001 * least_m;
            let is_far = |k: usize| (own.middle[k] - groups[other].middle[k]).abs() > enough_m;
            if is_far(0) || is_far(1) {
                continue;
            }
            if let Some(distance_m) = distance_to_join_m(own, &groups[other]) {
                let pair = (distance_m.to_bits(), [index.min(other), index.max(other)]);
                nearest = Some(nearest.map_or(pair, |nearest| nearest.min(pair)));
                least_m = least_m.min(distance_m);
            }
        }
        let (distance_bits, pair) = nearest?;
        Some(Pair {
            distance_bits,
            groups: pair,
            shots: pair.map(|group| groups[group].shots.len()),
            owner: usize::from(pair[1] == index),
        })
    };
    // Of any two groups that may join, one has an entry in the heap that is no farther.
    let all = (0..groups.len()).filter_map(|index| nearest(groups, &cells, index));
    let mut pairs: BinaryHeap<Reverse<Pair>> = all.map(Reverse).collect();
    while let Some(Reverse(pair)) = pairs.pop() {
        let [first, second] = pair.groups;
        let is_unchanged = [0, 1].map(|k| groups[pair.groups[k]].shots.len() == pair.shots[k]);
        let changed = if is_unchanged == [true; 2] {
            cells.remove(first, &groups[first]);
            cells.remove(second, &groups[second]);
            let other = groups[second].clone();
            groups[second].shots.clear();
            groups[first].join(&other);
            cells.insert(first, &groups[first]);
            first
        } else if is_unchanged[pair.owner] {
            pair.groups[pair.owner]
        } else {
            continue;
        };
        pairs.extend(nearest(groups, &cells, changed).map(Reverse));
    }
    groups.retain(|group| !group.shots.is_empty());
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
        let shots = shots_of_places(&places, true, &|| ());
        assert_eq!(shots.len(), 2, "{shots:?}");
        assert!(shots[0].iter().all(|shot| shot % 2 == 0));
        let found = middle(&places, &shots[0]);
        assert!((found.location.distance_m - 13.75 * FOOT_M).abs() < 0.01);
    }

    /// Authority: the definition, by looking at all pairs after each join. Points on a lattice have
    /// many equal distances.
    #[test]
    fn contract_the_nearest_groups_join_first() {
        fn by_all_pairs(groups: &mut Vec<Group>, limit_m: f64, joins: impl Fn(&Group) -> bool) {
            loop {
                let mut best: Option<(f64, usize, usize)> = None;
                for (i, a) in groups.iter().enumerate() {
                    for (j, b) in groups.iter().enumerate().skip(i + 1) {
                        let distance_m = a.distance_m(b);
                        let may_join = a.is_as_high_as(b)
                            && !(a.is_stated && b.is_stated && distance_m > SAME_POINT_M)
                            && (joins(a) || joins(b))
                            && distance_m <= limit_m;
                        if may_join && best.is_none_or(|(least, ..)| distance_m < least) {
                            best = Some((distance_m, i, j));
                        }
                    }
                }
                let Some((_, i, j)) = best else { return };
                let other = groups.remove(j);
                groups[i].join(&other);
            }
        }
        let mut random = 1_u64;
        let mut next = |below: u64| {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (random >> 33) % below
        };
        for round in 0..40 {
            let groups: Vec<Group> = (0..60)
                .map(|shot| {
                    // A lattice of a foot, or of a centimetre.
                    let mut at = |cells: u64| match round % 2 {
                        0 => next(cells) as f64 * FOOT_M,
                        _ => next(cells * 30) as f64 * 0.01,
                    };
                    Group {
                        middle: [at(14), at(14), 2.0 + 0.1 * at(3)],
                        shots: vec![shot],
                        is_stated: round % 4 > 1 && shot % 5 == 0,
                    }
                })
                .collect();
            let (mut found, mut wanted) = (groups.clone(), groups);
            for (limit_m, fewest) in [(SAME_PLACE_M, usize::MAX), (NEAR_PLACE_M, FEWEST_SHOTS)] {
                let joins = |group: &Group| group.shots.len() < fewest;
                join_nearest(&mut found, limit_m, joins, &|| ());
                by_all_pairs(&mut wanted, limit_m, joins);
                assert!(found.len() < 60);
                let shots = |groups: &[Group]| -> Vec<Vec<usize>> {
                    groups.iter().map(|group| group.shots.clone()).collect()
                };
                assert_eq!(shots(&found), shots(&wanted), "round {round}");
            }
        }
    }

    /// Points that the file states for many shots stay places of their own.
    #[test]
    fn contract_stated_places_stay_apart() {
        let places: Vec<Place> = (0..60).map(|k| at(12.0 + f64::from(k % 3), 0.0)).collect();
        assert_eq!(shots_of_places(&places, true, &|| ()).len(), 3);
        assert_eq!(shots_of_places(&places, false, &|| ()).len(), 1);
        assert_eq!(middle(&places, &[0, 3]), places[0]);
    }
}
