"""Pictures of results with matplotlib, in the look of the report.

Each function draws on ``ax`` (a new figure without it) and returns it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._measured import Advice, Estimate, Fit
from ._shots import BestShots, Trace
from ._sweep import Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# The colours of the report: made and direct, missed and bank, and the hoop.
_BLUE, _ORANGE, _INK, _GREY = "#3b6fb6", "#d9822b", "#222222", "#9a9a9a"
_RING_RADIUS_FT = 0.75


def _axes(ax: Axes | None, **options: Any) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    made: Axes = plt.subplots(layout="constrained", **options)[1]
    made.spines[["top", "right"]].set_visible(False)
    return made


def _feet(columns: Any, name: str) -> Any:
    """A length of a result in feet, whatever its unit."""
    import numpy as np

    if f"{name}_ft" in columns:
        return np.asarray(columns[f"{name}_ft"], dtype=float)
    return np.asarray(columns[f"{name}_m"], dtype=float) / 0.3048


def path(trace: Trace, ax: Axes | None = None) -> Axes:
    """The path of a shot from the side, with the ring."""
    ax = _axes(ax, figsize=(7, 4))
    x = _feet(trace.path, "x")
    z = _feet(trace.path, "z_above_ring")
    ax.plot(x, z, color=_BLUE if trace.made else _ORANGE, label=trace.kind)
    ax.plot([-_RING_RADIUS_FT, _RING_RADIUS_FT], [0, 0], color=_ORANGE, lw=4, solid_capstyle="round")
    ax.set(xlabel="from the hoop's centre (ft)", ylabel="above the ring (ft)")
    ax.set_aspect("equal")
    ax.invert_xaxis()
    ax.legend(frameon=False)
    return ax


def make_zone(fit: Fit, points: int = 160, ax: Axes | None = None) -> Axes:
    """The make zone of a shooter: the speeds and pitch angles with which an otherwise average shot goes in,
    and the measured shots, those that were made filled.

    ``points`` is the number of simulated shots along each axis.
    """
    import csv

    import numpy as np

    from ._simulate import simulate

    with open(fit.folder / "shots.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    unit = "ft_s" if "speed_ft_s" in rows[0] else "m_s"
    speed = np.array([float(row[f"speed_{unit}"]) for row in rows])
    pitch = np.array([float(row["pitch_deg"]) for row in rows])
    made = np.array([row.get("made", "") == "1" for row in rows])
    profile = fit.profile
    usual = fit.parameters
    speeds = np.linspace(speed.min() - 0.2, speed.max() + 0.2, points)
    pitches = np.linspace(pitch.min() - 1, pitch.max() + 1, points)
    grid = np.meshgrid(speeds, pitches)
    same = np.ones(points * points)
    shots = {
        "distance_m": profile.distance_m * same,
        "court_angle_rad": profile.angle_rad * same,
        "release_height_m": profile.release_height_m * same,
        f"speed_{unit}": grid[0].ravel(),
        "pitch_deg": grid[1].ravel(),
        "polar_deg": usual["polar_mean"].mean * same,
        "backspin_rev_s": usual["backspin_mean"].mean * same,
    }
    goes_in = simulate(shots, physics=profile.physics)["made"].reshape(points, points)
    ax = _axes(ax, figsize=(6, 4.5))
    ax.contourf(speeds, pitches, goes_in, levels=[0.5, 1.5], colors=["#cfe0f3"])
    ax.scatter(speed[made], pitch[made], s=18, color=_BLUE, label="made")
    ax.scatter(speed[~made], pitch[~made], s=18, edgecolor=_INK, facecolor="none", label="missed")
    ax.set(xlabel=f"speed ({unit.replace('_', '/')})", ylabel="pitch (deg)")
    ax.set_title("shaded: goes in with the average aim and spin", fontsize=10)
    ax.legend(frameon=False)
    return ax


def intervals(result: Fit | Advice, ax: Axes | None = None) -> Axes:
    """The scatter of a fit, or the gains of an advice, with their 95 % intervals."""
    shown: dict[str, Estimate]
    if isinstance(result, Fit):
        parameters = result.parameters.values()
        shown = {f"{p.name} ({p.unit})": p for p in parameters if p.name.endswith("_sd")}
        label = "standard deviation"
    else:
        shown = {f"step: {name}": e for name, e in result.causes.items()}
        shown |= {f"steadier {name}": e for name, e in result.training.items()}
        label = "makes in 100 shots"
    scale = 1.0 if isinstance(result, Fit) else 100.0
    ax = _axes(ax, figsize=(6, 0.4 * len(shown) + 1))
    for row, (name, estimate) in enumerate(shown.items()):
        ax.plot([scale * estimate.low, scale * estimate.high], [row, row], color=_BLUE, lw=2)
        ax.plot(scale * estimate.mean, row, "o", color=_BLUE)
    ax.set_yticks(range(len(shown)), list(shown))
    ax.invert_yaxis()
    ax.set_xlabel(label)
    if isinstance(result, Advice):
        ax.axvline(0, color=_GREY, lw=1)
    return ax


def windows(best: BestShots, variable: str = "speed", ax: Axes | None = None) -> Axes:
    """The range of one variable in which an otherwise exact best shot is made, for both kinds."""
    ax = _axes(ax, figsize=(6, 1.8))
    names: list[str] = []
    for kind, colour in (("direct", _BLUE), ("bank", _ORANGE)):
        shot = getattr(best, kind)
        if shot is None:
            continue
        ends = shot.sensitivity["windows"]
        name = next(key for key in ends if key.startswith(variable))
        if ends[name] is None:
            continue
        ax.plot(ends[name], [len(names)] * 2, color=colour, lw=6, solid_capstyle="butt")
        ax.plot(shot[name], len(names), "o", color=_INK)
        names.append(f"{kind} ({100 * shot.probability:.0f} in 100)")
        ax.set_xlabel(name.replace("_", " "))
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(-0.6, len(names) - 0.4)
    return ax


def bank_and_direct(sweep: Sweep, ax: Axes | None = None) -> Axes:
    """P of the best bank shot minus P of the best direct one, over the court from above."""
    import numpy as np

    columns = sweep.columns()
    found: dict[tuple[float, float], dict[str, float]] = {}
    x, y = _feet(columns, "x"), _feet(columns, "y")
    for i, kind in enumerate(columns["kind"]):
        p = columns["probability"][i]
        if p is not None:
            found.setdefault((x[i], y[i]), {})[kind] = p
    both = {place: p for place, p in found.items() if {"bank", "direct"} <= p.keys()}
    if not both:
        raise ValueError("the sweep has no place with both a bank and a direct shot")
    gain = np.array([100 * (p["bank"] - p["direct"]) for p in both.values()])
    places = np.array(list(both))
    ax = _axes(ax, figsize=(6.5, 5))
    limit = max(np.abs(gain).max(), 1.0)
    dots = ax.scatter(
        places[:, 1], places[:, 0], c=gain, cmap="PuOr_r", vmin=-limit, vmax=limit, s=60, marker="s"
    )
    ax.figure.colorbar(dots, ax=ax, shrink=0.7, label="bank minus direct (makes in 100)")
    ax.plot([-3, 3], [-1.25, -1.25], color=_INK, lw=3)
    circle = np.linspace(0, 2 * np.pi, 60)
    ax.plot(_RING_RADIUS_FT * np.cos(circle), _RING_RADIUS_FT * np.sin(circle), color=_ORANGE)
    ax.set(xlabel="across, right facing the board (ft)", ylabel="from the hoop's centre (ft)")
    ax.set_aspect("equal")
    ax.invert_yaxis()
    return ax
