import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def command():
    """Runs the program that the wheel carries; its standard output."""

    def run(*arguments, exit_code=0):
        # As a process of its own.
        done = subprocess.run(
            [sys.executable, "-m", "bankshot", *map(str, arguments), "--quiet"],
            capture_output=True,
            text=True,
            env={**os.environ, "PYTHONWARNINGS": "error"},
        )
        assert done.returncode == exit_code, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def guard_file():
    return ROOT / "configs" / "free_throw.toml"


@pytest.fixture(scope="session")
def root():
    return ROOT
