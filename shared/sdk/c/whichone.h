/* Messages of the topics. Generated from the wire layout; do not edit.
 *
 * Numbers are in SI units. Names that end in _ns are times: nanoseconds of CLOCK_MONOTONIC. Structures lie in
 * shared memory as they are here. Topics whose payload has no structure carry postcard in a slice of bytes.
 */
#ifndef WHICHONE_H
#define WHICHONE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define WHICHONE_ASSERT(condition, text) static_assert(condition, text)
#define _Alignof alignof
#else
#define WHICHONE_ASSERT(condition, text) _Static_assert(condition, text)
#endif

/* Bounds. */
#define WHICHONE_ASKED_MAX 4u
#define WHICHONE_BASE_WORDS_MAX 32u
#define WHICHONE_CHUNK_SAMPLES_MAX 1600u
#define WHICHONE_CONFIDENCES_MAX 32u
#define WHICHONE_EXCLUDED_GROUPS_MAX 8u
#define WHICHONE_EXCLUDED_WORDS_MAX 6u
#define WHICHONE_FURTHER_MAX 4u
#define WHICHONE_HYPOTHESES_MAX 5u
#define WHICHONE_JOINTS_MAX 17u
#define WHICHONE_JOINT_STATE_LEN 17u
#define WHICHONE_LIMB_JOINTS 7u
#define WHICHONE_PERSON_BYTES_MAX 64u
#define WHICHONE_READINGS_MAX 32u
#define WHICHONE_UTTERANCE_BYTES_MAX 16380u
#define WHICHONE_NO_QUESTION 255u

/** Kind of a decision. */
enum whichone_act_kind {
    /** Waits for the user. */
    WHICHONE_ACT_KIND_WAIT = 0,
    /** Asks a question. */
    WHICHONE_ACT_KIND_ASK = 1,
    /** Says a line; no answer is expected. */
    WHICHONE_ACT_KIND_SAY = 2,
    /** Picks an object and says so. */
    WHICHONE_ACT_KIND_PICK = 3,
    /** Calls a pick off: an object that is grasped already goes back to its place, unless the gripper has
    begun to let go of it where it hands it over. Calls putting back off, unless the object is already
    grasped. */
    WHICHONE_ACT_KIND_CANCEL = 4,
    /** Puts the object that was handed over back in its place and says so. */
    WHICHONE_ACT_KIND_PUT_BACK = 5,
};

/** An external influence on the simulated robot. */
enum whichone_drill_kind {
    /** `set_super_enable` true: motors on. */
    WHICHONE_DRILL_KIND_ENABLE = 0,
    /** `set_super_enable` false: motors off. */
    WHICHONE_DRILL_KIND_DISABLE = 1,
    /** `set_super_reset`: faults and emergency stop are cleared; the motors stay off. */
    WHICHONE_DRILL_KIND_RESET = 2,
    /** A person presses the red button. */
    WHICHONE_DRILL_KIND_PRESS_ESTOP = 3,
    /** A person releases it; the robot stays stopped until it is reset. */
    WHICHONE_DRILL_KIND_RELEASE_ESTOP = 4,
    /** A part of it fails. */
    WHICHONE_DRILL_KIND_FAIL = 5,
    /** No joint states for some seconds. */
    WHICHONE_DRILL_KIND_SILENCE = 6,
    /** The next grasps close beside the object; `amount` says how many. */
    WHICHONE_DRILL_KIND_MISS = 7,
    /** Something holds a limb for some seconds, so that it cannot follow. */
    WHICHONE_DRILL_KIND_OBSTRUCT = 8,
    /** A person puts an object at `place`, wherever it was; not one that is in a gripper. */
    WHICHONE_DRILL_KIND_PUT = 9,
    /** A person takes an object off the table. */
    WHICHONE_DRILL_KIND_TAKE = 10,
};

/** Availability of speech recognition. */
enum whichone_ear_state {
    /** The recogniser is being loaded. */
    WHICHONE_EAR_STATE_LOADING = 0,
    /** It is ready. */
    WHICHONE_EAR_STATE_READY = 1,
    /** Text only. */
    WHICHONE_EAR_STATE_OFF = 2,
};

/** The red button. */
enum whichone_estop_button {
    /** Not pressed, and the robot is not stopped by it. */
    WHICHONE_ESTOP_BUTTON_UNPRESSED = 0,
    /** Pressed. */
    WHICHONE_ESTOP_BUTTON_PRESSED = 1,
    /** The robot was stopped by something else. */
    WHICHONE_ESTOP_BUTTON_UNKNOWN = 2,
    /** It was pressed and is not any more, but the robot is still stopped. */
    WHICHONE_ESTOP_BUTTON_RELEASED = 3,
};

/** Why speech is acted on or not. */
enum whichone_gate_verdict {
    /** It is about the scene. */
    WHICHONE_GATE_VERDICT_PASSED = 0,
    /** No words were recognised. */
    WHICHONE_GATE_VERDICT_NO_WORDS = 1,
    /** It is about other things. */
    WHICHONE_GATE_VERDICT_OTHER_TALK = 2,
    /** There is no speech. */
    WHICHONE_GATE_VERDICT_NO_SPEECH = 3,
    /** The robot's own voice covers its beginning. */
    WHICHONE_GATE_VERDICT_COVERED = 4,
    /** It is a line that the robot has just said. */
    WHICHONE_GATE_VERDICT_ECHO = 5,
};

enum whichone_intent {
    /** Says something about the wanted object, or answers. */
    WHICHONE_INTENT_INFORM = 0,
    /** Not addressed to the robot, or without content. */
    WHICHONE_INTENT_NONE = 1,
    /** Stop moving at once. */
    WHICHONE_INTENT_STOP = 2,
    /** Withdraw the request; with excluded groups, only what they describe ("don't get me the red one").
    */
    WHICHONE_INTENT_CANCEL = 3,
    /** Repeat the question. */
    WHICHONE_INTENT_REPEAT = 4,
    /** Forget everything said and start over. */
    WHICHONE_INTENT_START_OVER = 5,
    /** Ask the robot what there is ("what colours do you have?"). */
    WHICHONE_INTENT_ASK_BACK = 6,
    /** Ask how many objects the words describe ("how many cups are there?"). */
    WHICHONE_INTENT_ASK_COUNT = 7,
    /** Ask which objects the words describe ("what is on the shelf?"). */
    WHICHONE_INTENT_ASK_WHICH = 8,
    /** Ask where the objects are that the words describe. */
    WHICHONE_INTENT_ASK_WHERE = 9,
    /** Ask for the reason of what the robot said or does. */
    WHICHONE_INTENT_ASK_WHY = 10,
    /** Ask what the robot is doing. */
    WHICHONE_INTENT_ASK_STATUS = 11,
    /** Ask what one can say to the robot. */
    WHICHONE_INTENT_ASK_HELP = 12,
    /** Greet. */
    WHICHONE_INTENT_GREET = 13,
    /** Thank. */
    WHICHONE_INTENT_THANK = 14,
    /** Have the delivered object put back. */
    WHICHONE_INTENT_PUT_BACK = 15,
    /** Take leave. */
    WHICHONE_INTENT_LEAVE = 16,
    /** Ask whether there is an object that the words describe ("is there a red mug?"). */
    WHICHONE_INTENT_ASK_WHETHER = 17,
    /** Have the robot do something else than fetch ("wash the bowl"). */
    WHICHONE_INTENT_CHORE = 18,
    /** Stop moving at once, and withdraw the request ("stop, I don't want it"). */
    WHICHONE_INTENT_STOP_AND_CANCEL = 19,
    /** Move again after a stop ("go on"), which words cannot bring about. An answer in the same words
    ("keep going") stands. */
    WHICHONE_INTENT_GO_ON = 20,
};

/** State of the microphone of the robot's computer. */
enum whichone_microphone_state {
    /** There is none, or it is switched off. */
    WHICHONE_MICROPHONE_STATE_OFF = 0,
    /** It is opened when a user asks to talk. */
    WHICHONE_MICROPHONE_STATE_CLOSED = 1,
    /** Its program was started and has given no sound yet. */
    WHICHONE_MICROPHONE_STATE_OPENING = 2,
    /** It listens. */
    WHICHONE_MICROPHONE_STATE_LISTENING = 3,
    /** It leaves out the robot's own voice. */
    WHICHONE_MICROPHONE_STATE_MUTED = 4,
    /** Its program died; another try will follow. */
    WHICHONE_MICROPHONE_STATE_BROKEN = 5,
};

/** Reason why the robot cannot move at all, the gravest of several. */
enum whichone_motion_inhibit {
    /** Nothing. */
    WHICHONE_MOTION_INHIBIT_NONE = 0,
    /** An emergency stop holds. */
    WHICHONE_MOTION_INHIBIT_STOPPED = 1,
    /** A part of the robot has a fault. */
    WHICHONE_MOTION_INHIBIT_ERROR = 2,
    /** The motors are off. */
    WHICHONE_MOTION_INHIBIT_DISABLED = 3,
    /** The robot has not been heard yet, or not all of it. */
    WHICHONE_MOTION_INHIBIT_UNHEARD = 4,
    /** The measurements are too old to rely on. */
    WHICHONE_MOTION_INHIBIT_STALE = 5,
    /** A gripper has a fault, or is not the electric one. */
    WHICHONE_MOTION_INHIBIT_GRIPPER = 6,
    /** A gripper is being calibrated. */
    WHICHONE_MOTION_INHIBIT_CALIBRATING = 7,
};

/** Purpose of a part of a motion. */
enum whichone_motion_phase {
    /** Away from what the arm touches, straight up; or a pause while the fingers open. */
    WHICHONE_MOTION_PHASE_CLEAR = 0,
    /** To above the object and straight down to it. */
    WHICHONE_MOTION_PHASE_APPROACH = 1,
    /** The fingers close. */
    WHICHONE_MOTION_PHASE_CLOSE = 2,
    /** Straight up with the object. */
    WHICHONE_MOTION_PHASE_LIFT = 3,
    /** To where the person takes the object. */
    WHICHONE_MOTION_PHASE_HAND_OVER = 4,
    /** The fingers open. */
    WHICHONE_MOTION_PHASE_RELEASE = 5,
    /** To where the gripper's axis passes through an object. */
    WHICHONE_MOTION_PHASE_AIM = 6,
    /** Back to rest. */
    WHICHONE_MOTION_PHASE_RETURN = 7,
    /** To where the user gives an object back, and still there. */
    WHICHONE_MOTION_PHASE_TAKE = 8,
    /** To above the place of an object that is put back. */
    WHICHONE_MOTION_PHASE_CARRY_BACK = 9,
    /** Straight down to that place. */
    WHICHONE_MOTION_PHASE_LOWER = 10,
};

