"""Tables of every kind, good and bad: results that are right, or one clear exception."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import bankshot
import numpy as np
import pandas as pd
import pint
import polars as pl
import pyarrow as pa
import pytest
from test_same_bits import releases

SHOTS = releases(500)
SHOTS["polar_deg"] = SHOTS["court_angle_deg"]
EXPECTED = bankshot.simulate(SHOTS, physics="ncaa", details=True)


def simulate(table, **options):
    return bankshot.simulate(table, physics="ncaa", details=True, **options)


def assert_expected(result):
    for name in ("made", "n_board", "n_ring", "flight_time_s"):
        assert np.array_equal(np.asarray(result[name]), EXPECTED[name])
    for name in ("entry_angle_deg", "first_touch_s"):
        values = np.asarray(result[name], dtype=float)
        assert np.array_equal(values, EXPECTED[name], equal_nan=True)


def test_every_kind_of_table_gives_its_own_kind():
    frame = pd.DataFrame(SHOTS)
    result = simulate(frame)
    assert isinstance(result, pd.DataFrame) and list(result)[:7] == list(SHOTS)
    assert list(result["kind"]) == [bankshot.OUTCOME_KINDS[code] for code in EXPECTED["kind"]]
    assert_expected(result)
    result = simulate(pl.DataFrame(SHOTS))
    assert isinstance(result, pl.DataFrame)
    assert_expected({name: result[name].to_numpy() for name in result.columns})
    assert list(result["kind"]) == list(simulate(frame)["kind"])
    result = simulate(pa.table(SHOTS))
    assert isinstance(result, pa.Table)
    assert_expected({name: result[name].to_numpy(zero_copy_only=False) for name in EXPECTED})
    # Several chunks, and a stream of record batches.
    chunked = pa.concat_tables([pa.table(SHOTS).slice(0, 123), pa.table(SHOTS).slice(123)])
    assert_expected({n: simulate(chunked)[n].to_numpy(zero_copy_only=False) for n in EXPECTED})
    structured = np.zeros(500, dtype=[(name, "f8") for name in SHOTS])
    for name, values in SHOTS.items():
        structured[name] = values
    result = simulate(structured)
    assert result.dtype.names[:7] == tuple(SHOTS)
    assert_expected(result)


class OnlyArrow:
    """A table of another library."""

    def __init__(self, table):
        self.table = table

    def __arrow_c_stream__(self, requested_schema=None):
        return self.table.__arrow_c_stream__(requested_schema)


def test_any_arrow_stream():
    assert_expected(
        {n: pa.table(simulate(OnlyArrow(pa.table(SHOTS))))[n].to_numpy(zero_copy_only=False) for n in EXPECTED}
    )


def test_strides_byte_orders_and_types():
    reverse = {name: values[::-1] for name, values in SHOTS.items()}
    assert np.array_equal(simulate(reverse)["made"][::-1], EXPECTED["made"])
    big = {name: values.astype(">f8") for name, values in SHOTS.items()}
    assert_expected(simulate(big))
    wide = np.zeros((500, 3))
    wide[:, 1] = SHOTS["speed_ft_s"]
    assert_expected(simulate({**SHOTS, "speed_ft_s": wide[:, 1]}))
    raw = np.zeros(500 * 8 + 1, dtype="u1")
    unaligned = raw[1:].view("f8")
    unaligned[:] = SHOTS["speed_ft_s"]
    assert_expected(simulate({**SHOTS, "speed_ft_s": unaligned}))
    single = {name: values.astype("f4") for name, values in SHOTS.items()}
    double = {name: values.astype("f8") for name, values in single.items()}
    assert np.array_equal(simulate(single)["flight_time_s"], simulate(double)["flight_time_s"])
    whole = {**SHOTS, "release_height_ft": np.full(500, 7, dtype="i2")}
    assert_expected(simulate(whole))
    boxed = {name: values.astype(object) for name, values in SHOTS.items()}
    assert_expected(simulate(boxed))
    assert_expected(simulate({name: values.tolist() for name, values in SHOTS.items()}))


def test_a_duplicate_index_and_other_columns_are_kept():
    frame = pd.DataFrame(SHOTS, index=[7] * 500).assign(player="Ann", when=pd.Timestamp("2026-01-01"))
    result = simulate(frame)
    assert (result.index == 7).all() and (result["player"] == "Ann").all()
    assert_expected(result)


def test_empty_tables():
    empty = {name: values[:0] for name, values in SHOTS.items()}
    assert len(simulate(empty)["made"]) == 0
    assert len(simulate(pd.DataFrame(empty))) == 0
    assert simulate(pl.DataFrame(empty)).height == 0
    assert simulate(pa.table(empty)).num_rows == 0


def refused(table, *parts, **options):
    with pytest.raises(bankshot.InputError) as raised:
        simulate(table, **options)
    for part in parts:
        assert part in str(raised.value), str(raised.value)


def with_(**columns):
    return {**SHOTS, **columns}


def test_faults_have_their_place_and_value():
    bad = SHOTS["speed_ft_s"].copy()
    bad[[3, 400]] = np.nan, -1
    refused(with_(speed_ft_s=bad), "row 3: column speed_ft_s: NaN", "row 400: column speed_ft_s: the speed")
    refused(pl.DataFrame(with_(speed_ft_s=bad)), "row 3: column speed_ft_s")
    nulls = pa.table(with_(speed_ft_s=pa.array([None] + [24.0] * 499)))
    refused(nulls, "row 0: column speed_ft_s: NaN")
    masked = np.ma.array(SHOTS["speed_ft_s"], mask=np.arange(500) == 9)
    refused(with_(speed_ft_s=masked), "row 9: column speed_ft_s: is masked")
    bad[5] = np.inf
    refused(with_(speed_ft_s=bad), "row 5")
    refused(with_(speed_ft_s=["fast"] * 500), "speed_ft_s", "numbers")
    refused(with_(speed_ft_s=np.array([24.0, "x"] + [24.0] * 498, dtype=object)), "row 1: 'x' is not a number")
    refused(with_(speed_ft_s=SHOTS["speed_ft_s"][:9]), "has 9 values where others have 500")
    refused(with_(speed_ft_s=np.float64(24.0)), "0 dimensions")
    refused(with_(speed_ft_s=np.zeros((500, 2))), "2 dimensions")
    refused(with_(speed_ft_s=SHOTS["speed_ft_s"] * 1j), "complex")
    refused(with_(spin_rpm=np.zeros(500)), "spin_rpm looks like a quantity", "backspin_rev_s")
    refused(with_(made=np.zeros(500)), "column made is written by the simulation")
    refused({"speed_ft_s": [24.0]}, "distance_ft (or distance_m) is missing")
    refused({}, "is missing")
    refused({1: [2.0]}, "its name must be text")
    refused(np.zeros((5, 9)), "is no table")
    refused(np.float64(3), "is no table")
    refused(None, "is no table")
    refused("shots.csv", "is no table")
    frame = pd.DataFrame(SHOTS)
    refused(pd.concat([frame, frame[["speed_ft_s"]]], axis=1), "speed_ft_s: is there twice")
    refused(SHOTS, "threads", threads=0)
    refused(pa.table(with_(speed_ft_s=pa.array(["fast"] * 500))), "speed_ft_s")
    with pytest.raises(bankshot.InputError, match="altitud"):
        bankshot.Physics("ncaa", altitud="5280 ft")
    with pytest.raises(bankshot.InputError, match="moon"):
        bankshot.simulate(SHOTS, physics="moon")
    with pytest.raises(bankshot.InputError, match="integrator"):
        simulate(SHOTS, integrator="euler")


def test_carried_columns():
    kept = simulate(with_(spin_rpm=np.zeros(500)), carry=["spin_rpm"])
    assert_expected(kept)


def test_faulty_profiles_and_shots():
    good = dict(name="a", release_height="7 ft", max_backspin="3 rev/s", distance_ft=13.75,
                errors={"speed": "0.25 ft/s", "pitch_deg": 1.2, "polar": "1.2 deg", "backspin": "0.3 rev/s"})
    guard = bankshot.Profile(**good)
    assert guard.replace(distance_ft=15).distance_m == 15 * 0.3048
    faults = [
        (dict(distance="3 in"), "inside the ring"),
        (dict(distance=3), "has no unit"),
        (dict(distance_ft="far"), "is not a number"),
        (dict(distance_ft=float("nan")), "finite"),
        (dict(distance_km=3), "distance_km: is not known"),
        (dict(release_height="7 feets"), "release_height"),
        (dict(physics="moon"), "moon"),
        (dict(errors={"sped": "1 ft/s"}), "sped"),
    ]
    for change, part in faults:
        with pytest.raises(bankshot.InputError, match=part):
            bankshot.Profile(**{**{k: v for k, v in good.items() if not ("distance_ft" in k and "distance" in "".join(change))}, **change})
    with pytest.raises(bankshot.InputError, match="given twice"):
        guard.probability(speed_ft_s=24, speed="24 ft/s", pitch_deg=50)
    with pytest.raises(bankshot.InputError, match="pitch: is missing"):
        guard.probability(speed_ft_s=24)
    with pytest.raises(bankshot.InputError, match="unknown table|is not a key|colour"):
        bankshot.Profile.from_toml(guard.toml + "\n[colour]\nball = 1\n")
    with pytest.raises(FileNotFoundError):
        bankshot.Profile.from_file("no.toml")
    with pytest.warns(bankshot.BankshotWarning, match="touches nothing"):
        guard.probability(speed_ft_s=10, pitch_deg=50, target=0.01)
    with pytest.warns(bankshot.BankshotWarning, match="players release"):
        guard.replace(release_height="10 ft")


def test_pint_quantities():
    unit = pint.UnitRegistry()
    guard = bankshot.Profile(
        name="a", release_height=7 * unit.ft, max_backspin=3 * unit.revolution / unit.s,
        distance=13.75 * unit.ft, physics="ncaa",
        errors={"speed": 0.25 * unit.ft / unit.s, "pitch": 1.2 * unit.deg, "polar": 1.2 * unit.deg,
                "backspin": 0.3 * unit.revolution / unit.s},
    )
    p = guard.probability(speed=7.4 * unit.m / unit.s, pitch=0.9 * unit.rad, target=0.01)
    assert p.nominal["speed_ft_s"] == pytest.approx(7.4 / 0.3048)
    with pytest.raises(bankshot.InputError, match="speed: .* is no speed"):
        guard.probability(speed=3 * unit.kg, pitch_deg=50)


def test_a_hertz_is_a_turn_in_a_second():
    """Authority: the same shot as text. (A radian in a second would be a sixth of the spin.)"""
    unit = pint.UnitRegistry()
    known = {"name": "a", "release_height": "7 ft", "distance": "13.75 ft"}
    known["errors"] = {"speed": "0.25 ft/s", "pitch": "1.2 deg", "polar": "1.22 deg", "backspin": "0.3 rev/s"}
    shot = {"speed": "24.3 ft/s", "pitch": "53 deg", "target": 0.005}
    text = bankshot.Profile(max_backspin="3 rev/s", **known)
    expected = text.probability(backspin="3 rev/s", **shot).probability
    for spin in (3 * unit.Hz, 3 / unit.s, 180 / unit.minute, 0.003 * unit.kHz, 3 * unit.rps, 180 * unit.rpm,
                 1080 * unit.deg / unit.s, "3 Hz", "3 1/s"):
        guard = bankshot.Profile(max_backspin=spin, **known)
        found = guard.probability(backspin=spin, **shot)
        assert found.nominal["backspin_rev_s"] == pytest.approx(3), spin
        assert found.probability == pytest.approx(expected, abs=1e-9), spin
        # Nobody gives the backspin: the profile's, with a warning.
        with pytest.warns(bankshot.BankshotWarning, match="max_backspin"):
            assert guard.probability(**shot).nominal["backspin_rev_s"] == pytest.approx(3)


def test_every_unit_of_pint():
    """Authority: pint's own sizes; SI, where a hertz counts cycles."""
    from bankshot._units import in_words

    unit = pint.UnitRegistry()
    base = {"length": unit.m, "speed": unit.m / unit.s, "angle": unit.rad, "spin": unit.rad / unit.s}
    cycles = {"hertz", "Hz", "kilohertz"}
    # Counts and bits are no angles, though pint says that they have no dimension.
    counts = {"baud", "Bd", "bps", "counts_per_second", "cps", "becquerel", "Bq", "curie", "Ci", "rutherford", "Rd"}
    tried = 0
    for dimension, si in base.items():
        for name in (name for name in unit._units if name.isidentifier()):
            one = unit.Quantity(2.0, name)
            if one.dimensionality != si.dimensionality or not one._is_multiplicative:
                continue
            root = one.to_root_units()
            is_angle = format(root.units, "C") in ("radian", "radian/second")
            if dimension in ("angle", "spin") and not is_angle and name not in cycles:
                assert name in counts or dimension == "angle", name
                try:
                    written = in_words("x", one, dimension)
                except bankshot.InputError:
                    continue
                # Shares are refused where the program reads them.
                assert written.endswith("%") and name not in counts, name
                continue
            number, text_unit = in_words("x", one, dimension).split()
            turns = 2 * np.pi if name in cycles else 1.0
            expected = one.to(si).magnitude * turns
            size = {"Hz": 2 * np.pi}.get(text_unit, 1.0)
            assert float(number) * size == pytest.approx(expected, rel=1e-12), name
            tried += 1
    assert tried > 60


