"""Other processes and signals: spawn, joblib and Dask; Ctrl-C; other threads of Python; overhead."""

from __future__ import annotations

import multiprocessing
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import distributed
import joblib
import numpy as np
import pytest
from conftest import small_sweep

import contact_dma as cd

SPHERE = cd.Sphere("10 mm")


def loss(radius: float) -> cd.SweepResult:
    """A case of a study, as a worker solves it."""
    material = cd.Material.library("pmma")
    return cd.sweep(
        material, cd.Sphere(radius), mean=10.0, amplitude=5.0, angular_frequency=[1e-2], springs=16, steps=16, threads=1
    )


def test_a_result_comes_back_from_a_pickle_bit_for_bit(result: cd.SweepResult) -> None:
    again = pickle.loads(pickle.dumps(result))
    assert again == result and again.peaks == result.peaks and again.resolved == result.resolved
    for one, other in zip(again.cycles, result.cycles):
        assert np.array_equal(one.load, other.load) and np.array_equal(one.approach, other.approach)
        assert np.array_equal(one.profiles[1].lines[0].pressure, other.profiles[1].lines[0].pressure, equal_nan=True)


def test_a_result_read_from_a_folder_pickles(tmp_path: Path, result: cd.SweepResult) -> None:
    result.save(tmp_path)
    assert pickle.loads(pickle.dumps(cd.read(tmp_path))) == result


def test_what_was_read_by_a_relative_path_pickles_for_another_folder(
    tmp_path: Path, result: cd.SweepResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    result.save(tmp_path / "out")
    monkeypatch.chdir(tmp_path)
    packed = pickle.dumps(cd.read("out"))
    monkeypatch.chdir("/")
    assert pickle.loads(packed) == result


def test_a_study_runs_over_spawned_processes() -> None:
    radii = [0.005, 0.01]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        made = pool.map(loss, radii)
    assert made == [loss(radius) for radius in radii]


def test_a_study_runs_over_joblib() -> None:
    radii = [0.005, 0.01]
    made = joblib.Parallel(n_jobs=2)(joblib.delayed(loss)(radius) for radius in radii)
    assert made == [loss(radius) for radius in radii]


def test_a_study_runs_over_a_cluster_of_dask_with_two_workers() -> None:
    radii = [0.005, 0.01, 0.02]
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,  # type: ignore[no-untyped-call]
        distributed.Client(cluster) as client,  # type: ignore[no-untyped-call]
    ):
        made = client.gather(client.map(loss, radii))
    assert made == [loss(radius) for radius in radii]


# A process that a shell has started in the background ignores Ctrl-C, and so do those that it starts. The timer runs beside the work.
LONG = """
import contact_dma as cd, numpy as np, signal, threading
signal.signal(signal.SIGINT, signal.default_int_handler)
t = np.linspace(0, 2000, 200_001)
record = np.stack([t, 10 + 5 * np.sin(3 * t), 1e-5 + 2e-6 * np.sin(3 * t - 0.2)], 1)
np.savetxt({record!r}, record[::10], delimiter=",", header="time_s,load_n,approach_m", comments="")
threading.Timer(1.0, print, ["working"], {{"flush": True}}).start()
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
CALLS = {
    "sweep": "cd.sweep(cd.Material.library('pmma'), cd.Ellipsoid(0.01, 0.02), mean=10.0, amplitude=5.0,"
    " angular_frequency=np.logspace(-4, 0, 200), cells=256, method='march', hold='500 s')",
    "simulate": "cd.simulate(cd.Material.library('pmma'), cd.Ellipsoid(0.01, 0.02), cells=256, step=0.01,"
    " segments=[{'kind': 'ramp', 'to': 10.0, 'duration': '1000 s'}])",
    "analyse": "cd.analyse([RECORD] * 100_000)",
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_control_c_stops_work_of_hours(call: str, tmp_path: Path) -> None:
    record = str(tmp_path / "record.csv")
    script = LONG.format(call=call.replace("RECORD", repr(record)), record=record)
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "working\n"
    process.send_signal(signal.SIGINT)
    try:
        # Nobody waits so long but where the work goes on to its end.
        said, _ = process.communicate(timeout=300)
    finally:
        process.kill()
    assert said == "interrupted\n"


def test_other_threads_of_python_run_meanwhile() -> None:
    counted, stop = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not stop.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted
    started = time.monotonic()
    small_sweep(springs=256, steps=256, threads=1)
    elapsed, counted_meanwhile = time.monotonic() - started, counted - before
    stop.set()
    thread.join()
    # One in a millisecond at best; a held lock would let none through.
    assert counted_meanwhile > 50 * elapsed
