"""The command `doe-kc live` in a process of its own, as a user starts it."""

from __future__ import annotations

import http.client
import re
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.live.cases import EXAMPLES, RIG


@dataclass
class Served:
    """process: the command. address: with its token. lines: what it said before it was ready."""

    process: subprocess.Popen[str]
    address: str
    lines: list[str]

    @property
    def port(self) -> int:
        """Of 127.0.0.1."""
        return int(re.findall(r":(\d+)/", self.address)[0])

    @property
    def token(self) -> str:
        """Of the address."""
        return self.address.partition("token=")[2]

    @property
    def cookie(self) -> str:
        """As a browser sends it."""
        return f"doe_kc_live_{self.port}={self.token}"

    def get(self, path: str, **headers: str) -> tuple[int, Mapping[str, str], str]:
        """Status, headers and text of the answer to a request; headers: Host replaced where it is given."""
        with closing(http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)) as connection:
            connection.putrequest("GET", path, skip_host="Host" in headers)
            for name, value in headers.items():
                connection.putheader(name, value)
            connection.endheaders()
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read().decode()

    def end(self, number: int = signal.SIGINT) -> tuple[int, str]:
        """Exit code after a signal, and what it said last."""
        self.process.send_signal(number)
        _, said = self.process.communicate(timeout=60)
        return self.process.returncode, said


@contextmanager
def serving(out: Path, *options: str, study: Path | None = None) -> Iterator[Served]:
    """A study, by default the McPherson beside a virtual car; ended afterwards, whatever happens."""
    command = [sys.executable, "-m", "doe_kc", "live", str(study or EXAMPLES / "front_axle")]
    command += [] if study else ["--measurement", str(RIG / "car_b")]
    command += ["--no-browser", "--out", str(out), *options]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    lines: list[str] = []
    try:
        while not any("http" in line for line in lines):
            line = process.stderr.readline()
            assert line, f"ended with {process.wait()}: {lines}"
            lines.append(line)
        address = next(found[0] for line in lines if (found := re.findall(r"http\S+", line)))
        yield Served(process, address, lines)
    finally:
        if process.poll() is None:
            process.terminate()
            process.wait(60)
        process.stderr.close()
