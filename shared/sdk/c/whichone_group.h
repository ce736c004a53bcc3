/* A process in its group: typed topics in shared memory, readiness and beats, wake-ups, and the scene's words.
 *
 * Everything belongs to one thread. Functions that can fail say why on standard error and return NULL, -1 or false.
 * Link with whichone_group.c and the C library of iceoryx2 (`scripts/sdk c` builds both).
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

/** Exit codes: the start was wrong, and is not tried again; the group is not as the program needs it. */
enum { WHICHONE_EXIT_USAGE = 64, WHICHONE_EXIT_BROKEN = 70, WHICHONE_EXIT_CONFIG = 78 };

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

/** The path of a file of the group, e.g. "run/settings.toml", in memory of the caller. Returns `path`. */
char *whichone_path(const whichone_group_t *group, const char *file, char *path, size_t size);

/** Opens a topic for reading: `whichone_open_reader(group, &whichone_speech_utterance)`. */
whichone_reader_t *whichone_open_reader(whichone_group_t *group, const whichone_topic_t *topic);

/** Opens a topic for writing. Services write the topics that are theirs, and no others. */
whichone_writer_t *whichone_open_writer(whichone_group_t *group, const whichone_topic_t *topic);

void whichone_close_reader(whichone_reader_t *reader);
void whichone_close_writer(whichone_writer_t *writer);

/** Copies the next message to `message`, which has room for `size` bytes. Returns its bytes, 0 if there is none, -1
 * if the topic fails. Messages of other epochs and of earlier processes are left out. Codes are not checked: compare
 * them with the enums before use. */
long whichone_take(whichone_reader_t *reader, void *message, size_t size);

/** Sends a copy of a message of `size` bytes and wakes the topic's readers. Nothing waits: the oldest unread message
 * gives way. */
bool whichone_send(whichone_writer_t *writer, const void *message, size_t size);

/** Tells the supervisor that the service is ready. */
void whichone_ready(whichone_group_t *group);

/** Sends a beat to the supervisor if one is due. Call it in each pass of the main loop, and from within long work: a
 * service that is silent for 3 s is restarted. */
void whichone_beat(whichone_group_t *group);

/** Whether to shut down: on request, or because the supervisor is gone. */
bool whichone_ends(const whichone_group_t *group);

/** Sleeps until there is a wake-up for this service, or for `longest_ms`. A client just sleeps. */
void whichone_wait(whichone_group_t *group, unsigned longest_ms);

/** Nanoseconds of the monotonic clock, as all times in messages are. */
uint64_t whichone_now_ns(void);

/** Says something to the robot, as if typed, and waits at most `seconds` for its receipt. Returns the utterance's
 * number, or 0 with the reason on standard error. */
uint64_t whichone_say(whichone_group_t *group, const char *text, double seconds);

/** The words of the scene, whose places are their numbers in messages, and the scene's key. */
typedef struct whichone_words {
    uint64_t scene_key;
    size_t count;
    char **words;
} whichone_words_t;

/** Reads the words of the scene in force. */
bool whichone_read_words(const whichone_group_t *group, whichone_words_t *words);

void whichone_free_words(whichone_words_t *words);

#ifdef __cplusplus
}
#endif

#endif
