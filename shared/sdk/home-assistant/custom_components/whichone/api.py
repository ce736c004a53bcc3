"""The robot's HTTP interface, version 1: nothing but aiohttp, which Home Assistant brings."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import AsyncIterator
from dataclasses import dataclass
from typing import Any

import aiohttp

from .const import PAUSE_S, RETRY_S, SILENCE_S, STOP_RETRY_S, WAIT_S

# Refusals after which the same request may succeed.
_LATER = frozenset({"unavailable", "not_accepted", "too_many"})
# Longest line of an event, bytes: the state of a scene of 1,000 objects takes 64 KiB.
_LINE_MAX = 1 << 20


class RobotError(Exception):
    """A request was not carried out."""


class CannotConnect(RobotError):
    """The robot is not reached."""


class InvalidToken(RobotError):
    """The robot does not know the token."""


class Problem(RobotError):
    """The robot refuses a request; `code` says why (docs/http.md)."""

    def __init__(self, code: str, detail: str) -> None:
        """Take the robot's word for programs, and its sentence for people."""
        super().__init__(detail)
        self.code, self.detail = code, detail


class BegunAfresh(RobotError):
    """The robot has begun afresh, and what the words answer is gone."""


@dataclass(frozen=True)
class Words:
    """A sentence, with what does not change when it is sent again."""

    text: str
    key: str
    """Said under one key, it is said once."""
    conversation: str
    """Whose dialogue it is."""
    seen: int | None = None
    """The latest line of the robot that the person was given."""
    person: str | None = None
    """The name of the person who speaks."""

    @property
    def body(self) -> dict[str, Any]:
        """The body of the request."""
        body = {"text": self.text, "conversation": self.conversation, "wait_s": WAIT_S}
        body |= {} if self.seen is None else {"seen": self.seen}
        return body | ({"from": self.person} if self.person else {})


@dataclass(frozen=True)
class Event:
    """An event of the robot."""

    id: str | None
    name: str
    data: dict[str, Any]


class Robot:
    """One robot, by its address and a token."""

    def __init__(self, session: aiohttp.ClientSession, url: str, token: str) -> None:
        """Ask at `url`, without `/api/v1`. With an empty token none is sent."""
        self._session, self.url = session, url.rstrip("/")
        self._headers = {"Authorization": f"Bearer {token}"} if token else {}

    async def info(self) -> dict[str, Any]:
        """Which robot this is."""
        return await self._call("GET", "info", seconds=5)

    async def state(self) -> dict[str, Any]:
        """Return the robot's state."""
        return await self._call("GET", "state", seconds=5)

    async def stop(self) -> None:
        """Stop the arm; returns once it is at rest. It is asked again while the robot's console is away."""
        until = time.monotonic() + STOP_RETRY_S
        while True:
            try:
                await self._call("POST", "motion/stop", seconds=4)
                return
            except CannotConnect:
                if time.monotonic() >= until:
                    raise
            await asyncio.sleep(PAUSE_S)

    async def resume(self, stop: int) -> None:
        """Release this stop, 0 for any. None counts within 2 s of a stop."""
        await self._call("POST", "motion/resume", seconds=8, **({"json": {"stop": stop}} if stop else {}))

    async def say(self, words: Words) -> dict[str, Any]:
        """Say a sentence once and return the reply. It is sent again, under its key, while the robot restarts."""
        until = time.monotonic() + RETRY_S
        while True:
            try:
                headers = {"Idempotency-Key": words.key}
                answer = await self._call("POST", "say", seconds=WAIT_S + 12, headers=headers, json=words.body)
                if answer["reply"]["kind"] != "pending" or time.monotonic() >= until:
                    return answer["reply"]
            except CannotConnect:
                if time.monotonic() >= until:
                    raise
            except Problem as problem:
                if problem.code not in _LATER or time.monotonic() >= until:
                    raise
            await asyncio.sleep(PAUSE_S)

    async def events(self, last: str | None) -> AsyncIterator[Event | None]:
        """Yield `None` once the stream is open, then the events after `last`, until the connection ends."""
        headers = self._headers | ({"Last-Event-ID": last} if last else {})
        timeout = aiohttp.ClientTimeout(total=None, connect=5, sock_read=SILENCE_S)
        try:
            async with self._session.get(
                f"{self.url}/api/v1/events", headers=headers, timeout=timeout, read_bufsize=_LINE_MAX
            ) as response:
                if response.status != 200:
                    raise await _problem(response)
                yield None
                async for event in _events(response.content):
                    yield event
        except (aiohttp.ClientError, TimeoutError, ValueError) as error:
            raise CannotConnect(str(error) or type(error).__name__) from error

    async def _call(self, method: str, path: str, *, seconds: float, **options: Any) -> dict[str, Any]:
        headers = self._headers | options.pop("headers", {})
        try:
            async with self._session.request(
                method,
                f"{self.url}/api/v1/{path}",
                headers=headers,
                timeout=aiohttp.ClientTimeout(total=seconds),
                **options,
            ) as response:
                if response.status >= 400:
                    raise await _problem(response)
                body = await response.json()
        except (aiohttp.ClientError, TimeoutError, ValueError) as error:
            raise CannotConnect(str(error) or type(error).__name__) from error
        if not isinstance(body, dict):
            raise CannotConnect("expected an object of JSON")
        return body


async def _problem(response: aiohttp.ClientResponse) -> RobotError:
    """Return the error that a refusal stands for."""
    if response.status == 401:
        return InvalidToken("the robot does not know the token")
    body = await response.json(content_type=None)
    if not isinstance(body, dict) or "code" not in body:
        # Something else listens there, or a proxy answers for a robot that is away.
        return CannotConnect(f"status {response.status}")
    return Problem(str(body["code"]), str(body.get("detail", "")))


async def _events(lines: AsyncIterator[bytes]) -> AsyncIterator[Event]:
    """Read server-sent events."""
    number, name, data = None, "", ""
    async for raw in lines:
        field, _, value = raw.decode().rstrip("\r\n").partition(":")
        value = value.removeprefix(" ")
        if field == "id":
            number = value
        elif field == "event":
            name = value
        elif field == "data":
            data += value
        elif not field and not value:
            if name and isinstance(content := json.loads(data or "null"), dict):
                yield Event(number, name, content)
            number, name, data = None, "", ""
