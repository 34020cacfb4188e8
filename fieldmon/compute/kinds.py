"""What a caller hands over is held to the kinds that a signature names, before it is used.

Annotations are read as text: a kind need not be imported to be known by its name.
"""

from __future__ import annotations

import ast
from dataclasses import fields
from datetime import date, datetime
from functools import cache, lru_cache, wraps
from inspect import Parameter, signature
from itertools import chain
from math import isnan
from numbers import Integral, Real
from operator import is_
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from fieldmon.compute.arguments import shown, with_article
from fieldmon.compute.day_arguments import day_in, time_in
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

F = TypeVar("F", bound="Callable[..., Any] | type")

# beyond it, whole numbers of Python become no others
_MOST = 10**300
#: what to give instead of something else
_INSTEAD = {
    "AdviceSettings": "Give AdviceSettings(level=0.05).",
    "GeoDataFrame": "Read a file with geopandas, or make one of a table and its geometry.",
    "date": "Give date(2026, 11, 18).",
    "time": 'Give "06:00", or datetime.time(6).',
    "MonitoringSettings": "Begin with season.settings.",
    "Robot": "Give Robot(hours=4), or scout() for a person on foot.",
    "PestInWeather": "Give PestInWeather(pest, weather, date(2026, 11, 18)).",
    "Plot": "Give the plot itself, as read_plot returns it; its plants are plot.grid.",
    "PlantGrid": "Give plot.grid.",
    "Inspections": "Read them with read_inspections(path, plot), or give Inspections.of(...).",
    "MultiPolygon": "Give shapely.MultiPolygon([polygon]), in degrees.",
    "Records": "Read them with read_records(path, near=plot).",
    "OpenSeason": "Open it with Season(path).",
    "Start": "Draw one with draw_start.",
    "Spread": "Give Spread(0.3).",
    "Viewpoints": "Give Viewpoints(steps, longer).",
    "str": "Put it in quotes.",
}
#: annotations of arguments that may be a day as `day_in` reads it
_DAYS = frozenset({"date", "date | None", "Day", "Day | None"})
#: and of those that may be a time as `time_in` reads it
_TIMES = frozenset({"time", "time | None", "TimeOfDay", "TimeOfDay | None"})
#: names of protocols, and of what a function looks at itself
_LEFT = frozenset(
    {
        "Any",
        "object",
        "ArrayLike",
        "Belief",
        "Column",
        "Cutoff",
        "KernelName",
        "Sampler",
        "Samplers",
        "Source",
        "generic",
    }
)
_ANYTHING = "something else"
_ALIASES = {
    "Day": "date",
    "TimeOfDay": "time",
    "Float": "NDArray[float64]",
    "Floats": "NDArray[float64]",
    "Times": "NDArray[datetime64]",
}
#: of arrays: what numpy calls their types, and how a sentence does
_HELD = {
    "f": ("iuf", "numbers"),
    "i": ("iu", "whole numbers"),
    "u": ("iu", "whole numbers"),
    "b": ("b", "True and False"),
    "d": ("M", "dates"),
    "s": ("U", "texts"),
}


def _as_it_is(given: Any) -> Any:  # noqa: ANN401 - anything
    return given


class Kind(NamedTuple):
    """What may be handed over.

    Parameters
    ----------
    words
        How a sentence calls it, with its article.
    fits
        Tells whether something is of it.
    instead
        What to do where it is not; may be empty.
    kept
        Returns something of it as values keep it: numbers as Python's own, lists as tuples.
    """

    words: str
    fits: Callable[[Any], bool]
    instead: str = ""
    kept: Callable[[Any], Any] = _as_it_is


@lru_cache(maxsize=1000)
def kind_of(annotation: str) -> Kind:
    """Return what an annotation allows.

    Examples
    --------
    >>> kind_of("float | None").words, kind_of("tuple[str, ...]").words
    ('a number', 'a tuple of texts')
    >>> kind_of("int").fits(2.5), kind_of("int").fits(True), kind_of("Robot").fits(4)
    (False, False, False)
    """
    return _read(ast.parse(annotation, mode="eval").body)


