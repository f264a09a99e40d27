//! Board and ring at once: the rare double contact.
//!
//! The mechanics are those of the single contact, with both forces in one balance. Where both
//! contacts roll, their frictions are coupled: four linear equations say that both slips stay zero.

use super::contact::{
    self, Balance, Grip, Load, NO_FORCE_M_S2, SHORTEST_S, SLIP_DIRECTION_LOST, size, time_to_change,
};
use super::state::{Law, Rate, State, Triple};
use super::surface::{Board, Ring, Surface, Touch};
use crate::lane::{Lane, Mask};

/// The same for the board and for the ring. (A closure in `map` would not be inlined, and so not be
/// compiled for the vector instructions of its caller.)
macro_rules! each {
    ($which:ident => $value:expr) => {
        [
            {
                #[allow(non_upper_case_globals)]
                const $which: usize = BOARD;
                $value
            },
            {
                #[allow(non_upper_case_globals)]
                const $which: usize = RING;
                $value
            },
        ]
    };
}

/// What one step in the wedge did.
pub(crate) struct WedgeStep<L: Lane> {
    pub(crate) dt: L,
    /// The contact with the board, the ring is over; nothing was integrated.
    pub(crate) left: [L::Mask; 2],
    /// Impulses per unit of mass that board and ring gave, m/s.
    pub(crate) impulses: [Triple<L>; 2],
}

/// Both contacts seen from one state.
struct Pair<L> {
    touches: [Touch<L>; 2],
    /// The directions (n, 1, 2) of each contact in space.
    axes: [[Triple<L>; 3]; 2],
    /// Lever over the moment of inertia (per unit of mass).
    twists: [L; 2],
    normals: [L; 2],
}

/// Slip that counts as ended after a step meant to end it, m/s. The other contact's push turns the
/// slip as it dies away, so each such step leaves about half of it over.
const SLIP_ENDED_M_S: f64 = 1e-3;

pub(crate) const BOARD: usize = 0;
pub(crate) const RING: usize = 1;

impl<L: Lane> Pair<L> {
    #[inline(always)]
    fn meet(law: &Law<L>, state: &State<L>) -> Self {
        let (board, ()) = Board.meet(law, state);
        let (ring, frame) = Ring.meet(law, state);
        let touches = [board, ring];
        let (zero, one) = (law.zero, law.one);
        let units = [
            Triple(one, zero, zero),
            Triple(zero, one, zero),
            Triple(zero, zero, one),
        ];
        Self {
            axes: [
                units,
                [
                    Ring.to_space(frame, units[0]),
                    Ring.to_space(frame, units[1]),
                    Ring.to_space(frame, units[2]),
                ],
            ],
            twists: each!(i => touches[i].lever * law.mass_over_inertia),
            normals: each!(i => touches[i].normal(law)),
            touches,
        }
    }

    /// The slip rate that accelerations (linear, angular) of the ball give at a contact.
    #[inline(always)]
    fn slip_rate(&self, which: usize, (linear, angular): (Triple<L>, Triple<L>)) -> (L, L) {
        let [_, first, second] = self.axes[which];
        let lever = self.touches[which].lever;
        (
            dot(first, linear) - lever * dot(second, angular),
            dot(second, linear) + lever * dot(first, angular),
        )
    }

    /// Linear and angular acceleration of the ball from (n, 1, 2) accelerations at a contact.
    #[inline(always)]
    fn response(&self, which: usize, push: Triple<L>) -> (Triple<L>, Triple<L>) {
        let [normal, first, second] = self.axes[which];
        let twist = self.twists[which];
        (
            times(normal, push.0)
                .plus(first, push.1)
                .plus(second, push.2),
            times(first, twist * push.2).plus(second, -(twist * push.1)),
        )
    }

    /// Slip rates at a contact from the other contact's push.
    #[inline(always)]
    fn by_other(&self, which: usize, push: Triple<L>) -> (L, L) {
        self.slip_rate(which, self.response(1 - which, push))
    }

