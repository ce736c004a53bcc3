"""Messages, scene and readings without a group: `python3 -m unittest discover shared/sdk/python/tests`."""

import ctypes
import itertools
import json
import socket
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from types import SimpleNamespace

HERE = Path(__file__).resolve()
sys.path.insert(0, str(HERE.parents[1]))
ROOT = HERE.parents[4]

from whichone import Client, GroupNotRunning, InvalidMessage, Reading, Response, Scene, _stop, spot
from whichone import messages as m
from whichone.group import Group
from whichone._postcard import decode, encode
from whichone.grounding import Heard, Hypothesis, heard, observation


def bowls():
    return Scene.parse((ROOT / "config/scenes/bowls.toml").read_text(encoding="utf-8"))


def utterance(text, questions=0):
    message = m.Utterance(seq=7, hypothesis_count=1, asked_count=questions)
    message.text.set(text)
    message.hypotheses[0].len, message.hypotheses[0].weight = len(text.encode()), 1.0
    message.hypotheses[0].confidence[:] = [255] * m.CONFIDENCES_MAX
    return message


class StopOrder(unittest.TestCase):
    """The motion stop's orders, of an arm that this test imitates."""

    def answer(self, **changed):
        return {"given_ns": 5, "in_force_ns": 5, "stopped": True, "at_rest": True, "durable": True,
                "inhibit": "none", "stop": 0} | changed

    def test_stop_outlasts_every_restart_and_warns_now_and_then(self):
        stop, warnings = _stop.Order("stop", 0.0, None), []
        for second in range(86_400):
            stop.on_sent(is_absent=True)
            self.assertFalse(stop.is_done(second))
            if why := stop.warning(second):
                warnings.append(second)
                self.assertIn("emergency stop", why)
        self.assertEqual(warnings[:3], [0, 3, 6])
        stop.on_sent(is_absent=False)
        stop.on_answer(self.answer(), 86_400)
        self.assertTrue(stop.is_done(86_400))

    def test_only_an_arm_at_rest_that_is_heard_confirms(self):
        for changed in ({"at_rest": False}, {"inhibit": "unheard"}, {"stopped": False}):
            stop = _stop.Order("stop", 0.0, None)
            stop.on_answer(self.answer(**changed), 0.1)
            self.assertFalse(stop.is_done(1.0), changed)
        stop = _stop.Order("stop", 0.0, None)
        stop.on_answer(self.answer(stopped=False, in_force_ns=6), 0.1)
        self.assertRaisesRegex(_stop.NotStopped, "overruled", stop.is_done, 0.1)
        late = _stop.Order("resume", 0.0, 5.0)
        self.assertFalse(late.is_done(4.9))
        self.assertRaisesRegex(_stop.NotStopped, "does not answer", late.is_done, 5.0)

    def test_release_of_a_stop_that_is_not_the_latest_ends(self):
        release = _stop.Order("resume", 3.0, 5.0, stop=7)
        for arm in ({"stop": 7}, {}):
            release.on_answer(self.answer(given_ns=3_000_000_000, **arm), 3.1)
            self.assertFalse(release.is_done(3.1), arm)
        release.on_answer(self.answer(given_ns=3_000_000_000, stop=8), 3.1)
        self.assertRaisesRegex(_stop.NotStopped, "another stop", release.is_done, 3.1)

    def test_restarted_arm_takes_the_repeated_order(self):
        with tempfile.TemporaryDirectory() as home:
            group = Group("g", home)
            self.assertRaises(GroupNotRunning, _stop.give, group, "stop", None)
            group.run.mkdir(parents=True)
            orders = []

            def arm():
                with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listener:
                    listener.bind(str(group.run / "stop.sock"))
                    data, caller = listener.recvfrom(512)
                    orders.append(json.loads(data))
                    given = orders[0]["given_ns"]
                    listener.sendto(json.dumps(self.answer(given_ns=given, in_force_ns=given)).encode(), caller)

            with self.assertLogs("whichone", "WARNING") as logged:
                # The arm starts once the giver has been warned that it is away.
                starter = threading.Thread(target=lambda: (wait_until(lambda: logged.records), arm()))
                starter.start()
                _stop.give(group, "stop", None)
                starter.join()
            self.assertEqual(orders[0]["order"], "stop")


