//! Dialogues with real sound in real time: a synthesised user at the microphone's program, and the
//! robot's own voice without a sound card.

use messages::{PresentationState, Presented, topics};
use service::client::Client;
use whichone_tests::spoken::{Conditions, Ending, Noise, tally};
use whichone_tests::{Group, wait_for};

/// The sound is kept for later prompts, too.
#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn prompt_without_a_sound_card_lasts_as_long_as_its_sound() {
    let folder = tempfile::tempdir().unwrap();
    let kept = format!("speech.voice_dir={}", folder.path().display());
    let group = Group::up(&["speech.voice=espeak-ng", "speech.player=[\"none\"]", &kept]);
    let client = Client::join(group.paths()).unwrap();
    let presented = client.bus().reader::<Presented>(&topics::PRESENTED).unwrap();
    group.say("get me the bowl");
    let said = wait_for("a question said to its end", 20.0, || {
        let latest = presented.latest().unwrap()?;
        (latest.state == PresentationState::Ended).then_some(latest)
    });
    let entries = std::fs::read_dir(folder.path()).unwrap();
    let files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    let [file] = files.as_slice() else { panic!("one question: {files:?}") };
    let samples = speech_engines::audio::read_wav(file, 60.0).unwrap();
    let sound_s = samples.len() as f64 / 16_000.0;
    let took_s = (said.ended_ns - said.started_ns) as f64 / 1e9;
    // The two ends are noticed by the service's loop, each a little after it happened.
    assert!(sound_s > 0.5 && took_s > sound_s - 0.1, "{took_s} s for {sound_s} s of sound");
    drop(presented);
    drop(client);
    group.down();
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn spoken_dialogues_deliver_the_right_bowl() {
    let conditions = Conditions { snr_db: 40.0, noise: Noise::Steady, number: 0, seed: 1 };
    let tally = tally(conditions, 3, 2, |_| {});
    for held in &tally.dialogues {
        assert_eq!(held.ending(), Ending::Right, "{held:#?}");
    }
}
