from collections.abc import Callable, Sequence
from typing import Any

__version__: str
OUTCOME_KINDS: list[str]

class InputError(ValueError):
    """An input that cannot be used: the message has the place, the value and what is allowed."""

class Command:
    exit_code: int
    answer: bytes
    remarks: str
    @staticmethod
    def run(
        arguments: Sequence[str], progress: Callable[[str, int, int], object] | None = ...
    ) -> Command: ...

def ask(
    request: dict[str, Any],
    threads: int | None = ...,
    progress: Callable[[str, int, int], object] | None = ...,
) -> tuple[dict[str, Any], list[str]]: ...
def main(arguments: Sequence[str]) -> int: ...
def text_with(text: str, values: Sequence[tuple[str, Any]]) -> str: ...
def arrow_table(columns: Sequence[tuple[str, Any]], beside: Any = ...) -> Any: ...
def column_names(table: Any) -> list[str]: ...
def simulate(
    names: Sequence[str],
    carry: Sequence[str],
    releases: Any,
    physics: str,
    integrator: str | None,
    details: bool,
    threads: int | None,
    progress: Callable[[str, int, int], object] | None,
) -> Any: ...
