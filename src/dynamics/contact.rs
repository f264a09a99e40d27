//! One contact: steps of RK4 that end on the events of friction.
//!
//! A bounce runs sliding, rolling, sliding and, where the normal force is negative just before
//! parting, frictionless. The force has a kink or a jump at each change, so a step never straddles
//! one: the times until the slip reaches zero, rolling needs more than mu N, N reaches zero and the
//! ball parts are predicted from the present derivatives, and the step is the shortest of them.
//!
//! Sliding is the paper's law (Eqs. 3 and 13). Rolling is its exact limit (a Filippov sliding mode;
//! the paper's Appendix 2 approaches it by chattering): the friction that keeps the slip zero.

use super::state::{Law, Rate, State, Triple};
use super::surface::{Surface, Touch};
use crate::lane::{Lane, Mask};

/// Slip below which the ball counts as not slipping, m/s.
const NO_SLIP_M_S: f64 = 1e-9;
/// Part of the slip, at the start of a step meant to end it, that may be left over; it is taken out by
/// friction's own impulse. (At 0.05 more
/// steps are taken and no better agreement was seen.)
const SLIP_LEFT: f64 = 0.2;
/// The same as a speed: what the shortest step at the strongest friction overshoots by, m/s.
const SLIP_ENDED_M_S: f64 = 2e-4;
/// In a step that ends the slip, stages with less than this part of it keep the direction of the
/// start: at zero slip the sliding law has none.
pub(crate) const SLIP_DIRECTION_LOST: f64 = 0.1;
/// Compression at which a ball moving away has parted, m: more where it moves fast, and the rest of
/// the way takes microseconds.
const PARTED_M: f64 = 1e-7;
const PARTED_FAST_M: f64 = 2e-5;
/// Speed away from the surface that counts as fast, m/s.
const FAST_M_S: f64 = 0.1;
/// Gap at which a surface that is being approached counts as touched, m.
pub(crate) const REACHED_M: f64 = 1e-7;
/// Normal acceleration that counts as zero, m/s^2 (a bounce reaches a thousand).
pub(crate) const NO_FORCE_M_S2: f64 = 0.5;
/// Steps that end a roll or the normal force go this part beyond the predicted time, so that the
/// next step is past the event and not, again and again, just before it.
const BEYOND: f64 = 1.03;
/// Shortest step, s.
pub(crate) const SHORTEST_S: f64 = 1e-9;

/// How friction acts at a contact, carried from step to step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grip<L: Lane = f64> {
    /// The ball rolls: the slip is and stays zero.
    pub(crate) rolling: L::Mask,
    /// Rolling needed more than mu N; the ball slides until N grows again (else it would flip
    /// between the two in tiny steps).
    pub(crate) spent: L::Mask,
    /// Slip that counts as none: what a step meant to end on zero slip may leave over, m/s.
    pub(crate) no_slip: L,
}

impl<L: Lane> Grip<L> {
    /// A contact that has just begun.
    #[inline(always)]
    pub(crate) fn fresh(law: &Law<L>) -> Self {
        let no = law.zero.mask(false);
        Self {
            rolling: no,
            spent: no,
            no_slip: law.zero.lit(NO_SLIP_M_S),
        }
    }
}

/// A time until an event, as a fraction: the earliest of several is found without dividing, which
/// costs as much as a dozen multiplications.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Due<L> {
    over: L,
    /// Positive.
    under: L,
}

impl<L: Lane> Due<L> {
    /// After `time`.
    #[inline(always)]
    fn after(law: &Law<L>, time: L) -> Self {
        Self {
            over: time,
            under: law.one,
        }
    }

    /// Not at all.
    #[inline(always)]
    pub(crate) fn never(law: &Law<L>) -> Self {
        Self::after(law, law.never)
    }

    #[inline(always)]
    pub(crate) fn when(self, mask: L::Mask, other: Self) -> Self {
        Self {
            over: self.over.when(mask, other.over),
            under: self.under.when(mask, other.under),
        }
    }

    /// Not after `other`.
    #[inline(always)]
    pub(crate) fn not_after(self, other: Self) -> L::Mask {
        (self.over * other.under).le(other.over * self.under)
    }

    #[inline(always)]
    pub(crate) fn earlier(self, other: Self) -> Self {
        self.when(self.not_after(other), other)
    }

