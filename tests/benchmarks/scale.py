"""How everything grows with the plot: ``python -m tests.benchmarks.scale`` prints a table.

Each size runs in a process of its own, so that its memory is its own; compiling is left out.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from datetime import date
from itertools import pairwise
from pathlib import Path

import numpy as np

from app.show.maps import colours, deck, plant_layers, route_layers
from app.show.maps.plant_layers import PlantNotes
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.infestation.pairs.independent_plants import IndependentPlants, overnight
from fieldmon.infestation.pairs.pairs import PairApproximation, pair_chances
from fieldmon.infestation.prior.prior import prior_chance, start_infested
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import ABSENT, PRESENT, Records
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import plan_work
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from tests.benchmarks.test_bench_grid import crooked_plot

SIZES = (100, 1_000, 10_000, 100_000, 1_000_000)
DAY = np.datetime64("2026-05-20")
RECORDS = 10_000
THESIS = ("naive", "bouncy", "dynamic")


def best_of(measured, most=7, at_most_s=2.0):
    """Return the least seconds of several runs, and what the last one returned."""
    seconds, began = [], time.perf_counter()
    while len(seconds) < most and (not seconds or time.perf_counter() - began < at_most_s):
        start = time.perf_counter()
        result = measured()
        seconds.append(time.perf_counter() - start)
    return min(seconds), result


def records_on(grid, rng):
    lonlat = grid.lonlat(rng.integers(0, len(grid), RECORDS))
    return Records.of(
        lonlat + rng.normal(0.0, 2e-5, lonlat.shape),
        rng.choice([ABSENT, PRESENT], RECORDS, p=[0.8, 0.2]),
        DAY - rng.integers(0, 60, RECORDS),
    )


def measure(n_plants):
    """Return seconds by what was done on a crooked plot of about so many plants."""
    took, rng = {}, np.random.default_rng(5)
    field = crooked_plot(n_plants)
    planting = Planting(row_bearing_deg=33.0, headland_m=1.0)
    took["laying the plants"], grid = best_of(lambda: lay(field, planting))
    took["finding the ways"], aisles = best_of(lambda: Aisles.of(grid))
    plot, records = Plot(field, aisles), records_on(grid, rng)
    took[f"chances from {RECORDS:,} records"], chance = best_of(
        lambda: prior_chance(grid, field, records, DAY, PriorSettings())
    )
    n = len(grid)
    infested = rng.random(n) < 0.1
    spread, key = Spread(0.5), RandomStreams(1).key("spread")
    took["a night, a tenth infested"], _ = best_of(lambda: night(grid, infested, spread, key))
    took["a night of the chance map"], _ = best_of(lambda: overnight(chance, grid, spread))
    last = np.full(n, NEVER, np.int32)
    # as the app, the commands and a season plan: with what is believed of plants side by side
    took["what is believed of neighbours"], pair_chance = best_of(
        lambda: pair_chances(chance, grid)
    )
    scene = Scene(
        aisles, Robot(), chance, last, seconds_left=Robot().day_s, pair_chance=pair_chance
    )
    for name in SAMPLERS:
        took[f"a day's plan and route: {name}"], _ = best_of(
            lambda name=name: route_of(scene, plan_work(scene, sampler(name)))
        )
    start = Start(start_infested(chance, 0.02, RandomStreams(1).of("start")), chance)
    for name in THESIS:
        took[f"a season of 25 days: {name}"], _ = best_of(
            lambda name=name: season(aisles, name, start)
        )
    took |= files_and_map(plot, chance, records)
    return {"plants": n, "took": took, "memory_mb": memory_mb()}


def season(aisles, name, start, believe=PairApproximation.of):
    settings = SimulationSettings(n_days=25, spread=Spread(0.1), believe=believe)
    walk = simulated_days(aisles, Robot(), sampler(name), start, settings, RandomStreams(2))
    return [day.detection_pct for day in walk]


def files_and_map(plot, chance, records):
    """Return the seconds of writing the route, of a season's file, and of the first map."""
    took = {}
    today = plan_from(plot, chance, PlanSettings())
    with tempfile.TemporaryDirectory() as folder:
        to = Path(folder)
        route = replace(today.route, notes=RouteNotes("plot", "adaptive"))
        took["writing the route"], _ = best_of(lambda: route.to_file(to / "route.geojson"))
        setup = MonitoringSettings(date(2026, 5, 20))
        took["beginning a season's file"], _ = best_of(
            lambda: Season.create(to / "season.gpkg", plot, records, setup), 1
        )
        took["opening a season's file"], _ = best_of(lambda: Season(to / "season.gpkg"))

    def first_map():
        plants = plant_layers.plants(plot.grid, colours.by_chance(chance), PlantNotes(chance))
        layers = [plants, *route_layers.route(today.route)]
        return [deck.published(layer) for layer in layers]

    took["the first map, as sent to the browser"], _ = best_of(first_map)
    return took


