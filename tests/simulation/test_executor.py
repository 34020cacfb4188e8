"""Workers: whoever dies, and however many there are, the seasons of a study are the same."""

import logging
import os
import shlex
import signal
import subprocess
import sys
import time
from contextlib import suppress

import psutil
import pytest

from fieldmon.cli.study_run import StudyOptions
from fieldmon.errors import SettingError
from fieldmon.simulation import design, executor, results
from fieldmon.simulation.design import Design, study_of
from fieldmon.simulation.experiment import Experiment, Memory, run
from fieldmon.simulation.results import StudyFolder
from tests.parcels import write_geojson
from tests.simulation.study_plots import area

# a short study has many chunks to lose: CHUNKS of a few seasons each
CHUNK_S, CHUNKS = 0.003, 10
SHORT = Design(("dynamic", "naive"), infested=(0.05,), n_days=4, n_seeds=12)
#: the same for the command
ON = "2026-11-02"
WORDS = "--sampler dynamic --sampler naive --infested 0.05 --days 4 --seeds 12 --date " + ON


@pytest.fixture(scope="module", autouse=True)
def short_chunks():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(design, "_CHUNK_S", CHUNK_S)
        yield


@pytest.fixture(scope="module")
def plot_file(tmp_path_factory):
    """Return the file of the small plot."""
    file = tmp_path_factory.mktemp("plot") / "plot.geojson"
    write_geojson(file, [area(40.0)])
    return file


@pytest.fixture(scope="module")
def plots(plot_file):
    """Return the small plot as the command reads it."""
    return StudyOptions(plot_file, on=ON).plots()


def simulated(folder, plots, asked, workers, progress=None):
    store = StudyFolder(folder, plots, asked)
    run(study_of(plots, asked), workers, store, progress)
    assert store.refused == {}


@pytest.fixture(scope="module")
def two_workers():
    """Return two processes of this machine, which take seconds to start."""
    with executor.cluster(workers=2) as workers:
        yield workers


@pytest.fixture(scope="module")
def undisturbed(plots, tmp_path_factory):
    """Return the folder of the short study, simulated in this thread."""
    folder = tmp_path_factory.mktemp("undisturbed")
    simulated(folder, plots, SHORT, executor.here())
    assert len(list(folder.glob("*/*.parquet"))) == CHUNKS
    return folder


def same_files(one, other):
    parts = [
        {path.relative_to(folder): path.read_bytes() for path in folder.glob("*/*.parquet")}
        for folder in (one, other)
    ]
    assert parts[0].keys() == parts[1].keys()
    assert parts[0] == parts[1]


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


def test_threads_make_the_same_files(plots, undisturbed, tmp_path):
    with executor.threads(2) as workers:
        simulated(tmp_path, plots, SHORT, workers)
    same_files(tmp_path, undisturbed)


def test_the_seasons_do_not_depend_on_how_many_work_nor_on_one_who_dies(
    plots, undisturbed, two_workers, tmp_path
):
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

    simulated(tmp_path, plots, SHORT, two_workers, kill_one)
    assert killed
    same_files(tmp_path, undisturbed)


#: the command, which prints the processes that it started and dies as it has kept two chunks
_DIES = f"""
import os, psutil, signal
from fieldmon.cli.main import main
from fieldmon.simulation import design, results

def keep_two(folder, key, result):
    keep(folder, key, result)
    if len(list(folder.folder.glob("*/*.parquet"))) == 2:
        print(*[child.pid for child in psutil.Process().children(recursive=True)], flush=True)
        os.kill(os.getpid(), signal.SIGKILL)

design._CHUNK_S = {CHUNK_S}
keep, results.StudyFolder.keep = results.StudyFolder.keep, keep_two
main()
"""


def still_there(pids):
    for pid in pids:
        with suppress(psutil.NoSuchProcess):
            yield psutil.Process(pid)


def test_a_killed_client_costs_only_unfinished_chunks(plot_file, plots, undisturbed, tmp_path):
    folder, said = tmp_path / "killed", tmp_path / "said"
    words = [sys.executable, "-c", _DIES, "study", "run", str(plot_file), *shlex.split(WORDS)]
    words += ["--workers", "1", "-o", str(folder)]
    with said.open("w") as out:  # no pipe: one would be open as long as its workers are
        died = subprocess.run(words, stdout=out, stderr=subprocess.DEVNULL, check=False)
    assert died.returncode == -signal.SIGKILL
    children = [int(pid) for pid in said.read_text().splitlines()[-1].split()]
    assert children
    _, alive = psutil.wait_procs(list(still_there(children)), timeout=60)
    assert not alive, "workers outlive the client that started them"
    half = {path: path.stat().st_mtime_ns for path in folder.glob("*/*.parquet")}
    assert len(half) == 2
    simulated(folder, plots, SHORT, executor.here())
    same_files(folder, undisturbed)
    assert all(path.stat().st_mtime_ns == written for path, written in half.items())


def test_no_scheduler_is_a_sentence(monkeypatch):
    monkeypatch.setattr(executor, "_CONNECT_S", 0.5)
    with pytest.raises(SettingError, match="dask scheduler"), executor.cluster("tcp://127.0.0.1:9"):
        pass


@pytest.mark.usefixtures("two_workers")
def test_a_cluster_that_is_there_already_is_used(plots, tmp_path):
    from distributed import default_client

    there = default_client().scheduler.address
    short = Design(samplers=("naive",), n_days=1, n_seeds=2)
    with executor.cluster(there) as workers:
        assert default_client().scheduler.address == there
        simulated(tmp_path, plots, short, workers)
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
