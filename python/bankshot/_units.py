"""Quantities in the words of the program: a number and its unit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ._engine import InputError

#: The suffixes of names, and the units they stand for.
_SUFFIXES = {
    "length": {"ft": "ft", "in": "in", "m": "m", "cm": "cm"},
    "speed": {"ft_s": "ft/s", "m_s": "m/s", "mph": "mph", "km_h": "km/h"},
    "angle": {"deg": "deg", "rad": "rad"},
    "spin": {"rev_s": "rev/s", "rad_s": "rad/s", "rpm": "rpm"},
}
_PINT_UNITS = {"length": "m", "speed": "m/s", "angle": "rad", "spin": "rad/s"}

#: The parts of a nominal shot.
SHOT = {
    "speed": "speed",
    "pitch": "angle",
    "polar": "angle",
    "aim": "angle",
    "backspin": "spin",
    "rifle_spin": "spin",
    "side_spin": "spin",
}


def in_words(name: str, value: Any, dimension: str) -> str:
    """A quantity as text: text as it is, a pint quantity in SI units."""
    if isinstance(value, str):
        return value
    if hasattr(value, "magnitude") and hasattr(value, "to"):
        unit = _PINT_UNITS[dimension]
        try:
            return f"{float(value.to(unit).magnitude)!r} {unit}"
        except Exception as error:
            raise InputError(f"{name}: {value} is no {dimension}") from error
    names = ", ".join(f"{name}_{suffix}" for suffix in _SUFFIXES[dimension])
    example = next(iter(_SUFFIXES[dimension].values()))
    raise InputError(
        f"{name}: {value!r} has no unit; write {name}=\"{value} {example}\", or one of {names}"
    )


def quantities(given: Mapping[str, Any], known: Mapping[str, str]) -> dict[str, str]:
    """The quantities of keywords such as ``speed_ft_s=23.6`` or ``speed="23.6 ft/s"``, as text."""
    found: dict[str, str] = {}
    for keyword, value in given.items():
        if value is None:
            continue
        name, text = _quantity(keyword, value, known)
        if name in found:
            raise InputError(f"{keyword}: {name} is given twice; keep one")
        found[name] = text
    return found


def _quantity(keyword: str, value: Any, known: Mapping[str, str]) -> tuple[str, str]:
    if keyword in known:
        return keyword, in_words(keyword, value, known[keyword])
    for name, dimension in known.items():
        for suffix, unit in _SUFFIXES[dimension].items():
            if keyword == f"{name}_{suffix}":
                return name, f"{_number(keyword, value)!r} {unit}"
    raise InputError(f"{keyword}: is not known; known are {', '.join(known)}")


def _number(keyword: str, value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{keyword}: {value!r} is not a number") from None
    if number != number or number in (float("inf"), float("-inf")):
        raise InputError(f"{keyword}: {number} is not a finite number")
    return number


def flags(shot: Mapping[str, str]) -> list[str]:
    """The options of a command for the parts of a shot."""
    return [f"--{name.replace('_', '-')}={text}" for name, text in shot.items()]
