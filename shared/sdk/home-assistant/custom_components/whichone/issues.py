"""Repairs: what the owner of the robot has to do."""

from __future__ import annotations

from homeassistant.config_entries import ConfigEntry
from homeassistant.core import HomeAssistant, callback
from homeassistant.helpers import issue_registry as ir

from .const import DOMAIN

# Robot and integration speak different versions of the interface.
API_VERSION = "api_version"
# Another robot answers at the address.
OTHER_ROBOT = "other_robot"
# The token lacks a right.
RIGHTS = "rights"


@callback
def report(hass: HomeAssistant, entry: ConfigEntry, key: str, **placeholders: str) -> None:
    """Show an issue until it is cleared."""
    ir.async_create_issue(
        hass,
        DOMAIN,
        f"{key}_{entry.entry_id}",
        is_fixable=False,
        severity=ir.IssueSeverity.ERROR,
        translation_key=key,
        translation_placeholders={"name": entry.title, **placeholders},
    )


@callback
def clear(hass: HomeAssistant, entry: ConfigEntry, *keys: str) -> None:
    """Remove issues that are settled."""
    for key in keys:
        ir.async_delete_issue(hass, DOMAIN, f"{key}_{entry.entry_id}")
