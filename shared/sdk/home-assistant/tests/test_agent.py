"""The agent: what is said to it, and what it answers."""

import asyncio

import pytest
from homeassistant.components.conversation import async_get_chat_log
from homeassistant.core import Context
from homeassistant.helpers.chat_session import async_get_chat_session

from custom_components.whichone import api, const, echo
from custom_components.whichone.stops import is_stop
from custom_components.whichone.whose import conversation_of, name_of
from fake_robot import reply_of
from talk import say, spoken


async def test_microphone_stays_open_while_the_robot_waits(core, fake, entry):
    fake.script = ["question", "fetching"]
    first = await say(core, "get me the bowl")
    assert spoken(first) == reply_of("question")["text"]
    assert first.continue_conversation
    second = await say(core, "the clear one", first.conversation_id)
    assert spoken(second) == reply_of("fetching")["text"]
    assert not second.continue_conversation
    # The answer is to the line that the person was given, and to no other.
    assert [words.get("seen") for words in fake.said] == [None, reply_of("question")["prompt"]]
    assert len(set(fake.keys)) == 2


async def test_microphone_follows_what_the_robot_expects_and_no_question_mark(core, fake, entry, monkeypatch):
    fake.script = ["question", "fetching"]
    monkeypatch.setitem(reply_of("question"), "text", "You mean the white one.")
    monkeypatch.setitem(reply_of("fetching"), "text", "I will get it, all right?")
    assert (await say(core, "get me the bowl")).continue_conversation
    assert not (await say(core, "yes")).continue_conversation


async def test_own_question_that_a_satellite_hears_is_no_answer(core, fake, entry, monkeypatch):
    fake.script = ["question"] * 4
    asks = reply_of("question")["text"]
    await say(core, "get me the bowl", device="hall")
    heard = await say(core, asks, device="hall")
    assert spoken(heard) == ""
    assert heard.continue_conversation
    assert len(fake.said) == 1
    # Typed, and later, the words are the person's.
    typed = await say(core, "get me the bowl")
    assert spoken(await say(core, asks, typed.conversation_id)) == asks
    monkeypatch.setattr(echo, "ECHO_S", -1.0)
    assert spoken(await say(core, asks, device="hall")) == asks
    assert len(fake.said) == 4


@pytest.mark.parametrize(
    ("heard", "line", "expected"),
    [
        ("Is it white?", "Is it white?", True),
        ("is it the white one", "All right. Is it the white one?", True),
        ("all right, is it the white one", "All right. Is it the white one?", True),
        ("it is white", "Is it white?", False),
        ("no is it white", "Is it white?", False),
        ("is it the red one", "Is it the white one?", False),
        ("the red one", "The red one?", False),
        ("yes", "Is it white?", False),
        ("", "Is it white?", False),
    ],
)
def test_echo_is_the_question_word_for_word(heard, line, expected):
    assert echo.is_echo(heard, line, 0.0) is expected


async def test_chat_log_has_both_sides(core, fake, entry):
    fake.script = ["question", "fetching"]
    first = await say(core, "get me the bowl")
    await say(core, "the clear one", first.conversation_id)
    with async_get_chat_session(core, first.conversation_id) as session, async_get_chat_log(core, session) as log:
        said = [part.content for part in log.content if part.role in ("user", "assistant")]
    asks, gets = (reply_of(name)["text"] for name in ("question", "fetching"))
    assert said == ["get me the bowl", asks, "the clear one", gets]


async def test_denial_and_next_question_are_one_reply(core, fake, entry):
    fake.script = ["denied"]
    result = await say(core, "no, not that one")
    assert spoken(result).startswith("All right. ")
    assert result.continue_conversation


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("busy", "I am talking with someone else. Say stop to stop me."),
        ("right", "I may not do that. The robot's owner has to give me the right."),
        ("other_words", "this key belongs to other words"),
    ],
)
async def test_refusals_are_said(core, fake, entry, name, words):
    fake.script = [name]
    result = await say(core, "get me the bowl")
    assert spoken(result) == words
    assert not result.continue_conversation


async def test_sentence_is_said_under_one_key_while_a_service_restarts(core, fake, entry):
    fake.script = ["unavailable", "unavailable", "question"]
    result = await say(core, "get me the bowl")
    assert result.continue_conversation
    assert len(fake.keys) == 3
    assert len(set(fake.keys)) == 1


async def test_sentence_waits_for_a_robot_that_comes_back(core, fake, entry):
    fake.script = ["question"]
    await fake.end()
    task = core.async_create_task(say(core, "get me the bowl"))
    await asyncio.sleep(3 * const.PAUSE_S)
    await fake.start()
    assert (await task).continue_conversation
    assert len(fake.said) == 1


