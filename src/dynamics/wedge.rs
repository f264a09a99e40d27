//! Board and ring at once: the rare double contact, in scalar form.
//!
//! The mechanics are those of the single contact, with both forces in one balance. Where both
//! contacts roll, their frictions are coupled: four linear equations say that both slips stay zero.

use super::contact::{
    self, Grip, Hold, Load, NO_FORCE_M_S2, SHORTEST_S, SLIP_DIRECTION_LOST, first_root,
};
use super::state::{Law, Rate, State, Triple};
use super::surface::{Board, Ring, Surface, Touch};
use nalgebra::{Matrix2, Vector2};

/// What one step in the wedge did.
pub(crate) struct WedgeStep {
    pub(crate) dt: f64,
    /// The board's contact is over; nothing was integrated.
    pub(crate) left_board: bool,
    /// The ring's contact is over; nothing was integrated.
    pub(crate) left_ring: bool,
    /// Impulses per unit of mass that board and ring gave, m/s.
    pub(crate) impulses: [Triple<f64>; 2],
}

/// Both contacts seen from one state.
struct Pair {
    touches: [Touch; 2],
    /// The directions (n, 1, 2) of each contact in space.
    axes: [[Triple<f64>; 3]; 2],
    /// Lever over the moment of inertia (per unit of mass).
    twists: [f64; 2],
    normals: [f64; 2],
}

/// Slip that counts as ended after a step meant to end it, m/s. The other contact's push turns the
/// slip as it dies away, so each such step leaves about half of it over.
const SLIP_ENDED_M_S: f64 = 1e-3;

const BOARD: usize = 0;
const RING: usize = 1;
const UNITS: [Triple<f64>; 3] = [
    Triple(1.0, 0.0, 0.0),
    Triple(0.0, 1.0, 0.0),
    Triple(0.0, 0.0, 1.0),
];

impl Pair {
    fn meet(law: &Law, state: &State) -> Self {
        let (board, ()) = Board.meet(law, state);
        let (ring, frame) = Ring.meet(law, state);
        let touches = [board, ring];
        Self {
            axes: [UNITS, UNITS.map(|unit| Ring.to_space(frame, unit))],
            twists: touches.map(|touch| touch.lever * law.mass_over_inertia),
            normals: touches.map(|touch| touch.normal(law)),
            touches,
        }
    }

    /// The slip rate that accelerations (linear, angular) of the ball give at a contact.
    fn slip_rate(&self, which: usize, (linear, angular): (Triple<f64>, Triple<f64>)) -> (f64, f64) {
        let [_, first, second] = self.axes[which];
        let lever = self.touches[which].lever;
        (
            dot(first, linear) - lever * dot(second, angular),
            dot(second, linear) + lever * dot(first, angular),
        )
    }

    /// Linear and angular acceleration of the ball from (n, 1, 2) accelerations at a contact.
    fn response(&self, which: usize, push: Triple<f64>) -> (Triple<f64>, Triple<f64>) {
        let [normal, first, second] = self.axes[which];
        let twist = self.twists[which];
        let nothing = Triple(0.0, 0.0, 0.0);
        (
            nothing
                .plus(normal, push.0)
                .plus(first, push.1)
                .plus(second, push.2),
            nothing
                .plus(first, twist * push.2)
                .plus(second, -(twist * push.1)),
        )
    }

    /// Slip rates at a contact with no friction there: drift, gravity, and the other contact's push.
    fn driven(&self, which: usize, other_push: Triple<f64>) -> (f64, f64) {
        let touch = &self.touches[which];
        let drift = touch.drift();
        let from_other = self.slip_rate(which, self.response(1 - which, other_push));
        (
            touch.g.1 + drift.0 + from_other.0,
            touch.g.2 + drift.1 + from_other.1,
        )
    }

    /// The push along the normal alone.
    fn press(&self, which: usize) -> Triple<f64> {
        Triple(self.normals[which], 0.0, 0.0)
    }

    /// Frictions at both contacts, `sliding` given where a contact slides.
    fn frictions(&self, rolling: [bool; 2], sliding: [(f64, f64); 2]) -> [(f64, f64); 2] {
        if rolling == [false, false] {
            return sliding;
        }
        let wanted = [BOARD, RING].map(|which| {
            if rolling[which] {
                let drive = self.driven(which, self.press(1 - which));
                (-drive.0, -drive.1)
            } else {
                sliding[which]
            }
        });
        self.solve(rolling, wanted)
    }

