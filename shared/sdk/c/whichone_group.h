/* A process in its group: typed topics in shared memory, readiness and beats, wake-ups, and the scene's words.
 *
 * Everything belongs to one thread. Functions that can fail say why on standard error and return NULL, -1 or false.
 * Link with -lwhichone_c, which `scripts/sdk c` builds.
 */
#ifndef WHICHONE_GROUP_H
#define WHICHONE_GROUP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "whichone.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Exit codes: the start was wrong, or the group is not as the program needs it. Neither is tried again. */
enum { WHICHONE_EXIT_USAGE = 64, WHICHONE_EXIT_CONFIG = 78 };

/** A process's access to its group. */
typedef struct whichone_group whichone_group_t;
/** Reads a topic. */
typedef struct whichone_reader whichone_reader_t;
/** Writes a topic. */
typedef struct whichone_writer whichone_writer_t;

/** Joins the group as one of its services, by the environment that the supervisor sets. Takes over SIGTERM and
 * SIGINT. NULL if the program was not started by a supervisor, or the group's memory does not open. */
whichone_group_t *whichone_join_as_service(const char *service);

/** Joins a running group as a client. `group` is $WHICHONE_GROUP or "whichone" where it is NULL. */
whichone_group_t *whichone_join_as_client(const char *group);

/** Leaves the group, with all readers and writers closed before. */
void whichone_leave(whichone_group_t *group);

/** Opens a topic for reading: `whichone_open_reader(group, &whichone_speech_utterance)`. */
whichone_reader_t *whichone_open_reader(whichone_group_t *group, const whichone_topic_t *topic);

/** Opens a topic for writing. Services write the topics that are theirs, and no others. */
whichone_writer_t *whichone_open_writer(whichone_group_t *group, const whichone_topic_t *topic);

void whichone_close_reader(whichone_reader_t *reader);
void whichone_close_writer(whichone_writer_t *writer);

/** Copies the next message to `message`, which has room for `size` bytes. Returns its bytes, 0 if there is none, -1
 * if the topic fails or the message is larger. Messages of other epochs and of earlier processes are left out, those
 * with codes that their enums do not have are rejected and logged. Counts and numbers are the writer's: compare them
 * with their bounds before use. */
ptrdiff_t whichone_take(whichone_reader_t *reader, void *message, size_t size);

/** Sends a copy of a message of `size` bytes and wakes the topic's readers. Nothing waits: the oldest unread message
 * gives way. A message with a wrong size, or a code that its enum does not have, is not sent. */
bool whichone_send(whichone_writer_t *writer, const void *message, size_t size);

/** Runs a service until it is asked to end: reports that it is ready, and calls `step` with `context` after each
 * wake-up and twice a second besides; beats after each step. A step that takes longer than 3 s counts as hung.
 * Returns the exit code of the program. */
int whichone_run(whichone_group_t *group, void (*step)(void *context), void *context);

/** Nanoseconds of the monotonic clock, as all times in messages are. */
uint64_t whichone_now_ns(void);

/** Says something to the robot, as if typed, and waits at most `seconds` for its receipt. Returns the utterance's
 * number, or 0 with the reason on standard error. */
uint64_t whichone_say(whichone_group_t *group, const char *text, double seconds);

/** As `whichone_say`, for a person: `from` is a name of at most 64 bytes. What they have had fetched teaches the robot how
 * they speak; `whichone people forget` has it forget that. */
uint64_t whichone_say_from(whichone_group_t *group, const char *from, const char *text, double seconds);

/** As `whichone_say_from`, in answer to the line `seen`: the `prompt` that the person was shown last, 0 if unknown. The
 * words answer that question and no later one; they wait for a second for a line that was not said yet. */
uint64_t whichone_say_in_answer(whichone_group_t *group, const char *from, const char *text, uint64_t seen,
                                double seconds);

/** Stops the arm and latches the stop, on the motion stop's own path: it needs no shared memory and no disk. Returns
 * true once the arm is at rest. The order is repeated for `seconds`, or, if they are below 0, for as long as the group
 * runs; warnings on standard error say that it is not confirmed. On false use the robot's own emergency stop. */
bool whichone_stop_motion(const whichone_group_t *group, double seconds);

/** Releases the motion stop, within `seconds`, or 5 if they are below 0. */
bool whichone_resume_motion(const whichone_group_t *group, double seconds);

/** As `whichone_resume_motion`, for the stop that the person saw, `stop` of `whichone_arm_status_t`: if another one has
 * been given since, it holds, and false is returned. 0 stands for any. */
bool whichone_release_stop(const whichone_group_t *group, uint64_t stop, double seconds);

/** Key of the scene in force, for messages about it. */
uint64_t whichone_scene_key(const whichone_group_t *group);

/** Number of the scene's words; a word's number in messages is its place, from 0. */
size_t whichone_word_count(const whichone_group_t *group);

/** The word of this number, valid until the group is left; NULL if there is none. */
const char *whichone_word(const whichone_group_t *group, size_t number);

#ifdef __cplusplus
}
#endif

#endif