def test_pint_in_every_field():
    unit = pint.UnitRegistry()
    errors = {"c10": 0.25 * unit.ft / unit.s, "c12": 0.0 * unit.s / unit.ft, "c20": 1.2 * unit.deg,
              "polar": 1.22 * unit.deg, "c40": 0.3 * unit.Hz, "c42": 0.0 * unit.s / unit.turn}
    physics = bankshot.Physics(
        "ncaa", ball_mass=21 * unit.oz, ball_radius=0.12 * unit.m, board_stiffness=2000 * unit.lbf / unit.ft,
        gravity=32.2 * unit.ft / unit.s**2, air_density=1.2 * unit.kg / unit.m**3, hoop_restitution=60 * unit.percent,
        time_limit=9 * unit.s,
    )
    text = bankshot.Physics(
        "ncaa", ball_mass="21 oz", ball_radius="0.12 m", board_stiffness="2000 lb/ft", gravity="32.2 ft/s^2",
        air_density="1.2 kg/m^3", hoop_restitution="60 %", time_limit="9 s",
    )
    given = {"name": "a", "release_height": 7 * unit.ft, "distance": 13.75 * unit.ft, "max_backspin": 3 * unit.Hz}
    guard = bankshot.Profile(**given, errors=errors, physics=physics, search={"speed_max": 30 * unit.ft / unit.s})
    plain = bankshot.Profile(
        name="a", release_height="7 ft", distance="13.75 ft", max_backspin="3 rev/s", physics=text,
        errors={"speed": "0.25 ft/s", "pitch": "1.2 deg", "polar": "1.22 deg", "backspin": "0.3 rev/s"},
        search={"speed_max": "30 ft/s"},
    )
    shot = {"speed_ft_s": 24.3, "pitch_deg": 53, "backspin_rev_s": 3, "target": 0.005}
    p, expected = guard.probability(**shot), plain.probability(**shot)
    assert p.probability == pytest.approx(expected.probability, abs=1e-3)
    with pytest.raises(bankshot.InputError, match="backspin"):
        guard.probability(speed_ft_s=24.3, pitch_deg=53, backspin=3 * unit.Bq)
    with pytest.raises(bankshot.InputError, match="pitch"):
        guard.probability(speed_ft_s=24.3, pitch=53 * unit.dimensionless, backspin_rev_s=3)


