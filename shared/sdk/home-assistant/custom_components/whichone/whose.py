"""Whose dialogue a sentence belongs to, and who speaks."""

from __future__ import annotations

from homeassistant.core import HomeAssistant

# Longest name of a person, bytes (docs/people.md).
_NAME_MAX = 64


def conversation_of(satellite: str | None, device: str | None, user: str | None, conversation: str | None) -> str:
    """Return the name of a dialogue.

    Home Assistant's own conversation ends with the microphone, and the robot's dialogue goes on after the next wake
    word: so it is the satellite's, else the device's, else the user's.
    """
    name = satellite or device or user or conversation
    return f"home-assistant {name}"[:200] if name else "home-assistant"


async def name_of(hass: HomeAssistant, user: str | None) -> str | None:
    """Return the name of a user as the robot takes it, `None` for nobody in particular."""
    known = await hass.auth.async_get_user(user) if user else None
    if known is None or not known.name or known.system_generated:
        return None
    printable = "".join(letter for letter in known.name if letter.isprintable())
    return printable.encode()[:_NAME_MAX].decode(errors="ignore").strip() or None