class Say(unittest.TestCase):
    """Words of a client, to topics that this test imitates."""

    def test_words_answer_the_line_that_they_name_or_the_latest_one(self):
        sent, robot = [], Client.__new__(Client)
        robot._identity, robot._injections = bytes(8), SimpleNamespace(send=sent.append)
        robot.look = lambda: SimpleNamespace(view=SimpleNamespace(prompt=9), presented=None)
        accepted = m.ReceiptStatus.ACCEPTED
        robot._receipts = map(lambda _: SimpleNamespace(key=sent[-1].key, status=accepted, seq=4), itertools.repeat(0))
        for seen, expected in ((None, 9), (7, 7), (0, 0)):
            self.assertEqual(robot.say("yes", seen=seen), 4)
            self.assertEqual(robot.point([0.0, 0.0, 0.0], seen=seen), 4)
            self.assertEqual(robot.hypotheses([("yes", 1.0)], seen=seen), 4)
            self.assertEqual({injection.seen_prompt for injection in sent[-3:]}, {expected})


def wait_until(fact):
    until = time.monotonic() + 60
    while not fact() and time.monotonic() < until:
        time.sleep(0.001)


class Messages(unittest.TestCase):
    def test_layout_is_that_of_the_golden_file(self):
        golden = (ROOT / "tests/golden/wire_layout.txt").read_text(encoding="utf-8")
        for message in m.Message.__subclasses__():
            head = f"{message.wire_name} size {ctypes.sizeof(message)} schema {message.schema_key}\n"
            self.assertIn(head, golden)
            block = golden.split(head)[1].split("\n\n")[0].splitlines()
            offsets = [(line.split()[2].rstrip(":"), int(line.split()[0])) for line in block]
            found = [(name.removesuffix("_"), getattr(message, name).offset) for name, *_ in message._fields_]
            self.assertEqual(offsets, found)
        self.assertEqual(set(m.TOPICS), {line.split()[0] for line in golden.splitlines() if " waking [" in line})

    def test_encoded_messages_round_trip(self):
        sounds = [m.SoundText("hellö"), m.SoundPoint(target_m=[0.1, -2.0, 3.5], words=""),
                  m.SoundTalk(longest_s=2.5),
                  m.SoundTranscript(hypotheses=[m.Hypothesis(text="a", weight=0.5, word_confidence=[0.25])])]
        for sound in sounds:
            injection = m.Injection(key=bytes(range(16)), onset_ns=2**63, end_ns=0, seen_prompt=300, from_="Ann",
                                    sound=sound)
            self.assertEqual(decode(m.Injection, encode(injection)), injection)
        data = encode(m.Injection(key=b"k" * 16, onset_ns=0, end_ns=127, seen_prompt=128, from_="A", sound=sounds[0]))
        self.assertEqual(data, b"k" * 16 + b"\x00\x7f\x80\x01\x01A\x00\x06hell\xc3\xb6")

    def test_malformed_bytes_are_refused(self):
        sound = m.SoundText("hello")
        whole = encode(m.Injection(key=b"k" * 16, onset_ns=0, end_ns=0, seen_prompt=0, from_="", sound=sound))
        for cut in range(len(whole)):
            with self.assertRaises(InvalidMessage):
                decode(m.Injection, whole[:cut])
        wrong = [whole + b"\0", whole[:20] + b"\x09" + whole[21:], whole[:16] + b"\xff" * 20,
                 whole[:21] + b"\xff\xff\xff\xff\x0f", whole[:-1] + b"\xff"]
        for data in wrong:
            with self.assertRaises(InvalidMessage):
                decode(m.Injection, data)

    def test_values_that_do_not_fit_are_refused(self):
        good = {"key": b"k" * 16, "onset_ns": 0, "end_ns": 0, "seen_prompt": 0, "from_": "", "sound": m.SoundText("a")}
        for wrong in ({"key": b"k"}, {"onset_ns": -1}, {"end_ns": 2**64}, {"sound": "a"}):
            with self.assertRaises(InvalidMessage):
                encode(m.Injection(**(good | wrong)))

    def test_invalid_codes_are_found_wherever_they_are(self):
        message = m.Observation()
        message.validate()
        message.readings[m.READINGS_MAX - 1].intent = 200
        with self.assertRaisesRegex(InvalidMessage, "Reading.intent: expected a Intent .*found 200"):
            message.validate()

    def test_texts_lose_their_end_between_characters(self):
        message = m.Receipt()
        message.first_text.set("ä" * 150)
        self.assertEqual(str(message.first_text), "ä" * 100)
        message.first_text.set("short")
        self.assertEqual((str(message.first_text), message.first_text.len), ("short", 5))
        message.first_text.len = 4_000_000_000
        self.assertEqual(str(message.first_text)[:5], "short")