def test_faulty_measured_shots(tmp_path):
    with pytest.raises(bankshot.InputError, match="needs the columns"):
        bankshot.fit({"Speed": [24.0, 24.1], "Angle": [50, 51]})
    with pytest.raises(bankshot.InputError, match="different lengths"):
        bankshot.fit({"speed_ft_s": [24.0], "pitch_deg": [50, 51]})
    with pytest.raises(bankshot.InputError, match="neither a file nor a table"):
        bankshot.fit(3)
    with pytest.raises(bankshot.InputError, match="missing.csv"):
        bankshot.fit(tmp_path / "missing.csv")


def test_results_have_arrow_and_html(guard_file):
    found = bankshot.Profile.from_file(guard_file).best()
    table = pa.table(found.to_arrow())
    assert table.column("kind").to_pylist() == ["direct", "bank"]
    assert table.column("probability").to_pylist() == [found.direct.probability, found.bank.probability]
    assert "<table>" in found._repr_html_()


ENDLESS = """
import bankshot, sys
guard = bankshot.Profile.from_file({file!r})
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("stopped", flush=True)
"""
CALLS = {
    "probability": "guard.probability(speed_ft_s=24, pitch_deg=53, target=1e-6, method='monte-carlo')",
    "simulate": "import numpy as np; n = 40_000_000; one = lambda x: np.broadcast_to(np.float64(x), n); "
    "bankshot.simulate(dict(distance_ft=one(13.75), court_angle_deg=one(0), release_height_ft=one(7), "
    "speed_ft_s=one(24.9), pitch_deg=one(53), polar_deg=one(0.7)), details=True)",
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_stops_within_half_a_second(call, guard_file):
    script = ENDLESS.format(file=str(guard_file), call=call)
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    # The work has begun; how long it has run does not matter, for it never ends.
    time.sleep(0.5)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.stdout.readline() == "stopped\n"
    # Half a second is promised on a quiet machine.
    assert time.monotonic() - start < 3
    process.kill()
    process.wait()


def test_other_threads_run_meanwhile():
    ticks = []
    done = threading.Event()

    def tick():
        while not done.wait(0.005):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    big = {name: np.tile(values, 400) for name, values in SHOTS.items()}
    simulate(big, threads=1)
    done.set()
    thread.join()
    assert len(ticks) > 5


def test_threads_of_python_at_once():
    results = [None] * 4

    def work(i):
        results[i] = simulate(SHOTS, threads=2)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results:
        assert_expected(result)


def _in_child(_):
    return simulate(SHOTS)["made"].tolist()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="fork of POSIX")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_fork_after_threads():
    simulate(SHOTS)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        for made in pool.map(_in_child, range(2)):
            assert made == EXPECTED["made"].tolist()


def test_progress_is_told_and_its_exceptions_are_passed_on():
    told = []
    big = {name: np.tile(values, 100) for name, values in SHOTS.items()}
    simulate(big, progress=lambda *words: told.append(words))
    assert told[-1] == ("simulating", 50_000, 50_000)

    def fails(stage, done, total):
        raise ZeroDivisionError("no")

    with pytest.raises(ZeroDivisionError):
        simulate(big, progress=fails)


@pytest.mark.parametrize("has_tqdm", [True, False])
def test_a_bar_is_shown_with_and_without_tqdm(has_tqdm, capfd, monkeypatch):
    if not has_tqdm:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    assert_expected(simulate(SHOTS, progress=True))
    shown = capfd.readouterr().err
    assert "simulating" in shown and "100" in shown


def test_duckdb_relations():
    duckdb = pytest.importorskip("duckdb")
    shots = pa.table(SHOTS)
    relation = duckdb.sql("select * from shots")
    result = pa.table(simulate(relation))
    assert_expected({name: result[name].to_numpy(zero_copy_only=False) for name in EXPECTED})
    assert shots.num_rows == result.num_rows
