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

/// The smallest positive time at which `c0 + c1 t + c2 t^2/2` (with `c0 > 0`) reaches zero.
#[inline(always)]
pub(crate) fn first_root<L: Lane>(law: &Law<L>, c0: L, c1: L, c2: L) -> L {
    let discriminant = c1.squared() - c0 * c2 * 2.0;
    let slope = discriminant.most(law.zero).sqrt() - c1;
    let reaches = law.zero.le(discriminant) & law.zero.lt(slope);
    (c0 * 2.0 / slope.when(reaches, law.one)).when(reaches, law.never)
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

    /// Time until the compression is gone.
    #[inline(always)]
    pub(crate) fn time_to_part(&self, law: &Law<L>, touch: &Touch<L>) -> L {
        let (u, du, ddu) = (
            touch.compression.most(law.zero),
            -touch.v.0,
            self.squeeze_rate,
        );
        let guess = first_root(law, u, du, ddu);
        let found = guess.lt(law.never);
        // One Newton step on the Taylor polynomial with u''' = -N' and u'''' = -N''.
        let t = guess.when(found, law.zero);
        let d3 = -self.normal_rate;
        let d4 = -self.normal_curve;
        let value = u + t * (du + t * (ddu * 0.5 + t * (d3 * (1.0 / 6.0) + t * d4 * (1.0 / 24.0))));
        let slope = du + t * (ddu + t * (d3 * 0.5 + t * d4 * (1.0 / 6.0)));
        let falling = slope.lt(law.zero) & found;
        let better = t - value / slope.when(falling, law.one);
        let good = falling & law.zero.lt(better);
        better.when(good, guess)
    }

    /// Time until the normal force is zero, for a contact that still presses.
    #[inline(always)]
    pub(crate) fn time_to_release(&self, law: &Law<L>) -> L {
        let pressing = law.zero.lit(NO_FORCE_M_S2).lt(self.normal);
        let time = first_root(law, self.normal, self.normal_rate, self.normal_curve);
        (time * BEYOND).when(pressing, law.never)
    }
}

/// What friction must do to hold the contact point still, and what it is driven by.
pub(crate) struct Hold<L> {
    /// Rate of the slip without friction.
    pub(crate) drive: (L, L),
    /// Friction (per unit of mass) that keeps zero slip at zero.
    pub(crate) need: (L, L),
    pub(crate) need_size: L,
    /// Friction over the rate of slip it makes: 1/(1 + lever^2 m/I).
    pub(crate) yielding: L,
}

