"""From measured shots to a profile, and from a profile to advice."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import _tables
from ._commands import Progress, run_json
from ._engine import InputError
from ._profile import PathLike, Profile
from ._units import quantities

_PLACE = {
    "distance": "length",
    "angle": "angle",
    "release_height": "length",
    "backspin": "spin",
}


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % interval."""

    mean: float
    low: float
    high: float
    sd: float | None = None

    @classmethod
    def _of(cls, raw: Mapping[str, Any]) -> Estimate:
        return cls(raw["mean"], raw["low"], raw["high"], raw.get("sd"))

    def __str__(self) -> str:
        return f"{self.mean:.3f} ({self.low:.3f} to {self.high:.3f})"


@dataclass(frozen=True)
class Parameter(Estimate):
    """A fitted parameter; ``source`` says whether it was measured or assumed."""

    name: str = ""
    unit: str = ""
    source: str = ""


@dataclass(frozen=True)
class Fit:
    """A shooter's profile from measured shots, and how sure it is.

    ``folder`` holds everything that the fit wrote: draws, plots and the report page.
    """

    shooter: str
    parameters: Mapping[str, Parameter]
    probability: Estimate
    shots: int
    made: int | None
    folder: Path
    raw: Mapping[str, Any] = field(repr=False)

    @property
    def profile(self) -> Profile:
        """The profile with the means of the fit."""
        return Profile.from_file(self.folder / "profile.toml")

    def advise(self, **options: Any) -> Advice:
        """What to do with it: :func:`advise`."""
        return advise(self, **options)

    def to_arrow(self) -> Any:
        """A row for each parameter."""
        return _tables.arrow(self.raw["parameters"])

    def _repr_html_(self) -> str:
        rows = [
            (p.name, f"{p.mean:.3f}", f"{p.low:.3f} to {p.high:.3f}", p.unit, p.source)
            for p in self.parameters.values()
        ]
        header = ("parameter", "mean", "95 % interval", "unit", "source")
        return _tables.html(f"{self.shooter}: probability {self.probability}", header, rows)


@dataclass(frozen=True)
class Advice:
    """What to change, step by step, and what to train.

    ``causes`` has the gain of each step over those before it; ``suggested`` is the release after the
    supported steps alone, and ``suggested_gain`` what they gain.
    """

    kind: str
    current: Mapping[str, float]
    best: Mapping[str, float]
    current_probability: Estimate
    best_probability: Estimate
    gain: Estimate
    causes: Mapping[str, Estimate]
    suggested: Mapping[str, float] | None
    suggested_gain: Estimate | None
    training: Mapping[str, Estimate]
    raw: Mapping[str, Any] = field(repr=False)

    @classmethod
    def _of(cls, raw: dict[str, Any]) -> Advice:
        return cls(
            kind=raw["kind"],
            current=raw["current"],
            best=raw["best"],
            current_probability=Estimate._of(raw["current_probability"]),
            best_probability=Estimate._of(raw["best_probability"]),
            gain=Estimate._of(raw["gain"]),
            causes={cause["cause"]: Estimate._of(cause) for cause in raw["causes"]},
            suggested=raw["suggested"],
            suggested_gain=Estimate._of(raw["suggested_gain"]) if raw["suggested_gain"] else None,
            training={part["less_scatter_of"]: Estimate._of(part) for part in raw["training"]},
            raw=raw,
        )

    def to_arrow(self) -> Any:
        """A row for each step and each thing to train: its gain."""
        parts = [("step", self.causes), ("10 % less scatter", self.training)]
        return _tables.arrow(
            [
                {"what": what, "of": name, "mean": e.mean, "low": e.low, "high": e.high}
                for what, estimates in parts
                for name, e in estimates.items()
            ]
        )

    def _repr_html_(self) -> str:
        rows = [("now", str(self.current_probability)), ("at best", str(self.best_probability))]
        rows += [("suggested change", str(self.suggested_gain))]
        rows += [(f"step: {name}", str(estimate)) for name, estimate in self.causes.items()]
        rows += [(f"steadier {name}", str(estimate)) for name, estimate in self.training.items()]
        return _tables.html(f"the best {self.kind} shot", ("", "mean (95 % interval)"), rows)


