"""Who shoots, from where, at which hoop."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from . import _engine
from ._commands import Progress, ask
from ._engine import InputError
from ._units import SHOT, in_words, plain, quantities

if TYPE_CHECKING:
    from ._shots import BestShots, Probability, Trace

PathLike = Union[str, "os.PathLike[str]"]

#: Keywords of a profile: their keys in its TOML file, and what they measure.
_KEYS = {
    "release_height": ("shooter.release_height", "length"),
    "max_backspin": ("shooter.max_backspin", "spin"),
    "max_side_spin": ("shooter.max_side_spin", "spin"),
    "distance": ("location.distance", "length"),
    "angle": ("location.angle", "angle"),
}
_ERRORS = {
    "speed": "speed",
    "pitch": "angle",
    "polar": "angle",
    "backspin": "spin",
    "rifle_spin": "spin",
    "side_spin": "spin",
    "distance": "length",
    "court_angle": "angle",
    "height": "length",
}


class Physics:
    """A ball and a hoop.

    ``name`` is a preset (``paper``, ``ncaa``, ``nba``, ``fiba`` ...); keywords replace its values,
    by the keys of a ``[physics]`` table:

    >>> import bankshot
    >>> soft = bankshot.Physics("ncaa", hoop_restitution=0.5, altitude="5280 ft", temperature="20 C")
    >>> soft
    Physics('ncaa', hoop_restitution=0.5, altitude='5280 ft', temperature='20 C')
    """

    def __init__(self, name: str = "ncaa", **values: Any) -> None:
        self.name = name
        self.values = values
        items = [("physics.preset", name)]
        items += [(f"physics.{key}", plain(key, value)) for key, value in values.items()]
        self.toml = _engine.text_with("", items)
        self._check()

    @classmethod
    def from_toml(cls, text: str) -> Physics:
        """From the text of a ``[physics]`` table."""
        physics = cls.__new__(cls)
        physics.name, physics.values, physics.toml = "from TOML", {}, text
        physics._check()
        return physics

    def _check(self) -> None:
        # Simulates nothing, but reads the table.
        columns = ["distance_m", "court_angle_rad", "release_height_m"]
        columns += ["speed_m_s", "pitch_rad", "polar_rad"]
        _engine.simulate(columns, [], [None] * 9, self.toml, None, False, 1, None)

    def __repr__(self) -> str:
        values = [f"{key}={value!r}" for key, value in self.values.items()]
        return f"Physics({', '.join([repr(self.name), *values])})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Physics) and self.toml == other.toml

    def __hash__(self) -> int:
        return hash(self.toml)


class Profile:
    """A shooter at a place: how their releases scatter, from where they shoot, at which hoop.

    Parameters
    ----------
    name : str
    release_height, max_backspin, max_side_spin, distance, angle
        Text with a unit (``"7 ft"``), a pint quantity, or a float under a name with its unit
        (``release_height_ft=7``). ``distance`` is that on the floor from the hoop's centre, ``angle`` the
        court angle, 0 straight in front, positive to the right as the shooter faces the board.
    errors : mapping
        Standard deviations of ``speed``, ``pitch``, ``polar``, ``backspin`` and more; or the keys
        ``c10`` to ``c42`` of the paper.
    physics : str or Physics
        The ball and the hoop; ``ncaa`` and the like for players, ``paper`` for the paper's model.
    nominal : mapping
        The current shot: ``speed``, ``pitch`` and so on.
    search : mapping
        Keys of the table ``[search]``.

    Raises
    ------
    InputError
        Everything that is wrong, with its key, value and what is allowed.
    """

    def __init__(
        self,
        *,
        name: str = "",
        errors: Mapping[str, Any] | None = None,
        physics: str | Physics = "ncaa",
        nominal: Mapping[str, Any] | None = None,
        search: Mapping[str, Any] | None = None,
        **values: Any,
    ) -> None:
        if not any(key.startswith("angle") for key in values):
            values["angle_deg"] = 0.0
        given = {"name": name, "errors": errors, "physics": physics}
        items = _items({**given, "nominal": nominal, "search": search, **values})
        self._set(_engine.text_with("", items), None)

    @classmethod
    def from_toml(cls, text: str) -> Profile:
        """From the text of a profile."""
        profile = cls.__new__(cls)
        profile._set(text, None)
        return profile

    @classmethod
    def from_file(cls, path: PathLike) -> Profile:
        """From a file, as :command:`bankshot new player` writes it."""
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            raise InputError(f"{path}: is not UTF-8 text; save it as UTF-8") from None
        profile = cls.__new__(cls)
        profile._set(text, str(path))
        return profile

    def _set(self, text: str, origin: str | None) -> None:
        self._text, self._origin = text, origin
        checked = self._ask("check")
        self._name: str = checked["shooter"]
        self._distance_m: float = checked["distance_m"]
        self._angle_rad: float = checked["court_angle_rad"]
        self._release_height_m: float = checked["release_height_m"]

    @property
    def toml(self) -> str:
        """The text of the profile."""
        return self._text

    @property
    def name(self) -> str:
        """The shooter."""
        return self._name

    @property
    def distance_m(self) -> float:
        """Distance from the hoop's centre, m."""
        return self._distance_m

    @property
    def angle_rad(self) -> float:
        """Court angle, rad."""
        return self._angle_rad

    @property
    def release_height_m(self) -> float:
        """Height of the release above the floor, m."""
        return self._release_height_m

    @property
    def physics(self) -> Physics:
        """The ball and the hoop."""
        others = ("shooter", "location", "nominal", "search", "grid", "output")
        text = _engine.text_with(self._text, [(table, None) for table in others])
        return Physics.from_toml(text) if "[physics]" in text else Physics()

    def __repr__(self) -> str:
        feet, degrees = self._distance_m / 0.3048, self._angle_rad * 57.29577951308232
        return f"<Profile {self._name!r}, {feet:.2f} ft from the hoop at {degrees:.1f} deg>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Profile) and self._text == other._text

    def __hash__(self) -> int:
        return hash(self._text)

    def replace(self, **values: Any) -> Profile:
        """The same profile with other values, by the keywords of the class."""
        return Profile.from_toml(_engine.text_with(self._text, _items(values)))

    def _ask(
        self,
        question: str,
        *,
        units: str | None = None,
        threads: int | None = None,
        progress: Progress = None,
        **asked: Any,
    ) -> dict[str, Any]:
        profile = {"toml": self._text, "origin": self._origin or "profile", "units": units}
        request = {"question": question, "profile": profile, **asked}
        return ask(request, threads=threads, progress=progress)

    def probability(
        self,
        *,
        target: float | None = None,
        budget: int | None = None,
        seed: int | None = None,
        method: str = "sobol",
        reach: Any = None,
        threads: int | None = None,
        progress: Progress = None,
        **shot: Any,
    ) -> Probability:
        """P of one nominal shot.

        Parameters
        ----------
        **shot
            ``speed``, ``pitch``, ``polar`` or ``aim`` (from the line to the hoop's centre), ``backspin``,
            ``rifle_spin``, ``side_spin``, as text, pint quantities, or floats such as ``speed_ft_s``.
            What is missing comes from the profile's nominal shot; a backspin that neither gives is
            ``max_backspin``, with a warning.
        target : float
            Standard error at which to stop.
        budget : int
            Greatest number of shots.
        reach : text or pint quantity
            The height at which a rebound is within reach, such as ``"8 ft"``: ``raw["rebounds"]`` then
            says where the misses come down.
        """
        from ._shots import Probability

        effort = {"target": target, "budget": budget, "seed": seed, "method": method}
        question: dict[str, Any] = {"shot": quantities(shot, SHOT), "effort": effort}
        if reach is not None:
            question["reach"] = in_words("reach", reach, "length")
        return Probability._of(
            self._ask("probability", threads=threads, progress=progress, **question)
        )

    def best(
        self,
        *,
        units: str = "imperial",
        threads: int | None = None,
        progress: Progress = None,
    ) -> BestShots:
        """The best direct and bank shots from this place, and what they depend on."""
        from ._shots import BestShots

        return BestShots._of(
            self._ask("best_shots", units=units, threads=threads, progress=progress)
        )

    def trace(self, *, units: str = "imperial", **shot: Any) -> Trace:
        """The path of one shot without errors, to its end. ``shot`` as in :meth:`probability`."""
        from ._shots import Trace

        return Trace._of(self._ask("trace", units=units, shot=quantities(shot, SHOT)))


