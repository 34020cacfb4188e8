"""An experiment: settings that all meet the same seeds, in chunks that run wherever there is room.

A setting is a scenario, a contender, or one of each. What the seasons of a chunk come to is the
experiment's own affair: this module knows which chunks there are and which of them a store holds
already, has the others run, and keeps what comes back.
"""

from __future__ import annotations

from concurrent.futures import FIRST_COMPLETED, wait
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
    from concurrent.futures import Future

    from fieldmon.simulation.executor import Workers

    Progress = Callable[[int, int], None]

Setting = TypeVar("Setting")
Result = TypeVar("Result")
Result_contra = TypeVar("Result_contra", contravariant=True)


@dataclass(frozen=True, eq=False)
class Chunk(Generic[Setting]):
    """Seasons of one setting that are simulated in one go.

    Parameters
    ----------
    setting
        What meets the seeds.
    seeds
        Which seeds.
    key
        Names what comes out, in a store.
    """

    setting: Setting
    seeds: range
    key: Hashable

    def __len__(self) -> int:
        """Return the number of seasons."""
        return len(self.seeds)


@dataclass(frozen=True, eq=False)
class Experiment(Generic[Setting, Result]):
    """Settings x seeds, and how a chunk of them is simulated.

    Parameters
    ----------
    settings
        Scenarios, contenders, or pairs of them.
    seeds
        The seeds that each setting meets.
    simulate
        ``simulate(setting, seeds)`` returns what the seasons of a chunk come to. Where chunks run
        in other processes it travels with the settings, so all of them must be picklable.
    chunk_size
        How many seasons of a setting are simulated in one go; None: all.
    key
        ``key(setting, seeds)`` names a chunk; None: setting and first seed.
    seed_by_seed
        Whether all settings meet a seed before any meets the next, so that they can be compared
        at any time.
    """

    settings: Sequence[Setting]
    seeds: range
    simulate: Callable[[Setting, range], Result]
    chunk_size: Callable[[Setting], int] | None = None
    key: Callable[[Setting, range], Hashable] | None = None
    seed_by_seed: bool = False

    def __post_init__(self) -> None:
        if not self.seeds:
            raise SettingError("An experiment needs 1 seed or more, but it has none.")

    def __len__(self) -> int:
        """Return the number of seasons."""
        return len(self.settings) * len(self.seeds)

    def chunks(self) -> Iterable[Chunk[Setting]]:
        """Return the chunks in their order: the same ones, whoever simulates them."""
        cut = (chunk for setting in self.settings for chunk in self._cut(setting))
        return sorted(cut, key=lambda chunk: chunk.seeds.start) if self.seed_by_seed else cut

    def _cut(self, setting: Setting) -> Iterator[Chunk[Setting]]:
        size = len(self.seeds) if self.chunk_size is None else self.chunk_size(setting)
        for first in range(0, len(self.seeds), size):
            seeds = self.seeds[first : first + size]
            key = (setting, seeds.start) if self.key is None else self.key(setting, seeds)
            yield Chunk(setting, seeds, key)


class ResultStore(Protocol[Result_contra]):
    """Where the results of chunks are kept, by their keys."""

    def holds(self, key: Hashable) -> bool:
        """Tell whether a chunk is there already."""
        ...

    def keep(self, key: Hashable, result: Result_contra) -> None:
        """Take what a chunk came to."""
        ...


class Memory(dict["Hashable", Result]):
    """A store of this process: results by key."""

    def holds(self, key: Hashable) -> bool:
        """Tell whether a chunk is there already."""
        return key in self

    def keep(self, key: Hashable, result: Result) -> None:
        """Take what a chunk came to."""
        self[key] = result


def run(
    experiment: Experiment[Setting, Result],
    workers: Workers,
    store: ResultStore[Result],
    progress: Progress | None = None,
    stop: Callable[[], bool] = lambda: False,
) -> None:
    """Simulate all chunks that a store does not hold yet; keep each there as soon as it is done.

    Ctrl-C ends it at once, and what was done is in the store; the same call goes on from there.

    Parameters
    ----------
    experiment
        What is simulated.
    workers
        Who simulates, see `executor`.
    store
        Where results are looked for and kept.
    progress
        Hears how many of all seasons there are, at the beginning and after each chunk.
    stop
        Asked before a chunk is handed out; once it says so, only those at work are finished.
    """
    total = len(experiment)
    left = [chunk for chunk in experiment.chunks() if not store.holds(chunk.key)]
    done = total - sum(len(chunk) for chunk in left)
    if progress is not None:
        progress(done, total)
    for chunk, result in _simulated(experiment.simulate, left, workers, stop):
        store.keep(chunk.key, result)
        done += len(chunk)
        if progress is not None:
            progress(done, total)


def in_settings(progress: Progress | None, n_seeds: int) -> Progress | None:
    """Return what tells of settings to one that is told of seasons, where a chunk is a setting."""
    if progress is None:
        return None
    return lambda done, total: progress(done // n_seeds, total // n_seeds)


def _simulated(
    simulate: Callable[[Setting, range], Result],
    left: Sequence[Chunk[Setting]],
    workers: Workers,
    stop: Callable[[], bool],
) -> Iterator[tuple[Chunk[Setting], Result]]:
    """Have chunks simulated; yield each with its result, in the order they are finished."""
    waiting = iter(left)
    at_work: dict[Future[Result], Chunk[Setting]] = {}

    def hand_out(n: int) -> None:
        for chunk in islice(waiting, n):
            at_work[workers.pool.submit(simulate, chunk.setting, chunk.seeds)] = chunk

    try:
        if not stop():
            hand_out(workers.ahead)
        while at_work:
            for future in wait(at_work, return_when=FIRST_COMPLETED).done:
                yield at_work.pop(future), future.result()
                if not stop():
                    hand_out(1)
                    continue
                for idle in [each for each in at_work if each.cancel()]:
                    del at_work[idle]
    finally:
        for future in at_work:
            future.cancel()
