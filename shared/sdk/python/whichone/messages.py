"""Messages of the topics. Generated from the wire layout; do not edit.

Numbers are in SI units. Times end in `_ns`: nanoseconds of the monotonic clock (`time.monotonic_ns()`).
Messages of fixed layout are `ctypes` structures, which lie in shared memory as they are; the others are
dataclasses with an encoding.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from enum import IntEnum

from . import _postcard as encoding
from ._fixed import Array, InvalidMessage, Message, Text, Topic, fixed_text

ASKED_MAX = 4
BASE_WORDS_MAX = 32
CHUNK_SAMPLES_MAX = 1600
CONFIDENCES_MAX = 32
EXCLUDED_GROUPS_MAX = 8
EXCLUDED_WORDS_MAX = 6
FURTHER_MAX = 4
HYPOTHESES_MAX = 5
JOINTS_MAX = 17
JOINT_STATE_LEN = 17
LIMB_JOINTS = 7
PERSON_BYTES_MAX = 64
READINGS_MAX = 32
UTTERANCE_BYTES_MAX = 16380
NO_QUESTION = 255


class ActKind(IntEnum):
    """Kind of a decision."""

    WAIT = 0
    """Waits for the user."""
    ASK = 1
    """Asks a question."""
    SAY = 2
    """Says a line; no answer is expected."""
    PICK = 3
    """Picks an object and says so."""
    CANCEL = 4
    """Calls a pick off: an object that is grasped already goes back to its place, unless the gripper has
    begun to let go of it where it hands it over. Calls putting back off, unless the object is already
    grasped."""
    PUT_BACK = 5
    """Puts the object that was handed over back in its place and says so."""


class DrillKind(IntEnum):
    """An external influence on the simulated robot."""

    ENABLE = 0
    """`set_super_enable` true: motors on."""
    DISABLE = 1
    """`set_super_enable` false: motors off."""
    RESET = 2
    """`set_super_reset`: faults and emergency stop are cleared; the motors stay off."""
    PRESS_ESTOP = 3
    """A person presses the red button."""
    RELEASE_ESTOP = 4
    """A person releases it; the robot stays stopped until it is reset."""
    FAIL = 5
    """A part of it fails."""
    SILENCE = 6
    """No joint states for some seconds."""
    MISS = 7
    """The next grasps close beside the object; `amount` says how many."""
    OBSTRUCT = 8
    """Something holds a limb for some seconds, so that it cannot follow."""
    PUT = 9
    """A person puts an object at `place`, wherever it was; not one that is in a gripper."""
    TAKE = 10
    """A person takes an object off the table."""


class EarState(IntEnum):
    """Availability of speech recognition."""

    LOADING = 0
    """The recogniser is being loaded."""
    READY = 1
    """It is ready."""
    OFF = 2
    """Text only."""


class EstopButton(IntEnum):
    """The red button."""

    UNPRESSED = 0
    """Not pressed, and the robot is not stopped by it."""
    PRESSED = 1
    """Pressed."""
    UNKNOWN = 2
    """The robot was stopped by something else."""
    RELEASED = 3
    """It was pressed and is not any more, but the robot is still stopped."""


class GateVerdict(IntEnum):
    """Why speech is acted on or not."""

    PASSED = 0
    """It is about the scene."""
    NO_WORDS = 1
    """No words were recognised."""
    OTHER_TALK = 2
    """It is about other things."""
    NO_SPEECH = 3
    """There is no speech."""
    COVERED = 4
    """The robot's own voice covers its beginning."""
    ECHO = 5
    """It is a line that the robot has just said."""


class Intent(IntEnum):
    """Codes of `Intent`."""

    INFORM = 0
    """Says something about the wanted object, or answers."""
    NONE = 1
    """Not addressed to the robot, or without content."""
    STOP = 2
    """Stop moving at once."""
    CANCEL = 3
    """Withdraw the request; with excluded groups, only what they describe ('don't get me the red one')."""
    REPEAT = 4
    """Repeat the question."""
    START_OVER = 5
    """Forget everything said and start over."""
    ASK_BACK = 6
    """Ask the robot what there is ('what colours do you have?')."""
    ASK_COUNT = 7
    """Ask how many objects the words describe ('how many cups are there?')."""
    ASK_WHICH = 8
    """Ask which objects the words describe ('what is on the shelf?')."""
    ASK_WHERE = 9
    """Ask where the objects are that the words describe."""
    ASK_WHY = 10
    """Ask for the reason of what the robot said or does."""
    ASK_STATUS = 11
    """Ask what the robot is doing."""
    ASK_HELP = 12
    """Ask what one can say to the robot."""
    GREET = 13
    """Greet."""
    THANK = 14
    """Thank."""
    PUT_BACK = 15
    """Have the delivered object put back."""
    LEAVE = 16
    """Take leave."""
    ASK_WHETHER = 17
    """Ask whether there is an object that the words describe ('is there a red mug?')."""
    CHORE = 18
    """Have the robot do something else than fetch ('wash the bowl')."""
    STOP_AND_CANCEL = 19
    """Stop moving at once, and withdraw the request ('stop, I don't want it')."""
    GO_ON = 20
    """Move again after a stop ('go on'), which words cannot bring about. An answer in the same words ('keep
    going') stands."""


class MicrophoneState(IntEnum):
    """State of the microphone of the robot's computer."""

    OFF = 0
    """There is none, or it is switched off."""
    CLOSED = 1
    """It is opened when a user asks to talk."""
    OPENING = 2
    """Its program was started and has given no sound yet."""
    LISTENING = 3
    """It listens."""
    MUTED = 4
    """It leaves out the robot's own voice."""
    BROKEN = 5
    """Its program died; another try will follow."""


class MotionInhibit(IntEnum):
    """Reason why the robot cannot move at all, the gravest of several."""

    NONE = 0
    """Nothing."""
    STOPPED = 1
    """An emergency stop holds."""
    ERROR = 2
    """A part of the robot has a fault."""
    DISABLED = 3
    """The motors are off."""
    UNHEARD = 4
    """The robot has not been heard yet, or not all of it."""
    STALE = 5
    """The measurements are too old to rely on."""
    GRIPPER = 6
    """A gripper has a fault, or is not the electric one."""
    CALIBRATING = 7
    """A gripper is being calibrated."""


class MotionPhase(IntEnum):
    """Purpose of a part of a motion."""

    CLEAR = 0
    """Away from what the arm touches, straight up; or a pause while the fingers open."""
    APPROACH = 1
    """To above the object and straight down to it."""
    CLOSE = 2
    """The fingers close."""
    LIFT = 3
    """Straight up with the object."""
    HAND_OVER = 4
    """To where the person takes the object."""
    RELEASE = 5
    """The fingers open."""
    AIM = 6
    """To where the gripper's axis passes through an object."""
    RETURN = 7
    """Back to rest."""
    TAKE = 8
    """To where the user gives an object back, and still there."""
    CARRY_BACK = 9
    """To above the place of an object that is put back."""
    LOWER = 10
    """Straight down to that place."""


class Outcome(IntEnum):
    """Outcome of an interaction."""

    DELIVERED = 0
    """An object was handed over."""
    REFUSED = 1
    """An object was handed over, and the user refused it."""
    FAILED = 2
    """The arm failed; the object is named."""
    CANCELLED = 3
    """The user withdrew the request."""
    ABANDONED = 4
    """The user fell silent, or no question helped."""
    SCENE_CHANGED = 5
    """The scene was replaced during the interaction, and none of its objects is left."""
    NOT_HERE = 6
    """The robot concluded that the wanted object is not here."""


class PickOutcome(IntEnum):
    """Outcome of a pick."""

    PENDING = 0
    """Not over yet."""
    DELIVERED = 1
    """The object was handed over."""
    UNREACHABLE = 2
    """No motion reaches it; nothing moved."""
    INTERRUPTED = 3
    """Unknown whether the object was grasped; a person must look."""
    CANCELLED = 4
    """Called off by the policy or the operator; the object was put back or never touched."""
    MISSED = 5
    """The fingers closed on nothing in every attempt; nothing is held."""
    BLOCKED = 6
    """The robot did not follow its motion, or did not arrive; a person must look."""
    PUT_BACK = 7
    """The object is back in its place."""
    VANISHED = 8
    """The object is no longer where it was seen; nothing is held."""
    KEPT = 9
    """Called off while it was held, and no way back to its place was found: the gripper keeps hold of it
    until the next order for it."""


class PickPhase(IntEnum):
    """Codes of `PickPhase`."""

    IDLE = 0
    """Nothing to do."""
    ACCEPTED = 1
    """Accepted; nothing has moved."""
    MOVING = 2
    """Moving to the object, gripper open."""
    CLOSING = 3
    """The gripper closes on the object."""
    HOLDING = 4
    """The object is held: lifted and carried to the user, or carried to its place and put down."""
    DONE = 5
    """Over; see the outcome."""
    RETURNING = 6
    """Called off while it is held: the object is carried back to its place and put down."""


class PresentationState(IntEnum):
    """Progress of a prompt."""

    SILENT = 0
    """Nothing was said yet."""
    SPEAKING = 1
    """Being said."""
    ENDED = 2
    """Said to its end; from now on an answer can be meant for it."""
    INTERRUPTED = 3
    """Broken off before its end."""


