//! Removes points of a line that make no visible difference (Ramer 1972, Douglas and Peucker 1973).

/// Greatest distance between a thinned line and the points that it leaves out, px.
const TOLERANCE: f64 = 0.2;

/// The points of a line, px, without those that change it by less than [`TOLERANCE`].
pub(super) fn thinned(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let points: Vec<(f64, f64)> = points.collect();
    let mut is_kept = vec![false; points.len()];
    let mut spans = vec![(0, points.len().saturating_sub(1))];
    while let Some((first, last)) = spans.pop() {
        for end in [first, last] {
            if let Some(is_kept) = is_kept.get_mut(end) {
                *is_kept = true;
            }
        }
        let (_, farthest) = (first + 1..last)
            .map(|i| {
                (
                    distance_from_line(points[i], points[first], points[last]),
                    i,
                )
            })
            .fold((TOLERANCE, None), |(largest, at), (distance, i)| {
                if distance > largest {
                    (distance, Some(i))
                } else {
                    (largest, at)
                }
            });
        if let Some(i) = farthest {
            spans.extend([(first, i), (i, last)]);
        }
    }
    let kept = points.iter().zip(is_kept);
    kept.filter_map(|(point, is_kept)| is_kept.then_some(*point))
        .collect()
}

/// Distance of a point from the line segment between `a` and `b`.
fn distance_from_line(p: (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length_squared = dx * dx + dy * dy;
    let fraction = if length_squared > 0.0 {
        (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let (x, y) = (p.0 - a.0 - fraction * dx, p.1 - a.1 - fraction * dy);
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_a_thinned_line_stays_near_its_points() {
        let points: Vec<(f64, f64)> = (0..500)
            .map(|i| {
                let t = f64::from(i);
                let sign = if i > 400 { -1.0 } else { 1.0 };
                (t, 0.01 * (t - 250.0) * (t - 250.0) * sign)
            })
            .collect();
        let kept = thinned(points.iter().copied());
        assert!(kept.len() > 10 && kept.len() < 200, "{}", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[499]));
        for point in points {
            let distance = kept
                .windows(2)
                .map(|pair| distance_from_line(point, pair[0], pair[1]))
                .fold(f64::INFINITY, f64::min);
            assert!(distance <= TOLERANCE + 1e-12, "{point:?} {distance}");
        }
        assert_eq!(thinned(std::iter::empty()), []);
        assert_eq!(thinned([(1.0, 2.0)].into_iter()), [(1.0, 2.0)]);
    }
}
