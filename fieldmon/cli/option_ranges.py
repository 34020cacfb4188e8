"""Numbers as options: refused when the line is read, as the option is typed and in its unit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import typer  # noqa: TC002 - typer reads what a callback takes

from fieldmon.compute.ranges import AllowedRange
from fieldmon.errors import SettingError
from fieldmon.plot.robot import broken_rule

if TYPE_CHECKING:
    from collections.abc import Callable

V = TypeVar("V")


def within(*told: float | AllowedRange, **how: bool | str) -> Callable[[typer.CallbackParam, V], V]:
    """Return what refuses an option outside a range, or outside the one told as it is made.

    It is the ``callback`` of the option, which may be repeated.
    """
    range_ = told[0] if isinstance(told[0], AllowedRange) else AllowedRange(*told, **how)  # type: ignore[arg-type]
    return refusing(range_.broken)


def of_robot(name: str) -> Callable[..., object]:
    """Return what refuses an option for a setting of `Robot`, said in the unit of the option."""
    return refusing(lambda value: broken_rule(name, value, with_unit=True))


def refusing(broken: Callable[[float], str]) -> Callable[[typer.CallbackParam, V], V]:
    """Return what refuses an option of which a rule is broken; the rule is empty where not."""

    def checked(param: typer.CallbackParam, value: V) -> V:
        told: Any = value
        for one in told if isinstance(told, list | tuple) else [told]:
            if one is not None and (rule := broken(one)):
                raise SettingError(f"{param.opts[0]} must be {rule}, but it is {one:g}.")
        return value

    return checked