class ReceiptStatus(IntEnum):
    """Outcome of an injection."""

    ACCEPTED = 0
    """Durable; it will be applied."""
    REFUSED = 1
    """Refused; `note` says why and nothing was kept."""
    NOT_FOR_ME = 2
    """Heard, but not meant for the robot; `note` holds what was heard."""
    OVER = 3
    """A stream has ended, and everything said in it has its receipt; `note` reports what was lost."""


class Reference(IntEnum):
    """Codes of `Reference`."""

    NONE = 0
    """None."""
    OTHER = 1
    """'the other one': not the one just spoken of."""
    SAME = 2
    """'the same one again': the one delivered last."""
    SMALLER = 3
    """'the smaller one', of those that may be meant."""
    LARGER = 4
    """'the bigger one', of those that may be meant."""
    SMALLEST = 5
    """'the smallest one', of those that the words describe."""
    LARGEST = 6
    """'the biggest one', of those that the words describe."""
    ANY = 7
    """'either', 'you choose': any of those that may be meant."""
    RELATION = 8
    """'the leftmost one', 'longer than the red one': by place, order or size."""


class Response(IntEnum):
    """Codes of `Response`."""

    NONE = 0
    """Neither, or both."""
    YES = 1
    """An affirmative and no negative word."""
    NO = 2
    """A negative and no affirmative word."""
    CANNOT_TELL = 3
    """'I don't know': the user cannot tell."""
    DOES_NOT_MATTER = 4
    """'I don't care', 'either': the answer does not matter to the user."""


class Role(IntEnum):
    """Grammatical role of a value: a key of the scene file, or else guessed from the `spoken` form."""

    QUALITY = 0
    """'white': stands before a noun, has degrees."""
    KIND = 1
    """'a marker': is a noun."""
    PLACE = 2
    """'in the dishwasher': stands after the noun."""
    PART = 3
    """'with nuts', 'a green handle': what is in a thing or belongs to it; stands after the noun, and can be
    asked for as if it were the thing."""


class SecondState(IntEnum):
    """The second recogniser's part in an utterance."""

    NOT_ASKED = 0
    """There is none, or the first one was sure."""
    LATE = 1
    """It was too late."""
    HEARD = 2
    """It was heard."""


class Source(IntEnum):
    """Origin of an utterance."""

    TEXT = 0
    """Typed or injected text."""
    WAV = 1
    """A WAV file."""
    MICROPHONE = 2
    """A microphone."""
    BROWSER = 3
    """A browser's own recogniser."""
    GESTURE = 4
    """A pointing gesture, with or without words."""


class Task(IntEnum):
    """What the arm is ordered to do with an object. Both kinds of order have one numbering, the phases and
    the outcomes of a pick, and the same rules."""

    FETCH = 0
    """Fetch it from its place and hand it over."""
    PUT_BACK = 1
    """Take it from the user, where it was handed over, and put it back in its place."""


class Tristate(IntEnum):
    """The three values of a gripper's state fields."""

    FALSE = 0
    """`STATE_FALSE`."""
    TRUE = 1
    """`STATE_TRUE`."""
    UNKNOWN = 2
    """`STATE_UNKNOWN`: unknown, or not known to this gripper."""


class UiType(IntEnum):
    """Mounted end effector: `EndEffectorProperties::ui_type`."""

    NO_GRIPPER = 0
    """Nothing."""
    SUCTION_CUP = 1
    """A vacuum gripper."""
    ELECTRIC = 2
    """The electric parallel gripper."""
    PASSIVE = 3
    """Something without a motor, or a gripper of one's own."""


class Stamp(Message):
    """The sender of a message; the user header of every topic."""

    wire_name = "Stamp"
    wire_size = 24
    schema_key = "8857d7949252d28b"
    epoch: int
    """Epoch of the group's journals."""
    sent_ns: int
    """When it was sent."""
    incarnation: int
    """Incarnation of the sender; 0 for a client."""
    sequence: int
    """Number of the message among those of its writer in this topic, from 1; 0 where the sender does not
    count. A reader sees from a gap how many it has lost."""
    codes = {}
    _fields_ = [
        ("epoch", ctypes.c_uint64),  # 0
        ("sent_ns", ctypes.c_uint64),  # 8
        ("incarnation", ctypes.c_uint32),  # 16
        ("sequence", ctypes.c_uint32),  # 20
    ]


class WireQuestion(Message):
    """A `Question` on the wire."""

    wire_name = "Question"
    wire_size = 8
    schema_key = "a0c8de0a2f4eaa8d"
    kind: int
    """0 none, 1 point, 2 attribute, 3 which, 4 choice; the values of a choice, each plus 1, are the bytes of
    `object` and `value`, the lower one first, and 0 where there are fewer than four."""
    object: int
    """The object pointed at."""
    attribute: int
    """The attribute asked about."""
    value: int
    """The value asked about, its place in the attribute's list."""
    codes = {}
    _fields_ = [
        ("kind", ctypes.c_uint16),  # 0
        ("object", ctypes.c_uint16),  # 2
        ("attribute", ctypes.c_uint16),  # 4
        ("value", ctypes.c_uint16),  # 6
    ]


class WireGesture(Message):
    """A pointing gesture, or none."""

    wire_name = "Gesture"
    wire_size = 32
    schema_key = "3564b776a5b30a63"
    target_m: Array[float]
    """The point that the person points at, metres, frame `base`: x, y, z."""
    present: int
    """1 where there is a gesture, else 0."""
    reserved: Array[int]
    """Zero."""
    codes = {}
    _fields_ = [
        ("target_m", ctypes.c_double * 3),  # 0
        ("present", ctypes.c_uint8),  # 24
        ("reserved", ctypes.c_uint8 * 7),  # 25
    ]


class AskedQuestion(Message):
    """A question as it was put to the person: one presentation of a prompt."""

    wire_name = "AskedQuestion"
    wire_size = 48
    schema_key = "2a0adff7531884c8"
    prompt: int
    """`PromptId`."""
    scene: int
    """`Scene::key` of the scene that it was asked about."""
    began_ns: int
    """When its sound began."""
    ended_ns: int
    """When its sound ended or was broken off; 0 while it lasts."""
    question: WireQuestion
    """The question that was asked."""
    presentation: int
    """Which presentation of the prompt."""
    whole: int
    """1 where it was said to its end."""
    reserved: Array[int]
    """Zero."""
    codes = {}
    _fields_ = [
        ("prompt", ctypes.c_uint64),  # 0
        ("scene", ctypes.c_uint64),  # 8
        ("began_ns", ctypes.c_uint64),  # 16
        ("ended_ns", ctypes.c_uint64),  # 24
        ("question", WireQuestion),  # 32
        ("presentation", ctypes.c_uint32),  # 40
        ("whole", ctypes.c_uint8),  # 44
        ("reserved", ctypes.c_uint8 * 3),  # 45
    ]


class WireHypothesis(Message):
    """A `Hypothesis` on the wire: where its words lie in the utterance's text, and how sure it is."""

    wire_name = "Hypothesis"
    wire_size = 48
    schema_key = "d93ca23e859f455a"
    start: int
    """First byte."""
    len: int
    """Bytes."""
    weight: float
    """Probability among the hypotheses; they sum to 1."""
    confidence: Array[int]
    """Confidence of each blank-separated word: 0 (not said) to 255 (certain). Unknown for words beyond
    these."""
    codes = {}
    _fields_ = [
        ("start", ctypes.c_uint32),  # 0
        ("len", ctypes.c_uint32),  # 4
        ("weight", ctypes.c_double),  # 8
        ("confidence", ctypes.c_uint8 * CONFIDENCES_MAX),  # 16
    ]


class WireReading(Message):
    """A `Reading` on the wire."""

    wire_name = "Reading"
    wire_size = 400
    schema_key = "a59be7e903333f82"
    weight: float
    """Probability among the readings for the same question; they sum to 1."""
    base_doubt: Array[float]
    """By word of `base`: probability that it was not said."""
    excluded_doubt: Array[float]
    """By excluded group: probability that it was not meant."""
    response_doubt: float
    """Probability that the response was not given."""
    base: Array[int]
    """`WordId`s."""
    excluded: Array[Array[int]]
    """`WordId`s by group."""
    further: Array[Array[int]]
    """`WordId`s by further object."""
    excluded_len: Array[int]
    """Used words of each excluded group."""
    further_len: Array[int]
    """Used words of each further object."""
    question: int
    """The question that it is the answer to if the utterance answers that one: its place in the observation's
    `asked`, or `NO_QUESTION`."""
    response: int
    """`Response`."""
    intent: int
    """`Intent`, in its order."""
    refers: int
    """`Reference`."""
    base_count: int
    """Used entries of `base`."""
    excluded_count: int
    """Used entries of `excluded`."""
    further_count: int
    """Used entries of `further`."""
    relation: int
    """`Relation::code` of a relation in `refers`; else zero."""
    codes = {"response": Response, "intent": Intent, "refers": Reference}
    _fields_ = [
        ("weight", ctypes.c_double),  # 0
        ("base_doubt", ctypes.c_float * BASE_WORDS_MAX),  # 8
        ("excluded_doubt", ctypes.c_float * EXCLUDED_GROUPS_MAX),  # 136
        ("response_doubt", ctypes.c_float),  # 168
        ("base", ctypes.c_uint16 * BASE_WORDS_MAX),  # 172
        ("excluded", (ctypes.c_uint16 * EXCLUDED_WORDS_MAX) * EXCLUDED_GROUPS_MAX),  # 236
        ("further", (ctypes.c_uint16 * EXCLUDED_WORDS_MAX) * FURTHER_MAX),  # 332
        ("excluded_len", ctypes.c_uint8 * EXCLUDED_GROUPS_MAX),  # 380
        ("further_len", ctypes.c_uint8 * FURTHER_MAX),  # 388
        ("question", ctypes.c_uint8),  # 392
        ("response", ctypes.c_uint8),  # 393
        ("intent", ctypes.c_uint8),  # 394
        ("refers", ctypes.c_uint8),  # 395
        ("base_count", ctypes.c_uint8),  # 396
        ("excluded_count", ctypes.c_uint8),  # 397
        ("further_count", ctypes.c_uint8),  # 398
        ("relation", ctypes.c_uint8),  # 399
    ]


