"""A thousand plots in one command, and a study on one worker and on two."""

import csv
import subprocess
import sys
import time

import numpy as np
import pytest

from fieldmon.io.read import read_plots
from tests.parcels import many, write_geojson
from tests.paths import SAMPLE_DATA, SHARED

DATA = SHARED / "data"
ESTATE = SAMPLE_DATA / "paran_estate.geojson"


@pytest.fixture
def parcels(tmp_path):
    """Return a file of 1 000 plots: 158 real parcels, shifted and turned again and again."""
    if not DATA.is_dir():
        pytest.skip(f"the real data folder {DATA} is not on this machine")
    files = sorted((DATA / "parcels_orchards_vineyards").glob("*.gpkg"))
    files.append(DATA / "parcels_rlp_vineyards" / "vineyards.shp")
    fields = [field for file in files for field in read_plots(file).value]
    rng = np.random.default_rng(1)
    write_geojson(
        tmp_path / "parcels.geojson",
        many(fields, 1000),
        hours=rng.choice([4.0, 8.0, 12.0], 1000).tolist(),
        robot=rng.choice(["robot", "scout"], 1000).tolist(),
    )
    return tmp_path / "parcels.geojson"


@pytest.mark.benchmark(group="1 000 plots of real parcels in one command")
@pytest.mark.timeout(1800)
def test_a_thousand_plots_are_planned_in_one_command(benchmark, parcels):
    """Within 60 s on two cores, starting the workers included."""
    words = [*[sys.executable, "-m", "fieldmon", "plan", str(parcels), "--all", "-o"], "routes"]

    def command():
        subprocess.run(words, cwd=parcels.parent, check=True, capture_output=True)

    benchmark.pedantic(command, rounds=1)
    with (parcels.parent / "routes" / "summary.csv").open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 1000
    assert sum(row["state"] == "planned" for row in rows) > 900
    assert all(row["sentence"] for row in rows if row["state"] == "refused")


@pytest.mark.benchmark(group="a study on one worker and on two")
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("workers", [1, 2])
def test_a_study_of_seasons(benchmark, tmp_path, workers):
    """Two workers take 1 / 1.8 of one's time or less (workers warmed up, cores free)."""
    from distributed import default_client

    from fieldmon.infestation.records import Records
    from fieldmon.plot.plot import planting_of
    from fieldmon.simulation import executor
    from fieldmon.simulation.design import Design, study_of
    from fieldmon.simulation.experiment import run
    from fieldmon.simulation.results import StudyFolder
    from fieldmon.simulation.study_plot import StudyPlot
    from fieldmon.simulation.worker import simulate_chunk

    (field,) = (f for f in read_plots(ESTATE).value if f.name == "Gate")
    plots = [StudyPlot(field, planting_of(field), Records.none(), np.datetime64("2026-11-02"))]
    with executor.cluster(workers=workers) as ready:
        warm = (plots[0], Design().combinations[0])
        default_client().run(simulate_chunk, warm, range(1, 2), 1)

        def study():
            asked = Design(n_seeds=400)
            folder = StudyFolder(tmp_path / str(time.monotonic_ns()), plots, asked)
            run(study_of(plots, asked), ready, folder)

        benchmark.pedantic(study, rounds=1)
