"""Setting up a robot, and changing how it is reached."""

import json
from ipaddress import ip_address
from pathlib import Path

import pytest
from homeassistant.config_entries import SOURCE_IGNORE, SOURCE_USER, SOURCE_ZEROCONF, ConfigEntryState
from homeassistant.data_entry_flow import FlowResultType
from homeassistant.helpers.service_info.zeroconf import ZeroconfServiceInfo
from pytest_homeassistant_custom_component.common import MockConfigEntry

from conftest import connected, until
from custom_components.whichone.config_flow import announced_url, robot_url
from custom_components.whichone.const import CONF_NAME_PEOPLE
from fake_robot import ID, TOKEN, Fake
from talk import say, spoken

HERE = Path(__file__).parent
COMPONENT = HERE.parent / "custom_components/whichone"


async def begin(hass, source=SOURCE_USER):
    """Open the form for a new robot."""
    return await hass.config_entries.flow.async_init("whichone", context={"source": source})


async def fill(hass, flow, url, token):
    """Fill in the form."""
    return await hass.config_entries.flow.async_configure(flow["flow_id"], {"url": url, "token": token})


async def test_user_sets_up_a_robot_through_every_mistake(core, fake):
    flow = await begin(core)
    for url, token, key, error in [
        ("robot.local", TOKEN, "url", "invalid_url"),
        ("http://127.0.0.1:1", TOKEN, "base", "cannot_connect"),
        (fake.url, "wrong", "token", "invalid_token"),
    ]:
        flow = await fill(core, flow, url, token)
        assert flow["errors"] == {key: error}
    fake.answers["state"] = "right"
    flow = await fill(core, flow, fake.url, TOKEN)
    assert flow["errors"] == {"base": "missing_right"}
    fake.answers["state"] = "state_idle"
    fake.info = {"api": 2}
    flow = await fill(core, flow, fake.url, TOKEN)
    assert flow["errors"] == {"base": "api_version"}
    fake.info = {}
    done = await fill(core, flow, f"{fake.url}/?token=of-the-page", f" {TOKEN}\n")
    assert done["type"] is FlowResultType.CREATE_ENTRY
    assert done["data"] == {"url": fake.url, "token": TOKEN}
    assert done["result"].unique_id == ID
    again = await fill(core, await begin(core), fake.url, TOKEN)
    assert again["reason"] == "already_configured"
    await core.config_entries.async_unload(done["result"].entry_id)


def announced(port, **changed):
    """Return what a robot announces in its network."""
    address = ip_address("127.0.0.1")
    return ZeroconfServiceInfo(
        ip_address=address,
        ip_addresses=[address],
        port=port,
        hostname="robot.local.",
        type="_whichone._tcp.local.",
        name="robot._whichone._tcp.local.",
        properties={"api": "1", "id": ID, "name": "kitchen", "scheme": "http", "path": "/api/v1"} | changed,
    )


async def find(hass, found):
    """Have Home Assistant find a robot."""
    return await hass.config_entries.flow.async_init("whichone", context={"source": SOURCE_ZEROCONF}, data=found)


async def answer(hass, flow, **fields):
    """Fill in a form of other fields."""
    return await hass.config_entries.flow.async_configure(flow["flow_id"], fields)


async def test_robot_that_is_found_is_set_up_with_its_token(core, fake):
    flow = await find(core, announced(fake.port))
    assert flow["description_placeholders"] == {"name": "kitchen", "url": fake.url}
    assert [str(field) for field in flow["data_schema"].schema] == ["token"]
    flow = await answer(core, flow, token="wrong")
    assert flow["errors"] == {"token": "invalid_token"}
    assert (await find(core, announced(fake.port)))["reason"] == "already_in_progress"
    done = await answer(core, flow, token=TOKEN)
    assert done["type"] is FlowResultType.CREATE_ENTRY
    assert done["data"] == {"url": fake.url, "token": TOKEN}
    assert done["result"].unique_id == ID
    wrong, right = (f"Bearer {token}" for token in ("wrong", TOKEN))
    assert fake.authorizations[:6] == [None, wrong, wrong, None, right, right]
    await core.async_block_till_done()
    assert (await find(core, announced(fake.port)))["reason"] == "already_configured"
    await core.config_entries.async_unload(done["result"].entry_id)


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"api": "2"}, "api_version"),
        ({"id": ""}, "invalid_announcement"),
        ({"id": None}, "invalid_announcement"),
        ({"id": "i" * 65}, "invalid_announcement"),
        ({"id": "two words"}, "invalid_announcement"),
        ({"name": None}, "invalid_announcement"),
        ({"name": "kitchen\n"}, "invalid_announcement"),
        ({"name": "n" * 33}, "invalid_announcement"),
        ({"name": "-kitchen"}, "invalid_announcement"),
        ({"name": "[click](http://evil)"}, "invalid_announcement"),
        ({"scheme": "ftp"}, "invalid_announcement"),
        ({"path": "elsewhere"}, "invalid_announcement"),
    ],
)
async def test_announcement_of_something_else_is_not_offered(core, changed, reason):
    assert (await find(core, announced(8377, **changed)))["reason"] == reason