class Utterance(Message):
    """An accepted utterance. Speech to grounding."""

    wire_name = "Utterance"
    wire_size = 16952
    schema_key = "a9b84ed794b730c1"
    seq: int
    """`UtteranceSeq`."""
    asked: Array[AskedQuestion]
    """The latest questions whose sound had begun when the utterance was accepted, newest first."""
    gesture: WireGesture
    """Target of the pointing gesture, if any."""
    onset_ns: int
    """When the person began to speak or type."""
    end_ns: int
    """When the person had ended."""
    accepted_ns: int
    """When it was accepted."""
    source: int
    """`Source`."""
    hypothesis_count: int
    """Number of used entries of `hypotheses`; the first is the best. 0 for a gesture without words."""
    asked_count: int
    """Number of used entries of `asked`."""
    reserved: int
    """Zero."""
    from_: Text
    """Name of the person who speaks; empty: nobody in particular."""
    hypotheses: Array[WireHypothesis]
    """Recognition hypotheses, most likely first."""
    text: Text
    """The text of all hypotheses, one after another."""
    codes = {"source": Source}
    _fields_ = [
        ("seq", ctypes.c_uint64),  # 0
        ("asked", AskedQuestion * ASKED_MAX),  # 8
        ("gesture", WireGesture),  # 200
        ("onset_ns", ctypes.c_uint64),  # 232
        ("end_ns", ctypes.c_uint64),  # 240
        ("accepted_ns", ctypes.c_uint64),  # 248
        ("source", ctypes.c_uint8),  # 256
        ("hypothesis_count", ctypes.c_uint8),  # 257
        ("asked_count", ctypes.c_uint8),  # 258
        ("reserved", ctypes.c_uint8),  # 259
        ("from_", fixed_text(64)),  # 260
        ("hypotheses", WireHypothesis * HYPOTHESES_MAX),  # 328
        ("text", fixed_text(16380)),  # 568
    ]


class Observation(Message):
    """The interpretation of an utterance. Grounding to policy, one for each utterance."""

    wire_name = "Observation"
    wire_size = 13208
    schema_key = "5b9560b6ac211b48"
    seq: int
    """The utterance's `UtteranceSeq`."""
    asked: Array[AskedQuestion]
    """Of the utterance."""
    gesture: WireGesture
    """Of the utterance."""
    scene_key: int
    """`Scene::key` of the scene that it was read with."""
    onset_ns: int
    """Of the utterance."""
    end_ns: int
    """Of the utterance."""
    accepted_ns: int
    """Of the utterance."""
    grounded_ns: int
    """When it was read."""
    reading_count: int
    """Number of used entries of `readings`."""
    asked_count: int
    """Number of used entries of `asked`."""
    source: int
    """`Source` of the utterance."""
    unknown_role: int
    """`Role` of `unknown`."""
    from_: Text
    """Of the utterance."""
    readings: Array[WireReading]
    """Possible meanings: for each question asked and for none, most likely first."""
    unknown: Text
    """A word that the scene does not have, for the robot's reply ('plate'); may be empty."""
    codes = {"source": Source, "unknown_role": Role}
    _fields_ = [
        ("seq", ctypes.c_uint64),  # 0
        ("asked", AskedQuestion * ASKED_MAX),  # 8
        ("gesture", WireGesture),  # 200
        ("scene_key", ctypes.c_uint64),  # 232
        ("onset_ns", ctypes.c_uint64),  # 240
        ("end_ns", ctypes.c_uint64),  # 248
        ("accepted_ns", ctypes.c_uint64),  # 256
        ("grounded_ns", ctypes.c_uint64),  # 264
        ("reading_count", ctypes.c_uint8),  # 272
        ("asked_count", ctypes.c_uint8),  # 273
        ("source", ctypes.c_uint8),  # 274
        ("unknown_role", ctypes.c_uint8),  # 275
        ("from_", fixed_text(64)),  # 276
        ("readings", WireReading * READINGS_MAX),  # 344
        ("unknown", fixed_text(60)),  # 13144
    ]


class AppliedMark(Message):
    """The highest utterance that the belief holds. Policy to speech."""

    wire_name = "AppliedMark"
    wire_size = 8
    schema_key = "1462b9620e386d8b"
    seq: int
    """`UtteranceSeq`."""
    codes = {}
    _fields_ = [
        ("seq", ctypes.c_uint64),  # 0
    ]


class Forget(Message):
    """An order to forget what was learned about a person. Clients to policy, sent again until
    `PolicyView::forgot` has its key. `PolicyView::forgot`: PolicyView::forgot"""

    wire_name = "Forget"
    wire_size = 80
    schema_key = "d8d270a2349d4c69"
    key: int
    """Made by the client, not 0, kept through its retries."""
    person: Text
    """Name of the person."""
    reserved: Array[int]
    """Zero."""
    codes = {}
    _fields_ = [
        ("key", ctypes.c_uint64),  # 0
        ("person", fixed_text(64)),  # 8
        ("reserved", ctypes.c_uint8 * 4),  # 76
    ]


class RobotAct(Message):
    """The policy's standing decision. Policy to speech and arm, sent again until superseded."""

    wire_name = "RobotAct"
    wire_size = 320
    schema_key = "0b532968dd30c91a"
    act: int
    """`ActId`."""
    interaction: int
    """`InteractionId`."""
    prompt: int
    """`PromptId` of an `Ask` or `Say`."""
    presentation: int
    """Number of times the prompt has been requested: 1, and one more for each repetition."""
    kind: int
    """`ActKind`."""
    in_words: int
    """1 where the question names its object in words alone, as 'do you want the blue pen?' does: the arm does
    not point at it. Else 0."""
    reserved: Array[int]
    """Zero."""
    question: WireQuestion
    """The question of an `Ask`; of a `Pick` or `PutBack`, its object: it can be denied; of a `Say`, the
    object that can be refused or confirmed, if any."""
    object: int
    """`ObjectId` of a `Pick` or `PutBack`."""
    attempt: int
    """Attempt of a `Pick` or `PutBack`."""
    scene_key: int
    """`Scene::key` of the scene whose objects and attributes are meant."""
    decided_ns: int
    """When it was decided."""
    utterance: int
    """The utterance that it answers, 0 for none."""
    text: Text
    """Text to say."""
    codes = {"kind": ActKind}
    _fields_ = [
        ("act", ctypes.c_uint64),  # 0
        ("interaction", ctypes.c_uint64),  # 8
        ("prompt", ctypes.c_uint64),  # 16
        ("presentation", ctypes.c_uint32),  # 24
        ("kind", ctypes.c_uint8),  # 28
        ("in_words", ctypes.c_uint8),  # 29
        ("reserved", ctypes.c_uint8 * 2),  # 30
        ("question", WireQuestion),  # 32
        ("object", ctypes.c_uint32),  # 40
        ("attempt", ctypes.c_uint32),  # 44
        ("scene_key", ctypes.c_uint64),  # 48
        ("decided_ns", ctypes.c_uint64),  # 56
        ("utterance", ctypes.c_uint64),  # 64
        ("text", fixed_text(244)),  # 72
    ]


class Presented(Message):
    """The latest prompt that was said. Speech to policy."""

    wire_name = "Presented"
    wire_size = 32
    schema_key = "fbc66b0d2815aa74"
    prompt: int
    """`PromptId`."""
    started_ns: int
    """When its sound began."""
    ended_ns: int
    """When its sound ended, 0 while it lasts."""
    presentation: int
    """Which presentation of the prompt."""
    state: int
    """`PresentationState`."""
    reserved: Array[int]
    """Zero."""
    codes = {"state": PresentationState}
    _fields_ = [
        ("prompt", ctypes.c_uint64),  # 0
        ("started_ns", ctypes.c_uint64),  # 8
        ("ended_ns", ctypes.c_uint64),  # 16
        ("presentation", ctypes.c_uint32),  # 24
        ("state", ctypes.c_uint8),  # 28
        ("reserved", ctypes.c_uint8 * 3),  # 29
    ]


class Activity(Message):
    """Speech activity of a user. Speech to policy, which stays silent meanwhile."""

    wire_name = "Activity"
    wire_size = 16
    schema_key = "e0bdb0b6578b377d"
    onset_ns: int
    """Start of the user's speech, 0 while there is none."""
    pending: int
    """Sounds that are still being recognised, and utterances that are not yet applied."""
    ear: int
    """`EarState`."""
    reserved: Array[int]
    """Zero."""
    codes = {"ear": EarState}
    _fields_ = [
        ("onset_ns", ctypes.c_uint64),  # 0
        ("pending", ctypes.c_uint32),  # 8
        ("ear", ctypes.c_uint8),  # 12
        ("reserved", ctypes.c_uint8 * 3),  # 13
    ]


