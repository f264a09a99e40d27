"""The best shots over the court."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ._commands import Progress, run
from ._profile import PathLike


@dataclass(frozen=True)
class Sweep:
    """A finished sweep; ``folder`` has its tables."""

    folder: Path

    @property
    def table(self) -> Path:
        """The best shots of all places: a Parquet file."""
        return self.folder / "best_shots.parquet"

    def columns(self) -> dict[str, list[Any]]:
        """The best shots as columns: numbers, text, ``None`` where there is no value."""
        import csv

        with open(self.folder / "best_shots.csv", newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        columns = zip(*rows) if rows else [()] * len(header)
        return {name: _values(cells) for name, cells in zip(header, columns)}

    def to_arrow(self) -> Any:
        """The best shots of all places."""
        from . import _tables

        columns = self.columns()
        count = len(next(iter(columns.values()), []))
        text = {name for name, values in columns.items() if any(isinstance(v, str) for v in values)}
        return _tables.arrow(
            [
                {
                    name: (values[i] or "") if name in text else values[i]
                    for name, values in columns.items()
                }
                for i in range(count)
            ]
        )

    def compare(self, against: Sweep | PathLike | None = None) -> Comparison:
        """Its maps: :func:`compare`."""
        return compare(self, against)

    def _repr_html_(self) -> str:
        return f"<p>sweep in {self.folder}</p>"


@dataclass(frozen=True)
class Comparison:
    """Maps of bank and direct shots."""

    folder: Path

    @property
    def plots(self) -> list[Path]:
        """The maps as SVG files."""
        return sorted(self.folder.glob("*.svg"))

    def _repr_html_(self) -> str:
        return "".join(plot.read_text(encoding="utf-8") for plot in self.plots)


def sweep(
    config: PathLike,
    out: PathLike,
    *,
    resume: bool = True,
    threads: int | None = None,
    progress: Progress = None,
) -> Sweep:
    """The best shots at every place of a sweep.

    What is computed is saved: after Ctrl-C, the same call continues where it stopped.

    Parameters
    ----------
    config : path
        The sweep, as :command:`bankshot new sweep` writes it.
    out : path
        Its folder.
    resume : bool
        With ``False`` a folder that is there already is refused.
    """
    folder = Path(out)
    if not resume and folder.exists():
        raise FileExistsError(f"{folder}: is there already; continue it with resume=True")
    run(["sweep", str(config), "--out", str(folder)], threads=threads, progress=progress)
    return Sweep(folder)


def compare(
    what: Sweep | PathLike,
    against: Sweep | PathLike | None = None,
    *,
    out: PathLike | None = None,
    threads: int | None = None,
) -> Comparison:
    """Draws maps of bank and direct shots: of a sweep, of two, or about the best shots of a profile's file."""
    path = what.folder if isinstance(what, Sweep) else Path(what)
    folder = Path(out) if out is not None else (path if path.is_dir() else path.parent) / "plots"
    command = ["map", str(path), "--output", str(folder)]
    if against is not None:
        other = against.folder if isinstance(against, Sweep) else Path(against)
        command += ["--against", str(other)]
    run(command, threads=threads)
    return Comparison(folder)


def _values(cells: tuple[str, ...]) -> list[Any]:
    def value(cell: str) -> Any:
        if not cell:
            return None
        try:
            return float(cell)
        except ValueError:
            return cell

    return [value(cell) for cell in cells]
