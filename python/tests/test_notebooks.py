"""The notebooks of the docs run, and say what they said."""

import importlib.util

import nbformat
import pytest


def texts(notebook):
    found = []
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if output.output_type == "stream":
                found.append(output.text)
            elif "text/plain" in output.get("data", {}):
                # That of a picture is its size.
                found.append(output.data["text/plain"] if "image/png" not in output.data else "picture")
    return found


@pytest.mark.parametrize("name", ["measured_shots_to_advice", "bank_and_direct_map"])
def test_notebook(name, root, capfd):
    folder = root / "docs" / "notebooks"
    spec = importlib.util.spec_from_file_location("run", folder / "run.py")
    run = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(run)
    path = folder / f"{name}.ipynb"
    stored = texts(nbformat.read(path, as_version=4))
    assert texts(run.executed(path)) == stored
    assert "picture" in stored and len(stored) >= 4
