"""What `--json` prints is what the committed schemas say, in both systems of units."""

import json
import subprocess
import sys
from pathlib import Path

import bankshot
import jsonschema
import pytest

ROOT = Path(__file__).parents[2]
FREE_THROW = str(ROOT / "configs/free_throw.toml")
SHOTS = str(ROOT / "docs/data/gym_sensor.csv")
SHOT = ["--speed", "24.4 ft/s", "--pitch", "53 deg", "--backspin", "3 rev/s"]

#: The command of each answer; {fit} is the folder of a fit, {sweep} that of a sweep.
COMMANDS = {
    "best_shots": ["best", FREE_THROW, "--out", "{new}"],
    "probability": ["probability", FREE_THROW, *SHOT, "--target", "0.01"],
    "probability_along": [
        "probability", FREE_THROW, *SHOT, "--target", "0.01", "--vary", "pitch=50 deg to 54 deg by 2 deg",
    ],
    "pitch_curve": ["pitch-curve", FREE_THROW, "--pitches", "50 deg, 54 deg"],
    "table": ["table", FREE_THROW, "--distances", "12 ft, 13 ft", "--draft", "--format", "json"],
    "trace": ["trace", FREE_THROW, *SHOT],
    "physics": ["physics", FREE_THROW],
    "fit": ["fit", SHOTS, "--out", "{new}"],
    "advice": ["advise", "{fit}"],
    "sessions": ["compare-sessions", "{fit}", "{fit}"],
    "sample_size": ["design", "{fit}", "--shots", "30", "--repetitions", "12"],
    "check": ["check", FREE_THROW],
    "plan": ["plan", FREE_THROW],
}  # fmt: skip
#: Those whose units do not change, and those that take a minute.
ONCE = {"check", "plan", "physics", "sample_size", "sessions"}


def schema(units):
    return json.loads((ROOT / f"docs/answers.{units}.schema.json").read_text())


@pytest.fixture(scope="module")
def fit(tmp_path_factory):
    folder = tmp_path_factory.mktemp("answers") / "fit"
    bankshot.fit(SHOTS, out=folder)
    return folder


@pytest.mark.parametrize("units", ["imperial", "metric"])
@pytest.mark.parametrize("answer", COMMANDS)
def test_answers_are_as_their_schema_says(answer, units, fit, tmp_path):
    if answer in ONCE and units == "metric":
        pytest.skip("one system of units is enough")
    arguments = [part.format(fit=fit, new=tmp_path / "new") for part in COMMANDS[answer]]
    json_flag = [] if answer == "table" else ["--json"]
    units_flag = [] if answer in ONCE else ["--units", units]
    command = [sys.executable, "-m", "bankshot", *arguments, *json_flag, *units_flag, "--quiet"]
    said = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=True)
    document = json.loads(said.stdout)
    assert document["answer"] == answer
    of_answer = {"$ref": f"#/$defs/{answer}", "$defs": schema(units)["$defs"]}
    jsonschema.validate(document, of_answer)
    if answer != "check":
        assert set(document) <= set(schema(units)["$defs"][answer]["properties"])


def test_a_wrong_answer_is_refused(fit):
    document = json.loads((fit / "fit.json").read_text())
    document["probability"]["mean"] = "high"
    of_fit = {"$ref": "#/$defs/fit", "$defs": schema("imperial")["$defs"]}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(document, of_fit)
