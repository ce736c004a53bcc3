/* A process in its group, over the C interface of iceoryx2. */
#define _GNU_SOURCE
#include "whichone_group.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include "iox2/iceoryx2.h"

#define PATH_BYTES 4096
/* Most services that one process wakes. */
#define NOTIFIERS_MAX 16
/* Time between two transmissions of a request that has no receipt yet. */
#define RESEND_NS 250000000u
/* Events of a wake-up: a message was sent; a client, or a service, asks for the latest messages. */
enum { EVENT_MESSAGE, EVENT_CLIENT, EVENT_SERVICE };

typedef struct {
    char name[32];
    iox2_port_factory_event_h topic;
    iox2_notifier_h port;
} notifier_t;

struct whichone_group {
    char folder[PATH_BYTES];
    char name[64];
    uint64_t epoch;
    uint32_t incarnation;
    iox2_node_h node;
    iox2_port_factory_event_h wake_topic;
    iox2_listener_h listener;
    notifier_t notifiers[NOTIFIERS_MAX];
    size_t notifier_count;
    struct whichone_writer *writers;
    int lifeline, notify_fd, alive;
    struct sockaddr_un notify_to;
    socklen_t notify_to_size;
    uint64_t beaten_ns, beat_every_ns;
    bool is_ready_owed;
};

struct whichone_reader {
    whichone_group_t *group;
    const whichone_topic_t *topic;
    iox2_port_factory_pub_sub_h service;
    iox2_subscriber_h port;
    uint32_t newest;
};

struct whichone_writer {
    whichone_group_t *group;
    const whichone_topic_t *topic;
    iox2_port_factory_pub_sub_h service;
    iox2_publisher_h port;
    uint32_t sequence;
    struct whichone_writer *next;
};

static volatile sig_atomic_t is_called;

static void on_signal(int number) {
    (void)number;
    is_called = 1;
}

#define FAIL(result, ...) return (fprintf(stderr, __VA_ARGS__), fputc('\n', stderr), (result))

uint64_t whichone_now_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

char *whichone_path(const whichone_group_t *group, const char *file, char *path, size_t size) {
    if ((size_t)snprintf(path, size, "%s/%s", group->folder, file) >= size && size > 0)
        path[0] = 0;
    return path;
}

/* Reads a small file of the group; returns its bytes, or -1. */
static long read_file(const whichone_group_t *group, const char *file, char *text, size_t size) {
    char path[PATH_BYTES];
    FILE *stream = fopen(whichone_path(group, file, path, sizeof path), "re");
    if (!stream)
        return -1;
    size_t bytes = fread(text, 1, size - 1, stream);
    text[bytes] = 0;
    fclose(stream);
    return (long)bytes;
}

static const char *variable(const char *key) {
    const char *value = getenv(key);
    return value && *value ? value : NULL;
}

/* The folder of the group: that of the home of all groups, and its name. */
static bool find_folder(whichone_group_t *group, const char *name) {
    const char *home = variable("WHICHONE_HOME"), *state = variable("XDG_STATE_HOME"), *user = variable("HOME");
    char folder[PATH_BYTES] = "";
    int length = home    ? snprintf(folder, sizeof folder, "%s", home)
                 : state ? snprintf(folder, sizeof folder, "%s/whichone", state)
                 : user  ? snprintf(folder, sizeof folder, "%s/.local/state/whichone", user)
                         : -1;
    if (length < 0)
        FAIL(false, "no home folder: set WHICHONE_HOME to a folder for the groups, or HOME");
    int whole = snprintf(group->folder, sizeof group->folder, "%s/%s", folder, name);
    if (whole < 0 || (size_t)whole >= sizeof group->folder)
        FAIL(false, "%s: the path is too long", folder);
    return true;
}

