"""`fieldmon app`: the app in the browser. Heavy imports wait."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.app_package import app_package
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.progress import WAITING
from fieldmon.errors import SettingError

_GOODBYE_S = 10
_HERE = "127.0.0.1"


@dataclass(frozen=True)
class AppOptions:
    """What `fieldmon app` is told."""

    port: Annotated[int, typer.Option(help="Port on this machine.", callback=within(1, 65535))] = (
        8501
    )
    address: Annotated[
        str | None,
        typer.Option(
            help="Address to listen on; others may only see it beyond 127.0.0.1.",
            show_default=_HERE,
        ),
    ] = None
    seasons: Annotated[
        Path, typer.Option(help="Folder in which seasons are kept; made when one begins.")
    ] = Path("seasons")
    name: Annotated[
        list[str] | None,
        typer.Option(
            help="Name by which browsers ask for this machine, in a network or behind a proxy; "
            "may be repeated. Its own name and numbers are known."
        ),
    ] = None
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True
    lan: Annotated[
        bool,
        typer.Option(
            "--lan",
            help="Let phones on the local network in: encrypted, behind a password, with codes to "
            "scan.",
        ),
    ] = False
    reached_at: Annotated[
        str,
        typer.Option(help="Address at which others reach the app behind a server of your own."),
    ] = ""

    def of_others(self) -> dict[str, str]:
        """Return what tells the server of other devices; raise `SettingError` if it cannot be."""
        at = self.reached_at
        if at and not at.startswith("https://"):
            raise SettingError(
                "The address at which others reach the app must begin with https://, for phones "
                f"give no position to others, but it is {at!r}."
            )
        if at.rstrip("/").count("/") > 2:  # two are those of https://
            raise SettingError(
                "The address at which others reach the app must be a name, and perhaps a port, "
                f"without a path, but it is {at!r}. Give the app a name of its own, as "
                "https://field.example."
            )
        told = {"FIELDMON_ADDRESS": at.rstrip("/")} if at else {}
        if self.lan:
            told["FIELDMON_LAN"] = (self.address or "").strip("[]")
            if told["FIELDMON_LAN"] in {_HERE, "::1"}:
                raise SettingError(
                    "The address for --lan must be one at which phones reach this machine, but "
                    f"{told['FIELDMON_LAN']} is its own. Leave out --address, or say another."
                )
        return told

    def names(self) -> str:
        """Return the names by which browsers may ask, that of a server before us among them."""
        names = self.name or os.environ.get("FIELDMON_NAMES", "").split(",")
        before = self.reached_at.partition("://")[2].partition("/")[0].partition(":")[0]
        return ",".join([*names, before] if before else names)


@with_options
def open_app(options: AppOptions) -> None:
    """Open the app in the browser. It needs no internet; stop it with Ctrl-C."""
    from fieldmon.io.sandbox.process import own_path

    server = f"{app_package()[0]}.startup.serve"
    others = options.of_others()
    address = _HERE if options.lan else options.address or _HERE
    _must_be_free(address, options.port)
    if not options.lan:  # else the server says it, once it has an address for others
        typer.echo(f"fieldmon is at http://{address}:{options.port} (stop it with Ctrl-C)")
    # -P: -m looks in the folder one stands in first, which need not be where the app is
    command = [sys.executable, "-P", "-m", server, *(["--browser"] if options.browser else [])]
    # everything else is set, with reasons, in the app's own .streamlit/config.toml
    env = os.environ | {
        "STREAMLIT_SERVER_ADDRESS": address,
        "STREAMLIT_SERVER_PORT": str(options.port),
        "FIELDMON_SEASONS": str(options.seasons.absolute()),
        "FIELDMON_NAMES": options.names(),
        "PYTHONPATH": own_path(),
        **others,
    }
    with WAITING.silent():
        raise typer.Exit(_run(command, env))


def _must_be_free(address: str, port: int) -> None:
    """Raise `SettingError` where something else listens."""
    import socket

    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((address, port))
        except OSError as error:
            raise SettingError(
                f"Port {port} at {address} must be free, but it is not ({error.strerror}). "
                "Close what uses it, or choose another with --port."
            ) from error


def _run(command: list[str], env: dict[str, str]) -> int:
    """Run the server until it ends; what ends this program ends it too. Return its exit code."""
    import subprocess

    from fieldmon.cli.told_to_end import told_to_end

    ended = False
    server: subprocess.Popen[bytes] | None = None

    def end() -> None:
        nonlocal ended
        ended = True
        if server is not None:
            server.terminate()

    with told_to_end(end):
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
