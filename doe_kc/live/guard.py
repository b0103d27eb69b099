"""Who may talk to the live page: this computer's browser, at this address, with the token.

Any page that a browser has open may send requests to 127.0.0.1 and open sockets to it, and a name of another
site may be made to point there (DNS rebinding): so Host and Origin are checked on everything, and a random
token that other pages cannot know.
"""

from __future__ import annotations

import hmac
from collections.abc import Awaitable, Callable, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]


class Guard:
    """Passes on what comes from the page itself, refuses the rest with 403; adds the security headers."""

    def __init__(self, application: Application, *, token: str, port: int) -> None:
        self._application, self._token, self._port = application, token, port
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}
        self._origins = {f"http://{host}" for host in self._hosts}

    @property
    def cookie(self) -> str:
        """Its name has the port: cookies are shared by all ports of a host."""
        return f"doe_kc_live_{self._port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request or socket."""
        if scope["type"] not in ("http", "websocket"):
            await self._application(scope, receive, send)
            return
        reason = self._refusal(scope)
        if not reason:
            await self._application(scope, receive, self._with_headers(send, scope))
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": reason})
        else:
            body = f"doe-kc live: {reason}\n".encode()
            headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"cache-control", b"no-store")]
            await send({"type": "http.response.start", "status": 403, "headers": headers})
            await send({"type": "http.response.body", "body": body})

    def _refusal(self, scope: Scope) -> str:
        """Why the request is refused, in words; empty when it is not."""
        headers: dict[bytes, list[str]] = {}
        for name, value in scope["headers"]:
            headers.setdefault(name.lower(), []).append(value.decode("latin-1"))
        if headers.get(b"host", []) not in [[h] for h in self._hosts]:
            return "the address is not the one that doe-kc printed; open that."
        origins = headers.get(b"origin", [])
        if (origins or scope["type"] == "websocket") and origins not in [[o] for o in self._origins]:
            return "the request comes from another page."
        if scope["type"] == "http" and scope["method"] not in ("GET", "HEAD"):
            return "only the page itself can be asked for."
        if not self._has_token(scope, headers.get(b"cookie", [])):
            return "the token is missing or wrong; open the address that doe-kc printed."
        return ""

    def _has_token(self, scope: Scope, cookies: list[str]) -> bool:
        """The page is opened by the token in its address; all else has it in the cookie that came with it."""
        given = []
        if scope["path"] == "/":
            given += parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
        try:
            jar = SimpleCookie("; ".join(cookies))
            given += [jar[self.cookie].value] if self.cookie in jar else []
        except CookieError:
            pass
        return any(hmac.compare_digest(t.encode(), self._token.encode()) for t in given)

    def _with_headers(self, send: Send, scope: Scope) -> Send:
        async def sent(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", []), *self._headers(scope)]
            await send(message)

        return sent

    def _headers(self, scope: Scope) -> list[tuple[bytes, bytes]]:
        sockets = " ".join(f"ws://{host}" for host in sorted(self._hosts))
        policy = (
            f"default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
            f"connect-src 'self' {sockets}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        )
        headers = {
            "content-security-policy": policy,
            "x-content-type-options": "nosniff",
            "referrer-policy": "no-referrer",
            "cross-origin-resource-policy": "same-origin",
            "cross-origin-opener-policy": "same-origin",
            "cache-control": "no-store",
        }
        if scope["path"] == "/":
            headers["set-cookie"] = f"{self.cookie}={self._token}; Path=/; HttpOnly; SameSite=Strict"
        return [(name.encode(), value.encode()) for name, value in headers.items()]