    /// Or `longest`, if that is earlier.
    #[inline(always)]
    pub(crate) fn within(self, law: &Law<L>, longest: L) -> Self {
        let mask = self.over.le(longest * self.under);
        self.when(mask, Self::after(law, longest))
    }

    /// `factor` times as late.
    #[inline(always)]
    fn scaled(self, factor: L) -> Self {
        Self {
            over: self.over * factor,
            under: self.under,
        }
    }

    /// The time.
    #[inline(always)]
    pub(crate) fn time(self) -> L {
        self.over / self.under
    }
}

/// The smallest positive time at which `c0 + c1 t + c2 t^2/2` (with `c0 > 0`) reaches zero.
#[inline(always)]
pub(crate) fn first_root<L: Lane>(law: &Law<L>, c0: L, c1: L, c2: L) -> Due<L> {
    let discriminant = c1.squared() - c0 * c2 * 2.0;
    let slope = discriminant.most(law.zero).sqrt() - c1;
    let reaches = law.zero.le(discriminant) & law.zero.lt(slope);
    let root = Due {
        over: c0 * 2.0,
        under: slope,
    };
    root.when(reaches, Due::never(law))
}

/// As [`first_root`], or never where the time cannot be within `longest`: seldom needed, it is then
/// mostly not computed.
#[inline(always)]
pub(crate) fn first_root_within<L: Lane>(
    law: &Law<L>,
    (c0, c1, c2): (L, L, L),
    longest: L,
) -> Due<L> {
    let within = (c0 + longest * (c1 - c2.abs() * longest * 0.5)).le(law.zero);
    if !within.any() {
        return Due::never(law);
    }
    first_root(law, c0, c1, c2).when(within, Due::never(law))
}

/// Normal force of a contact and its first two derivatives (per unit of mass), with the
/// derivatives of the compression they come from.
pub(crate) struct Load<L> {
    pub(crate) normal: L,
    pub(crate) normal_rate: L,
    pub(crate) normal_curve: L,
    /// u''.
    pub(crate) squeeze_rate: L,
}

impl<L: Lane> Load<L> {
    /// `acceleration` is that of the centre along the normal, all forces and the turning of the
    /// frame included.
    #[inline(always)]
    pub(crate) fn new(law: &Law<L>, touch: &Touch<L>, normal: L, acceleration: L) -> Self {
        let squeeze_rate = -acceleration;
        let normal_rate = law.damping * squeeze_rate - law.stiffness * touch.v.0;
        let normal_curve = law.stiffness * squeeze_rate - law.damping * normal_rate;
        Self {
            normal,
            normal_rate,
            normal_curve,
            squeeze_rate,
        }
    }

    /// Time until the contact presses no more: until the normal force is zero (which that of a ball on its
    /// way out is before the compression is gone) and, where it is already or will not be, until the
    /// compression is gone.
    #[inline(always)]
    pub(crate) fn time_to_end(&self, law: &Law<L>, touch: &Touch<L>) -> Due<L> {
        let pressing = law.zero.lit(NO_FORCE_M_S2).lt(self.normal);
        let (u, du, ddu) = (
            touch.compression.most(law.zero),
            -touch.v.0,
            self.squeeze_rate,
        );
        // Has N + N' t + N'' t^2/2 a zero ahead?
        let real = (self.normal * self.normal_curve * 2.0).le(self.normal_rate.squared());
        let falls = self.normal_rate.lt(law.zero) | self.normal_curve.lt(law.zero);
        let releases = pressing & real & falls;
        let end = first_root(
            law,
            self.normal.when(releases, u),
            self.normal_rate.when(releases, du),
            self.normal_curve.when(releases, ddu),
        );
        let time = end.time();
        let found = time.lt(law.never) & !releases;
        // Of the compression, one Newton step on the Taylor polynomial with u''' = -N' and u'''' = -N''.
        let t = time.when(found, law.zero);
        let d3 = -self.normal_rate;
        let d4 = -self.normal_curve;
        let value = u + t * (du + t * (ddu * 0.5 + t * (d3 * (1.0 / 6.0) + t * d4 * (1.0 / 24.0))));
        let slope = du + t * (ddu + t * (d3 * 0.5 + t * d4 * (1.0 / 6.0)));
        let better = Due {
            over: value - t * slope,
            under: -slope,
        };
        let good = slope.lt(law.zero) & law.zero.lt(better.over) & found;
        // Not so far beyond the release that a ball with little damping would be past its parting.
        let beyond = (end.over * BEYOND).least(end.over + law.release_to_part * end.under);
        let release = Due {
            over: beyond.when(releases, end.over),
            under: end.under,
        };
        better.when(good, release)
    }
}

