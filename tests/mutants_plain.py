"""All small faults of some functions, tried at once: loops as plain Python, in this very process.

    python tests/mutants_plain.py
    python tests/mutants_plain.py planning/meetings samplers/decide

For functions that have an oracle of their own (`HELD`), on tiny plots: nothing is compiled, so a
mutant takes milliseconds. `tests/mutants.py` draws from all the others.
"""

import ast
import importlib
import itertools
import os
import signal
import sys
import warnings
from pathlib import Path
from types import FunctionType

os.environ["NUMBA_DISABLE_JIT"] = "1"
ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import pytest  # noqa: E402

from tests.mutants import mutant_function, mutants_of, mutated  # noqa: E402
from tests.mutants_warm import answers_kept, changed_functions, code_of, fault, functions_within  # noqa: E402

# seconds of work after which a fault counts as noticed: a loop without an end
_MOST_S = 20.0
#: a module, the functions that are changed, and how tests of its file begin that are to notice
HELD = (
    ("planning/meetings", ("meetings", "_presences", "_with_stops", "_joined"), "test_"),
    ("io/writers/chance_raster", ("_paint",), "test_each_pixel"),
    ("io/writers/zone_cells", ("narrowest_m",), "test_the_narrowest"),
    ("planning/routes/binned", ("_sweep",), "test_the_sweep"),
    ("planning/routes/blocks", ("blockings", "_way_out", "_gate", "_apart_m", "_tours", "_order"),
     ("test_two_aisles", "test_ways")),
    ("samplers/adaptive/tours", ("measure_ways",), "test_the_ways_measured"),
    ("samplers/adaptive/day", ("_value_finds", "_next_in", "_best_left", "_least_s", "_fits"),
     ("test_a_find_is_worth", "test_the_next", "test_what_is_left", "test_no_plant_of_a_row")),
    ("samplers/adaptive/day",
     ("_inspect", "_learn", "_trace", "_learn_clustering", "_learn_level", "_learn_jumps"),
     ("test_an_inspection", "test_finds_beyond", "test_evidence", "test_pairs", "test_where_noth")),
    ("samplers/decide", ("_walk", "_choose", "_weigh", "_drive_rows", "_turn"), "test_every_look"),
    ("samplers/sweeps", ("_walk", "_first", "_place"), "test_every_stop"),
    ("samplers/without_prior", ("_walk", "_next_here", "_turned", "_sweep"), "test_every_stop"),
    ("infestation/insects/latency", ("likely", "nights", "hides", "hidden", "inspected", "_said",
                             "levelled", "overnight", "treated"),
     ("test_candidates", "test_a_day_s", "test_a_clean_ins", "test_what_cand", "test_each_cand",
      "test_however")),
    ("infestation/tracing/tracing", ("trace", "_raise", "rescale_traced"),
     ("test_each_plant", "test_what_jumps_brought_counts")),
    ("infestation/tracing/traced_day", ("_count", "_share", "_share_traced"),
     ("test_finds_are", "test_what_a_chance", "test_what_a_find")),
    ("infestation/tracing/traced_doubt", ("doubt_of_number", "doubt_of_rates", "_by_origins"),
     ("test_the_number", "test_offspring")),
    ("infestation/tracing/traced_evening", ("counting", "lowered"),
     ("test_counts", "test_what_was_found")),
    ("infestation/tracing/traced_map", ("times",), "test_known_finds_keep"),
    ("infestation/tracing/traced_night",
     ("by_origins", "brought_from_afar", "_shares_after", "_of_late"),
     ("test_a_night_brings", "test_what_lands", "test_the_wind")),
    ("planning/headlands", ("_cut", "steps"), "test_steps_in"),
    ("planning/team_day",
     ("_visit", "_pass_by", "_wait_for_each_other", "_tell", "_ready", "_give_up", "_go_at_last"),
     ("test_a_stop_is", "test_who_comes", "test_who_plans_anew_makes", "test_aisles_in",
      "test_those_wait", "test_a_find_is_heard", "test_who_waits_in_vain_drives",
      "test_within_its")),
    ("planning/workday", ("work_day", "plan_work", "draw_detections", "_note_found", "_end_s"),
     ("test_a_day", "test_a_plan", "test_what_an_insp")),
    ("planning/headlands", ("_nearest", "meet", "_width_m"), ("test_who_drive", "test_a_headland")),
    ("planning/routes/aisle_ways", ("_once",), "test_one_pass"),
    ("planning/routes/aisle_ways",
     ("value_ways", "_hang", "_value_through", "_value_in", "_put", "_put_from_right",
      "_left_if_better", "_better_left", "_sum_sides", "_of_sides"),
     ("test_each_way", "test_an_aisle_that_hangs")),
    ("planning/routes/priced", ("_take_element", "_sweep", "_sweep_kinds", "_stretches"),
     ("test_the_best_drive", "test_a_kind")),
    ("planning/routes/ladders", ("_hanging",), "test_beside"),
    ("planning/routes/ladders",
     ("_lines", "_hull", "_places", "_put_in_line", "_cross_links", "_take_crossing",
      "_from_left_to_right", "_stub", "_assembled", "_apart"),
     ("test_both_ends", "test_places", "test_cross", "test_one_more", "test_the_gate",
      "test_aisles_links", "test_the_ends")),
    ("planning/routes/frontier", ("tables", "_onward", "_fits", "_after"), "test_"),
    ("planning/routes/best_route", ("upper_bound", "_between"),
     ("test_the_least_bound", "test_no_time_is", "test_no_bound", "test_a_bound_by", "test_to_sec",
      "test_the_next_price", "test_a_drive_that", "test_where_a_stop")),
    ("planning/routes/exact_walk", ("_price", "_walk_at", "full_budget"),
     ("test_the_least", "test_so_many", "test_no_steps")),
    ("planning/routes/stops",
     ("_plants", "excursion", "_of_part", "through", "end", "_in_line", "_passes"),
     ("test_in_and", "test_a_plant", "test_through", "test_where", "test_a_part", "test_no_plants",
      "test_the_lowest",
      "test_passes")),
    ("planning/routes/walk_sweep",
     ("at", "fill_tables", "depths", "_fill_worth", "_price_row", "_fill_onward", "_fill_up_to",
      "narrow", "sweep", "_worth_it", "_spread", "_go_on"), "test_"),
    ("planning/routes/pendant_parts", ("_with_place", "_and_place"), "test_a_part_is"),
    ("planning/routes/pendant_parts", ("_tree",), "test_parts_are"),
    ("planning/routes/improve", ("_leave_out", "_detour_s", "_find_place", "_try_place", "_fill",
                                 "_shorten", "_move", "_turn", "_same_aisle"),
     ("test_no_stretch", "test_what_is")),
    ("planning/routes/improve", ("_shorten", "_move", "_turn", "_same_aisle"), "test_stretches"),
)  # fmt: skip


