/* A grounding service: spots the scene's words, yes and no.
 *
 *     whichone swap grounding -- target/sdk/c/grounding
 *
 * It remembers nothing, so it can be killed and swapped at any moment, as the one that it replaces.
 */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "../whichone_group.h"

/* Longest wording that is read, bytes. */
#define WORDING_MAX 4096

static bool is_letter(char c) {
    return isalnum((unsigned char)c) || c == '-' || c == '\'' || (unsigned char)c >= 0x80;
}

/* The length of `word` where it stands at `text` as a word of its own, in any case of letters; else 0. */
static size_t starts_with(const char *text, const char *word) {
    size_t length = strlen(word);
    if (length == 0 || strncasecmp(text, word, length) != 0 || is_letter(text[length]))
        return 0;
    return length;
}

static bool is_one_of(const char *text, const char *const *words) {
    for (; *words; words++)
        if (starts_with(text, *words))
            return true;
    return false;
}

/* What a wording says: the scene's words, the longest at each place, and yes, no or neither. */
static void read_wording(const char *text, const uint8_t *confidence, const whichone_group_t *group,
                         whichone_reading_t *reading) {
    static const char *const affirmative[] = {"yes", "yeah", "sure", "yup", "yep", NULL};
    static const char *const negative[] = {"no", "nope", "not", "nah", "other", NULL};
    bool yes = false, no = false, is_inside = false;
    size_t place = 0;
    for (const char *at = text; *at;) {
        size_t longest = 0, found = 0;
        if (!is_inside) {
            yes = yes || is_one_of(at, affirmative);
            no = no || is_one_of(at, negative);
            for (size_t n = 0; n < whichone_word_count(group); n++) {
                size_t length = starts_with(at, whichone_word(group, n));
                if (length > longest)
                    longest = length, found = n;
            }
        }
        if (longest && reading->base_count < WHICHONE_BASE_WORDS_MAX) {
            size_t slot = reading->base_count++;
            reading->base[slot] = (uint16_t)found;
            /* A word counts for less where the recogniser was not sure of it. */
            if (place < WHICHONE_CONFIDENCES_MAX)
                reading->base_doubt[slot] = 1.0f - (float)confidence[place] / 255.0f;
        }
        for (const char *end = at + (longest ? longest : 1); at < end; at++)
            place += *at == ' ';
        is_inside = is_letter(at[-1]);
    }
    reading->response = yes == no ? WHICHONE_RESPONSE_NONE : yes ? WHICHONE_RESPONSE_YES : WHICHONE_RESPONSE_NO;
}

/* Adds a reading of each wording as an answer to the question at `place`. */
static void read_for(uint8_t place, const whichone_utterance_t *utterance, const whichone_group_t *group,
                     whichone_observation_t *observation) {
    for (size_t n = 0; n < utterance->hypothesis_count; n++) {
        const whichone_hypothesis_t *heard = &utterance->hypotheses[n];
        char text[WORDING_MAX];
        snprintf(text, sizeof text, "%.*s", (int)heard->len, utterance->text.bytes + heard->start);
        whichone_reading_t *reading = &observation->readings[observation->reading_count++];
        reading->question = place;
        reading->weight = heard->weight;
        reading->intent = WHICHONE_INTENT_INFORM;
        read_wording(text, heard->confidence, group, reading);
    }
}

/* Numbers of another process are not believed: what makes no sense counts as not said. */
static void check(whichone_utterance_t *utterance) {
    uint32_t length = utterance->text.len;
    bool is_sound = utterance->hypothesis_count <= WHICHONE_HYPOTHESES_MAX && length <= sizeof utterance->text.bytes &&
                    utterance->asked_count <= WHICHONE_ASKED_MAX;
    for (size_t n = 0; is_sound && n < utterance->hypothesis_count; n++) {
        const whichone_hypothesis_t *heard = &utterance->hypotheses[n];
        is_sound = heard->start <= length && heard->len <= length - heard->start;
    }
    if (is_sound)
        return;
    fprintf(stderr, "utterance %llu makes no sense; it counts as without content\n", (unsigned long long)utterance->seq);
    utterance->hypothesis_count = 0;
    if (utterance->asked_count > WHICHONE_ASKED_MAX)
        utterance->asked_count = WHICHONE_ASKED_MAX;
}

static void observe(const whichone_utterance_t *utterance, const whichone_group_t *group,
                    whichone_observation_t *observation) {
    memset(observation, 0, sizeof *observation);
    observation->seq = utterance->seq;
    memcpy(observation->asked, utterance->asked, sizeof observation->asked);
    observation->asked_count = utterance->asked_count;
    observation->from = utterance->from;
    observation->gesture = utterance->gesture;
    observation->source = utterance->source;
    observation->onset_ns = utterance->onset_ns;
    observation->end_ns = utterance->end_ns;
    observation->accepted_ns = utterance->accepted_ns;
    observation->scene_key = whichone_scene_key(group);
    for (uint8_t place = 0; place < utterance->asked_count; place++)
        read_for(place, utterance, group, observation);
    read_for(WHICHONE_NO_QUESTION, utterance, group, observation);
    if (observation->reading_count == 0) {
        /* A pointing gesture without words, or nothing. */
        observation->readings[0].question = WHICHONE_NO_QUESTION;
        observation->readings[0].weight = 1.0;
        observation->readings[0].intent = utterance->gesture.present ? WHICHONE_INTENT_INFORM : WHICHONE_INTENT_NONE;
        observation->reading_count = 1;
    }
    observation->grounded_ns = whichone_now_ns();
}

typedef struct {
    const whichone_group_t *group;
    whichone_reader_t *utterances;
    whichone_writer_t *observations;
} grounder_t;

static void step(void *context) {
    const grounder_t *grounder = context;
    static whichone_utterance_t utterance;
    static whichone_observation_t observation;
    while (whichone_take(grounder->utterances, &utterance, sizeof utterance) > 0) {
        check(&utterance);
        observe(&utterance, grounder->group, &observation);
        whichone_send(grounder->observations, &observation, sizeof observation);
    }
}

int main(void) {
    whichone_group_t *group = whichone_join_as_service("grounding");
    if (!group)
        return WHICHONE_EXIT_USAGE;
    grounder_t grounder = {group, whichone_open_reader(group, &whichone_speech_utterance),
                           whichone_open_writer(group, &whichone_grounding_observation)};
    int status = WHICHONE_EXIT_CONFIG;
    if (grounder.utterances && grounder.observations)
        status = whichone_run(group, step, &grounder);
    whichone_close_reader(grounder.utterances);
    whichone_close_writer(grounder.observations);
    whichone_leave(group);
    return status;
}