def memory_mb():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024


def per_visit_and_night():
    """Return the ns that a plant visit costs, and a plant's night, on 91 x 91 plants."""
    from fieldmon.plot.layout import rectangle

    aisles = Aisles.of(rectangle(91, 91))
    n = len(aisles.grid)
    chance, last = np.full(n, 0.02), np.full(n, NEVER, np.int32)
    visits = {}
    for name in THESIS:
        scene = Scene(aisles, Robot(), chance, last, seconds_left=Robot().day_s)
        took, work = best_of(lambda scene=scene, name=name: plan_work(scene, sampler(name)), 200)
        visits[name] = took / len(work) * 1e9
    infested = np.random.default_rng(1).random(n) < 0.1
    nights = {
        "insects": best_of(
            lambda: night(aisles.grid, infested, Spread(0.5), RandomStreams(1).key("x")), 200
        )[0],
        "chance map": best_of(lambda: overnight(chance, aisles.grid, Spread(0.5)), 200)[0],
    }
    copied = best_of(lambda: np.multiply(chance, 0.5), 200)[0]
    return (
        visits
        | {name: took / n * 1e9 for name, took in nights.items()}
        | {"reading and writing 8 bytes": copied / n * 1e9}
    )


def seasons():
    """Return the seconds of a season of 25 days on 91 x 91 plants.

    What is believed: pairs of plants as everywhere, or plants one by one. Naive and Bouncy do not
    ask for it, so for them it is not worked out.
    """
    from fieldmon.plot.layout import rectangle

    aisles = Aisles.of(rectangle(91, 91))
    chance = np.full(len(aisles.grid), 0.02)
    start = Start(start_infested(chance, 0.02, RandomStreams(1).of("start")), chance)
    took = {}
    for name in (*THESIS, "adaptive"):
        for how, believe in (("pairs", PairApproximation.of), ("one by one", IndependentPlants)):
            took[f"a season on 91 x 91 plants: {name}, {how}"], _ = best_of(
                lambda name=name, believe=believe: season(aisles, name, start, believe), 50
            )
    return took


def told(seconds):
    if seconds < 1e-3:
        return f"{seconds * 1e6:.0f} us"
    return f"{seconds * 1e3:.3g} ms" if seconds < 1.0 else f"{seconds:.2f} s"


def table(results):
    """Return the markdown: a row for each thing done, with its growth from size to size."""
    sizes = [result["plants"] for result in results]
    lines = ["| " + " | ".join(["", *(f"{n:,} plants" for n in sizes)]) + " |"]
    lines.append("|---" * (len(sizes) + 1) + "|")
    for what in results[0]["took"]:
        seconds = [result["took"][what] for result in results]
        grown = [f"{told(b)} (x {b / a:.3g})" for a, b in pairwise(seconds)]
        cells = [told(seconds[0]), *grown]
        lines.append("| " + " | ".join([what, *cells]) + " |")
    memory = [f"{result['memory_mb']} MB" for result in results]
    lines.append("| " + " | ".join(["most memory, all of this in one process", *memory]) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--one", type=int, help="Measure one size and print JSON.")
    asked = parser.parse_args()
    if asked.one:
        measure(100)  # loads and compiles
        sys.stdout.write(json.dumps(measure(asked.one)))
        return
    results = []
    for size in asked.sizes:
        command = [sys.executable, "-m", "tests.benchmarks.scale", "--one", str(size)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        results.append(json.loads(done.stdout))
    sys.stdout.write(table(results) + "\n\n")
    for what, ns in per_visit_and_night().items():
        sys.stdout.write(f"{what}: {ns:.2g} ns\n")
    for what, took in seasons().items():
        sys.stdout.write(f"{what}: {told(took)}\n")


if __name__ == "__main__":
    main()