class Hearing(Message):
    """Quality of the robot's hearing. Speech to clients."""

    wire_name = "Hearing"
    wire_size = 240
    schema_key = "7248920805776846"
    onset_ns: int
    """When the last utterance began to be heard, 0 for none."""
    level_db: float
    """Loudness of the microphone over the last fifth of a second, decibels below full scale, -100 where
    nothing is known."""
    snr_db: float
    """Level of the last utterance above the noise around it, decibels, 0 to 60."""
    restarts: int
    """Times that the microphone's program died."""
    dropped: int
    """Utterances lost because too much was said at a time."""
    pending: int
    """Utterances that are being spoken or recognised."""
    ear: int
    """`EarState`."""
    microphone: int
    """`MicrophoneState`."""
    measured: int
    """1 where the last utterance was spoken (`snr_db` counts)."""
    reserved: int
    """Zero."""
    note: Text
    """The program that records, or why there is none."""
    codes = {"ear": EarState, "microphone": MicrophoneState}
    _fields_ = [
        ("onset_ns", ctypes.c_uint64),  # 0
        ("level_db", ctypes.c_float),  # 8
        ("snr_db", ctypes.c_float),  # 12
        ("restarts", ctypes.c_uint32),  # 16
        ("dropped", ctypes.c_uint32),  # 20
        ("pending", ctypes.c_uint32),  # 24
        ("ear", ctypes.c_uint8),  # 28
        ("microphone", ctypes.c_uint8),  # 29
        ("measured", ctypes.c_uint8),  # 30
        ("reserved", ctypes.c_uint8),  # 31
        ("note", fixed_text(204)),  # 32
    ]


class Partial(Message):
    """Interim result of an utterance that is still being spoken; the receipt holds the final one. Speech to
    clients."""

    wire_name = "Partial"
    wire_size = 544
    schema_key = "d3fca29dd0fc18fa"
    stream: Array[int]
    """`RequestKey` that the utterance's receipt will have."""
    onset_ns: int
    """When the person began to speak."""
    number: int
    """Rises with every message of this incarnation."""
    segment: int
    """The `segment` that the utterance's receipt will have."""
    over: int
    """1 where the utterance has its result; the text is empty then."""
    reserved: Array[int]
    """Zero."""
    text: Text
    """The words so far; empty until there are any."""
    codes = {}
    _fields_ = [
        ("stream", ctypes.c_uint8 * 16),  # 0
        ("onset_ns", ctypes.c_uint64),  # 16
        ("number", ctypes.c_uint64),  # 24
        ("segment", ctypes.c_uint32),  # 32
        ("over", ctypes.c_uint8),  # 36
        ("reserved", ctypes.c_uint8 * 3),  # 37
        ("text", fixed_text(500)),  # 40
    ]


class AudioChunk(Message):
    """A piece of a stream of sound. Clients to speech. Chunks may be lost: the robot hears silence then."""

    wire_name = "AudioChunk"
    wire_size = 3248
    schema_key = "4d400d4fde189f11"
    stream: Array[int]
    """`RequestKey` of the stream, made by the client."""
    number: int
    """Number of the chunk in its stream, from 0."""
    first_sample: int
    """Samples of the stream before this chunk."""
    taken_ns: int
    """When its first sample was taken, monotonic clock."""
    count: int
    """Number of used entries of `samples`."""
    flags: int
    """Sum of `AudioChunk::END`, `AudioChunk::HELD` and `AudioChunk::ECHO_FREE`."""
    reserved: Array[int]
    """Zero."""
    samples: Array[int]
    """The sound."""
    codes = {}
    _fields_ = [
        ("stream", ctypes.c_uint8 * 16),  # 0
        ("number", ctypes.c_uint64),  # 16
        ("first_sample", ctypes.c_uint64),  # 24
        ("taken_ns", ctypes.c_uint64),  # 32
        ("count", ctypes.c_uint32),  # 40
        ("flags", ctypes.c_uint8),  # 44
        ("reserved", ctypes.c_uint8 * 3),  # 45
        ("samples", ctypes.c_int16 * CHUNK_SAMPLES_MAX),  # 48
    ]


class Receipt(Message):
    """Answer to an injection, or what a microphone heard. Speech to clients."""

    wire_name = "Receipt"
    wire_size = 976
    schema_key = "182b8dea5739e0ca"
    key: Array[int]
    """`RequestKey` of the injection; one of its own for what a microphone heard."""
    seq: int
    """`UtteranceSeq` given, 0 where refused."""
    segment: int
    """Which piece of the sound, 0 for text; of a stream the tenth of a second in which it began."""
    segments: int
    """Pieces in all; of a stream 0, and with `ReceiptStatus::Over` its utterances."""
    onset_ns: int
    """When the person began to speak; 0 where nothing was heard."""
    end_ns: int
    """When the person had ended."""
    confidence: float
    """Probability of the text heard among all that it may have been, 0 to 1; 1 for text."""
    snr_db: float
    """Level of the speech above the noise around it, decibels, 0 to 60; 0 for text."""
    gate_score: float
    """How much of it is about the scene, 0 to 1, where the verdict is `GateVerdict::OtherTalk`."""
    status: int
    """`ReceiptStatus`."""
    source: int
    """`Source`."""
    verdict: int
    """`GateVerdict` on speech."""
    second: int
    """`SecondState`."""
    note: Text
    """The text heard, or why it was refused."""
    first_text: Text
    """Best words of the first recogniser; empty for text, and after a restart."""
    second_text: Text
    """Words of the second recogniser, where it was heard."""
    codes = {"status": ReceiptStatus, "source": Source, "verdict": GateVerdict, "second": SecondState}
    _fields_ = [
        ("key", ctypes.c_uint8 * 16),  # 0
        ("seq", ctypes.c_uint64),  # 16
        ("segment", ctypes.c_uint32),  # 24
        ("segments", ctypes.c_uint32),  # 28
        ("onset_ns", ctypes.c_uint64),  # 32
        ("end_ns", ctypes.c_uint64),  # 40
        ("confidence", ctypes.c_float),  # 48
        ("snr_db", ctypes.c_float),  # 52
        ("gate_score", ctypes.c_float),  # 56
        ("status", ctypes.c_uint8),  # 60
        ("source", ctypes.c_uint8),  # 61
        ("verdict", ctypes.c_uint8),  # 62
        ("second", ctypes.c_uint8),  # 63
        ("note", fixed_text(500)),  # 64
        ("first_text", fixed_text(200)),  # 568
        ("second_text", fixed_text(200)),  # 772
    ]


class ArmStatus(Message):
    """State of the arm executor. Arm to policy and speech."""

    wire_name = "ArmStatus"
    wire_size = 48
    schema_key = "8b147729fca6b4f3"
    interaction: int
    """`InteractionId` of the latest pick."""
    aimed_act: int
    """`ActId` of the pointing question that the gripper aims at, 0 for none."""
    attempt: int
    """Attempt of the latest pick."""
    object: int
    """`ObjectId` of the latest pick."""
    phase: int
    """`PickPhase` of the latest pick."""
    outcome: int
    """`PickOutcome` of the latest pick."""
    stopped: int
    """1 while the motion stop is latched."""
    moving: int
    """1 while any joint moves."""
    hindrance: int
    """`MotionInhibit`."""
    task: int
    """`Task` of the latest pick."""
    reserved: Array[int]
    """Zero."""
    remaining_s: float
    """Expected seconds until the pick is done, 0 where none runs."""
    stop: int
    """`StopId` of the motion stop in force, 0 for none: a release names it."""
    codes = {"phase": PickPhase, "outcome": PickOutcome, "hindrance": MotionInhibit, "task": Task}
    _fields_ = [
        ("interaction", ctypes.c_uint64),  # 0
        ("aimed_act", ctypes.c_uint64),  # 8
        ("attempt", ctypes.c_uint32),  # 16
        ("object", ctypes.c_uint32),  # 20
        ("phase", ctypes.c_uint8),  # 24
        ("outcome", ctypes.c_uint8),  # 25
        ("stopped", ctypes.c_uint8),  # 26
        ("moving", ctypes.c_uint8),  # 27
        ("hindrance", ctypes.c_uint8),  # 28
        ("task", ctypes.c_uint8),  # 29
        ("reserved", ctypes.c_uint8 * 2),  # 30
        ("remaining_s", ctypes.c_double),  # 32
        ("stop", ctypes.c_uint64),  # 40
    ]


class JointStates(Message):
    """Joint states, at 100 Hz while the arm is busy, in the order of `JOINT_STATE_NAMES`. Arm to clients."""

    wire_name = "JointStates"
    wire_size = 432
    schema_key = "b61683a36126fd0b"
    at_ns: int
    """When the joints were so."""
    position: Array[float]
    """Position, radians."""
    velocity: Array[float]
    """Velocity, radians a second."""
    effort: Array[float]
    """Effort, newton metres; the kinematic arm has none."""
    gripper_percent: Array[float]
    """Opening of the left and right gripper, percent of its range."""
    codes = {}
    _fields_ = [
        ("at_ns", ctypes.c_uint64),  # 0
        ("position", ctypes.c_double * JOINT_STATE_LEN),  # 8
        ("velocity", ctypes.c_double * JOINT_STATE_LEN),  # 144
        ("effort", ctypes.c_double * JOINT_STATE_LEN),  # 280
        ("gripper_percent", ctypes.c_double * 2),  # 416
    ]


