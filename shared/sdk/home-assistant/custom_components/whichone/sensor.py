"""What the robot is doing."""

from __future__ import annotations

from typing import Any

from homeassistant.components.sensor import SensorDeviceClass, SensorEntity
from homeassistant.core import HomeAssistant
from homeassistant.helpers.entity_platform import AddEntitiesCallback

from .const import STATES
from .entity import WhichoneEntity
from .link import WhichoneEntry

PARALLEL_UPDATES = 0


async def async_setup_entry(hass: HomeAssistant, entry: WhichoneEntry, add: AddEntitiesCallback) -> None:
    """Add the sensor of a robot."""
    add([Activity(entry)])


class Activity(WhichoneEntity, SensorEntity):
    """The robot in a word."""

    _attr_device_class = SensorDeviceClass.ENUM
    _attr_options = STATES

    def __init__(self, entry: WhichoneEntry) -> None:
        """Name the sensor."""
        super().__init__(entry, "activity")

    @property
    def native_value(self) -> str | None:
        """The activity; none before the robot was reached."""
        state = self.link.state.get("state")
        return state if state in STATES else None

    @property
    def extra_state_attributes(self) -> dict[str, Any]:
        """Why it is disconnected or held."""
        return {"why": self.link.state.get("why")}
