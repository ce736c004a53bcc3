/* A client: says something to the robot, and shows its lines and the arm until the arm has done something or the time
 * is over.
 *
 *     target/sdk/c/say "get me the clear bowl" [SECONDS]
 */
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>

#include "../whichone_group.h"

int main(int count, char **words) {
    if (count < 2 || count > 3) {
        fprintf(stderr, "usage: %s TEXT [SECONDS]\n", words[0]);
        return WHICHONE_EXIT_USAGE;
    }
    double seconds = count == 3 ? atof(words[2]) : 60.0;
    static const char *const outcomes[] = {"pending", "delivered", "unreachable", "interrupted", "cancelled",
                                           "missed",  "blocked",   "put back",    "vanished",    "kept"};
    whichone_group_t *group = whichone_join_as_client(NULL);
    whichone_reader_t *acts = group ? whichone_open_reader(group, &whichone_policy_act) : NULL;
    whichone_reader_t *arm = acts ? whichone_open_reader(group, &whichone_arm_status) : NULL;
    if (!arm)
        return 1;
    uint64_t number = whichone_say(group, words[1], 10.0), shown = 0, interaction = 0, began = whichone_now_ns();
    int status = number ? 1 : WHICHONE_EXIT_USAGE;
    while (number && status == 1 && (double)(whichone_now_ns() - began) < seconds * 1e9) {
        whichone_robot_act_t act;
        while (whichone_take(acts, &act, sizeof act) > 0)
            if (act.utterance >= number && act.act > shown && act.text.len <= sizeof act.text.bytes) {
                shown = act.act;
                interaction = act.interaction;
                printf("robot: %.*s\n", (int)act.text.len, act.text.bytes);
            }
        whichone_arm_status_t now;
        while (whichone_take(arm, &now, sizeof now) > 0)
            if (interaction && now.interaction == interaction && now.phase == WHICHONE_PICK_PHASE_DONE && now.outcome < sizeof outcomes / sizeof *outcomes &&
                now.outcome != WHICHONE_PICK_OUTCOME_PENDING) {
                printf("arm: object %u %s\n", now.object, outcomes[now.outcome]);
                status = now.outcome == WHICHONE_PICK_OUTCOME_DELIVERED ? 0 : 1;
                number = 0;
            }
        fflush(stdout);
        poll(NULL, 0, 10);
    }
    whichone_close_reader(acts);
    whichone_close_reader(arm);
    whichone_leave(group);
    return status;
}
