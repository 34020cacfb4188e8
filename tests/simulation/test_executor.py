"""Workers: whoever dies, and however many there are, the seasons of a study are the same."""

import logging
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import psutil
import pytest

from fieldmon.cli import study_run
from fieldmon.errors import SettingError
from fieldmon.simulation import design, executor, results
from fieldmon.simulation.design import Design, study_of
from fieldmon.simulation.experiment import Experiment, Memory, run
from fieldmon.simulation.results import StudyFolder
from tests.parcels import write_geojson
from tests.simulation.study_plots import SMALL, area, plot

# a short study has many chunks to lose: twelve of a few seasons each
CHUNK_S = 0.006
SHORT = replace(SMALL, n_seeds=8)


@pytest.fixture(scope="module", autouse=True)
def short_chunks():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(design, "_CHUNK_S", CHUNK_S)
        yield


def simulated(folder, plots, asked, workers, progress=None):
    store = StudyFolder(folder, plots, asked)
    run(study_of(plots, asked), workers, store, progress)
    return store


@pytest.fixture(scope="module")
def two_workers():
    """Return two processes of this machine, which take seconds to start."""
    with executor.cluster(workers=2) as workers:
        yield workers


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """Return the folder of the small study, simulated in this thread."""
    folder = tmp_path_factory.mktemp("undisturbed")
    simulated(folder, [plot()], SHORT, executor.here())
    return folder


def same_files(one, other):
    parts = [
        {path.relative_to(folder): path.read_bytes() for path in folder.glob("*/*.parquet")}
        for folder in (one, other)
    ]
    assert parts[0].keys() == parts[1].keys()
    assert parts[0] == parts[1]


def test_the_seasons_do_not_depend_on_the_number_of_workers(undisturbed, two_workers, tmp_path):
    assert simulated(tmp_path, [plot()], SHORT, two_workers).refused == {}
    same_files(tmp_path, undisturbed)


def _pid(setting, seeds):  # noqa: ARG001
    time.sleep(0.05)
    return os.getpid()


def test_a_cluster_works_in_processes_of_its_own(two_workers):
    made = Memory()
    run(Experiment(tuple(range(12)), range(1), _pid), two_workers, made)
    assert os.getpid() not in made.values()
    assert len(set(made.values())) == 2


def _holds_ctrl_c(setting, seeds):  # noqa: ARG001
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])


def test_ctrl_c_is_heard_here_and_by_no_worker(two_workers):
    made = Memory()
    run(Experiment(tuple(range(4)), range(1), _holds_ctrl_c), two_workers, made)
    assert all(made.values())
    assert not _holds_ctrl_c(None, None)


def _level(setting, seeds):  # noqa: ARG001
    return logging.getLogger("distributed.worker.state_machine").getEffectiveLevel()


def test_workers_say_nothing_of_their_own_at_the_terminal(two_workers):
    made = Memory()
    run(Experiment(tuple(range(4)), range(1), _level), two_workers, made)
    assert set(made.values()) == {logging.CRITICAL}


def test_threads_make_the_same_files(undisturbed, tmp_path):
    with executor.threads(2) as workers:
        simulated(tmp_path, [plot()], SHORT, workers)
    same_files(tmp_path, undisturbed)


def test_a_killed_worker_costs_only_what_it_had_in_hand(undisturbed, two_workers, tmp_path):
    from distributed import default_client

    killed = []

    def kill_one(done, total):
        assert 0 <= done <= total
        client = default_client()
        workers = client.scheduler_info(n_workers=-1)["workers"]
        if done and not killed and workers:
            pid = client.run(os.getpid)[next(iter(workers))]
            os.kill(pid, signal.SIGKILL)
            killed.append(pid)

    simulated(tmp_path, [plot()], SHORT, two_workers, kill_one)
    assert killed
    same_files(tmp_path, undisturbed)


def test_a_killed_client_costs_only_unfinished_chunks(two_workers, tmp_path):
    write_geojson(tmp_path / "plot.geojson", [area(60.0)])
    command = f"from fieldmon.simulation import design; design._CHUNK_S = {CHUNK_S}; "
    command += "from fieldmon.cli.main import main; main()"
    words = [sys.executable, "-c", command, "study", "run", "plot.geojson", "--seeds", "12"]
    words += ["--days", "10", "--workers", "1", "--date", "2026-11-02"]
    command = subprocess.Popen([*words, "-o", "killed"], cwd=tmp_path, stderr=subprocess.DEVNULL)
    until = time.monotonic() + 200
    while not list(tmp_path.glob("killed/*/*.parquet")) and time.monotonic() < until:
        time.sleep(0.02)
    children = psutil.Process(command.pid).children(recursive=True)
    os.kill(command.pid, signal.SIGKILL)
    command.wait()
    _, alive = psutil.wait_procs(children, timeout=60)
    assert not alive, "workers outlive the client that started them"
    half = {path: path.stat().st_mtime_ns for path in tmp_path.glob("killed/*/*.parquet")}
    plots = study_run.StudyOptions(tmp_path / "plot.geojson", on="2026-11-02").plots()
    asked = Design(n_days=10, n_seeds=12)
    simulated(tmp_path / "killed", plots, asked, two_workers)
    simulated(tmp_path / "whole", plots, asked, executor.here())
    assert 0 < len(half) < len(list(study_of(plots, asked).chunks()))
    same_files(tmp_path / "killed", tmp_path / "whole")
    assert all(path.stat().st_mtime_ns == written for path, written in half.items())


def test_no_scheduler_is_a_sentence(monkeypatch):
    monkeypatch.setattr(executor, "_CONNECT_S", 0.5)
    with pytest.raises(SettingError, match="dask scheduler"), executor.cluster("tcp://127.0.0.1:9"):
        pass


@pytest.mark.usefixtures("two_workers")
def test_a_cluster_that_is_there_already_is_used(tmp_path):
    from distributed import default_client

    there = default_client().scheduler.address
    short = Design(samplers=("naive",), n_days=1, n_seeds=2)
    with executor.cluster(there) as workers:
        assert default_client().scheduler.address == there
        simulated(tmp_path, [plot()], short, workers)
    assert results.seasons(tmp_path).num_rows == 2


@pytest.mark.usefixtures("two_workers")
def test_a_chunk_that_kills_its_workers_is_a_sentence():
    from distributed import default_client

    client = default_client()
    # Dask tries a chunk on some workers, each of which is started anew
    client.run_on_scheduler(_allow_no_failure)
    with (
        pytest.raises(SettingError, match="ended several workers"),
        executor.cluster(client.scheduler.address) as workers,
    ):
        run(Experiment((1,), range(1), _die), workers, Memory())


def _allow_no_failure(dask_scheduler):
    dask_scheduler.allowed_failures = 0


def _die(setting, seeds):  # noqa: ARG001
    os._exit(1)


def test_who_leaves_threads_leaves_no_chunk_that_has_not_begun():
    def left():
        with executor.threads(1) as workers:
            done = [workers.pool.submit(time.sleep, 0.05) for _ in range(50)]
            raise KeyboardInterrupt(done)

    with pytest.raises(KeyboardInterrupt) as stopped:
        left()
    assert sum(one.cancelled() for one in stopped.value.args[0]) >= 45
