"""Prints the bands of speed of the paper's Figs. 12 to 15, by a program that shares no code with bankshot.

    python3 tests/validation/paper_speed_bands.py [CASE ...] [--dt SECONDS]

It compiles benches/peers/paper_rk4.c (needs a C compiler) and simulates 3000 speeds per case at 52 deg,
0.002 ft/s apart, with uniform steps of 5e-6 s. One case takes about two minutes. The tests of
tests/validation/paper_figures.rs expect these bands. Bands of 0.03 ft/s or less are not listed, but they
count in the total.
"""

import argparse
import math
import pathlib
import subprocess
import tempfile

PEER = pathlib.Path(__file__).resolve().parents[2] / "benches" / "peers" / "paper_rk4.c"
FIRST, STEP, COUNT = 21.0, 0.002, 3000
LEAST_WIDTH = 0.03
# Damping, lb s/ft: the paper's, and the one for the restitution 0.8457 of its Appendix 1 (0.96194).
PAPER_DAMPING = 1.53
STIFFNESS, MASS = 2000.0, 21 / 16 / 32.2
DECREMENT = -math.log(0.8457) / math.pi
APPENDIX_1_DAMPING = 2 * math.sqrt(STIFFNESS * MASS) * DECREMENT / math.hypot(1, DECREMENT)

# Court angle (deg), polar angle (deg), backspin (rev/s).
FIGURES = {
    "12": (0.0, 0.0, 0.0),
    "13": (0.0, 0.0, 3.0),
    "14": (67.5, 67.5, 3.0),
    "15": (67.5, 62.107, 3.0),
}
CASES = {f"fig_{name}": (shot, PAPER_DAMPING) for name, shot in FIGURES.items()}
CASES |= {f"fig_{name}_restitution_0.8457": (shot, APPENDIX_1_DAMPING) for name, shot in FIGURES.items()}


def scan(program, shot, damping, dt):
    court, polar, backspin = shot
    releases = "\n".join(
        f"13.75 {court!r} 7.0 {FIRST + STEP * i!r} 52.0 {polar!r} {backspin!r}" for i in range(COUNT)
    )
    command = [program, repr(dt), repr(dt), repr(damping)]
    run = subprocess.run(command, input=releases, text=True, capture_output=True, check=True)
    return [verdict == "1" for verdict in run.stdout.strip()]


def bands(made):
    found, start = [], None
    for i, one in enumerate(made + [False]):
        if one and start is None:
            start = i
        elif not one and start is not None:
            found.append((FIRST + STEP * start, STEP * (i - start)))
            start = None
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("cases", nargs="*", metavar="CASE", help=f"of {', '.join(CASES)}; default: all")
    parser.add_argument("--dt", type=float, default=5e-6, help="step, s (default 5e-6)")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.cases if name not in CASES]
    if unknown:
        parser.error(f"unknown case {unknown[0]}; the cases are {', '.join(CASES)}")
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "paper_rk4"
        # No contraction of a * b + c, so that the bands do not depend on the machine.
        subprocess.run(["cc", "-O2", "-ffp-contract=off", "-o", program, PEER, "-lm"], check=True)
        for name in arguments.cases or CASES:
            shot, damping = CASES[name]
            made = scan(program, shot, damping, arguments.dt)
            print(f"{name}, steps of {arguments.dt:g} s: total {STEP * sum(made):.3f} ft/s")
            for start, width in bands(made):
                if width > LEAST_WIDTH:
                    print(f"    ({start:.3f}, {width:.3f}),", flush=True)


if __name__ == "__main__":
    main()
