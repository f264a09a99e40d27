"""Many shots at once: a table of releases in, the same kind of table out."""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

from . import _engine
from ._commands import BankshotWarning, Progress, _depth, _watch
from ._engine import InputError
from ._profile import Physics

#: The place of the backspin among the parameters of a release.
_BACKSPIN = 6


def simulate(
    releases: Any,
    *,
    physics: str | Physics = "ncaa",
    integrator: str | None = None,
    details: bool = False,
    carry: Sequence[str] = (),
    threads: int | None = None,
    progress: Progress = None,
) -> Any:
    """Simulates shots and says which are made.

    Parameters
    ----------
    releases
        A pandas or polars DataFrame, a pyarrow Table, anything else with the Arrow PyCapsule
        interface, a mapping of arrays, or a structured NumPy array. Columns by name:
        ``distance_ft``, ``court_angle_deg``, ``release_height_ft``, ``speed_ft_s``, ``pitch_deg``,
        ``polar_deg``; optional ``backspin_rev_s``, ``rifle_spin_rev_s``, ``side_spin_rev_s``. The
        suffixes ``_m``, ``_m_s``, ``_rad`` and ``_rad_s`` are understood too.
    physics : str or Physics
        The ball and the hoop.
    details : bool
        Also ``kind``, ``entry_angle_deg`` and ``first_touch_s``. Without, many shots are computed side
        by side, five times as fast.
    carry : sequence of str
        Columns that are kept though they are named like a quantity.

    Returns
    -------
    The same kind of table with the columns ``made`` (bool), ``n_board`` and ``n_ring`` (touches of board and
    ring) and ``flight_time_s`` (to the end of the shot); with ``details`` also ``kind``,
    ``entry_angle_deg`` and ``first_touch_s`` (NaN where there is none). Other columns are kept. ``kind`` is
    categorical in a table, and an index of ``OUTCOME_KINDS`` in arrays.

    Raises
    ------
    InputError
        A column is missing or not known, or a value is out of range: with its row, from 0.

    Examples
    --------
    >>> import bankshot
    >>> shots = {
    ...     "distance_ft": [13.75, 13.75], "court_angle_deg": [0, 0], "release_height_ft": [7, 7],
    ...     "speed_ft_s": [24.36, 22.0], "pitch_deg": [54.3, 54.3], "polar_deg": [0, 0],
    ...     "backspin_rev_s": [3, 3],
    ... }
    >>> bankshot.simulate(shots, physics="ncaa")["made"].tolist()
    [True, False]
    """
    table = _Table.of(releases)
    toml = physics.toml if isinstance(physics, Physics) else Physics(physics).toml
    if threads is not None and threads < 1:
        raise InputError(f"threads: {threads} must be 1 or more")
    names, carried = table.names, list(carry)
    settings = (toml, integrator, details, threads)
    needed = _engine.simulate(names, carried, None, *settings, None)
    if needed[_BACKSPIN] is None:
        words = "the backspin is not given (no column such as backspin_rev_s): no ball spins"
        warnings.warn(words, BankshotWarning, stacklevel=_depth())
    given = table.columns(needed)
    with _watch(progress) as report:
        outcomes = _engine.simulate(names, carried, given, *settings, report)
    return table.with_outcomes(outcomes)


class _Table:
    """Releases of some kind, and how outcomes are added to them."""

    def __init__(self, releases: Any, names: Sequence[Any]) -> None:
        for name in names:
            if not isinstance(name, str):
                raise InputError(f"column {name!r}: its name must be text")
        self.releases = releases
        self.names = list(names)

    @staticmethod
    def of(releases: Any) -> _Table:
        module = type(releases).__module__.partition(".")[0]
        if module == "pandas" and hasattr(releases, "columns"):
            return _Pandas(releases, list(releases.columns))
        if isinstance(releases, Mapping):
            return _Arrays(releases, list(releases))
        if getattr(getattr(releases, "dtype", None), "names", None):
            return _Structured(releases, list(releases.dtype.names))
        if hasattr(releases, "__arrow_c_stream__"):
            return _Arrow(releases, _arrow_names(releases))
        raise InputError(
            f"releases: {type(releases).__name__} is no table; give a DataFrame, an Arrow table, a "
            "mapping of arrays, or a structured NumPy array"
        )

    def column(self, name: str) -> Any:
        return self.releases[name]

    def columns(self, needed: Sequence[int | None]) -> Any:
        """The arrays of the parameters."""
        arrays: list[Any] = []
        length: int | None = None
        for index in needed:
            if index is None:
                arrays.append(None)
                continue
            name = self.names[index]
            array = _numbers(name, self.column(name))
            if length is None:
                length = len(array)
            elif len(array) != length:
                raise InputError(
                    f"column {name}: has {len(array)} values where others have {length}"
                )
            arrays.append(array)
        return arrays

    def with_outcomes(self, outcomes: dict[str, Any]) -> Any:
        raise NotImplementedError