/// Slip that counts as none after a step: more (`ended`, or a part of the slip there was) where the
/// step was meant to land on zero.
#[inline(always)]
pub(crate) fn left_over<L: Lane>(law: &Law<L>, landing: L::Mask, speed: L, ended: f64) -> L {
    let landed = (speed * SLIP_LEFT).most(law.zero.lit(ended));
    landed.when(landing, law.zero.lit(NO_SLIP_M_S))
}

/// What one step at a contact did.
pub(crate) struct Step<L: Lane> {
    /// Time advanced, s.
    pub(crate) dt: L,
    /// The ball has left the surface (nothing was integrated).
    pub(crate) parted: L::Mask,
}

/// Rate of change under the normal and friction accelerations `push` given along (n, 1, 2).
#[inline(always)]
fn rate<L: Lane, S: Surface<L>>(
    law: &Law<L>,
    surface: S,
    state: &State<L>,
    (touch, frame): (&Touch<L>, S::Frame),
    push: Triple<L>,
) -> Rate<L> {
    let a = surface.to_space(frame, push);
    let twist = touch.lever * law.mass_over_inertia;
    let spin = surface.along_to_space(frame, (twist * push.2, -(twist * push.1)));
    Rate {
        velocity_m_s: state.velocity_m_s,
        acceleration_m_s2: Triple(a.0, a.1, a.2 - law.gravity),
        spin_rate_rad_s2: spin,
    }
}

/// Direction along which a sliding contact counts as slipping within one step.
#[derive(Clone, Copy)]
struct Heading<L> {
    along: (L, L),
    /// Forward slip below which `along` itself is used.
    least: L,
}

/// The rate at one stage of a step, in the mode that holds for the whole step.
#[inline(always)]
fn stage<L: Lane, S: Surface<L>>(
    law: &Law<L>,
    surface: S,
    state: &State<L>,
    rolling: L::Mask,
    heading: Heading<L>,
) -> Rate<L> {
    let (touch, frame) = surface.meet(law, state);
    let normal = touch.normal(law);
    let limit = law.friction * normal.most(law.zero);
    let (slip, along) = (touch.slip(), heading.along);
    let clear = heading.least.lt(slip.0 * along.0 + slip.1 * along.1);
    // Sliding, mu N slip/|slip|; rolling, what the slip would gain over what friction makes of it: in
    // one division.
    let mut over = (
        limit * slip.0.when(clear, along.0),
        limit * slip.1.when(clear, along.1),
    );
    let mut under = size(slip).when(clear, law.one);
    if rolling.any() {
        let drive = touch.drive();
        over = (drive.0.when(rolling, over.0), drive.1.when(rolling, over.1));
        under = touch.slip_per_push(law).when(rolling, under);
    }
    let back = -(law.one / under);
    rate(
        law,
        surface,
        state,
        (&touch, frame),
        Triple(normal, back * over.0, back * over.1),
    )
}

/// Length of a vector along the surface.
#[inline(always)]
pub(crate) fn size<L: Lane>(along: (L, L)) -> L {
    (along.0.squared() + along.1.squared()).sqrt()
}

/// Takes the slip out by friction's own impulse (angular momentum about the contact is kept).
#[inline(always)]
fn stop_slip<L: Lane, S: Surface<L>>(
    law: &Law<L>,
    surface: S,
    state: &mut State<L>,
    (touch, frame): (&mut Touch<L>, S::Frame),
    push_per_slip: L,
    stop: L::Mask,
) {
    let slip = touch.slip();
    let kick = (
        (-(push_per_slip * slip.0)).when(stop, law.zero),
        (-(push_per_slip * slip.1)).when(stop, law.zero),
    );
    let twist = touch.lever * law.mass_over_inertia;
    let turn = (twist * kick.1, -(twist * kick.0));
    touch.v = Triple(touch.v.0, touch.v.1 + kick.0, touch.v.2 + kick.1);
    touch.w = Triple(touch.w.0, touch.w.1 + turn.0, touch.w.2 + turn.1);
    let dv = surface.along_to_space(frame, kick);
    let dw = surface.along_to_space(frame, turn);
    state.velocity_m_s = state.velocity_m_s.plus(dv, law.one);
    state.spin_rad_s = state.spin_rad_s.plus(dw, law.one);
}

