"""What all entities of a robot have in common."""

from __future__ import annotations

from homeassistant.core import callback
from homeassistant.helpers.device_registry import DeviceInfo
from homeassistant.helpers.entity import Entity

from .api import Event
from .const import DOMAIN
from .link import WhichoneEntry


class WhichoneEntity(Entity):
    """An entity that follows the robot's events."""

    _attr_has_entity_name = True
    _attr_should_poll = False

    def __init__(self, entry: WhichoneEntry, key: str) -> None:
        """Name the entity of a robot."""
        self.link = entry.runtime_data
        self._attr_translation_key = key
        self._attr_unique_id = f"{entry.unique_id}_{key}"
        self._attr_device_info = DeviceInfo(
            identifiers={(DOMAIN, str(entry.unique_id))},
            name=entry.title,
            manufacturer="whichone",
            sw_version=self.link.info.get("version"),
            configuration_url=self.link.robot.url,
        )

    @property
    def available(self) -> bool:
        """Whether the robot's console is reached."""
        return self.link.is_connected

    async def async_added_to_hass(self) -> None:
        """Follow the robot."""
        await super().async_added_to_hass()
        self.async_on_remove(self.link.listen(self.on_event))

    @callback
    def on_event(self, event: Event | None) -> None:
        """Take in an event; `None` means that the connection has changed."""
        self.async_write_ha_state()
