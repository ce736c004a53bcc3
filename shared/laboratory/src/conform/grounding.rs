//! The rules for a grounder, with the tester in the place of speech and policy.

use std::time::{Duration, Instant};

use messages::topics::{self, WINDOW};
use messages::{
    AskedQuestion, Epoch, FixedText, Hypothesis, Observation, Utterance, WireGesture, WireQuestion,
};
use scene::{ObjectId, Question, Scene};
use service::bus::{Bus, Reader, Writer, rejected};
use service::client::Polling;
use service::clock;
use service::exit::Failure;

use super::bench::EPOCH;
use super::rules::seconds;
use super::{Broken, Kept, Rule, Test, rule};

/// The rules.
pub(super) const RULES: [Rule; 7] = [
    rule("answers", "answers every kind of utterance with a valid observation", answers),
    rule("repeats", "gives the same observation for the same utterance", repeats),
    rule("burst", "answers each of many utterances at once", burst),
    rule("nonsense", "survives utterances that make no sense, and answers the next", nonsense),
    rule("foreign", "ignores utterances of another epoch", foreign),
    rule("resume", "answers after kill -9 what was said meanwhile", resume),
    rule("latency", "answers within a second", latency),
];

/// Longest time for an answer where the rule is about what it says: a busy machine is no fault of the service.
const ANSWER_PATIENCE: Duration = Duration::from_secs(10);
/// Longest time for an answer where the rule is about its time: people wait for about a second.
const LATENCY_MAX: Duration = Duration::from_secs(1);
/// Utterances whose time is taken.
const TIMED: usize = 100;
/// Interval at which an utterance without an answer is sent again.
const RESEND_EVERY: Duration = Duration::from_millis(500);
/// Deviation of a sum of weights from 1 that is taken for rounding.
const WEIGHT_TOLERANCE: f64 = 1e-6;

/// The tester's topics.
pub(super) struct Speaking {
    utterances: Writer<Utterance>,
    observations: Reader<Observation>,
    /// Number of the latest utterance.
    seq: u64,
    _buses: [Bus; 2],
}

impl Speaking {
    /// Takes the place of speech, with utterances above `seq`.
    fn open(test: &Test<'_>, epoch: Epoch, seq: u64) -> Result<Self, Failure> {
        let (speech, policy) = (test.bench.bus("speech", epoch)?, test.bench.bus("policy", EPOCH)?);
        let utterances = speech.writer(&topics::UTTERANCE)?;
        let observations = policy.reader(&topics::OBSERVATION)?;
        Ok(Self { utterances, observations, seq, _buses: [speech, policy] })
    }
}

impl Test<'_> {
    fn speaking(&mut self) -> Result<&mut Speaking, Broken> {
        if self.speaking.is_none() {
            // Numbers above those of an earlier writer.
            self.speaking = Some(Speaking::open(self, EPOCH, clock::now().ns() / 1_000)?);
        }
        Ok(self.speaking.as_mut().expect("just opened"))
    }

    /// The next utterance with these hypotheses.
    fn said(&mut self, heard: &[Hypothesis]) -> Result<Utterance, Broken> {
        let now = clock::now().ns();
        let speaking = self.speaking()?;
        speaking.seq += 1;
        let mut said = Utterance {
            seq: speaking.seq,
            onset_ns: now,
            end_ns: now,
            accepted_ns: now,
            ..Utterance::default()
        };
        said.set_hypotheses(heard).map_err(|error| Broken::new(error.to_string(), ""))?;
        Ok(said)
    }

    /// Sends the utterance until it is answered. Returns the answer and the time that it took.
    fn ask(
        &mut self,
        said: &Utterance,
        patience: Duration,
    ) -> Result<(Observation, Duration), Broken> {
        self.running()?;
        let (began, dropped) = (Instant::now(), rejected());
        let mut polling = Polling::default();
        let mut sent: Option<Instant> = None;
        while began.elapsed() < patience {
            let speaking = self.speaking()?;
            if sent.is_none_or(|sent| sent.elapsed() >= RESEND_EVERY) {
                speaking.utterances.send(said)?;
                sent = Some(Instant::now());
            }
            let mut found = None;
            speaking.observations.drain(|one| {
                if one.seq == said.seq {
                    found = Some(*one);
                }
            })?;
            if let Some(observation) = found {
                return Ok((observation, began.elapsed()));
            }
            self.survives(&format!("after utterance {}", text_of(said)), Duration::ZERO)?;
            polling.pause();
        }
        Err(unanswered(said, patience, rejected() - dropped))
    }
}