    /// Slip rates at a contact with no friction there: drift, gravity, and the other contact's push.
    #[inline(always)]
    fn driven(&self, which: usize, other_push: Triple<L>) -> (L, L) {
        let drive = self.touches[which].drive();
        let other = self.by_other(which, other_push);
        (drive.0 + other.0, drive.1 + other.1)
    }

    /// The push along the normal alone.
    #[inline(always)]
    fn press(&self, law: &Law<L>, which: usize) -> Triple<L> {
        Triple(self.normals[which], law.zero, law.zero)
    }

    /// Frictions at both contacts, `sliding` given where a contact slides.
    #[inline(always)]
    fn frictions(&self, law: &Law<L>, rolling: [L::Mask; 2], sliding: [(L, L); 2]) -> [(L, L); 2] {
        if !(rolling[BOARD] | rolling[RING]).any() {
            return sliding;
        }
        let wanted = each!(which => {
            let drive = self.driven(which, self.press(law, 1 - which));
            when(rolling[which], minus(drive), sliding[which])
        });
        self.solve(law, rolling, wanted)
    }

    /// The (1, 2) accelerations at both contacts that change the slips of the `held` contacts at the
    /// `wanted` rates; those of the other contacts are `wanted` themselves.
    ///
    /// A contact's own accelerations change its slip alike in both directions (1 + lever^2 m/I), so
    /// the four equations come down to two.
    #[inline(always)]
    fn solve(&self, law: &Law<L>, held: [L::Mask; 2], wanted: [(L, L); 2]) -> [(L, L); 2] {
        let [board, ring] = wanted;
        let [own_board, own_ring] = each!(i => {
            let own = self.touches[i].slip_per_push(law);
            own.when(held[i], law.one)
        });
        let [on_board, on_ring] = each!(i => self.coupling(law, i, held[i]));
        let per_board = law.one / own_board;
        let scaled = (board.0 * per_board, board.1 * per_board);
        let back = on_ring.times(scaled);
        let right = (ring.0 - back.0, ring.1 - back.1);
        let round = on_ring.after(&on_board, per_board);
        let matrix = Matrix {
            a: own_ring - round.a,
            b: -round.b,
            c: -round.c,
            d: own_ring - round.d,
        };
        let ring = matrix.solve(law, right, own_ring);
        let other = on_board.times(ring);
        let board = (
            (board.0 - other.0) * per_board,
            (board.1 - other.1) * per_board,
        );
        [board, ring]
    }

    /// Slip rates at a contact from unit (1, 2) accelerations at the other one, where `held`.
    #[inline(always)]
    fn coupling(&self, law: &Law<L>, which: usize, held: L::Mask) -> Matrix<L> {
        let (zero, one) = (law.zero, law.one);
        let first = self.by_other(which, Triple(zero, one, zero));
        let second = self.by_other(which, Triple(zero, zero, one));
        Matrix {
            a: first.0.when(held, zero),
            b: second.0.when(held, zero),
            c: first.1.when(held, zero),
            d: second.1.when(held, zero),
        }
    }

    #[inline(always)]
    fn rate(
        &self,
        law: &Law<L>,
        state: &State<L>,
        frictions: [(L, L); 2],
    ) -> (Rate<L>, [Triple<L>; 2]) {
        let [board, ring] = each!(which => {
            let (first, second) = frictions[which];
            self.response(which, Triple(self.normals[which], first, second))
        });
        let linear = board.0.plus(ring.0, law.one);
        let rate = Rate {
            velocity_m_s: state.velocity_m_s,
            acceleration_m_s2: Triple(linear.0, linear.1, linear.2 - law.gravity),
            spin_rate_rad_s2: board.1.plus(ring.1, law.one),
        };
        (rate, [board.0, ring.0])
    }
}

/// Two equations' coefficients, row by row.
struct Matrix<L> {
    a: L,
    b: L,
    c: L,
    d: L,
}

impl<L: Lane> Matrix<L> {
    #[inline(always)]
    fn times(&self, v: (L, L)) -> (L, L) {
        (self.a * v.0 + self.b * v.1, self.c * v.0 + self.d * v.1)
    }