async def test_robot_that_is_away_is_said_and_the_agent_stays(core, fake, entry, monkeypatch):
    monkeypatch.setattr(api, "RETRY_S", 0.5)
    await fake.end()
    result = await say(core, "get me the bowl")
    assert spoken(result) == "I cannot reach the robot."
    assert core.states.get("conversation.robot").state != "unavailable"


async def test_lines_are_numbered_anew_after_a_fresh_start(core, fake, entry):
    fake.script = ["fetching", "unseen_line", "question"]
    await say(core, "get me the clear bowl", device="hall")
    assert (await say(core, "get me the bowl", device="hall")).continue_conversation
    assert [words.get("seen") for words in fake.said] == [None, reply_of("fetching")["prompt"], None]
    assert fake.keys[1] != fake.keys[2]


async def test_answer_to_a_question_that_is_gone_is_not_said_again(core, fake, entry):
    fake.script = ["question", "unseen_line", "question"]
    await say(core, "get me the bowl", device="hall")
    result = await say(core, "the clear one", device="hall")
    assert spoken(result) == "I have begun afresh. Please say your request again."
    assert not result.continue_conversation
    assert [words["text"] for words in fake.said] == ["get me the bowl", "the clear one"]
    assert (await say(core, "get me the bowl", device="hall")).continue_conversation
    assert "seen" not in fake.said[-1]


@pytest.mark.parametrize("text", ["stop", "Stop, stop!", "Please stop now.", "Stop the robot!", "Stopp den Roboter!"])
async def test_stop_to_the_agent_is_the_stop_itself(core, fake, entry, text):
    fake.script = ["question"]
    first = await say(core, "get me the bowl")
    result = await say(core, text, first.conversation_id)
    assert spoken(result) == "I have stopped."
    assert not result.continue_conversation
    assert fake.asked.count("motion/stop") == 1
    assert len(fake.said) == 1


async def test_stop_to_the_agent_of_a_robot_that_is_away_is_not_confirmed(core, fake, entry, monkeypatch):
    monkeypatch.setattr(api, "STOP_RETRY_S", 0.2)
    fake.script = ["question"]
    first = await say(core, "get me the bowl")
    await fake.end()
    async with asyncio.timeout(3):
        result = await say(core, "stop", first.conversation_id)
    assert spoken(result) == "The robot has not confirmed the stop! Use its emergency stop."


async def test_words_stop_where_the_token_may_only_talk(core, fake, entry):
    fake.answers["motion/stop"] = "right"
    fake.script = ["stopped", "question"]
    assert spoken(await say(core, "stop")) == reply_of("stopped")["text"]
    # What the robot did not take for a stop is none.
    assert "has not confirmed the stop" in spoken(await say(core, "Stopp den Roboter!"))
    assert [words["text"] for words in fake.said] == ["stop", "Stopp den Roboter!"]


@pytest.mark.parametrize("text", ["stop, not that one", "do not stop", "the one beside the bus stop", ""])
def test_other_words_are_no_stop(text):
    assert not is_stop(text)


async def test_dialogue_is_the_satellites_else_the_devices_else_the_users(core, fake, entry, hass_admin_user):
    assert conversation_of("assist_satellite.hall", "device", "user", "talk") == "home-assistant assist_satellite.hall"
    assert conversation_of(None, None, None, "talk") == "home-assistant talk"
    fake.script = ["question", "fetching", "question"]
    context = Context(user_id=hass_admin_user.id)
    await say(core, "get me the bowl", "talk-1", device="device", context=context)
    await say(core, "the clear one", "talk-2", device="device", context=context)
    await say(core, "get me the bowl", "talk-3", context=context)
    said = [words["conversation"] for words in fake.said]
    assert said == ["home-assistant device"] * 2 + [f"home-assistant {hass_admin_user.id}"]
    assert all("from" not in words for words in fake.said)


async def test_names_of_people_are_told_only_if_the_owner_says_so(core, fake, entry, hass_admin_user):
    core.config_entries.async_update_entry(entry, options={const.CONF_NAME_PEOPLE: True})
    await core.async_block_till_done()
    fake.script = ["question", "question"]
    await say(core, "get me the bowl", context=Context(user_id=hass_admin_user.id))
    await say(core, "get me the bowl", device="device")
    assert [words.get("from") for words in fake.said] == [hass_admin_user.name, None]
    hass_admin_user.name = "Zoë\n" + "é" * 40
    assert await name_of(core, hass_admin_user.id) == "Zoë" + "é" * 30
    assert await name_of(core, None) is None
