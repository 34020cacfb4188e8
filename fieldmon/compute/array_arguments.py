"""Arrays that a caller of the library hands over: what they must hold, and how many of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from fieldmon.compute.arguments import shown
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import TypeVar

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    K = TypeVar("K", np.float64, np.bool_)

#: a column that a public function takes: a list, an array, or one of pandas or polars; what it
#: must hold its function says, and looks at
Column: TypeAlias = "ArrayLike | Sequence[Any]"


def array_of(kind: type[K], what: str, given: object, instead: str = "") -> NDArray[K]:
    """Return an array of numbers, or of True and False; raise `SettingError` for anything else.

    Parameters
    ----------
    kind
        ``np.float64`` or ``np.bool_``: numbers are not taken for True and False.
    what
        What is asked for: ``"A risk map"``.
    given
        What was handed over.
    instead
        What to do.

    Examples
    --------
    >>> import numpy as np
    >>> array_of(np.float64, "A risk map", [0.1, None, 0.3])
    array([0.1, nan, 0.3])
    >>> array_of(np.bool_, "What was treated", [True, False])
    array([ True, False])
    """
    import numpy as np  # noqa: PLC0415 - a command's help is there without it

    held = "True or False" if kind is np.bool_ else "numbers"
    try:
        array = np.asarray(given)
        if kind is not np.bool_ and array.dtype.kind in "biufO":
            array = array.astype(kind)
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None or array.dtype != kind:
        sentence = f"{what} must hold {held}, but {shown(given)} does not. {instead}"
        raise SettingError(sentence.rstrip())
    return array


def texts_of(given: object, kinds: tuple[type, ...] = (str,)) -> NDArray[np.object_] | None:
    """Return texts ``(k,)``, empty where one is missing (None, NaN, NA); None: they are none.

    `kinds` are what texts may be.

    Examples
    --------
    >>> import pandas as pd
    >>> texts_of(pd.Series(["Ann", None], dtype="string")), texts_of([float("nan")]), texts_of([7])
    (array(['Ann', ''], dtype=object), array([''], dtype=object), None)
    """
    import numpy as np  # noqa: PLC0415 - as above

    array = np.atleast_1d(np.asarray(given, None if hasattr(given, "dtype") else object))
    if array.dtype.kind == "U":
        return array.astype(object)
    entries = array.ravel().tolist()
    if array.dtype.kind == "O" and {*map(type, entries)} <= {str}:  # as mostly
        return array
    said = ["" if _is_missing(one) else one for one in entries]
    if not all(isinstance(one, kinds) for one in said):
        return None
    texts = np.empty(len(said), object)
    texts[:] = [str(one) if isinstance(one, str) else one for one in said]
    return texts.reshape(array.shape)


def _is_missing(given: Any) -> bool:  # noqa: ANN401 - anything
    """Return whether something stands for nothing: None, NaN, or pandas's NA and NaT."""
    return (
        given is None
        or type(given).__name__ in {"NAType", "NaTType"}
        or (isinstance(given, float) and given != given)  # noqa: PLR0124 - NaN
    )


def array_of_plants(
    kind: type[K],
    what: str,
    given: Any,  # noqa: ANN401 - held to its kind here
    instead: str = "",
) -> NDArray[K]:
    """Return what `array_of` does of one entry a plant, in the order of the plants.

    Raise `SettingError` for what pandas has in another order, too: arrays go by place, pandas by
    its index, which would be lost.

    Examples
    --------
    >>> import numpy as np, pandas as pd
    >>> array_of_plants(np.float64, "A risk map", pd.Series([0.1, 0.3]))
    array([0.1, 0.3])
    >>> array_of_plants(np.float64, "A risk map", pd.Series([0.1, 0.3]).sort_values()[::-1])
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A risk map must be in the plants' order, its index 0, 1, 2..., but its index is another. Sort it by its plants, as with .sort_index(), or give .to_numpy() of one that is in their order.
    """  # noqa: E501 - a sentence
    import numpy as np  # noqa: PLC0415 - as above

    if _has_index(given) and not np.array_equal(given.index, np.arange(len(given))):
        raise SettingError(
            f"{what} must be in the plants' order, its index 0, 1, 2..., but its index is another. "
            "Sort it by its plants, as with .sort_index(), or give .to_numpy() of one that is in "
            "their order."
        )
    return array_of(kind, what, given, instead)


