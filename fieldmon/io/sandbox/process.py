"""A process of its own for reading files, which may crash, hang or run out of memory alone.

Libraries that parse what a stranger made run here, with a clock, a limit on memory and no way to
the network. The process is kept for the next file and ends with the program. It has the same rights
as the program, so what it sends back may be pickled.
"""

from __future__ import annotations

import atexit
import importlib
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from importlib.abc import MetaPathFinder
from pathlib import Path
from typing import IO, Any, NamedTuple

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.sandbox import limits

if sys.platform != "win32":
    import resource

#: the signal by which a system ends a process that has worked for too long
_OUT_OF_TIME = getattr(signal, "SIGXCPU", 0) or -1

#: files read before a process is replaced, so that nothing adds up in it
_USES = 200
#: what a process that is to have all at hand loads before its first file
ALL_READERS = (
    "fieldmon.io.sandbox.tasks",
    *(
        f"fieldmon.io.readers.{name}"
        for name in ("plots", "points_and_lines", "treated_areas", "crews")
    ),
    *(f"fieldmon.io.formats.{name}" for name in ("gdal", "geoparquet")),
)
# GDAL reads these when it is loaded. Drivers that lead to other files or to the network are not
# there at all, and a proxy that does not exist stands between the rest and the world.
_SKIPPED = (
    *("OGR_VRT", "WFS", "OAPIF", "OGCAPI", "CSW", "Elasticsearch", "Carto", "AmigoCloud", "NGW"),
    *("PLSCENES", "EEDA", "HTTP", "GDALG", "GPSBabel", "ADBC", "MBTiles", "PMTiles", "MVT", "OSM"),
    *("GTFS", "PDF", "PDS4", "VICAR", "PCIDSK", "S57", "DGN", "LVBAG", "GMLAS", "TopoJSON", "WAsP"),
    *("ESRIJSON", "GeoJSONSeq", "OGR_GMT", "GeoRSS", "VFK", "PGDUMP", "OGR_PDS"),
    *("EDIGEO", "Idrisi", "ODS", "XLSX", "SXF", "Selafin", "JML", "VDV", "MapML", "JSONFG", "CSV"),
    *("MiraMonVector", "AVCBin", "AVCE00", "AIVector", "MEM", "KML", "GeoJSON"),
)
_ENVIRONMENT = {
    "OGR_SKIP": ",".join(_SKIPPED),
    "GDAL_HTTP_PROXY": "127.0.0.1:9",
    "GDAL_HTTPS_PROXY": "127.0.0.1:9",
    "CPL_VSIL_CURL_ALLOWED_EXTENSIONS": ".none",
    "OGR_SQLITE_LIST_VIRTUAL_OGR": "NO",
    "GML_SKIP_RESOLVE_ELEMS": "ALL",
    "LIBKML_RESOLVE_STYLE": "NO",
    "SHAPE_RESTORE_SHX": "YES",
    "GPX_USE_EXTENSIONS": "YES",
    "PROJ_NETWORK": "OFF",
    "GDAL_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "PYTHONUTF8": "1",
}


class _Clock(threading.Thread):
    """Ends a process that works for longer than it may, or sleeps.

    What counts is the process's own working time, or a busy machine would refuse good files. Real
    time counts where it only sleeps, and as a far backstop, `limits.PATIENCE` times as long. The
    process has the same limit by itself (`_limit_work`), where the system tells no working time.
    """

    def __init__(self, process: subprocess.Popen[bytes], seconds: float) -> None:
        super().__init__(daemon=True)
        self._process, self._seconds = process, seconds
        self._done = threading.Event()
        self.is_late = False

    def run(self) -> None:
        """Look at the process until it has answered."""
        began = awake = time.monotonic()
        first = seen = _work(self._process.pid)
        while not self._done.wait(min(0.1, self._seconds / 10)):
            now, own = time.monotonic(), _work(self._process.pid)
            if own.worked_s > seen.worked_s or own.waits_for_its_turn:
                awake, seen = now, own
            if (
                own.worked_s - first.worked_s > self._seconds
                or now - awake > self._seconds
                or now - began > limits.PATIENCE * self._seconds
            ):
                self.is_late = True
                self._process.kill()
                return

    def cancel(self) -> None:
        """Stop looking."""
        self._done.set()