def fit(
    shots: Any,
    *,
    physics: str | None = None,
    tracker: str | None = None,
    map: Mapping[str, str] | None = None,  # noqa: A002
    frame: str | None = None,
    tails: str | None = None,
    free: Sequence[str] = (),
    seed: int | None = None,
    units: str = "imperial",
    out: PathLike | None = None,
    threads: int | None = None,
    progress: Progress = None,
    **place: Any,
) -> Fit:
    """Fits a profile to measured shots of one shooter.

    Parameters
    ----------
    shots
        A CSV or Parquet file, or a pandas, polars or Arrow table, or a mapping of arrays: releases
        (``speed_ft_s``, ``pitch_deg``, ``aim_deg``), landings (``entry_angle_deg``, ``depth_in``,
        ``left_right_in``) or trajectories (``shot``, ``time_s``, ``x_ft``, ``y_ft``, ``z_ft``).
    map : mapping
        Columns of other names: ``{"speed": "ReleaseSpeed:mph"}``.
    tracker : str
        ``lab``, ``noah``, ``optical_25hz``, ``optical_60hz``, or a TOML file with its noise.
    out : path
        Folder of the results; a temporary one that stays otherwise.
    **place
        ``distance``, ``angle``, ``release_height``, ``backspin``, where the file has no column for it.

    Raises
    ------
    InputError
        What is wrong with the shots. Rows that are left out are warnings.
    """
    folder = Path(out) if out is not None else Path(tempfile.mkdtemp(prefix="bankshot-fit-"))
    command = ["--out", str(folder), "--units", units]
    for flag, value in (
        ("physics", physics),
        ("tracker", tracker),
        ("frame", frame),
        ("tails", tails),
        ("seed", seed),
    ):
        if value is not None:
            command.append(f"--{flag}={value}")
    command += [f"--map={quantity}={column}" for quantity, column in (map or {}).items()]
    command += [f"--free={parameter}" for parameter in free]
    command += [
        f"--{name.replace('_', '-')}={text}" for name, text in quantities(place, _PLACE).items()
    ]
    with tempfile.TemporaryDirectory(prefix="bankshot-") as temporary:
        file, named = _as_file(shots, Path(temporary))
        raw = run_json(["fit", file, *command], threads=threads, progress=progress, named=named)
    observed = raw.get("observed") or {}
    return Fit(
        shooter=raw["shooter"],
        parameters={
            p["name"]: Parameter(
                p["mean"], p["low"], p["high"], p["sd"], p["name"], p["unit"], p["source"]
            )
            for p in raw["parameters"]
        },
        probability=Estimate._of(raw["probability"]),
        shots=observed.get("shots", 0),
        made=observed.get("made"),
        folder=folder,
        raw=raw,
    )


def advise(
    fitted: Fit | PathLike,
    *,
    threads: int | None = None,
    progress: Progress = None,
) -> Advice:
    """What a fitted shooter should change, and what it is worth, with intervals."""
    folder = fitted.folder if isinstance(fitted, Fit) else fitted
    answer = run_json(["advise", str(folder)], threads=threads, progress=progress)
    return Advice._of(answer)


def _as_file(shots: Any, folder: Path) -> tuple[str, dict[str, str]]:
    """Shots as a file that the program reads, and what to call it."""
    if isinstance(shots, (str, Path)) or hasattr(shots, "__fspath__"):
        return str(shots), {}
    path = folder / "shots.csv"
    if hasattr(shots, "to_csv"):
        shots.to_csv(path, index=False)
    elif hasattr(shots, "write_csv"):
        shots.write_csv(path)
    elif isinstance(shots, Mapping):
        _write_csv(path, {name: list(values) for name, values in shots.items()})
    elif hasattr(shots, "to_pydict"):
        _write_csv(path, shots.to_pydict())
    else:
        raise InputError(
            f"shots: {type(shots).__name__} is neither a file nor a table of measured shots"
        )
    return str(path), {str(path): "shots"}


def _write_csv(path: Path, columns: Mapping[str, Sequence[Any]]) -> None:
    import csv

    lengths = {name: len(values) for name, values in columns.items()}
    if len(set(lengths.values())) > 1:
        raise InputError(f"shots: the columns have different lengths: {lengths}")
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*columns.values()))