def must_be_of(what: str, annotation: str, given: object) -> None:
    """Raise `SettingError` unless something is what an annotation allows.

    Examples
    --------
    >>> must_be_of("A name", "str", 3)
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A name must be text, but it is 3. Put it in quotes.
    """
    kind = kind_of(annotation)
    if kind.fits(given):
        return
    if isinstance(given, Integral) and abs(int(given)) > _MOST:
        raise SettingError(
            f"{what} must be a number of less than 300 digits, but it is {shown(given)}."
        )
    raise SettingError(
        f"{what} must be {kind.words}, but it is {shown(given)}. {kind.instead}".rstrip()
    )


def must_hold_kinds(settings: Any, whose: str) -> None:  # noqa: ANN401 - any dataclass
    """Let a dataclass hold what it is annotated with; raise `SettingError` where it does not.

    A day or a time may be what `checked` takes for one. Numpy's numbers and texts become Python's
    own, which can be written, and lists tuples, which nobody can change.

    Parameters
    ----------
    settings
        A dataclass.
    whose
        Who has its fields, in the sentence: ``"The robot's"``.
    """
    of: Any = type(settings)
    for name, annotation, kind in _kinds_in(of):
        given = told = getattr(settings, name)
        if annotation in _DAYS:
            told = day_in(given)
        elif annotation in _TIMES:
            told = time_in(given)
        if not kind.fits(told):
            must_be_of(f"{whose} {name}", annotation, told)
        if (kept := kind.kept(told)) is not given:
            object.__setattr__(settings, name, kept)


@cache
def _kinds_in(settings: Any) -> list[tuple[str, str, Kind]]:  # noqa: ANN401 - any dataclass
    """Return what each field of a dataclass may hold: its name, its annotation, its kind."""
    named = [(field.name, str(field.type)) for field in fields(settings)]
    return [(name, annotation, kind_of(annotation)) for name, annotation in named]


def checked(public: F) -> F:
    """Let a function refuse arguments that are not what it is annotated with; for decorators.

    Of a class: all its public methods. A day may be a text, ``"2026-11-18"``, a time, or numpy's;
    a time of day may be a text, ``"07:00"``. What has the method `_plot_time` turns a time of
    another zone into its plot's.

    Examples
    --------
    >>> @checked
    ... def plants_in(hours: "float") -> int:
    ...     return int(hours * 90)
    >>> plants_in("4")
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: 'hours' of plants_in must be a number, but it is '4'.
    """
    if not isinstance(public, type):
        wrapped: F = _checked(public)
        return wrapped
    for name, member in list(vars(public).items()):
        if name.startswith("_"):
            continue
        if isinstance(member, classmethod):
            setattr(public, name, classmethod(_checked(member.__func__)))
        elif callable(member) and not isinstance(member, type | staticmethod):
            setattr(public, name, _checked(member))
    return public


def _checked(function: Any) -> Any:  # noqa: ANN401 - any function, with its own signature
    named = {}
    for name, one in signature(function).parameters.items():
        if name in {"self", "cls"} or one.annotation is Parameter.empty:
            named[name] = ""
        elif one.kind is not Parameter.VAR_KEYWORD:
            named[name] = str(one.annotation)
    in_order = list(named)
    days = {name for name, annotation in named.items() if annotation in _DAYS}
    times = {name for name, annotation in named.items() if annotation in _TIMES}

    @wraps(function)
    def wrapper(*args: Any, **keywords: Any) -> Any:  # noqa: ANN401 - as above
        if days or times:
            asked = args[0] if args and not isinstance(args[0], type) else None
            local = getattr(asked, "_plot_time", None)

            def read(name: str, given: Any) -> Any:  # noqa: ANN401 - as above
                if name in days:
                    return day_in(given, local)
                return time_in(given) if name in times else given

            in_place = [read(*told) for told in zip(in_order, args, strict=False)]
            args = (*in_place, *args[len(in_place) :])
            keywords = {name: read(name, given) for name, given in keywords.items()}
        for name, given in chain(zip(in_order, args, strict=False), keywords.items()):
            annotation = named.get(name, "")
            if annotation and not kind_of(annotation).fits(given):
                must_be_of(f"'{name}' of {_called(function, args)}", annotation, given)
        return function(*args, **keywords)

    return wrapper


