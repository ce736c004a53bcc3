//! Spoken dialogues with the real group.

use crate::options::{Options, SpokenNoise};
use crate::report::{Report, percentile, print};
use std::path::Path;
use std::process::Command;
use whichone_tests::spoken::{Conditions, Ending, Held, Noise, Tally, tally};

/// Noise under the speech: its option, how far the speech stands above it, decibels, what it is, and its name.
const NOISES: [(SpokenNoise, f64, Noise, &str); 3] = [
    (SpokenNoise::Quiet, 40.0, Noise::Steady, "quiet"),
    (SpokenNoise::Steady, 20.0, Noise::Steady, "20 dB"),
    (SpokenNoise::Babble, 10.0, Noise::Babble, "babble, 10 dB"),
];
/// Dialogues in each noise unless a number is given: alone, and among everything else.
const DIALOGUES: (u64, u64) = (60, 6);

pub(crate) fn measure(report: &mut Report, options: &Options) {
    if !can_speak() {
        return print("spoken dialogues are skipped: they need espeak-ng, flite and pocketsphinx");
    }
    let usual = if options.wants_all() { DIALOGUES.1 } else { DIALOGUES.0 };
    let (dialogues, seed) = (options.dialogues.unwrap_or(usual), options.seed);
    let tallies: Vec<(&str, Tally)> = NOISES
        .iter()
        .filter(|(option, ..)| options.noise.is_none_or(|wanted| wanted == *option))
        .map(|&(_, snr_db, noise, name)| {
            let conditions = Conditions { snr_db, noise, number: 0, seed };
            (name, tally(conditions, dialogues, options.groups, show))
        })
        .collect();
    keep(&tallies);
    let heads = [
        "noise",
        "right picks",
        "95 % interval",
        "another object",
        "none",
        "questions",
        "seconds to the decision",
        "utterances",
        "rejected",
        "misunderstood",
        "end of speech to the reply's first sound, ms, p50",
        "p95",
    ];
    let note = format!(
        "{dialogues} dialogues of seed {seed} over the six bowls in each noise, with the real processes: a synthesised \
         person speaks into the microphone's program in real time, and answers after the robot's real questions. \
         Every dialogue is in target/bench/spoken.json."
    );
    let rows = tallies.iter().map(|(name, tally)| row(name, tally)).collect();
    report.table("Spoken dialogues", note, heads, rows);
}

fn can_speak() -> bool {
    let is_there = |program: &str| Command::new(program).arg("--version").output().is_ok();
    is_there("espeak-ng")
        && is_there("flite")
        && Path::new("/usr/share/pocketsphinx/model/en-us/en-us").exists()
}

fn show(held: &Held) {
    let how = match held.ending() {
        Ending::Right => "right",
        Ending::Another => "WRONG",
        Ending::Nothing => "none ",
    };
    let Held { number, speaker, wanted, questions, seconds, .. } = held;
    print(&format!(
        "{number:3} {how} {wanted:7} {speaker:9} {questions} questions {seconds:5.1} s"
    ));
    if held.ending() != Ending::Right {
        held.story.iter().for_each(|line| print(line));
    }
}

fn row(name: &str, tally: &Tally) -> Vec<String> {
    let (all, (low, high)) = (tally.dialogues.len(), tally.interval());
    let said = tally.sum(|held| held.said);
    let replies = tally.dialogues.iter().flat_map(|held| &held.replies_ms);
    let replies_ms: Vec<f64> = replies.copied().collect();
    let share = |of: u32| format!("{of} ({:.1} %)", 100.0 * f64::from(of) / f64::from(said.max(1)));
    vec![
        name.to_owned(),
        format!("{} of {all}", tally.ended(Ending::Right)),
        format!("{:.1} to {:.1} %", 100.0 * low, 100.0 * high),
        tally.ended(Ending::Another).to_string(),
        tally.ended(Ending::Nothing).to_string(),
        format!("{:.2}", tally.mean(|held| f64::from(held.questions))),
        format!("{:.1}", tally.mean(|held| held.seconds)),
        said.to_string(),
        share(tally.sum(|held| held.rejected)),
        share(tally.sum(|held| held.misunderstood)),
        format!("{:.0}", percentile(&replies_ms, 0.5)),
        format!("{:.0}", percentile(&replies_ms, 0.95)),
    ]
}

fn keep(tallies: &[(&str, Tally)]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/bench");
    let json = serde_json::to_vec_pretty(tallies).map_err(std::io::Error::other);
    let kept = std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(folder.join("spoken.json"), json?));
    if let Err(error) = kept {
        print(&format!("target/bench/spoken.json: {error}"));
    }
}