/* Opens the node with the group's own prefix and folder in shared memory. */
static bool open_node(whichone_group_t *group) {
    char shm[128], root[160];
    if (read_file(group, "run/shm", shm, sizeof shm) <= 0)
        FAIL(false, "group %s is not running; help: start it with `whichone up`", group->folder);
    snprintf(root, sizeof root, "/dev/shm/%s", shm);
    iox2_set_log_level(iox2_log_level_e_FATAL);
    iox2_config_h config = NULL;
    iox2_config_default(NULL, &config);
    bool is_set = iox2_config_global_set_prefix(&config, shm) == IOX2_OK &&
                  iox2_config_global_set_root_path(&config, root) == IOX2_OK;
    /* The supervisor cleans up after processes that have died. */
    iox2_config_global_node_set_cleanup_dead_nodes_on_creation(&config, false);
    iox2_config_global_node_set_cleanup_dead_nodes_on_destruction(&config, false);
    iox2_config_global_service_set_cleanup_dead_nodes_on_open(&config, false);
    iox2_node_builder_h builder = iox2_node_builder_new(NULL);
    iox2_node_builder_set_config(&builder, &config);
    iox2_node_builder_set_signal_handling_mode(&builder, iox2_signal_handling_mode_e_DISABLED);
    int made = iox2_node_builder_create(builder, NULL, iox2_service_type_e_IPC, &group->node);
    iox2_config_drop(config);
    if (!is_set || made != IOX2_OK)
        FAIL(false, "shared memory %s: cannot be opened (error %d); help: see `whichone status`", root, made);
    return true;
}

static iox2_service_builder_h service_builder(whichone_group_t *group, const char *name, iox2_service_name_h *made) {
    if (iox2_service_name_new(NULL, name, strlen(name), made) != IOX2_OK)
        return NULL;
    return iox2_node_service_builder(&group->node, NULL, iox2_cast_service_name_ptr(*made));
}

/* Opens the wake-up of a service. */
static iox2_port_factory_event_h open_wake_up(whichone_group_t *group, const char *service) {
    char name[64];
    snprintf(name, sizeof name, "wake/%s", service);
    iox2_service_name_h made = NULL;
    iox2_port_factory_event_h topic = NULL;
    iox2_service_builder_h builder = service_builder(group, name, &made);
    if (builder && iox2_service_builder_event_open(iox2_service_builder_event(builder), NULL, &topic) != IOX2_OK)
        topic = NULL;
    if (made)
        iox2_service_name_drop(made);
    return topic;
}

/* Wakes a service. A failure is harmless: services look for messages from time to time, too. */
static void notify(whichone_group_t *group, const char *service, size_t event) {
    notifier_t *found = NULL;
    for (size_t i = 0; i < group->notifier_count; i++)
        if (strcmp(group->notifiers[i].name, service) == 0)
            found = &group->notifiers[i];
    if (!found) {
        iox2_port_factory_event_h topic =
            group->notifier_count < NOTIFIERS_MAX ? open_wake_up(group, service) : NULL;
        if (!topic)
            return;
        iox2_notifier_h port = NULL;
        if (iox2_port_factory_notifier_builder_create(iox2_port_factory_event_notifier_builder(&topic, NULL), NULL,
                                                      &port) != IOX2_OK) {
            iox2_port_factory_event_drop(topic);
            return;
        }
        found = &group->notifiers[group->notifier_count++];
        snprintf(found->name, sizeof found->name, "%s", service);
        found->topic = topic, found->port = port;
    }
    iox2_event_id_t id = {.value = event};
    iox2_notifier_notify_with_custom_event_id(&found->port, &id, NULL);
}

static whichone_group_t *join(const char *process, const char *group_name, uint64_t epoch, uint32_t incarnation) {
    whichone_group_t *group = calloc(1, sizeof *group);
    if (!group)
        FAIL(NULL, "no memory");
    group->lifeline = group->notify_fd = group->alive = -1;
    group->incarnation = incarnation, group->epoch = epoch;
    snprintf(group->name, sizeof group->name, "%s", process);
    if (!find_folder(group, group_name) || !open_node(group)) {
        whichone_leave(group);
        return NULL;
    }
    return group;
}

/* The supervisor's socket, its lifeline, and the lock by which it waits for the end of all services. */
static void supervise(whichone_group_t *group) {
    struct sigaction action = {.sa_handler = on_signal};
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGINT, &action, NULL);
    char path[PATH_BYTES];
    group->alive = open(whichone_path(group, "alive.lock", path, sizeof path), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (group->alive >= 0)
        flock(group->alive, LOCK_SH | LOCK_NB);
    const char *lifeline = variable("WHICHONE_LIFELINE_FD"), *socket_name = variable("NOTIFY_SOCKET");
    group->lifeline = lifeline ? atoi(lifeline) : -1;
    const char *watchdog = variable("WATCHDOG_USEC");
    uint64_t third_ns = (watchdog ? strtoull(watchdog, NULL, 10) : 3000000u) * 1000u / 3u;
    group->beat_every_ns = third_ns < 1000000000u ? third_ns : 1000000000u;
    if (socket_name && strlen(socket_name) < sizeof group->notify_to.sun_path) {
        group->notify_fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        group->notify_to.sun_family = AF_UNIX;
        size_t length = strlen(socket_name);
        memcpy(group->notify_to.sun_path, socket_name, length);
        if (socket_name[0] == '@')
            group->notify_to.sun_path[0] = 0;
        group->notify_to_size = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    }
}