impl<L: Lane> Hold<L> {
    /// `push` is the acceleration along (1, 2) from everything but this contact's friction.
    #[inline(always)]
    pub(crate) fn new(law: &Law<L>, touch: &Touch<L>, push: (L, L)) -> Self {
        let drift = touch.drift();
        let yielding = law.one / (touch.lever.squared() * law.mass_over_inertia + 1.0);
        let drive = (push.0 + drift.0, push.1 + drift.1);
        let need = (-(yielding * drive.0), -(yielding * drive.1));
        let need_size = (need.0.squared() + need.1.squared()).sqrt();
        Self {
            drive,
            need,
            need_size,
            yielding,
        }
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
    let spin = surface.to_space(frame, Triple(law.zero, twist * push.2, -(twist * push.1)));
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

impl<L: Lane> Heading<L> {
    #[inline(always)]
    fn of(self, law: &Law<L>, slip: (L, L)) -> (L, L) {
        let forward = slip.0 * self.along.0 + slip.1 * self.along.1;
        let clear = self.least.lt(forward);
        let size = (slip.0.squared() + slip.1.squared()).sqrt();
        let per_size = law.one / size.when(clear, law.one);
        (
            (slip.0 * per_size).when(clear, self.along.0),
            (slip.1 * per_size).when(clear, self.along.1),
        )
    }
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
    let direction = heading.of(law, touch.slip());
    let mut friction = (-(limit * direction.0), -(limit * direction.1));
    if rolling.any() {
        let drift = touch.drift();
        let yielding = law.one / (touch.lever.squared() * law.mass_over_inertia + 1.0);
        friction = (
            (-(yielding * (touch.g.1 + drift.0))).when(rolling, friction.0),
            (-(yielding * (touch.g.2 + drift.1))).when(rolling, friction.1),
        );
    }
    rate(
        law,
        surface,
        state,
        (&touch, frame),
        Triple(normal, friction.0, friction.1),
    )
}

/// Takes the slip out by friction's own impulse (angular momentum about the contact is kept).
#[inline(always)]
fn stop_slip<L: Lane, S: Surface<L>>(
    law: &Law<L>,
    surface: S,
    state: &mut State<L>,
    (touch, frame): (&mut Touch<L>, S::Frame),
    stop: L::Mask,
) {
    let slip = touch.slip();
    let yielding = law.one / (touch.lever.squared() * law.mass_over_inertia + 1.0);
    let kick = (
        (-(yielding * slip.0)).when(stop, law.zero),
        (-(yielding * slip.1)).when(stop, law.zero),
    );
    let twist = touch.lever * law.mass_over_inertia;
    let dv = Triple(law.zero, kick.0, kick.1);
    let dw = Triple(law.zero, twist * kick.1, -(twist * kick.0));
    touch.v = touch.v.plus(dv, law.one);
    touch.w = touch.w.plus(dw, law.one);
    state.velocity_m_s = state
        .velocity_m_s
        .plus(surface.to_space(frame, dv), law.one);
    state.spin_rad_s = state.spin_rad_s.plus(surface.to_space(frame, dw), law.one);
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
    other: impl FnOnce(&State<L>, Triple<L>) -> L,
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
    let speed = (slip.0.squared() + slip.1.squared()).sqrt();
    let stuck = grip.rolling | speed.le(grip.no_slip);
    if stuck.any() {
        stop_slip(law, surface, state, (&mut touch, frame), stuck);
    }
    let speed = law.zero.when(stuck, speed);
    let normal = touch.normal(law);
    let limit = law.friction * normal.most(law.zero);
    let hold = Hold::new(law, &touch, (touch.g.1, touch.g.2));
    let load = Load::new(law, &touch, normal, normal + touch.g.0 + touch.bending());
    let fits = hold.need_size.le(limit);
    let loading = law.zero.lt(load.normal_rate);
    let spent = (grip.spent | (stuck & !fits)) & !loading;
    let rolling = stuck & fits & !spent;

    // 2. The friction, and the direction of slip for this step.
    let from = (
        hold.drive.0.when(stuck, slip.0),
        hold.drive.1.when(stuck, slip.1),
    );
    let size = (from.0.squared() + from.1.squared()).sqrt();
    let some = law.zero.lt(size);
    let per_size = law.one / size.when(some, law.one);
    let along = (from.0 * per_size, from.1 * per_size);
    let heading = Heading {
        along,
        least: speed * SLIP_DIRECTION_LOST,
    };
    let friction = (
        hold.need.0.when(rolling, -(limit * along.0)),
        hold.need.1.when(rolling, -(limit * along.1)),
    );

    // 3. The step ends at the first event.
    let to_part = load.time_to_part(law, &touch);
    let to_release = load.time_to_release(law);
    let give = (
        touch.bend_1 * touch.v.1 + touch.w.2,
        touch.bend_2 * touch.v.2 - touch.w.1,
    );
    let to_change = time_to_change(law, &hold, &load, (rolling, speed, limit), along, give);
    let k1 = rate(
        law,
        surface,
        state,
        (&touch, frame),
        Triple(normal, friction.0, friction.1),
    );
    let to_other = other(state, k1.acceleration_m_s2);
    let until = to_part.least(to_release).least(to_other).least(longest);
    let dt = until.least(to_change).most(law.zero.lit(SHORTEST_S));
    let landing = to_change.le(until) & !rolling;
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

/// Time until friction changes its law: the slip reaches zero, or rolling needs more than mu N.
#[inline(always)]
fn time_to_change<L: Lane>(
    law: &Law<L>,
    hold: &Hold<L>,
    load: &Load<L>,
    (rolling, speed, limit): (L::Mask, L, L),
    along: (L, L),
    give: (L, L),
) -> L {
    let per_yielding = law.one / hold.yielding;
    let slip_rate = hold.drive.0 * along.0 + hold.drive.1 * along.1 - limit * per_yielding;
    let slip_curve = -(law.friction * load.normal_rate * per_yielding);
    // While rolling, what is needed changes mainly because the normal velocity does.
    let some = law.zero.lt(hold.need_size);
    let per_need = law.one / hold.need_size.when(some, law.one);
    let need_rate = -(hold.yielding
        * load.squeeze_rate
        * (hold.need.0 * give.0 + hold.need.1 * give.1)
        * per_need);
    let c0 = (limit - hold.need_size).when(rolling, speed);
    let c1 = (law.friction * load.normal_rate - need_rate).when(rolling, slip_rate);
    let c2 = (law.friction * load.normal_curve).when(rolling, slip_curve);
    let moving = law.zero.lt(c0) | rolling;
    let time = first_root(law, c0, c1, c2).when(moving, law.never);
    time * law.zero.lit(BEYOND).when(rolling, law.one)
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