/** Outcome of an interaction. */
enum whichone_outcome {
    /** An object was handed over. */
    WHICHONE_OUTCOME_DELIVERED = 0,
    /** An object was handed over, and the user refused it. */
    WHICHONE_OUTCOME_REFUSED = 1,
    /** The arm failed; the object is named. */
    WHICHONE_OUTCOME_FAILED = 2,
    /** The user withdrew the request. */
    WHICHONE_OUTCOME_CANCELLED = 3,
    /** The user fell silent, or no question helped. */
    WHICHONE_OUTCOME_ABANDONED = 4,
    /** The scene was replaced during the interaction, and none of its objects is left. */
    WHICHONE_OUTCOME_SCENE_CHANGED = 5,
    /** The robot concluded that the wanted object is not here. */
    WHICHONE_OUTCOME_NOT_HERE = 6,
};

/** Outcome of a pick. */
enum whichone_pick_outcome {
    /** Not over yet. */
    WHICHONE_PICK_OUTCOME_PENDING = 0,
    /** The object was handed over. */
    WHICHONE_PICK_OUTCOME_DELIVERED = 1,
    /** No motion reaches it; nothing moved. */
    WHICHONE_PICK_OUTCOME_UNREACHABLE = 2,
    /** Unknown whether the object was grasped; a person must look. */
    WHICHONE_PICK_OUTCOME_INTERRUPTED = 3,
    /** Called off by the policy or the operator; the object was put back or never touched. */
    WHICHONE_PICK_OUTCOME_CANCELLED = 4,
    /** The fingers closed on nothing in every attempt; nothing is held. */
    WHICHONE_PICK_OUTCOME_MISSED = 5,
    /** The robot did not follow its motion, or did not arrive; a person must look. */
    WHICHONE_PICK_OUTCOME_BLOCKED = 6,
    /** The object is back in its place. */
    WHICHONE_PICK_OUTCOME_PUT_BACK = 7,
    /** The object is no longer where it was seen; nothing is held. */
    WHICHONE_PICK_OUTCOME_VANISHED = 8,
    /** Called off while it was held, and no way back to its place was found: the gripper keeps hold of it
    until the next order for it. */
    WHICHONE_PICK_OUTCOME_KEPT = 9,
};

enum whichone_pick_phase {
    /** Nothing to do. */
    WHICHONE_PICK_PHASE_IDLE = 0,
    /** Accepted; nothing has moved. */
    WHICHONE_PICK_PHASE_ACCEPTED = 1,
    /** Moving to the object, gripper open. */
    WHICHONE_PICK_PHASE_MOVING = 2,
    /** The gripper closes on the object. */
    WHICHONE_PICK_PHASE_CLOSING = 3,
    /** The object is held: lifted and carried to the user, or carried to its place and put down. */
    WHICHONE_PICK_PHASE_HOLDING = 4,
    /** Over; see the outcome. */
    WHICHONE_PICK_PHASE_DONE = 5,
    /** Called off while it is held: the object is carried back to its place and put down. */
    WHICHONE_PICK_PHASE_RETURNING = 6,
};

/** Progress of a prompt. */
enum whichone_presentation_state {
    /** Nothing was said yet. */
    WHICHONE_PRESENTATION_STATE_SILENT = 0,
    /** Being said. */
    WHICHONE_PRESENTATION_STATE_SPEAKING = 1,
    /** Said to its end; from now on an answer can be meant for it. */
    WHICHONE_PRESENTATION_STATE_ENDED = 2,
    /** Broken off before its end. */
    WHICHONE_PRESENTATION_STATE_INTERRUPTED = 3,
};

/** Outcome of an injection. */
enum whichone_receipt_status {
    /** Durable; it will be applied. */
    WHICHONE_RECEIPT_STATUS_ACCEPTED = 0,
    /** Refused; `note` says why and nothing was kept. */
    WHICHONE_RECEIPT_STATUS_REFUSED = 1,
    /** Heard, but not meant for the robot; `note` holds what was heard. */
    WHICHONE_RECEIPT_STATUS_NOT_FOR_ME = 2,
    /** A stream has ended, and everything said in it has its receipt; `note` reports what was lost. */
    WHICHONE_RECEIPT_STATUS_OVER = 3,
};

enum whichone_reference {
    /** None. */
    WHICHONE_REFERENCE_NONE = 0,
    /** "the other one": not the one just spoken of. */
    WHICHONE_REFERENCE_OTHER = 1,
    /** "the same one again": the one delivered last. */
    WHICHONE_REFERENCE_SAME = 2,
    /** "the smaller one", of those that may be meant. */
    WHICHONE_REFERENCE_SMALLER = 3,
    /** "the bigger one", of those that may be meant. */
    WHICHONE_REFERENCE_LARGER = 4,
    /** "the smallest one", of those that the words describe. */
    WHICHONE_REFERENCE_SMALLEST = 5,
    /** "the biggest one", of those that the words describe. */
    WHICHONE_REFERENCE_LARGEST = 6,
    /** "either", "you choose": any of those that may be meant. */
    WHICHONE_REFERENCE_ANY = 7,
    /** "the leftmost one", "longer than the red one": by place, order or size. */
    WHICHONE_REFERENCE_RELATION = 8,
};

enum whichone_response {
    /** Neither, or both. */
    WHICHONE_RESPONSE_NONE = 0,
    /** An affirmative and no negative word. */
    WHICHONE_RESPONSE_YES = 1,
    /** A negative and no affirmative word. */
    WHICHONE_RESPONSE_NO = 2,
    /** "I don't know": the user cannot tell. */
    WHICHONE_RESPONSE_CANNOT_TELL = 3,
    /** "I don't care", "either": the answer does not matter to the user. */
    WHICHONE_RESPONSE_DOES_NOT_MATTER = 4,
};

/** Grammatical role of a value: a key of the scene file, or else guessed from the `spoken` form. */
enum whichone_role {
    /** "white": stands before a noun, has degrees. */
    WHICHONE_ROLE_QUALITY = 0,
    /** "a marker": is a noun. */
    WHICHONE_ROLE_KIND = 1,
    /** "in the dishwasher": stands after the noun. */
    WHICHONE_ROLE_PLACE = 2,
    /** "with nuts", "a green handle": what is in a thing or belongs to it; stands after the noun, and can
    be asked for as if it were the thing. */
    WHICHONE_ROLE_PART = 3,
};

/** The second recogniser's part in an utterance. */
enum whichone_second_state {
    /** There is none, or the first one was sure. */
    WHICHONE_SECOND_STATE_NOT_ASKED = 0,
    /** It was too late. */
    WHICHONE_SECOND_STATE_LATE = 1,
    /** It was heard. */
    WHICHONE_SECOND_STATE_HEARD = 2,
};

/** Origin of an utterance. */
enum whichone_source {
    /** Typed or injected text. */
    WHICHONE_SOURCE_TEXT = 0,
    /** A WAV file. */
    WHICHONE_SOURCE_WAV = 1,
    /** A microphone. */
    WHICHONE_SOURCE_MICROPHONE = 2,
    /** A browser's own recogniser. */
    WHICHONE_SOURCE_BROWSER = 3,
    /** A pointing gesture, with or without words. */
    WHICHONE_SOURCE_GESTURE = 4,
};

/** What the arm is ordered to do with an object. Both kinds of order have one numbering, the phases and
the outcomes of a pick, and the same rules. */
enum whichone_task {
    /** Fetch it from its place and hand it over. */
    WHICHONE_TASK_FETCH = 0,
    /** Take it from the user, where it was handed over, and put it back in its place. */
    WHICHONE_TASK_PUT_BACK = 1,
};

/** The three values of a gripper's state fields. */
enum whichone_tristate {
    /** `STATE_FALSE`. */
    WHICHONE_TRISTATE_FALSE = 0,
    /** `STATE_TRUE`. */
    WHICHONE_TRISTATE_TRUE = 1,
    /** `STATE_UNKNOWN`: unknown, or not known to this gripper. */
    WHICHONE_TRISTATE_UNKNOWN = 2,
};

/** Mounted end effector: `EndEffectorProperties::ui_type`. */
enum whichone_ui_type {
    /** Nothing. */
    WHICHONE_UI_TYPE_NO_GRIPPER = 0,
    /** A vacuum gripper. */
    WHICHONE_UI_TYPE_SUCTION_CUP = 1,
    /** The electric parallel gripper. */
    WHICHONE_UI_TYPE_ELECTRIC = 2,
    /** Something without a motor, or a gripper of one's own. */
    WHICHONE_UI_TYPE_PASSIVE = 3,
};

/** UTF-8 text of at most 28 bytes, without a zero at its end. */
typedef struct whichone_text_28 {
    uint32_t len;
    char bytes[28];
} whichone_text_28_t;

/** UTF-8 text of at most 60 bytes, without a zero at its end. */
typedef struct whichone_text_60 {
    uint32_t len;
    char bytes[60];
} whichone_text_60_t;

/** UTF-8 text of at most 64 bytes, without a zero at its end. */
typedef struct whichone_text_64 {
    uint32_t len;
    char bytes[64];
} whichone_text_64_t;

/** UTF-8 text of at most 200 bytes, without a zero at its end. */
typedef struct whichone_text_200 {
    uint32_t len;
    char bytes[200];
} whichone_text_200_t;

/** UTF-8 text of at most 204 bytes, without a zero at its end. */
typedef struct whichone_text_204 {
    uint32_t len;
    char bytes[204];
} whichone_text_204_t;

/** UTF-8 text of at most 244 bytes, without a zero at its end. */
typedef struct whichone_text_244 {
    uint32_t len;
    char bytes[244];
} whichone_text_244_t;

/** UTF-8 text of at most 500 bytes, without a zero at its end. */
typedef struct whichone_text_500 {
    uint32_t len;
    char bytes[500];
} whichone_text_500_t;

/** UTF-8 text of at most 16380 bytes, without a zero at its end. */
typedef struct whichone_text_16380 {
    uint32_t len;
    char bytes[16380];
} whichone_text_16380_t;

/** The sender of a message; the user header of every topic. */
typedef struct whichone_stamp {
    /** Epoch of the group's journals. */
    uint64_t epoch;
    /** When it was sent. */
    uint64_t sent_ns;
    /** Incarnation of the sender; 0 for a client. */
    uint32_t incarnation;
    /** Number of the message among those of its writer in this topic, from 1; 0 where the sender does not
    count. A reader sees from a gap how many it has lost. */
    uint32_t sequence;
} whichone_stamp_t;
WHICHONE_ASSERT(sizeof(whichone_stamp_t) == 24, "size of Stamp");
WHICHONE_ASSERT(offsetof(whichone_stamp_t, epoch) == 0, "offset of Stamp.epoch");
WHICHONE_ASSERT(offsetof(whichone_stamp_t, sent_ns) == 8, "offset of Stamp.sent_ns");
WHICHONE_ASSERT(offsetof(whichone_stamp_t, incarnation) == 16, "offset of Stamp.incarnation");
WHICHONE_ASSERT(offsetof(whichone_stamp_t, sequence) == 20, "offset of Stamp.sequence");
#define WHICHONE_STAMP_TYPE "Stamp"
#define WHICHONE_STAMP_SCHEMA "8857d7949252d28b"

