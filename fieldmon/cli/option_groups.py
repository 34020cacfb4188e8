"""Options of commands as fields of dataclasses, so that commands can share them."""

from __future__ import annotations

from dataclasses import MISSING, fields, is_dataclass
from functools import wraps
from inspect import Parameter, Signature, signature
from typing import TYPE_CHECKING, Any, TypeVar, get_type_hints

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

R = TypeVar("R")


def with_options(command: Callable[..., R]) -> Callable[..., R]:
    """Give a command the fields of a dataclass as options of its own, in their order.

    A parameter of `command` whose type is a dataclass stands for its fields, and a field whose
    type is one stands for those in turn. Fields are annotated as typer wants a command's
    parameters to be, and have their defaults.
    """
    hints = get_type_hints(command, include_extras=True)
    groups = {name: hint for name, hint in hints.items() if is_dataclass(hint)}
    parameters: list[Parameter] = []
    for name in signature(command).parameters:
        if name in groups:
            parameters += _parameters(groups[name])
        else:
            parameters.append(Parameter(name, Parameter.KEYWORD_ONLY, annotation=hints[name]))

    @wraps(command)
    def called(**told: Any) -> R:  # noqa: ANN401 - what a command is told is of any type
        made = {name: _made(group, told) for name, group in groups.items()}
        return command(**{name: told[name] for name in hints if name in told} | made)

    called.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    called.__annotations__ = {each.name: each.annotation for each in parameters}
    return called


def _parameters(group: Any) -> Iterator[Parameter]:  # noqa: ANN401 - a dataclass
    hints = get_type_hints(group, include_extras=True)
    for each in fields(group):
        if is_dataclass(hints[each.name]):
            yield from _parameters(hints[each.name])
            continue
        default = Parameter.empty if each.default is MISSING else each.default
        yield Parameter(
            each.name, Parameter.KEYWORD_ONLY, default=default, annotation=hints[each.name]
        )


def _made(group: Any, told: dict[str, Any]) -> Any:  # noqa: ANN401 - a dataclass
    hints = get_type_hints(group, include_extras=True)
    return group(
        **{
            each.name: _made(hints[each.name], told)
            if is_dataclass(hints[each.name])
            else told[each.name]
            for each in fields(group)
        }
    )
