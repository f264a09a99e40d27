"""Compares the speed and the agreement of bankshot, the paper's RK4 in C, and SciPy's solve_ivp.

    cargo build --release && python3 benches/peers/compare.py [SHOTS]

Needs a C compiler and Python with numpy and scipy. All programs simulate the same shots. The reference is
bankshot with 400 steps per contact. The C program with tiny steps shares no code with bankshot, so its
agreement checks the reference.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.integrate import solve_ivp

HERE = pathlib.Path(__file__).parent
BANKSHOT = HERE.parent.parent / "target" / "release" / "bankshot"
COLUMNS = [
    "distance_ft",
    "court_angle_deg",
    "release_height_ft",
    "speed_ft_s",
    "pitch_deg",
    "polar_deg",
    "backspin_rev_s",
]

# Units of the paper: ft, s, slug.
G, MASS, K, C, MU = 32.2, 21 / 16 / 32.2, 2000.0, 1.53, 1.0
# Slip speed below which friction is smoothed, ft/s.
SMOOTH = 0.1
RADIUS, RING, FACE = 29.75 / (24 * np.pi), (9 + 5 / 16) / 12, -1.25


def free_throw_uniform(count):
    """Uniform releases from the free-throw line, as in benches/shots.rs, but with another seed."""
    random = np.random.default_rng(20260101)
    low = [13.75, 0, 7, 22, 40, -3, 0]
    high = [13.75, 0, 7, 27, 65, 3, 5]
    return random.uniform(low, high, (count, 7))


def bankshot(releases, folder, physics=None):
    """Which shots are made, and the shots per second, by bankshot."""
    source, target = folder / "releases.csv", folder / "outcomes.csv"
    with open(source, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        writer.writerows([[repr(float(x)) for x in row] for row in releases])
    command = [BANKSHOT, "simulate", source, "-o", target, "-q", "--threads", "1"]
    if physics:
        command += ["--physics", physics]
    began = time.perf_counter()
    subprocess.run(command, check=True)
    seconds = time.perf_counter() - began
    with open(target, newline="") as file:
        made = np.array([row["made"] in ("true", "1") for row in csv.DictReader(file)])
    return made, len(releases) / seconds


def paper_rk4(releases, program, dt_max, dt_min):
    """The same by the C program."""
    text = "\n".join(" ".join(repr(float(x)) for x in row) for row in releases)
    command = [program, str(dt_max), str(dt_min)]
    run = subprocess.run(command, input=text, text=True, capture_output=True, check=True)
    return np.array([c == "1" for c in run.stdout.strip()]), float(run.stderr)


def contact(v, w, normal, compression):
    """Acceleration and angular acceleration by one contact."""
    lever = RADIUS - compression
    speed = v @ normal
    force = (K * compression - C * speed) / MASS
    arm = -lever * normal
    slip = v - speed * normal + np.cross(w, arm)
    # Without the smoothing, the step size collapses when the slip approaches zero.
    friction = -MU * max(force, 0) * slip / max(np.linalg.norm(slip), SMOOTH)
    return force * normal + friction, np.cross(arm, friction) / (2 / 3 * RADIUS**2)


def on_board(p):
    """Whether a ball at this position compresses the board."""
    return FACE < p[0] < FACE + RADIUS and abs(p[1]) < 3 and -0.5 < p[2] < 3


def rate(_, s):
    """Rate of the state: position, velocity, angular velocity."""
    p, v, w = s[:3], s[3:6], s[6:9]
    a, alpha = np.array([0, 0, -G]), np.zeros(3)
    if on_board(p):
        push, turn = contact(v, w, np.array([1.0, 0, 0]), FACE + RADIUS - p[0])
        a, alpha = a + push, alpha + turn
    axis = np.hypot(p[0], p[1])
    lever = np.hypot(RING - axis, p[2])
    if lever < RADIUS:
        inward = (RING - axis) / axis
        push, turn = contact(v, w, np.array([-inward * p[0], -inward * p[1], p[2]]) / lever, RADIUS - lever)
        a, alpha = a + push, alpha + turn
    return np.concatenate([v, a, alpha])


def below(_, s):
    """Zero where the ball falls below the ring; the shot ends there."""
    return s[2] + RADIUS


def plane(_, s):
    """Zero where the ball rises through the plane of the hoop."""
    return s[2]


below.terminal, below.direction, plane.direction = True, -1, 1


def scipy_shot(release, tolerance, longest):
    """Whether a shot is made, by SciPy."""
    d, _, height, speed, pitch, polar, spin = release
    pitch, polar, w = np.radians(pitch), np.radians(polar), 2 * np.pi * spin
    level = speed * np.cos(pitch)
    position = [d, 0, height - 10]
    velocity = [-level * np.cos(polar), -level * np.sin(polar), speed * np.sin(pitch)]
    angular_velocity = [-w * np.sin(polar), w * np.cos(polar), 0]
    start = position + velocity + angular_velocity
    settings = {"rtol": tolerance, "atol": tolerance, "max_step": longest}
    run = solve_ivp(rate, (0, 10), start, events=[below, plane], **settings)
    rises = list(run.y_events[1])
    if len(run.y_events[0]) == 0 or not rises:
        return False
    end = run.y_events[0][-1]
    return bool(np.hypot(end[0], end[1]) < RING and all(np.hypot(s[0], s[1]) >= RING for s in rises))


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20000
    releases = free_throw_uniform(count)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        tiny = folder / "tiny.toml"
        tiny.write_text('[physics]\npreset = "paper"\nintegrator = "exact"\nsteps_per_contact = 400\n')
        truth, _ = bankshot(releases, folder, tiny)
        program = folder / "paper_rk4"
        flags = ["-O3", "-march=native", "-ffast-math"]
        subprocess.run(["cc", *flags, "-o", program, HERE / "paper_rk4.c", "-lm"], check=True)
        print(f"free_throw_uniform, {count} shots, {truth.mean():.3f} made, one thread")

        def show(label, made, per_second):
            agree = (made == truth[: len(made)]).mean()
            print(f"{label:34} {per_second:12,.0f} shots/s   {100 * agree:7.3f} % agree")

        show("bankshot simulate (files included)", *bankshot(releases, folder))
        for dt_min in (0.0005, 0.0001, 0.00005):
            show(f"paper's RK4 in C, 15/{1000 * dt_min:g} ms", *paper_rk4(releases, program, 0.015, dt_min))
        show("the same, 0.05/0.005 ms, 2000 shots", *paper_rk4(releases[:2000], program, 0.00005, 0.000005))
        tolerance, longest, few = 1e-6, 0.01, releases[:50]
        began = time.perf_counter()
        made = np.array([scipy_shot(release, tolerance, longest) for release in few])
        per_second = len(few) / (time.perf_counter() - began)
        show(f"SciPy RK45, {tolerance:g}, {1000 * longest:g} ms, 50 shots", made, per_second)


if __name__ == "__main__":
    main()