async def test_robot_that_has_moved_is_followed_once_its_owner_agrees(core, fake, entry):
    moved = Fake()
    await moved.start()
    # Who announces a robot that still answers does not get its token.
    assert (await find(core, announced(moved.port)))["reason"] == "already_configured"
    await fake.end()
    flow = await find(core, announced(moved.port))
    assert (flow["step_id"], flow["data_schema"].schema) == ("moved", {})
    assert flow["description_placeholders"] == {"name": "robot", "url": moved.url, "former": fake.url}
    assert (entry.data["url"], moved.asked) == (fake.url, [])
    moved.answers["state"] = "right"
    flow = await answer(core, flow)
    assert flow["errors"] == {"base": "missing_right"}
    moved.answers["state"] = "state_idle"
    done = await answer(core, flow)
    assert done["reason"] == "reconfigure_successful"
    await core.async_block_till_done()
    assert entry.data == {"url": moved.url, "token": TOKEN}
    await until(lambda: moved.resumed_after)
    await core.config_entries.async_unload(entry.entry_id)
    await moved.end()


async def test_another_robot_at_the_announced_address_is_not_followed(core, fake, entry):
    other = Fake()
    other.info = {"id": "another"}
    await other.start()
    await fake.end()
    flow = await find(core, announced(other.port))
    assert (await answer(core, flow))["reason"] == "other_robot"
    assert entry.data["url"] == fake.url
    assert (other.asked, other.authorizations) == (["info"], [None])
    await other.end()


async def test_robot_that_is_back_before_its_owner_agrees_is_not_followed(core, fake, entry):
    impostor = Fake()
    await impostor.start()
    await fake.end()
    flow = await find(core, announced(impostor.port))
    assert flow["step_id"] == "moved"
    await fake.start()
    assert (await answer(core, flow))["reason"] == "already_configured"
    assert (entry.data["url"], impostor.asked) == (fake.url, [])
    await impostor.end()


async def test_robot_behind_a_gateway_is_not_followed(core, fake, entry):
    # A gateway names no robot to strangers.
    fake.answers["info"] = "no_token"
    assert (await find(core, announced(1)))["reason"] == "already_configured"


async def test_another_robot_at_the_address_that_was_found_gets_no_token(core, fake):
    flow = await find(core, announced(fake.port))
    fake.info = {"id": "another"}
    assert (await answer(core, flow, token=TOKEN))["reason"] == "other_robot"
    assert (fake.asked, fake.authorizations) == (["info"], [None])


async def test_robot_that_is_ignored_stays_ignored(core, fake):
    MockConfigEntry(domain="whichone", unique_id=ID, source=SOURCE_IGNORE, data={}).add_to_hass(core)
    assert (await find(core, announced(fake.port)))["reason"] == "already_configured"


async def test_refused_token_asks_for_another_one(core, fake, entry):
    fake.token = "another-token-0123456789"
    await fake.drop()
    await until(lambda: core.config_entries.flow.async_progress())
    (flow,) = core.config_entries.flow.async_progress()
    assert flow["context"]["source"] == "reauth"
    assert spoken(await say(core, "get me the bowl")) == "The robot refuses my token."
    wrong = await core.config_entries.flow.async_configure(flow["flow_id"], {"token": "wrong"})
    assert wrong["errors"] == {"token": "invalid_token"}
    done = await core.config_entries.flow.async_configure(flow["flow_id"], {"token": fake.token})
    assert done["reason"] == "reauth_successful"
    await core.async_block_till_done()
    assert entry.data["token"] == fake.token
    assert entry.state is ConfigEntryState.LOADED


