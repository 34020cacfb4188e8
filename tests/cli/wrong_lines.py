"""Wrong command lines without end, each the same for its seed.

    python -m tests.cli.wrong_lines --lines 5000          # before a release: an hour or two
    python -m tests.cli.wrong_lines --first 17 --lines 1  # one of them again

Each has things that may be wrong: numbers that are none, files that are something else, empty and
endless texts, names that a terminal would turn round. Three of four have one that certainly is.
"""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import io
import os
import random
import shutil
import signal
import sys
import tempfile
from functools import cache
from pathlib import Path
from time import process_time

import typer

from fieldmon.cli.main import app, main
from tests.paths import ROOT

MOST_S = 10.0
_NO_NUMBER = ("many", "1,5x", "", "٣x", "--", "1e", "0x1g")
_ODD_NUMBER = ("nan", "inf", "-inf", "-1", "0", "1e308", "-1e308", "1e-320", str(10**30), "-0.0")
_ODD_TEXT = ("", " ", "\u202egpj.exe", "x" * 5000, "<script>alert(1)</script>", "2026-13-45", "::",
             "=", "a=b", "=b", "nan", "-", "2026-04-06", "25:61", "35.1", "35.1,nan", "1e999,0",
             "%s%n", "{0.__class__}", "../../etc/passwd", "\udce4", "\t\n", "robot=7")  # fmt: skip
_ODD_FILE = ("season.gpkg", "plot.geojson", "junk.bin", "empty.csv", "folder", ".", "/dev/null",
             "", "no\u202egpj.geojson", "x" * 300, "~", "/proc/self/mem", "\udce4.csv")  # fmt: skip
#: what works for long when nothing is wrong
_LONG = ("app", "simulate", "study")
_NOWHERE = ("nowhere.gpkg", "none/there.geojson", "none.csv")


@cache
def commands():
    """Return every command with its words, but for those that only group others."""
    found, waiting = [], [((), typer.main.get_command(app))]
    while waiting:
        words, command = waiting.pop()
        inner = getattr(command, "commands", None)
        if inner is None:
            found.append((words, command))
        else:
            waiting += [((*words, name), one) for name, one in sorted(inner.items())]
    return sorted(found, key=lambda one: one[0])


def _kind(parameter):
    """Return what a parameter is in Python: typer tells it of each."""
    return parameter.type_descriptor.annotation


def _is_number(parameter):
    return _kind(parameter) in {int, float}


def _is_file(parameter):
    return _kind(parameter) is Path


def _odd(parameter, rng):
    """Return a value that may be wrong."""
    if _is_number(parameter):
        return rng.choice((*_ODD_NUMBER, "1", "2"))
    return rng.choice(_ODD_FILE if _is_file(parameter) else _ODD_TEXT)


def is_certain(seed):
    """Tell whether a line is certainly wrong; the others may happen to be right."""
    return seed % 4 != 3


def wrong_line(seed):
    """Return the words of a wrong command line."""
    rng = random.Random(f"wrong {seed}")
    some = commands() if is_certain(seed) else [c for c in commands() if c[0][0] not in _LONG]
    words, command = rng.choice(some)
    options = [p for p in command.params if p.param_type_name == "option" and p.opts]
    arguments = [p for p in command.params if p.param_type_name == "argument"]
    given = [[_odd(p, rng)] for p in arguments]
    for option in rng.sample(options, min(len(options), rng.randrange(4))):
        flag = bool(getattr(option, "is_flag", False))
        given.append([option.opts[0], *([] if flag else [_odd(option, rng)])])
    if not is_certain(seed):
        return [*words, *(word for each in given for word in each if "--help" not in each)]
    numbers = [p for p in options if _is_number(p)]
    wrong = rng.choice(("option", "number", "file", "surplus"))
    if wrong == "number" and numbers:
        name = rng.choice(numbers).opts[0]
        given = [one for one in given if one[0] != name]  # the last of two would count
        given.append([name, rng.choice(_NO_NUMBER)])
    elif wrong == "file" and arguments and _is_file(arguments[0]):
        given[0] = [rng.choice(_NOWHERE)]
    elif wrong == "surplus" and not any(p.nargs == -1 for p in arguments):
        given += [["surplus"]] * (len(arguments) + 1)
    else:
        given.append([f"--no-such-{rng.randrange(100)}"])
    rng.shuffle(given)
    return [*words, *(word for each in given for word in each if "--help" not in each)]