    /// This after the other, times a factor.
    #[inline(always)]
    fn after(&self, first: &Self, factor: L) -> Self {
        Self {
            a: (self.a * first.a + self.b * first.c) * factor,
            b: (self.a * first.b + self.b * first.d) * factor,
            c: (self.c * first.a + self.d * first.c) * factor,
            d: (self.c * first.b + self.d * first.d) * factor,
        }
    }

    /// The solution; singular only where both contacts are one point, of which `own` then makes one
    /// do all.
    #[inline(always)]
    fn solve(&self, law: &Law<L>, right: (L, L), own: L) -> (L, L) {
        let determinant = self.a * self.d - self.b * self.c;
        let regular = law.zero.lt(determinant.abs());
        let per = law.one / determinant.when(regular, own);
        let over = (
            self.d * right.0 - self.b * right.1,
            self.a * right.1 - self.c * right.0,
        );
        let over = when(regular, over, right);
        (over.0 * per, over.1 * per)
    }
}

#[inline(always)]
fn dot<L: Lane>(a: Triple<L>, b: Triple<L>) -> L {
    a.0 * b.0 + a.1 * b.1 + a.2 * b.2
}

#[inline(always)]
fn times<L: Lane>(a: Triple<L>, factor: L) -> Triple<L> {
    Triple(a.0 * factor, a.1 * factor, a.2 * factor)
}

#[inline(always)]
fn minus<L: Lane>(a: (L, L)) -> (L, L) {
    (-a.0, -a.1)
}

#[inline(always)]
fn when<L: Lane>(mask: L::Mask, a: (L, L), b: (L, L)) -> (L, L) {
    (a.0.when(mask, b.0), a.1.when(mask, b.1))
}

/// The frictions `-limit * heading`.
#[inline(always)]
fn against<L: Lane>(limit: L, heading: (L, L)) -> (L, L) {
    (-(limit * heading.0), -(limit * heading.1))
}

