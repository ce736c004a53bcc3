"""Buttons, sensor, event, and the stream that feeds them."""

import json

import aiohttp
import pytest
from homeassistant.exceptions import HomeAssistantError
from homeassistant.helpers import device_registry as dr
from homeassistant.helpers import issue_registry as ir

from conftest import until
from custom_components.whichone import api
from custom_components.whichone.diagnostics import async_get_config_entry_diagnostics
from fake_robot import ANSWERS, EVENTS, ID, TOKEN, Fake
from talk import entity, say


def state(hass, key):
    """Return the state of an entity of the robot."""
    return hass.states.get(entity(hass, key))


async def press(hass, key):
    """Press a button."""
    await hass.services.async_call("button", "press", {"entity_id": entity(hass, key)}, blocking=True)


def of(name):
    """Return the data of the first recorded event of a name."""
    return next(event["data"] for event in EVENTS if event["event"] == name)


async def test_resume_is_of_the_stop_that_was_shown(core, fake, entry):
    link = entry.runtime_data
    await press(core, "resume")
    assert fake.bodies["motion/resume"] == "", "no stop is known: any"
    link.state |= {"arm": {"stop": 7}}
    await press(core, "resume")
    assert json.loads(fake.bodies["motion/resume"]) == {"stop": 7}
    fake.answers["motion/resume"], fake.arm_stop = "other_stop", 8
    with pytest.raises(HomeAssistantError):
        await press(core, "resume")
    fake.answers["motion/resume"] = "resumed"
    await press(core, "resume")
    assert json.loads(fake.bodies["motion/resume"]) == {"stop": 8}, "the user has been told of it"


async def test_stop_and_resume(core, fake, entry):
    await press(core, "stop")
    await press(core, "resume")
    assert fake.asked[-2:] == ["motion/stop", "motion/resume"]
    fake.answers["motion/resume"] = "too_soon"
    with pytest.raises(HomeAssistantError) as error:
        await press(core, "resume")
    assert error.value.translation_key == "not_resumed"
    devices = dr.async_entries_for_config_entry(dr.async_get(core), entry.entry_id)
    assert [device.sw_version for device in devices] == [ANSWERS["info"]["body"]["version"]]


async def test_activity_and_dialogue_follow_the_events(core, fake, entry):
    assert state(core, "activity").state == "idle"
    await fake.publish("question")
    await until(lambda: state(core, "activity").state == "asking")
    await until(lambda: state(core, "dialogue").attributes.get("event_type") == "question")
    assert state(core, "dialogue").attributes["options"] == of("question")["options"]
    await fake.publish("ended")
    await until(lambda: state(core, "dialogue").attributes.get("event_type") == "ended")
    attributes = state(core, "dialogue").attributes
    assert (attributes["object"], attributes["outcome"]) == ("clear", "delivered")


async def test_events_go_on_where_they_ended(core, fake, entry):
    await fake.publish("question")
    await until(lambda: state(core, "activity").state == "asking")
    seen = []
    stop = entry.runtime_data.listen(seen.append)
    await fake.drop()
    await fake.publish("ended")
    await until(lambda: len(fake.resumed_after) > 1)
    await until(lambda: state(core, "dialogue").attributes.get("event_type") == "ended")
    assert fake.resumed_after[0] is None
    assert fake.resumed_after[1] == "fake-2"
    await until(lambda: not entry.runtime_data.is_busy)
    # The end of a stream is no outage, such as a gateway's after a minute.
    assert None not in seen
    stop()


async def test_robot_that_is_away_is_unavailable_but_for_agent_and_stop(core, fake, entry, monkeypatch):
    monkeypatch.setattr(api, "STOP_RETRY_S", 0.2)
    await fake.end()
    await until(lambda: state(core, "activity").state == "unavailable")
    states = {key: state(core, key).state for key in ("robot", "stop", "resume", "dialogue")}
    away = {key for key, word in states.items() if word == "unavailable"}
    assert away == {"resume", "dialogue"}
    with pytest.raises(HomeAssistantError) as error:
        await press(core, "stop")
    assert error.value.translation_key == "not_stopped"
    await fake.start()
    await until(lambda: state(core, "activity").state == "idle", 30)


async def test_stop_waits_for_a_console_that_restarts(core, fake, entry):
    await fake.end()
    pressed = core.async_create_task(press(core, "stop"))
    await until(lambda: state(core, "activity").state == "unavailable")
    await fake.start()
    await pressed
    assert "motion/stop" in fake.asked


async def test_every_activity_is_known(core, fake, entry):
    recorded = {answer["body"]["state"] for name, answer in ANSWERS.items() if name.startswith("state_")}
    assert recorded <= set(state(core, "activity").attributes["options"])
    assert recorded == {"idle", "asking", "fetching", "stopped", "held"}


async def test_missing_right_and_another_robot_become_repairs(core, fake, entry):
    issues = ir.async_get(core)

    def open_issues():
        return {issue.translation_key for (domain, _), issue in issues.issues.items() if domain == "whichone"}

    fake.script = ["right", "question"]
    await say(core, "get me the bowl")
    assert open_issues() == {"rights"}
    await say(core, "get me the bowl")
    assert open_issues() == set()
    fake.info = {"id": "another", "name": "other"}
    await fake.drop()
    await until(lambda: open_issues() == {"other_robot"})
    assert state(core, "activity").state == "unavailable"
    fake.info = {"api": 2}
    await until(lambda: open_issues() == {"other_robot", "api_version"}, 30)
    fake.info = {}
    await until(lambda: open_issues() == set(), 30)


async def test_diagnostics_have_no_words_and_no_secrets(core, fake, entry):
    await fake.publish("question")
    await until(lambda: entry.runtime_data.is_busy)
    found = await async_get_config_entry_diagnostics(core, entry)
    assert found["state"]["state"] == "asking"
    assert found["is_connected"]
    text = str(found)
    belief = ANSWERS["state_idle"]["body"]["belief"]
    for secret in (TOKEN, ID, "127.0.0.1", of("question")["text"], *of("question")["options"], *belief):
        assert str(secret) not in text


async def test_long_events_and_broken_ones(core):
    fake = Fake()
    await fake.start()
    session = aiohttp.ClientSession()
    robot = api.Robot(session, fake.url, TOKEN)
    names = []
    stream = robot.events(None)
    assert await anext(stream) is None
    names.append((await anext(stream)).name)
    await fake._send("question", {"text": "x" * 500_000})
    names.append((await anext(stream)).name)
    assert names == ["snapshot", "question"]
    await fake._send("line", {"text": "x" * 5_000_000})
    with pytest.raises(api.CannotConnect):
        await anext(stream)
    await session.close()
    await fake.end()
