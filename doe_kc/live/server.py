"""The live page's server: one session, any number of tabs, each told only the newest of everything."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from doe_kc.ground.errors import DoeKcError
from doe_kc.live import documents, keep, views
from doe_kc.live import messages as says
from doe_kc.live.advice import Advised
from doe_kc.live.background_work import BackgroundWork
from doe_kc.live.page_files import SERVED, asset
from doe_kc.live.session import Session, SolveRequest, Update
from doe_kc.live.worker import LiveWorker

log = logging.getLogger("doe_kc")
MOST_MESSAGES = 600
"""From one tab within a second; a hand on a slider sends 60."""


class Tab:
    """One open page. Of each kind of news only the newest waits to be sent, so that a slow tab lags by one.

    look: load case and row in which it shows the axle. shown: model and snapshots whose curves it has.
    """

    def __init__(self, socket: WebSocket) -> None:
        self._socket = socket
        self._waiting: dict[str, bytes | dict[str, Any]] = {}
        self._wake = asyncio.Event()
        self.look = ("", 0)
        self.shown: tuple[object, ...] = ()
        self._second, self._count = 0.0, 0

    def tell(self, topic: str, news: bytes | dict[str, Any]) -> None:
        """Send this, in place of older news of the same topic."""
        self._waiting.pop(topic, None)
        self._waiting[topic] = news
        self._wake.set()

    def too_busy(self) -> bool:
        """Counts a message; whether the tab has sent too many within this second."""
        now = time.monotonic()
        if now - self._second > 1.0:
            self._second, self._count = now, 0
        self._count += 1
        return self._count > MOST_MESSAGES

    async def send_news(self) -> None:
        """Until cancelled."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self._waiting:
                topic = next(iter(self._waiting))
                news = self._waiting.pop(topic)
                if isinstance(news, bytes):
                    await self._socket.send_bytes(news)
                else:
                    await self._socket.send_json(news)