whichone_group_t *whichone_join_as_service(const char *service) {
    const char *group_name = variable("WHICHONE_GROUP"), *epoch = variable("WHICHONE_EPOCH"),
               *incarnation = variable("WHICHONE_INCARNATION");
    if (!group_name || !epoch || !incarnation)
        FAIL(NULL,
             "WHICHONE_GROUP, WHICHONE_EPOCH or WHICHONE_INCARNATION is not set; help: services are started by "
             "their supervisor, e.g. `whichone swap %s -- PROGRAM`",
             service);
    whichone_group_t *group =
        join(service, group_name, strtoull(epoch, NULL, 10), (uint32_t)strtoul(incarnation, NULL, 10));
    if (!group)
        return NULL;
    supervise(group);
    group->wake_topic = open_wake_up(group, service);
    /* A service that no topic wakes has none. */
    if (group->wake_topic &&
        iox2_port_factory_listener_builder_create(iox2_port_factory_event_listener_builder(&group->wake_topic, NULL),
                                                  NULL, &group->listener) != IOX2_OK)
        group->listener = NULL;
    return group;
}

whichone_group_t *whichone_join_as_client(const char *group_name) {
    const char *name = group_name ? group_name : variable("WHICHONE_GROUP");
    whichone_group_t *group = join("client", name ? name : "whichone", 0, 0);
    if (!group)
        return NULL;
    char text[4096];
    const char *epoch = read_file(group, "epoch", text, sizeof text) > 0 ? strstr(text, "\"epoch\":") : NULL;
    if (!epoch) {
        fprintf(stderr, "%s/epoch: expected the set of journals, found damage\n", group->folder);
        whichone_leave(group);
        return NULL;
    }
    group->epoch = strtoull(epoch + strlen("\"epoch\":"), NULL, 10);
    return group;
}

void whichone_leave(whichone_group_t *group) {
    if (!group)
        return;
    for (size_t i = 0; i < group->notifier_count; i++) {
        iox2_notifier_drop(group->notifiers[i].port);
        iox2_port_factory_event_drop(group->notifiers[i].topic);
    }
    if (group->listener)
        iox2_listener_drop(group->listener);
    if (group->wake_topic)
        iox2_port_factory_event_drop(group->wake_topic);
    if (group->node)
        iox2_node_drop(group->node);
    if (group->notify_fd >= 0)
        close(group->notify_fd);
    if (group->alive >= 0)
        close(group->alive);
    free(group);
}

/* Opens a topic that the supervisor has made; refused if its messages are of another version. */
static iox2_port_factory_pub_sub_h open_topic(whichone_group_t *group, const whichone_topic_t *topic) {
    iox2_service_name_h name = NULL;
    iox2_port_factory_pub_sub_h service = NULL;
    iox2_attribute_verifier_h verifier = NULL;
    int error = -1;
    iox2_service_builder_h plain = service_builder(group, topic->name, &name);
    if (plain) {
        iox2_service_builder_pub_sub_h builder = iox2_service_builder_pub_sub(plain);
        bool is_slice = topic->size == 0;
        iox2_service_builder_pub_sub_set_payload_type_details(
            &builder, is_slice ? iox2_type_variant_e_DYNAMIC : iox2_type_variant_e_FIXED_SIZE, topic->type,
            strlen(topic->type), is_slice ? 1 : topic->size, topic->alignment);
        iox2_service_builder_pub_sub_set_user_header_type_details(
            &builder, iox2_type_variant_e_FIXED_SIZE, WHICHONE_STAMP_TYPE, strlen(WHICHONE_STAMP_TYPE),
            sizeof(whichone_stamp_t), _Alignof(whichone_stamp_t));
        iox2_attribute_verifier_new(NULL, &verifier);
        iox2_attribute_verifier_require(&verifier, "schema", topic->schema);
        error = iox2_service_builder_pub_sub_open_with_attributes(builder, &verifier, NULL, &service);
        iox2_attribute_verifier_drop(verifier);
    }
    if (name)
        iox2_service_name_drop(name);
    if (error != IOX2_OK)
        FAIL(NULL,
             "topic %s does not open with schema %s (error %d); help: build the program with the whichone.h of the "
             "group's version",
             topic->name, topic->schema, error);
    return service;
}

