"""What is known of single shots: P, the best ones, their paths."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from . import _tables

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Probability:
    """P of a nominal shot.

    ``standard_error`` is numerical: the profile is taken as exact. ``shares`` are those of all shots, by how
    they went in or missed. ``raw`` has everything that the program says.
    """

    probability: float
    standard_error: float
    interval_95: tuple[float, float] | None
    shots: int
    shares: Mapping[str, float]
    nominal: Mapping[str, float]
    target_met: bool
    raw: Mapping[str, Any] = field(repr=False)

    @classmethod
    def _of(cls, raw: dict[str, Any]) -> Probability:
        interval = raw.get("interval_95")
        return cls(
            probability=raw["probability"],
            standard_error=raw.get("standard_error") or 0.0,
            interval_95=(interval[0], interval[1]) if interval else None,
            shots=raw["shots"],
            shares=raw.get("shares") or {},
            nominal=raw["nominal"],
            target_met=raw.get("target_met", True),
            raw=raw,
        )

    def __float__(self) -> float:
        return self.probability

    def to_arrow(self) -> Any:
        """One row: P, its error, and the nominal shot."""
        record = {"probability": self.probability, "standard_error": self.standard_error}
        return _tables.arrow([{**record, "shots": self.shots, **self.nominal}])

    def _repr_html_(self) -> str:
        rows = [("probability", f"{self.probability:.4f} ± {self.standard_error:.4f}")]
        rows += [(name.replace("_", " "), f"{share:.3f}") for name, share in self.shares.items()]
        return _tables.html("one nominal shot", ("", "share of all shots"), rows)


@dataclass(frozen=True)
class BestShot:
    """The best shot of a kind. Values have their unit in their name, as in ``shot["speed_ft_s"]``."""

    kind: str
    probability: float
    standard_error: float
    values: Mapping[str, Any]
    sensitivity: Mapping[str, Any] = field(repr=False)

    def __getitem__(self, name: str) -> Any:
        return self.values[name]

    @property
    def nominal(self) -> dict[str, float]:
        """The shot as keywords of :meth:`Profile.probability` and :meth:`Profile.trace`."""
        names = ("speed", "pitch", "polar", "backspin", "side_spin")
        return {key: value for key, value in self.values.items() if key.startswith(names)}

    @classmethod
    def _of(cls, kind: str, raw: dict[str, Any]) -> BestShot:
        values = {key: value for key, value in raw.items() if key != "sensitivity"}
        return cls(
            kind, raw["probability"], raw["standard_error"], values, raw.get("sensitivity", {})
        )


@dataclass(frozen=True)
class BestShots:
    """The best direct and bank shots from a place; ``None`` where there is no clean one."""

    shooter: str
    direct: BestShot | None
    bank: BestShot | None
    reasons: Mapping[str, str]
    raw: Mapping[str, Any] = field(repr=False)

    @classmethod
    def _of(cls, raw: dict[str, Any]) -> BestShots:
        shots = {
            kind: BestShot._of(kind, raw[kind]) if raw.get(kind) else None
            for kind in ("direct", "bank")
        }
        reasons = {kind: raw[f"{kind}_reason"] for kind in shots if f"{kind}_reason" in raw}
        return cls(raw["shooter"], shots["direct"], shots["bank"], reasons, raw)

    @property
    def best(self) -> BestShot:
        """The better of both."""
        found = [shot for shot in (self.direct, self.bank) if shot is not None]
        if not found:
            raise ValueError("; ".join(self.reasons.values()) or "no shot goes in")
        return max(found, key=lambda shot: shot.probability)

    @property
    def bank_minus_direct(self) -> tuple[float, float] | None:
        """The gain of the bank shot and its standard error."""
        gain = self.raw.get("bank_minus_direct")
        return (gain["gain"], gain["standard_error"]) if gain else None

    def to_arrow(self) -> Any:
        """A row for each kind of shot."""
        found = [shot for shot in (self.direct, self.bank) if shot is not None]
        return _tables.arrow([{"kind": shot.kind, **shot.values} for shot in found])

    def _repr_html_(self) -> str:
        rows: list[tuple[str, ...]] = []
        for kind, shot in (("direct", self.direct), ("bank", self.bank)):
            if shot is None:
                rows.append((kind, self.reasons.get(kind, "no shot goes in"), "", "", ""))
                continue
            speed = next(key for key in shot.values if key.startswith("speed"))
            p = f"{shot.probability:.4f} ± {shot.standard_error:.4f}"
            rest = (shot[speed], shot["pitch_deg"], shot["backspin_rev_s"])
            rows.append((kind, p, *(f"{value:.2f}" for value in rest)))
        header = ("shot", "probability", "speed", "pitch (deg)", "backspin (rev/s)")
        return _tables.html(f"best shots of {self.shooter}", header, rows)


@dataclass(frozen=True)
class Trace:
    """The path of one shot without errors.

    ``path`` maps names with units (``time_s``, ``x_ft`` ...) to arrays of one length; ``events`` are the release,
    the touches and the end.
    """

    made: bool
    kind: str
    events: list[dict[str, Any]]
    path: Mapping[str, NDArray[np.float64]] = field(repr=False)
    raw: Mapping[str, Any] = field(repr=False)

    @classmethod
    def _of(cls, raw: dict[str, Any]) -> Trace:
        import numpy as np

        points = raw.pop("path")
        path = {name: np.array([float(point[name]) for point in points]) for name in points[0]}
        return cls(raw["made"], raw["kind"], raw["events"], path, raw)

    def to_arrow(self) -> Any:
        """A row for each point of the path."""
        from . import _engine

        return _engine.arrow_table(list(self.path.items()))

    def _repr_html_(self) -> str:
        rows = [(event["event"], f"{event['time_s']:.3f}") for event in self.events]
        return _tables.html(f"{self.kind}", ("event", "time (s)"), rows)