def calls_in(tests, begins):
    """Yield the tests of a file with the values that they are to be tried with."""
    for name, test in vars(tests).items():
        if name.startswith(begins) and callable(test):
            marks = [mark for mark in getattr(test, "pytestmark", ()) if mark.name == "parametrize"]
            sets = [[told_by(mark, one) for one in mark.args[1]] for mark in marks]
            for chosen in itertools.product(*sets):
                yield test, {name: value for one in chosen for name, value in one.items()}


def told_by(mark, one):
    """Return the values of a test's parameters by their names."""
    names = mark.args[0]
    if isinstance(names, str):
        return {names: one}
    return dict(zip(names, one, strict=True))


class _EndlessError(Exception):
    """A loop did not end."""


def _stop(*_):
    raise _EndlessError


def is_noticed(calls):
    """Tell whether any test fails, or has no end."""
    signal.setitimer(signal.ITIMER_VIRTUAL, _MOST_S)
    try:
        for test, values in calls:
            test(**values)
    except (Exception, pytest.fail.Exception):  # noqa: BLE001 - whatever it is, it was noticed
        return True
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
    return False


def as_loops():
    """Let functions that tests ask for as Python be themselves: none is compiled here."""
    for name, module in [*sys.modules.items()]:
        if name.startswith("fieldmon"):
            for one in vars(module).values():
                if isinstance(one, FunctionType):
                    one.py_func = one


def tried(path, functions, begins):
    """Return how many mutants of some functions were noticed, of how many; print the others."""
    dotted = path.replace("/", ".")
    folder, _, name = dotted.rpartition(".")
    importlib.import_module(f"fieldmon.{dotted}")
    tests = importlib.import_module(f"tests.{folder}.test_{name}")
    as_loops()
    calls, file = [*calls_in(tests, begins)], ROOT / "fieldmon" / f"{path}.py"
    assert not is_noticed(calls), f"the tests of {path} fail without a fault"
    source, standing = file.read_text("utf-8"), functions_within(file)
    was, answers = code_of(ast.parse(source), file), answers_kept("fieldmon")
    n_noticed = n = 0
    for mutant in mutants_of(file):
        if mutant_function(mutant) in functions:
            tree, said = mutated(source, mutant.place)
            with fault([*changed_functions(was, code_of(tree, file))], standing):
                for kept in answers:
                    kept.cache_clear()
                noticed = is_noticed(calls)
            n_noticed, n = n_noticed + noticed, n + 1
            if not noticed:
                print(f"{path}:{mutant.line}  {said}")  # noqa: T201 - a command
    return n_noticed, n


def main():
    """Try all of them, or those of the modules named; say how many were noticed."""
    warnings.simplefilter("ignore")  # coins overflow, as they are meant to
    signal.signal(signal.SIGVTALRM, _stop)
    named = sys.argv[1:] or [path for path, *_ in HELD]
    for path, functions, begins in (one for one in HELD if one[0] in named):
        n_noticed, n = tried(path, functions, begins)
        print(f"{path}: {n_noticed} of {n} noticed ({', '.join(functions)})", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
