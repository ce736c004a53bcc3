"""Diagnostics: neither secrets, nor what was said, nor names of people, addresses and things."""

from __future__ import annotations

from typing import Any

from homeassistant.core import HomeAssistant

from .link import WhichoneEntry

_INFO = ("api", "version", "online")
_STATE = ("state", "interaction", "utterance", "prompt", "expects_answer", "questions")
_ARM = ("phase", "moving", "stopped", "remaining_s")


async def async_get_config_entry_diagnostics(hass: HomeAssistant, entry: WhichoneEntry) -> dict[str, Any]:
    """Return what helps to find a fault of the connection."""
    link = entry.runtime_data
    arm = link.state.get("arm") or {}
    return {
        "is_https": entry.data["url"].startswith("https:"),
        "options": dict(entry.options),
        "is_connected": link.is_connected,
        "reconnections": link.reconnections,
        "info": {key: link.info.get(key) for key in _INFO},
        "state": {key: link.state.get(key) for key in _STATE},
        "arm": {key: arm.get(key) for key in _ARM},
        "objects": len(link.state.get("belief") or {}),
    }