def _numbers(name: str, values: Any) -> Any:
    """A column as doubles of this machine: the same memory where the type allows."""
    import numpy as np

    if isinstance(values, np.ma.MaskedArray):
        if np.ma.getmaskarray(values).any():
            row = int(np.ma.getmaskarray(values).argmax())
            raise InputError(f"row {row}: column {name}: is masked")
        values = values.data
    if hasattr(values, "to_numpy") and not isinstance(values, np.ndarray):
        # A DataFrame's column: missing values of any type become NaN.
        values = values.to_numpy()
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise InputError(f"column {name}: {error}") from None
    if array.ndim != 1:
        raise InputError(f"column {name}: has {array.ndim} dimensions; it must have one")
    if array.dtype.kind in "mMcSUVb":
        raise InputError(f"column {name}: is of type {array.dtype}; it must be of numbers")
    try:
        converted = np.asarray(array, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"column {name}: {_culprit(array)}") from None
    # Big-endian and unaligned arrays are copied; strides of any sign are not.
    return np.require(converted, requirements=["A"])


def _culprit(array: Any) -> str:
    for row, value in enumerate(array.tolist()):
        try:
            float(value)
        except (TypeError, ValueError):
            return f"row {row}: {value!r} is not a number"
    return "is not of numbers"


class _Arrays(_Table):
    """A mapping of arrays."""

    def with_outcomes(self, outcomes: dict[str, Any]) -> Any:
        return {**self.releases, **outcomes}


class _Structured(_Table):
    """A structured NumPy array: the outcomes are more fields."""

    def with_outcomes(self, outcomes: dict[str, Any]) -> Any:
        import numpy as np

        old = self.releases
        fields = [(name, old.dtype[name]) for name in self.names]
        fields += [(name, array.dtype) for name, array in outcomes.items()]
        joined = np.empty(old.shape, dtype=fields)
        for name in self.names:
            joined[name] = old[name]
        for name, array in outcomes.items():
            joined[name] = array
        return joined


class _Pandas(_Table):
    """A pandas DataFrame: the index is kept, duplicate or not."""

    def __init__(self, releases: Any, names: Sequence[Any]) -> None:
        super().__init__(releases, names)
        doubled = [name for name in names if list(names).count(name) > 1]
        if doubled:
            raise InputError(f"column {doubled[0]}: is there twice; rename one")

    def with_outcomes(self, outcomes: dict[str, Any]) -> Any:
        pd: Any = importlib.import_module("pandas")

        columns: dict[str, Any] = dict(outcomes)
        if "kind" in columns:
            columns["kind"] = pd.Categorical.from_codes(
                columns["kind"], list(_engine.OUTCOME_KINDS)
            )
        added = pd.DataFrame(columns, index=self.releases.index, copy=False)
        return pd.concat([self.releases, added], axis=1)


class _Arrow(_Table):
    """Any other table with the Arrow PyCapsule interface."""

    def columns(self, needed: Sequence[int | None]) -> Any:
        del needed
        return self.releases

    def with_outcomes(self, outcomes: dict[str, Any]) -> Any:
        columns: list[tuple[str, Any]] = []
        for name, array in outcomes.items():
            if name == "kind":
                columns.append((name, (array, list(_engine.OUTCOME_KINDS))))
            else:
                columns.append((name, array))
        module = type(self.releases).__module__.partition(".")[0]
        if module == "polars":
            pl: Any = importlib.import_module("polars")

            return self.releases.hstack(pl.DataFrame(_engine.arrow_table(columns)))
        if module == "pyarrow":
            pa: Any = importlib.import_module("pyarrow")

            table, added = pa.table(self.releases), pa.table(_engine.arrow_table(columns))
            for name in added.column_names:
                table = table.append_column(name, added[name])
            return table
        return _engine.arrow_table(columns, self.releases)


def _arrow_names(releases: Any) -> list[str]:
    names = getattr(releases, "column_names", None) or getattr(releases, "columns", None)
    if names is None:
        names = _engine.column_names(releases)
    return [str(name) for name in names]