/// Advances a ball in contact with board and ring by one step of at most `longest`.
#[inline(always)]
pub(crate) fn step<L: Lane>(
    law: &Law<L>,
    state: &mut State<L>,
    grips: &mut [Grip<L>; 2],
    longest: L,
) -> WedgeStep<L> {
    let start = *state;
    let mut pair = Pair::meet(law, state);
    let left = each!(i => contact::has_parted(law, &pair.touches[i]));
    let over = left[BOARD] | left[RING];
    let nothing = Triple(law.zero, law.zero, law.zero);
    if over.all() {
        return WedgeStep {
            dt: law.zero,
            left,
            impulses: [nothing; 2],
        };
    }

    // 1. Slips that have ended are taken out, by friction's own impulses.
    let stuck = each!(i => {
        let slip = pair.touches[i].slip();
        let slip_square = slip.0.squared() + slip.1.squared();
        grips[i].rolling | slip_square.le(grips[i].no_slip.squared())
    });
    let mut impulses = [nothing; 2];
    if (stuck[BOARD] | stuck[RING]).any() {
        impulses = stop_slips(law, state, &mut pair, stuck);
    }

    // 2. Which contacts roll: those that are stuck and whose friction is enough. One that is not
    //    enough slides, and the other is asked again.
    let slips = each!(i => pair.touches[i].slip());
    let speeds = each!(i => law.zero.when(stuck[i], size(slips[i])));
    let limits = each!(i => law.friction * pair.normals[i].most(law.zero));
    let mut rolling = each!(i => stuck[i] & !grips[i].spent);
    let mut failed = [law.zero.mask(false); 2];
    // Of a contact that does not roll: where it slips to, or would.
    let along = each!(i => {
        let drive = pair.driven(i, pair.press(law, 1 - i));
        let from = when(stuck[i], drive, slips[i]);
        let from_size = size(from);
        let some = law.zero.lt(from_size);
        let per_size = law.one / from_size.when(some, law.one);
        (from.0 * per_size, from.1 * per_size)
    });
    let sliding = each!(i => against(limits[i], along[i]));
    let mut frictions = pair.frictions(law, rolling, sliding);
    // Two contacts fail at most twice.
    loop {
        let [board, ring] = each!(i => {
            let beyond = size(frictions[i]) - limits[i];
            beyond.when(rolling[i], -law.never)
        });
        let worse = [ring.le(board), board.lt(ring)];
        let fails = [
            worse[BOARD] & law.zero.lt(board),
            worse[RING] & law.zero.lt(ring),
        ];
        if !(fails[BOARD] | fails[RING]).any() {
            break;
        }
        for i in [BOARD, RING] {
            rolling[i] = rolling[i] & !fails[i];
            failed[i] = failed[i] | fails[i];
        }
        frictions = pair.frictions(law, rolling, sliding);
    }

    // 3. The step ends at the first event of either contact.
    let (k1, push1) = pair.rate(law, state, frictions);
    let loads = each!(i => {
        let touch = &pair.touches[i];
        let acceleration = dot(pair.axes[i][0], k1.acceleration_m_s2) + touch.bending();
        Load::new(law, touch, pair.normals[i], acceleration)
    });
    let ends = each!(i => loads[i].time_to_end(law, &pair.touches[i]));
    let until = ends[BOARD].earlier(ends[RING]).within(law, longest);
    let changes = each!(i => {
        let (first, second) = frictions[1 - i];
        let drive = pair.driven(i, Triple(pair.normals[1 - i], first, second));
        let slip_per_push = pair.touches[i].slip_per_push(law);
        let forward = drive.0 * along[i].0 + drive.1 * along[i].1;
        // How what rolling needs will change is hard to foresee with two contacts; that of the limit is not.
        let spare = (limits[i] - size(frictions[i])).most(law.zero.lit(NO_FORCE_M_S2));
        let balance = Balance {
            speed: speeds[i],
            slip_rate: forward - limits[i] * slip_per_push,
            slip_per_push,
            spare,
            need_per_squeeze: law.zero,
        };
        time_to_change(law, &loads[i], rolling[i], balance)
    });
    let next = until.earlier(changes[BOARD]).earlier(changes[RING]);
    let dt = next.time().most(law.zero.lit(SHORTEST_S));

    // 4. RK4 in the modes that hold for the whole step.
    let mode = Mode {
        rolling,
        along,
        least: each!(i => speeds[i] * SLIP_DIRECTION_LOST),
    };
    let half = dt * 0.5;
    let (k2, push2) = stage(law, &state.advanced(&k1, half), mode);
    let (k3, push3) = stage(law, &state.advanced(&k2, half), mode);
    let (k4, push4) = stage(law, &state.advanced(&k3, dt), mode);
    let end = state.combined([&k1, &k2, &k3, &k4], dt);
    let (sixth, third) = (dt * (1.0 / 6.0), dt * (1.0 / 3.0));
    for i in [BOARD, RING] {
        impulses[i] = impulses[i]
            .plus(push1[i], sixth)
            .plus(push2[i], third)
            .plus(push3[i], third)
            .plus(push4[i], sixth);
        let landing = changes[i].not_after(next) & !rolling[i];
        let loading = law.zero.lt(loads[i].normal_rate);
        grips[i] = Grip {
            rolling: pick(over, grips[i].rolling, rolling[i]),
            spent: pick(
                over,
                grips[i].spent,
                (grips[i].spent | failed[i]) & !loading,
            ),
            no_slip: grips[i].no_slip.when(
                over,
                contact::left_over(law, landing, speeds[i], SLIP_ENDED_M_S),
            ),
        };
    }
    *state = start.when(over, end);
    WedgeStep {
        dt: law.zero.when(over, dt),
        left,
        impulses,
    }
}

/// How friction acts at both contacts throughout a step.
#[derive(Clone, Copy)]
struct Mode<L: Lane> {
    rolling: [L::Mask; 2],
    /// Direction of the slip at the start.
    along: [(L, L); 2],
    /// Forward slip below which that direction is kept.
    least: [L; 2],
}