class _Work(NamedTuple):
    """How long a process has worked, and whether it would if it had a processor."""

    worked_s: float
    waits_for_its_turn: bool


def _work(pid: int) -> _Work:
    """Return the work of a process; nothing where the system does not tell."""
    try:
        after_name = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2]
    except OSError:
        return _Work(0.0, waits_for_its_turn=False)
    state, *numbers = after_name.split()
    ticks = int(numbers[10]) + int(numbers[11])
    return _Work(ticks / os.sysconf("SC_CLK_TCK"), state in {"R", "D"})


def own_path() -> str:
    """Return where Python is to look first for modules: beside this very package."""
    here = str(Path(__file__).resolve().parents[3])
    return os.pathsep.join([here, *filter(None, [os.environ.get("PYTHONPATH")])])


class ReadingProcess:
    """One reading process; it loads `modules` before its first file."""

    def __init__(self, *modules: str) -> None:
        # -P: a folder of downloads that one happens to stand in must not shadow a module
        self._process = subprocess.Popen(  # noqa: S603 - our own names
            [sys.executable, "-P", "-m", "fieldmon.io.sandbox.process", *modules],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=os.environ | _ENVIRONMENT | {"PYTHONPATH": own_path()},
        )
        self.uses = 0

    @property
    def pid(self) -> int:
        """Return the number of the process."""
        return self._process.pid

    def call(self, task: str, arguments: tuple[Any, ...], seconds: float) -> Any:  # noqa: ANN401
        """Return what ``module:function`` returns there; raise what it raises there."""
        self.uses += 1
        clock = _Clock(self._process, seconds)
        clock.start()
        try:
            sent, received = self._pipes()
            pickle.dump((task, arguments, seconds), sent, protocol=5)
            sent.flush()
            is_good, answer = pickle.load(received)  # noqa: S301 - see the module's first words
        except (EOFError, OSError, pickle.UnpicklingError) as gone:
            self.stop()
            is_late = clock.is_late or self._process.returncode == -_OUT_OF_TIME
            raise FileProblem(self._why(is_late)) from gone
        finally:
            clock.cancel()
        if is_good:
            return answer
        raise answer

    def _pipes(self) -> tuple[IO[bytes], IO[bytes]]:
        if self._process.stdin is None or self._process.stdout is None:
            raise EOFError("the reading process has no pipes")
        return self._process.stdin, self._process.stdout

    def _why(self, late: bool) -> str:  # noqa: FBT001
        if late:
            return worded(
                "A file must be read within {read_seconds:g} seconds of work, but this one "
                "takes longer: it is too big or made to be slow. Cut it to the plots that "
                "matter.",
                read_seconds=limits.READ_SECONDS,
            )
        return worded(
            "The file made its reader crash and was given up: it is damaged, or made to do "
            "harm. Export or download it again."
        )

    @property
    def is_alive(self) -> bool:
        """Return whether the process can take another file."""
        return self._process.poll() is None

    @property
    def peak_bytes(self) -> int:
        """Return the most memory the process ever took; 0 where the system does not tell."""
        with suppress(OSError):
            for line in Path(f"/proc/{self.pid}/status").read_text(encoding="ascii").splitlines():
                if line.startswith("VmHWM:"):
                    return int(line.split()[1]) * 1024
        return 0

    def stop(self) -> None:
        """End the process and wait until it is gone."""
        self._process.kill()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()
        self._process.wait()


