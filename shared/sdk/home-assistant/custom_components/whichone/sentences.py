"""Sentences that reach the robot whichever agent is spoken to.

Home Assistant looks for sentence triggers before its own intents and before any agent, unless an agent waits for an
answer. Without these, "never mind" during a fetch would end in Home Assistant, and the robot would go on.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from typing import Any

from homeassistant.core import CALLBACK_TYPE, HomeAssistant, callback
from homeassistant.helpers.script import ScriptRunResult
from homeassistant.helpers.trigger import async_initialize_triggers, async_validate_trigger_config
from homeassistant.util import ulid

from . import spoken
from .api import Event, RobotError, Words
from .const import DOMAIN, NEVER_MIND, STOP, STOP_THE_ROBOT
from .link import WhichoneEntry
from .whose import conversation_of

_LOGGER = logging.getLogger(__name__)

type _Action = Callable[[dict[str, Any]], Awaitable[str]]


class Sentences:
    """The sentences of one robot: some always, the others while it is busy."""

    def __init__(self, hass: HomeAssistant, entry: WhichoneEntry) -> None:
        """Begin with none attached."""
        self._hass, self._entry, self._link = hass, entry, entry.runtime_data
        self._always: CALLBACK_TYPE | None = None
        self._busy: list[CALLBACK_TYPE] = []
        self._changing = asyncio.Lock()
        self._unlisten: CALLBACK_TYPE | None = None
        self._is_ended = False

    async def begin(self) -> None:
        """Attach what is always the robot's, and follow whether it is busy."""
        self._always = await self._attach(STOP_THE_ROBOT, self._stop)
        self._unlisten = self._link.listen(self._on_event)
        await self._follow()

    @callback
    def end(self) -> None:
        """Detach everything."""
        self._is_ended = True
        for detach in (self._unlisten, self._always, *self._busy):
            if detach is not None:
                detach()
        self._unlisten, self._always, self._busy = None, None, []

    @callback
    def _on_event(self, _event: Event | None) -> None:
        if self._link.is_busy != bool(self._busy):
            self._hass.async_create_task(self._follow(), f"{DOMAIN} sentences")

    async def _follow(self) -> None:
        """Attach the sentences of a busy robot, or detach them."""
        async with self._changing:
            if self._link.is_busy and not self._busy and not self._is_ended:
                attached = [await self._attach(STOP, self._stop), await self._attach(NEVER_MIND, self._never_mind)]
                self._busy = attached
                if self._is_ended:
                    self.end()
            elif not self._link.is_busy and self._busy:
                for detach in self._busy:
                    detach()
                self._busy = []

    async def _attach(self, commands: list[str], action: _Action) -> CALLBACK_TYPE:
        async def run(variables: dict[str, Any], _context: Any = None) -> ScriptRunResult:
            text = await action(variables["trigger"])
            return ScriptRunResult(text, None, {})

        config = await async_validate_trigger_config(self._hass, [{"platform": "conversation", "command": commands}])
        detach = await async_initialize_triggers(self._hass, config, run, DOMAIN, self._entry.title, _LOGGER.log)
        return detach or (lambda: None)

    async def _stop(self, said: dict[str, Any]) -> str:
        """Stop the arm, on the stop's own path."""
        language = said["user_input"]["language"]
        try:
            await self._link.robot.stop()
        except RobotError as error:
            _LOGGER.error("the stop of %s is not confirmed: %s", self._entry.title, error)
            return await spoken.sentence(self._hass, language, "not_stopped_aloud")
        return await spoken.sentence(self._hass, language, "stopped")

    async def _never_mind(self, said: dict[str, Any]) -> str:
        """Withdraw the open request in the name of who speaks."""
        source = said["user_input"]
        conversation = conversation_of(
            source.get("satellite_id"), source.get("device_id"), source["context"].get("user_id"), None
        )
        try:
            reply = await self._link.robot.say(Words(said["sentence"], ulid.ulid_now(), conversation))
        except RobotError as error:
            return await spoken.error(self._hass, source["language"], error)
        return reply["text"]
