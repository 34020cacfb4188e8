"""Which scenarios the beginnings of their names mean."""

from __future__ import annotations

from itertools import takewhile
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.studies.samplers.scenarios import Scenario

# names that a sentence has room for
_NAMED = 5


def beginning_so(
    beginnings: Sequence[str], known: Sequence[Scenario], more: str = ""
) -> list[Scenario]:
    """Return the scenarios whose names begin like one of these.

    Parameters
    ----------
    beginnings, known
        One or more, and all scenarios.
    more
        What a refusal says of others, after the names.

    Raises
    ------
    SettingError
        If there is none: it names those that begin most alike.
    """
    meant = [each for each in known if each.name.startswith(tuple(beginnings))]
    if meant:
        return meant

    def alike(name: str) -> int:
        pairs = [zip(name, beginning, strict=False) for beginning in beginnings]
        return max(sum(1 for _ in takewhile(lambda two: two[0] == two[1], each)) for each in pairs)

    # sorted keeps the order of those that are equally alike
    names = sorted((each.name for each in known), key=alike, reverse=True)
    near = ", ".join(f'"{name}"' for name in names[:_NAMED])
    said = " or ".join(f'"{beginning}"' for beginning in beginnings)
    raise SettingError(
        f"--scenario must be how a scenario's name begins, but none begins with {said}. There are "
        f"{len(names)}, for instance {near}{more}."
    )
