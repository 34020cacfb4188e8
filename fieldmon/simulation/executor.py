"""Who simulates an experiment: this thread, threads, processes, or a cluster of many machines.

All of them are `concurrent.futures` executors, so that nothing else needs to know which.
"""

from __future__ import annotations

import logging
import signal
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import resource_tracker
from typing import TYPE_CHECKING, Any, NamedTuple

from fieldmon.compute.cores import cores
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from distributed import Client

# chunks handed out ahead of each worker, so that none waits for the next
_AHEAD = 3
_CONNECT_S = 20
# workers of this machine write to the terminal of whoever started them
_QUIET = {"distributed.nanny.pre-spawn-environ.DASK_LOGGING__DISTRIBUTED": "critical"}


class Workers(NamedTuple):
    """Who simulates.

    Parameters
    ----------
    pool
        Takes chunks.
    ahead
        How many chunks it has in hand at a time.
    dashboard
        Address of a page that shows it at work; empty: there is none.
    """

    pool: Executor
    ahead: int
    dashboard: str = ""


class _Here(Executor):
    """Does in the calling thread, at once, what it is asked for."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:  # noqa: ANN401 - the protocol's
        """Return the finished future of a call."""
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


def here() -> Workers:
    """Return the calling thread: one chunk after the other, and nothing is left when it ends."""
    return Workers(_Here(), 1)


@contextmanager
def threads(workers: int | None = None) -> Iterator[Workers]:
    """Start threads, one a core: for compiled loops, which hold no lock while they run.

    Left by an error or Ctrl-C, those at work end their chunk in the background.
    """
    n = workers or cores()
    pool = ThreadPoolExecutor(n)
    try:
        yield Workers(pool, _AHEAD * n)
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


@contextmanager
def cluster(scheduler: str | None = None, workers: int | None = None) -> Iterator[Workers]:
    """Connect to a Dask scheduler (``tcp://...``), or start processes on this machine's cores.

    The local ones have a thread each and listen on 127.0.0.1 only. A worker that is killed costs
    the chunks it had in hand, which others simulate again.
    """
    from distributed import KilledWorker  # noqa: PLC0415 - heavy

    # a worker that dies is replaced and its chunks are simulated again: nothing to shout about
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    with _client(scheduler, workers) as client:
        # a chunk is told from others by its number, not by what is in it
        pool = client.get_executor(pure=False)
        ahead = _AHEAD * max(len(client.nthreads()), 1)
        try:
            yield Workers(pool, ahead, client.dashboard_link)
        except KilledWorker as error:
            raise SettingError(
                "A chunk of the study ended several workers (is their memory too small for the "
                "plot?). What is finished is kept: the same command goes on."
            ) from error


@contextmanager
def _client(scheduler: str | None, workers: int | None) -> Iterator[Client]:
    import dask  # noqa: PLC0415 - heavy
    from distributed import Client, LocalCluster  # noqa: PLC0415 - heavy

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
    with ctrl_c_waits(), dask.config.set(_QUIET):
        local = LocalCluster(
            n_workers=workers or cores(),
            threads_per_worker=1,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
        )
    with local, Client(local) as client:
        yield client


@contextmanager
def ctrl_c_waits() -> Iterator[None]:
    """Let Ctrl-C wait until workers have started; they themselves, who inherit this, never hear it.

    Whoever started them ends them.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    resource_tracker.ensure_running()  # it would lift what is held when it is started later
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