/** A `Question` on the wire. */
typedef struct whichone_question {
    /** 0 none, 1 point, 2 attribute, 3 which, 4 choice; the values of a choice, each plus 1, are the
    bytes of `object` and `value`, the lower one first, and 0 where there are fewer than four. */
    uint16_t kind;
    /** The object pointed at. */
    uint16_t object;
    /** The attribute asked about. */
    uint16_t attribute;
    /** The value asked about, its place in the attribute's list. */
    uint16_t value;
} whichone_question_t;
WHICHONE_ASSERT(sizeof(whichone_question_t) == 8, "size of Question");
WHICHONE_ASSERT(offsetof(whichone_question_t, kind) == 0, "offset of Question.kind");
WHICHONE_ASSERT(offsetof(whichone_question_t, object) == 2, "offset of Question.object");
WHICHONE_ASSERT(offsetof(whichone_question_t, attribute) == 4, "offset of Question.attribute");
WHICHONE_ASSERT(offsetof(whichone_question_t, value) == 6, "offset of Question.value");
#define WHICHONE_QUESTION_TYPE "Question"
#define WHICHONE_QUESTION_SCHEMA "a0c8de0a2f4eaa8d"

/** A pointing gesture, or none. */
typedef struct whichone_gesture {
    /** The point that the person points at, metres, frame `base`: x, y, z. */
    double target_m[3];
    /** 1 where there is a gesture, else 0. */
    uint8_t present;
    /** Zero. */
    uint8_t reserved[7];
} whichone_gesture_t;
WHICHONE_ASSERT(sizeof(whichone_gesture_t) == 32, "size of Gesture");
WHICHONE_ASSERT(offsetof(whichone_gesture_t, target_m) == 0, "offset of Gesture.target_m");
WHICHONE_ASSERT(offsetof(whichone_gesture_t, present) == 24, "offset of Gesture.present");
WHICHONE_ASSERT(offsetof(whichone_gesture_t, reserved) == 25, "offset of Gesture.reserved");
#define WHICHONE_GESTURE_TYPE "Gesture"
#define WHICHONE_GESTURE_SCHEMA "3564b776a5b30a63"

/** A question as it was put to the person: one presentation of a prompt. */
typedef struct whichone_asked_question {
    /** `PromptId`. */
    uint64_t prompt;
    /** `Scene::key` of the scene that it was asked about. */
    uint64_t scene;
    /** When its sound began. */
    uint64_t began_ns;
    /** When its sound ended or was broken off; 0 while it lasts. */
    uint64_t ended_ns;
    /** The question that was asked. */
    whichone_question_t question;
    /** Which presentation of the prompt. */
    uint32_t presentation;
    /** 1 where it was said to its end. */
    uint8_t whole;
    /** Zero. */
    uint8_t reserved[3];
} whichone_asked_question_t;
WHICHONE_ASSERT(sizeof(whichone_asked_question_t) == 48, "size of AskedQuestion");
WHICHONE_ASSERT(offsetof(whichone_asked_question_t, prompt) == 0, "offset of AskedQuestion.prompt");
WHICHONE_ASSERT(offsetof(whichone_asked_question_t, scene) == 8, "offset of AskedQuestion.scene");
WHICHONE_ASSERT(offsetof(whichone_asked_question_t, began_ns) == 16, "offset of AskedQuestion.began_ns");
WHICHONE_ASSERT(offsetof(whichone_asked_question_t, ended_ns) == 24, "offset of AskedQuestion.ended_ns");
WHICHONE_ASSERT(offsetof(whichone_asked_question_t, question) == 32, "offset of AskedQuestion.question");
WHICHONE_ASSERT(offsetof(whichone_asked_question_t, presentation) == 40, "offset of AskedQuestion.presentation");
WHICHONE_ASSERT(offsetof(whichone_asked_question_t, whole) == 44, "offset of AskedQuestion.whole");
WHICHONE_ASSERT(offsetof(whichone_asked_question_t, reserved) == 45, "offset of AskedQuestion.reserved");
#define WHICHONE_ASKED_QUESTION_TYPE "AskedQuestion"
#define WHICHONE_ASKED_QUESTION_SCHEMA "2a0adff7531884c8"

/** A `Hypothesis` on the wire: where its words lie in the utterance's text, and how sure it is. */
typedef struct whichone_hypothesis {
    /** First byte. */
    uint32_t start;
    /** Bytes. */
    uint32_t len;
    /** Probability among the hypotheses; they sum to 1. */
    double weight;
    /** Confidence of each blank-separated word: 0 (not said) to 255 (certain). Unknown for words beyond
    these. */
    uint8_t confidence[WHICHONE_CONFIDENCES_MAX];
} whichone_hypothesis_t;
WHICHONE_ASSERT(sizeof(whichone_hypothesis_t) == 48, "size of Hypothesis");
WHICHONE_ASSERT(offsetof(whichone_hypothesis_t, start) == 0, "offset of Hypothesis.start");
WHICHONE_ASSERT(offsetof(whichone_hypothesis_t, len) == 4, "offset of Hypothesis.len");
WHICHONE_ASSERT(offsetof(whichone_hypothesis_t, weight) == 8, "offset of Hypothesis.weight");
WHICHONE_ASSERT(offsetof(whichone_hypothesis_t, confidence) == 16, "offset of Hypothesis.confidence");
#define WHICHONE_HYPOTHESIS_TYPE "Hypothesis"
#define WHICHONE_HYPOTHESIS_SCHEMA "d93ca23e859f455a"

/** A `Reading` on the wire. */
typedef struct whichone_reading {
    /** Probability among the readings for the same question; they sum to 1. */
    double weight;
    /** By word of `base`: probability that it was not said. */
    float base_doubt[WHICHONE_BASE_WORDS_MAX];
    /** By excluded group: probability that it was not meant. */
    float excluded_doubt[WHICHONE_EXCLUDED_GROUPS_MAX];
    /** Probability that the response was not given. */
    float response_doubt;
    /** `WordId`s. */
    uint16_t base[WHICHONE_BASE_WORDS_MAX];
    /** `WordId`s by group. */
    uint16_t excluded[WHICHONE_EXCLUDED_GROUPS_MAX][WHICHONE_EXCLUDED_WORDS_MAX];
    /** `WordId`s by further object. */
    uint16_t further[WHICHONE_FURTHER_MAX][WHICHONE_EXCLUDED_WORDS_MAX];
    /** Used words of each excluded group. */
    uint8_t excluded_len[WHICHONE_EXCLUDED_GROUPS_MAX];
    /** Used words of each further object. */
    uint8_t further_len[WHICHONE_FURTHER_MAX];
    /** The question that it is the answer to if the utterance answers that one: its place in the
    observation's `asked`, or `NO_QUESTION`. */
    uint8_t question;
    /** `Response`. */
    uint8_t response /* enum whichone_response */;
    /** `Intent`, in its order. */
    uint8_t intent /* enum whichone_intent */;
    /** `Reference`. */
    uint8_t refers /* enum whichone_reference */;
    /** Used entries of `base`. */
    uint8_t base_count;
    /** Used entries of `excluded`. */
    uint8_t excluded_count;
    /** Used entries of `further`. */
    uint8_t further_count;
    /** `Relation::code` of a relation in `refers`; else zero. */
    uint8_t relation;
} whichone_reading_t;
WHICHONE_ASSERT(sizeof(whichone_reading_t) == 400, "size of Reading");
WHICHONE_ASSERT(offsetof(whichone_reading_t, weight) == 0, "offset of Reading.weight");
WHICHONE_ASSERT(offsetof(whichone_reading_t, base_doubt) == 8, "offset of Reading.base_doubt");
WHICHONE_ASSERT(offsetof(whichone_reading_t, excluded_doubt) == 136, "offset of Reading.excluded_doubt");
WHICHONE_ASSERT(offsetof(whichone_reading_t, response_doubt) == 168, "offset of Reading.response_doubt");
WHICHONE_ASSERT(offsetof(whichone_reading_t, base) == 172, "offset of Reading.base");
WHICHONE_ASSERT(offsetof(whichone_reading_t, excluded) == 236, "offset of Reading.excluded");
WHICHONE_ASSERT(offsetof(whichone_reading_t, further) == 332, "offset of Reading.further");
WHICHONE_ASSERT(offsetof(whichone_reading_t, excluded_len) == 380, "offset of Reading.excluded_len");
WHICHONE_ASSERT(offsetof(whichone_reading_t, further_len) == 388, "offset of Reading.further_len");
WHICHONE_ASSERT(offsetof(whichone_reading_t, question) == 392, "offset of Reading.question");
WHICHONE_ASSERT(offsetof(whichone_reading_t, response) == 393, "offset of Reading.response");
WHICHONE_ASSERT(offsetof(whichone_reading_t, intent) == 394, "offset of Reading.intent");
WHICHONE_ASSERT(offsetof(whichone_reading_t, refers) == 395, "offset of Reading.refers");
WHICHONE_ASSERT(offsetof(whichone_reading_t, base_count) == 396, "offset of Reading.base_count");
WHICHONE_ASSERT(offsetof(whichone_reading_t, excluded_count) == 397, "offset of Reading.excluded_count");
WHICHONE_ASSERT(offsetof(whichone_reading_t, further_count) == 398, "offset of Reading.further_count");
WHICHONE_ASSERT(offsetof(whichone_reading_t, relation) == 399, "offset of Reading.relation");
#define WHICHONE_READING_TYPE "Reading"
#define WHICHONE_READING_SCHEMA "a59be7e903333f82"

/** An accepted utterance. Speech to grounding. */
typedef struct whichone_utterance {
    /** `UtteranceSeq`. */
    uint64_t seq;
    /** The latest questions whose sound had begun when the utterance was accepted, newest first. */
    whichone_asked_question_t asked[WHICHONE_ASKED_MAX];
    /** Target of the pointing gesture, if any. */
    whichone_gesture_t gesture;
    /** When the person began to speak or type. */
    uint64_t onset_ns;
    /** When the person had ended. */
    uint64_t end_ns;
    /** When it was accepted. */
    uint64_t accepted_ns;
    /** `Source`. */
    uint8_t source /* enum whichone_source */;
    /** Number of used entries of `hypotheses`; the first is the best. 0 for a gesture without words. */
    uint8_t hypothesis_count;
    /** Number of used entries of `asked`. */
    uint8_t asked_count;
    /** Zero. */
    uint8_t reserved;
    /** Name of the person who speaks; empty: nobody in particular. */
    whichone_text_64_t from;
    /** Recognition hypotheses, most likely first. */
    whichone_hypothesis_t hypotheses[WHICHONE_HYPOTHESES_MAX];
    /** The text of all hypotheses, one after another. */
    whichone_text_16380_t text;
} whichone_utterance_t;
WHICHONE_ASSERT(sizeof(whichone_utterance_t) == 16952, "size of Utterance");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, seq) == 0, "offset of Utterance.seq");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, asked) == 8, "offset of Utterance.asked");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, gesture) == 200, "offset of Utterance.gesture");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, onset_ns) == 232, "offset of Utterance.onset_ns");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, end_ns) == 240, "offset of Utterance.end_ns");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, accepted_ns) == 248, "offset of Utterance.accepted_ns");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, source) == 256, "offset of Utterance.source");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, hypothesis_count) == 257, "offset of Utterance.hypothesis_count");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, asked_count) == 258, "offset of Utterance.asked_count");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, reserved) == 259, "offset of Utterance.reserved");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, from) == 260, "offset of Utterance.from");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, hypotheses) == 328, "offset of Utterance.hypotheses");
WHICHONE_ASSERT(offsetof(whichone_utterance_t, text) == 568, "offset of Utterance.text");
#define WHICHONE_UTTERANCE_TYPE "Utterance"
#define WHICHONE_UTTERANCE_SCHEMA "a9b84ed794b730c1"

