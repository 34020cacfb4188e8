"""fieldmon beside other ways to the same end, in one run: ``python -m tests.benchmarks.ratios``.

A night beside plain numpy and plain Python, the published simulator beside GNU Octave (if it is
installed), a day's route beside PyVRP (``pip install fieldmon[bench]``). Prints seconds and ratios.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.planning.workday import plan_work
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.studies.thesis.chapter4 import draws, listings
from fieldmon.studies.thesis.chapter4.listing_errors import AS_PUBLISHED
from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial, ThesisStrategy, night_of, walk_of
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS
from tests.benchmarks.scale import best_of, told

SIDE = 317
# PyVRP counts in whole numbers: milliseconds, and so much for an expected find that time driven
# only decides between routes with the same finds (without a price, it knows no near and far)
_MS, _PRIZE = 1000, 10**9
ROUTE_SIDE, ROUTE_HOURS = 20, 3.0
SOLVER_S = (5.0, 30.0)


def say(what, seconds, beside=""):
    sys.stdout.write(f"{what:46s} {told(seconds):>10s}  {beside}\n")


def night_in_numpy(infested, rate, rng):
    """Spread on a rectangle, a whole field at a time: no loop, no neighbours' lists."""
    after = infested.copy()
    after[:, 1:] |= infested[:, :-1] & (rng.random(infested[:, 1:].shape) < rate)
    after[:, :-1] |= infested[:, 1:] & (rng.random(infested[:, 1:].shape) < rate)
    after[1:] |= infested[:-1] & (rng.random(infested[1:].shape) < rate)
    after[:-1] |= infested[1:] & (rng.random(infested[1:].shape) < rate)
    return after


def night_in_python(infested, neighbours, rate, rng):
    """Spread plant by plant, as one would write it down."""
    after = list(infested)
    for plant, sick in enumerate(infested):
        if sick:
            for other in neighbours[plant]:
                if rng.random() < rate:
                    after[other] = True
    return after


def nights():
    import random

    grid = rectangle(SIDE, SIDE)
    infested = np.random.default_rng(1).random(len(grid)) < 0.1
    key = RandomStreams(1).key("spread")
    ours, after = best_of(lambda: night(grid, infested, Spread(0.5), key), 50)
    square, rng = infested.reshape(SIDE, SIDE), np.random.default_rng(2)
    arrays, other = best_of(lambda: night_in_numpy(square, 0.5, rng), 20)
    start, plant = grid.adjacent
    neighbours = [plant[a:b].tolist() for a, b in pairwise(start)]
    listed, draws_of = infested.tolist(), random.Random(3)
    plain, third = best_of(lambda: night_in_python(listed, neighbours, 0.5, draws_of), 5)
    say(f"a night on {len(grid):,} plants", ours, f"{after.mean():.1%} infested after it")
    say("  plain numpy", arrays, f"x {arrays / ours:.1f}, {other.mean():.1%} infested")
    say("  plain Python", plain, f"x {plain / ours:.0f}, {np.mean(third):.1%} infested")


def published():
    """Run the published simulator, two of its slips put right, here and in Octave."""
    field, runs = SCENARIOS["C"], 200
    trial = NoPriorTrial(field, ThesisStrategy(1), 3, rules=AS_PUBLISHED)
    slips = AS_PUBLISHED.without("night_other_face", "phantom_infections")
    walk, dark = walk_of(trial, slips), night_of(trial, slips)
    keys = draws.keys(RandomStreams(1), runs, trial.hours.days)
    ours, (days, _) = best_of(lambda: listings.repeat(walk, dark, trial.START, 0, keys), 20)
    found = days[:, :, listings.FOUND].sum()
    known = days[:, 0, listings.INFESTED].sum() + days[:, :, listings.NEW_TRUE].sum()
    say("a published run, 3 days in scenario C", ours / runs, f"{100 * found / known:.2f} % found")
    octave = shutil.which("octave")
    if octave is None:
        sys.stdout.write("  GNU Octave is not installed\n")
        return
    call = f"published ({field.plants}, {field.vine_rows}, {trial.plant_s}, 0.3, 20)"
    done = subprocess.run(
        [octave, "--no-gui", "--norc", "--quiet", "--eval", call],
        cwd=Path(__file__).parent,
        check=True,
        capture_output=True,
        text=True,
    )
    theirs, percent = (float(word) for word in done.stdout.split())
    say("  GNU Octave", theirs, f"x {theirs / (ours / runs):.0f}, {percent:.2f} % found")