def must_share_index(whose: str, columns: Mapping[str, Any]) -> None:
    """Raise `SettingError` where columns by their names come from pandas with different indices.

    Examples
    --------
    >>> import pandas as pd
    >>> found = pd.DataFrame({"plant": [7, 8], "result": [0, 1]}, index=[3, 9])
    >>> must_share_index("inspections", {"plant": found["plant"], "result": found["result"]})
    """
    indexed = {name: one for name, one in columns.items() if _has_index(one)}
    first = next(iter(indexed), "")
    for name, one in indexed.items():
        if not one.index.equals(indexed[first].index):
            raise SettingError(
                f"The columns of {whose} must have one index, but that of {name} is another than "
                f"that of {first}: they are put together by place, not by index. Take them from "
                "one frame, or give .to_numpy() of each where their order is the same."
            )


def _has_index(given: Any) -> bool:  # noqa: ANN401 - anything
    """Return whether something is of pandas, with an index."""
    return hasattr(given, "iloc") and hasattr(given, "index")


def plants_marked(
    what: str, given: object, n: int, wrong: Callable[[int], str]
) -> NDArray[np.bool_]:
    """Return which of n plants are marked, ``(n,)``; raise `SettingError` for anything else.

    Parameters
    ----------
    what
        What is asked for: ``"The mask of treated plants"``.
    given
        What was handed over.
    n
        How many plants there are.
    wrong
        What to say where so many are marked or not, instead of n.
    """
    import numpy as np  # noqa: PLC0415 - as above

    marked = array_of_plants(
        np.bool_, what, given, f"Of plants by their numbers give np.isin(np.arange({n}), numbers)."
    )
    if marked.shape != (n,):
        raise SettingError(wrong(marked.size))
    return marked


def entries_of(what: str, which: Any, n: int) -> Any:  # noqa: ANN401 - an array or a slice
    """Return what picks some of n entries; raise `SettingError` for anything else.

    Parameters
    ----------
    what
        What is picked: ``"Records"``.
    which
        Numbers of entries, a mask ``(n,)`` or a slice.
    n
        How many entries there are.

    Examples
    --------
    >>> entries_of("Records", [True, False], 2)
    array([ True, False])
    """
    import numpy as np  # noqa: PLC0415 - as above

    if isinstance(which, slice):
        return which
    try:
        picked = np.asarray(which)
    except ValueError:
        picked = np.empty(())
    if picked.ndim == 1 and not picked.size:
        return picked.astype(np.int64)
    if picked.dtype == bool and picked.shape == (n,):
        return picked
    if picked.ndim == 1 and picked.dtype.kind in "iu" and -n <= picked.min() <= picked.max() < n:
        return picked
    raise SettingError(
        f"{what} must be picked by their numbers below {n}, or by True and False for each, but "
        f"'which' is {shown(which)}."
    )


def must_be_shaped(whose: str, arrays: Mapping[str, tuple[Any, tuple[int, ...]]]) -> None:
    """Raise `SettingError` unless arrays have their shapes.

    Parameters
    ----------
    whose
        Who has them, in the sentence: ``"A route's"``.
    arrays
        By name: the array, and the shape that it must have.

    Examples
    --------
    >>> import numpy as np
    >>> must_be_shaped("A start's", {"chance": (np.zeros(3), (2,))})
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A start's chance must have the shape (2,), but it has (3,).
    """
    for name, (array, shape) in arrays.items():
        if array.shape != shape:
            raise SettingError(
                f"{whose} {name} must have the shape {shape}, but it has {array.shape}."
            )


def must_hold_shapes(holder: object, whose: str, shapes: Mapping[str, tuple[int, ...]]) -> None:
    """Raise `SettingError` unless a holder's arrays, by their names, have these `shapes`."""
    must_be_shaped(whose, {name: (getattr(holder, name), one) for name, one in shapes.items()})


def must_be_chances(what: str, chance: NDArray[np.float64]) -> None:
    """Raise `SettingError` unless an array ``(n,)`` holds chances from 0 to 1.

    Examples
    --------
    >>> import numpy as np
    >>> must_be_chances("A start", np.array([0.1, 12.0]))
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A start must hold chances in 0..1, but plant 1 of 2 has 12.
    """
    wrong = ~((chance >= 0) & (chance <= 1))
    if wrong.any():
        plant = int(wrong.argmax())
        raise SettingError(
            f"{what} must hold chances in 0..1, but plant {plant} of {len(chance)} has "
            f"{chance[plant]:g}."
        )


def chances_of(given: object, n: int) -> NDArray[np.float64]:
    """Return what a caller hands over as the chances of n plants, ``(n,)``.

    Raise `SettingError` unless it is a chance for each.

    Examples
    --------
    >>> chances_of([0.1, 1], 2)
    array([0.1, 1. ])
    >>> chances_of([0.1], 2)
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A plot's chance map must have the shape (2,), but it has (1,).
    """
    import numpy as np  # noqa: PLC0415 - as above

    chance = array_of_plants(np.float64, "A chance map", given)
    must_be_shaped("A plot's", {"chance map": (chance, (n,))})
    must_be_chances("A chance map", chance)
    return chance