/// The rate at one stage of a step, and what board and ring have in it.
#[inline(always)]
fn stage<L: Lane>(law: &Law<L>, state: &State<L>, mode: Mode<L>) -> (Rate<L>, [Triple<L>; 2]) {
    let pair = Pair::meet(law, state);
    let sliding = each!(i => {
        let limit = law.friction * pair.normals[i].most(law.zero);
        let (slip, along) = (pair.touches[i].slip(), mode.along[i]);
        let clear = mode.least[i].lt(slip.0 * along.0 + slip.1 * along.1);
        let per = law.one / size(slip).when(clear, law.one);
        against(limit, when(clear, (slip.0 * per, slip.1 * per), along))
    });
    pair.rate(law, state, pair.frictions(law, mode.rolling, sliding))
}

/// `a` where `mask` holds, `b` elsewhere.
#[inline(always)]
fn pick<M: Mask>(mask: M, a: M, b: M) -> M {
    (mask & a) | (!mask & b)
}

/// For how long both contacts have been rolled on without a break, after a step of `dt`.
#[inline(always)]
pub(crate) fn wedged<L: Lane>(law: &Law<L>, grips: &[Grip<L>; 2], before: L, dt: L) -> L {
    (before + dt).when(grips[BOARD].rolling & grips[RING].rolling, law.zero)
}

/// Takes out the slips of the stuck contacts together, and returns the impulses that did it.
#[inline(always)]
fn stop_slips<L: Lane>(
    law: &Law<L>,
    state: &mut State<L>,
    pair: &mut Pair<L>,
    stuck: [L::Mask; 2],
) -> [Triple<L>; 2] {
    let wanted = each!(i => {
        let nothing = (law.zero, law.zero);
        when(stuck[i], minus(pair.touches[i].slip()), nothing)
    });
    let kick = pair.solve(law, stuck, wanted);
    let impulses = each!(i => {
        let push = Triple(law.zero, kick[i].0, kick[i].1);
        let (linear, angular) = pair.response(i, push);
        state.velocity_m_s = state.velocity_m_s.plus(linear, law.one);
        state.spin_rad_s = state.spin_rad_s.plus(angular, law.one);
        linear
    });
    *pair = Pair::meet(law, state);
    impulses
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Physics;

    /// A ball on board and ring, moving and turning.
    fn pair() -> (Law, Pair<f64>) {
        let law = Law::new(&Physics::paper());
        let x = law.board_touch_x - 0.001;
        let off = law.ring_radius - (x * x + 0.01).sqrt();
        let state = State {
            position_m: Triple(x, 0.1, (law.radius.powi(2) - off * off).sqrt() - 0.001),
            velocity_m_s: Triple(-0.3, 0.2, -1.0),
            spin_rad_s: Triple(3.0, -2.0, 1.0),
        };
        let pair = Pair::meet(&law, &state);
        (law, pair)
    }

    #[test]
    fn prop_held_slips_change_as_wanted() {
        let (law, pair) = pair();
        let wanted = [(0.7, -0.4), (-0.2, 0.5)];
        for held in [[true, true], [true, false], [false, true], [false, false]] {
            let found = pair.solve(&law, held, wanted);
            for i in [BOARD, RING] {
                let push = |of: usize| Triple(0.0, found[of].0, found[of].1);
                let own = pair.slip_rate(i, pair.response(i, push(i)));
                let other = pair.by_other(i, push(1 - i));
                let expected = if held[i] {
                    (own.0 + other.0, own.1 + other.1)
                } else {
                    found[i]
                };
                assert!((expected.0 - wanted[i].0).abs() < 1e-12, "{held:?}");
                assert!((expected.1 - wanted[i].1).abs() < 1e-12, "{held:?}");
            }
        }
    }

    #[test]
    fn prop_a_singular_matrix_leaves_the_work_to_one_contact() {
        let law = Law::new(&Physics::paper());
        let [a, b, c, d] = [1.0, 2.0, 2.0, 4.0];
        assert_eq!(
            Matrix { a, b, c, d }.solve(&law, (3.0, 5.0), 2.0),
            (1.5, 2.5)
        );
    }
}