class LiveServer:
    """The application and what its tabs share. last_open: monotonic time at which a tab was last open."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.tabs: set[Tab] = set()
        self.last_open = time.monotonic()
        self._loop: asyncio.AbstractEventLoop | None = None
        self.worker = LiveWorker(session, self._solved, self._quiet)
        self.work = BackgroundWork(
            session, self.worker.put, lambda: self._in_loop(self._tell_work), self._answer_told
        )
        routes = [
            Route("/", self._page),
            Route("/assets/{name}", self._asset),
            WebSocketRoute("/socket", self._socket),
        ]
        self.application = Starlette(routes=routes)

    def close(self) -> None:
        """End what runs in the background and the solver's thread, and wait for a compiler at work."""
        self.work.close()
        self.worker.close()
        self.session.compilation.wait()

    async def _page(self, _: Request) -> Response:
        return Response(asset("live.html"), media_type="text/html")

    async def _asset(self, request: Request) -> Response:
        name = request.path_params["name"]
        if name not in SERVED:
            return PlainTextResponse("there is no such file.\n", status_code=404)
        return Response(asset(name), media_type=SERVED[name])

    async def _socket(self, socket: WebSocket) -> None:
        await socket.accept()
        self._loop = asyncio.get_running_loop()
        tab = Tab(socket)
        self.tabs.add(tab)
        sender = asyncio.create_task(tab.send_news())
        self._introduce([tab])
        try:
            await self._listen(tab, socket)
        except WebSocketDisconnect:
            pass
        finally:
            self.tabs.discard(tab)
            self.last_open = time.monotonic()
            sender.cancel()
            await asyncio.gather(sender, return_exceptions=True)

    async def _listen(self, tab: Tab, socket: WebSocket) -> None:
        while True:
            said = await socket.receive()
            if said["type"] == "websocket.disconnect":
                return
            if tab.too_busy():
                await socket.close(1008, "too many messages")
                return
            try:
                message = says.read_message(said.get("text") or said.get("bytes") or b"")
                self._heard(tab, message)
            except DoeKcError as error:
                tab.tell("refused", {"kind": "refused", "reason": str(error)})

    def _heard(self, tab: Tab, message: says.Message) -> None:
        if isinstance(message, says.Look):
            tab.look = (message.load_case, message.row)
            self.worker.put(partial(self._show_axle, tab, self.session.seq))
            return
        self._told(tab, self.session.handle(message), message)

    def _told(self, tab: Tab, changes: Update, message: says.Message) -> None:
        if changes.advice:
            self.worker.put(partial(self._advise, tab, changes.advice))
        if changes.keep:
            self.worker.put(partial(self._keep, tab, changes.keep))
        if isinstance(message, says.RunTask):
            self.work.begin(message.kind)
        elif changes.task:
            {"cancel": self.work.cancel, "forget": self.work.forget}[changes.task]()
        self._spread(changes)

    def _spread(self, changes: Update) -> None:
        """Tell all tabs, and have solved what has to be."""
        if changes.sliders:
            self._introduce(self.tabs)
        elif changes.state:
            self._tell_state(self.tabs)
        if changes.solve:
            self.worker.ask(self.session.request(at_rest=changes.at_rest))

    def _introduce(self, tabs: Iterable[Tab]) -> None:
        said = views.announcement(self.session)
        frame = views.present_frame(self.session, self.session.seq).encode()
        for tab in tabs:
            tab.tell("model", said)
            self._tell_state([tab])
            tab.tell("present", frame)
            tab.tell("work", documents.work_document(self.work))
        self.worker.put(self._quiet)

    def _tell_state(self, tabs: Iterable[Tab]) -> None:
        """The state, and the curves to compare with where a tab does not have them yet."""
        said = documents.state_document(self.session)
        snapshots = self.session.state.snapshots
        shown = (self.session.model.space, self.session.nominal, *(s.answer for s in snapshots))
        frames: list[bytes] = []
        for tab in tabs:
            tab.tell("state", said)
            if [id(part) for part in tab.shown] == [id(part) for part in shown]:
                continue
            tab.shown = shown
            frames = frames or [frame.encode() for frame in views.reference_frames(self.session)]
            for place, frame in enumerate(frames):
                tab.tell(f"reference {place}", frame)

    def _in_loop(self, do: Callable[[], None]) -> None:
        """From the solver's thread: do it where the tabs are."""
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(do)

    def _tell_work(self) -> None:
        said = documents.work_document(self.work)
        for tab in self.tabs:
            tab.tell("work", said)

    def _solved(self, request: SolveRequest) -> None:
        self._tell_answer(request.seq)
        self.work.confirm(request)

    def _answer_told(self) -> None:
        """The answer to what is set is another without a message: the outside solver has given it."""
        self._tell_answer(self.session.seq)
        self._in_loop(lambda: self._tell_state(self.tabs))
        self._quiet()

    def _tell_answer(self, seq: int) -> None:
        frame = views.present_frame(self.session, seq).encode()
        shapes = {tab: self._shape(tab, seq) for tab in list(self.tabs)}

        def tell() -> None:
            for tab in self.tabs:
                tab.tell("present", frame)
                if tab in shapes:
                    tab.tell("shape", shapes[tab])

        self._in_loop(tell)

    def _shape(self, tab: Tab, seq: int) -> bytes:
        return views.shape_frame(self.session.present, self.session.nominal.curves, *tab.look, seq).encode()

    def _show_axle(self, tab: Tab, seq: int) -> None:
        self._in_loop(partial(tab.tell, "shape", self._shape(tab, seq)))

    def _quiet(self) -> None:
        if self.session.present.model.space is not self.session.model.space:
            return  # its answer is still to come, or there is none
        slopes = self.session.slopes()
        frame = views.influence_frame(self.session, slopes, self.session.seq).encode()

        def tell() -> None:
            for tab in self.tabs:
                tab.tell("influence", frame)

        self._in_loop(tell)

    def _advise(self, tab: Tab, what: str) -> None:
        self._settle()
        try:
            advised = self.session.advise(what)
        except DoeKcError as error:
            self._in_loop(partial(tab.tell, "refused", {"kind": "refused", "reason": str(error)}))
            return
        self._in_loop(partial(self._advised, tab, advised))

    def _advised(self, tab: Tab, advised: Advised) -> None:
        tab.tell("advice", documents.advice_document(advised, self.session))
        if advised.adopt:
            self._spread(self.session.adopt(advised.adopt))

    def _settle(self) -> None:
        """Advice and files are of what is set, not of the answer before."""
        if not self.session.settled:
            self.session.solve_now()

    def _keep(self, tab: Tab, what: str) -> None:
        self._settle()
        try:
            if what == "reopen":
                state = keep.read_state(self.session)
                self._in_loop(lambda: self._spread(self.session.replaced(state)))
                sentence = "The saved exploration is open."
            else:
                sentence = keep.KEEPERS[what](self.session)
        except DoeKcError as error:
            self._in_loop(partial(tab.tell, "refused", {"kind": "refused", "reason": str(error)}))
            return
        self._in_loop(partial(tab.tell, "kept", {"kind": "kept", "sentence": sentence}))
