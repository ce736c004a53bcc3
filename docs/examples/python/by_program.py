"""Grounding by an external program, for example a local language model.

    whichone swap grounding -- python3 docs/examples/python/by_program.py PROGRAM [ARGUMENT…]

For each utterance the program is started once. It reads a prompt on standard input and writes JSON
on standard output:

    {"readings": [{"question": 0, "weight": 1.0, "base": ["white"], "base_doubt": [0.1],
                   "excluded": [["big"]], "response": "yes", "response_doubt": 0.0,
                   "intent": "inform"}]}

`question` is the place of the question answered, null for none; all keys may be left out. For each
question the weights are made to sum to 1. If the program is too slow, fails, or names something that
the scene does not have, the utterance is read by word spotting instead, and standard error says why.
A repeated utterance gets the same answer: answers are cached for a while.
"""

import json
import subprocess
import sys
import time

from grounding import NO_QUESTION, empty, hypotheses, observe, places, serve

# People wait for about a second; the policy stays silent for longer, but the dialogue stalls.
SECONDS_MAX = 1.5
KEPT_MAX = 64
RESPONSES = ["none", "yes", "no"]
INTENTS = ["inform", "none", "stop", "cancel", "repeat", "start_over", "ask_back"]


def question(scene, asked):
    """A question in words; a question about another scene is empty."""
    number = asked.question
    if asked.scene != scene.key or number.kind == 0:
        return {}
    if number.kind == 1:
        return {"pointing_at": scene.objects[number.object]}
    name, values = list(scene.values.items())[number.attribute]
    return {"attribute": name, "value": values[number.value]} if number.kind == 2 else {"open": name}


def prompt(scene, utterance):
    """The prompt for the program. A person's words are quoted as JSON, so that they are data and never
    an instruction."""
    asked = [{"place": n} | question(scene, asked)
             for n, asked in enumerate(utterance.asked[:utterance.asked_count])]
    heard = [{"text": text, "weight": weight} for text, weight, _ in hypotheses(utterance)]
    return "\n".join([
        "Say what this person tells a robot about the object that they want. Answer in JSON.",
        "scene words: " + json.dumps(scene.words),
        "questions that may be answered, newest first: " + json.dumps(asked),
        "heard: " + json.dumps(heard),
    ])


def run(command, text, bond):
    """Runs the program and returns its answer, sending beats to the supervisor meanwhile."""
    pipe = subprocess.PIPE
    until = time.monotonic() + SECONDS_MAX
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as program:
        try:
            while True:
                try:
                    answer, _ = program.communicate(text, timeout=0.05)
                    break
                except subprocess.TimeoutExpired:
                    text = None  # It has been handed over.
                    bond.beat()
                    if time.monotonic() > until or bond.ends():
                        raise OSError(f"no answer in {SECONDS_MAX} s") from None
        finally:
            # Do not wait for a program that is still running after a failure.
            if program.poll() is None:
                program.kill()
    if program.returncode != 0:
        raise ValueError(f"the program exited with {program.returncode}")
    return answer


def share(number):
    """A probability, or an error."""
    if not 0.0 <= float(number) <= 1.0:
        raise ValueError(f"{number} is not a probability")
    return float(number)


def fill(slot, given, words, place, total):
    """Writes one reading of the answer to its place in the message."""
    base = [words.index(word) for word in given.get("base", [])][:len(slot.base)]
    groups = given.get("excluded", [])[:len(slot.excluded)]
    slot.question, slot.weight = place, share(given.get("weight", 1.0)) / total
    slot.response = RESPONSES.index(given.get("response", "none"))
    slot.response_doubt = share(given.get("response_doubt", 0.0))
    slot.intent = INTENTS.index(given.get("intent", "inform"))
    slot.base_count, slot.base[:len(base)] = len(base), base
    for n, doubt in enumerate(given.get("base_doubt", [])[:len(base)]):
        slot.base_doubt[n] = share(doubt)
    slot.excluded_count = len(groups)
    for n, group in enumerate(groups):
        numbers = [words.index(word) for word in group][:len(slot.excluded[n])]
        slot.excluded_len[n], slot.excluded[n][:len(numbers)] = len(numbers), numbers


def believe(observation, answer, scene, utterance):
    """Fills the observation with the program's answer. A question that it leaves out is read as
    none is: with the readings that answer no question."""
    given = json.loads(answer)["readings"]
    by_place = {place: [] for place in places(utterance)}
    for reading in given:
        place = reading.get("question")
        by_place[NO_QUESTION if place is None else place].append(reading)
    slots = iter(observation.readings)
    count = 0
    for place, readings in by_place.items():
        readings = readings or by_place[NO_QUESTION] or [{"intent": "none"}]
        # Six for each of four questions and none: so many fit.
        readings = sorted(readings, key=lambda reading: -reading.get("weight", 1.0))[:6]
        total = sum(share(reading.get("weight", 1.0)) for reading in readings)
        for reading in readings:
            fill(next(slots), reading, scene.words, place, total)
            count += 1
    observation.reading_count = count


def main():
    command = sys.argv[1:]
    if not command:
        raise SystemExit("by_program.py PROGRAM [ARGUMENT…]: name the program that reads")
    kept = {}

    def observe_one(layout, scene, utterance, bond):
        if utterance.hypothesis_count == 0 or kept.get(utterance.seq, "") is None:
            return observe(layout, scene, utterance)
        observation = empty(layout, scene, utterance)
        try:
            if utterance.seq not in kept:
                kept[utterance.seq] = run(command, prompt(scene, utterance), bond)
            believe(observation, kept[utterance.seq], scene, utterance)
            return observation
        except (OSError, ValueError, KeyError, TypeError, AttributeError, ZeroDivisionError) as why:
            # Sent again, the utterance is answered as now.
            kept[utterance.seq] = None
            print(f"{command[0]}: {why}; read by word spotting", file=sys.stderr, flush=True)
            return observe(layout, scene, utterance)
        finally:
            while len(kept) > KEPT_MAX:
                del kept[min(kept)]

    serve(observe_one)


if __name__ == "__main__":
    main()