class JointCommand(Message):
    """`baxter_core_msgs/JointCommand`: what the joints of one limb are to do now. A limb that has heard none
    for 0.2 s (`joint_command_timeout`) goes back to holding its position."""

    wire_name = "JointCommand"
    wire_size = 288
    schema_key = "aeb1a9869cb128a1"
    mode: int
    """`JointMode`."""
    len: int
    """Number of used entries below."""
    command: Array[float]
    """Radians or rad/s, after the mode."""
    names: Array[Text]
    """The joints' names, in the order of `command`."""
    codes = {}
    _fields_ = [
        ("mode", ctypes.c_int32),  # 0
        ("len", ctypes.c_uint32),  # 4
        ("command", ctypes.c_double * LIMB_JOINTS),  # 8
        ("names", fixed_text(28) * LIMB_JOINTS),  # 64
    ]


class JointState(Message):
    """`sensor_msgs/JointState`: what was measured, by name. Baxter sends its 17 joints in alphabetical order,
    and the joint of an electric gripper's finger in messages of their own, so readers look for names and
    never for places."""

    wire_name = "JointState"
    wire_size = 968
    schema_key = "5a68e470198c953b"
    stamp_ns: int
    """`header.stamp`, monotonic clock."""
    len: int
    """Number of used entries below."""
    reserved: int
    """Zero."""
    name: Array[Text]
    """The joints' names."""
    position: Array[float]
    """Positions, radians; metres for a finger."""
    velocity: Array[float]
    """Velocities, rad/s; m/s for a finger."""
    effort: Array[float]
    """Torques, newton metres; newtons for a finger."""
    codes = {}
    _fields_ = [
        ("stamp_ns", ctypes.c_uint64),  # 0
        ("len", ctypes.c_uint32),  # 8
        ("reserved", ctypes.c_uint32),  # 12
        ("name", fixed_text(28) * JOINTS_MAX),  # 16
        ("position", ctypes.c_double * JOINTS_MAX),  # 560
        ("velocity", ctypes.c_double * JOINTS_MAX),  # 696
        ("effort", ctypes.c_double * JOINTS_MAX),  # 832
    ]


class JointTrajectoryPoint(Message):
    """`trajectory_msgs/JointTrajectoryPoint` on `inverse_dynamics_command`: where the commanded motion is,
    how fast, and how it accelerates, joints in the order s0, s1, e0, e1, w0, w1, w2. Feed-forward: the robot
    computes the torques that this takes and lags less."""

    wire_name = "JointTrajectoryPoint"
    wire_size = 176
    schema_key = "762a70a65dadbe77"
    positions: Array[float]
    """Radians."""
    velocities: Array[float]
    """rad/s."""
    accelerations: Array[float]
    """rad/s²."""
    time_from_start_s: float
    """Seconds since the motion began."""
    codes = {}
    _fields_ = [
        ("positions", ctypes.c_double * LIMB_JOINTS),  # 0
        ("velocities", ctypes.c_double * LIMB_JOINTS),  # 56
        ("accelerations", ctypes.c_double * LIMB_JOINTS),  # 112
        ("time_from_start_s", ctypes.c_double),  # 168
    ]


class SpeedRatio(Message):
    """`std_msgs/Float64` on `set_speed_ratio`: the share of its greatest velocity that a limb may use in
    position mode; 0.3 until the first message."""

    wire_name = "SpeedRatio"
    wire_size = 8
    schema_key = "49de834c30d97b0b"
    data: float
    """0 to 1."""
    codes = {}
    _fields_ = [
        ("data", ctypes.c_double),  # 0
    ]


class EndpointState(Message):
    """`baxter_core_msgs/EndpointState`: the tip of `<limb>_gripper`."""

    wire_name = "EndpointState"
    wire_size = 160
    schema_key = "3fddff69cb12608f"
    stamp_ns: int
    """`header.stamp`, monotonic clock."""
    pose: Array[float]
    """Position in `base`, metres, and orientation, quaternion x, y, z, w."""
    twist: Array[float]
    """Linear velocity, m/s, and angular velocity, rad/s, axes of `base`."""
    wrench: Array[float]
    """Force, newtons, and torque, newton metres."""
    codes = {}
    _fields_ = [
        ("stamp_ns", ctypes.c_uint64),  # 0
        ("pose", ctypes.c_double * 7),  # 8
        ("twist", ctypes.c_double * 6),  # 64
        ("wrench", ctypes.c_double * 6),  # 112
    ]


class EndEffectorCommand(Message):
    """`baxter_core_msgs/EndEffectorCommand`."""

    wire_name = "EndEffectorCommand"
    wire_size = 136
    schema_key = "47ba4d74164ce7d6"
    id: int
    """The gripper's own number, from its state."""
    sequence: int
    """Comes back in the state once the command is handled."""
    command: Text
    """`calibrate`, `go`, `grip`, `release`, `stop` or `configure`."""
    args: Text
    """JSON; for `go` as `{'position': 50.0}`, for `configure` as `{'holding_force': 100.0}`."""
    sender: Text
    """Comes back in the state once the command is handled."""
    codes = {}
    _fields_ = [
        ("id", ctypes.c_uint32),  # 0
        ("sequence", ctypes.c_uint32),  # 4
        ("command", fixed_text(28)),  # 8
        ("args", fixed_text(60)),  # 40
        ("sender", fixed_text(28)),  # 104
    ]


class EndEffectorState(Message):
    """`baxter_core_msgs/EndEffectorState`. The bytes are `Tristate`s."""

    wire_name = "EndEffectorState"
    wire_size = 96
    schema_key = "5ad5059d9701b48d"
    timestamp_ns: int
    """When the state was so, monotonic clock."""
    id: int
    """The gripper's own number."""
    enabled: int
    """True if it is switched on."""
    calibrated: int
    """True if it has been calibrated."""
    ready: int
    """True if it accepts commands."""
    moving: int
    """True if the fingers are moving."""
    gripping: int
    """True if the fingers stopped at something: the force threshold was met on the way."""
    missed: int
    """True if the fingers came to the end of a command without meeting anything."""
    error: int
    """True if it has a fault; it has to be reset then."""
    reverse: int
    """True if it grips by opening."""
    position: float
    """Percent: 0 closed, 100 open."""
    force: float
    """Percent of the greatest force."""
    command_sequence: int
    """Sequence number of the last command that was handled, or `NO_SEQUENCE`."""
    command: Text
    """The last command."""
    command_sender: Text
    """The sender."""
    codes = {"enabled": Tristate, "calibrated": Tristate, "ready": Tristate, "moving": Tristate, "gripping": Tristate, "missed": Tristate, "error": Tristate, "reverse": Tristate}
    _fields_ = [
        ("timestamp_ns", ctypes.c_uint64),  # 0
        ("id", ctypes.c_uint32),  # 8
        ("enabled", ctypes.c_uint8),  # 12
        ("calibrated", ctypes.c_uint8),  # 13
        ("ready", ctypes.c_uint8),  # 14
        ("moving", ctypes.c_uint8),  # 15
        ("gripping", ctypes.c_uint8),  # 16
        ("missed", ctypes.c_uint8),  # 17
        ("error", ctypes.c_uint8),  # 18
        ("reverse", ctypes.c_uint8),  # 19
        ("position", ctypes.c_float),  # 20
        ("force", ctypes.c_float),  # 24
        ("command_sequence", ctypes.c_uint32),  # 28
        ("command", fixed_text(28)),  # 32
        ("command_sender", fixed_text(28)),  # 64
    ]


class EndEffectorProperties(Message):
    """`baxter_core_msgs/EndEffectorProperties`: what is mounted. Text fields beyond product and serial number
    stay behind: nothing here depends on them."""

    wire_name = "EndEffectorProperties"
    wire_size = 176
    schema_key = "3cecfb4e9a325ced"
    id: int
    """The gripper's own number."""
    ui_type: int
    """`UiType`."""
    has_calibration: int
    """1 if it has to be calibrated."""
    controls_grip: int
    """1 if it obeys `grip` and `release`."""
    senses_grip: int
    """1 if it feels what it grips."""
    reverses_grip: int
    """1 if it can grip by opening."""
    controls_force: int
    """1 if its force can be set."""
    senses_force: int
    """1 if it measures its force."""
    controls_position: int
    """1 if it obeys `go`."""
    senses_position: int
    """1 if it measures its position."""
    reserved: Array[int]
    """Zero."""
    manufacturer: Text
    """The manufacturer."""
    product: Text
    """The product name."""
    serial_number: Text
    """Its serial number."""
    codes = {"ui_type": UiType}
    _fields_ = [
        ("id", ctypes.c_uint32),  # 0
        ("ui_type", ctypes.c_uint8),  # 4
        ("has_calibration", ctypes.c_uint8),  # 5
        ("controls_grip", ctypes.c_uint8),  # 6
        ("senses_grip", ctypes.c_uint8),  # 7
        ("reverses_grip", ctypes.c_uint8),  # 8
        ("controls_force", ctypes.c_uint8),  # 9
        ("senses_force", ctypes.c_uint8),  # 10
        ("controls_position", ctypes.c_uint8),  # 11
        ("senses_position", ctypes.c_uint8),  # 12
        ("reserved", ctypes.c_uint8 * 3),  # 13
        ("manufacturer", fixed_text(60)),  # 16
        ("product", fixed_text(60)),  # 80
        ("serial_number", fixed_text(28)),  # 144
    ]