    /// The (1, 2) accelerations at both contacts that change the slips of the `held` contacts at the
    /// `wanted` rates; those of the other contacts are `wanted` themselves.
    ///
    /// A contact's own accelerations change its slip alike in both directions (1 + lever^2 m/I), so
    /// the four equations come down to two.
    fn solve(&self, held: [bool; 2], wanted: [(f64, f64); 2]) -> [(f64, f64); 2] {
        let [board, ring] = wanted.map(|(first, second)| Vector2::new(first, second));
        let own = [BOARD, RING].map(|i| 1.0 + self.touches[i].lever * self.twists[i]);
        let (board, ring) = match held {
            [false, false] => (board, ring),
            [true, false] => ((board - self.coupling(BOARD) * ring) / own[BOARD], ring),
            [false, true] => (board, (ring - self.coupling(RING) * board) / own[RING]),
            [true, true] => {
                let (on_board, on_ring) = (self.coupling(BOARD), self.coupling(RING));
                let matrix = Matrix2::identity() * own[RING] - on_ring * on_board / own[BOARD];
                let right = ring - on_ring * board / own[BOARD];
                // Singular only where both contacts are one point; then one of them serves.
                let ring = matrix
                    .try_inverse()
                    .map_or(right / own[RING], |inverse| inverse * right);
                ((board - on_board * ring) / own[BOARD], ring)
            }
        };
        [(board.x, board.y), (ring.x, ring.y)]
    }

    /// Slip rates at a contact from unit (1, 2) accelerations at the other one.
    fn coupling(&self, which: usize) -> Matrix2<f64> {
        let column = |unit| self.slip_rate(which, self.response(1 - which, unit));
        let (first, second) = (column(UNITS[1]), column(UNITS[2]));
        Matrix2::new(first.0, second.0, first.1, second.1)
    }

    fn rate(
        &self,
        law: &Law,
        state: &State,
        frictions: [(f64, f64); 2],
    ) -> (Rate, [Triple<f64>; 2]) {
        let mut pushes = [Triple(0.0, 0.0, 0.0); 2];
        let mut linear = Triple(0.0, 0.0, -law.gravity);
        let mut angular = Triple(0.0, 0.0, 0.0);
        for which in [BOARD, RING] {
            let push = Triple(self.normals[which], frictions[which].0, frictions[which].1);
            let (a, alpha) = self.response(which, push);
            pushes[which] = a;
            linear = linear.plus(a, 1.0);
            angular = angular.plus(alpha, 1.0);
        }
        let rate = Rate {
            velocity_m_s: state.velocity_m_s,
            acceleration_m_s2: linear,
            spin_rate_rad_s2: angular,
        };
        (rate, pushes)
    }
}

fn dot(a: Triple<f64>, b: Triple<f64>) -> f64 {
    a.0 * b.0 + a.1 * b.1 + a.2 * b.2
}

fn size(a: (f64, f64)) -> f64 {
    (a.0 * a.0 + a.1 * a.1).sqrt()
}

fn direction(slip: (f64, f64), along: (f64, f64), least: f64) -> (f64, f64) {
    if slip.0 * along.0 + slip.1 * along.1 > least {
        let per = 1.0 / size(slip);
        (slip.0 * per, slip.1 * per)
    } else {
        along
    }
}

