"""Settings cannot be changed, and what holds arrays is compared by what it is, not by values."""

import ast
import re
from pathlib import Path

ROOM = Path(__file__).resolve().parents[1] / "fieldmon"
#: they gather what comes in while they live
THAT_GROW = {"DrivenDay", "Recording", "Workroom", "Mornings", "_Worker", "_Self"}
ARRAYS = re.compile(r"\bNDArray\b|\bFloats?\b|\bInts?\b|\bBools?\b")


def dataclasses_there_are():
    for file in sorted(ROOM.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            for one in node.decorator_list if isinstance(node, ast.ClassDef) else ():
                name = ast.unparse(one)
                if name.partition("(")[0] == "dataclass":
                    told = {w.arg: ast.literal_eval(w.value) for w in getattr(one, "keywords", ())}
                    yield node, told


def test_what_was_made_stays_as_it_was_made():
    made = {node.name: told.get("frozen", False) for node, told in dataclasses_there_are()}
    assert {name for name, frozen in made.items() if not frozen} == THAT_GROW


def test_what_holds_arrays_is_equal_to_itself_only():
    """Arrays compare entry by entry: `==` of two holders would have no answer."""
    for node, told in dataclasses_there_are():
        told_of = [ast.unparse(one.annotation) for one in node.body if type(one) is ast.AnnAssign]
        held = [one for one in told_of if not one.startswith(("Callable", "float |", "ClassVar"))]
        if any(ARRAYS.search(one) for one in held):
            assert told.get("eq", True) is False, node.name
