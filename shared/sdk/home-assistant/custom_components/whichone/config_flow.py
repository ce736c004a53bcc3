"""Setting up a robot."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import voluptuous as vol
from homeassistant.config_entries import ConfigEntry, ConfigFlow, ConfigFlowResult, OptionsFlow
from homeassistant.const import CONF_TOKEN, CONF_URL
from homeassistant.core import callback
from homeassistant.data_entry_flow import AbortFlow
from homeassistant.helpers.aiohttp_client import async_get_clientsession
from homeassistant.helpers.selector import (
    BooleanSelector,
    TextSelector,
    TextSelectorConfig,
    TextSelectorType,
)
from homeassistant.helpers.service_info.zeroconf import ZeroconfServiceInfo
from yarl import URL

from .api import CannotConnect, InvalidToken, Problem, Robot, RobotError
from .const import API, CONF_NAME_PEOPLE, DOMAIN

_PLAIN = TextSelector(TextSelectorConfig(type=TextSelectorType.URL))
_SECRET = TextSelector(TextSelectorConfig(type=TextSelectorType.PASSWORD))
_TOKEN = {vol.Required(CONF_TOKEN): _SECRET}
# What robots are called. Anyone in the network writes announcements, and their words are shown.
_FORMS = {"name": re.compile(r"[a-z0-9][a-z0-9-]{0,31}"), "id": re.compile(r"[A-Za-z0-9_-]{1,64}")}


class WhichoneFlow(ConfigFlow, domain=DOMAIN):
    """Asks for the robot's address and a token, and tries them."""

    VERSION = 1

    def __init__(self) -> None:
        """Begin with nothing found."""
        self._url = ""
        self._moved: ConfigEntry | None = None

    @staticmethod
    @callback
    def async_get_options_flow(config_entry: ConfigEntry) -> OptionsFlow:
        """Return the flow of the options."""
        return WhichoneOptions()

    async def async_step_user(self, user_input: dict[str, Any] | None = None) -> ConfigFlowResult:
        """Set up a robot by its address."""
        errors: dict[str, str] = {}
        if user_input is not None:
            data, info, errors = await self._try(user_input)
            if not errors:
                await self.async_set_unique_id(info["id"], raise_on_progress=False)
                self._abort_if_unique_id_configured(updates=data)
                return self.async_create_entry(title=info["name"], data=data)
        return self._form("user", user_input, errors)

    async def async_step_zeroconf(self, discovery_info: ZeroconfServiceInfo) -> ConfigFlowResult:
        """Take the address of a robot that announces itself."""
        found, url = discovery_info.properties, announced_url(discovery_info)
        if url is None or not all(form.fullmatch(found.get(key) or "") for key, form in _FORMS.items()):
            return self.async_abort(reason="invalid_announcement")
        if found.get("api") != str(API):
            return self.async_abort(reason="api_version")
        self._url = url
        entry = await self.async_set_unique_id(found["id"])
        self.context["title_placeholders"] = {"name": entry.title if entry else found["name"]}
        if entry and await self._is_gone(entry):
            self._moved = entry
            return await self.async_step_moved()
        self._abort_if_unique_id_configured()
        return await self.async_step_zeroconf_confirm()

    async def async_step_zeroconf_confirm(self, user_input: dict[str, Any] | None = None) -> ConfigFlowResult:
        """Set up a robot that was found, with its token."""
        errors: dict[str, str] = {}
        if user_input is not None:
            data, info, errors = await self._try({CONF_URL: self._url, **user_input}, self.unique_id)
            if not errors:
                self._abort_if_unique_id_configured()
                return self.async_create_entry(title=info["name"], data=data)
        return self._ask("zeroconf_confirm", _TOKEN, errors, url=self._url)

    async def async_step_moved(self, user_input: dict[str, Any] | None = None) -> ConfigFlowResult:
        """Change the address of a robot that is announced at another one, if its owner agrees.

        It is not changed without being asked: anyone in the network can announce the robot, and would get the token.
        """
        entry, errors = self._moved, {}
        if user_input is not None:
            # The form may be old.
            if not await self._is_gone(entry):
                return self.async_abort(reason="already_configured")
            data, _, errors = await self._try({**entry.data, CONF_URL: self._url}, entry.unique_id)
            if not errors:
                return self.async_update_reload_and_abort(entry, data_updates=data, reason="reconfigure_successful")
        # A form without fields shows an error only as a whole.
        errors = dict(zip(["base"], errors.values(), strict=False))
        return self._ask("moved", {}, errors, url=self._url, former=entry.data[CONF_URL])

    async def async_step_reconfigure(self, user_input: dict[str, Any] | None = None) -> ConfigFlowResult:
        """Change the address or the token of a robot."""
        entry, errors = self._get_reconfigure_entry(), {}
        if user_input is not None:
            data, info, errors = await self._try(user_input)
            if not errors:
                await self.async_set_unique_id(info["id"])
                self._abort_if_unique_id_mismatch(reason="other_robot")
                return self.async_update_reload_and_abort(entry, data_updates=data)
        return self._form("reconfigure", user_input or {CONF_URL: entry.data[CONF_URL]}, errors)

    async def async_step_reauth(self, entry_data: Mapping[str, Any]) -> ConfigFlowResult:
        """Ask for another token: the robot refuses the one that is stored."""
        return await self.async_step_reauth_confirm()

    async def async_step_reauth_confirm(self, user_input: dict[str, Any] | None = None) -> ConfigFlowResult:
        """Try the other token."""
        entry, errors = self._get_reauth_entry(), {}
        if user_input is not None:
            data, info, errors = await self._try({**entry.data, **user_input})
            if not errors:
                await self.async_set_unique_id(info["id"])
                self._abort_if_unique_id_mismatch(reason="other_robot")
                return self.async_update_reload_and_abort(entry, data_updates=data)
        return self._ask("reauth_confirm", _TOKEN, errors)

    def _form(self, step: str, given: dict[str, Any] | None, errors: dict[str, str]) -> ConfigFlowResult:
        url = (given or {}).get(CONF_URL) or self._url
        fields = {vol.Required(CONF_URL, default=url or vol.UNDEFINED): _PLAIN} | _TOKEN
        return self.async_show_form(step_id=step, errors=errors, data_schema=vol.Schema(fields))

    def _ask(self, step: str, fields: dict[Any, Any], errors: dict[str, str], **placeholders: str) -> ConfigFlowResult:
        """Show a form whose text names the robot."""
        names = {**self.context["title_placeholders"], **placeholders}
        return self.async_show_form(
            step_id=step, errors=errors, data_schema=vol.Schema(fields), description_placeholders=names
        )

    async def _is_gone(self, entry: ConfigEntry) -> bool:
        """Return whether a robot that is set up does not answer at its address, which is not the found one."""
        url = entry.data.get(CONF_URL, self._url)
        if url == self._url:
            return False
        try:
            return await self._id_at(url) != entry.unique_id
        except InvalidToken:
            # A gateway, which names its robots to nobody without a secret.
            return False
        except RobotError:
            return True

    async def _id_at(self, url: str) -> str | None:
        """Return the id of the robot at an address, which is public: what answers there does not get the token."""
        info = await Robot(async_get_clientsession(self.hass), url, "").info()
        return info.get("id")

    async def _try(
        self, given: Mapping[str, Any], found: str | None = None
    ) -> tuple[dict[str, Any], dict[str, Any], dict[str, str]]:
        """Return what is to be stored, which robot it is, and what is wrong with it.

        Of a robot that announces itself, `found` is the id: a robot with another one does not get the token.
        """
        url = robot_url(given[CONF_URL])
        if url is None:
            return {}, {}, {CONF_URL: "invalid_url"}
        data = {CONF_URL: url, CONF_TOKEN: given[CONF_TOKEN].strip()}
        robot = Robot(async_get_clientsession(self.hass), url, data[CONF_TOKEN])
        try:
            if found and await self._id_at(url) != found:
                raise AbortFlow("other_robot")
            info = await robot.info()
            if info.get("api") != API or not info.get("id"):
                return data, info, {"base": "api_version"}
            await robot.state()
        except InvalidToken:
            return data, {}, {CONF_TOKEN: "invalid_token"}
        except Problem as problem:
            return data, {}, {"base": "missing_right" if problem.code == "right" else "cannot_connect"}
        except CannotConnect:
            return data, {}, {"base": "cannot_connect"}
        return data, info, {}