class AssemblyState(Message):
    """`baxter_core_msgs/AssemblyState` on `/robot/state`."""

    wire_name = "AssemblyState"
    wire_size = 8
    schema_key = "c8e08929b466579e"
    ready: int
    """1 if it is enabled and takes commands: not homing, for example."""
    enabled: int
    """1 if its motors are on."""
    stopped: int
    """1 while an emergency stop holds, until the robot is reset."""
    error: int
    """1 if a part of it has a fault."""
    estop_button: int
    """`EstopButton`."""
    estop_source: int
    """Cause of the stop: 0 none, 1 a person, 2 unknown, 3 a joint's fault, 4 its computer."""
    reserved: Array[int]
    """Zero."""
    codes = {"estop_button": EstopButton}
    _fields_ = [
        ("ready", ctypes.c_uint8),  # 0
        ("enabled", ctypes.c_uint8),  # 1
        ("stopped", ctypes.c_uint8),  # 2
        ("error", ctypes.c_uint8),  # 3
        ("estop_button", ctypes.c_uint8),  # 4
        ("estop_source", ctypes.c_uint8),  # 5
        ("reserved", ctypes.c_uint8 * 2),  # 6
    ]


class Drill(Message):
    """Something that happens to the simulated robot. Clients to the simulated robot; a real one has no such
    topic."""

    wire_name = "Drill"
    wire_size = 64
    schema_key = "e7e4101d0e5c7dab"
    key: int
    """Made by the client; a drill that comes twice happens once."""
    amount: float
    """Seconds or a number, after the kind."""
    scene_key: int
    """Key of the scene file that `object` is from."""
    place: Array[float]
    """Where the object is put: centre in frame `base`, metres, and yaw, radians."""
    object: int
    """Which object of the scene file is put or taken."""
    kind: int
    """`DrillKind`."""
    reserved: Array[int]
    """Zero."""
    codes = {"kind": DrillKind}
    _fields_ = [
        ("key", ctypes.c_uint64),  # 0
        ("amount", ctypes.c_double),  # 8
        ("scene_key", ctypes.c_uint64),  # 16
        ("place", ctypes.c_double * 4),  # 24
        ("object", ctypes.c_uint16),  # 56
        ("kind", ctypes.c_uint8),  # 58
        ("reserved", ctypes.c_uint8 * 5),  # 59
    ]


ObjectId = int
ObjectId_ENCODING = encoding.UNSIGNED


AttributeId = int
AttributeId_ENCODING = encoding.UNSIGNED


ValueId = int
ValueId_ENCODING = encoding.UNSIGNED


class Question:
    """A `Question` on the wire."""


@encoding.struct()
@dataclass(frozen=True)
class QuestionNone(Question):
    """Nothing has been asked yet."""


@encoding.struct(
    object=ObjectId_ENCODING,
)
@dataclass(frozen=True)
class QuestionPoint(Question):
    """'This one?', pointing at the object."""

    object: ObjectId
    """The object pointed at."""


@encoding.struct(
    attribute=AttributeId_ENCODING,
    value=ValueId_ENCODING,
)
@dataclass(frozen=True)
class QuestionAttribute(Question):
    """'Is its k v?': yes or no."""

    attribute: AttributeId
    """The attribute asked about."""
    value: ValueId
    """The value asked about, its place in the attribute's list."""


@encoding.struct(
    attribute=AttributeId_ENCODING,
)
@dataclass(frozen=True)
class QuestionWhich(Question):
    """'What is its k?': open."""

    attribute: AttributeId
    """The attribute asked about."""


@encoding.struct(
    attribute=AttributeId_ENCODING,
    value=encoding.Sequence(ValueId_ENCODING),
)
@dataclass(frozen=True)
class QuestionChoice(Question):
    """'v, w or x?': which of these values of k."""

    attribute: AttributeId
    """The attribute asked about."""
    value: list[ValueId]
    """The value asked about, its place in the attribute's list."""


Question_ENCODING = encoding.Variants({0: QuestionNone, 1: QuestionPoint, 2: QuestionAttribute, 3: QuestionWhich, 4: QuestionChoice})


class Action:
    """An action."""


@encoding.struct()
@dataclass(frozen=True)
class ActionWait(Action):
    """Do nothing for a turn."""


@encoding.struct(
    question=Question_ENCODING,
)
@dataclass(frozen=True)
class ActionAsk(Action):
    """Ask."""

    question: Question


@encoding.struct(
    object=ObjectId_ENCODING,
)
@dataclass(frozen=True)
class ActionPick(Action):
    """Fetch the object; this ends the interaction."""

    object: ObjectId


Action_ENCODING = encoding.Variants({0: ActionWait, 1: ActionAsk, 2: ActionPick})


@encoding.struct(
    prompt=encoding.UNSIGNED,
    presentation=encoding.UNSIGNED,
    share=encoding.F64,
)
@dataclass(kw_only=True)
class QuestionShare:
    """Share of one presentation of a question in an utterance."""

    prompt: int
    """The prompt."""
    presentation: int
    """Which presentation of it."""
    share: float
    """Probability that the utterance answers it."""


@encoding.struct(
    utterance=encoding.UNSIGNED,
    questions=encoding.Sequence(encoding.Nested(QuestionShare)),
    none=encoding.F64,
)
@dataclass(kw_only=True)
class Attributed:
    """The questions that an utterance was attributed to."""

    utterance: int
    """The utterance; 0 before the first."""
    questions: list[QuestionShare]
    """Probability that it answers each presentation of a question, where that is above 0."""
    none: float
    """Probability that it answers no question."""


@encoding.struct(
    track=encoding.STR,
    classes=encoding.Sequence(encoding.Tuple(encoding.STR, encoding.F64)),
    attributes=encoding.Sequence(encoding.Tuple(encoding.STR, encoding.Sequence(encoding.Tuple(encoding.STR, encoding.F64)))),
    xyz=encoding.Fixed(encoding.F64, 3),
    yaw=encoding.F64,
    variances=encoding.Fixed(encoding.F64, 4),
)
@dataclass(kw_only=True)
class Detection:
    """One object in a look."""

    track: str
    """Name under which the source follows the object, or the number of its marker; empty if it has none."""
    classes: list[tuple[str, float]]
    """Names of objects in the scene file with probabilities: what it is taken for."""
    attributes: list[tuple[str, list[tuple[str, float]]]]
    """Values seen directly, by attribute, with probabilities."""
    xyz: list[float]
    """Centre, metres."""
    yaw: float
    """Rotation about the vertical, radians."""
    variances: list[float]
    """Variances of x, y, z (m²) and of the yaw (rad²); zero: not stated."""


@encoding.struct(
    at_ns=encoding.UNSIGNED,
    whole=encoding.BOOL,
    seen=encoding.Sequence(encoding.Nested(Detection)),
)
@dataclass(kw_only=True)
class Look:
    """One look of a camera."""

    at_ns: int
    """When it was taken, monotonic clock, nanoseconds; 0: when it arrives."""
    whole: bool
    """Whether it shows all that the source sees, so that what it does not show was missed."""
    seen: list[Detection]
    """What it shows."""


class Change:
    """What a source reports of the table."""


@encoding.struct(
    look=encoding.Nested(Look),
)
@dataclass(frozen=True)
class ChangeLook(Change):
    """A look at the table."""

    look: Look


@encoding.struct(
    detection=encoding.Nested(Detection),
)
@dataclass(frozen=True)
class ChangeAdd(Change):
    """An object is there from now on. It is not looked for until it was seen."""

    detection: Detection


@encoding.struct(
    object=encoding.STR,
    xyz=encoding.Fixed(encoding.F64, 3),
    yaw=encoding.F64,
)
@dataclass(frozen=True)
class ChangeMove(Change):
    """The object of that name or number is somewhere else."""

    object: str
    """Name or number."""
    xyz: list[float]
    """Centre, metres."""
    yaw: float
    """Rotation about the vertical, radians."""


@encoding.struct(
    object=encoding.STR,
)
@dataclass(frozen=True)
class ChangeRemove(Change):
    """The object of that name or number is gone."""

    object: str
    """Name or number."""


Change_ENCODING = encoding.Variants({0: ChangeLook, 1: ChangeAdd, 2: ChangeMove, 3: ChangeRemove})


@encoding.struct(
    key=encoding.UNSIGNED,
    object=encoding.UNSIGNED,
    refusal=encoding.STR,
)
@dataclass(kw_only=True)
class ChangeAnswer:
    """What became of a change by hand."""

    key: int
    """Its key."""
    object: int
    """The object's number."""
    refusal: str
    """Why it was refused; empty if it was not."""


@encoding.struct(
    interaction=encoding.UNSIGNED,
    object=encoding.UNSIGNED,
    until_ns=encoding.UNSIGNED,
)
@dataclass(kw_only=True)
class Delivery:
    """A hand-over that can be refused for a while."""

    interaction: int
    """The interaction that ended with it."""
    object: int
    """The object, by its number."""
    until_ns: int
    """End of the time for a refusal, monotonic clock."""


