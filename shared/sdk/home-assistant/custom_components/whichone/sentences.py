"""Sentences that reach the robots whichever agent is spoken to.

Home Assistant looks for sentence triggers before its own intents and before any agent, unless an agent waits for an
answer. Without these, "never mind" during a fetch would end in Home Assistant, and the robot would go on.

Of several triggers with one sentence Home Assistant runs all, and says what the first returns. So there is one for all
robots, which says what has become of each.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass
from typing import Any

from homeassistant.core import CALLBACK_TYPE, HomeAssistant, callback
from homeassistant.helpers.script import ScriptRunResult
from homeassistant.helpers.trigger import async_initialize_triggers, async_validate_trigger_config
from homeassistant.util import ulid
from homeassistant.util.hass_dict import HassKey

from . import spoken
from .api import Event, Problem, RobotError, Words
from .const import DOMAIN, NEVER_MIND, STOP, STOP_THE_ROBOT
from .link import WhichoneEntry
from .stops import stop
from .whose import conversation_of

_LOGGER = logging.getLogger(__name__)


@dataclass
class _Trigger:
    """Sentences with one meaning, attached while they are wanted."""

    commands: list[str]
    action: Callable[[dict[str, Any]], Awaitable[str]]
    is_wanted: Callable[[], bool]
    detach: CALLBACK_TYPE | None = None


class Sentences:
    """The sentences of all robots: some always, the others while one of them is busy."""

    def __init__(self, hass: HomeAssistant) -> None:
        """Begin without robots."""
        self._hass = hass
        self._entries: dict[str, WhichoneEntry] = {}
        self._unlisten: dict[str, CALLBACK_TYPE] = {}
        self._changing = asyncio.Lock()
        self._triggers = [
            _Trigger(STOP_THE_ROBOT, self._stop, lambda: bool(self._entries)),
            _Trigger(STOP, self._stop, lambda: any(entry.runtime_data.is_busy for entry in self._entries.values())),
            _Trigger(NEVER_MIND, self._never_mind, lambda: bool(self._engaged())),
        ]

    async def add(self, entry: WhichoneEntry) -> None:
        """Have the sentences reach a robot, and follow whether it is busy."""
        self._entries[entry.entry_id] = entry
        self._unlisten[entry.entry_id] = entry.runtime_data.listen(self._on_event)
        await self._follow()

    @callback
    def remove(self, entry: WhichoneEntry) -> None:
        """Have the sentences reach a robot no more."""
        self._entries.pop(entry.entry_id, None)
        if unlisten := self._unlisten.pop(entry.entry_id, None):
            unlisten()
        self._detach()

    def _engaged(self) -> list[WhichoneEntry]:
        return [entry for entry in self._entries.values() if entry.runtime_data.is_engaged]

    @callback
    def _on_event(self, _event: Event | None) -> None:
        if any(trigger.is_wanted() != bool(trigger.detach) for trigger in self._triggers):
            self._hass.async_create_task(self._follow(), f"{DOMAIN} sentences")

    async def _follow(self) -> None:
        """Attach the sentences that are wanted, and detach the others."""
        async with self._changing:
            for trigger in self._triggers:
                if trigger.is_wanted() and trigger.detach is None:
                    trigger.detach = await self._attach(trigger)
            # Robots have changed, or gone, in the meantime.
            self._detach()

    @callback
    def _detach(self) -> None:
        for trigger in self._triggers:
            if trigger.detach is not None and not trigger.is_wanted():
                trigger.detach()
                trigger.detach = None

    async def _attach(self, trigger: _Trigger) -> CALLBACK_TYPE:
        async def run(variables: dict[str, Any], _context: Any = None) -> ScriptRunResult:
            text = await trigger.action(variables["trigger"])
            return ScriptRunResult(text, None, {})

        wanted = [{"platform": "conversation", "command": trigger.commands}]
        config = await async_validate_trigger_config(self._hass, wanted)
        detach = await async_initialize_triggers(self._hass, config, run, DOMAIN, DOMAIN, _LOGGER.log)
        return detach or (lambda: None)

    async def _stop(self, said: dict[str, Any]) -> str:
        """Stop every arm, on the stop's own path. It is a stop only if each of them confirms it."""
        language = said["user_input"]["language"]
        entries = list(self._entries.values())
        failed = await stop(entries)
        if not failed:
            return await spoken.sentence(self._hass, language, "stopped")
        if len(entries) == 1:
            return await spoken.sentence(self._hass, language, "not_stopped_aloud")
        return await spoken.sentence(self._hass, language, "not_stopped_names", names=_names(failed))

    async def _never_mind(self, said: dict[str, Any]) -> str:
        """Withdraw the open request in the name of who speaks, whichever robot has it."""
        source = said["user_input"]
        language = source["language"]
        conversation = conversation_of(
            source.get("satellite_id"), source.get("device_id"), source["context"].get("user_id"), None
        )

        async def withdraw(entry: WhichoneEntry) -> str | RobotError:
            try:
                reply = await entry.runtime_data.robot.say(Words(said["sentence"], ulid.ulid_now(), conversation))
            except RobotError as error:
                return error
            return RobotError("no answer yet") if reply["kind"] == "pending" else reply["text"]

        entries = self._engaged() or list(self._entries.values())
        answers = dict(zip(entries, await asyncio.gather(*map(withdraw, entries)), strict=True))
        texts = list(dict.fromkeys(answer for answer in answers.values() if isinstance(answer, str)))
        failed = {entry: answer for entry, answer in answers.items() if isinstance(answer, RobotError)}
        # A robot that talks with someone else has no request of who speaks.
        others = {entry: error for entry, error in failed.items() if _is_busy(error)}
        if len(others) < len(entries):
            failed = {entry: error for entry, error in failed.items() if entry not in others}
        if len(entries) == 1 or len(others) == len(entries):
            texts += [await spoken.error(self._hass, language, error) for error in list(failed.values())[:1]]
        elif failed:
            texts.append(await spoken.sentence(self._hass, language, "not_withdrawn_names", names=_names(failed)))
        return " ".join(filter(None, texts))


def _is_busy(error: RobotError) -> bool:
    return isinstance(error, Problem) and error.code == "busy"


def _names(entries: Iterable[WhichoneEntry]) -> str:
    return ", ".join(entry.title for entry in entries)


SENTENCES: HassKey[Sentences] = HassKey(DOMAIN)