class WhichoneOptions(OptionsFlow):
    """Asks what the robot is told about people."""

    async def async_step_init(self, user_input: dict[str, Any] | None = None) -> ConfigFlowResult:
        """Ask for the options."""
        if user_input is not None:
            return self.async_create_entry(data=user_input)
        names = self.config_entry.options.get(CONF_NAME_PEOPLE, False)
        fields = {vol.Required(CONF_NAME_PEOPLE, default=names): BooleanSelector()}
        return self.async_show_form(step_id="init", data_schema=vol.Schema(fields))


def announced_url(found: ZeroconfServiceInfo) -> str | None:
    """Return the address in an announcement, `None` if there is none."""
    scheme, path = (found.properties.get(key) or "" for key in ("scheme", "path"))
    # Certificates are of names.
    host = found.hostname.rstrip(".") if scheme == "https" else found.host
    try:
        return robot_url(str(URL.build(scheme=scheme or "http", host=host, port=found.port, path=path)))
    except (TypeError, ValueError):
        return None


def robot_url(text: str) -> str | None:
    """Return an address without what `whichone console` adds to it, `None` if it is not one."""
    try:
        url = URL(text.strip())
    except ValueError:
        return None
    if url.scheme not in ("http", "https") or not url.host:
        return None
    path = url.path.rstrip("/").removesuffix("/api/v1")
    return str(url.with_query(None).with_fragment(None).with_path(path)).rstrip("/")