class _Idle:
    """Readers that wait for the next file."""

    def __init__(self) -> None:
        self._readers: list[ReadingProcess] = []
        self._lock = threading.Lock()
        atexit.register(self.stop)

    def borrow(self, *modules: str) -> ReadingProcess:
        with self._lock:
            while self._readers:
                reader = self._readers.pop()
                if reader.is_alive:
                    return reader
                reader.stop()
        return ReadingProcess(*modules)

    def give_back(self, reader: ReadingProcess) -> None:
        with self._lock:
            if reader.is_alive and reader.uses < _USES and not self._readers:
                self._readers.append(reader)
                return
        reader.stop()

    def peaks_bytes(self) -> list[int]:
        with self._lock:
            return [reader.peak_bytes for reader in self._readers]

    def stop(self) -> None:
        with self._lock:
            for reader in self._readers:
                reader.stop()
            self._readers.clear()


_IDLE = _Idle()


def call(task: str, *arguments: Any, seconds: float = limits.READ_SECONDS) -> Any:  # noqa: ANN401
    """Return what ``module:function`` returns in a reading process.

    Raises
    ------
    FieldmonError
        What the function raised; `FileProblem` where the process crashed, worked for more than
        `seconds` or took more than `limits.MEMORY_BYTES`.
    """
    reader = _IDLE.borrow()
    try:
        return reader.call(task, arguments, seconds)
    finally:
        _IDLE.give_back(reader)


def warm(*modules: str) -> None:
    """Start a reading process now, so that the first file need not wait for it to load `modules`.

    None: all that read files.
    """
    _IDLE.give_back(_IDLE.borrow(*(modules or ALL_READERS)))


def peaks_bytes() -> list[int]:
    """Return the most memory that each waiting process ever took."""
    return _IDLE.peaks_bytes()


def stop() -> None:
    """End the waiting processes; the next file starts another."""
    _IDLE.stop()


class _WithoutTables(MetaPathFinder):
    """Hides GeoPandas and pandas from pyogrio, which loads them for tables that nobody reads here.

    They take as long as all else that it loads. Others, as pyarrow for nanoseconds, find them.
    """

    def find_spec(self, name: str, *_: object) -> None:
        """Refuse both while pyogrio looks for what is installed."""
        looking = sys.modules.get("pyogrio._compat")
        is_looking = looking is not None and not hasattr(looking, "HAS_GEOPANDAS")
        if is_looking and name in {"geopandas", "pandas"}:
            raise ModuleNotFoundError(f"{name} is not needed to read files", name=name)


def _serve() -> None:
    """Answer calls on standard input until it is closed."""
    calls = sys.stdin.buffer
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever a library prints must not end up among the answers
    _limit_memory()
    sys.meta_path.insert(0, _WithoutTables())
    for module in sys.argv[1:]:
        importlib.import_module(module)
    while True:
        try:
            task, arguments, seconds = pickle.load(calls)  # noqa: S301 - from our own program
        except EOFError:
            return
        _limit_work(seconds)
        pickle.dump(_answer(task, arguments), answers, protocol=5)
        answers.flush()


def _answer(task: str, arguments: tuple[Any, ...]) -> tuple[bool, Any]:
    module, _, function = task.partition(":")
    try:
        return True, getattr(importlib.import_module(module), function)(*arguments)
    except MemoryError:
        return False, FileProblem(
            worded(
                "Reading a file may take {size} of memory at most, but this "
                "one takes more. Cut it to the plots that matter.",
                size=limits.size(limits.MEMORY_BYTES),
            )
        )
    except RecursionError:
        return False, FileProblem(
            worded("A file must not be nested beyond reason, but this one is. Do not trust it.")
        )
    except Exception as bad:  # noqa: BLE001 - everything is for the caller to see
        return False, bad


def _limit_work(seconds: float) -> None:
    """Let the system end this process a second after it has worked for so long on one file."""
    if sys.platform != "win32":
        used = resource.getrusage(resource.RUSAGE_SELF)
        until = int(used.ru_utime + used.ru_stime + seconds) + 2
        hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
        if hard == resource.RLIM_INFINITY or until < hard:
            resource.setrlimit(resource.RLIMIT_CPU, (until, hard))


def _limit_memory() -> None:
    if sys.platform != "win32":  # there the clock holds alone
        resource.setrlimit(resource.RLIMIT_DATA, (limits.MEMORY_BYTES, limits.MEMORY_BYTES))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


if __name__ == "__main__":
    _serve()
