"""A sweep in shards, which the workers of an executor solve."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor, as_completed
from typing import Any

from . import _contact_dma as _core
from ._result import Progress
from ._sources import Source

SHARDS_PER_WORKER = 4
"""Cases do not cost the same: with several shards each, no worker waits long for the last of another."""


def solve(packed: Any, number: int, of: int, threads: int) -> bytes:
    """What a worker does."""
    return _core.solve_shard(packed, number, of, threads)


def records_of_shards(source: Source, executor: Executor, shards: int | None, threads: int, progress: Progress | None) -> bytes:
    """The records of all cases, each solved by a worker of the executor."""
    if not callable(getattr(executor, "submit", None)):
        raise ValueError(f"executor is {executor!r}: give a pool of concurrent.futures, or client.get_executor() of Dask")
    if shards is not None and (isinstance(shards, bool) or not isinstance(shards, int) or shards < 1):
        raise ValueError(f"shards is {shards!r}: give a number of at least 1, or leave it out")
    packed, cases = _core.packed_sweep(source)
    workers = getattr(executor, "_max_workers", None) or os.cpu_count() or 1
    count = min(shards or SHARDS_PER_WORKER * workers, max(cases, 1))
    futures = [executor.submit(solve, packed, k + 1, count, threads) for k in range(count)]
    try:
        for done, future in enumerate(_as_completed(futures), 1):
            future.result()
            if progress is not None:
                progress(done, count)
    finally:
        for future in futures:
            future.cancel()
    return b"".join(future.result() for future in futures)


def _as_completed(futures: list[Any]) -> Iterator[Any]:
    """As they end; in their order where they are futures of another kind."""
    try:
        yield from as_completed(futures)
    except AttributeError:
        yield from futures
