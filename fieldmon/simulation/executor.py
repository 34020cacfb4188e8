"""A study on Dask: a cluster of this machine's cores, or one of many machines."""

from __future__ import annotations

import logging
import os
from contextlib import contextmanager
from itertools import islice
from typing import TYPE_CHECKING

from distributed import Client, KilledWorker, LocalCluster, as_completed

from fieldmon.errors import FieldmonError, SettingError
from fieldmon.simulation import results
from fieldmon.simulation.design import chunks
from fieldmon.simulation.worker import run_chunk

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    import pyarrow as pa

    from fieldmon.simulation.design import Chunk, Design, Site

    Progress = Callable[[int, int], None]

# chunks handed out ahead of each worker, so that none waits for the next
_AHEAD = 3
_CONNECT_S = 20


@contextmanager
def cluster(scheduler: str | None = None, workers: int | None = None) -> Iterator[Client]:
    """Connect to a scheduler (``tcp://...``), or start a cluster of this machine's cores.

    The local one listens on 127.0.0.1 only; its workers are processes of one thread each.
    """
    # a worker that dies is replaced and its chunks are simulated again: nothing to shout about
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    if scheduler is not None:
        try:
            client = Client(scheduler, timeout=_CONNECT_S)
        except (OSError, ValueError) as error:
            raise SettingError(
                f"There must be a Dask scheduler at {scheduler}, but none answers ({error}). "
                "Start one with: dask scheduler"
            ) from error
        with client:
            yield client
        return
    local = LocalCluster(
        n_workers=workers or _cores(),
        threads_per_worker=1,
        host="127.0.0.1",
        dashboard_address="127.0.0.1:0",
    )
    with local, Client(local) as client:
        yield client


def run(
    client: Client, folder: Path, sites: tuple[Site, ...], design: Design, progress: Progress
) -> dict[str, str]:
    """Simulate all seasons of a study that `folder` does not hold yet.

    Each chunk's part is written here as soon as it arrives; a worker that is killed costs the
    chunks it had in hand. `progress` hears how many of all seasons there are. Return why plots
    were refused, by name.
    """
    results.begin(folder, sites, design)
    total = len(sites) * len(design.cases) * design.n_seeds
    left = [chunk for chunk in chunks(sites, design) if not results.part(folder, chunk).exists()]
    done = total - sum(len(chunk) for chunk in left)
    progress(done, total)
    refused = {}
    for chunk, seasons in _results(client, left):
        if isinstance(seasons, FieldmonError):
            refused[chunk.site.field.name] = str(seasons)
        else:
            results.keep(folder, chunk, seasons)
        done += len(chunk)
        progress(done, total)
    return refused


def _results(client: Client, left: list[Chunk]) -> Iterator[tuple[Chunk, pa.Table | FieldmonError]]:
    """Have chunks simulated; yield each with its seasons, in the order they are finished."""
    waiting = iter(left)
    by_key = {}

    def more(n: int) -> list[object]:
        handed = list(islice(waiting, n))
        by_key.update({chunk.key: chunk for chunk in handed})
        return [client.submit(run_chunk, chunk, key=f"fieldmon-{chunk.key}") for chunk in handed]

    finished = as_completed(more(_AHEAD * max(len(client.nthreads()), 1)), with_results=True)
    try:
        for future, seasons in finished:
            chunk = by_key.pop(future.key.removeprefix("fieldmon-"))
            for one in more(1):
                finished.add(one)
            yield chunk, seasons
    except KilledWorker as error:
        raise SettingError(
            "A chunk of the study ended several workers (is their memory too small for the plot?). "
            "What is finished is kept: the same command goes on."
        ) from error


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