def route_instance():
    """Return a scene: a patchy chance map on 20 x 20 plants, and a short day."""
    aisles = Aisles.of(rectangle(ROUTE_SIDE, ROUTE_SIDE))
    rng = np.random.default_rng(4)
    x, y = aisles.grid.xy_m.T
    chance = np.full(len(aisles.grid), 0.01)
    for _ in range(6):
        k = rng.integers(len(x))
        chance += 0.4 * np.exp(-((x - x[k]) ** 2 + (y - y[k]) ** 2) / (2 * 6.0**2))
    robot = Robot(hours=ROUTE_HOURS).with_times("thesis")
    last = np.full(len(x), NEVER, np.int32)
    return Scene(aisles, robot, chance.clip(0, 0.95), last, seconds_left=robot.day_s)


def seconds_between(scene):
    """Return the seconds from every plant, and the gate as the last, to every other."""
    robot, grid = scene.robot, scene.grid
    places = np.append(np.arange(len(grid)), -1)
    took = scene.aisles.distance_m(places[:, None], places) / robot.speed_m_s
    corridor, side = grid.corridor[grid.row], grid.side[grid.row]
    other = corridor[:, None] != corridor
    took[:-1, :-1] += robot.row_change_s * other
    took[:-1, :-1] += robot.turn_180_s * (~other & (side[:, None] != side))
    return took


def solved(scene, took, most_s):
    """Return seconds and expected finds of the route that PyVRP finds in so many seconds."""
    from pyvrp import Model
    from pyvrp.stop import MaxRuntime

    whole = np.ceil(took * _MS).astype(int)
    model = Model()
    gate = model.add_location(0, 0)
    depot = model.add_depot(gate)
    plants = [model.add_location(0, 0) for _ in scene.chance]
    for place, prize in zip(plants, scene.chance, strict=True):
        service = int(scene.robot.visit_s * _MS)
        model.add_client(place, service_duration=service, prize=int(prize * _PRIZE), required=False)
    model.add_vehicle_type(
        start_depot=depot,
        end_depot=depot,
        shift_duration=int(scene.seconds_left * _MS),
    )
    nodes = [*plants, gate]
    for i, one in enumerate(nodes):
        for j, other in enumerate(nodes):
            if i != j:
                model.add_edge(one, other, distance=int(whole[i, j]), duration=int(whole[i, j]))
    began = time.perf_counter()
    result = model.solve(MaxRuntime(most_s), seed=1, display=False)
    if not result.is_feasible():
        return time.perf_counter() - began, float("nan"), 0
    (route,) = result.best.routes()
    return time.perf_counter() - began, route.prizes() / _PRIZE, len(route)


def routes():
    scene = route_instance()
    took, best = seconds_between(scene), 0.0
    n = len(scene.chance)
    sys.stdout.write(f"a day of {ROUTE_HOURS:g} h on {n} plants, most expected finds\n")
    for name in SAMPLERS:
        seconds, work = best_of(lambda name=name: plan_work(scene, sampler(name)), 50)
        finds = scene.chance[work.plant].sum()
        best = max(best, finds)
        say(f"  {name}", seconds, f"{finds:.2f} expected on {len(work)} stops")
    try:
        import pyvrp  # noqa: F401
    except ImportError:
        sys.stdout.write("  PyVRP is not installed: pip install fieldmon[bench]\n")
        return
    for most_s in SOLVER_S:
        seconds, finds, stops = solved(scene, took, most_s)
        beside = f"{finds:.2f} expected on {stops} stops; the best of ours is {best / finds:.1%}"
        say(f"  PyVRP, {most_s:g} s", seconds, beside)


def main():
    nights()
    published()
    routes()


if __name__ == "__main__":
    main()
