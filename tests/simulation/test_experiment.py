"""An experiment is simulated once, whoever does it, and goes on where it was stopped."""

import threading
from concurrent.futures import ProcessPoolExecutor

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import SettingError
from fieldmon.simulation import executor
from fieldmon.simulation.executor import Workers
from fieldmon.simulation.experiment import Experiment, Memory, in_settings, run


def squares(setting, seeds):
    """Return what a chunk comes to, in the place of seasons."""
    return [setting * seed * seed for seed in seeds]


def experiment(**more):
    return Experiment((2, 3, 5), range(1, 12), squares, **({"chunk_size": lambda _: 4} | more))


def results(workers, **more):
    made = Memory()
    run(experiment(**more), workers, made)
    return made


EXPECTED = {
    (setting, first): squares(setting, range(first, min(first + 4, 12)))
    for setting in (2, 3, 5)
    for first in (1, 5, 9)
}


@given(
    sizes=st.lists(st.integers(1, 9), min_size=1, max_size=5),
    seeds=st.integers(1, 30),
    by_seed=st.booleans(),
)
def test_chunks_hold_every_setting_and_seed_once_under_a_key_of_its_own(sizes, seeds, by_seed):
    settings = tuple(range(len(sizes)))
    one = Experiment(
        settings, range(5, 5 + seeds), squares, sizes.__getitem__, seed_by_seed=by_seed
    )
    chunks = list(one.chunks())
    met = [(chunk.setting, seed) for chunk in chunks for seed in chunk.seeds]
    assert sorted(met) == [(s, k) for s in settings for k in range(5, 5 + seeds)]
    assert len({chunk.key for chunk in chunks}) == len(chunks)
    assert sum(map(len, chunks)) == len(one)
    assert all(1 <= len(chunk) <= sizes[chunk.setting] for chunk in chunks)


def test_seed_by_seed_all_settings_meet_a_seed_before_the_next():
    chunks = experiment(chunk_size=lambda _: 1, seed_by_seed=True).chunks()
    order = [(chunk.seeds.start, chunk.setting) for chunk in chunks]
    assert order == sorted(order)


def test_an_experiment_without_seeds_is_refused():
    with pytest.raises(SettingError, match="1 seed or more"):
        Experiment((1,), range(0), squares)


def test_threads_processes_and_this_thread_come_to_the_same():
    assert results(executor.here()) == EXPECTED
    for n in (1, 3):
        with executor.threads(n) as workers:
            assert results(workers) == EXPECTED
    with ProcessPoolExecutor(2) as pool:
        assert results(Workers(pool, 4), chunk_size=lambda _: 4) == EXPECTED


def test_what_a_store_holds_is_not_simulated_again():
    made = Memory({(3, 5): "kept"})
    told = []
    run(experiment(), executor.here(), made, lambda *n: told.append(n))
    assert made == EXPECTED | {(3, 5): "kept"}
    assert told[0] == (4, 33)
    assert told[-1] == (33, 33)


def test_progress_counts_seasons_from_what_is_there_to_all():
    told = []
    run(experiment(), executor.here(), Memory(), lambda *n: told.append(n))
    assert [done for done, _ in told] == [0, 4, 8, 11, 15, 19, 22, 26, 30, 33]
    assert {total for _, total in told} == {33}


def test_progress_in_settings_counts_settings():
    told = []
    progress = in_settings(lambda *n: told.append(n), 11)
    run(Experiment((2, 3, 5), range(11), squares), executor.here(), Memory(), progress)
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]
    assert in_settings(None, 11) is None


@pytest.mark.parametrize("n", [None, 2])
def test_ctrl_c_keeps_what_is_done_and_the_same_call_goes_on(n):
    made, simulated = Memory(), []

    def simulate(setting, seeds):
        simulated.append((setting, seeds.start))
        return squares(setting, seeds)

    def ctrl_c(done, _):
        if done >= 12:
            raise KeyboardInterrupt

    one = Experiment((2, 3, 5), range(1, 12), simulate, lambda _: 4)
    with executor.threads(n or 1) as threads:
        workers = executor.here() if n is None else threads
        with pytest.raises(KeyboardInterrupt):
            run(one, workers, made, ctrl_c)
    assert 3 <= len(made) < 9
    assert made.items() <= EXPECTED.items()
    kept, before = set(made), len(simulated)
    with executor.threads(2) as workers:
        run(one, workers, made)
    assert made == EXPECTED
    assert not kept & set(simulated[before:])


def test_an_error_in_a_chunk_ends_the_experiment_and_keeps_what_was_done():
    def simulate(setting, seeds):
        if setting == 3:
            raise SettingError("no")
        return squares(setting, seeds)

    made = Memory()
    with pytest.raises(SettingError, match="no"):
        run(Experiment((2, 3, 5), range(3), simulate), executor.here(), made)
    assert made == {(2, 0): [0, 2, 8]}


def test_a_stopped_experiment_finishes_what_is_at_work_and_hands_out_no_more():
    stop, at_work = threading.Event(), threading.Barrier(3, timeout=20)

    def simulate(setting, seeds):
        if not stop.is_set():
            at_work.wait()
            at_work.wait()
        return squares(setting, seeds)

    made = Memory()
    one = Experiment((2, 3, 5), range(1, 12), simulate, lambda _: 4)
    with executor.threads(2) as workers:
        running = threading.Thread(target=run, args=(one, workers, made, None, stop.is_set))
        running.start()
        at_work.wait()
        stop.set()
        at_work.wait()
        running.join(20)
    assert not running.is_alive()
    assert 2 <= len(made) < 9
    assert made.items() <= EXPECTED.items()
    nothing = Memory()
    run(one, executor.here(), nothing, None, lambda: True)
    assert nothing == {}


def test_this_thread_hands_a_result_over_before_it_begins_the_next():
    seen = []

    def simulate(setting, seeds):  # noqa: ARG001
        seen.append(len(made))
        return setting

    made = Memory()
    run(Experiment(tuple(range(5)), range(1), simulate), executor.here(), made)
    assert seen == [0, 1, 2, 3, 4]
