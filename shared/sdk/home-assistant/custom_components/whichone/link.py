"""The link to a robot: its state, kept by its events."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable
from typing import Any

from homeassistant.config_entries import ConfigEntry
from homeassistant.core import HomeAssistant, callback
from homeassistant.exceptions import ConfigEntryAuthFailed, ConfigEntryError

from . import issues
from .api import Event, InvalidToken, Problem, Robot, RobotError
from .const import API, ARM_LOOKS, ARM_PAUSE_S, BACKOFF_S, DOMAIN

_LOGGER = logging.getLogger(__name__)

type Listener = Callable[[Event | None], None]
type WhichoneEntry = ConfigEntry[Link]


class Mismatch(RobotError):
    """Another robot answers, or one that speaks another version; `key` is the issue that says so."""

    def __init__(self, key: str, **placeholders: str) -> None:
        """Name the issue, and what stands in its text."""
        super().__init__(key)
        self.key, self.placeholders = key, placeholders


class Link:
    """One robot, for as long as its entry is loaded."""

    def __init__(self, hass: HomeAssistant, entry: WhichoneEntry, robot: Robot) -> None:
        """Begin without knowing anything of the robot."""
        self._hass, self._entry, self.robot = hass, entry, robot
        self.info: dict[str, Any] = {}
        self.state: dict[str, Any] = {}
        self.is_connected = False
        self.reconnections = 0
        self._last: str | None = None
        self._listeners: list[Listener] = []
        self._nudged = asyncio.Event()
        # The arm moves, or has been at rest for a few looks only.
        self._may_move = False
        self._looks_at_rest = 0
        self._looking: asyncio.Task[None] | None = None

    @property
    def is_busy(self) -> bool:
        """The robot is engaged, or its arm moves nevertheless, such as home after a request."""
        return self.is_engaged or self._may_move

    @property
    def is_engaged(self) -> bool:
        """The robot talks with someone, or fetches something; without a connection, as when that ended."""
        return bool(self.state.get("interaction")) or self.state.get("state") in ("fetching", "asking")

    @callback
    def listen(self, listener: Listener) -> Callable[[], None]:
        """Call `listener` after each event, and with `None` after each change of the connection.

        Once an arm is at rest that may have moved, it is called with an event `arm`, which is not the robot's.
        """
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    @callback
    def nudge(self) -> None:
        """Connect again at once: the robot has answered a request."""
        if not self.is_connected:
            self._nudged.set()

    async def begin(self) -> None:
        """Look at the robot for the first time. One that is away is no error: the agent says so itself."""
        try:
            await self._check()
            self.state = await self.robot.state()
            self.is_connected = True
            self._may_move = self._arm_moves
        except InvalidToken as error:
            raise ConfigEntryAuthFailed(translation_domain=DOMAIN, translation_key="invalid_token") from error
        except Mismatch as error:
            issues.report(self._hass, self._entry, error.key, **error.placeholders)
            raise ConfigEntryError(translation_domain=DOMAIN, translation_key=error.key) from error
        except RobotError as error:
            self._on_error(error)
            _LOGGER.warning("%s is not reached: %s", self._entry.title, error)

    async def follow(self) -> None:
        """Take in the robot's events, through every end of a connection, until the token is refused."""
        pause = BACKOFF_S[0]
        while True:
            try:
                await self._check()
                async for event in self.robot.events(self._last):
                    pause = BACKOFF_S[0]
                    self._take(event)
                # Not a lost connection yet: a gateway ends streams after a while.
            except RobotError as error:
                self._set_connected(False)
                self._on_error(error)
                if isinstance(error, InvalidToken):
                    self._entry.async_start_reauth(self._hass)
                    return
                pause = min(2 * pause, BACKOFF_S[1])
            self._nudged.clear()
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._nudged.wait(), pause)

    async def _check(self) -> None:
        """Check that it is this robot, and that it can be talked with."""
        info = await self.robot.info()
        if info.get("api") != API:
            raise Mismatch(issues.API_VERSION, found=str(info.get("api")), expected=str(API))
        if info.get("id") != self._entry.unique_id:
            raise Mismatch(issues.OTHER_ROBOT, found=str(info.get("name")))
        self.info = info
        issues.clear(self._hass, self._entry, issues.API_VERSION, issues.OTHER_ROBOT)

    def _on_error(self, error: RobotError) -> None:
        _LOGGER.debug("%s: %s", self._entry.title, error)
        if isinstance(error, Mismatch):
            issues.report(self._hass, self._entry, error.key, **error.placeholders)
        elif isinstance(error, Problem) and error.code == "right":
            issues.report(self._hass, self._entry, issues.RIGHTS, detail=error.detail)

    @callback
    def _take(self, event: Event | None) -> None:
        if event is None:
            self._set_connected(True)
            if self._may_move:
                self._look()
            return
        self._last = event.id or self._last
        match event.name:
            case "snapshot":
                self.state = event.data
                if self._arm_moves:
                    self._look()
            case "state" | "line":
                self.state |= event.data
            case "question":
                self.state |= event.data
            case "ended":
                self.state |= {"interaction": 0, "ended": event.data}
        if event.name in ("state", "question", "line", "ended"):
            self._look()
        self._notify(event)

    @property
    def stop(self) -> int:
        """The stop in force, as far as it is known; 0 otherwise."""
        return (self.state.get("arm") or {}).get("stop", 0)

    async def look_at_arm(self) -> None:
        """Look which stop is in force: no event tells of a stop that follows another one."""
        with contextlib.suppress(RobotError):
            self.state |= {"arm": (await self.robot.state()).get("arm")}

    @property
    def _arm_moves(self) -> bool:
        return bool((self.state.get("arm") or {}).get("moving"))

    @callback
    def _look(self) -> None:
        """Take the arm for a moving one until it was seen at rest a few times."""
        self._may_move, self._looks_at_rest = True, 0
        if self._looking is None or self._looking.done():
            self._looking = self._entry.async_create_background_task(
                self._hass, self._look_until_at_rest(), f"whichone arm of {self._entry.title}"
            )

    async def _look_until_at_rest(self) -> None:
        while self._looks_at_rest < ARM_LOOKS:
            await asyncio.sleep(ARM_PAUSE_S)
            try:
                state = await self.robot.state()
            except RobotError as error:
                if isinstance(error, InvalidToken) or not self.is_connected:
                    return  # goes on with the connection
                continue
            self.state |= {"arm": state.get("arm")}
            self._looks_at_rest = 0 if self._arm_moves else self._looks_at_rest + 1
        self._may_move = False
        self._notify(Event(None, "arm", self.state["arm"] or {}))

    @callback
    def _set_connected(self, is_connected: bool) -> None:
        if is_connected == self.is_connected:
            return
        self.is_connected = is_connected
        self.reconnections += is_connected
        if is_connected:
            _LOGGER.info("%s is reached again", self._entry.title)
        else:
            _LOGGER.warning("%s is not reached", self._entry.title)
        self._notify(None)

    @callback
    def _notify(self, event: Event | None) -> None:
        for listener in list(self._listeners):
            listener(event)
