"""whichone: a robot that asks which one you mean before it fetches it."""

from __future__ import annotations

from homeassistant.const import CONF_TOKEN, CONF_URL, Platform
from homeassistant.core import HomeAssistant
from homeassistant.helpers.aiohttp_client import async_get_clientsession

from . import issues
from .api import Robot
from .link import Link, WhichoneEntry
from .sentences import SENTENCES, Sentences

PLATFORMS = [Platform.BUTTON, Platform.CONVERSATION, Platform.EVENT, Platform.SENSOR]


async def async_setup_entry(hass: HomeAssistant, entry: WhichoneEntry) -> bool:
    """Set up a robot. One that is away is set up as well: its agent says that it is away."""
    robot = Robot(async_get_clientsession(hass), entry.data[CONF_URL], entry.data[CONF_TOKEN])
    entry.runtime_data = link = Link(hass, entry, robot)
    await link.begin()
    await hass.config_entries.async_forward_entry_setups(entry, PLATFORMS)
    sentences = hass.data.setdefault(SENTENCES, Sentences(hass))
    entry.async_on_unload(lambda: sentences.remove(entry))
    await sentences.add(entry)
    entry.async_create_background_task(hass, link.follow(), f"whichone events of {entry.title}")
    return True


async def async_unload_entry(hass: HomeAssistant, entry: WhichoneEntry) -> bool:
    """Unload a robot."""
    return await hass.config_entries.async_unload_platforms(entry, PLATFORMS)


async def async_remove_entry(hass: HomeAssistant, entry: WhichoneEntry) -> None:
    """Remove what is said about a robot that is gone."""
    issues.clear(hass, entry, issues.API_VERSION, issues.OTHER_ROBOT, issues.RIGHTS)
