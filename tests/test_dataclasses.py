"""Settings cannot be changed, and what holds arrays is compared by what it is, not by values."""

import importlib
import inspect
import re
from pathlib import Path

ROOM = Path(__file__).resolve().parents[1] / "fieldmon"
#: they gather what comes in while they live
THAT_GROW = {"DrivenDay", "Recording", "Workroom", "Mornings", "TeamWorker", "_Self", "_Visits"}
ARRAYS = re.compile(r"\bNDArray\b|\bFloats?\b|\bInts?\b|\bBools?\b")


def dataclasses_there_are():
    """Yield classes as they are, not as they are written: a fault put in does not change a file."""
    for file in sorted(ROOM.rglob("*.py")):
        if "@dataclass" in file.read_text("utf-8"):
            module = importlib.import_module(
                ".".join(file.relative_to(ROOM.parent).with_suffix("").parts)
            )
            for one in vars(module).values():
                if (
                    isinstance(one, type)
                    and one.__module__ == module.__name__
                    and "__dataclass_params__" in vars(one)
                ):
                    yield one, vars(one)["__dataclass_params__"]


def test_what_was_made_stays_as_it_was_made():
    made = {one.__name__: told.frozen for one, told in dataclasses_there_are()}
    assert {name for name, frozen in made.items() if not frozen} == THAT_GROW


def test_what_holds_arrays_is_equal_to_itself_only():
    """Arrays compare entry by entry: `==` of two holders would have no answer."""
    for one, told in dataclasses_there_are():
        own = inspect.get_annotations(one).values()
        held = [each for each in own if not each.startswith(("Callable", "float |", "ClassVar"))]
        if any(ARRAYS.search(each) for each in held):
            assert told.eq is False, one.__name__
