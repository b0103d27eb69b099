"""The served page: who may talk to it, what it refuses, that the latest request wins, and how it ends."""

from __future__ import annotations

import json
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from doe_kc.live.frames import PRESENT, PageFrame
from doe_kc.live.messages import LONGEST_MESSAGE
from tests.live.served import Served, serving


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with serving(tmp_path_factory.mktemp("live"), "--port", "18350") as process:
        yield process


def open_socket(served: Served, **changed: str) -> ClientConnection:
    headers = {"Cookie": served.cookie} | {k: v for k, v in changed.items() if k != "Origin"}
    origin: Any = changed.get("Origin", f"http://127.0.0.1:{served.port}")
    address = f"ws://127.0.0.1:{served.port}/socket"
    return connect(address, additional_headers=headers, origin=origin or None, max_size=None)


def until(socket: ClientConnection, wanted: Any) -> Any:
    """The first message that `wanted` is true of: a dict or a frame."""
    end = time.monotonic() + 60
    while time.monotonic() < end:
        data = socket.recv(timeout=60)
        message = json.loads(data) if isinstance(data, str) else PageFrame.decode(data)
        if wanted(message):
            return message
    raise TimeoutError


def test_the_page_is_served_with_its_policy(served: Served) -> None:
    status, headers, page = served.get(f"/?token={served.token}")
    policy, cookie = headers["content-security-policy"], headers["set-cookie"]
    assert status == 200 and "default-src 'none'" in policy and "unsafe" not in policy
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie and headers["cache-control"] == "no-store"
    assert "http:" not in page and "https:" not in page
    assert served.get("/assets/live.js", Cookie=served.cookie)[0] == 200
    for path in ("/assets/server.py", "/assets/..%2fserver.py", "/study.toml", "/assets/"):
        assert served.get(path, Cookie=served.cookie)[0] == 404


@pytest.mark.parametrize(
    ("path", "headers"),
    [
        ("/", {}),
        ("/?token=wrong", {}),
        ("/?token=", {}),
        ("/assets/live.js?token={token}", {}),
        ("/?token={token}", {"Host": "evil.example:18350"}),
        ("/?token={token}", {"Host": "127.0.0.1"}),
        ("/?token={token}", {"Origin": "http://evil.example"}),
        ("/?token={token}", {"Origin": "null"}),
        ("/assets/live.js", {"Cookie": "doe_kc_live_1=x; ="}),
    ],
)
def test_strangers_are_refused(served: Served, path: str, headers: dict[str, str]) -> None:
    status, told, _ = served.get(path.format(token=served.token), **headers)
    assert status == 403 and "set-cookie" not in told


@pytest.mark.parametrize(
    "changed",
    [
        {"Origin": "http://evil.example"},
        {"Origin": ""},
        {"Cookie": "doe_kc_live_18350=wrong"},
    ],
)
def test_sockets_of_strangers_are_refused(served: Served, changed: dict[str, str]) -> None:
    with pytest.raises(InvalidStatus):
        open_socket(served, **changed)


def test_the_latest_request_wins(served: Served) -> None:
    with open_socket(served) as tab:
        model = until(tab, lambda m: isinstance(m, dict) and m["kind"] == "model")
        place = next(i for i, s in enumerate(model["sliders"]) if s["path"] == "LLF.z")
        start = model["sliders"][place]["start"]
        for k in range(1, 101):
            message = {"kind": "move", "seq": 1000 + k, "path": "LLF.z", "value": start + 0.01 * k}
            tab.send(json.dumps({**message, "last": k == 100}))
        seen: list[PageFrame] = []

        def last(m: Any) -> bool:
            if isinstance(m, PageFrame) and m.kind == PRESENT:
                seen.append(m)
            return bool(seen) and seen[-1].seq == 1100

        until(tab, last)
        seqs = [m.seq for m in seen]
        assert seqs == sorted(seqs) and len(seqs) < 100
        assert seen[-1].exact[place] == pytest.approx(start + 1.0)
        tab.send('{"kind": "undo", "seq": 1101}')
        until(tab, lambda m: isinstance(m, PageFrame) and m.kind == PRESENT and m.exact[place] == start)


def test_two_tabs_see_the_same(served: Served) -> None:
    with open_socket(served) as one, open_socket(served) as other:
        model = until(other, lambda m: isinstance(m, dict) and m["kind"] == "model")
        place = next(i for i, s in enumerate(model["sliders"]) if s["path"] == "RIB.z")
        value = model["sliders"][place]["start"] + 0.75
        one.send(json.dumps({"kind": "move", "seq": 2000, "path": "RIB.z", "value": value}))
        until(other, lambda m: isinstance(m, PageFrame) and m.kind == PRESENT and m.exact[place] == value)
        one.send('{"kind": "reset", "seq": 2001}')
        until(other, lambda m: isinstance(m, PageFrame) and m.kind == PRESENT and m.exact[place] != value)


def test_malformed_messages_are_answered_and_huge_ones_end_the_tab(served: Served) -> None:
    with open_socket(served) as tab:
        for text in ("{", "[]", '{"kind": "open", "path": "/etc/passwd"}', b"\x00\xff", '{"kind": "look"}'):
            tab.send(text)
            said = until(tab, lambda m: isinstance(m, dict) and m["kind"] == "refused")
            assert said["reason"] and "Traceback" not in said["reason"]
        tab.send('{"kind": "undo"}' + " " * (2 * LONGEST_MESSAGE))
        with pytest.raises(ConnectionClosed):
            until(tab, lambda m: False)
    with open_socket(served) as tab:
        until(tab, lambda m: isinstance(m, dict) and m["kind"] == "model")


def test_a_flood_ends_the_tab_alone(served: Served) -> None:
    with open_socket(served) as tab, pytest.raises(ConnectionClosed):
        for _ in range(200):
            for _ in range(100):
                tab.send("{")
        until(tab, lambda m: False)  # a busy machine may count them only now
    with open_socket(served) as tab:
        until(tab, lambda m: isinstance(m, dict) and m["kind"] == "model")


def test_only_this_computer_is_listened_to(served: Served) -> None:
    with socket.socket() as outside:
        outside.settimeout(2)
        assert outside.connect_ex(("127.0.0.2", served.port)) != 0


def test_a_taken_port_gives_the_next_and_it_ends_after_the_last_tab(served: Served, tmp_path: Path) -> None:
    with serving(tmp_path, "--port", str(served.port), "--idle", "0.02") as second:
        assert second.port != served.port and any("taken" in line for line in second.lines)
        with open_socket(second) as tab:
            until(tab, lambda m: isinstance(m, dict) and m["kind"] == "model")
            time.sleep(2.0)
            assert second.process.poll() is None
        assert second.process.wait(30) == 0


def test_ctrl_c_ends_it_well_with_a_tab_open(served: Served) -> None:
    """Last: it ends the server of the tests above."""
    with open_socket(served) as tab:
        until(tab, lambda m: isinstance(m, dict) and m["kind"] == "model")
        code, said = served.end()
        with pytest.raises(ConnectionClosed):
            until(tab, lambda m: False)
    assert code == 0 and "has ended" in said and "Traceback" not in said
