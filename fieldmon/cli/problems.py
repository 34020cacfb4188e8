"""What a person sees of a problem: a sentence and an exit code, never a traceback."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any, NoReturn

import typer

from fieldmon.cli.progress import WAITING
from fieldmon.cli.stopped import STOPPED, STOPPED_CODE
from fieldmon.errors import FieldmonError, NoRowsError

if TYPE_CHECKING:
    from collections.abc import Callable


# what typer's own library calls what it cannot make of a text, in our words
_NUMBERS = {
    "float_parsing": "a number", "int_parsing": "a whole number",
    "int_from_float": "a whole number", "int_parsing_size": "a number of fewer digits",
}  # fmt: skip
# of a name that cannot be one
_LONGEST = 80


def run(command: Callable[..., object]) -> None:
    """Run the command line; end with its exit code."""
    try:
        with WAITING:
            code = command(standalone_mode=False)
        if code == STOPPED_CODE:  # which typer makes of Ctrl-C
            _stopped()
        sys.exit(code if isinstance(code, int) else 0)
    except NoRowsError as error:
        _end(f"{error} That says --no-rows.", 2)
    except FieldmonError as error:
        _end(str(error), 2)
    except typer.Exit as stop:
        sys.exit(stop.exit_code)
    except (KeyboardInterrupt, typer.Abort):
        _stopped()
    except BrokenPipeError:
        sys.exit(0)
    except OverflowError as error:
        _end(f"A number is too large to work with ({error}). Give a smaller one.", 2)
    except OSError as error:
        name = str(error.filename or "A file")
        name = name if len(name) <= _LONGEST else f"{name[:_LONGEST]}..."
        _end(
            f"{name} must be a file or folder that this machine can use, but it is not "
            f"({error.strerror or error}). Check its name, its permissions and the disk.",
            2,
        )
    except Exception as error:  # noqa: BLE001 - no traceback ever reaches a person
        _unexpected(error)


def _stopped() -> NoReturn:
    _end(STOPPED, STOPPED_CODE)


def _unexpected(error: Exception) -> NoReturn:
    # typer's own base of a wrong option or argument, wherever its version keeps it
    usage = next(c for c in typer.BadParameter.__mro__ if c.__name__ == "ClickException")
    if isinstance(error, usage):
        if sentence := _of_value(error):
            _end(sentence, 2)
        error.show()  # type: ignore[attr-defined]
        sys.exit(2)
    if os.environ.get("FIELDMON_DEBUG"):
        raise error
    _end(
        f"Sorry: fieldmon made a mistake of its own ({type(error).__name__}: {error}). "
        "Run the command again with FIELDMON_DEBUG=1 to see where, and report it.",
        1,
    )


def _of_value(error: Any) -> str:  # noqa: ANN401 - typer's own
    """Return why a value of an option is refused, where typer lets another library say so."""
    told, of = getattr(error.__cause__, "errors", None), getattr(error, "param", None)
    if told is None or of is None:
        return ""
    found = told()[0]
    kind, given = found["type"], found["input"]
    name = of.opts[0] if of.param_type_name == "option" else of.human_readable_name
    if kind in _NUMBERS:
        return f"{name} must be {_NUMBERS[kind]}, but it is {given!r}."
    _, parted, names = str(found.get("ctx", {}).get("error", "")).partition(" is not one of ")
    if not parted:
        return ""
    return f"{name} must be one of {names.rstrip('.').replace(chr(39), '')}, but it is {given!r}."


def _end(sentence: str, code: int) -> NoReturn:
    typer.echo(sentence, err=True)
    sys.exit(code)
