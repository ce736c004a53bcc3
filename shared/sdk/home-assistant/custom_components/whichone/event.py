"""What the robot says, and how requests end, as events for automations."""

from __future__ import annotations

from typing import Any

from homeassistant.components.event import EventEntity
from homeassistant.core import HomeAssistant, callback
from homeassistant.helpers.entity_platform import AddEntitiesCallback

from .api import Event
from .entity import WhichoneEntity
from .link import WhichoneEntry

PARALLEL_UPDATES = 0

# The attributes of each event.
ATTRIBUTES = {
    "question": ("text", "options"),
    "line": ("text",),
    "ended": ("outcome", "object", "questions", "seconds"),
}


async def async_setup_entry(hass: HomeAssistant, entry: WhichoneEntry, add: AddEntitiesCallback) -> None:
    """Add the event entity of a robot."""
    add([Dialogue(entry)])


class Dialogue(WhichoneEntity, EventEntity):
    """The robot's side of the dialogue."""

    def __init__(self, entry: WhichoneEntry) -> None:
        """Name the entity."""
        super().__init__(entry, "dialogue")
        self._attr_event_types = list(ATTRIBUTES)

    @callback
    def on_event(self, event: Event | None) -> None:
        """Pass on a line of the robot, or the end of a request."""
        if event is not None and event.name in ATTRIBUTES:
            attributes: dict[str, Any] = {key: event.data.get(key) for key in ATTRIBUTES[event.name]}
            self._trigger_event(event.name, attributes)
        super().on_event(event)
