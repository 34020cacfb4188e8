"""Loading compiled loops by using them."""

from app.startup import compiled_loops
from fieldmon.samplers import SAMPLERS


def test_planning_and_simulating_on_a_few_plants_raise_nothing():
    compiled_loops.load_planning()
    compiled_loops.load_simulation()


def test_what_compare_and_simulate_begin_with_is_simulated(monkeypatch):
    played = []
    monkeypatch.setattr(
        compiled_loops,
        "simulated_days",
        lambda _aisles, _robot, decides, *_: played.append(decides) or [],
    )
    compiled_loops.load_simulation()
    names = {type(decides).__name__.lower() for decides in played}
    assert names == {"adaptive", "dynamic", "naive"} <= SAMPLERS.keys()