/// An utterance without an answer.
fn unanswered(said: &Utterance, patience: Duration, dropped: u64) -> Broken {
    let what = format!("expected an observation of {} within {}", text_of(said), seconds(patience));
    match dropped {
        0 => Broken::new(
            format!("{what}, found none with its `seq`"),
            "answer each utterance, also one that says nothing about the scene, with its `seq`, and \
             notify wake/policy",
        ),
        dropped => Broken::new(
            format!("{what}, found {dropped} with invalid codes"),
            "use the codes of tests/golden/wire_layout.txt",
        ),
    }
}

fn text_of(said: &Utterance) -> String {
    let text = said.hypotheses().ok().and_then(|heard| heard.into_iter().next());
    let text: String = text.map(|heard| heard.text.chars().take(24).collect()).unwrap_or_default();
    format!("\"{text}\"")
}

/// Has the grounder answer an utterance, rightly or not.
pub(super) fn exercise(test: &mut Test<'_>) -> Result<(), Broken> {
    let said = test.said(&[Hypothesis::certain("the one")])?;
    match test.ask(&said, LATENCY_MAX) {
        Err(broken) if test.subject.is_none() => Err(broken),
        _ => Ok(()),
    }
}

/// Utterances of every kind, with the special feature of each.
fn kinds(test: &mut Test<'_>) -> Result<Vec<(&'static str, Utterance)>, Broken> {
    let scene = test.bench.settings.scene.clone();
    let word = scene.words().first().cloned().unwrap_or_default();
    let asked = |question: Question, number: u64| AskedQuestion {
        prompt: number,
        scene: scene.key(),
        question: WireQuestion::from(question),
        presentation: 1,
        whole: 1,
        ..AskedQuestion::default()
    };
    let weighed = |text: String, weight| Hypothesis { weight, ..Hypothesis::certain(text) };
    let point = asked(Question::Point(ObjectId(0)), 1);
    let mut all = Vec::new();
    let plain = test.said(&[Hypothesis::certain(format!("get me the {word}"))])?;
    all.push(("a request", plain));
    let heard = [weighed(format!("the {word}"), 0.7), weighed("the other one".into(), 0.3)];
    all.push(("two hypotheses", test.said(&heard)?));
    let mut answer = test.said(&[Hypothesis::certain("yes")])?;
    answer.set_asked(&[point]);
    all.push(("an answer", answer));
    let mut answer = test.said(&[Hypothesis::certain(format!("no, the {word}"))])?;
    answer.set_asked(&[4, 3, 2, 1].map(|number| asked(Question::Point(ObjectId(0)), number)));
    all.push(("an answer to one of four questions", answer));
    let mut other = test.said(&[Hypothesis::certain("yes")])?;
    other.set_asked(&[AskedQuestion { scene: scene.key() ^ 1, ..point }]);
    all.push(("an answer to a question about another scene", other));
    let mut gesture = test.said(&[])?;
    gesture.gesture = WireGesture::from(Some([0.7, 0.1, 0.0]));
    all.push(("a gesture without words", gesture));
    all.push(("words that the scene does not have", test.said(&[Hypothesis::certain("zyx qwv")])?));
    let long = "the one over there and ".repeat(300);
    all.push(("a long utterance", test.said(&[Hypothesis::certain(long)])?));
    Ok(all)
}

fn answers(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let kinds = kinds(test)?;
    let scene = test.bench.settings.scene.clone();
    for (kind, said) in &kinds {
        let (observation, _) = test.ask(said, ANSWER_PATIENCE)?;
        judge(said, &observation, &scene).map_err(|(what, help)| {
            Broken::new(format!("{kind} ({}): {what}", text_of(said)), help)
        })?;
    }
    Ok(Kept::Fact(scene::count(kinds.len(), "kind")))
}

