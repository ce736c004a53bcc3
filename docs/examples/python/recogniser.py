#!/usr/bin/env python3
"""A recogniser of your own: samples in, hypotheses out (docs/speech.md has the protocol).

    recogniser = "command"
    recogniser_command = ["python3", "/path/to/recogniser.py", "whisper-cli", "-m", "/path/to/model.bin", "-nt", "-np", "-f"]

Runs the command after its own name once for each utterance, with the path of a WAV file as last
argument, and takes what it prints for what was said.
"""

import json
import os
import subprocess
import sys
import tempfile
import wave


def main(command):
    while head := sys.stdin.buffer.readline():
        about = json.loads(head)
        samples = sys.stdin.buffer.read(2 * about["samples"])
        print(json.dumps(answer(command, about["rate"], samples)), flush=True)


def answer(command, rate, samples):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "utterance.wav")
        with wave.open(path, "wb") as file:
            file.setnchannels(1)
            file.setsampwidth(2)
            file.setframerate(rate)
            file.writeframes(samples)
        try:
            done = subprocess.run([*command, path], capture_output=True, text=True, check=True)
        except (OSError, subprocess.CalledProcessError) as error:
            return {"error": f"{error}"}
    return {"hypotheses": [{"text": " ".join(done.stdout.split())}]}


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1:])