def small_season(folder):
    """Return a season of thirty plants in a folder, of today's version."""
    from fieldmon.monitoring import Season

    old = ROOT / "tests" / "monitoring" / "seasons_of_old" / "adaptive.gpkg"
    return Season(shutil.copy(old, folder)).path


def prepare(folder, season):
    """Put the files in a folder of which wrong lines speak."""
    (folder / "season.gpkg").write_bytes(Path(season).read_bytes())
    square = "[[[35.15,30.36],[35.1505,30.36],[35.1505,30.3604],[35.15,30.36]]]"
    plot = '{"type":"Feature","properties":{"name":"<b>"},"geometry":{"type":"Polygon",'
    (folder / "plot.geojson").write_text(f'{plot}"coordinates":{square}}}}}', "utf-8")
    (folder / "junk.bin").write_bytes(bytes(range(256)) * 8)
    (folder / "empty.csv").touch()
    (folder / "folder").mkdir()


def standing(folder):
    """Return what stands in a folder: every file with the digest of what is in it."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in folder.rglob("*") if p.is_file()}  # fmt: skip


def trouble(words, folder, *, certain=True):
    """Run a wrong line in this process; return what is wrong with how it ended, or ""."""
    before, began = standing(folder), process_time()
    out, err, code = io.StringIO(), io.StringIO(), 0
    old = sys.argv, Path.cwd()
    try:
        sys.argv = ["fieldmon", *words]
        os.chdir(folder)
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            main()
    except SystemExit as stop:
        code = stop.code or 0
    except BaseException as escaped:  # noqa: BLE001 - that is what is looked for
        return f"{type(escaped).__name__} escaped: {escaped}"
    finally:
        sys.argv = old[0]
        os.chdir(old[1])
    seconds, said = process_time() - began, err.getvalue().strip()
    last = said.splitlines()[-1].strip() if said else ""
    if code == 0 and not certain:
        return ""
    # a command to copy has no full stop behind it
    is_sentence = last.endswith((".", "?")) or ": fieldmon " in last or last.startswith("Error: ")
    for bad, what in (
        (code != 2, f"exit {code}"),
        ("Traceback" in said or "mistake of its own" in said, "a mistake of its own"),
        (not is_sentence, "no sentence"),
        (seconds > MOST_S, f"{seconds:.0f} s"),
        (standing(folder) != before, "something was written"),
    ):
        if bad:
            return f"{what}: {said[-300:]}"
    return ""


def cli():
    """Try many wrong lines; name those that end badly or hang."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("--first", type=int, default=0)
    asked.add_argument("--lines", type=int, default=5000)
    told = asked.parse_args()
    bad, season = 0, small_season(Path(tempfile.mkdtemp()))
    signal.signal(signal.SIGALRM, _late)
    for seed in range(told.first, told.first + told.lines):
        words = wrong_line(seed)
        with tempfile.TemporaryDirectory() as folder:
            prepare(Path(folder), season)
            signal.alarm(int(6 * MOST_S))
            problem = trouble(words, Path(folder), certain=is_certain(seed))
            signal.alarm(0)
        if problem:
            bad += 1
            sys.stdout.write(f"{seed}: fieldmon {words}\n    {problem}\n")
            sys.stdout.flush()
    sys.stdout.write(f"{told.lines} wrong lines, {bad} ended badly\n")


def _late(*_):
    raise TimeoutError("it hung")


if __name__ == "__main__":
    cli()
