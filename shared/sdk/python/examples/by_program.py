"""Grounding by an external program, for example a local language model.

    whichone swap grounding -- python3 shared/sdk/python/examples/by_program.py PROGRAM [ARGUMENT…]

For each utterance the program is started once. It reads a prompt on standard input and writes JSON
on standard output:

    {"readings": [{"question": 0, "weight": 1.0, "base": ["white"], "base_doubt": [0.1],
                   "excluded": [["big"]], "response": "yes", "response_doubt": 0.0,
                   "intent": "inform"}]}

`question` is the place of the question answered, null for none; all keys may be left out. For each
question the weights are made to sum to 1. If the program is too slow, fails, or names something that
the scene does not have, the utterance is read by word spotting instead, and the log says why.
"""

import json
import subprocess
import sys
import time

from whichone import Grounder, Intent, Reading, Response

# People wait for about a second; the policy stays silent for longer, but the dialogue stalls.
SECONDS_MAX = 1.5
NAMES = {"response": Response, "intent": Intent}


class ByProgram(Grounder):
    def __init__(self, command):
        super().__init__()
        self.command = command

    def ground(self, heard):
        answer = json.loads(self.ask(self.prompt(heard)))
        return [Reading(**{key: self.value(key, value) for key, value in reading.items()})
                for reading in answer["readings"]]

    @staticmethod
    def value(key, value):
        """An answer's value: codes are given by name."""
        return NAMES[key][value.upper()] if key in NAMES else value

    def prompt(self, heard):
        """The prompt for the program. A person's words are quoted as JSON, so that they are data and never an
        instruction."""
        asked = [{"place": n, "question": self.scene.question(it)} for n, it in enumerate(heard.questions)]
        said = [{"text": it.text, "weight": it.weight} for it in heard.hypotheses]
        return "\n".join([
            "Say what this person tells a robot about the object that they want. Answer in JSON.",
            "scene words: " + json.dumps(self.scene.words),
            "questions that may be answered, newest first: " + json.dumps(asked),
            "heard: " + json.dumps(said),
        ])

    def ask(self, text):
        """Runs the program and returns its answer, sending beats to the supervisor meanwhile."""
        until, pipe = time.monotonic() + SECONDS_MAX, subprocess.PIPE
        with subprocess.Popen(self.command, stdin=pipe, stdout=pipe, text=True) as program:
            try:
                while True:
                    try:
                        answer, _ = program.communicate(text, timeout=0.05)
                        break
                    except subprocess.TimeoutExpired:
                        text = None  # It has been handed over.
                        self.beat()
                        if time.monotonic() > until or self.ends:
                            raise OSError(f"no answer in {SECONDS_MAX} s") from None
            finally:
                # Do not wait for a program that is still running after a failure.
                if program.poll() is None:
                    program.kill()
        if program.returncode != 0:
            raise ValueError(f"the program exited with {program.returncode}")
        return answer


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("by_program.py PROGRAM [ARGUMENT…]: name the program that reads")
    ByProgram(sys.argv[1:]).run()
