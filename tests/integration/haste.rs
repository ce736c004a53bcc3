//! A program that answers each question as soon as it is shown, before the robot's own voice has begun it, also
//! while the speech service is killed.

use std::time::{Duration, Instant};

use config::Settings;
use laboratory::TruthfulUser;
use messages::{Activity, Outcome, PresentationState, Presented, PromptId, Sound, topics};
use rustix::process::Signal;
use service::client::Client;
use service::submission::Submission;
use service::view::{Latest, LatestTopics};
use service::{Span, Time, clock};
use whichone_tests::{Group, number};

use crate::console_voice::ALOUD;

/// Delays of an answer, milliseconds.
const AFTER_MS: [u64; 3] = [0, 50, 200];
/// Answers of each kind, at least; WHICHONE_ANSWERS asks for more.
const ANSWERS: u64 = 12;
/// Timeout of a dialogue.
const PATIENCE: Duration = Duration::from_secs(180);

/// Answers that were given, and those that were not credited to their question alone.
#[derive(Debug, Default)]
struct Tally {
    answers: u64,
    wrong: Vec<String>,
}

/// A request with its number, once that is known.
type Sent = (Submission, Option<u64>);

fn pending<'a>(
    said: &'a mut Option<Sent>,
    answered: &'a mut Option<(Submission, PromptId, Option<u64>)>,
) -> impl Iterator<Item = (&'a mut Submission, &'a mut Option<u64>)> {
    let said = said.iter_mut().map(|(own, number)| (own, number));
    said.chain(answered.iter_mut().map(|(own, _, number)| (own, number)))
}

/// Has an object fetched; `kills`: the speech service is killed as a question is shown.
fn fetch(group: &Group, wanted: &str, after: Duration, kills: bool, tally: &mut Tally) {
    let settings = Settings::load_snapshot(&group.paths().run()).unwrap();
    let client = Client::join(group.paths()).unwrap();
    let writer = client.bus().encoded_writer(&topics::INJECTION).unwrap();
    let (mut all, _) = LatestTopics::open(client.bus(), &settings).unwrap();
    let mut user = TruthfulUser::new(&settings.scene, wanted, false).unwrap();
    let mut latest = Latest::default();
    let (mut said, mut last) = (None::<Sent>, None);
    let mut shown = (PromptId(0), Instant::now());
    let mut answered: Option<(Submission, PromptId, Option<u64>)> = None;
    let until = Instant::now() + PATIENCE;
    let submission = |text: &str, latest: &Latest| {
        let (sound, said) = (Sound::Text(text.to_owned()), (clock::now(), Time(0)));
        Submission::new(sound, said, clock::now(), Span(u64::MAX / 2)).after(latest.prompt())
    };
    loop {
        assert!(Instant::now() < until, "{wanted}: {latest:?}");
        let arrived = all.take();
        latest.update(&arrived);
        for receipt in &arrived.receipts {
            for (own, number) in pending(&mut said, &mut answered) {
                let is_own = own.key() == receipt.request();
                *number = number.or(is_own.then_some(receipt.seq));
            }
        }
        let Some(view) = latest.view.clone() else { continue };
        last.get_or_insert_with(|| view.last.as_ref().map_or(0, |last| last.interaction.0));
        if let Some((_, prompt, Some(seq))) = &answered
            && view.attributed.utterance.0 >= *seq
        {
            let share = view.attributed.share(*prompt);
            if view.attributed.utterance.0 != *seq || share < 0.999 {
                tally.wrong.push(format!("{prompt:?}, utterance {seq}: {:?}", view.attributed));
            }
            answered = None;
        }
        if said.is_none() {
            said = Some((submission("get me the bowl", &latest), None));
        }
        if let Some(ended) = view.last.filter(|ended| Some(ended.interaction.0) > last) {
            assert_eq!((ended.outcome, ended.name.as_deref()), (Outcome::Delivered, Some(wanted)));
            return;
        }
        if shown.0.0 != view.prompt {
            shown = (PromptId(view.prompt), Instant::now());
            let is_question = view.interaction != 0 && view.question != scene::Question::None;
            if kills && is_question {
                group.signal("speech", Signal::KILL);
            }
        }
        let is_heard = said.as_ref().is_some_and(|(_, number)| number.is_some());
        if is_heard && answered.is_none() && shown.1.elapsed() >= after {
            let (prompt, state) = (shown.0.0, PresentationState::Ended.code());
            let presented = Presented { prompt, presentation: 1, state, ..Presented::default() };
            let activity = Some(Activity::default());
            let as_shown = Latest { presented, activity, accepted: 0, ..latest.clone() };
            if let Some(answer) = user.answer(&as_shown) {
                answered = Some((submission(&answer, &latest), shown.0, None));
                tally.answers += 1;
            }
        }
        let now = clock::now();
        for (own, number) in pending(&mut said, &mut answered) {
            if number.is_none()
                && let Some(request) = own.due(now)
            {
                // Speech may be away; the request is sent again.
                let _ = writer.send(request);
            }
        }
        std::thread::sleep(Duration::from_micros(300));
    }
}

fn all_answers_are_credited(settings: &[&str], kills: bool) {
    const OBJECTS: [&str; 6] = ["white", "white2", "white3", "metal", "metal2", "clear"];
    let group = Group::up(&[settings, &["arm.time_scale=60.0"]].concat());
    let answers = number("WHICHONE_ANSWERS").unwrap_or(ANSWERS);
    for after_ms in AFTER_MS {
        let mut tally = Tally::default();
        for wanted in OBJECTS.into_iter().cycle() {
            fetch(&group, wanted, Duration::from_millis(after_ms), kills, &mut tally);
            if tally.answers >= answers {
                break;
            }
        }
        let (wrong, all) = (tally.wrong.len() as u64, tally.answers);
        assert!(wrong == 0, "{after_ms} ms: {wrong} of {all}: {:#?}", tally.wrong);
    }
    group.verify_journals();
    group.down();
}

#[test]
fn hasty_answers_are_credited_to_their_questions() {
    all_answers_are_credited(&[], false);
}

#[test]
fn hasty_answers_are_credited_to_their_questions_though_speech_is_killed() {
    all_answers_are_credited(&[], true);
}

#[test]
#[ignore = "needs espeak-ng"]
fn hasty_answers_are_credited_to_their_questions_beside_a_loudspeaker() {
    all_answers_are_credited(&ALOUD, false);
    all_answers_are_credited(&ALOUD, true);
}
