//! Turn-taking in simulated time: the rules of attribution side by side.

use crate::options::Options;
use crate::report::{Report, print};
use whichone_tests::simulated_group::{Count, study};

/// Dialogues where nothing else is said.
const DIALOGUES: u64 = 500;

pub(crate) fn measure(report: &mut Report, options: &Options) {
    let (dialogues, seed) = (options.dialogues.unwrap_or(DIALOGUES), options.seed);
    let counts = study(dialogues, seed);
    for count in counts.iter().filter(|count| count.rule == "mixture") {
        for story in count.stories.iter().take(3) {
            print(&format!("{}, wrong by timing: {story}\n", count.rule));
        }
    }
    let heads = [
        "attribution, words arrive",
        "dialogues",
        "credited to the right question",
        "to another one",
        "wrong picks",
        "of them by timing",
        "questions",
        "seconds",
    ];
    let note = format!(
        "{dialogues} dialogues of seed {seed} through the real reducers of speech, grounding and \
         policy, the same people under each rule; half of them heard live, half by what arrives \
         when they have ended. Every user answers truthfully. By timing: the same user who answers \
         in good time gets the right object."
    );
    let title = "Answers late, early, into the next question, and twice";
    report.table(title, note, heads, counts.iter().map(row).collect());
}

fn row(count: &Count) -> Vec<String> {
    let n = count.dialogues.max(1) as f64;
    vec![
        format!("{}, {}", count.rule, if count.live { "live" } else { "afterwards" }),
        count.dialogues.to_string(),
        format!("{:.2} %", 100.0 * count.share()),
        format!("{:.2} %", 100.0 * count.share_wrong()),
        format!("{} ({:.1} %)", count.wrong, 100.0 * count.wrong as f64 / n),
        count.wrong_by_timing.to_string(),
        format!("{:.2}", count.questions as f64 / n),
        format!("{:.1}", count.seconds / n),
    ]
}
