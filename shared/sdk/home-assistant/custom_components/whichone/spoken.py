"""Sentences of the integration, in the language of the person who is spoken to."""

from __future__ import annotations

from homeassistant.core import HomeAssistant
from homeassistant.helpers.translation import async_get_translations

from .api import BegunAfresh, CannotConnect, InvalidToken, Problem, RobotError
from .const import DOMAIN

# What is said for a refusal of the robot; its own sentence for those that are not listed.
_SAID = {
    "busy": "busy",
    "right": "missing_right",
    "not_accepted": "no_answer",
    "unavailable": "unavailable",
    "too_many": "unavailable",
    "not_confirmed": "not_stopped_aloud",
}


async def sentence(hass: HomeAssistant, language: str, key: str, **placeholders: str) -> str:
    """Return a sentence: in English if it is not translated."""
    path = f"component.{DOMAIN}.exceptions.{key}.message"
    for choice in (language, "en"):
        texts = await async_get_translations(hass, choice, "exceptions", [DOMAIN])
        if path in texts:
            text = texts[path]
            for name, value in placeholders.items():
                text = text.replace(f"{{{name}}}", value)
            return text
    return key


async def error(hass: HomeAssistant, language: str, failure: RobotError) -> str:
    """Return what is said when a request has failed."""
    match failure:
        case InvalidToken():
            key = "invalid_token"
        case BegunAfresh():
            key = "begun_afresh"
        case Problem() if failure.code in _SAID:
            key = _SAID[failure.code]
        case Problem():
            return plain(failure.detail)
        case CannotConnect():
            key = "cannot_connect"
        case _:
            key = "no_answer"
    return await sentence(hass, language, key)


def plain(detail: str) -> str:
    """Return a sentence without the help for programmers behind it."""
    return detail.partition("; help:")[0]