/// Advances the ball on `surface` by one step of at most `longest`, or finds that it has parted.
///
/// `other` gives, from the state and the acceleration, the time until something outside this
/// contact (the other surface) must end the step.
#[inline(always)]
pub(crate) fn step<L: Lane, S: Surface<L>>(
    law: &Law<L>,
    surface: S,
    state: &mut State<L>,
    grip: &mut Grip<L>,
    longest: L,
    other: impl FnOnce(&State<L>, Triple<L>) -> Due<L>,
) -> Step<L> {
    let (mut touch, frame) = surface.meet(law, state);
    let parted = has_parted(law, &touch);
    if parted.all() {
        settle_parting(law, surface, state, (&touch, frame), parted);
        return Step {
            dt: law.zero,
            parted,
        };
    }

    // 1. Where friction stands now.
    let slip = touch.slip();
    let slip_square = slip.0.squared() + slip.1.squared();
    let stuck = (grip.rolling | slip_square.le(grip.no_slip.squared())) & !parted;
    let slip_per_push = touch.slip_per_push(law);
    // Needed of stuck contacts only.
    let mut push_per_slip = law.one;
    if stuck.any() {
        push_per_slip = law.one / slip_per_push;
        stop_slip(
            law,
            surface,
            state,
            (&mut touch, frame),
            push_per_slip,
            stuck,
        );
    }
    let normal = touch.normal(law);
    let limit = law.friction * normal.most(law.zero);
    let load = Load::new(law, &touch, normal, normal + touch.g.0 + touch.bending());

    // 2. What drives the slip, or would; and the friction against it.
    let drive = touch.drive();
    let from = (drive.0.when(stuck, slip.0), drive.1.when(stuck, slip.1));
    let from_size = size(from);
    let some = law.zero.lt(from_size);
    let per_size = law.one / from_size.when(some, law.one);
    let along = (from.0 * per_size, from.1 * per_size);
    let need = push_per_slip * from_size;
    let fits = need.le(limit);
    let loading = law.zero.lt(load.normal_rate);
    let spent = (grip.spent | (stuck & !fits)) & !loading;
    let rolling = stuck & fits & !spent;
    let speed = law.zero.when(stuck, from_size);
    let heading = Heading {
        along,
        least: speed * SLIP_DIRECTION_LOST,
    };
    let back = -need.when(rolling, limit);

    // 3. The step ends at the first event.
    let to_end = load.time_to_end(law, &touch);
    let forward = drive.0 * along.0 + drive.1 * along.1;
    let to_change = time_to_change(
        law,
        &load,
        rolling,
        Balance {
            speed,
            slip_rate: forward - limit * slip_per_push,
            slip_per_push,
            spare: limit - need,
            need_per_squeeze: push_per_slip * touch.give(along),
        },
    );
    let k1 = rate(
        law,
        surface,
        state,
        (&touch, frame),
        Triple(normal, back * along.0, back * along.1),
    );
    let until = to_end
        .earlier(other(state, k1.acceleration_m_s2))
        .within(law, longest);
    let landing = to_change.not_after(until) & !rolling;
    let dt = to_change
        .earlier(until)
        .time()
        .most(law.zero.lit(SHORTEST_S));
    let no_slip = left_over(law, landing, speed, SLIP_ENDED_M_S);

    // 4. The classical RK4 step.
    let half = dt * 0.5;
    let k2 = stage(law, surface, &state.advanced(&k1, half), rolling, heading);
    let k3 = stage(law, surface, &state.advanced(&k2, half), rolling, heading);
    let k4 = stage(law, surface, &state.advanced(&k3, dt), rolling, heading);
    let next = state.combined([&k1, &k2, &k3, &k4], dt);

    if parted.any() {
        settle_parting(law, surface, state, (&touch, frame), parted);
    }
    *state = state.when(parted, next);
    *grip = Grip {
        rolling,
        spent,
        no_slip,
    };
    Step {
        dt: law.zero.when(parted, dt),
        parted,
    }
}