/** The interpretation of an utterance. Grounding to policy, one for each utterance. */
typedef struct whichone_observation {
    /** The utterance's `UtteranceSeq`. */
    uint64_t seq;
    /** Of the utterance. */
    whichone_asked_question_t asked[WHICHONE_ASKED_MAX];
    /** Of the utterance. */
    whichone_gesture_t gesture;
    /** `Scene::key` of the scene that it was read with. */
    uint64_t scene_key;
    /** Of the utterance. */
    uint64_t onset_ns;
    /** Of the utterance. */
    uint64_t end_ns;
    /** Of the utterance. */
    uint64_t accepted_ns;
    /** When it was read. */
    uint64_t grounded_ns;
    /** Number of used entries of `readings`. */
    uint8_t reading_count;
    /** Number of used entries of `asked`. */
    uint8_t asked_count;
    /** `Source` of the utterance. */
    uint8_t source /* enum whichone_source */;
    /** `Role` of `unknown`. */
    uint8_t unknown_role /* enum whichone_role */;
    /** Of the utterance. */
    whichone_text_64_t from;
    /** Possible meanings: for each question asked and for none, most likely first. */
    whichone_reading_t readings[WHICHONE_READINGS_MAX];
    /** A word that the scene does not have, for the robot's reply ("plate"); may be empty. */
    whichone_text_60_t unknown;
} whichone_observation_t;
WHICHONE_ASSERT(sizeof(whichone_observation_t) == 13208, "size of Observation");
WHICHONE_ASSERT(offsetof(whichone_observation_t, seq) == 0, "offset of Observation.seq");
WHICHONE_ASSERT(offsetof(whichone_observation_t, asked) == 8, "offset of Observation.asked");
WHICHONE_ASSERT(offsetof(whichone_observation_t, gesture) == 200, "offset of Observation.gesture");
WHICHONE_ASSERT(offsetof(whichone_observation_t, scene_key) == 232, "offset of Observation.scene_key");
WHICHONE_ASSERT(offsetof(whichone_observation_t, onset_ns) == 240, "offset of Observation.onset_ns");
WHICHONE_ASSERT(offsetof(whichone_observation_t, end_ns) == 248, "offset of Observation.end_ns");
WHICHONE_ASSERT(offsetof(whichone_observation_t, accepted_ns) == 256, "offset of Observation.accepted_ns");
WHICHONE_ASSERT(offsetof(whichone_observation_t, grounded_ns) == 264, "offset of Observation.grounded_ns");
WHICHONE_ASSERT(offsetof(whichone_observation_t, reading_count) == 272, "offset of Observation.reading_count");
WHICHONE_ASSERT(offsetof(whichone_observation_t, asked_count) == 273, "offset of Observation.asked_count");
WHICHONE_ASSERT(offsetof(whichone_observation_t, source) == 274, "offset of Observation.source");
WHICHONE_ASSERT(offsetof(whichone_observation_t, unknown_role) == 275, "offset of Observation.unknown_role");
WHICHONE_ASSERT(offsetof(whichone_observation_t, from) == 276, "offset of Observation.from");
WHICHONE_ASSERT(offsetof(whichone_observation_t, readings) == 344, "offset of Observation.readings");
WHICHONE_ASSERT(offsetof(whichone_observation_t, unknown) == 13144, "offset of Observation.unknown");
#define WHICHONE_OBSERVATION_TYPE "Observation"
#define WHICHONE_OBSERVATION_SCHEMA "5b9560b6ac211b48"

/** The highest utterance that the belief holds. Policy to speech. */
typedef struct whichone_applied_mark {
    /** `UtteranceSeq`. */
    uint64_t seq;
} whichone_applied_mark_t;
WHICHONE_ASSERT(sizeof(whichone_applied_mark_t) == 8, "size of AppliedMark");
WHICHONE_ASSERT(offsetof(whichone_applied_mark_t, seq) == 0, "offset of AppliedMark.seq");
#define WHICHONE_APPLIED_MARK_TYPE "AppliedMark"
#define WHICHONE_APPLIED_MARK_SCHEMA "1462b9620e386d8b"

/** An order to forget what was learned about a person. Clients to policy, sent again until
`PolicyView::forgot` has its key. `PolicyView::forgot`: PolicyView::forgot */
typedef struct whichone_forget {
    /** Made by the client, not 0, kept through its retries. */
    uint64_t key;
    /** Name of the person. */
    whichone_text_64_t person;
    /** Zero. */
    uint8_t reserved[4];
} whichone_forget_t;
WHICHONE_ASSERT(sizeof(whichone_forget_t) == 80, "size of Forget");
WHICHONE_ASSERT(offsetof(whichone_forget_t, key) == 0, "offset of Forget.key");
WHICHONE_ASSERT(offsetof(whichone_forget_t, person) == 8, "offset of Forget.person");
WHICHONE_ASSERT(offsetof(whichone_forget_t, reserved) == 76, "offset of Forget.reserved");
#define WHICHONE_FORGET_TYPE "Forget"
#define WHICHONE_FORGET_SCHEMA "d8d270a2349d4c69"

/** The policy's standing decision. Policy to speech and arm, sent again until superseded. */
typedef struct whichone_robot_act {
    /** `ActId`. */
    uint64_t act;
    /** `InteractionId`. */
    uint64_t interaction;
    /** `PromptId` of an `Ask` or `Say`. */
    uint64_t prompt;
    /** Number of times the prompt has been requested: 1, and one more for each repetition. */
    uint32_t presentation;
    /** `ActKind`. */
    uint8_t kind /* enum whichone_act_kind */;
    /** 1 where the question names its object in words alone, as "do you want the blue pen?" does: the arm
    does not point at it. Else 0. */
    uint8_t in_words;
    /** Zero. */
    uint8_t reserved[2];
    /** The question of an `Ask`; of a `Pick` or `PutBack`, its object: it can be denied; of a `Say`, the
    object that can be refused or confirmed, if any. */
    whichone_question_t question;
    /** `ObjectId` of a `Pick` or `PutBack`. */
    uint32_t object;
    /** Attempt of a `Pick` or `PutBack`. */
    uint32_t attempt;
    /** `Scene::key` of the scene whose objects and attributes are meant. */
    uint64_t scene_key;
    /** When it was decided. */
    uint64_t decided_ns;
    /** The utterance that it answers, 0 for none. */
    uint64_t utterance;
    /** Text to say. */
    whichone_text_244_t text;
} whichone_robot_act_t;
WHICHONE_ASSERT(sizeof(whichone_robot_act_t) == 320, "size of RobotAct");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, act) == 0, "offset of RobotAct.act");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, interaction) == 8, "offset of RobotAct.interaction");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, prompt) == 16, "offset of RobotAct.prompt");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, presentation) == 24, "offset of RobotAct.presentation");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, kind) == 28, "offset of RobotAct.kind");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, in_words) == 29, "offset of RobotAct.in_words");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, reserved) == 30, "offset of RobotAct.reserved");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, question) == 32, "offset of RobotAct.question");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, object) == 40, "offset of RobotAct.object");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, attempt) == 44, "offset of RobotAct.attempt");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, scene_key) == 48, "offset of RobotAct.scene_key");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, decided_ns) == 56, "offset of RobotAct.decided_ns");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, utterance) == 64, "offset of RobotAct.utterance");
WHICHONE_ASSERT(offsetof(whichone_robot_act_t, text) == 72, "offset of RobotAct.text");
#define WHICHONE_ROBOT_ACT_TYPE "RobotAct"
#define WHICHONE_ROBOT_ACT_SCHEMA "0b532968dd30c91a"

/** The latest prompt that was said. Speech to policy. */
typedef struct whichone_presented {
    /** `PromptId`. */
    uint64_t prompt;
    /** When its sound began. */
    uint64_t started_ns;
    /** When its sound ended, 0 while it lasts. */
    uint64_t ended_ns;
    /** Which presentation of the prompt. */
    uint32_t presentation;
    /** `PresentationState`. */
    uint8_t state /* enum whichone_presentation_state */;
    /** Zero. */
    uint8_t reserved[3];
} whichone_presented_t;
WHICHONE_ASSERT(sizeof(whichone_presented_t) == 32, "size of Presented");
WHICHONE_ASSERT(offsetof(whichone_presented_t, prompt) == 0, "offset of Presented.prompt");
WHICHONE_ASSERT(offsetof(whichone_presented_t, started_ns) == 8, "offset of Presented.started_ns");
WHICHONE_ASSERT(offsetof(whichone_presented_t, ended_ns) == 16, "offset of Presented.ended_ns");
WHICHONE_ASSERT(offsetof(whichone_presented_t, presentation) == 24, "offset of Presented.presentation");
WHICHONE_ASSERT(offsetof(whichone_presented_t, state) == 28, "offset of Presented.state");
WHICHONE_ASSERT(offsetof(whichone_presented_t, reserved) == 29, "offset of Presented.reserved");
#define WHICHONE_PRESENTED_TYPE "Presented"
#define WHICHONE_PRESENTED_SCHEMA "fbc66b0d2815aa74"

/** Speech activity of a user. Speech to policy, which stays silent meanwhile. */
typedef struct whichone_activity {
    /** Start of the user's speech, 0 while there is none. */
    uint64_t onset_ns;
    /** Sounds that are still being recognised, and utterances that are not yet applied. */
    uint32_t pending;
    /** `EarState`. */
    uint8_t ear /* enum whichone_ear_state */;
    /** Zero. */
    uint8_t reserved[3];
} whichone_activity_t;
WHICHONE_ASSERT(sizeof(whichone_activity_t) == 16, "size of Activity");
WHICHONE_ASSERT(offsetof(whichone_activity_t, onset_ns) == 0, "offset of Activity.onset_ns");
WHICHONE_ASSERT(offsetof(whichone_activity_t, pending) == 8, "offset of Activity.pending");
WHICHONE_ASSERT(offsetof(whichone_activity_t, ear) == 12, "offset of Activity.ear");
WHICHONE_ASSERT(offsetof(whichone_activity_t, reserved) == 13, "offset of Activity.reserved");
#define WHICHONE_ACTIVITY_TYPE "Activity"
#define WHICHONE_ACTIVITY_SCHEMA "e0bdb0b6578b377d"