/// Advances a ball in contact with board and ring by one step of at most `longest`.
pub(crate) fn step(law: &Law, state: &mut State, grips: &mut [Grip; 2], longest: f64) -> WedgeStep {
    let mut pair = Pair::meet(law, state);
    let left = pair.touches.map(|touch| contact::has_parted(law, &touch));
    let nothing = Triple(0.0, 0.0, 0.0);
    if left[BOARD] || left[RING] {
        return WedgeStep {
            dt: 0.0,
            left_board: left[BOARD],
            left_ring: left[RING],
            impulses: [nothing; 2],
        };
    }

    // 1. Slips that have ended are taken out, by friction's own impulses.
    let mut stuck = [false; 2];
    for which in [BOARD, RING] {
        let slip = pair.touches[which].slip();
        stuck[which] = grips[which].rolling || size(slip) <= grips[which].no_slip;
    }
    let mut impulses = stop_slips(law, state, &mut pair, stuck);

    // 2. Which contacts roll: those that are stuck and whose friction is enough. One that is not
    //    enough slides, and the other is asked again.
    let speeds = [BOARD, RING].map(|i| {
        if stuck[i] {
            0.0
        } else {
            size(pair.touches[i].slip())
        }
    });
    let limits = pair.normals.map(|n| law.friction * n.max(0.0));
    let mut rolling = [
        stuck[BOARD] && !grips[BOARD].spent,
        stuck[RING] && !grips[RING].spent,
    ];
    let mut along = [(0.0, 0.0); 2];
    let mut sliding = [(0.0, 0.0); 2];
    let mut failed = [false; 2];
    let frictions = loop {
        for which in [BOARD, RING] {
            if rolling[which] {
                continue;
            }
            let from = if stuck[which] {
                pair.driven(which, pair.press(1 - which))
            } else {
                pair.touches[which].slip()
            };
            let per = if size(from) > 0.0 {
                1.0 / size(from)
            } else {
                0.0
            };
            along[which] = (from.0 * per, from.1 * per);
            sliding[which] = (
                -limits[which] * along[which].0,
                -limits[which] * along[which].1,
            );
        }
        let frictions = pair.frictions(rolling, sliding);
        let over = [BOARD, RING].map(|i| {
            if rolling[i] {
                size(frictions[i]) - limits[i]
            } else {
                f64::NEG_INFINITY
            }
        });
        let worst = if over[BOARD] >= over[RING] {
            BOARD
        } else {
            RING
        };
        if over[worst] <= 0.0 {
            break frictions;
        }
        rolling[worst] = false;
        failed[worst] = true;
    };

    // 3. The step ends at the first event of either contact.
    let (k1, push1) = pair.rate(law, state, frictions);
    let mut until = longest;
    let mut to_change = [law.never; 2];
    let mut loading = [false; 2];
    for which in [BOARD, RING] {
        let touch = &pair.touches[which];
        let normal_axis = pair.axes[which][0];
        let acceleration = dot(normal_axis, k1.acceleration_m_s2) + touch.bending();
        let load = Load::new(law, touch, pair.normals[which], acceleration);
        until = until
            .min(load.time_to_part(law, touch))
            .min(load.time_to_release(law));
        loading[which] = load.normal_rate > 0.0;
        let other_push = Triple(
            pair.normals[1 - which],
            frictions[1 - which].0,
            frictions[1 - which].1,
        );
        let from_other = pair.slip_rate(which, pair.response(1 - which, other_push));
        let hold = Hold::new(
            law,
            touch,
            (touch.g.1 + from_other.0, touch.g.2 + from_other.1),
        );
        to_change[which] = if rolling[which] {
            let spare = limits[which] - hold.need_size;
            first_root(
                law,
                spare.max(NO_FORCE_M_S2),
                law.friction * load.normal_rate,
                0.0,
            )
        } else if speeds[which] > 0.0 {
            let per = 1.0 / hold.yielding;
            let rate =
                hold.drive.0 * along[which].0 + hold.drive.1 * along[which].1 - limits[which] * per;
            first_root(
                law,
                speeds[which],
                rate,
                -(law.friction * load.normal_rate * per),
            )
        } else {
            law.never
        };
    }
    let dt = until
        .min(to_change[BOARD])
        .min(to_change[RING])
        .max(SHORTEST_S);

    // 4. RK4 in the modes that hold for the whole step.
    let stage = |state: &State| {
        let pair = Pair::meet(law, state);
        let sliding = [BOARD, RING].map(|i| {
            let limit = law.friction * pair.normals[i].max(0.0);
            let heading = direction(
                pair.touches[i].slip(),
                along[i],
                SLIP_DIRECTION_LOST * speeds[i],
            );
            (-limit * heading.0, -limit * heading.1)
        });
        pair.rate(law, state, pair.frictions(rolling, sliding))
    };
    let (k2, push2) = stage(&state.advanced(&k1, 0.5 * dt));
    let (k3, push3) = stage(&state.advanced(&k2, 0.5 * dt));
    let (k4, push4) = stage(&state.advanced(&k3, dt));
    *state = state.combined([&k1, &k2, &k3, &k4], dt);
    for which in [BOARD, RING] {
        impulses[which] = impulses[which]
            .plus(push1[which], dt / 6.0)
            .plus(push2[which], dt / 3.0)
            .plus(push3[which], dt / 3.0)
            .plus(push4[which], dt / 6.0);
        let landing = !rolling[which] && to_change[which] <= dt;
        grips[which] = Grip {
            rolling: rolling[which],
            spent: (grips[which].spent || failed[which]) && !loading[which],
            no_slip: contact::left_over(law, landing, speeds[which], SLIP_ENDED_M_S),
        };
    }
    WedgeStep {
        dt,
        left_board: false,
        left_ring: false,
        impulses,
    }
}

/// Takes out the slips of the stuck contacts together, and returns the impulses that did it.
fn stop_slips(law: &Law, state: &mut State, pair: &mut Pair, stuck: [bool; 2]) -> [Triple<f64>; 2] {
    let nothing = Triple(0.0, 0.0, 0.0);
    let mut impulses = [nothing; 2];
    if stuck == [false, false] {
        return impulses;
    }
    let wanted = [BOARD, RING].map(|which| {
        let slip = pair.touches[which].slip();
        if stuck[which] {
            (-slip.0, -slip.1)
        } else {
            (0.0, 0.0)
        }
    });
    let kick = pair.solve(stuck, wanted);
    for which in [BOARD, RING] {
        if stuck[which] {
            let push = Triple(0.0, kick[which].0, kick[which].1);
            let (linear, angular) = pair.response(which, push);
            state.velocity_m_s = state.velocity_m_s.plus(linear, 1.0);
            state.spin_rad_s = state.spin_rad_s.plus(angular, 1.0);
            impulses[which] = linear;
        }
    }
    *pair = Pair::meet(law, state);
    impulses
}