async def test_address_changes_and_the_robot_stays_the_same(core, fake, entry):
    flow = await entry.start_reconfigure_flow(core)
    fake.info = {"id": "another"}
    other = await fill(core, flow, fake.url, TOKEN)
    assert other["reason"] == "other_robot"
    fake.info = {}
    moved = Fake()
    await moved.start()
    done = await fill(core, await entry.start_reconfigure_flow(core), f"{moved.url}/api/v1/", TOKEN)
    assert done["reason"] == "reconfigure_successful"
    await core.async_block_till_done()
    assert entry.data["url"] == moved.url
    await until(lambda: moved.resumed_after)
    await core.config_entries.async_unload(entry.entry_id)
    await moved.end()


async def test_options(core, fake, entry):
    flow = await core.config_entries.options.async_init(entry.entry_id)
    await core.config_entries.options.async_configure(flow["flow_id"], {CONF_NAME_PEOPLE: True})
    await core.async_block_till_done()
    assert entry.options == {CONF_NAME_PEOPLE: True}
    assert entry.state is ConfigEntryState.LOADED


async def test_robot_that_is_away_at_the_start_is_set_up(core, fake):
    await fake.end()
    entry = await connected(core, fake.url, TOKEN, ID)
    assert entry.state is ConfigEntryState.LOADED
    fake.script = ["question"]
    await fake.start()
    assert (await say(core, "get me the bowl")).continue_conversation
    await until(lambda: core.states.get("sensor.robot_activity").state == "idle")
    await core.config_entries.async_unload(entry.entry_id)


@pytest.mark.parametrize(
    ("token", "info", "state"),
    [
        ("wrong", {}, ConfigEntryState.SETUP_ERROR),
        (TOKEN, {"api": 2}, ConfigEntryState.SETUP_ERROR),
        (TOKEN, {"id": "another"}, ConfigEntryState.SETUP_ERROR),
    ],
)
async def test_robot_that_is_not_this_one_is_not_set_up(core, fake, token, info, state):
    fake.info = info
    entry = MockConfigEntry(domain="whichone", unique_id=ID, title="robot", data={"url": fake.url, "token": token})
    entry.add_to_hass(core)
    assert not await core.config_entries.async_setup(entry.entry_id)
    assert entry.state is state


@pytest.mark.parametrize(
    ("text", "url"),
    [
        ("http://robot.local:8377", "http://robot.local:8377"),
        (" http://127.0.0.1:8377/?token=secret ", "http://127.0.0.1:8377"),
        ("https://house.example/robots/ann/", "https://house.example/robots/ann"),
        ("https://house.example/ann/api/v1/", "https://house.example/ann"),
        ("http://[fd00::1]:8377/#history", "http://[fd00::1]:8377"),
        ("robot.local:8377", None),
        ("ftp://robot", None),
        ("http://", None),
        ("http://robot:port", None),
    ],
)
def test_addresses(text, url):
    assert robot_url(text) == url


@pytest.mark.parametrize(
    ("changed", "url"),
    [
        ({}, "http://127.0.0.1:8377"),
        ({"scheme": None, "path": None}, "http://127.0.0.1:8377"),
        ({"scheme": "https", "path": "/ann/api/v1"}, "https://robot.local:8377/ann"),
    ],
)
def test_announced_addresses(changed, url):
    assert announced_url(announced(8377, **changed)) == url


def keys(value, path=""):
    """Return every key of a text, with the places where something is inserted."""
    if isinstance(value, str):
        holes = sorted(part.partition("}")[0] for part in value.split("{")[1:])
        return {f"{path}: {holes}"}
    return {key for name, part in value.items() for key in keys(part, f"{path}.{name}")}


def test_translations_are_complete_and_nothing_unknown_is_said():
    texts = {path.stem: json.loads(path.read_text()) for path in (COMPONENT / "translations").iterdir()}
    assert set(texts) == {"en", "de"}
    assert keys(texts["en"]) == keys(texts["de"])
    source = "".join(path.read_text() for path in COMPONENT.glob("*.py"))
    for group in ("exceptions", "issues"):
        for key in texts["en"][group]:
            assert f'"{key}"' in source, key


def test_manifest_is_in_order_and_of_the_products_version():
    manifest = json.loads((COMPONENT / "manifest.json").read_text())
    names = list(manifest)
    assert names == ["domain", "name", *sorted(names[2:])]
    workspace = HERE.parents[3] / "Cargo.toml"
    version = next(line for line in workspace.read_text().splitlines() if line.startswith("version ="))
    assert version == f'version = "{manifest["version"]}"'