/** Quality of the robot's hearing. Speech to clients. */
typedef struct whichone_hearing {
    /** When the last utterance began to be heard, 0 for none. */
    uint64_t onset_ns;
    /** Loudness of the microphone over the last fifth of a second, decibels below full scale, -100 where
    nothing is known. */
    float level_db;
    /** Level of the last utterance above the noise around it, decibels, 0 to 60. */
    float snr_db;
    /** Times that the microphone's program died. */
    uint32_t restarts;
    /** Utterances lost because too much was said at a time. */
    uint32_t dropped;
    /** Utterances that are being spoken or recognised. */
    uint32_t pending;
    /** `EarState`. */
    uint8_t ear /* enum whichone_ear_state */;
    /** `MicrophoneState`. */
    uint8_t microphone /* enum whichone_microphone_state */;
    /** 1 where the last utterance was spoken (`snr_db` counts). */
    uint8_t measured;
    /** Zero. */
    uint8_t reserved;
    /** The program that records, or why there is none. */
    whichone_text_204_t note;
} whichone_hearing_t;
WHICHONE_ASSERT(sizeof(whichone_hearing_t) == 240, "size of Hearing");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, onset_ns) == 0, "offset of Hearing.onset_ns");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, level_db) == 8, "offset of Hearing.level_db");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, snr_db) == 12, "offset of Hearing.snr_db");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, restarts) == 16, "offset of Hearing.restarts");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, dropped) == 20, "offset of Hearing.dropped");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, pending) == 24, "offset of Hearing.pending");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, ear) == 28, "offset of Hearing.ear");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, microphone) == 29, "offset of Hearing.microphone");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, measured) == 30, "offset of Hearing.measured");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, reserved) == 31, "offset of Hearing.reserved");
WHICHONE_ASSERT(offsetof(whichone_hearing_t, note) == 32, "offset of Hearing.note");
#define WHICHONE_HEARING_TYPE "Hearing"
#define WHICHONE_HEARING_SCHEMA "7248920805776846"

/** Interim result of an utterance that is still being spoken; the receipt holds the final one. Speech to
clients. */
typedef struct whichone_partial {
    /** `RequestKey` that the utterance's receipt will have. */
    uint8_t stream[16];
    /** When the person began to speak. */
    uint64_t onset_ns;
    /** Rises with every message of this incarnation. */
    uint64_t number;
    /** The `segment` that the utterance's receipt will have. */
    uint32_t segment;
    /** 1 where the utterance has its result; the text is empty then. */
    uint8_t over;
    /** Zero. */
    uint8_t reserved[3];
    /** The words so far; empty until there are any. */
    whichone_text_500_t text;
} whichone_partial_t;
WHICHONE_ASSERT(sizeof(whichone_partial_t) == 544, "size of Partial");
WHICHONE_ASSERT(offsetof(whichone_partial_t, stream) == 0, "offset of Partial.stream");
WHICHONE_ASSERT(offsetof(whichone_partial_t, onset_ns) == 16, "offset of Partial.onset_ns");
WHICHONE_ASSERT(offsetof(whichone_partial_t, number) == 24, "offset of Partial.number");
WHICHONE_ASSERT(offsetof(whichone_partial_t, segment) == 32, "offset of Partial.segment");
WHICHONE_ASSERT(offsetof(whichone_partial_t, over) == 36, "offset of Partial.over");
WHICHONE_ASSERT(offsetof(whichone_partial_t, reserved) == 37, "offset of Partial.reserved");
WHICHONE_ASSERT(offsetof(whichone_partial_t, text) == 40, "offset of Partial.text");
#define WHICHONE_PARTIAL_TYPE "Partial"
#define WHICHONE_PARTIAL_SCHEMA "d3fca29dd0fc18fa"

/** A piece of a stream of sound. Clients to speech. Chunks may be lost: the robot hears silence then. */
typedef struct whichone_audio_chunk {
    /** `RequestKey` of the stream, made by the client. */
    uint8_t stream[16];
    /** Number of the chunk in its stream, from 0. */
    uint64_t number;
    /** Samples of the stream before this chunk. */
    uint64_t first_sample;
    /** When its first sample was taken, monotonic clock. */
    uint64_t taken_ns;
    /** Number of used entries of `samples`. */
    uint32_t count;
    /** Sum of `AudioChunk::END`, `AudioChunk::HELD` and `AudioChunk::ECHO_FREE`. */
    uint8_t flags;
    /** Zero. */
    uint8_t reserved[3];
    /** The sound. */
    int16_t samples[WHICHONE_CHUNK_SAMPLES_MAX];
} whichone_audio_chunk_t;
WHICHONE_ASSERT(sizeof(whichone_audio_chunk_t) == 3248, "size of AudioChunk");
WHICHONE_ASSERT(offsetof(whichone_audio_chunk_t, stream) == 0, "offset of AudioChunk.stream");
WHICHONE_ASSERT(offsetof(whichone_audio_chunk_t, number) == 16, "offset of AudioChunk.number");
WHICHONE_ASSERT(offsetof(whichone_audio_chunk_t, first_sample) == 24, "offset of AudioChunk.first_sample");
WHICHONE_ASSERT(offsetof(whichone_audio_chunk_t, taken_ns) == 32, "offset of AudioChunk.taken_ns");
WHICHONE_ASSERT(offsetof(whichone_audio_chunk_t, count) == 40, "offset of AudioChunk.count");
WHICHONE_ASSERT(offsetof(whichone_audio_chunk_t, flags) == 44, "offset of AudioChunk.flags");
WHICHONE_ASSERT(offsetof(whichone_audio_chunk_t, reserved) == 45, "offset of AudioChunk.reserved");
WHICHONE_ASSERT(offsetof(whichone_audio_chunk_t, samples) == 48, "offset of AudioChunk.samples");
#define WHICHONE_AUDIO_CHUNK_TYPE "AudioChunk"
#define WHICHONE_AUDIO_CHUNK_SCHEMA "4d400d4fde189f11"

/** Answer to an injection, or what a microphone heard. Speech to clients. */
typedef struct whichone_receipt {
    /** `RequestKey` of the injection; one of its own for what a microphone heard. */
    uint8_t key[16];
    /** `UtteranceSeq` given, 0 where refused. */
    uint64_t seq;
    /** Which piece of the sound, 0 for text; of a stream the tenth of a second in which it began. */
    uint32_t segment;
    /** Pieces in all; of a stream 0, and with `ReceiptStatus::Over` its utterances. */
    uint32_t segments;
    /** When the person began to speak; 0 where nothing was heard. */
    uint64_t onset_ns;
    /** When the person had ended. */
    uint64_t end_ns;
    /** Probability of the text heard among all that it may have been, 0 to 1; 1 for text. */
    float confidence;
    /** Level of the speech above the noise around it, decibels, 0 to 60; 0 for text. */
    float snr_db;
    /** How much of it is about the scene, 0 to 1, where the verdict is `GateVerdict::OtherTalk`. */
    float gate_score;
    /** `ReceiptStatus`. */
    uint8_t status /* enum whichone_receipt_status */;
    /** `Source`. */
    uint8_t source /* enum whichone_source */;
    /** `GateVerdict` on speech. */
    uint8_t verdict /* enum whichone_gate_verdict */;
    /** `SecondState`. */
    uint8_t second /* enum whichone_second_state */;
    /** The text heard, or why it was refused. */
    whichone_text_500_t note;
    /** Best words of the first recogniser; empty for text, and after a restart. */
    whichone_text_200_t first_text;
    /** Words of the second recogniser, where it was heard. */
    whichone_text_200_t second_text;
} whichone_receipt_t;
WHICHONE_ASSERT(sizeof(whichone_receipt_t) == 976, "size of Receipt");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, key) == 0, "offset of Receipt.key");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, seq) == 16, "offset of Receipt.seq");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, segment) == 24, "offset of Receipt.segment");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, segments) == 28, "offset of Receipt.segments");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, onset_ns) == 32, "offset of Receipt.onset_ns");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, end_ns) == 40, "offset of Receipt.end_ns");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, confidence) == 48, "offset of Receipt.confidence");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, snr_db) == 52, "offset of Receipt.snr_db");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, gate_score) == 56, "offset of Receipt.gate_score");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, status) == 60, "offset of Receipt.status");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, source) == 61, "offset of Receipt.source");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, verdict) == 62, "offset of Receipt.verdict");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, second) == 63, "offset of Receipt.second");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, note) == 64, "offset of Receipt.note");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, first_text) == 568, "offset of Receipt.first_text");
WHICHONE_ASSERT(offsetof(whichone_receipt_t, second_text) == 772, "offset of Receipt.second_text");
#define WHICHONE_RECEIPT_TYPE "Receipt"
#define WHICHONE_RECEIPT_SCHEMA "182b8dea5739e0ca"

/** State of the arm executor. Arm to policy and speech. */
typedef struct whichone_arm_status {
    /** `InteractionId` of the latest pick. */
    uint64_t interaction;
    /** `ActId` of the pointing question that the gripper aims at, 0 for none. */
    uint64_t aimed_act;
    /** Attempt of the latest pick. */
    uint32_t attempt;
    /** `ObjectId` of the latest pick. */
    uint32_t object;
    /** `PickPhase` of the latest pick. */
    uint8_t phase /* enum whichone_pick_phase */;
    /** `PickOutcome` of the latest pick. */
    uint8_t outcome /* enum whichone_pick_outcome */;
    /** 1 while the motion stop is latched. */
    uint8_t stopped;
    /** 1 while any joint moves. */
    uint8_t moving;
    /** `MotionInhibit`. */
    uint8_t hindrance /* enum whichone_motion_inhibit */;
    /** `Task` of the latest pick. */
    uint8_t task /* enum whichone_task */;
    /** Zero. */
    uint8_t reserved[2];
    /** Expected seconds until the pick is done, 0 where none runs. */
    double remaining_s;
    /** `StopId` of the motion stop in force, 0 for none: a release names it. */
    uint64_t stop;
} whichone_arm_status_t;
WHICHONE_ASSERT(sizeof(whichone_arm_status_t) == 48, "size of ArmStatus");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, interaction) == 0, "offset of ArmStatus.interaction");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, aimed_act) == 8, "offset of ArmStatus.aimed_act");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, attempt) == 16, "offset of ArmStatus.attempt");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, object) == 20, "offset of ArmStatus.object");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, phase) == 24, "offset of ArmStatus.phase");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, outcome) == 25, "offset of ArmStatus.outcome");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, stopped) == 26, "offset of ArmStatus.stopped");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, moving) == 27, "offset of ArmStatus.moving");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, hindrance) == 28, "offset of ArmStatus.hindrance");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, task) == 29, "offset of ArmStatus.task");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, reserved) == 30, "offset of ArmStatus.reserved");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, remaining_s) == 32, "offset of ArmStatus.remaining_s");
WHICHONE_ASSERT(offsetof(whichone_arm_status_t, stop) == 40, "offset of ArmStatus.stop");
#define WHICHONE_ARM_STATUS_TYPE "ArmStatus"
#define WHICHONE_ARM_STATUS_SCHEMA "8b147729fca6b4f3"

