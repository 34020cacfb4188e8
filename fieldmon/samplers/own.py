"""A sampler of one's own, in a Python file: `my_sampler.py:Mine`.

Only who asks for it by hand gets it: the name of a sampler in a season's file runs no code.
"""

from __future__ import annotations

import sys
import traceback
from hashlib import blake2b
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldmon.errors import FieldmonError, SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fieldmon.samplers.base import Sampler

# of what an error says
_LONGEST = 200


def is_own(name: str) -> bool:
    """Tell whether a name is that of a file and a class.

    Examples
    --------
    >>> from fieldmon.samplers.own import is_own
    >>> is_own("samplers/mine.py:Mine"), is_own("naive")
    (True, False)
    """
    return name.rpartition(":")[0].endswith(".py")


def own_class(name: str) -> type[Sampler]:
    """Return the class of a name such as ``my_sampler.py:Mine``; the file is run once.

    Raise `SettingError` if there is no such file, it does not run, or has no such sampler.
    """
    file, _, called = name.rpartition(":")
    found = getattr(_module(Path(file).resolve()), called, None)
    if not isinstance(found, type) or not callable(getattr(found, "walk", None)):
        raise SettingError(
            f"{file} must have a class {called} with a method walk, but it has none. Derive it "
            "from fieldmon.Sampler."
        )
    return found


def label_of(name: str) -> str:
    """Return what a sampler is called in tables: a name as it is, of an own one its class.

    Examples
    --------
    >>> from fieldmon.samplers.own import label_of
    >>> label_of("samplers/mine.py:Mine"), label_of("naive")
    ('Mine', 'naive')
    """
    return name.rpartition(":")[2] if is_own(name) else name


def labels_of(names: Iterable[str]) -> list[str]:
    """Return what samplers of a study are called in its tables.

    Raise `SettingError` unless each is called otherwise.
    """
    labels = [label_of(name) for name in names]
    if len(set(labels)) < len(labels):
        raise SettingError(
            f"Samplers of a study must have different names, but they are {', '.join(labels)}."
        )
    return labels


def asked(who: str, own: Callable[..., Any], *given: object) -> Any:  # noqa: ANN401 - its answer
    """Return what code of somebody's own answers.

    Raise `SettingError` where it ends in an error, with its file and line.
    """
    try:
        return own(*given)
    except FieldmonError:
        raise
    except (Exception, SystemExit) as error:
        called = error.__traceback__ and error.__traceback__.tb_next
        frame = called and called.tb_frame
        if frame and str(frame.f_globals.get("__name__")).startswith("fieldmon."):
            raise  # it has that method from here
        file = Path(frame.f_code.co_filename) if frame else None
        raise _must_run(who, error, file) from error


def _must_run(who: str, error: BaseException, file: Path | None) -> SettingError:
    """Return what is said of code that ends in an error, and where in its `file`."""
    lines = [
        line
        for frame, line in traceback.walk_tb(error.__traceback__)
        if file is not None and frame.f_code.co_filename == str(file)
    ]
    where = f" ({file.name}, line {lines[-1]})" if file is not None and lines else ""
    said = " ".join(str(error).split()).rstrip(".")[:_LONGEST]
    kind = type(error).__name__
    said = f"{kind}: {said}" if said else kind
    written = kind == "ValueError" and "read-only" in said
    change = " What it is given cannot be written to: change a copy." if written else ""
    return SettingError(f"{who} must run, but it ends in {said}{where}.{change}")


def own_text(name: str) -> bytes:
    """Return what is in the file of an own sampler: another text is another sampler.

    Raise `SettingError` if it cannot be read.
    """
    return _text(Path(name.rpartition(":")[0]).resolve())


def _text(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise SettingError(
            f"{file} must be a Python file with a sampler, but it cannot be read "
            f"({error.strerror}). Name it as my_sampler.py:Mine."
        ) from error


def _module(file: Path) -> Any:  # noqa: ANN401 - any module
    text = _text(file)
    name = f"own_{blake2b(bytes(file) + text, digest_size=8).hexdigest()}"
    if name in sys.modules:
        return sys.modules[name]
    spec = spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise SettingError(f"{file} must be a Python file, but it is none. Name it my_sampler.py.")
    module = module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look for their own module there
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise _must_run(str(file), error, file) from error
    return module
