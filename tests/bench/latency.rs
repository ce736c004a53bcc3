//! From an utterance handed in to the decision that answers it, through all processes, by stage.

use crate::peers::{SYNC, WAKE};
use crate::report::{Report, percentile};
use messages::{AppliedMark, Injection, Observation, Receipt, RobotAct, Sound, Utterance, topics};
use service::bus::Reader;
use service::client::{Client, deliver};
use service::clock;
use service::{Span, Time};
use std::time::Duration;
use whichone_tests::hammer::Hammer;
use whichone_tests::{Group, wait_for};

/// Utterances measured.
const UTTERANCES: usize = 200;

/// Polling interval of the policy's mark.
const MARK_POLL: Duration = Duration::from_micros(200);

/// The stages between the moments of [`Moments`], in order.
const STAGES: [&str; 6] = [
    "client to speech (hop)",
    "accept: number, append, sync",
    "speech to grounding (hop)",
    "ground: words to reading",
    "grounding to policy (hop)",
    "decide: belief, plan, append, sync",
];

/// When the utterance was given, accepted, sent; read, sent; taken in, and its act sent.
pub(crate) type Moments = [u64; 7];

pub(crate) fn measure(report: &mut Report) {
    let group = Group::up(&["dialogue.turns.questions_max=1000"]);
    let client = Client::join(group.paths()).expect("a running group");
    let mut taps = Taps::open(&client);
    let samples: Vec<Moments> = (0..UTTERANCES).map(|n| taps.utter(n)).collect();
    let ms = |from: usize, to: usize| -> Vec<f64> {
        samples.iter().map(|m| m[to].saturating_sub(m[from]) as f64 / 1e6).collect()
    };
    let total = ms(0, 6);
    report.add_beside("utterance in to decision out", "ms", &total, SYNC, "two syncs, three hops");
    for (i, stage) in STAGES.iter().enumerate() {
        let samples = ms(i, i + 1);
        let share = 100.0 * percentile(&samples, 0.5) / percentile(&total, 0.5);
        let peer = if stage.contains("hop") { WAKE } else { SYNC };
        report.add_beside(stage, "ms", &samples, peer, &format!("{share:.0} % of the whole"));
    }
    let applied = |_| taps.apply("the white one");
    let alone: Vec<f64> = (0..UTTERANCES / 4).map(applied).collect();
    report.add_beside("utterance in to applied", "ms", &alone, SYNC, "one client alone");
    let hammer = Hammer::start(&group, "the metal one");
    let beside: Vec<f64> = (0..UTTERANCES / 4).map(applied).collect();
    drop(hammer);
    let what = "utterance in to applied while another client hammers";
    report.add_beside(what, "ms", &beside, SYNC, "2,000 requests a second of the other one");
    drop(taps);
    drop(client);
    group.down();
}

pub(crate) struct Taps {
    utterances: Reader<Utterance>,
    observations: Reader<Observation>,
    acts: Reader<RobotAct>,
    receipts: Reader<Receipt>,
    marks: Reader<AppliedMark>,
    injections: service::bus::EncodedWriter<Injection>,
}

impl Taps {
    pub(crate) fn open(client: &Client) -> Self {
        let bus = client.bus();
        Self {
            utterances: bus.reader(&topics::UTTERANCE).expect("utterances"),
            observations: bus.reader(&topics::OBSERVATION).expect("observations"),
            acts: bus.reader(&topics::ACT).expect("acts"),
            receipts: bus.reader(&topics::RECEIPT).expect("receipts"),
            marks: bus.reader(&topics::MARK).expect("marks"),
            injections: bus.encoded_writer(&topics::INJECTION).expect("injections"),
        }
    }

    /// Says something that changes nothing for good, and collects the moments of its way.
    pub(crate) fn utter(&mut self, n: usize) -> Moments {
        std::thread::sleep(Duration::from_millis(20));
        let text = if n.is_multiple_of(2) { "the white one" } else { "start over" };
        let mut moments = [clock::now().ns(), 0, 0, 0, 0, 0, 0];
        let seq = self.say(text);
        wait_for("the decision", 10.0, || {
            self.collect(seq, &mut moments);
            moments.iter().all(|&at| at > 0).then_some(())
        });
        moments
    }

    /// Submits a text and returns its number.
    fn say(&self, text: &str) -> u64 {
        let (sound, patience) = (Sound::Text(text.to_owned()), Span::from_ms(10_000));
        let said = (clock::now(), Time(0));
        let receipts = deliver(&self.injections, &self.receipts, sound, said, patience, || None);
        receipts.expect("a receipt")[0].utterance().expect("an accepted utterance").0
    }

    /// Submits a text and returns the milliseconds until the policy has applied it.
    fn apply(&self, text: &str) -> f64 {
        std::thread::sleep(Duration::from_millis(20));
        let begun_ns = clock::now().ns();
        let (seq, mut applied_ns) = (self.say(text), None);
        while applied_ns.is_none() {
            std::thread::sleep(MARK_POLL);
            let marks = self.marks.drain_stamped(|mark, stamp| {
                applied_ns = applied_ns.or((mark.seq >= seq).then_some(stamp.sent_ns));
            });
            marks.expect("a topic that can be read");
        }
        applied_ns.unwrap_or(0).saturating_sub(begun_ns) as f64 / 1e6
    }

    fn collect(&self, seq: u64, moments: &mut Moments) {
        let once = |slot: &mut u64, at: u64| {
            if *slot == 0 {
                *slot = at;
            }
        };
        let utterances = self.utterances.drain_stamped(|utterance, stamp| {
            if utterance.seq == seq {
                once(&mut moments[1], utterance.accepted_ns);
                once(&mut moments[2], stamp.sent_ns);
            }
        });
        let observations = self.observations.drain_stamped(|observation, stamp| {
            if observation.seq == seq {
                once(&mut moments[3], observation.grounded_ns);
                once(&mut moments[4], stamp.sent_ns);
            }
        });
        let acts = self.acts.drain_stamped(|act, stamp| {
            if act.utterance == seq {
                once(&mut moments[5], act.decided_ns);
                once(&mut moments[6], stamp.sent_ns);
            }
        });
        utterances.and(observations).and(acts).expect("topics that can be read");
    }
}
