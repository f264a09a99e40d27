//! Board and ring at once: the rare double contact, in scalar form.
//!
//! The mechanics are those of the single contact, with both forces in one balance. Where both
//! contacts roll, their frictions are coupled: four linear equations say that both slips stay zero.

use super::contact::{
    self, Grip, Hold, Load, NO_FORCE_M_S2, SHORTEST_S, SLIP_DIRECTION_LOST, first_root,
};
use super::state::{Law, Rate, State, Triple};
use super::surface::{Board, Ring, Surface, Touch};
use nalgebra::{Matrix4, Vector4};

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

type RingFrame = <Ring as Surface<f64>>::Frame;

/// Both contacts seen from one state.
struct Pair {
    touches: [Touch; 2],
    frame: RingFrame,
    normals: [f64; 2],
}

const BOARD: usize = 0;
const RING: usize = 1;
/// The directions along the surface, in the frame of a contact.
const UNITS: [Triple<f64>; 2] = [Triple(0.0, 1.0, 0.0), Triple(0.0, 0.0, 1.0)];

impl Pair {
    fn meet(law: &Law, state: &State) -> Self {
        let (board, ()) = Board.meet(law, state);
        let (ring, frame) = Ring.meet(law, state);
        let normals = [board.normal(law), ring.normal(law)];
        Self {
            touches: [board, ring],
            frame,
            normals,
        }
    }

    fn to_space(&self, which: usize, vector: Triple<f64>) -> Triple<f64> {
        if which == BOARD {
            Board.to_space((), vector)
        } else {
            Ring.to_space(self.frame, vector)
        }
    }

    /// The slip rate that unit accelerations (linear, angular) of the ball give at a contact.
    fn slip_rate(&self, which: usize, linear: Triple<f64>, angular: Triple<f64>) -> (f64, f64) {
        let axes = UNITS.map(|unit| self.to_space(which, unit));
        let lever = self.touches[which].lever;
        (
            dot(axes[0], linear) - lever * dot(axes[1], angular),
            dot(axes[1], linear) + lever * dot(axes[0], angular),
        )
    }

    /// Linear and angular acceleration of the ball from (n, 1, 2) accelerations at a contact.
    fn response(&self, law: &Law, which: usize, push: Triple<f64>) -> (Triple<f64>, Triple<f64>) {
        let twist = self.touches[which].lever * law.mass_over_inertia;
        let spin = Triple(0.0, twist * push.2, -(twist * push.1));
        (self.to_space(which, push), self.to_space(which, spin))
    }

    /// Slip rates at a contact with no friction there: drift, gravity, and the other contact's push.
    fn driven(&self, law: &Law, which: usize, other_push: Triple<f64>) -> (f64, f64) {
        let touch = &self.touches[which];
        let drift = touch.drift();
        let (linear, angular) = self.response(law, 1 - which, other_push);
        let from_other = self.slip_rate(which, linear, angular);
        (
            touch.g.1 + drift.0 + from_other.0,
            touch.g.2 + drift.1 + from_other.1,
        )
    }

    /// Frictions at both contacts, `sliding` given where a contact slides.
    fn frictions(
        &self,
        law: &Law,
        rolling: [bool; 2],
        sliding: [(f64, f64); 2],
    ) -> [(f64, f64); 2] {
        if rolling == [false, false] {
            return sliding;
        }
        let wanted = [BOARD, RING].map(|which| {
            if rolling[which] {
                let drive = self.driven(law, which, Triple(self.normals[1 - which], 0.0, 0.0));
                (-drive.0, -drive.1)
            } else {
                sliding[which]
            }
        });
        self.solve(law, rolling, wanted)
    }

    /// The (1, 2) accelerations at both contacts that change the slips of the `held` contacts at the
    /// `wanted` rates; those of the other contacts are `wanted` themselves.
    fn solve(&self, law: &Law, held: [bool; 2], wanted: [(f64, f64); 2]) -> [(f64, f64); 2] {
        let mut matrix = Matrix4::<f64>::identity();
        let right = Vector4::new(wanted[0].0, wanted[0].1, wanted[1].0, wanted[1].1);
        for which in [BOARD, RING].into_iter().filter(|&which| held[which]) {
            for (column, unit) in UNITS.iter().cycle().take(4).enumerate() {
                let (linear, angular) = self.response(law, column / 2, *unit);
                let rate = self.slip_rate(which, linear, angular);
                matrix[(2 * which, column)] = rate.0;
                matrix[(2 * which + 1, column)] = rate.1;
            }
        }
        // Singular only where both contacts are one point; then friction at one of them serves.
        let solved = matrix.lu().solve(&right).unwrap_or(right);
        [(solved[0], solved[1]), (solved[2], solved[3])]
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
            let (a, alpha) = self.response(law, which, push);
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
                pair.driven(law, which, Triple(pair.normals[1 - which], 0.0, 0.0))
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
        let frictions = pair.frictions(law, rolling, sliding);
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
        let normal_axis = pair.to_space(which, Triple(1.0, 0.0, 0.0));
        let acceleration = dot(normal_axis, k1.acceleration_m_s2) + touch.bending();
        let load = Load::new(law, touch, pair.normals[which], acceleration);
        until = until
            .min(load.time_to_part(law, touch))
            .min(load.time_to_release(law));
        loading[which] = load.normal_rate > 0.0;
        let (linear, angular) = pair.response(
            law,
            1 - which,
            Triple(
                pair.normals[1 - which],
                frictions[1 - which].0,
                frictions[1 - which].1,
            ),
        );
        let from_other = pair.slip_rate(which, linear, angular);
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
        pair.rate(law, state, pair.frictions(law, rolling, sliding))
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
            no_slip: contact::left_over(law, landing, speeds[which]),
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
    let kick = pair.solve(law, stuck, wanted);
    for which in [BOARD, RING] {
        if stuck[which] {
            let push = Triple(0.0, kick[which].0, kick[which].1);
            let (linear, angular) = pair.response(law, which, push);
            state.velocity_m_s = state.velocity_m_s.plus(linear, 1.0);
            state.spin_rad_s = state.spin_rad_s.plus(angular, 1.0);
            impulses[which] = linear;
        }
    }
    *pair = Pair::meet(law, state);
    impulses
}