whichone_reader_t *whichone_open_reader(whichone_group_t *group, const whichone_topic_t *topic) {
    whichone_reader_t *reader = calloc(1, sizeof *reader);
    if (!reader)
        FAIL(NULL, "no memory");
    reader->group = group, reader->topic = topic;
    reader->service = open_topic(group, topic);
    if (reader->service) {
        iox2_port_factory_subscriber_builder_h builder =
            iox2_port_factory_pub_sub_subscriber_builder(&reader->service, NULL);
        iox2_port_factory_subscriber_builder_set_buffer_size(&builder, topic->buffer);
        if (iox2_port_factory_subscriber_builder_create(builder, NULL, &reader->port) == IOX2_OK) {
            if (topic->writer && topic->history)
                notify(group, topic->writer, group->incarnation ? EVENT_SERVICE : EVENT_CLIENT);
            return reader;
        }
        fprintf(stderr, "topic %s: too many readers\n", topic->name);
    }
    whichone_close_reader(reader);
    return NULL;
}

whichone_writer_t *whichone_open_writer(whichone_group_t *group, const whichone_topic_t *topic) {
    whichone_writer_t *writer = calloc(1, sizeof *writer);
    if (!writer)
        FAIL(NULL, "no memory");
    writer->group = group, writer->topic = topic;
    writer->service = open_topic(group, topic);
    if (writer->service) {
        iox2_port_factory_publisher_builder_h builder =
            iox2_port_factory_pub_sub_publisher_builder(&writer->service, NULL);
        iox2_port_factory_publisher_builder_backpressure_strategy(&builder, iox2_backpressure_strategy_e_DISCARD_DATA);
        if (topic->size == 0) {
            iox2_port_factory_publisher_builder_set_initial_max_slice_len(&builder, 4096);
            iox2_port_factory_publisher_builder_set_allocation_strategy(&builder,
                                                                        iox2_allocation_strategy_e_POWER_OF_TWO);
        }
        if (iox2_port_factory_publisher_builder_create(builder, NULL, &writer->port) == IOX2_OK) {
            writer->next = group->writers;
            group->writers = writer;
            return writer;
        }
        fprintf(stderr, "topic %s: another process writes it; help: see `whichone status`\n", topic->name);
    }
    whichone_close_writer(writer);
    return NULL;
}

void whichone_close_reader(whichone_reader_t *reader) {
    if (!reader)
        return;
    if (reader->port)
        iox2_subscriber_drop(reader->port);
    if (reader->service)
        iox2_port_factory_pub_sub_drop(reader->service);
    free(reader);
}

void whichone_close_writer(whichone_writer_t *writer) {
    if (!writer)
        return;
    for (whichone_writer_t **at = &writer->group->writers; *at; at = &(*at)->next)
        if (*at == writer) {
            *at = writer->next;
            break;
        }
    if (writer->port)
        iox2_publisher_drop(writer->port);
    if (writer->service)
        iox2_port_factory_pub_sub_drop(writer->service);
    free(writer);
}

/* Whether a message counts: of this epoch, and of the writer's newest process that was started. */
static bool admits(whichone_reader_t *reader, const whichone_stamp_t *stamp) {
    const whichone_group_t *group = reader->group;
    if (stamp->epoch != group->epoch || (reader->topic->writer && stamp->incarnation < reader->newest))
        return false;
    if (!reader->topic->writer || stamp->incarnation == reader->newest)
        return true;
    char file[96], path[PATH_BYTES];
    snprintf(file, sizeof file, "run/n-%s-%u", reader->topic->writer, stamp->incarnation);
    if (access(whichone_path(group, file, path, sizeof path), F_OK) != 0 &&
        access(whichone_path(group, "run/control.sock", path, sizeof path), F_OK) == 0)
        FAIL(false, "message rejected topic=%s: expected a running %s, found one of start %u", reader->topic->name,
             reader->topic->writer, stamp->incarnation);
    reader->newest = stamp->incarnation;
    return true;
}