def _items(values: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """The keys and values of a TOML file for keywords of a profile."""
    items: list[tuple[str, Any]] = []
    quantities_given: dict[str, Any] = {}
    for keyword, value in values.items():
        if value is None:
            continue
        if keyword == "name":
            items.append(("shooter.name", value))
        elif keyword == "physics":
            items += _physics_items(value)
        elif keyword == "errors":
            items += _error_items(value)
        elif keyword == "correlation":
            items += [(f"shooter.correlation.{key}", r) for key, r in value.items()]
        elif keyword == "nominal":
            found = quantities(value, SHOT)
            items += [(f"nominal.{key}", text) for key, text in found.items()]
        elif keyword in ("search", "grid", "output"):
            items += [(f"{keyword}.{key}", plain(key, x)) for key, x in value.items()]
        else:
            quantities_given[keyword] = value
    known = {name: dimension for name, (_, dimension) in _KEYS.items()}
    found = quantities(quantities_given, known)
    items += [(_KEYS[name][0], text) for name, text in found.items()]
    return items


def _physics_items(physics: str | Physics) -> list[tuple[str, Any]]:
    if isinstance(physics, str):
        physics = Physics(physics)
    if not isinstance(physics, Physics):
        raise InputError(f"physics: {physics!r} must be a name or a Physics")
    if not physics.values and physics.name == "from TOML":
        raise InputError("physics: give the table in the profile's own TOML")
    items: list[tuple[str, Any]] = [("physics", None), ("physics.preset", physics.name)]
    return items + [(f"physics.{key}", plain(key, value)) for key, value in physics.values.items()]


def _error_items(errors: Mapping[str, Any]) -> list[tuple[str, Any]]:
    # The paper's keys have units of their own, as text.
    paper = {key: value for key, value in errors.items() if key[:1] == "c" and key[1:].isdigit()}
    others = {key: value for key, value in errors.items() if key not in paper}
    items: list[tuple[str, Any]] = [
        (f"shooter.errors.{key}", plain(key, value)) for key, value in paper.items()
    ]
    found = quantities(others, _ERRORS)
    return items + [(f"shooter.errors.{key}", text) for key, text in found.items()]


