"""What a program hands over by mistake is refused in a sentence that names it; the rest of the
mistakes by a command, see `tests.wrong_values`.
"""

import numpy as np
import pytest

import fieldmon as fm
from fieldmon.errors import SettingError
from tests import wrong_values
from tests.thorough import times
from tests.wrong_values import Case, cases, faults


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return list(cases(tmp_path_factory.mktemp("wrong_values")))


def test_wrong_values_for_every_parameter_are_refused_by_name_and_nothing_crashes(
    made, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    assert faults(made, each=times(2, 6)) == []


def test_every_public_name_is_tried(made):
    tried = {case.name.split(".")[0] for case in made}
    # SAMPLERS is a dict, errors are raised, and who writes a sampler is handed a scene and answers
    # stops
    answers = {"PlantToInspect", "SimulatedDay", "Status", "PlotEstimate", "Forecast", "MapVerdict",
               "Comparison", "Ratio", "TeamPlan", "PlantNames"}  # fmt: skip
    others = {
        "SAMPLERS",
        "Sampler",
        "Scene",
        "Stops",
        "ImportDoubt",
        "__version__",
        "rover",
        "scout",
    }
    errors = {name for name in fm.__all__ if name.endswith(("Error", "Problem", "Needed"))}
    assert set(fm.__all__) - tried == others | answers | errors


def test_what_crashes_says_nothing_or_names_nothing_is_found():
    def crashes(hours: "float") -> "float":
        return hours + 1

    def takes(hours: "float") -> "float":
        return hours

    def mumbles(hours: "float") -> "float":  # noqa: ARG001 - refused all the same
        raise SettingError("It must be otherwise.")

    def warns(hours: "float") -> "float":  # noqa: ARG001 - as above
        return np.log(np.float64(0.0))

    for call, label, said in (
        (crashes, "text", "TypeError"),
        (takes, "text", "it is taken"),
        (mumbles, "text", "does not name it"),
        (warns, "text", "RuntimeWarning"),
    ):
        assert said in Case("f", call, {"hours": 1.0}).fault("hours", label)
    assert Case("f", takes, {"hours": 1.0}).fault("hours", "half") == ""


@pytest.mark.parametrize(("took", "said"), [([9.0, 0.1], ""), ([9.0, 9.0], "it took 9 s")])
def test_what_takes_long_is_found_and_what_is_compiled_once_is_not(took, said, monkeypatch):
    now, left = [0.0], list(took)
    monkeypatch.setattr(wrong_values.time, "process_time", lambda: now[0])

    def slow(hours: "float") -> "float":  # noqa: ARG001 - refused all the same
        now[0] += left.pop(0)
        raise SettingError("hours must be fewer.")

    fault = Case("f", slow, {"hours": 1.0}).fault("hours", "text")
    assert said in fault if said else fault == ""