long whichone_take(whichone_reader_t *reader, void *message, size_t size) {
    for (;;) {
        iox2_sample_h sample = NULL;
        int error = iox2_subscriber_receive(&reader->port, NULL, &sample);
        if (error != IOX2_OK)
            FAIL(-1, "topic %s: error %d", reader->topic->name, error);
        if (!sample)
            return 0;
        const whichone_stamp_t *stamp = NULL;
        const void *payload = NULL;
        size_t count = 0;
        iox2_sample_user_header(&sample, (const void **)&stamp);
        iox2_sample_payload(&sample, &payload, &count);
        size_t bytes = reader->topic->size ? reader->topic->size : count;
        bool is_taken = admits(reader, stamp) && bytes <= size;
        if (is_taken)
            memcpy(message, payload, bytes);
        iox2_sample_drop(sample);
        if (is_taken)
            return (long)bytes;
    }
}

static void wake(whichone_writer_t *writer) {
    for (const char *const *service = writer->topic->wakes; *service; service++)
        notify(writer->group, *service, EVENT_MESSAGE);
}

bool whichone_send(whichone_writer_t *writer, const void *message, size_t size) {
    const whichone_topic_t *topic = writer->topic;
    if (topic->size && size != topic->size)
        FAIL(false, "topic %s: expected %zu bytes, found %zu", topic->name, topic->size, size);
    iox2_sample_mut_h sample = NULL;
    int error = iox2_publisher_loan_slice_uninit(&writer->port, NULL, &sample, topic->size ? 1 : size);
    if (error != IOX2_OK)
        FAIL(false, "topic %s: no shared memory for a message (error %d)", topic->name, error);
    void *payload = NULL;
    whichone_stamp_t *stamp = NULL;
    iox2_sample_mut_payload_mut(&sample, &payload, NULL);
    iox2_sample_mut_user_header_mut(&sample, (void **)&stamp);
    memcpy(payload, message, size);
    /* 0 would say that the writer does not count. */
    writer->sequence = writer->sequence == UINT32_MAX ? 1 : writer->sequence + 1;
    *stamp = (whichone_stamp_t){.epoch = writer->group->epoch,
                                .sent_ns = whichone_now_ns(),
                                .incarnation = writer->group->incarnation,
                                .sequence = writer->sequence};
    if ((error = iox2_sample_mut_send(sample, NULL)) != IOX2_OK)
        FAIL(false, "topic %s: not sent (error %d)", topic->name, error);
    wake(writer);
    return true;
}

/* A state that is reported once stays owed until there is room for it. */
static void report(whichone_group_t *group, const char *state) {
    char text[128];
    int length = snprintf(text, sizeof text, "%s%s", group->is_ready_owed ? "READY=1\n" : "", state);
    if (group->notify_fd < 0 || length <= 0)
        return;
    if (sendto(group->notify_fd, text, (size_t)length, MSG_NOSIGNAL, (const struct sockaddr *)&group->notify_to,
               group->notify_to_size) >= 0)
        group->is_ready_owed = false;
}

void whichone_ready(whichone_group_t *group) {
    group->is_ready_owed = true;
    report(group, "");
}

void whichone_beat(whichone_group_t *group) {
    uint64_t now = whichone_now_ns();
    if (group->beaten_ns && now - group->beaten_ns < group->beat_every_ns)
        return;
    group->beaten_ns = now;
    report(group, "WATCHDOG=1\nX_INPUT_AGE_MS=0");
}

bool whichone_ends(const whichone_group_t *group) {
    struct pollfd lifeline = {.fd = group->lifeline, .events = POLLIN};
    return is_called || (group->lifeline >= 0 && poll(&lifeline, 1, 0) > 0);
}

/* Readers that have joined get the latest messages now instead of with the next ones. */
static void serve_joined(whichone_group_t *group, size_t event) {
    for (whichone_writer_t *writer = group->writers; event != EVENT_MESSAGE && writer; writer = writer->next) {
        iox2_publisher_update_connections(&writer->port);
        if (event == EVENT_SERVICE)
            wake(writer);
    }
}

