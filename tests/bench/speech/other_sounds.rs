//! Clips without speech, which the robot must not act on.

use super::corpus::Sentence;
use super::listener::Listener;
use super::noise::{bursts, hum, melody, pink, samples};
use super::score::is_acted_on;
use crate::report::Report;
use language::Reader;
use scene::{ObjectId, Question, Scene};
use vocabulary::Language;

/// Length of a clip, seconds.
const CLIP_S: f64 = 4.0;
/// Level of voices in the other clips.
const VOICE_RMS: f64 = 3_000.0;
const CLIPS_EACH: u64 = 30;
/// Levels of clips of a kind, from that of voices down in steps of 4 dB.
const LEVELS: u64 = 6;

/// Adds how often the robot acts on sounds of each kind, in the middle of a question.
pub(super) fn measure(report: &mut Report, scene: &Scene, listener: &mut Listener) {
    let reader = Reader::new(scene, Language::Careful);
    let question = Question::Point(ObjectId(0));
    let said = Sentence { scene: 0, for_the_robot: false, text: String::new(), question };
    let len = samples(CLIP_S);
    let silence =
        |seed: u64| pink(len, seed).iter().map(|s| s * 0.002 * (seed % LEVELS) as f64).collect();
    let quieter = |sound: Vec<f64>, seed: u64| -> Vec<f64> {
        let gain = 10_f64.powf(-4.0 * (seed % LEVELS) as f64 / 20.0);
        sound.into_iter().map(|s| s * gain).collect()
    };
    let mut row = |name: &str, clip: &dyn Fn(u64) -> Vec<f64>| {
        let (mut speech, mut words, mut acted_on) = (0, 0, 0);
        for seed in 0..CLIPS_EACH {
            let clip: Vec<i16> = clip(seed).iter().map(|s| (s * VOICE_RMS) as i16).collect();
            let heard = listener.hear_samples(&clip);
            speech += usize::from(!heard.is_empty());
            words += usize::from(heard.iter().any(|heard| !heard.hypotheses.is_empty()));
            acted_on += usize::from(is_acted_on(&reader, &said, &heard));
        }
        let counts = [CLIPS_EACH as usize, speech, words, acted_on].map(|n| n.to_string());
        std::iter::once(name.to_owned()).chain(counts).collect::<Vec<_>>()
    };
    let rows = vec![
        row("silence", &silence),
        row("steady noise", &|seed| quieter(pink(len, 100 + seed), seed)),
        row("hum", &|seed| quieter(hum(len, if seed % 2 == 0 { 50.0 } else { 120.0 }), seed)),
        row("knocks and clatter", &|seed| quieter(bursts(len, 200 + seed), seed)),
        row("music", &|seed| quieter(melody(len, 300 + seed), seed)),
    ];
    let heads = ["sound", "clips", "taken for speech", "with words", "acted on"];
    let note = "Clips of 4 s without speech after \"This one?\", at the level of voices and down to 20 dB \
                below it.";
    report.table("Sounds that are not speech", note, heads, rows);
}