/** Joint states, at 100 Hz while the arm is busy, in the order of `JOINT_STATE_NAMES`. Arm to clients. */
typedef struct whichone_joint_states {
    /** When the joints were so. */
    uint64_t at_ns;
    /** Position, radians. */
    double position[WHICHONE_JOINT_STATE_LEN];
    /** Velocity, radians a second. */
    double velocity[WHICHONE_JOINT_STATE_LEN];
    /** Effort, newton metres; the kinematic arm has none. */
    double effort[WHICHONE_JOINT_STATE_LEN];
    /** Opening of the left and right gripper, percent of its range. */
    double gripper_percent[2];
} whichone_joint_states_t;
WHICHONE_ASSERT(sizeof(whichone_joint_states_t) == 432, "size of JointStates");
WHICHONE_ASSERT(offsetof(whichone_joint_states_t, at_ns) == 0, "offset of JointStates.at_ns");
WHICHONE_ASSERT(offsetof(whichone_joint_states_t, position) == 8, "offset of JointStates.position");
WHICHONE_ASSERT(offsetof(whichone_joint_states_t, velocity) == 144, "offset of JointStates.velocity");
WHICHONE_ASSERT(offsetof(whichone_joint_states_t, effort) == 280, "offset of JointStates.effort");
WHICHONE_ASSERT(offsetof(whichone_joint_states_t, gripper_percent) == 416, "offset of JointStates.gripper_percent");
#define WHICHONE_JOINT_STATES_TYPE "JointStates"
#define WHICHONE_JOINT_STATES_SCHEMA "b61683a36126fd0b"

/** `baxter_core_msgs/JointCommand`: what the joints of one limb are to do now. A limb that has heard none
for 0.2 s (`joint_command_timeout`) goes back to holding its position. */
typedef struct whichone_joint_command {
    /** `JointMode`. */
    int32_t mode;
    /** Number of used entries below. */
    uint32_t len;
    /** Radians or rad/s, after the mode. */
    double command[WHICHONE_LIMB_JOINTS];
    /** The joints' names, in the order of `command`. */
    whichone_text_28_t names[WHICHONE_LIMB_JOINTS];
} whichone_joint_command_t;
WHICHONE_ASSERT(sizeof(whichone_joint_command_t) == 288, "size of JointCommand");
WHICHONE_ASSERT(offsetof(whichone_joint_command_t, mode) == 0, "offset of JointCommand.mode");
WHICHONE_ASSERT(offsetof(whichone_joint_command_t, len) == 4, "offset of JointCommand.len");
WHICHONE_ASSERT(offsetof(whichone_joint_command_t, command) == 8, "offset of JointCommand.command");
WHICHONE_ASSERT(offsetof(whichone_joint_command_t, names) == 64, "offset of JointCommand.names");
#define WHICHONE_JOINT_COMMAND_TYPE "JointCommand"
#define WHICHONE_JOINT_COMMAND_SCHEMA "aeb1a9869cb128a1"

/** `sensor_msgs/JointState`: what was measured, by name. Baxter sends its 17 joints in alphabetical
order, and the joint of an electric gripper's finger in messages of their own, so readers look for names
and never for places. */
typedef struct whichone_joint_state {
    /** `header.stamp`, monotonic clock. */
    uint64_t stamp_ns;
    /** Number of used entries below. */
    uint32_t len;
    /** Zero. */
    uint32_t reserved;
    /** The joints' names. */
    whichone_text_28_t name[WHICHONE_JOINTS_MAX];
    /** Positions, radians; metres for a finger. */
    double position[WHICHONE_JOINTS_MAX];
    /** Velocities, rad/s; m/s for a finger. */
    double velocity[WHICHONE_JOINTS_MAX];
    /** Torques, newton metres; newtons for a finger. */
    double effort[WHICHONE_JOINTS_MAX];
} whichone_joint_state_t;
WHICHONE_ASSERT(sizeof(whichone_joint_state_t) == 968, "size of JointState");
WHICHONE_ASSERT(offsetof(whichone_joint_state_t, stamp_ns) == 0, "offset of JointState.stamp_ns");
WHICHONE_ASSERT(offsetof(whichone_joint_state_t, len) == 8, "offset of JointState.len");
WHICHONE_ASSERT(offsetof(whichone_joint_state_t, reserved) == 12, "offset of JointState.reserved");
WHICHONE_ASSERT(offsetof(whichone_joint_state_t, name) == 16, "offset of JointState.name");
WHICHONE_ASSERT(offsetof(whichone_joint_state_t, position) == 560, "offset of JointState.position");
WHICHONE_ASSERT(offsetof(whichone_joint_state_t, velocity) == 696, "offset of JointState.velocity");
WHICHONE_ASSERT(offsetof(whichone_joint_state_t, effort) == 832, "offset of JointState.effort");
#define WHICHONE_JOINT_STATE_TYPE "JointState"
#define WHICHONE_JOINT_STATE_SCHEMA "5a68e470198c953b"

/** `trajectory_msgs/JointTrajectoryPoint` on `inverse_dynamics_command`: where the commanded motion is,
how fast, and how it accelerates, joints in the order s0, s1, e0, e1, w0, w1, w2. Feed-forward: the robot
computes the torques that this takes and lags less. */
typedef struct whichone_joint_trajectory_point {
    /** Radians. */
    double positions[WHICHONE_LIMB_JOINTS];
    /** rad/s. */
    double velocities[WHICHONE_LIMB_JOINTS];
    /** rad/s². */
    double accelerations[WHICHONE_LIMB_JOINTS];
    /** Seconds since the motion began. */
    double time_from_start_s;
} whichone_joint_trajectory_point_t;
WHICHONE_ASSERT(sizeof(whichone_joint_trajectory_point_t) == 176, "size of JointTrajectoryPoint");
WHICHONE_ASSERT(offsetof(whichone_joint_trajectory_point_t, positions) == 0, "offset of JointTrajectoryPoint.positions");
WHICHONE_ASSERT(offsetof(whichone_joint_trajectory_point_t, velocities) == 56, "offset of JointTrajectoryPoint.velocities");
WHICHONE_ASSERT(offsetof(whichone_joint_trajectory_point_t, accelerations) == 112, "offset of JointTrajectoryPoint.accelerations");
WHICHONE_ASSERT(offsetof(whichone_joint_trajectory_point_t, time_from_start_s) == 168, "offset of JointTrajectoryPoint.time_from_start_s");
#define WHICHONE_JOINT_TRAJECTORY_POINT_TYPE "JointTrajectoryPoint"
#define WHICHONE_JOINT_TRAJECTORY_POINT_SCHEMA "762a70a65dadbe77"

/** `std_msgs/Float64` on `set_speed_ratio`: the share of its greatest velocity that a limb may use in
position mode; 0.3 until the first message. */
typedef struct whichone_speed_ratio {
    /** 0 to 1. */
    double data;
} whichone_speed_ratio_t;
WHICHONE_ASSERT(sizeof(whichone_speed_ratio_t) == 8, "size of SpeedRatio");
WHICHONE_ASSERT(offsetof(whichone_speed_ratio_t, data) == 0, "offset of SpeedRatio.data");
#define WHICHONE_SPEED_RATIO_TYPE "SpeedRatio"
#define WHICHONE_SPEED_RATIO_SCHEMA "49de834c30d97b0b"

/** `baxter_core_msgs/EndpointState`: the tip of `<limb>_gripper`. */
typedef struct whichone_endpoint_state {
    /** `header.stamp`, monotonic clock. */
    uint64_t stamp_ns;
    /** Position in `base`, metres, and orientation, quaternion x, y, z, w. */
    double pose[7];
    /** Linear velocity, m/s, and angular velocity, rad/s, axes of `base`. */
    double twist[6];
    /** Force, newtons, and torque, newton metres. */
    double wrench[6];
} whichone_endpoint_state_t;
WHICHONE_ASSERT(sizeof(whichone_endpoint_state_t) == 160, "size of EndpointState");
WHICHONE_ASSERT(offsetof(whichone_endpoint_state_t, stamp_ns) == 0, "offset of EndpointState.stamp_ns");
WHICHONE_ASSERT(offsetof(whichone_endpoint_state_t, pose) == 8, "offset of EndpointState.pose");
WHICHONE_ASSERT(offsetof(whichone_endpoint_state_t, twist) == 64, "offset of EndpointState.twist");
WHICHONE_ASSERT(offsetof(whichone_endpoint_state_t, wrench) == 112, "offset of EndpointState.wrench");
#define WHICHONE_ENDPOINT_STATE_TYPE "EndpointState"
#define WHICHONE_ENDPOINT_STATE_SCHEMA "3fddff69cb12608f"

/** `baxter_core_msgs/EndEffectorCommand`. */
typedef struct whichone_end_effector_command {
    /** The gripper's own number, from its state. */
    uint32_t id;
    /** Comes back in the state once the command is handled. */
    uint32_t sequence;
    /** `calibrate`, `go`, `grip`, `release`, `stop` or `configure`. */
    whichone_text_28_t command;
    /** JSON; for `go` as `{"position": 50.0}`, for `configure` as `{"holding_force": 100.0}`. */
    whichone_text_60_t args;
    /** Comes back in the state once the command is handled. */
    whichone_text_28_t sender;
} whichone_end_effector_command_t;
WHICHONE_ASSERT(sizeof(whichone_end_effector_command_t) == 136, "size of EndEffectorCommand");
WHICHONE_ASSERT(offsetof(whichone_end_effector_command_t, id) == 0, "offset of EndEffectorCommand.id");
WHICHONE_ASSERT(offsetof(whichone_end_effector_command_t, sequence) == 4, "offset of EndEffectorCommand.sequence");
WHICHONE_ASSERT(offsetof(whichone_end_effector_command_t, command) == 8, "offset of EndEffectorCommand.command");
WHICHONE_ASSERT(offsetof(whichone_end_effector_command_t, args) == 40, "offset of EndEffectorCommand.args");
WHICHONE_ASSERT(offsetof(whichone_end_effector_command_t, sender) == 104, "offset of EndEffectorCommand.sender");
#define WHICHONE_END_EFFECTOR_COMMAND_TYPE "EndEffectorCommand"
#define WHICHONE_END_EFFECTOR_COMMAND_SCHEMA "47ba4d74164ce7d6"

