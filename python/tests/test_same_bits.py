"""The package gives the bits of the command line."""

import csv
import json

import bankshot
import numpy as np
import pytest

RNG = np.random.default_rng(1)


def releases(n, seed=1):
    rng = np.random.default_rng(seed)
    return {
        "distance_ft": np.full(n, 13.75),
        "court_angle_deg": rng.uniform(-40, 40, n),
        "release_height_ft": np.full(n, 7.0),
        "speed_ft_s": rng.uniform(22, 27, n),
        "pitch_deg": rng.uniform(40, 65, n),
        "polar_deg": rng.uniform(-40, 40, n),
        "backspin_rev_s": rng.uniform(0, 5, n),
    }


def write(path, columns):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*[[repr(float(x)) for x in c] for c in columns.values()]))


@pytest.mark.parametrize(
    ("physics", "integrator"), [("paper", None), ("paper", "paper"), ("ncaa", None), ("ncaa", "paper")]
)
def test_simulate(command, tmp_path, physics, integrator):
    shots = releases(3000)
    shots["polar_deg"] = shots["court_angle_deg"] + RNG.uniform(-2, 2, 3000)
    write(tmp_path / "in.csv", shots)
    more = ["--integrator", integrator] if integrator else []
    command("simulate", tmp_path / "in.csv", "-o", tmp_path / "out.csv", "--physics", physics, *more)
    with open(tmp_path / "out.csv") as file:
        rows = list(csv.DictReader(file))
    full = bankshot.simulate(shots, physics=physics, integrator=integrator, details=True)
    fast = bankshot.simulate(shots, physics=physics, integrator=integrator, threads=1)
    assert any(full["made"]) and not all(full["made"])
    for i, row in enumerate(rows):
        assert full["made"][i] == fast["made"][i] == (row["made"] == "1")
        assert bankshot.OUTCOME_KINDS[full["kind"][i]] == row["kind"]
        for name in ("n_board", "n_ring"):
            assert full[name][i] == fast[name][i] == int(row[name])
        assert full["flight_time_s"][i] == fast["flight_time_s"][i] == float(row["flight_time_s"])
        for name in ("entry_angle_deg", "first_touch_s"):
            assert np.array_equal(full[name][i], float(row[name] or "nan"), equal_nan=True)


def test_probability(command, guard_file):
    said = json.loads(
        command("probability", guard_file, "--speed", "24.1 ft/s", "--pitch", "52.5 deg",
                "--backspin", "2 rev/s", "--target", "0.001", "--json")
    )
    guard = bankshot.Profile.from_file(guard_file)
    shot = {"speed_ft_s": 24.1, "pitch": "52.5 deg", "backspin_rev_s": 2, "target": 0.001}
    p = guard.probability(**shot, reach="8 ft")
    assert p.raw == {**said, "configuration_blake3": p.raw["configuration_blake3"]}
    assert p.raw["configuration_blake3"] == said["configuration_blake3"]
    assert float(p) == said["probability"] and p.shots == said["shots"]
    again = bankshot.probability(guard, speed_ft_s=24.1, pitch_deg=52.5, backspin="2 rev/s", target=0.001, reach="8 ft")
    assert again == p
    assert guard.probability(**shot).raw == {**p.raw, "rebounds": None}
    with pytest.raises(bankshot.InputError, match="reach: must be from"):
        guard.probability(**shot, reach="8 in")


def test_best(command, guard_file, tmp_path):
    said = json.loads(command("best", guard_file, "--json", "--out", tmp_path / "best"))
    found = bankshot.best(bankshot.Profile.from_file(guard_file), threads=2)
    assert found.raw == said
    assert found.best is found.direct
    assert found.bank_minus_direct == tuple(said["bank_minus_direct"].values())


def test_fit_and_advise(command, root, tmp_path):
    file = root / "docs" / "data" / "gym_sensor.csv"
    said = json.loads(command("fit", file, "--json", "--out", tmp_path / "a"))
    fit = bankshot.fit(file, out=tmp_path / "b")
    assert fit.raw["parameters"] == said["parameters"]
    assert fit.raw["probability"] == said["probability"]
    advice = json.loads(command("advise", tmp_path / "a", "--json"))
    assert fit.advise().raw == advice
    assert fit.parameters["speed_sd"].source == "from landings"
    assert fit.profile.distance_m == pytest.approx(13.75 * 0.3048, abs=1e-9)


def test_trace(command, guard_file, tmp_path):
    command("trace", guard_file, "--speed", "24 ft/s", "--pitch", "53 deg", "--backspin", "0 rev/s", "-o", tmp_path / "path.csv")
    trace = bankshot.Profile.from_file(guard_file).trace(speed_ft_s=24.0, pitch_deg=53.0, backspin_rev_s=0)
    with open(tmp_path / "path.csv") as file:
        rows = list(csv.DictReader(file))
    for name, values in trace.path.items():
        assert values.tolist() == [float(row[name]) for row in rows]
    assert trace.kind == "short" and not trace.made


def test_sweep_resumes_and_has_the_same_results(command, tmp_path, root):
    sweep = tmp_path / "court.toml"
    sweep.write_text(
        f'[sweep]\nname = "small"\nshooter = "guard.toml"\ncourt = "ncaa"\ncompute = ["direct", "bank"]\n'
        'region = "arcs"\ndistances = ["8 ft", "14 ft"]\nangles = ["0 deg", "50 deg"]\nangle_step = "50 deg"\n'
        "[grid]\nspeed = 16\npitch = 10\npolar = 10\nbackspin = 3\n[search]\nstandard_error = 0.01\n"
    )
    (tmp_path / "guard.toml").write_text((root / "configs" / "elite.toml").read_text())
    command("sweep", sweep, "--out", tmp_path / "a")
    stages = []

    def stop(stage, done, total):
        stages.append((stage, done, total))
        if done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        bankshot.sweep(sweep, tmp_path / "b", progress=stop, threads=1)
    assert stages[-1][2] == 8
    done = bankshot.sweep(sweep, tmp_path / "b")
    assert (tmp_path / "a/best_shots.csv").read_text() == (tmp_path / "b/best_shots.csv").read_text()
    with pytest.raises(FileExistsError):
        bankshot.sweep(sweep, tmp_path / "b", resume=False)
    columns = done.columns()
    assert len(columns["probability"]) == 8 and set(columns["kind"]) == {"direct", "bank"}
    plots = done.compare()
    assert any(plot.name == "bank_and_direct.svg" for plot in plots.plots)
