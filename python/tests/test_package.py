"""Docstrings, types, pictures, and the program that the package carries."""

import doctest
import importlib
import pkgutil
import subprocess
import sys

import bankshot
import matplotlib
import pytest

matplotlib.use("Agg")


def test_doctests():
    for module in ["bankshot", *(f"bankshot.{m.name}" for m in pkgutil.iter_modules(bankshot.__path__))]:
        if module.endswith(("__main__", "_engine")):
            continue
        result = doctest.testmod(importlib.import_module(module))
        assert result.failed == 0, module


@pytest.mark.parametrize("checker", [["mypy", "--strict"], ["pyright", "--pythonpath", sys.executable]], ids=["mypy", "pyright"])
def test_types(checker, tmp_path, root):
    user = tmp_path / "user.py"
    user.write_text(
        "import bankshot\n"
        "guard = bankshot.Profile(name='a', release_height='7 ft', max_backspin='3 rev/s', distance_ft=13.75)\n"
        "p: float = guard.probability(speed_ft_s=24.0, pitch_deg=53.0).probability\n"
        "shot = guard.best().best\n"
        "reveal: dict[str, float] = shot.nominal\n"
        "table: object = bankshot.simulate({'speed_ft_s': [24.0]})\n"
        "interval: bankshot.Estimate = bankshot.fit('shots.csv').probability\n"
    )
    done = subprocess.run(
        [sys.executable, "-m", *checker, str(user), str(root / "python" / "bankshot")],
        capture_output=True, text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_program_is_carried(command):
    assert "bankshot" in command("--version")
    assert "error" in subprocess.run(
        [sys.executable, "-m", "bankshot", "best", "no.toml"], capture_output=True, text=True
    ).stderr


def test_numpy_is_not_imported_before_it_is_needed():
    code = "import bankshot, sys; sys.exit('numpy' in sys.modules or 'matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_pictures(root, guard_file, tmp_path):
    from bankshot import plots

    guard = bankshot.Profile.from_file(guard_file)
    best = guard.best()
    fit = bankshot.fit(root / "docs" / "data" / "gym_sensor.csv", out=tmp_path / "fit")
    for i, ax in enumerate(
        [
            plots.path(guard.trace(**best.direct.nominal)),
            plots.windows(best),
            plots.make_zone(fit),
            plots.intervals(fit),
            plots.intervals(fit.advise()),
        ]
    ):
        file = tmp_path / f"{i}.png"
        ax.figure.savefig(file)
        assert file.stat().st_size > 5000
        assert ax.get_xlabel()


def test_the_example_of_the_docs(capsys, root):
    """The page says what its example prints."""
    page = (root / "docs" / "python.md").read_text(encoding="utf-8")
    code = page.split("```python\n")[1].split("```")[0]
    exec(code, {})
    assert f"It prints `{capsys.readouterr().out.strip()}`" in page