/** `baxter_core_msgs/EndEffectorState`. The bytes are `Tristate`s. */
typedef struct whichone_end_effector_state {
    /** When the state was so, monotonic clock. */
    uint64_t timestamp_ns;
    /** The gripper's own number. */
    uint32_t id;
    /** True if it is switched on. */
    uint8_t enabled /* enum whichone_tristate */;
    /** True if it has been calibrated. */
    uint8_t calibrated /* enum whichone_tristate */;
    /** True if it accepts commands. */
    uint8_t ready /* enum whichone_tristate */;
    /** True if the fingers are moving. */
    uint8_t moving /* enum whichone_tristate */;
    /** True if the fingers stopped at something: the force threshold was met on the way. */
    uint8_t gripping /* enum whichone_tristate */;
    /** True if the fingers came to the end of a command without meeting anything. */
    uint8_t missed /* enum whichone_tristate */;
    /** True if it has a fault; it has to be reset then. */
    uint8_t error /* enum whichone_tristate */;
    /** True if it grips by opening. */
    uint8_t reverse /* enum whichone_tristate */;
    /** Percent: 0 closed, 100 open. */
    float position;
    /** Percent of the greatest force. */
    float force;
    /** Sequence number of the last command that was handled, or `NO_SEQUENCE`. */
    uint32_t command_sequence;
    /** The last command. */
    whichone_text_28_t command;
    /** The sender. */
    whichone_text_28_t command_sender;
} whichone_end_effector_state_t;
WHICHONE_ASSERT(sizeof(whichone_end_effector_state_t) == 96, "size of EndEffectorState");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, timestamp_ns) == 0, "offset of EndEffectorState.timestamp_ns");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, id) == 8, "offset of EndEffectorState.id");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, enabled) == 12, "offset of EndEffectorState.enabled");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, calibrated) == 13, "offset of EndEffectorState.calibrated");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, ready) == 14, "offset of EndEffectorState.ready");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, moving) == 15, "offset of EndEffectorState.moving");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, gripping) == 16, "offset of EndEffectorState.gripping");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, missed) == 17, "offset of EndEffectorState.missed");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, error) == 18, "offset of EndEffectorState.error");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, reverse) == 19, "offset of EndEffectorState.reverse");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, position) == 20, "offset of EndEffectorState.position");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, force) == 24, "offset of EndEffectorState.force");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, command_sequence) == 28, "offset of EndEffectorState.command_sequence");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, command) == 32, "offset of EndEffectorState.command");
WHICHONE_ASSERT(offsetof(whichone_end_effector_state_t, command_sender) == 64, "offset of EndEffectorState.command_sender");
#define WHICHONE_END_EFFECTOR_STATE_TYPE "EndEffectorState"
#define WHICHONE_END_EFFECTOR_STATE_SCHEMA "5ad5059d9701b48d"

/** `baxter_core_msgs/EndEffectorProperties`: what is mounted. Text fields beyond product and serial
number stay behind: nothing here depends on them. */
typedef struct whichone_end_effector_properties {
    /** The gripper's own number. */
    uint32_t id;
    /** `UiType`. */
    uint8_t ui_type /* enum whichone_ui_type */;
    /** 1 if it has to be calibrated. */
    uint8_t has_calibration;
    /** 1 if it obeys `grip` and `release`. */
    uint8_t controls_grip;
    /** 1 if it feels what it grips. */
    uint8_t senses_grip;
    /** 1 if it can grip by opening. */
    uint8_t reverses_grip;
    /** 1 if its force can be set. */
    uint8_t controls_force;
    /** 1 if it measures its force. */
    uint8_t senses_force;
    /** 1 if it obeys `go`. */
    uint8_t controls_position;
    /** 1 if it measures its position. */
    uint8_t senses_position;
    /** Zero. */
    uint8_t reserved[3];
    /** The manufacturer. */
    whichone_text_60_t manufacturer;
    /** The product name. */
    whichone_text_60_t product;
    /** Its serial number. */
    whichone_text_28_t serial_number;
} whichone_end_effector_properties_t;
WHICHONE_ASSERT(sizeof(whichone_end_effector_properties_t) == 176, "size of EndEffectorProperties");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, id) == 0, "offset of EndEffectorProperties.id");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, ui_type) == 4, "offset of EndEffectorProperties.ui_type");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, has_calibration) == 5, "offset of EndEffectorProperties.has_calibration");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, controls_grip) == 6, "offset of EndEffectorProperties.controls_grip");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, senses_grip) == 7, "offset of EndEffectorProperties.senses_grip");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, reverses_grip) == 8, "offset of EndEffectorProperties.reverses_grip");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, controls_force) == 9, "offset of EndEffectorProperties.controls_force");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, senses_force) == 10, "offset of EndEffectorProperties.senses_force");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, controls_position) == 11, "offset of EndEffectorProperties.controls_position");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, senses_position) == 12, "offset of EndEffectorProperties.senses_position");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, reserved) == 13, "offset of EndEffectorProperties.reserved");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, manufacturer) == 16, "offset of EndEffectorProperties.manufacturer");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, product) == 80, "offset of EndEffectorProperties.product");
WHICHONE_ASSERT(offsetof(whichone_end_effector_properties_t, serial_number) == 144, "offset of EndEffectorProperties.serial_number");
#define WHICHONE_END_EFFECTOR_PROPERTIES_TYPE "EndEffectorProperties"
#define WHICHONE_END_EFFECTOR_PROPERTIES_SCHEMA "3cecfb4e9a325ced"

/** `baxter_core_msgs/AssemblyState` on `/robot/state`. */
typedef struct whichone_assembly_state {
    /** 1 if it is enabled and takes commands: not homing, for example. */
    uint8_t ready;
    /** 1 if its motors are on. */
    uint8_t enabled;
    /** 1 while an emergency stop holds, until the robot is reset. */
    uint8_t stopped;
    /** 1 if a part of it has a fault. */
    uint8_t error;
    /** `EstopButton`. */
    uint8_t estop_button /* enum whichone_estop_button */;
    /** Cause of the stop: 0 none, 1 a person, 2 unknown, 3 a joint's fault, 4 its computer. */
    uint8_t estop_source;
    /** Zero. */
    uint8_t reserved[2];
} whichone_assembly_state_t;
WHICHONE_ASSERT(sizeof(whichone_assembly_state_t) == 8, "size of AssemblyState");
WHICHONE_ASSERT(offsetof(whichone_assembly_state_t, ready) == 0, "offset of AssemblyState.ready");
WHICHONE_ASSERT(offsetof(whichone_assembly_state_t, enabled) == 1, "offset of AssemblyState.enabled");
WHICHONE_ASSERT(offsetof(whichone_assembly_state_t, stopped) == 2, "offset of AssemblyState.stopped");
WHICHONE_ASSERT(offsetof(whichone_assembly_state_t, error) == 3, "offset of AssemblyState.error");
WHICHONE_ASSERT(offsetof(whichone_assembly_state_t, estop_button) == 4, "offset of AssemblyState.estop_button");
WHICHONE_ASSERT(offsetof(whichone_assembly_state_t, estop_source) == 5, "offset of AssemblyState.estop_source");
WHICHONE_ASSERT(offsetof(whichone_assembly_state_t, reserved) == 6, "offset of AssemblyState.reserved");
#define WHICHONE_ASSEMBLY_STATE_TYPE "AssemblyState"
#define WHICHONE_ASSEMBLY_STATE_SCHEMA "c8e08929b466579e"

/** Something that happens to the simulated robot. Clients to the simulated robot; a real one has no such
topic. */
typedef struct whichone_drill {
    /** Made by the client; a drill that comes twice happens once. */
    uint64_t key;
    /** Seconds or a number, after the kind. */
    double amount;
    /** Key of the scene file that `object` is from. */
    uint64_t scene_key;
    /** Where the object is put: centre in frame `base`, metres, and yaw, radians. */
    double place[4];
    /** Which object of the scene file is put or taken. */
    uint16_t object;
    /** `DrillKind`. */
    uint8_t kind /* enum whichone_drill_kind */;
    /** Zero. */
    uint8_t reserved[5];
} whichone_drill_t;
WHICHONE_ASSERT(sizeof(whichone_drill_t) == 64, "size of Drill");
WHICHONE_ASSERT(offsetof(whichone_drill_t, key) == 0, "offset of Drill.key");
WHICHONE_ASSERT(offsetof(whichone_drill_t, amount) == 8, "offset of Drill.amount");
WHICHONE_ASSERT(offsetof(whichone_drill_t, scene_key) == 16, "offset of Drill.scene_key");
WHICHONE_ASSERT(offsetof(whichone_drill_t, place) == 24, "offset of Drill.place");
WHICHONE_ASSERT(offsetof(whichone_drill_t, object) == 56, "offset of Drill.object");
WHICHONE_ASSERT(offsetof(whichone_drill_t, kind) == 58, "offset of Drill.kind");
WHICHONE_ASSERT(offsetof(whichone_drill_t, reserved) == 59, "offset of Drill.reserved");
#define WHICHONE_DRILL_TYPE "Drill"
#define WHICHONE_DRILL_SCHEMA "e7e4101d0e5c7dab"

/* Payloads without a structure: postcard in a slice of bytes. */
#define WHICHONE_INJECTION_SCHEMA "4c4f7035bc34a0cc"
#define WHICHONE_POLICY_VIEW_SCHEMA "0f26593076b2e607"
#define WHICHONE_WORLD_VIEW_SCHEMA "5c25bcd9afb51360"
#define WHICHONE_TRAJECTORY_VIEW_SCHEMA "531c464cf29b0cf3"
#define WHICHONE_SIGHTING_SCHEMA "3238153cdb355974"
#define WHICHONE_TABLE_VIEW_SCHEMA "fe080376f9e15322"

/** A topic. */
typedef struct whichone_topic {
    const char *name;
    /** Name of the type for iceoryx2; "u8" where the payload is postcard in a slice of bytes. */
    const char *type;
    /** Key of the layout, an attribute of the topic that both sides must agree on. */
    const char *schema;
    /** Bytes of a message and their alignment; size 0 for a slice of bytes. */
    size_t size, alignment;
    /** The service that writes it; NULL where clients do. */
    const char *writer;
    /** Services that are woken after a message, up to a NULL. */
    const char *wakes[4];
    /** Unread messages that a reader holds, and messages that a late reader still gets. */
    size_t buffer, history;
} whichone_topic_t;

/** Carries Injection. */
static const whichone_topic_t whichone_speech_inject = {
    "speech/inject", "u8", WHICHONE_INJECTION_SCHEMA, 0, 1, NULL, {"speech", "recorder", NULL}, 16, 0};
/** Carries AudioChunk. */
static const whichone_topic_t whichone_speech_audio = {
    "speech/audio", "AudioChunk", WHICHONE_AUDIO_CHUNK_SCHEMA, sizeof(whichone_audio_chunk_t), _Alignof(whichone_audio_chunk_t), NULL, {"speech", NULL}, 64, 0};
/** Carries Receipt. */
static const whichone_topic_t whichone_speech_receipt = {
    "speech/receipt", "Receipt", WHICHONE_RECEIPT_SCHEMA, sizeof(whichone_receipt_t), _Alignof(whichone_receipt_t), "speech", {NULL}, 16, 16};