def _called(function: Any, args: tuple[Any, ...]) -> str:  # noqa: ANN401 - any function
    """Return what a caller calls a function: a method by the class of what it is asked of."""
    first = next(iter(signature(function).parameters), "")
    if first in {"self", "cls"} and args:
        whose = args[0] if isinstance(args[0], type) else type(args[0])
        return f"{whose.__name__}.{function.__name__}"
    return str(function.__name__)


def _read(node: ast.expr) -> Kind:
    if isinstance(node, ast.BinOp):
        return _either(_read(node.left), _read(node.right))
    if isinstance(node, ast.Constant):
        return Kind("", lambda given: given is None) if node.value is None else _read_text(node)
    if isinstance(node, ast.Subscript):
        return _of_parts(_last(node.value), node.slice)
    return _named(_last(node))


def _read_text(node: ast.Constant) -> Kind:
    return kind_of(str(node.value))


def _last(node: ast.expr) -> str:
    """Return the last part of a dotted name."""
    return ast.unparse(node).rpartition(".")[2]


def _either(one: Kind, other: Kind) -> Kind:
    return Kind(
        " or ".join(dict.fromkeys(kind.words for kind in (one, other) if kind.words)),
        lambda given: one.fits(given) or other.fits(given),
        one.instead or other.instead,
        lambda given: (one if one.fits(given) else other).kept(given),
    )


def _named(name: str) -> Kind:
    if name in _LEFT:
        return Kind(_ANYTHING, lambda _: True)
    if name in _ALIASES:
        return kind_of(_ALIASES[name])
    if name in _PLAIN:
        words, fits = _PLAIN[name]
        return Kind(words, fits, _INSTEAD.get(name, ""), _KEPT.get(name, _as_it_is))
    return Kind(
        with_article(name),
        lambda given: any(kind.__name__ == name for kind in type(given).__mro__),
        _INSTEAD.get(name, ""),
    )


def _of_parts(outer: str, inner: ast.expr) -> Kind:
    parts = inner.elts if isinstance(inner, ast.Tuple) else [inner]
    if outer in {"tuple", "Sequence", "Iterable"}:
        return _of_entries(outer, parts)
    if outer == "NDArray":
        return _array(_last(parts[0]))
    if outer == "Callable":
        return Kind("a function", callable)
    if outer == "Literal":
        known = [part.value for part in parts if isinstance(part, ast.Constant)]
        return Kind(
            f"one of {', '.join(map(repr, known))}",
            lambda given: isinstance(given, str) and given in known,
        )
    key, value = map(_read, parts)
    return Kind(
        f"a dict of {_several(key)} and {_several(value)}",
        lambda given: (
            isinstance(given, dict)
            and all(key.fits(name) and value.fits(one) for name, one in given.items())
        ),
        kept=lambda given: {key.kept(name): value.kept(one) for name, one in given.items()},
    )


def _of_entries(outer: str, parts: list[ast.expr]) -> Kind:
    each = [_read(part) for part in parts if ast.unparse(part) != "..."]
    if outer == "tuple" and len(each) == len(parts):
        words = "a pair of numbers" if {kind.words for kind in each} == {"a number"} else "a tuple"
        return Kind(
            words,
            lambda given: _is_row(given, len(each)) and _all_fit(each, given),
            kept=lambda given: _same_or_tuple(given, map(_kept_as, each, given)),
        )
    (kind,) = each
    if outer == "Iterable":
        return Kind(f"a list of {_several(kind)}", lambda given: _all_of_it(kind, given))
    return Kind(
        f"a {outer.lower()} of {_several(kind)}",
        lambda given: _is_row(given) and all(kind.fits(one) for one in given),
        kept=_as_it_is
        if outer != "tuple"
        else lambda given: _same_or_tuple(given, map(kind.kept, given)),
    )