@encoding.struct(
    interaction=encoding.UNSIGNED,
    object=encoding.Optional(ObjectId_ENCODING),
    name=encoding.Optional(encoding.STR),
    outcome=encoding.Codes(Outcome),
    questions=encoding.UNSIGNED,
    seconds=encoding.F64,
    utterances=encoding.Fixed(encoding.UNSIGNED, 2),
)
@dataclass(kw_only=True)
class Ended:
    """An interaction that has ended."""

    interaction: int
    """Its number."""
    object: ObjectId | None
    """The object that was picked or tried, numbered as in the scene of that time."""
    name: str | None
    """That object's name."""
    outcome: Outcome
    """Its outcome."""
    questions: int
    """Questions asked, repetitions not counted."""
    seconds: float
    """Seconds from the first utterance to the end."""
    utterances: list[int]
    """First and last utterance."""


@encoding.struct(
    text=encoding.STR,
    weight=encoding.F64,
    word_confidence=encoding.Sequence(encoding.F32),
)
@dataclass(kw_only=True)
class Hypothesis:
    """One recognised wording of an utterance."""

    text: str
    """The words."""
    weight: float
    """Relative weight among the hypotheses, above 0."""
    word_confidence: list[float]
    """Probability of each blank-separated word, 0 to 1. Words beyond the end are certain."""


class Sound:
    """A client's input."""


@encoding.struct(
    value=encoding.STR,
)
@dataclass(frozen=True)
class SoundText(Sound):
    """Written words."""

    value: str


@encoding.struct(
    value=encoding.STR,
)
@dataclass(frozen=True)
class SoundWav(Sound):
    """A WAV file, absolute path."""

    value: str


@encoding.struct(
    target_m=encoding.Fixed(encoding.F64, 3),
    words=encoding.STR,
)
@dataclass(frozen=True)
class SoundPoint(Sound):
    """A pointing gesture, with written words or without."""

    target_m: list[float]
    """The point that is pointed at, metres, frame `base`."""
    words: str
    """Accompanying text; may be empty."""


@encoding.struct(
    longest_s=encoding.F64,
)
@dataclass(frozen=True)
class SoundTalk(Sound):
    """Speech into the microphone of the robot's computer from now on: one utterance."""

    longest_s: float
    """Longest wait for its end, seconds."""


@encoding.struct(
    hypotheses=encoding.Sequence(encoding.Nested(Hypothesis)),
)
@dataclass(frozen=True)
class SoundTranscript(Sound):
    """Speech that another recogniser has recognised already, a browser's say."""

    hypotheses: list[Hypothesis]
    """Hypotheses: text, weight above 0 (their sum need not be 1), and the confidence of each blank-separated
    word, 0 to 1; words beyond the end are certain."""


Sound_ENCODING = encoding.Variants({0: SoundText, 1: SoundWav, 2: SoundPoint, 3: SoundTalk, 4: SoundTranscript})


@encoding.struct(
    key=encoding.Bytes(16),
    onset_ns=encoding.UNSIGNED,
    end_ns=encoding.UNSIGNED,
    seen_prompt=encoding.UNSIGNED,
    from_=encoding.STR,
    sound=Sound_ENCODING,
)
@dataclass(kw_only=True)
class Injection:
    """Something that a client gives to the speech service to hear. Clients to speech; sent again with the
    same key until its receipt arrives."""

    key: bytes
    """Made by the client, kept through its retries."""
    onset_ns: int
    """When the person began to speak or type, monotonic clock; 0: when it arrives."""
    end_ns: int
    """When the person had ended, monotonic clock; 0: when it arrives. Of a recording it is found out."""
    seen_prompt: int
    """The latest prompt that the user was shown before, as text or sound; 0: not known. If it is a question,
    an answer is to this one, whether or not the robot's own voice has begun it; otherwise to no later one."""
    from_: str
    """Name of the person who types or points, printable and of at most 64 bytes; empty or `guest`: nobody in
    particular, of whom nothing is learned. Of sound nobody is known."""
    sound: Sound
    """Text to be heard."""


Injection.wire_name, Injection.schema_key = "Injection", "4c4f7035bc34a0cc"


@encoding.struct(
    number=ObjectId_ENCODING,
    name=encoding.STR,
    classes=encoding.Sequence(encoding.Tuple(encoding.STR, encoding.F64)),
    attributes=encoding.Sequence(encoding.Tuple(encoding.STR, encoding.Sequence(encoding.Tuple(encoding.STR, encoding.F64)))),
    xyz=encoding.Fixed(encoding.F64, 3),
    yaw=encoding.F64,
    seen_by=encoding.Sequence(encoding.STR),
    taken=encoding.BOOL,
)
@dataclass(kw_only=True)
class Perceived:
    """An object on the table as it was perceived."""

    number: ObjectId
    """Its number: never reused, and never below the number of objects in the scene file, so that it is never
    taken for one of those."""
    name: str
    """Its name, unique and never reused: the class that it was first taken for and its number, e.g.
    `white2-9`."""
    classes: list[tuple[str, float]]
    """What it was recognised as: names of objects in the scene file with their probabilities."""
    attributes: list[tuple[str, list[tuple[str, float]]]]
    """Values perceived directly, by attribute: each value's name with its probability. They replace what
    follows from the classes."""
    xyz: list[float]
    """Centre in frame `base`, metres."""
    yaw: float
    """Rotation about the vertical, radians."""
    seen_by: list[str]
    """Names of the sources that have seen it, so that it is missed where they look and do not."""
    taken: bool
    """Whether it was handed to a person, who may still refuse it or have it put back."""


@encoding.struct(
    phase=encoding.Codes(MotionPhase),
    points_m=encoding.Sequence(encoding.Fixed(encoding.F64, 3)),
    t_s=encoding.Sequence(encoding.F64),
)
@dataclass(kw_only=True)
class PhaseWay:
    """The gripper's way in one phase."""

    phase: MotionPhase
    """Purpose of the phase."""
    points_m: list[list[float]]
    """Position of the point between the finger tips, metres, frame `base`."""
    t_s: list[float]
    """When it is there, seconds since the motion began; as many as there are points."""


@encoding.struct(
    scene_key=encoding.UNSIGNED,
    applied=encoding.UNSIGNED,
    interaction=encoding.UNSIGNED,
    from_=encoding.STR,
    belief=encoding.Sequence(encoding.F64),
    objects=encoding.Sequence(ObjectId_ENCODING),
    absent=encoding.F64,
    person=encoding.Optional(encoding.Fixed(encoding.F64, 2)),
    question=Question_ENCODING,
    prompt=encoding.UNSIGNED,
    text=encoding.STR,
    decision=encoding.Codes(ActKind),
    value=encoding.F64,
    alternatives=encoding.Sequence(encoding.Tuple(Action_ENCODING, encoding.F64)),
    expected_questions=encoding.F64,
    bounds=encoding.Optional(encoding.Fixed(encoding.F64, 2)),
    attributed=encoding.Nested(Attributed),
    questions=encoding.UNSIGNED,
    utterances=encoding.Fixed(encoding.UNSIGNED, 2),
    last=encoding.Optional(encoding.Nested(Ended)),
    refusable=encoding.Optional(encoding.Nested(Delivery)),
    refused=encoding.UNSIGNED,
    planner=encoding.STR,
    forgot=encoding.UNSIGNED,
)
@dataclass(kw_only=True)
class PolicyView:
    """The policy's belief and decision, for people and their tools. Policy to clients."""

    scene_key: int
    """The scene's key, to match object names."""
    applied: int
    """Highest utterance applied."""
    interaction: int
    """The open interaction, 0 for none."""
    from_: str
    """Name of the person whose interaction it is; empty: nobody in particular."""
    belief: list[float]
    """Probability of each object, in the scene's order or in that of `objects`."""
    objects: list[ObjectId]
    """Numbers of the objects of the belief, where they come from perception; empty where they are those of
    the scene. Every object of this message is given by its number."""
    absent: float
    """Probability that the wanted object is not here; 0 where that is not believed possible."""
    person: list[float] | None
    """Estimated parameters of the user, if the robot learns them: `p_l`, the probability that a question is
    answered, and `ε`, that an answer is wrong."""
    question: Question
    """The question that stands."""
    prompt: int
    """Its prompt, 0 for none."""
    text: str
    """The robot's last sentence or question."""
    decision: ActKind
    """Kind of the standing decision."""
    value: float
    """Expected discounted return of the decision."""
    alternatives: list[tuple[Action, float]]
    """The best other actions with their values, best first."""
    expected_questions: float
    """Expected number of questions still to ask."""
    bounds: list[float] | None
    """Certified lower and upper bound on what the best policy is worth, where the planner has them."""
    attributed: Attributed
    """The questions that the latest utterance was attributed to."""
    questions: int
    """Questions asked in the open interaction."""
    utterances: list[int]
    """First and last utterance of the latest interaction."""
    last: Ended | None
    """The latest interaction that ended."""
    refusable: Delivery | None
    """The latest delivery, while it can be refused."""
    refused: int
    """Observations refused because they made no sense."""
    planner: str
    """The planner that decides, by its name."""
    forgot: int
    """Key of the latest `Forget` that was carried out."""


PolicyView.wire_name, PolicyView.schema_key = "PolicyView", "0f26593076b2e607"


@encoding.struct(
    key=encoding.UNSIGNED,
    source=encoding.STR,
    frame=encoding.STR,
    change=Change_ENCODING,
)
@dataclass(kw_only=True)
class Sighting:
    """A report of a source."""

    key: int
    """Chosen at random by the source; a report that is sent again keeps it."""
    source: str
    """Name of the source, e.g. `camera`."""
    frame: str
    """Frame of the positions: `base`, or one of the settings."""
    change: Change
    """What changed."""


