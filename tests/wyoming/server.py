#!/usr/bin/env python3
"""A server of speech on the classes of the package `wyoming`, for tests.

    server.py PORT FOLDER

It knows an utterance by its sound: the samples that it receives are a part of those of FOLDER/NAME.wav (16 kHz, 16 bit,
mono), and its words are in FOLDER/NAME.txt. It speaks with espeak-ng. Each request is a line of FOLDER/log.
"""
import asyncio
import subprocess
import sys
import wave
from functools import partial
from pathlib import Path

from wyoming.asr import Transcribe, Transcript
from wyoming.audio import AudioChunk, AudioStart, AudioStop
from wyoming.error import Error
from wyoming.event import Event
from wyoming.info import AsrProgram, Attribution, Describe, Info, TtsProgram
from wyoming.server import AsyncEventHandler, AsyncTcpServer
from wyoming.tts import Synthesize

COMMON = {
    "name": "table",
    "attribution": Attribution(name="test", url=""),
    "installed": True,
    "description": None,
    "version": "1",
}
INFO = Info(asr=[AsrProgram(**COMMON, models=[])], tts=[TtsProgram(**COMMON, voices=[])])


class Handler(AsyncEventHandler):
    """One connection."""

    def __init__(self, folder: Path, *streams: object) -> None:
        super().__init__(*streams)
        self.folder = folder
        self.audio = b""
        self.request = Transcribe()

    async def handle_event(self, event: Event) -> bool:
        """Answers an event; the connection ends with the answer to a request."""
        if Describe.is_type(event.type):
            await self.write_event(INFO.event())
        elif Transcribe.is_type(event.type):
            self.request = Transcribe.from_event(event)
        elif AudioStart.is_type(event.type):
            start = AudioStart.from_event(event)
            assert (start.rate, start.width, start.channels) == (16000, 2, 1), start
        elif AudioChunk.is_type(event.type):
            self.audio += AudioChunk.from_event(event).audio
        elif AudioStop.is_type(event.type):
            terms = ",".join(self.request.transcript_terms or [])
            text = self.known()
            self.log(f"transcribe {self.request.language} {terms}: {text}")
            await self.write_event(Transcript(text=text).event())
            return False
        elif Synthesize.is_type(event.type):
            await self.speak(Synthesize.from_event(event).text)
            return False
        else:
            await self.write_event(Error(text=f"unexpected {event.type}").event())
            return False
        return True

    def known(self) -> str:
        """Returns the words of the sound that the audio is a part of."""
        for path in self.folder.glob("*.wav"):
            with wave.open(str(path)) as file:
                if self.audio in file.readframes(file.getnframes()):
                    return path.with_suffix(".txt").read_text()
        return ""

    async def speak(self, text: str) -> None:
        """Sends the sound of a text."""
        self.log(f"synthesize {text}")
        path = self.folder / "spoken"
        subprocess.run(["espeak-ng", "-v", "en-us", "-w", path, "--", text], check=True)
        with wave.open(str(path)) as file:
            sound = (file.getframerate(), file.getsampwidth(), file.getnchannels())
            await self.write_event(AudioStart(*sound).event())
            while audio := file.readframes(1024):
                await self.write_event(AudioChunk(*sound, audio).event())
        await self.write_event(AudioStop().event())

    def log(self, line: str) -> None:
        """Appends a line to the log."""
        with open(self.folder / "log", "a") as file:
            file.write(line + "\n")


if __name__ == "__main__":
    server = AsyncTcpServer("127.0.0.1", int(sys.argv[1]))
    asyncio.run(server.run(partial(Handler, Path(sys.argv[2]))))
