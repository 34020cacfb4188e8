"""What a person sees of a problem: a sentence and an exit code, never a traceback."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, NoReturn

import typer

from fieldmon.cli.stopped import STOPPED, STOPPED_CODE
from fieldmon.cli.waiting import WAITING
from fieldmon.errors import FieldmonError

if TYPE_CHECKING:
    from collections.abc import Callable


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
        error.show()  # type: ignore[attr-defined]
        sys.exit(2)
    if os.environ.get("FIELDMON_DEBUG"):
        raise error
    _end(
        f"Sorry: fieldmon made a mistake of its own ({type(error).__name__}: {error}). "
        "Run the command again with FIELDMON_DEBUG=1 to see where, and report it.",
        1,
    )


def _end(sentence: str, code: int) -> NoReturn:
    typer.echo(sentence, err=True)
    sys.exit(code)
