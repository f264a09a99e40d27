"""What `bankshot.simulate` adds to the integrator's own time, and the memory that it takes.

python python/benches/simulate_many.py [SHOTS] [ROUNDS]

The integrator alone is `cargo run --release --example simulate_many`, on the same releases; both run in turn.
"""

import resource
import subprocess
import sys
import time
from pathlib import Path

import bankshot
import numpy as np

ROOT = Path(__file__).parents[2]


def releases(n):
    i = np.arange(n, dtype=float)

    def u(step, low, width):
        return low + width * ((i * step) % 1.0)

    return {
        "distance_ft": np.full(n, 13.75),
        "court_angle_deg": np.zeros(n),
        "release_height_ft": np.full(n, 7.0),
        "speed_ft_s": u(0.6180339887498949, 22.66, 5.15),
        "pitch_deg": u(0.7548776662466927, 40, 25),
        "polar_deg": u(0.5698402909980533, -3, 6),
        "backspin_rev_s": u(0.4142135623730951, 0, 5),
    }


def main():
    shots = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000_000
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    command = ["cargo", "run", "--release", "--quiet", "--example", "simulate_many", str(shots)]
    given = releases(shots)
    size = sum(array.nbytes for array in given.values())
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    for _ in range(rounds):
        alone = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
        kernel = float(alone.split()[-2])
        start = time.perf_counter()
        result = bankshot.simulate(given, physics="ncaa")
        whole = time.perf_counter() - start
        print(f"{alone.strip()}; package {whole:.3f} s, {result['made'].sum()} made: {whole / kernel:.3f}")
    size += sum(array.nbytes for name, array in result.items() if name not in given)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    # What was there before the call: the releases, NumPy and the interpreter.
    added = peak - before
    print(f"input and output {size / 1e6:.0f} MB, peak {peak / 1e6:.0f} MB ({added / 1e6:.0f} MB above the input)")


if __name__ == "__main__":
    main()
