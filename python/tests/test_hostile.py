"""Objects that lie, callbacks that raise or call back, forks, signals and threads at any time: an
exception or the right answer, never a crash, and the next call is right."""

import os
import signal
import sys
import threading

import bankshot
import numpy as np
import pyarrow as pa
import pytest
from bankshot import InputError
from test_inputs import EXPECTED, SHOTS, assert_expected, simulate

BIG = {name: np.tile(values, 100) for name, values in SHOTS.items()}


class Own(Exception):
    """Raised by the hostile objects themselves."""


class RaisesAsArray:
    def __array__(self, *args, **kwargs):
        raise Own


class LongerEachTime:
    length = 400

    def __len__(self):
        return 10**18

    def __array__(self, *args, **kwargs):
        LongerEachTime.length += 1
        return np.full(LongerEachTime.length, 24.0)


class RaisesAsNumber:
    def __float__(self):
        raise Own


class RaisesAsStream:
    def __arrow_c_stream__(self, requested_schema=None):
        raise Own

    def __arrow_c_schema__(self):
        return pa.schema([("speed_ft_s", pa.float64())]).__arrow_c_schema__()


class NoCapsule(RaisesAsStream):
    def __arrow_c_stream__(self, requested_schema=None):
        return 5


class AnotherSchema(RaisesAsStream):
    """The schema of a table of shots, the stream of another one."""

    def __arrow_c_schema__(self):
        return pa.table(SHOTS).schema.__arrow_c_schema__()

    def __arrow_c_stream__(self, requested_schema=None):
        return pa.table({"x": ["a"]}).__arrow_c_stream__()


class KeysWithoutValues(dict):
    def __getitem__(self, key):
        raise KeyError(key)


def with_speed(values):
    return {**SHOTS, "speed_ft_s": values}


N = len(next(iter(SHOTS.values())))
LIARS = {
    "an array that raises": with_speed(RaisesAsArray()),
    "an array of another length each time": with_speed(LongerEachTime()),
    "numbers that raise": with_speed([RaisesAsNumber()] * N),
    "two dimensions": with_speed(np.full((N, 2), 24.0)),
    "no dimension": with_speed(np.float64(24.0)),
    "objects": with_speed(np.array([object()] * N)),
    "complex numbers": with_speed(np.full(N, 24 + 1j)),
    "dates": with_speed(np.full(N, np.datetime64("2026-01-01"))),
    "numbers beyond a double": with_speed([10**400] * N),
    "text": with_speed(["24"] * N + [""]),
    "nested lists": with_speed([[24.0]] * N),
    "None": with_speed(None),
    "a generator": with_speed(24.0 for _ in range(N)),
    "a stream that raises": RaisesAsStream(),
    "a stream that is no capsule": NoCapsule(),
    "a stream of another schema": AnotherSchema(),
    "keys without values": KeysWithoutValues(SHOTS),
    "names that are no text": {**SHOTS, 5: np.zeros(N)},
    "names with NUL": {**SHOTS, "speed\0_ft_s": np.zeros(N)},
}


@pytest.mark.parametrize("table", LIARS.values(), ids=LIARS)
def test_objects_that_lie(table):
    try:
        result = simulate(table)
    except (Own, InputError, TypeError, ValueError, KeyError, OverflowError):
        pass
    else:
        # Columns that are no parameters are kept as they are.
        assert np.asarray(result["made"]).tolist() == EXPECTED["made"].tolist()
    assert_expected(simulate(SHOTS))


@pytest.mark.parametrize("raised", [Own, KeyboardInterrupt, SystemExit, GeneratorExit, MemoryError])
def test_every_exception_of_a_callback_is_passed_on(raised, guard_file):
    def fails(*_):
        raise raised

    with pytest.raises(raised):
        simulate(BIG, progress=fails)
    with pytest.raises(raised):
        bankshot.Profile.from_file(guard_file).best(progress=fails)
    assert_expected(simulate(SHOTS))


def test_a_callback_may_call_back():
    inner = []

    def again(*_):
        if len(inner) < 3:
            inner.append(simulate(SHOTS))

    simulate(BIG, progress=again)
    assert inner
    for result in inner:
        assert_expected(result)


def test_a_callback_may_change_what_it_was_given():
    arrays = {name: values.copy() for name, values in BIG.items()}

    def changes(*_):
        for values in arrays.values():
            values[:] = np.nan
        arrays.clear()

    try:
        result = simulate(arrays, progress=changes)
    except (InputError, RuntimeError, KeyError):
        return
    assert len(result["made"]) == len(BIG["speed_ft_s"])


def test_arrays_that_another_thread_changes():
    """Every row is that of the old or of the new values, or is refused."""
    other = np.full(len(BIG["speed_ft_s"]), 23.0)
    arrays = {**BIG, "speed_ft_s": BIG["speed_ft_s"].copy()}
    old, new = simulate(BIG)["made"], simulate({**BIG, "speed_ft_s": other})["made"]
    done = threading.Event()

    def write():
        while not done.is_set():
            arrays["speed_ft_s"][:] = other
            arrays["speed_ft_s"][:] = BIG["speed_ft_s"]

    writer = threading.Thread(target=write)
    writer.start()
    try:
        for _ in range(10):
            made = simulate(arrays)["made"]
            assert ((made == old) | (made == new)).all()
    finally:
        done.set()
        writer.join()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="fork of POSIX")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_fork_in_the_middle_of_a_call():
    children = []

    def forks(*_):
        if len(children) < 3:
            child = os.fork()
            if child == 0:
                os._exit(7)
            children.append(child)

    result = simulate(BIG, progress=forks)
    assert np.asarray(result["made"])[:N].tolist() == EXPECTED["made"].tolist()
    assert children
    for child in children:
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_signals_at_any_point():
    def raises(*_):
        raise Own

    before = signal.signal(signal.SIGALRM, raises)
    ended = {Own: 0, None: 0}
    try:
        for number in range(60):
            signal.setitimer(signal.ITIMER_REAL, 0.0005 * (number + 1))
            try:
                assert_expected(simulate(SHOTS))
                ended[None] += 1
            except Own:
                ended[Own] += 1
            finally:
                # It may come in the last moment.
                try:
                    signal.setitimer(signal.ITIMER_REAL, 0)
                except Own:
                    pass
    finally:
        signal.signal(signal.SIGALRM, before)
    assert sum(ended.values()) == 60
    assert_expected(simulate(SHOTS))


def test_one_profile_in_many_threads(guard_file):
    guard = bankshot.Profile.from_file(guard_file)
    question = dict(speed_ft_s=24.0, pitch_deg=53.0, target=0.004)
    expected = guard.probability(**question).probability
    found = []

    def ask():
        for _ in range(5):
            found.append(guard.probability(**question).probability)

    threads = [threading.Thread(target=ask) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 40