/// What decides when friction changes its law.
pub(crate) struct Balance<L> {
    /// Slip.
    pub(crate) speed: L,
    /// Its rate while it lasts.
    pub(crate) slip_rate: L,
    /// Rate of slip over the friction that makes it.
    pub(crate) slip_per_push: L,
    /// What friction could do beyond what rolling needs.
    pub(crate) spare: L,
    /// Rate of what rolling needs, over u''; what else changes it is slow.
    pub(crate) need_per_squeeze: L,
}

/// Time until friction changes its law: the slip reaches zero, or rolling needs more than mu N.
#[inline(always)]
pub(crate) fn time_to_change<L: Lane>(
    law: &Law<L>,
    load: &Load<L>,
    rolling: L::Mask,
    balance: Balance<L>,
) -> Due<L> {
    let limit_rate = law.friction * load.normal_rate;
    let slip_curve = -(limit_rate * balance.slip_per_push);
    let need_rate = balance.need_per_squeeze * load.squeeze_rate;
    let c0 = balance.spare.when(rolling, balance.speed);
    let c1 = (limit_rate - need_rate).when(rolling, balance.slip_rate);
    let c2 = (law.friction * load.normal_curve).when(rolling, slip_curve);
    let moving = law.zero.lt(c0) | rolling;
    first_root(law, c0, c1, c2)
        .scaled(law.zero.lit(BEYOND).when(rolling, law.one))
        .when(moving, Due::never(law))
}

/// Is the compression gone, but for what the parting's own step makes up?
#[inline(always)]
pub(crate) fn has_parted<L: Lane>(law: &Law<L>, touch: &Touch<L>) -> L::Mask {
    let fast = law.zero.lit(FAST_M_S).lt(touch.v.0);
    let gone = law
        .zero
        .lit(PARTED_FAST_M)
        .when(fast, law.zero.lit(PARTED_M));
    law.zero.lt(touch.v.0) & touch.compression.le(gone)
}

/// Moves a ball that has parted along its last stretch to (or back to) zero compression.
#[inline(always)]
fn settle_parting<L: Lane, S: Surface<L>>(
    law: &Law<L>,
    surface: S,
    state: &mut State<L>,
    (touch, frame): (&Touch<L>, S::Frame),
    parted: L::Mask,
) {
    let most = law.zero.lit(PARTED_FAST_M / FAST_M_S);
    let dt = (touch.compression / touch.v.0.when(parted, law.one))
        .least(most)
        .most(-most);
    let dt = dt.when(parted, law.zero);
    let push = Triple(touch.normal(law), law.zero, law.zero);
    let last = rate(law, surface, state, (touch, frame), push);
    *state = state.advanced(&last, dt);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Physics;
    use proptest::prelude::*;

    fn law() -> Law {
        Law::new(&Physics::paper())
    }

    proptest! {
        #[test]
        fn prop_the_earliest_fraction_is_the_earliest_time(
            a in (0.0..1.0, 1e-3..10.0),
            b in (0.0..1.0, 1e-3..10.0),
            longest in 1e-6..1.0,
        ) {
            let [a, b] = [a, b].map(|(over, under)| Due { over, under });
            let never = Due::never(&law());
            let close = |x: f64, y: f64| (x - y).abs() <= 1e-15 * y;
            prop_assert!(close(a.earlier(b).time(), a.time().min(b.time())));
            prop_assert!(close(never.earlier(b).time(), b.time()));
            prop_assert!(close(a.within(&law(), longest).time(), a.time().min(longest)));
        }

        #[test]
        fn prop_no_root_within_a_step_is_left_out(
            c0 in 1e-6..1.0, c1 in -10.0..10.0, c2 in -1e3..1e3, longest in 1e-4..1e-2,
        ) {
            let root = first_root(&law(), c0, c1, c2).time();
            let within = first_root_within(&law(), (c0, c1, c2), longest).time();
            if root <= longest {
                prop_assert_eq!(within, root);
            } else {
                prop_assert!(within > longest);
            }
            if root < law().never {
                let scale = c0 + (c1 * root).abs() + (c2 * root * root).abs();
                prop_assert!((c0 + c1 * root + 0.5 * c2 * root * root).abs() < 1e-12 * scale);
            }
        }
    }
}