def _kept_as(kind: Kind, given: object) -> object:
    return kind.kept(given)


def _same_or_tuple(given: Any, kept: Iterable[Any]) -> tuple[Any, ...]:  # noqa: ANN401 - a row
    """Return what is kept of a row: the same tuple where it is one and nothing becomes another."""
    made = tuple(kept)
    return given if isinstance(given, tuple) and all(map(is_, made, given)) else made


def _several(kind: Kind) -> str:
    if kind.words == _ANYTHING:
        return "things"
    first, of, rest = kind.words.removeprefix("an ").removeprefix("a ").partition(" of ")
    return f"{first.removesuffix('s')}s{of}{rest}"


def _all_of_it(kind: Kind, given: Any) -> bool:  # noqa: ANN401 - anything
    """Return whether something yields what it should; what can be read only once is believed."""
    if isinstance(given, str | bytes | dict) or not hasattr(given, "__iter__"):
        return False
    return not hasattr(given, "__len__") or (
        getattr(given, "ndim", 1) == 1 and all(kind.fits(one) for one in given)
    )


def _is_row(given: object, length: int | None = None) -> bool:
    """Return whether something is a tuple or a list; of so many entries, or an array of them."""
    if length is None:
        return isinstance(given, tuple | list)
    is_array = hasattr(given, "setflags") and getattr(given, "ndim", 0) == 1
    return (isinstance(given, tuple | list) or is_array) and len(given) == length  # type: ignore[arg-type]


def _all_fit(each: list[Kind], given: Any) -> bool:  # noqa: ANN401 - a row of anything
    return all(kind.fits(one) for kind, one in zip(each, given, strict=True))


def _array(type_: str) -> Kind:
    if type_ == "generic":
        return Kind("an array", _has_entries)
    if type_.startswith("object"):
        return Kind("an array", lambda given: _is_array(given, "O"))
    letters, held = _HELD[type_[0]]
    return Kind(f"an array of {held}", lambda given: _is_array(given, letters))


def _has_entries(given: object) -> bool:
    return hasattr(given, "setflags") and getattr(given, "ndim", 0) > 0


def _is_array(given: object, letters: str) -> bool:
    dtype = getattr(given, "dtype", None)
    if dtype is None or not _has_entries(given):
        return False
    # what is empty holds nothing else
    return dtype.kind in letters or not len(given)  # type: ignore[arg-type]


def _is_number(given: object) -> bool:
    if type(given) is float:  # most are, and the rest takes ten times as long
        return not isnan(given)
    if isinstance(given, bool) or not isinstance(given, Real):
        return False
    if isinstance(given, Integral):
        return abs(int(given)) <= _MOST
    return not isnan(given)


def _is_whole(given: object) -> bool:
    return isinstance(given, Integral) and _is_number(given)


def _is_true_or_false(given: object) -> bool:
    return isinstance(given, bool) or type(given).__name__ in {"bool", "bool_"}


def _python_number(given: Any) -> Any:  # noqa: ANN401 - a number
    """Return a number as Python's own, which JSON and databases take, whoever's it was."""
    if type(given) is float or isinstance(given, int):
        return given
    return int(given) if isinstance(given, Integral) else float(given)


_KEPT: dict[str, Callable[[Any], Any]] = {
    "float": _python_number,
    "int": _python_number,
    "bool": bool,
    # a text of numpy is one of Python too
    "str": lambda given: str(given) if type(given).__name__ == "str_" else given,
}
_PLAIN: dict[str, tuple[str, Callable[[Any], bool]]] = {
    "float": ("a number", _is_number),
    "int": ("a whole number", _is_whole),
    "bool": ("True or False", _is_true_or_false),
    "str": ("text", lambda given: isinstance(given, str)),
    "datetime64": (
        "a numpy.datetime64",
        lambda given: type(given).__name__ == "datetime64" and given == given,  # noqa: PLR0124
    ),
    # a moment is a date to Python
    "date": ("a date", lambda given: isinstance(given, date) and not isinstance(given, datetime)),
}
