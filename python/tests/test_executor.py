"""A sweep in shards through executors of several kinds is the sweep of one process, bit for bit."""

from __future__ import annotations

import multiprocessing
import threading
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from typing import Any

import distributed
import numpy as np
import pytest

import contact_dma as cd

PMMA, SPHERE = cd.Material.library("pmma"), cd.Sphere("10 mm")
FREQUENCIES = np.logspace(-3, -1, 7)


def swept(**options: Any) -> cd.SweepResult:
    return cd.sweep(PMMA, SPHERE, mean="10 N", amplitude="5 N", angular_frequency=FREQUENCIES, springs=32, steps=32, **options)


@pytest.fixture(scope="module")
def alone() -> cd.SweepResult:
    return swept()


def is_same(one: cd.SweepResult, other: cd.SweepResult) -> None:
    """Columns, peaks and loops."""
    assert one == other and one.peaks == other.peaks and one.resolved == other.resolved
    for a, b in zip(one.cycles, other.cycles, strict=True):
        assert np.array_equal(a.load, b.load) and np.array_equal(a.approach, b.approach)


@pytest.mark.parametrize("shards", [None, 1, 3, 7, 100])
def test_threads_and_any_number_of_shards(alone: cd.SweepResult, shards: int | None) -> None:
    with ThreadPoolExecutor(2) as pool:
        is_same(swept(executor=pool, shards=shards), alone)


def test_processes_that_are_spawned(alone: cd.SweepResult) -> None:
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        is_same(swept(executor=pool, shards=2), alone)


def test_dask(alone: cd.SweepResult) -> None:
    with distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:  # type: ignore[no-untyped-call]
        is_same(swept(executor=client.get_executor(), shards=2), alone)


class Here(Executor):
    """Solves when it is asked to, and has neither workers nor processes."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


def test_an_executor_of_ones_own_and_its_progress(alone: cd.SweepResult) -> None:
    told: list[tuple[int, int]] = []
    is_same(swept(executor=Here(), shards=4, progress=lambda done, of: told.append((done, of))), alone)
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)]


def test_progress_is_told_while_others_still_work(alone: cd.SweepResult) -> None:
    told = threading.Event()

    class LaterOnesWait(ThreadPoolExecutor):
        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            def late() -> Any:
                assert told.wait(60), "nothing was told of the first"
                return fn(*args, **kwargs)

            wait, self.has_first = getattr(self, "has_first", False), True
            return super().submit(late) if wait else super().submit(fn, *args, **kwargs)

    with LaterOnesWait(2) as pool:
        is_same(swept(executor=pool, shards=3, progress=lambda done, of: told.set()), alone)


def test_a_refined_sweep_and_one_of_several_axes() -> None:
    def study(**options: Any) -> cd.SweepResult:
        axes = {"drive.amplitude": ["1 N", "5 N"]}
        return cd.sweep(PMMA, SPHERE, mean="10 N", axes=axes, angular_frequency=FREQUENCIES, springs=32, steps=32, refine=True, **options)

    is_same(study(executor=Here(), shards=3), study())


def test_what_a_worker_raises_is_raised() -> None:
    class Broken(Here):
        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.set_exception(RuntimeError("the node is gone"))
            return future

    with pytest.raises(RuntimeError, match="the node is gone"):
        swept(executor=Broken())


def test_wrong_arguments_say_what_to_give() -> None:
    with pytest.raises(ValueError, match="there is none: give executor="):
        swept(shards=2)
    with pytest.raises(ValueError, match="give a pool of concurrent.futures"):
        swept(executor="four")
    for shards in (0, -1, True, 1.5):
        with pytest.raises(ValueError, match="give a number of at least 1"):
            swept(executor=Here(), shards=shards)
    with pytest.raises(ValueError, match="mean"), ThreadPoolExecutor(1) as pool:
        cd.sweep(PMMA, SPHERE, mean="-10 N", amplitude="5 N", angular_frequency=FREQUENCIES, executor=pool)
