"""Serves the live page until Ctrl-C, or until its last tab has been closed for a time."""

from __future__ import annotations

import asyncio
import contextlib
import os
import secrets
import signal
import socket
import sys
import time
import webbrowser
from collections.abc import Callable, Iterator
from types import FrameType

import uvicorn

from doe_kc.ground.errors import RunError
from doe_kc.ground.signals import SIGNALS, of_this_process
from doe_kc.live.guard import Guard
from doe_kc.live.messages import LONGEST_MESSAGE
from doe_kc.live.server import LiveServer
from doe_kc.live.session import Session

FIRST_PORT = 8350
PORTS_TRIED = 20
LOOK_AROUND = 0.5
"""Seconds between looks at whether a tab is open."""
LOOPBACK = "127.0.0.1"


class _Uvicorn(uvicorn.Server):
    """Leaves the signals to `serve`, which knows that Ctrl-C is how a live page ends well."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


def bound_socket(port: int) -> socket.socket:
    """A listening place at 127.0.0.1: the port, or the next free one; RunError when twenty are taken."""
    for candidate in range(port, min(port + PORTS_TRIED, 65536)):
        place = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if os.name == "posix":
            place.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            place.bind((LOOPBACK, candidate))
            place.listen()
        except OSError:
            place.close()
            continue
        return place
    raise RunError(f"ports {port} to {port + PORTS_TRIED - 1} are all taken; choose another with --port.")


def can_open_browser() -> bool:
    """Whether this computer has a screen that a browser can be shown on."""
    if sys.platform != "linux":
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def serve(
    session: Session,
    *,
    port: int = FIRST_PORT,
    idle: float = 600.0,
    browser: bool = True,
    say: Callable[[str], None],
) -> None:
    """Serve until Ctrl-C or SIGTERM, or until no tab has been open for `idle` seconds.

    say: told the address and how to end. RunError when no port is free.
    """
    place = bound_socket(port)
    chosen = place.getsockname()[1]
    token = secrets.token_urlsafe(24)
    address = f"http://{LOOPBACK}:{chosen}/?token={token}"
    if chosen != port:
        say(f"port {port} is taken; using {chosen}")
    live = LiveServer(session)
    try:
        say(f"open {address}")
        say(f"ends with Ctrl-C, or {idle / 60.0:g} minutes after the last tab is closed")
        if browser and can_open_browser():
            with contextlib.suppress(webbrowser.Error):
                webbrowser.open(address)
        asyncio.run(_serve(live, Guard(live.application, token=token, port=chosen), place, idle))
    finally:
        place.close()
        live.close()


async def _serve(live: LiveServer, guard: Guard, place: socket.socket, idle: float) -> None:
    config = uvicorn.Config(
        guard,
        log_level="error",
        access_log=False,
        http="h11",
        ws="websockets-sansio",
        ws_max_size=LONGEST_MESSAGE,
        lifespan="off",
        server_header=False,
        timeout_graceful_shutdown=2,
    )
    server = _Uvicorn(config)

    def end(_number: int, _frame: FrameType | None) -> None:
        server.should_exit = True

    before = {number: signal.signal(number, of_this_process(end)) for number in SIGNALS}
    watch = asyncio.create_task(_watch(live, server, idle))
    try:
        await server.serve(sockets=[place])
    finally:
        watch.cancel()
        for number, handler in before.items():
            signal.signal(number, handler)


async def _watch(live: LiveServer, server: uvicorn.Server, idle: float) -> None:
    while not server.should_exit:
        await asyncio.sleep(min(LOOK_AROUND, idle / 4.0))
        if live.tabs:
            live.last_open = time.monotonic()
        elif time.monotonic() - live.last_open > idle:
            server.should_exit = True
