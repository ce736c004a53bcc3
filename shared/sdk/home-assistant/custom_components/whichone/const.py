"""Names and times of the integration."""

from typing import Final

DOMAIN: Final = "whichone"

# Version of the robot's HTTP interface that this integration speaks.
API: Final = 1

CONF_NAME_PEOPLE: Final = "name_people"

# Activities of the robot; of several that hold, the first.
STATES: Final = ["stopped", "disconnected", "held", "fetching", "asking", "idle"]

# Seconds that a request waits for the robot's reply, and that a sentence is sent again while the robot is away.
WAIT_S: Final = 6.0
RETRY_S: Final = 15.0
# Seconds that a stop is sent again while the robot's console is away.
STOP_RETRY_S: Final = 5.0
# Seconds after a question in which a satellite may hear it.
ECHO_S: Final = 15.0
# Pause before a request is sent again, seconds.
PAUSE_S: Final = 0.4
# Pause between looks at an arm that may move, seconds, and looks at rest after which it does not: no event tells of it,
# and an arm may set out a moment after an event.
ARM_PAUSE_S: Final = 1.0
ARM_LOOKS: Final = 3
# A stream of events that is silent for longer is dead: the robot sends a comment every 15 s.
SILENCE_S: Final = 40.0
# Pauses before the events are asked for again, seconds: the first, and the longest.
BACKOFF_S: Final = (0.5, 10.0)

# Sentences that mean the robot in every state, whichever agent is spoken to. A stop is understood in German, too.
STOP_THE_ROBOT: Final = [
    "stop [the] robot",
    "robot stop",
    "stop moving",
    "(stopp|stoppe) [den] roboter",
    "roboter stopp",
]
# Sentences that mean it while it is busy. Home Assistant takes both for its own otherwise, or does nothing.
STOP: Final = ["stop", "freeze", "stop it", "stop that", "stopp", "halt"]
NEVER_MIND: Final = ["never mind", "nevermind"]
