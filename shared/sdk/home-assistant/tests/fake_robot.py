"""A robot that answers as a console did: `fixtures/console.json`, which the console's own tests hold it to."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path
from typing import Any

from aiohttp import web

RECORDED = json.loads((Path(__file__).parent / "fixtures/console.json").read_text())
ANSWERS: dict[str, dict[str, Any]] = RECORDED["answers"]
EVENTS: list[dict[str, Any]] = RECORDED["events"]
TOKEN = "0123456789abcdef0123456789abcdef"
ID = ANSWERS["info"]["body"]["id"]


def reply_of(name: str) -> dict[str, Any]:
    """Return a recorded reply."""
    return ANSWERS[name]["body"]["reply"]


def answer(name: str) -> web.Response:
    """Return a recorded answer."""
    recorded = ANSWERS[name]
    headers = {"Retry-After": recorded["retry_after"]} if recorded["retry_after"] else {}
    text = json.dumps(recorded["body"])
    return web.Response(status=recorded["status"], text=text, content_type=recorded["type"], headers=headers)


class Fake:
    """A console. `script` names the answers to what is said next, `answers` those to other requests."""

    def __init__(self) -> None:
        """Begin idle, with nothing said."""
        self.script: list[str] = []
        self.answers = {"info": "info", "state": "state_idle", "motion/stop": "stop", "motion/resume": "resumed"}
        self.info: dict[str, Any] = {}
        self.arm_moves = False
        self.arm_stop = 0
        self.stop_takes_s = 0.0
        self.token = TOKEN
        self.said: list[dict[str, Any]] = []
        self.keys: list[str] = []
        self.asked: list[str] = []
        self.authorizations: list[str | None] = []
        self.bodies: dict[str, str] = {}
        self.resumed_after: list[str | None] = []
        self._replies: dict[str, str] = {}
        self._streams: set[web.StreamResponse] = set()
        self._kept: list[bytes] = []
        self._closing = asyncio.Event()
        self._runner: web.AppRunner | None = None
        self.port = 0

    @property
    def url(self) -> str:
        """Where it listens."""
        return f"http://127.0.0.1:{self.port}"

    async def start(self) -> None:
        """Listen, at the same port as before."""
        app = web.Application()
        app.router.add_get("/api/v1/events", self._events)
        app.router.add_post("/api/v1/say", self._say)
        app.router.add_route("*", "/api/v1/{path:.*}", self._other)
        self._closing.clear()
        self._runner = web.AppRunner(app, shutdown_timeout=0.1, handler_cancellation=True)
        await self._runner.setup()
        site = web.TCPSite(self._runner, "127.0.0.1", self.port, reuse_address=True)
        await site.start()
        self.port = self._runner.addresses[0][1]

    async def end(self) -> None:
        """Close every connection, and listen no more."""
        await self.drop()
        if self._runner is not None:
            await self._runner.cleanup()
            self._runner = None

    async def drop(self) -> None:
        """End the streams of events."""
        self._closing.set()
        while self._streams:  # noqa: ASYNC110
            await asyncio.sleep(0.01)
        self._closing.clear()

    async def publish(self, *names: str) -> None:
        """Send the recorded events up to the next one of each name; those in between as well."""
        for name in names:
            while True:
                event = EVENTS[len(self._kept) + 1]
                await self._send(event["event"], event["data"])
                if event["event"] == name:
                    break

    async def _send(self, name: str, data: dict[str, Any]) -> None:
        number = len(self._kept) + 1
        frame = f"id: fake-{number}\nevent: {name}\ndata: {json.dumps(data)}\n\n".encode()
        self._kept.append(frame)
        for stream in list(self._streams):
            await stream.write(frame)

    def _is_refused(self, request: web.Request) -> bool:
        return request.headers.get("Authorization") != f"Bearer {self.token}"

    async def _say(self, request: web.Request) -> web.Response:
        if self._is_refused(request):
            return answer("no_token")
        body, key = await request.json(), request.headers["Idempotency-Key"]
        self.said.append(body)
        self.keys.append(key)
        name = self._replies.get(key) or self.script.pop(0)
        if name == "unavailable":
            return answer(name)
        self._replies[key] = name
        return answer(name)

    async def _other(self, request: web.Request) -> web.Response:
        path = request.match_info["path"]
        self.asked.append(path)
        self.authorizations.append(request.headers.get("Authorization"))
        self.bodies[path] = await request.text()
        if path == "info" and self.info:
            return web.json_response(ANSWERS["info"]["body"] | self.info)
        if path != "info" and self._is_refused(request):
            return answer("no_token")
        if path == "motion/stop":
            await asyncio.sleep(self.stop_takes_s)
        if path == "state" and (self.arm_moves or self.arm_stop):
            return web.json_response(self._state())
        return answer(self.answers[path])

    def _state(self) -> dict[str, Any]:
        state = ANSWERS[self.answers["state"]]["body"]
        return state | {"arm": state["arm"] | {"moving": self.arm_moves, "stop": self.arm_stop}}

    async def _events(self, request: web.Request) -> web.StreamResponse:
        if self._is_refused(request):
            return answer("no_token")
        last = request.headers.get("Last-Event-ID")
        self.resumed_after.append(last)
        response = web.StreamResponse(headers={"Content-Type": "text/event-stream"})
        await response.prepare(request)
        if last:
            missed = self._kept[int(last.removeprefix("fake-")) :]
        else:
            state = json.dumps(self._state())
            missed = [f"id: fake-{len(self._kept)}\nevent: snapshot\ndata: {state}\n\n".encode()]
        for frame in [b": alive\n\n", *missed]:
            await response.write(frame)
        self._streams.add(response)
        try:
            await self._closing.wait()
        finally:
            self._streams.discard(response)
        return response