Sighting.wire_name, Sighting.schema_key = "Sighting", "3238153cdb355974"


@encoding.struct(
    known=encoding.Nested(Perceived),
    place=encoding.Fixed(encoding.F64, 4),
    sd=encoding.Fixed(encoding.F64, 4),
    seen_ns=encoding.UNSIGNED,
    gone=encoding.BOOL,
)
@dataclass(kw_only=True)
class TableObject:
    """An object on the table."""

    known: Perceived
    """The object as the dialogue knows it."""
    place: list[float]
    """The best estimate of its place at this moment: centre in frame `base`, metres, and yaw, radians."""
    sd: list[float]
    """Standard deviation of each."""
    seen_ns: int
    """When it was last seen, monotonic clock, nanoseconds."""
    gone: bool
    """Whether it was looked for in vain for so long that it counts as gone; the dialogue hears of it when the
    arm is done."""


@encoding.struct(
    version=encoding.UNSIGNED,
    objects=encoding.Sequence(encoding.Nested(TableObject)),
    answers=encoding.Sequence(encoding.Nested(ChangeAnswer)),
    refused=encoding.UNSIGNED,
    refusal=encoding.STR,
)
@dataclass(kw_only=True)
class TableView:
    """The objects on the table, where they come from perception. Policy to arm and clients."""

    version: int
    """Number of changes of the table so far: each is a step of the dialogue."""
    objects: list[TableObject]
    """The objects."""
    answers: list[ChangeAnswer]
    """The latest changes by hand, by key: the object, or why it was refused."""
    refused: int
    """Reports of sources that were refused."""
    refusal: str
    """Why the latest of them was."""


TableView.wire_name, TableView.schema_key = "TableView", "fe080376f9e15322"


@encoding.struct(
    interaction=encoding.UNSIGNED,
    attempt=encoding.UNSIGNED,
    object=encoding.Optional(encoding.UNSIGNED),
    limb=encoding.U8,
    began_ns=encoding.UNSIGNED,
    phases=encoding.Sequence(encoding.Nested(PhaseWay)),
)
@dataclass(kw_only=True)
class TrajectoryView:
    """The way that a gripper is planned to take in the motion under way. Arm to clients; no phases while
    nothing moves by plan."""

    interaction: int
    """`InteractionId` of the pick that the motion is for, 0 for none."""
    attempt: int
    """Attempt of that pick."""
    object: int | None
    """The object that is fetched or pointed at."""
    limb: int
    """The limb that moves: 0 left, 1 right."""
    began_ns: int
    """Start of the motion, monotonic clock. Published with each phase change, including any delay of the
    motion so far."""
    phases: list[PhaseWay]
    """The phases in order, over or not; at most `TRAJECTORY_POINTS_MAX` points in all."""


TrajectoryView.wire_name, TrajectoryView.schema_key = "TrajectoryView", "531c464cf29b0cf3"


@encoding.struct(
    at_ns=encoding.UNSIGNED,
    objects=encoding.Sequence(encoding.Optional(encoding.Fixed(encoding.F64, 7))),
    numbers=encoding.Sequence(ObjectId_ENCODING),
    held=encoding.Optional(encoding.UNSIGNED),
    grippers=encoding.Fixed(encoding.Fixed(encoding.F64, 7), 2),
)
@dataclass(kw_only=True)
class WorldView:
    """Object poses in the simulated world. Arm to clients."""

    at_ns: int
    """When it was so."""
    objects: list[list[float] | None]
    """Pose of each object in the scene's order, frame `base`: x, y, z in metres and quaternion x, y, z, w.
    None: handed over."""
    numbers: list[ObjectId]
    """Numbers of these objects, where they come from perception; else empty."""
    held: int | None
    """The object in the gripper, by its number."""
    grippers: list[list[float]]
    """Pose of the left and right gripper, as the objects'."""


WorldView.wire_name, WorldView.schema_key = "WorldView", "5c25bcd9afb51360"


TOPICS: dict[str, Topic] = {
    "speech/inject": Topic("speech/inject", Injection, writer=None, wakes=("speech", "recorder",), buffer=16, history=0),
    "speech/audio": Topic("speech/audio", AudioChunk, writer=None, wakes=("speech",), buffer=64, history=0),
    "speech/receipt": Topic("speech/receipt", Receipt, writer="speech", wakes=(), buffer=16, history=16),
    "speech/utterance": Topic("speech/utterance", Utterance, writer="speech", wakes=("grounding",), buffer=16, history=16),
    "speech/presented": Topic("speech/presented", Presented, writer="speech", wakes=("policy", "console",), buffer=1, history=1),
    "speech/activity": Topic("speech/activity", Activity, writer="speech", wakes=("policy",), buffer=1, history=1),
    "speech/hearing": Topic("speech/hearing", Hearing, writer="speech", wakes=(), buffer=1, history=1),
    "speech/partial": Topic("speech/partial", Partial, writer="speech", wakes=(), buffer=16, history=1),
    "grounding/observation": Topic("grounding/observation", Observation, writer="grounding", wakes=("policy",), buffer=16, history=16),
    "policy/mark": Topic("policy/mark", AppliedMark, writer="policy", wakes=("speech",), buffer=1, history=1),
    "policy/act": Topic("policy/act", RobotAct, writer="policy", wakes=("speech", "arm", "console",), buffer=1, history=1),
    "scene/sightings": Topic("scene/sightings", Sighting, writer=None, wakes=("policy", "recorder",), buffer=16, history=0),
    "scene/objects": Topic("scene/objects", TableView, writer="policy", wakes=("arm",), buffer=1, history=1),
    "policy/forget": Topic("policy/forget", Forget, writer=None, wakes=("policy",), buffer=1, history=0),
    "policy/view": Topic("policy/view", PolicyView, writer="policy", wakes=(), buffer=1, history=1),
    "arm/status": Topic("arm/status", ArmStatus, writer="arm", wakes=("policy", "speech", "console",), buffer=1, history=1),
    "arm/joints": Topic("arm/joints", JointStates, writer="arm", wakes=("ros2",), buffer=16, history=1),
    "arm/world": Topic("arm/world", WorldView, writer="arm", wakes=(), buffer=1, history=1),
    "arm/trajectory": Topic("arm/trajectory", TrajectoryView, writer="arm", wakes=(), buffer=1, history=1),
    "robot/joint_states": Topic("robot/joint_states", JointState, writer="baxter", wakes=("arm",), buffer=16, history=1),
    "robot/state": Topic("robot/state", AssemblyState, writer="baxter", wakes=(), buffer=1, history=1),
    "robot/limb/left/joint_command": Topic("robot/limb/left/joint_command", JointCommand, writer="arm", wakes=("baxter",), buffer=4, history=0),
    "robot/limb/right/joint_command": Topic("robot/limb/right/joint_command", JointCommand, writer="arm", wakes=("baxter",), buffer=4, history=0),
    "robot/limb/left/inverse_dynamics_command": Topic("robot/limb/left/inverse_dynamics_command", JointTrajectoryPoint, writer="arm", wakes=(), buffer=4, history=0),
    "robot/limb/right/inverse_dynamics_command": Topic("robot/limb/right/inverse_dynamics_command", JointTrajectoryPoint, writer="arm", wakes=(), buffer=4, history=0),
    "robot/limb/left/set_speed_ratio": Topic("robot/limb/left/set_speed_ratio", SpeedRatio, writer="arm", wakes=(), buffer=4, history=0),
    "robot/limb/right/set_speed_ratio": Topic("robot/limb/right/set_speed_ratio", SpeedRatio, writer="arm", wakes=(), buffer=4, history=0),
    "robot/limb/left/endpoint_state": Topic("robot/limb/left/endpoint_state", EndpointState, writer="baxter", wakes=(), buffer=1, history=1),
    "robot/limb/right/endpoint_state": Topic("robot/limb/right/endpoint_state", EndpointState, writer="baxter", wakes=(), buffer=1, history=1),
    "robot/end_effector/left_gripper/command": Topic("robot/end_effector/left_gripper/command", EndEffectorCommand, writer="arm", wakes=(), buffer=4, history=0),
    "robot/end_effector/right_gripper/command": Topic("robot/end_effector/right_gripper/command", EndEffectorCommand, writer="arm", wakes=(), buffer=4, history=0),
    "robot/end_effector/left_gripper/state": Topic("robot/end_effector/left_gripper/state", EndEffectorState, writer="baxter", wakes=(), buffer=1, history=1),
    "robot/end_effector/right_gripper/state": Topic("robot/end_effector/right_gripper/state", EndEffectorState, writer="baxter", wakes=(), buffer=1, history=1),
    "robot/end_effector/left_gripper/properties": Topic("robot/end_effector/left_gripper/properties", EndEffectorProperties, writer="baxter", wakes=(), buffer=1, history=1),
    "robot/end_effector/right_gripper/properties": Topic("robot/end_effector/right_gripper/properties", EndEffectorProperties, writer="baxter", wakes=(), buffer=1, history=1),
    "robot/drill": Topic("robot/drill", Drill, writer=None, wakes=("baxter",), buffer=16, history=0),
}
"""Every topic by name."""

for _message in Message.__subclasses__():
    _message.check_layout()
