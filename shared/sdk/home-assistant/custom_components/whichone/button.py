"""Stop and resume."""

from __future__ import annotations

from homeassistant.components.button import ButtonEntity
from homeassistant.core import HomeAssistant
from homeassistant.exceptions import HomeAssistantError
from homeassistant.helpers.entity_platform import AddEntitiesCallback

from . import spoken
from .api import Problem, RobotError
from .const import DOMAIN
from .entity import WhichoneEntity
from .link import WhichoneEntry

PARALLEL_UPDATES = 0


async def async_setup_entry(hass: HomeAssistant, entry: WhichoneEntry, add: AddEntitiesCallback) -> None:
    """Add the buttons of a robot."""
    add([Stop(entry), Resume(entry)])


class Stop(WhichoneEntity, ButtonEntity):
    """Stops the arm. Pressing it returns once the arm is at rest."""

    def __init__(self, entry: WhichoneEntry) -> None:
        """Name the button."""
        super().__init__(entry, "stop")

    @property
    def available(self) -> bool:
        """Always: a stop is tried even if the robot seems to be away."""
        return True

    async def async_press(self) -> None:
        """Stop the arm."""
        try:
            await self.link.robot.stop()
        except RobotError as error:
            raise _not_done(error, "not_stopped") from error


class Resume(WhichoneEntity, ButtonEntity):
    """Releases the stop."""

    def __init__(self, entry: WhichoneEntry) -> None:
        """Name the button."""
        super().__init__(entry, "resume")

    async def async_press(self) -> None:
        """Release the stop."""
        try:
            await self.link.robot.resume(self.link.stop)
        except RobotError as error:
            if isinstance(error, Problem) and error.code == "other_stop":
                await self.link.look_at_arm()
            raise _not_done(error, "not_resumed") from error


def _not_done(error: RobotError, key: str) -> HomeAssistantError:
    why = error.detail if isinstance(error, Problem) else str(error)
    return HomeAssistantError(
        translation_domain=DOMAIN, translation_key=key, translation_placeholders={"why": spoken.plain(why)}
    )
