"""Runs commands of the program in this process, and turns what they say into answers."""

from __future__ import annotations

import importlib
import json
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from typing import Any, Union

from . import _engine
from ._engine import InputError

#: ``progress``: True for a bar (with tqdm where it is installed), or a function of the stage, the units
#: that are done, and their total.
Progress = Union[bool, Callable[[str, int, int], object], None]


class BankshotError(RuntimeError):
    """What failed though its input was right; ``exit_code`` is that of the program."""

    def __init__(self, message: str, exit_code: int) -> None:
        super().__init__(message)
        self.exit_code = exit_code


class BankshotWarning(UserWarning):
    """What is doubtful about an input or an answer."""


# Exit codes, as the manual of the program lists them.
_DONE, _IMPRECISE, _USAGE, _INCOMPLETE = 0, 1, 2, 3


def ask(
    request: dict[str, Any],
    *,
    threads: int | None = None,
    progress: Progress = None,
) -> dict[str, Any]:
    """The answer of the library to a question."""
    _check_threads(threads)
    with _watch(progress) as report:
        answer, notes = _engine.ask(request, threads, report)
    for note in notes:
        warnings.warn(note, BankshotWarning, stacklevel=_depth())
    return answer


def _check_threads(threads: int | None) -> None:
    if threads is not None and threads < 1:
        raise InputError(f"threads: {threads} must be 1 or more")


def run(
    arguments: Sequence[str],
    *,
    threads: int | None = None,
    progress: Progress = None,
    named: dict[str, str] | None = None,
) -> bytes:
    """The answer of a command. ``named`` says what to call the files of this call in messages."""
    command = ["bankshot", *arguments]
    _check_threads(threads)
    if threads is not None:
        command += ["--threads", str(threads)]
    with _watch(progress) as report:
        said = _engine.Command.run(command, report)
    remarks = said.remarks
    for path, name in (named or {}).items():
        remarks = remarks.replace(path, name)
    if said.exit_code in (_DONE, _IMPRECISE, _INCOMPLETE) and said.answer:
        _warn(remarks, said.exit_code)
        return said.answer
    if said.exit_code == _DONE:
        _warn(remarks, _DONE)
        return said.answer
    message = remarks.strip().removeprefix("error: ")
    if said.exit_code == _USAGE:
        raise InputError(message)
    raise BankshotError(message, said.exit_code)


def run_json(arguments: Sequence[str], **options: Any) -> dict[str, Any]:
    """The answer of a command with ``--json``."""
    answer: dict[str, Any] = json.loads(run([*arguments, "--json"], **options))
    return answer


def _warn(remarks: str, exit_code: int) -> None:
    lines = remarks.splitlines()
    if exit_code == _DONE:
        lines = [line for line in lines if line.startswith("warning: ")]
    for line in lines:
        if line.startswith(("written", "plots")):
            continue
        text = line.removeprefix("warning: ").removeprefix("error: ")
        # The caller of the public function.
        warnings.warn(text, BankshotWarning, stacklevel=_depth())


def _depth() -> int:
    """How far up the first caller outside this package is."""
    here = os.path.dirname(__file__)
    frame, depth = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_code.co_filename.startswith(here):
        frame, depth = frame.f_back, depth + 1
    return depth


class _watch:
    """The function that is told of progress, for the time of a call."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._bar: Any = None

    def __enter__(self) -> Callable[[str, int, int], object] | None:
        if self._progress is None or self._progress is False:
            return None
        if self._progress is not True:
            return self._progress
        try:
            tqdm: Any = importlib.import_module("tqdm.auto").tqdm
        except ImportError:
            return _print_progress

        def show(stage: str, done: int, total: int) -> None:
            if self._bar is None or self._bar.desc.rstrip(": ") != stage:
                self._close()
                self._bar = tqdm(total=total, desc=stage)
            self._bar.update(done - self._bar.n)

        return show

    def _close(self) -> None:
        if self._bar is not None:
            self._bar.close()

    def __exit__(self, *_: object) -> None:
        self._close()
        if self._progress is True and self._bar is None:
            print(file=sys.stderr)


def _print_progress(stage: str, done: int, total: int) -> None:
    share = 100 * done // max(total, 1)
    print(f"\r{stage}: {share} %", end="", file=sys.stderr, flush=True)


def main() -> None:
    """The program ``bankshot``."""
    sys.exit(_engine.main(["bankshot", *sys.argv[1:]]))