/// Judges an observation as the policy does, and beyond.
fn judge(
    said: &Utterance,
    found: &Observation,
    scene: &Scene,
) -> Result<(), (String, &'static str)> {
    let is_copied = found.asked_count == said.asked_count
        && found.asked == said.asked
        && found.source == said.source
        && found.gesture == said.gesture
        && (found.onset_ns, found.end_ns, found.accepted_ns)
            == (said.onset_ns, said.end_ns, said.accepted_ns);
    if !is_copied {
        let what = "expected the utterance's asked, source, gesture and times, found others";
        return Err((what.to_owned(), "copy every field that both messages have"));
    }
    if found.scene_key != scene.key() {
        let what =
            format!("expected scene_key {:016x}, found {:016x}", scene.key(), found.scene_key);
        return Err((what, "use the key of the scene in run/settings.toml"));
    }
    let readings = found.interpretations(scene.words().len()).map_err(|error| {
        (
            format!("invalid readings: {error}"),
            "keep counts, words, weights and doubts in their bounds",
        )
    })?;
    let is_bare_gesture = said.hypothesis_count == 0;
    let places = (0..usize::from(said.asked_count)).map(Some).chain([None]);
    for place in places.filter(|place| !is_bare_gesture || place.is_none()) {
        let of_place = readings.iter().filter(|reading| reading.answers == place);
        let sum = of_place.fold(0.0, |sum, reading| sum + reading.weight);
        if (sum - 1.0).abs() > WEIGHT_TOLERANCE {
            let place = place.map_or("no question".to_owned(), |at| format!("question {at}"));
            let what = format!("expected weights for {place} that sum to 1, found {sum}");
            return Err((what, "read the utterance for each question asked and for none"));
        }
    }
    Ok(())
}

fn repeats(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let kinds = kinds(test)?;
    for (kind, said) in &kinds {
        let (first, _) = test.ask(said, ANSWER_PATIENCE)?;
        let (again, _) = test.ask(said, ANSWER_PATIENCE)?;
        if (Observation { grounded_ns: first.grounded_ns, ..again }) != first {
            let what = format!(
                "{kind} ({}): expected the same observation again, found another",
                text_of(said)
            );
            let help = "an observation depends on scene and utterance alone; keep the answer of a model that varies";
            return Err(Broken::new(what, help));
        }
    }
    Ok(Kept::Fact(scene::count(kinds.len(), "kind")))
}

fn burst(test: &mut Test<'_>) -> Result<Kept, Broken> {
    test.running()?;
    let word = test.bench.settings.scene.words().first().cloned().unwrap_or_default();
    let mut said = Vec::new();
    for _ in 0..WINDOW {
        said.push(test.said(&[Hypothesis::certain(format!("the {word}"))])?);
    }
    let speaking = test.speaking()?;
    said.iter().try_for_each(|one| speaking.utterances.send(one))?;
    let (began, mut latest) = (Instant::now(), Instant::now());
    let mut open: Vec<u64> = said.iter().map(|one| one.seq).collect();
    let mut polling = Polling::default();
    while !open.is_empty() {
        if latest.elapsed() > ANSWER_PATIENCE {
            let what = format!("expected {WINDOW} observations, found {}", WINDOW - open.len());
            return Err(Broken::new(
                what,
                "read every waiting message on each wake-up, and answer each",
            ));
        }
        test.speaking()?.observations.drain(|one| {
            latest = Instant::now();
            open.retain(|seq| *seq != one.seq);
        })?;
        test.survives("during a burst", Duration::ZERO)?;
        polling.pause();
    }
    Ok(Kept::Fact(format!("{WINDOW} in {} ms", began.elapsed().as_millis())))
}