/** Carries Utterance. */
static const whichone_topic_t whichone_speech_utterance = {
    "speech/utterance", "Utterance", WHICHONE_UTTERANCE_SCHEMA, sizeof(whichone_utterance_t), _Alignof(whichone_utterance_t), "speech", {"grounding", NULL}, 16, 16};
/** Carries Presented. */
static const whichone_topic_t whichone_speech_presented = {
    "speech/presented", "Presented", WHICHONE_PRESENTED_SCHEMA, sizeof(whichone_presented_t), _Alignof(whichone_presented_t), "speech", {"policy", "console", NULL}, 1, 1};
/** Carries Activity. */
static const whichone_topic_t whichone_speech_activity = {
    "speech/activity", "Activity", WHICHONE_ACTIVITY_SCHEMA, sizeof(whichone_activity_t), _Alignof(whichone_activity_t), "speech", {"policy", NULL}, 1, 1};
/** Carries Hearing. */
static const whichone_topic_t whichone_speech_hearing = {
    "speech/hearing", "Hearing", WHICHONE_HEARING_SCHEMA, sizeof(whichone_hearing_t), _Alignof(whichone_hearing_t), "speech", {NULL}, 1, 1};
/** Carries Partial. */
static const whichone_topic_t whichone_speech_partial = {
    "speech/partial", "Partial", WHICHONE_PARTIAL_SCHEMA, sizeof(whichone_partial_t), _Alignof(whichone_partial_t), "speech", {NULL}, 16, 1};
/** Carries Observation. */
static const whichone_topic_t whichone_grounding_observation = {
    "grounding/observation", "Observation", WHICHONE_OBSERVATION_SCHEMA, sizeof(whichone_observation_t), _Alignof(whichone_observation_t), "grounding", {"policy", NULL}, 16, 16};
/** Carries AppliedMark. */
static const whichone_topic_t whichone_policy_mark = {
    "policy/mark", "AppliedMark", WHICHONE_APPLIED_MARK_SCHEMA, sizeof(whichone_applied_mark_t), _Alignof(whichone_applied_mark_t), "policy", {"speech", NULL}, 1, 1};
/** Carries RobotAct. */
static const whichone_topic_t whichone_policy_act = {
    "policy/act", "RobotAct", WHICHONE_ROBOT_ACT_SCHEMA, sizeof(whichone_robot_act_t), _Alignof(whichone_robot_act_t), "policy", {"speech", "arm", "console", NULL}, 1, 1};
/** Carries Sighting. */
static const whichone_topic_t whichone_scene_sightings = {
    "scene/sightings", "u8", WHICHONE_SIGHTING_SCHEMA, 0, 1, NULL, {"policy", "recorder", NULL}, 16, 0};
/** Carries TableView. */
static const whichone_topic_t whichone_scene_objects = {
    "scene/objects", "u8", WHICHONE_TABLE_VIEW_SCHEMA, 0, 1, "policy", {"arm", NULL}, 1, 1};
/** Carries Forget. */
static const whichone_topic_t whichone_policy_forget = {
    "policy/forget", "Forget", WHICHONE_FORGET_SCHEMA, sizeof(whichone_forget_t), _Alignof(whichone_forget_t), NULL, {"policy", NULL}, 1, 0};
/** Carries PolicyView. */
static const whichone_topic_t whichone_policy_view = {
    "policy/view", "u8", WHICHONE_POLICY_VIEW_SCHEMA, 0, 1, "policy", {NULL}, 1, 1};
/** Carries ArmStatus. */
static const whichone_topic_t whichone_arm_status = {
    "arm/status", "ArmStatus", WHICHONE_ARM_STATUS_SCHEMA, sizeof(whichone_arm_status_t), _Alignof(whichone_arm_status_t), "arm", {"policy", "speech", "console", NULL}, 1, 1};
/** Carries JointStates. */
static const whichone_topic_t whichone_arm_joints = {
    "arm/joints", "JointStates", WHICHONE_JOINT_STATES_SCHEMA, sizeof(whichone_joint_states_t), _Alignof(whichone_joint_states_t), "arm", {"ros2", NULL}, 16, 1};
/** Carries WorldView. */
static const whichone_topic_t whichone_arm_world = {
    "arm/world", "u8", WHICHONE_WORLD_VIEW_SCHEMA, 0, 1, "arm", {NULL}, 1, 1};
/** Carries TrajectoryView. */
static const whichone_topic_t whichone_arm_trajectory = {
    "arm/trajectory", "u8", WHICHONE_TRAJECTORY_VIEW_SCHEMA, 0, 1, "arm", {NULL}, 1, 1};
/** Carries JointState. */
static const whichone_topic_t whichone_robot_joint_states = {
    "robot/joint_states", "JointState", WHICHONE_JOINT_STATE_SCHEMA, sizeof(whichone_joint_state_t), _Alignof(whichone_joint_state_t), "baxter", {"arm", NULL}, 16, 1};
/** Carries AssemblyState. */
static const whichone_topic_t whichone_robot_state = {
    "robot/state", "AssemblyState", WHICHONE_ASSEMBLY_STATE_SCHEMA, sizeof(whichone_assembly_state_t), _Alignof(whichone_assembly_state_t), "baxter", {NULL}, 1, 1};
/** Carries JointCommand. */
static const whichone_topic_t whichone_robot_limb_left_joint_command = {
    "robot/limb/left/joint_command", "JointCommand", WHICHONE_JOINT_COMMAND_SCHEMA, sizeof(whichone_joint_command_t), _Alignof(whichone_joint_command_t), "arm", {"baxter", NULL}, 4, 0};
/** Carries JointCommand. */
static const whichone_topic_t whichone_robot_limb_right_joint_command = {
    "robot/limb/right/joint_command", "JointCommand", WHICHONE_JOINT_COMMAND_SCHEMA, sizeof(whichone_joint_command_t), _Alignof(whichone_joint_command_t), "arm", {"baxter", NULL}, 4, 0};
/** Carries JointTrajectoryPoint. */
static const whichone_topic_t whichone_robot_limb_left_inverse_dynamics_command = {
    "robot/limb/left/inverse_dynamics_command", "JointTrajectoryPoint", WHICHONE_JOINT_TRAJECTORY_POINT_SCHEMA, sizeof(whichone_joint_trajectory_point_t), _Alignof(whichone_joint_trajectory_point_t), "arm", {NULL}, 4, 0};
/** Carries JointTrajectoryPoint. */
static const whichone_topic_t whichone_robot_limb_right_inverse_dynamics_command = {
    "robot/limb/right/inverse_dynamics_command", "JointTrajectoryPoint", WHICHONE_JOINT_TRAJECTORY_POINT_SCHEMA, sizeof(whichone_joint_trajectory_point_t), _Alignof(whichone_joint_trajectory_point_t), "arm", {NULL}, 4, 0};
/** Carries SpeedRatio. */
static const whichone_topic_t whichone_robot_limb_left_set_speed_ratio = {
    "robot/limb/left/set_speed_ratio", "SpeedRatio", WHICHONE_SPEED_RATIO_SCHEMA, sizeof(whichone_speed_ratio_t), _Alignof(whichone_speed_ratio_t), "arm", {NULL}, 4, 0};
/** Carries SpeedRatio. */
static const whichone_topic_t whichone_robot_limb_right_set_speed_ratio = {
    "robot/limb/right/set_speed_ratio", "SpeedRatio", WHICHONE_SPEED_RATIO_SCHEMA, sizeof(whichone_speed_ratio_t), _Alignof(whichone_speed_ratio_t), "arm", {NULL}, 4, 0};
/** Carries EndpointState. */
static const whichone_topic_t whichone_robot_limb_left_endpoint_state = {
    "robot/limb/left/endpoint_state", "EndpointState", WHICHONE_ENDPOINT_STATE_SCHEMA, sizeof(whichone_endpoint_state_t), _Alignof(whichone_endpoint_state_t), "baxter", {NULL}, 1, 1};
/** Carries EndpointState. */
static const whichone_topic_t whichone_robot_limb_right_endpoint_state = {
    "robot/limb/right/endpoint_state", "EndpointState", WHICHONE_ENDPOINT_STATE_SCHEMA, sizeof(whichone_endpoint_state_t), _Alignof(whichone_endpoint_state_t), "baxter", {NULL}, 1, 1};
/** Carries EndEffectorCommand. */
static const whichone_topic_t whichone_robot_end_effector_left_gripper_command = {
    "robot/end_effector/left_gripper/command", "EndEffectorCommand", WHICHONE_END_EFFECTOR_COMMAND_SCHEMA, sizeof(whichone_end_effector_command_t), _Alignof(whichone_end_effector_command_t), "arm", {NULL}, 4, 0};
/** Carries EndEffectorCommand. */
static const whichone_topic_t whichone_robot_end_effector_right_gripper_command = {
    "robot/end_effector/right_gripper/command", "EndEffectorCommand", WHICHONE_END_EFFECTOR_COMMAND_SCHEMA, sizeof(whichone_end_effector_command_t), _Alignof(whichone_end_effector_command_t), "arm", {NULL}, 4, 0};
/** Carries EndEffectorState. */
static const whichone_topic_t whichone_robot_end_effector_left_gripper_state = {
    "robot/end_effector/left_gripper/state", "EndEffectorState", WHICHONE_END_EFFECTOR_STATE_SCHEMA, sizeof(whichone_end_effector_state_t), _Alignof(whichone_end_effector_state_t), "baxter", {NULL}, 1, 1};
/** Carries EndEffectorState. */
static const whichone_topic_t whichone_robot_end_effector_right_gripper_state = {
    "robot/end_effector/right_gripper/state", "EndEffectorState", WHICHONE_END_EFFECTOR_STATE_SCHEMA, sizeof(whichone_end_effector_state_t), _Alignof(whichone_end_effector_state_t), "baxter", {NULL}, 1, 1};
/** Carries EndEffectorProperties. */
static const whichone_topic_t whichone_robot_end_effector_left_gripper_properties = {
    "robot/end_effector/left_gripper/properties", "EndEffectorProperties", WHICHONE_END_EFFECTOR_PROPERTIES_SCHEMA, sizeof(whichone_end_effector_properties_t), _Alignof(whichone_end_effector_properties_t), "baxter", {NULL}, 1, 1};
/** Carries EndEffectorProperties. */
static const whichone_topic_t whichone_robot_end_effector_right_gripper_properties = {
    "robot/end_effector/right_gripper/properties", "EndEffectorProperties", WHICHONE_END_EFFECTOR_PROPERTIES_SCHEMA, sizeof(whichone_end_effector_properties_t), _Alignof(whichone_end_effector_properties_t), "baxter", {NULL}, 1, 1};
/** Carries Drill. */
static const whichone_topic_t whichone_robot_drill = {
    "robot/drill", "Drill", WHICHONE_DRILL_SCHEMA, sizeof(whichone_drill_t), _Alignof(whichone_drill_t), NULL, {"baxter", NULL}, 16, 0};

#endif
