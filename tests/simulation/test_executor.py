"""A study on Dask: whoever dies, and however many work, the seasons are the same."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import psutil
import pyarrow.parquet as pq
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.cli import study_run
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.observations import Observations
from fieldmon.plot.field import Field
from fieldmon.plot.layout import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.travel import Aisles
from fieldmon.simulation import design, executor, results
from fieldmon.simulation import worker as study_chunks
from fieldmon.simulation.design import Case, Design, Site, chunks
from tests.parcels import write_geojson

FRAME = Frame(5.0, 45.0)
DAY = np.datetime64("2026-11-02")


def area(size_m):
    return FRAME.geometry_lonlat(MultiPolygon([shapely.box(0, 0, 2 * size_m, size_m)]))


def site(size_m=40.0, name="plot"):
    return Site(Field(name, area(size_m)), Planting(), Observations.none(), DAY)


SMALL = Design(hours=(1.0, 3.0), n_days=4, n_seeds=60, infested=(0.05,))
# a short study has many chunks to lose
CHUNK_S = 0.02


@pytest.fixture(scope="module", autouse=True)
def short_chunks():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(design, "_CHUNK_S", CHUNK_S)
        yield


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """Return the seasons of the small study, simulated here, without Dask."""
    folder = tmp_path_factory.mktemp("undisturbed")
    results.begin(folder, (site(),), SMALL)
    for chunk in chunks((site(),), SMALL):
        results.keep(folder, chunk, study_chunks.run_chunk(chunk))
    return folder


def same_files(one, other):
    parts = [
        {path.relative_to(folder): path.read_bytes() for path in folder.glob("*/*.parquet")}
        for folder in (one, other)
    ]
    assert parts[0].keys() == parts[1].keys()
    assert parts[0] == parts[1]


def quiet(done, total):
    assert 0 <= done <= total


@pytest.mark.parametrize("workers", [1, 2])
def test_the_seasons_do_not_depend_on_the_number_of_workers(undisturbed, tmp_path, workers):
    with executor.cluster(workers=workers) as client:
        assert executor.run(client, tmp_path, (site(),), SMALL, quiet) == {}
    same_files(tmp_path, undisturbed)


def test_a_killed_worker_costs_only_what_it_had_in_hand(undisturbed, tmp_path):
    killed = []

    def kill_one(done, total):  # noqa: ARG001
        workers = client.scheduler_info(n_workers=-1)["workers"]
        if done and not killed and workers:
            pid = client.run(os.getpid)[next(iter(workers))]
            os.kill(pid, signal.SIGKILL)
            killed.append(pid)

    with executor.cluster(workers=2) as client:
        executor.run(client, tmp_path, (site(),), SMALL, kill_one)
    assert killed
    same_files(tmp_path, undisturbed)


def test_a_killed_client_costs_only_unfinished_chunks(tmp_path):
    write_geojson(tmp_path / "plot.geojson", [area(60.0)])
    command = f"from fieldmon.simulation import design; design._CHUNK_S = {CHUNK_S}; "
    command += "from fieldmon.cli.main import main; main()"
    words = [sys.executable, "-c", command, "study", "run", "plot.geojson", "--seeds", "40"]
    words += ["--days", "10", "--workers", "2", "--date", "2026-11-02"]
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
    subprocess.run([*words, "-o", "killed"], cwd=tmp_path, check=True, capture_output=True)
    (tmp_path / "whole").mkdir()
    options = study_run.StudyOptions(tmp_path / "plot.geojson", on="2026-11-02")
    sites = options.sites()
    whole = list(chunks(sites, Design(n_days=10, n_seeds=40)))
    for chunk in whole:
        results.keep(tmp_path / "whole", chunk, study_chunks.run_chunk(chunk))
    assert 0 < len(half) < len(whole)
    same_files(tmp_path / "killed", tmp_path / "whole")
    assert all(path.stat().st_mtime_ns == written for path, written in half.items())


def test_a_plot_without_room_is_refused_and_the_others_go_on(tmp_path):
    short = Design(samplers=("naive",), n_days=1, n_seeds=2)
    with executor.cluster(workers=1) as client:
        refused = executor.run(client, tmp_path, (site(), site(1.0, "tiny")), short, quiet)
    assert set(refused) == {"tiny"}
    assert set(results.seasons(tmp_path)["plot"].to_pylist()) == {"plot"}


def test_no_scheduler_is_a_sentence(monkeypatch):
    monkeypatch.setattr(executor, "_CONNECT_S", 0.5)
    with pytest.raises(SettingError, match="dask scheduler"), executor.cluster("tcp://127.0.0.1:9"):
        pass


def test_a_season_of_a_study_is_that_of_the_simulator(undisturbed):
    from fieldmon.infestation.prior import PriorSettings, prior_chance, start_infested
    from fieldmon.infestation.spread import Spread
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers import sampler
    from fieldmon.simulation.metrics import figures
    from fieldmon.simulation.season import SeasonSettings, Start, days

    rows = results.seasons(undisturbed).to_pylist()
    assert len(rows) == 3 * 2 * 60
    row = next(r for r in rows if (r["sampler"], r["hours"], r["seed"]) == ("dynamic", 3.0, 37))
    plot = Plot.of(site().field, Planting())
    assert isinstance(plot.aisles, Aisles)
    chance = prior_chance(plot.grid, plot.field, Observations.none(), DAY, PriorSettings())
    start = Start(start_infested(chance, 0.05, RandomStreams(37).of("start")), chance)
    settings = SeasonSettings(n_days=4, spread=Spread(0.1))
    walk = days(
        plot.aisles, Robot(hours=3.0), sampler("dynamic"), start, settings, RandomStreams(37)
    )
    season = figures(walk)
    assert row["found_by_day"] == season.found.tolist()
    assert row["detection_pct"] == season.detection_pct[-1]
    assert row["infested_plant_days"] == season.infested_plant_days


def test_all_samplers_of_a_seed_start_with_the_same_insects(undisturbed):
    first = {}
    for row in results.seasons(undisturbed).to_pylist():
        before = row["found_by_day"][0] + row["left_by_day"][0]
        assert first.setdefault(row["seed"], before) == before


def test_chunks_hold_every_season_once_whatever_the_size_of_the_plot():
    for size_m in (10.0, 400.0):
        seasons = [
            (chunk.case, seed)
            for chunk in chunks((site(size_m),), SMALL)
            for seed in range(*chunk.seeds)
        ]
        assert len(seasons) == len(set(seasons)) == len(SMALL.cases) * SMALL.n_seeds
    assert SMALL.cases[0] == Case("naive", 1.0, 40.0, 0.05, 0.1)


def test_another_plot_setting_or_seed_has_other_keys():
    def keys(one, study):
        return {chunk.key for chunk in chunks((one,), study)}

    base = keys(site(), SMALL)
    assert base == keys(site(), SMALL)
    for other in (site(41.0), site(name="other")):
        assert not base & keys(other, SMALL)
    assert not base & keys(site(), Design(hours=(1.0, 3.0), n_days=5, n_seeds=60))


def test_a_folder_with_another_study_is_refused(tmp_path):
    results.begin(tmp_path, (site(),), SMALL)
    results.begin(tmp_path, (site(),), SMALL)
    with pytest.raises(SettingError, match="another study"):
        results.begin(tmp_path, (site(),), Design())


def test_a_folder_without_seasons_is_refused(tmp_path):
    with pytest.raises(FileProblem, match="finished seasons"):
        results.seasons(tmp_path)


def test_the_dataset_is_read_by_any_reader_of_parquet(undisturbed):
    table = pq.read_table(undisturbed)
    assert table.num_rows == results.seasons(undisturbed).num_rows
    assert set(table["sampler"].to_pylist()) == {"naive", "bouncy", "dynamic"}


@pytest.mark.parametrize(
    "settings",
    [
        {"samplers": ("best",)},
        {"hours": ()},
        {"n_days": 0},
        {"infested": (0.0,)},
        {"spread": (1, 1)},
    ],
)
def test_impossible_designs_are_refused(settings):
    with pytest.raises(SettingError):
        Design(**settings)


def test_a_cluster_that_is_there_already_is_used(tmp_path):
    from distributed import LocalCluster

    short = Design(samplers=("naive",), n_days=1, n_seeds=2)
    there = LocalCluster(
        n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    )
    with there, executor.cluster(there.scheduler_address) as client:
        assert client.scheduler.address == there.scheduler_address
        executor.run(client, tmp_path, (site(),), short, quiet)
    assert results.seasons(tmp_path).num_rows == 2