void whichone_wait(whichone_group_t *group, unsigned longest_ms) {
    if (!group->listener) {
        poll(NULL, 0, (int)longest_ms);
        return;
    }
    iox2_event_id_t id = {0};
    bool has_one = false;
    int error = iox2_listener_timed_wait_one(&group->listener, &id, &has_one, longest_ms / 1000,
                                             longest_ms % 1000 * 1000000u);
    for (int i = 0; error == IOX2_OK && has_one && i < 64; i++) {
        serve_joined(group, id.value);
        error = iox2_listener_try_wait_one(&group->listener, &id, &has_one);
    }
}

/* Appends a number of variable length, as postcard has it. */
static size_t put_number(unsigned char *out, uint64_t value) {
    size_t at = 0;
    for (; value >= 0x80; value >>= 7)
        out[at++] = (unsigned char)(value & 0x7f) | 0x80;
    out[at++] = (unsigned char)value;
    return at;
}

uint64_t whichone_say(whichone_group_t *group, const char *text, double seconds) {
    enum { KEY = 16, SOUND_TEXT = 0 };
    size_t length = strlen(text), at = KEY;
    if (length > WHICHONE_UTTERANCE_BYTES_MAX)
        FAIL(0, "%zu bytes are too long for an utterance: %u at most", length, WHICHONE_UTTERANCE_BYTES_MAX);
    unsigned char *request = malloc(length + 64);
    whichone_writer_t *writer = request ? whichone_open_writer(group, &whichone_speech_inject) : NULL;
    whichone_reader_t *receipts = writer ? whichone_open_reader(group, &whichone_speech_receipt) : NULL;
    uint64_t number = 0, begun = whichone_now_ns(), due = begun;
    /* Under one key, so that a restart in between neither loses nor doubles it. */
    if (receipts && getrandom(request, KEY, 0) == KEY) {
        request[at++] = 0; /* onset: when it arrives */
        request[at++] = 0; /* end: when it arrives */
        request[at++] = 0; /* the latest prompt that was shown is not known */
        request[at++] = SOUND_TEXT;
        at += put_number(request + at, length);
        memcpy(request + at, text, length);
        at += length;
        bool is_answered = false;
        while (!is_answered && (double)(whichone_now_ns() - begun) < seconds * 1e9) {
            if (whichone_now_ns() >= due) {
                whichone_send(writer, request, at);
                due = whichone_now_ns() + RESEND_NS;
            }
            whichone_receipt_t receipt;
            while (!is_answered && whichone_take(receipts, &receipt, sizeof receipt) > 0) {
                if (memcmp(receipt.key, request, KEY) != 0)
                    continue;
                is_answered = true;
                if (receipt.status == WHICHONE_RECEIPT_STATUS_ACCEPTED)
                    number = receipt.seq;
                else
                    fprintf(stderr, "refused: %.*s\n", (int)receipt.note.len, receipt.note.bytes);
            }
            poll(NULL, 0, 1);
        }
        if (!is_answered)
            fprintf(stderr, "speech: no receipt within %g s; help: see `whichone status`\n", seconds);
    }
    whichone_close_reader(receipts);
    whichone_close_writer(writer);
    free(request);
    return number;
}

bool whichone_read_words(const whichone_group_t *group, whichone_words_t *words) {
    char path[PATH_BYTES], *line = NULL;
    size_t size = 0, room = 0;
    *words = (whichone_words_t){0};
    FILE *stream = fopen(whichone_path(group, "run/scene.words", path, sizeof path), "re");
    bool is_whole = stream && getline(&line, &size, stream) == 17;
    if (is_whole)
        words->scene_key = strtoull(line, NULL, 16);
    for (ssize_t length; is_whole && (length = getline(&line, &size, stream)) > 0;) {
        if (words->count == room) {
            char **more = realloc(words->words, (room = room * 2 + 16) * sizeof *more);
            if (!(is_whole = more != NULL))
                break;
            words->words = more;
        }
        if (line[length - 1] == '\n')
            line[length - 1] = 0;
        is_whole = (words->words[words->count] = strdup(line)) != NULL;
        words->count += is_whole;
    }
    free(line);
    if (stream)
        fclose(stream);
    if (!is_whole) {
        whichone_free_words(words);
        FAIL(false, "%s: expected the scene's key and words, found %s", path, stream ? "damage" : "no file");
    }
    return true;
}

void whichone_free_words(whichone_words_t *words) {
    for (size_t i = 0; i < words->count; i++)
        free(words->words[i]);
    free(words->words);
    *words = (whichone_words_t){0};
}