class Readings(unittest.TestCase):
    def test_words_are_numbered_and_spotted(self):
        scene = bowls()
        self.assertEqual(scene.objects[0], "white")
        self.assertEqual([scene.words.index(word) for word in scene.words], list(range(len(scene.words))))
        self.assertEqual(scene.spot("the WHITE one, not-white"), [("white", 1)])
        with self.assertRaisesRegex(ValueError, "expected a word of the scene .white, .*found 'purple'"):
            scene.word("purple")

    def test_utterance_becomes_one_reading_for_each_question_and_none(self):
        scene, said = bowls(), utterance("no the white bowl", questions=2)
        message = observation(said, spot(heard(said, scene), scene), scene)
        message.validate()
        self.assertEqual((message.seq, message.scene_key, message.reading_count), (7, scene.key, 3))
        self.assertEqual([it.question for it in message.readings[:3]], [0, 1, m.NO_QUESTION])
        for reading in message.readings[:3]:
            self.assertEqual((reading.weight, reading.response), (1.0, Response.NO))
            self.assertEqual(reading.base[:reading.base_count], [scene.word("white")])

    def test_weights_are_normalised_and_the_likeliest_kept(self):
        scene, said = bowls(), utterance("bowl", questions=1)
        many = [Reading(["white"], weight=n, question=0) for n in range(1, 40)] + [Reading(["metal"])]
        message = observation(said, many, scene)
        self.assertEqual(message.reading_count, 17)
        own = message.readings[:16]
        self.assertAlmostEqual(sum(it.weight for it in own), 1.0)
        self.assertTrue(all(a.weight >= b.weight for a, b in zip(own, own[1:])))

    def test_readings_that_make_no_sense_are_named(self):
        scene, said = bowls(), utterance("bowl", questions=1)
        wrong = [(Reading(["purple"]), "purple"), (Reading(question=1), "found 1"), (Reading(weight=-1.0), "-1.0"),
                 (Reading(weight=float("nan")), "nan"), (Reading(weight=0.0), "above 0"),
                 (Reading(["white"], base_doubt=[1.5]), "1.5"), (Reading(response=9), "9")]
        for reading, named in wrong:
            with self.assertRaisesRegex(ValueError, named):
                observation(said, [reading], scene)

    def test_utterances_that_make_no_sense_are_refused(self):
        scene = bowls()
        for change in ({"hypothesis_count": 6}, {"asked_count": 5}):
            said = utterance("bowl")
            for field, value in change.items():
                setattr(said, field, value)
            with self.assertRaises(InvalidMessage):
                heard(said, scene)
        said = utterance("bowl")
        said.hypotheses[0].len = 9
        with self.assertRaises(InvalidMessage):
            heard(said, scene)
        for weight in (float("nan"), float("inf"), -1.0):
            said = utterance("bowl")
            said.hypotheses[0].weight = weight
            with self.assertRaises(InvalidMessage):
                heard(said, scene)

    def test_doubts_follow_the_recogniser(self):
        scene = bowls()
        words = Heard(1, [Hypothesis("the white bowl", 1.0, [0.0, 0.25])], [], None)
        self.assertEqual(spot(words, scene)[0].base_doubt, [0.25])


if __name__ == "__main__":
    unittest.main()