/// Malformed utterances, by the fault of each.
fn senseless(good: &Utterance) -> Vec<(&'static str, Utterance)> {
    let with = |change: &dyn Fn(&mut Utterance)| {
        let mut bad = *good;
        change(&mut bad);
        bad
    };
    vec![
        ("an invalid source", with(&|it| it.source = messages::Code::from_raw(77))),
        ("200 hypotheses", with(&|it| it.hypothesis_count = 200)),
        ("99 questions", with(&|it| it.asked_count = 99)),
        ("words beyond the text", with(&|it| it.hypotheses[0].len = u32::MAX)),
        ("a weight that is no number", with(&|it| it.hypotheses[0].weight = f64::NAN)),
        ("a text longer than its room", with(&|it| it.text = text(u32::MAX, b"the first one"))),
        ("a text that is not UTF-8", with(&|it| it.text = text(13, b"\xffhe first one"))),
        ("an invalid gesture", with(&|it| it.gesture.present = 9)),
        (
            "an unknown kind of question",
            with(&|it| {
                it.asked_count = 1;
                it.asked[0].question.kind = 99;
            }),
        ),
    ]
}

/// A text as only a writer with a fault writes it.
fn text<const N: usize>(len: u32, bytes: &[u8]) -> FixedText<N> {
    FixedText::from_raw(len, bytes).unwrap_or_default()
}

fn nonsense(test: &mut Test<'_>) -> Result<Kept, Broken> {
    test.running()?;
    let good = test.said(&[Hypothesis::certain("the first one")])?;
    let senseless = senseless(&good);
    for (what, bad) in &senseless {
        let speaking = test.speaking()?;
        speaking.seq += 1;
        let bad = Utterance { seq: speaking.seq, ..*bad };
        speaking.utterances.send(&bad)?;
        test.survives(&format!("after an utterance with {what}"), super::PAUSE)?;
        let next = test.said(&[Hypothesis::certain("the next one")])?;
        test.ask(&next, ANSWER_PATIENCE).map_err(|broken| {
            Broken::new(format!("after an utterance with {what}: {}", broken.what), broken.help)
        })?;
    }
    Ok(Kept::Fact(scene::count(senseless.len(), "kind")))
}

fn foreign(test: &mut Test<'_>) -> Result<Kept, Broken> {
    test.running()?;
    let said = test.said(&[Hypothesis::certain("the first one")])?;
    test.speaking = None;
    test.speaking = Some(Speaking::open(test, Epoch(EPOCH.0 + 1), said.seq)?);
    let answered = test.ask(&said, RESEND_EVERY);
    test.speaking = None;
    match answered {
        Err(broken) if test.subject.is_none() => Err(broken),
        Err(_) => Ok(Kept::Fact("none answered".to_owned())),
        Ok(_) => Err(Broken::new(
            format!("expected no answer to an utterance of epoch {}, found one", EPOCH.0 + 1),
            "compare the epoch in the stamp of each message with $WHICHONE_EPOCH",
        )),
    }
}

fn resume(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let before = test.said(&[Hypothesis::certain("the first one")])?;
    test.ask(&before, ANSWER_PATIENCE)?;
    test.running()?.kill();
    test.forget();
    let missed = test.said(&[Hypothesis::certain("the second one")])?;
    test.speaking()?.utterances.send(&missed)?;
    test.running()?;
    let (_, took) = test.ask(&missed, ANSWER_PATIENCE)?;
    // Utterances answered before are asked again until they are applied.
    test.ask(&before, ANSWER_PATIENCE)?;
    Ok(Kept::Fact(format!("{} ms after it was ready again", took.as_millis())))
}

fn latency(test: &mut Test<'_>) -> Result<Kept, Broken> {
    let words = test.bench.settings.scene.words().to_vec();
    let mut times = Vec::with_capacity(TIMED);
    for turn in 0..TIMED {
        let word = words.get(turn % words.len().max(1)).map_or("one", String::as_str);
        let said = test.said(&[Hypothesis::certain(format!("get me the {word}"))])?;
        let (_, took) = test.ask(&said, ANSWER_PATIENCE)?;
        times.push(took);
        if took > LATENCY_MAX {
            let what = format!(
                "expected answers within {}, found one after {}",
                seconds(LATENCY_MAX),
                seconds(took)
            );
            return Err(Broken::new(
                what,
                "answer what is certain at once; a slow model needs a time-out",
            ));
        }
    }
    times.sort_unstable();
    let at =
        |share: usize| times[(times.len() * share / 100).min(times.len() - 1)].as_secs_f64() * 1e3;
    Ok(Kept::Fact(format!("p50 {:.2} ms, p99 {:.2} ms of {TIMED}", at(50), at(99))))
}
