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
#: The root units of pint: the unit in the program's words, and its size in the root unit. A hertz is a
#: turn in a second, as in text: pint alone would take it as a radian in a second.
_PINT_UNITS = {
    "meter": ("m", 1.0),
    "meter/second": ("m/s", 1.0),
    "radian": ("rad", 1.0),
    "radian/second": ("rad/s", 1.0),
    "1/second": ("Hz", 1.0),
    "second": ("s", 1.0),
    "second/meter": ("s/m", 1.0),
    "second/radian": ("s/rad", 1.0),
    "gram": ("g", 1.0),
    "gram/second**2": ("N/m", 1000.0),
    "gram/second": ("kg/s", 1000.0),
    "meter/second**2": ("m/s^2", 1.0),
    "gram/meter**3": ("kg/m^3", 1000.0),
    "kelvin": ("K", 1.0),
}
#: The units above that belong to a dimension; a share where one is allowed is left to the program.
_UNITS_OF = {
    "length": ("m",),
    "speed": ("m/s", "%"),
    "angle": ("rad",),
    "spin": ("rad/s", "Hz", "%"),
}

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
    if _is_pint(value):
        number, unit = _in_root_units(name, value)
        if unit not in _UNITS_OF[dimension]:
            raise InputError(f"{name}: {value} is no {dimension}")
        return f"{number!r} {unit}"
    names = ", ".join(f"{name}_{suffix}" for suffix in _SUFFIXES[dimension])
    example = next(iter(_SUFFIXES[dimension].values()))
    raise InputError(
        f"{name}: {value!r} has no unit; write {name}=\"{value} {example}\", or one of {names}"
    )


def plain(name: str, value: Any) -> Any:
    """A value of a key whose dimension the program knows: a pint quantity as text, the rest as it is."""
    if not _is_pint(value):
        return value
    number, unit = _in_root_units(name, value)
    return f"{number!r} {unit}" if unit else number


def _is_pint(value: Any) -> bool:
    return hasattr(value, "magnitude") and hasattr(value, "to_root_units")


def _in_root_units(name: str, value: Any) -> tuple[float, str]:
    """The number of a pint quantity and its unit in the program's words; no unit for a bare number."""
    try:
        root = value.to_root_units()
        number, unit = float(root.magnitude), format(root.units, "C")
    except Exception as error:
        raise InputError(f"{name}: {value} is no quantity of this kind") from error
    if unit in ("", "dimensionless"):
        return (100.0 * number, "%") if value.units != root.units else (number, "")
    if unit not in _PINT_UNITS:
        raise InputError(f"{name}: {value} is no quantity of this kind")
    unit, size = _PINT_UNITS[unit]
    return number / size, unit


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
