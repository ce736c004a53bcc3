"""The robot as a conversation agent."""

from __future__ import annotations

import logging
from collections import OrderedDict
from dataclasses import dataclass
from typing import Any, Literal

from homeassistant.components.conversation import (
    AssistantContent,
    ChatLog,
    ConversationEntity,
    ConversationInput,
    ConversationResult,
)
from homeassistant.core import HomeAssistant
from homeassistant.helpers import intent
from homeassistant.helpers.entity_platform import AddEntitiesCallback
from homeassistant.util import ulid

from . import issues, spoken
from .api import BegunAfresh, InvalidToken, Problem, RobotError, Words
from .const import CONF_NAME_PEOPLE
from .echo import is_echo
from .entity import WhichoneEntity
from .link import WhichoneEntry
from .stops import is_stop
from .whose import conversation_of, name_of

_LOGGER = logging.getLogger(__name__)

PARALLEL_UPDATES = 0  # a stop never waits for an earlier sentence

# Dialogues whose latest line is remembered.
_SHOWN_MAX = 64


@dataclass(frozen=True)
class _Shown:
    """The line that a person was given last: its number, its words if it waits for an answer, and when."""

    prompt: int
    question: str | None
    at_s: float


async def async_setup_entry(hass: HomeAssistant, entry: WhichoneEntry, add: AddEntitiesCallback) -> None:
    """Add the agent of a robot."""
    add([Agent(entry)])


class Agent(WhichoneEntity, ConversationEntity):
    """Passes sentences to the robot, and its replies back."""

    _attr_name = None

    def __init__(self, entry: WhichoneEntry) -> None:
        """Begin without an open dialogue."""
        super().__init__(entry, "robot")
        self._entry = entry
        self._shown: OrderedDict[str, _Shown] = OrderedDict()

    @property
    def available(self) -> bool:
        """Always: an agent that is unavailable ends a pipeline with an error, this one says that the robot is away."""
        return True

    @property
    def supported_languages(self) -> list[str] | Literal["*"]:
        """The language of the robot."""
        return ["en"]

    async def _async_handle_message(self, user_input: ConversationInput, chat_log: ChatLog) -> ConversationResult:
        """Say it to the robot. The microphone stays open exactly if the robot waits for an answer."""
        response = intent.IntentResponse(language=user_input.language)
        waits, stops = False, is_stop(user_input.text)
        try:
            if stops and await self._stop():
                text = await spoken.sentence(self.hass, user_input.language, "stopped")
                reply = {"kind": "stopped", "text": text, "expects_answer": False}
            else:
                reply = await self._say(user_input, chat_log.conversation_id)
            if stops and reply["kind"] != "stopped":
                raise RobotError("the robot did not take it for a stop")
        except RobotError as error:
            text = await self._on_error(error, user_input.language)
            if stops:
                _LOGGER.error("the stop of %s is not confirmed: %s", self._entry.title, error)
                text = await spoken.sentence(self.hass, user_input.language, "not_stopped_aloud")
            response.async_set_error(intent.IntentResponseErrorCode.FAILED_TO_HANDLE, text)
        else:
            text, waits = reply["text"], bool(reply["expects_answer"])
            if reply["kind"] == "pending":
                text = await spoken.sentence(self.hass, user_input.language, "no_answer")
            response.async_set_speech(text)
        chat_log.async_add_assistant_content_without_tools(AssistantContent(user_input.agent_id, text))
        return ConversationResult(response, chat_log.conversation_id, continue_conversation=waits)

    async def _stop(self) -> bool:
        """Stop the arm as the button does. A token may have the right to talk alone: then the words stop it."""
        try:
            await self.link.robot.stop()
        except Problem as problem:
            if problem.code != "right":
                raise
            return False
        self.link.nudge()
        return True

    async def _say(self, user_input: ConversationInput, conversation_id: str) -> dict[str, Any]:
        """Say it under a key of its own, and remember which line the person is given.

        A satellite that hears the question which it has just said goes on listening.
        """
        user = user_input.context.user_id
        satellite = getattr(user_input, "satellite_id", None)  # newer than Home Assistant 2025.4
        whose = conversation_of(satellite, user_input.device_id, user, conversation_id)
        shown, now_s = self._shown.get(whose), self.hass.loop.time()
        is_aloud = bool(satellite or user_input.device_id)
        if is_aloud and shown and shown.question and is_echo(user_input.text, shown.question, now_s - shown.at_s):
            return {"kind": "silent", "text": "", "expects_answer": True}
        person = await name_of(self.hass, user) if self._entry.options.get(CONF_NAME_PEOPLE) else None
        words = Words(user_input.text, ulid.ulid_now(), whose, shown.prompt if shown else None, person)
        try:
            reply = await self.link.robot.say(words)
        except Problem as problem:
            if problem.code != "invalid" or shown is None or not problem.detail.startswith("seen:"):
                raise
            # The robot begins afresh: its lines are numbered anew.
            self._shown.pop(whose, None)
            if shown.question:
                # Without its question an answer would be a request, or the answer to someone else's question.
                self.link.nudge()
                raise BegunAfresh("the question is gone") from problem
            reply = await self.link.robot.say(Words(words.text, ulid.ulid_now(), whose, None, person))
        self.link.nudge()
        issues.clear(self.hass, self._entry, issues.RIGHTS)
        if reply["prompt"]:
            question = reply["text"] if reply["expects_answer"] else None
            self._shown[whose] = _Shown(reply["prompt"], question, self.hass.loop.time())
            self._shown.move_to_end(whose)
            if len(self._shown) > _SHOWN_MAX:
                self._shown.popitem(last=False)
        return reply

    async def _on_error(self, error: RobotError, language: str) -> str:
        """Return what is said instead of a reply, and have the owner do what only the owner can do."""
        if isinstance(error, InvalidToken):
            self._entry.async_start_reauth(self.hass)
        if isinstance(error, Problem) and error.code == "right":
            issues.report(self.hass, self._entry, issues.RIGHTS, detail=error.detail)
        return await spoken.error(self.hass, language, error)
