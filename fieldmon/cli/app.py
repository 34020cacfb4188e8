"""`fieldmon app`: the app in the browser. Heavy imports wait."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.waiting import WAITING
from fieldmon.errors import SettingError

_GOODBYE_S = 10


def open_app(
    port: Annotated[int, typer.Option(help="Port on this machine.", min=1, max=65535)] = 8501,
    address: Annotated[
        str, typer.Option(help="Address to listen on; others may only see it beyond 127.0.0.1.")
    ] = "127.0.0.1",
    seasons: Annotated[
        Path, typer.Option(help="Folder in which seasons are kept; made when one begins.")
    ] = Path("seasons"),
    name: Annotated[
        list[str] | None,
        typer.Option(
            help="Name by which browsers ask for this machine, in a network or behind a proxy; "
            "may be repeated. Its own name and numbers are known."
        ),
    ] = None,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,  # noqa: FBT002
) -> None:
    """Open the app in the browser. It needs no internet; stop it with Ctrl-C."""
    import socket  # noqa: PLC0415

    from fieldmon.io.sandbox.process import own_path  # noqa: PLC0415

    server = _server()
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((address, port))
        except OSError as error:
            raise SettingError(
                f"Port {port} at {address} must be free, but it is not ({error.strerror}). "
                "Close what uses it, or choose another with --port."
            ) from error
    typer.echo(f"fieldmon is at http://{address}:{port} (stop it with Ctrl-C)")
    # -P: -m looks in the folder one stands in first, which need not be where the app is
    command = [sys.executable, "-P", "-m", server, *(["--browser"] if browser else [])]
    # everything else is set, with reasons, in the app's own .streamlit/config.toml
    env = os.environ | {
        "STREAMLIT_SERVER_ADDRESS": address,
        "STREAMLIT_SERVER_PORT": str(port),
        "FIELDMON_SEASONS": str(seasons.absolute()),
        "FIELDMON_NAMES": ",".join(name or os.environ.get("FIELDMON_NAMES", "").split(",")),
        "PYTHONPATH": own_path(),
    }
    with WAITING.silent():
        raise typer.Exit(_run(command, env))


def _run(command: list[str], env: dict[str, str]) -> int:
    """Run the server until it ends; what ends this program ends it too. Return its exit code."""
    import signal  # noqa: PLC0415
    import subprocess  # noqa: PLC0415

    ended = False
    server: subprocess.Popen[bytes] | None = None

    def end(*_: object) -> None:
        nonlocal ended
        ended = True
        if server is not None:
            server.terminate()

    for name in ("SIGTERM", "SIGHUP"):  # the second is not known everywhere
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), end)
    server = subprocess.Popen(command, env=env)  # noqa: S603 - our own
    if ended:  # before there was a server to tell
        server.terminate()
    try:
        code = server.wait()
    except KeyboardInterrupt:  # which the server has heard too
        try:
            code = server.wait(_GOODBYE_S)
        except subprocess.TimeoutExpired:
            server.kill()
            code = server.wait()
    return code if code >= 0 else 128 - code


def _server() -> str:
    """Return the module that serves the app: in fieldmon as installed, beside it in its tree."""
    fieldmon = Path(__file__).resolve().parents[1]
    for package, folder in (("fieldmon._app", fieldmon / "_app"), ("app", fieldmon.parent / "app")):
        if (folder / "startup" / "serve.py").is_file():
            return f"{package}.startup.serve"
    raise SettingError("The app must be installed beside fieldmon, but it was not found.")
