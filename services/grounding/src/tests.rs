//! Grounding with a language model: which readings leave, in which order, and when.

use std::time::Duration;

use language::Reader;
use messages::{AskedQuestion, Hypothesis, Interpretation, Observation, Utterance};
use model_reader::Client;
use model_reader::{Calibration, LanguageModel};
use scene::{Response, Scene};
use serde_json::{Value as Json, json};
use service::{Effects, Event, Never, Node, Span, Time, clock, worker_channel};
use stand_in_model::{Reply, StandIn, reading, wants};
use vocabulary::Language;

use crate::model_worker::ModelWorker;
use crate::{Config, GroundingNode, In, ModelAnswer, ModelRequest, ModelUse, Out};

const TIMEOUT: Span = Span::from_ms(1000);

fn scene() -> Scene {
    Scene::from_toml("bowls", include_str!("../../../config/scenes/bowls.toml")).unwrap()
}

fn config(calibration: Calibration) -> Config {
    let scene = scene();
    let reader = Reader::new(&scene, Language::Careful);
    let model = Some(ModelUse { name: "small".to_owned(), timeout: TIMEOUT, calibration });
    Config { scene, reader, model }
}

fn node() -> GroundingNode {
    GroundingNode::recover(config(Calibration::NONE), Vec::new()).unwrap()
}

fn utterance(seq: u64, text: &str) -> Utterance {
    let mut utterance = Utterance { seq, ..Utterance::default() };
    utterance.set_hypotheses(&[Hypothesis::certain(text)]).unwrap();
    utterance
}

fn ms(ms: u64) -> Time {
    Time(1) + Span::from_ms(ms)
}

/// Gives the node an event; returns its observations and requests.
fn give(
    node: &mut GroundingNode,
    event: Event<In<'static>>,
    now: Time,
) -> (Vec<Observation>, Vec<ModelRequest>) {
    let mut effects: Effects<Out, Never> = Effects::default();
    node.on(event, now, &mut effects);
    let (mut observations, mut requests) = (Vec::new(), Vec::new());
    for output in effects.take_outputs() {
        match output {
            Out::Observation(observation) => observations.push(*observation),
            Out::Ask(request) => requests.push(request),
        }
    }
    (observations, requests)
}

fn say(
    node: &mut GroundingNode,
    utterance: Utterance,
    now: Time,
) -> (Vec<Observation>, Vec<ModelRequest>) {
    give(node, Event::Message(In::Utterance(utterance.into())), now)
}

fn answer(
    node: &mut GroundingNode,
    ticket: u64,
    content: Result<String, &str>,
    now: Time,
) -> Vec<Observation> {
    let content = content.map_err(str::to_owned);
    let event = Event::Message(In::Answer(ModelAnswer { ticket, content }));
    give(node, event, now).0
}

fn meant(observation: &Observation) -> Vec<Interpretation> {
    let asked = usize::from(observation.asked_count);
    let used = &observation.readings[..usize::from(observation.reading_count)];
    let words = scene().words().len();
    used.iter().map(|it| it.interpretation(words, asked).unwrap()).collect()
}

/// Words of the likeliest reading.
fn words(observation: &Observation) -> Vec<String> {
    let scene = scene();
    let base = &meant(observation)[0].reading.base;
    base.iter().map(|word| scene.words()[word.index()].clone()).collect()
}

#[test]
fn answer_takes_the_place_of_the_built_in_readings() {
    let mut node = node();
    assert_eq!((node.status(), node.deadline()), (None, None));
    let (observations, requests) = say(&mut node, utterance(1, "grandma's bowl"), ms(5));
    assert!(observations.is_empty() && requests.len() == 1);
    assert_eq!((requests[0].due, node.deadline()), (ms(5) + TIMEOUT, Some(ms(5) + TIMEOUT)));
    assert_eq!((node.pending_since(), node.checkpoint()), (Some(ms(5)), None));
    let content = json!({ "readings": [
        reading(Json::Null, 3.0, &["clear"], "none"), reading(Json::Null, 1.0, &["white"], "none"),
    ] });
    let observations = answer(&mut node, requests[0].ticket, Ok(content.to_string()), ms(9));
    assert_eq!((observations.len(), observations[0].seq), (1, 1));
    assert_eq!(observations[0].grounded_ns, ms(9).ns());
    let meant = meant(&observations[0]);
    assert_eq!(meant.iter().map(|it| it.weight).collect::<Vec<_>>(), [0.75, 0.25]);
    assert_eq!(words(&observations[0]), ["clear"]);
    assert_eq!(observations[0].unknown.as_str().unwrap(), "");
    assert_eq!((node.status(), node.deadline()), (Some("model small answers"), None));
}

#[test]
fn built_in_reader_takes_the_place_of_what_is_late_or_wrong() {
    let mut node = node();
    let unknown_key = r#"{"readings":[],"note":"x"}"#.to_owned();
    let wrong: [(Result<String, &str>, &str); 5] = [
        (Ok("the white one!".to_owned()), "answer refused: not the agreed JSON"),
        (Ok(unknown_key), "unknown field `note`"),
        (Ok(wants(&["purple"])), "`purple` is not a value of the scene"),
        (Ok(wants(&["white2"])), "`white2` is an object"),
        (Err("not reached: connection refused"), "not reached"),
    ];
    for (seq, (content, status)) in (1..).zip(wrong) {
        let (_, requests) = say(&mut node, utterance(seq, "the white bowl"), ms(10 * seq));
        let found = answer(&mut node, requests[0].ticket, content, ms(10 * seq + 1));
        assert_eq!((found.len(), words(&found[0])), (1, vec!["white".to_owned()]));
        assert!(node.status().unwrap().contains(status), "{status}: {:?}", node.status());
    }
    let (_, requests) = say(&mut node, utterance(9, "the white bowl"), ms(100));
    assert!(give(&mut node, Event::Tick, ms(1099)).0.is_empty());
    let found = give(&mut node, Event::Tick, ms(1100)).0;
    assert_eq!((found.len(), words(&found[0])), (1, vec!["white".to_owned()]));
    assert!(node.status().unwrap().contains("no answer within 1000 ms"), "{:?}", node.status());
    assert!(answer(&mut node, requests[0].ticket, Ok(wants(&["clear"])), ms(1101)).is_empty());
    let (_, requests) = say(&mut node, utterance(11, "the wooden bowl"), ms(1150));
    let found = answer(&mut node, requests[0].ticket, Ok(wants(&[])), ms(1151));
    assert_eq!(found[0].unknown.as_str().unwrap(), "wooden", "neither knows it");
    let (_, requests) = say(&mut node, utterance(10, "the bowl"), ms(1200));
    assert_eq!(answer(&mut node, requests[0].ticket, Ok(wants(&["clear"])), ms(1201)).len(), 1);
    assert_eq!(node.status(), Some("model small answers"));
}

#[test]
fn observations_leave_in_the_order_of_the_utterances() {
    let mut node = node();
    let (_, first) = say(&mut node, utterance(1, "the first one"), ms(0));
    let (_, second) = say(&mut node, utterance(2, "the second one"), ms(100));
    // A request to stop is not for the model, and waits for its turn.
    let (observations, third) = say(&mut node, utterance(3, "stop"), ms(200));
    assert!(observations.is_empty() && third.is_empty());
    assert!(answer(&mut node, second[0].ticket, Ok(wants(&["white"])), ms(300)).is_empty());
    let found = answer(&mut node, first[0].ticket, Ok(wants(&["clear"])), ms(400));
    assert_eq!(found.iter().map(|it| it.seq).collect::<Vec<_>>(), [1, 2, 3]);
    assert_eq!((words(&found[0]), words(&found[1])), (vec!["clear".into()], vec!["white".into()]));
    assert_eq!(meant(&found[2])[0].reading.intent, scene::Intent::Stop);
    assert_eq!(say(&mut node, utterance(4, "stop"), ms(500)).0.len(), 1, "with nothing before it");
    // Many at a time: those beyond the bound are read by the built-in reader, in their turn.
    let asked: usize =
        (5..30).map(|seq| say(&mut node, utterance(seq, "the white bowl"), ms(600)).1.len()).sum();
    assert_eq!(asked, crate::model_queue::PENDING_MAX);
    let found = give(&mut node, Event::Tick, ms(1600)).0;
    assert_eq!(found.iter().map(|it| it.seq).collect::<Vec<_>>(), (5..30).collect::<Vec<_>>());
}

#[test]
fn utterance_that_is_sent_again_gets_one_answer_and_the_same() {
    let mut node = node();
    let (_, requests) = say(&mut node, utterance(1, "grandma's bowl"), ms(0));
    let (observations, again) = say(&mut node, utterance(1, "grandma's bowl"), ms(50));
    assert!(observations.is_empty() && again.is_empty());
    let first = answer(&mut node, requests[0].ticket, Ok(wants(&["clear"])), ms(60));
    let (second, again) = say(&mut node, utterance(1, "grandma's bowl"), ms(70));
    assert!(again.is_empty());
    assert_eq!((words(&second[0]), first[0].readings), (words(&first[0]), second[0].readings));

    // With a question that was put meanwhile it is another matter; so it is for a node that was
    // resumed from a checkpoint.
    let checkpoint = node.checkpoint().unwrap();
    let mut node = GroundingNode::resume(config(Calibration::NONE), &checkpoint).unwrap();
    assert_eq!(say(&mut node, utterance(1, "grandma's bowl"), ms(80)).0.len(), 1);
    let mut asked = utterance(1, "grandma's bowl");
    asked.set_asked(&[AskedQuestion::default()]);
    assert_eq!(say(&mut node, asked, ms(90)).1.len(), 1);
    assert!(GroundingNode::resume(config(Calibration::NONE), &[255; 40]).is_err());
    assert!(GroundingNode::resume(config(Calibration::NONE), &[]).is_ok());
}

/// An utterance after a question of this scene.
fn answering(seq: u64, hypothesis: Hypothesis) -> Utterance {
    let scene = scene();
    let white = json!({ "type": "attr", "attribute": "color", "value": "white" });
    let question = scene::question_from_json(&scene, &white).unwrap();
    let mut utterance = Utterance { seq, ..Utterance::default() };
    utterance.set_hypotheses(&[hypothesis]).unwrap();
    let asked =
        AskedQuestion { question: question.into(), scene: scene.key(), ..AskedQuestion::default() };
    utterance.set_asked(&[asked]);
    utterance
}

#[test]
fn questions_that_the_model_passes_over_are_read_by_the_built_in_reader() {
    let mut node = node();
    let (_, requests) = say(&mut node, answering(1, Hypothesis::certain("yes")), ms(0));
    let user: Json = serde_json::from_str(&requests[0].utterance).unwrap();
    assert_eq!(user["questions"][0]["text"], "Is it white?");
    let found = answer(&mut node, requests[0].ticket, Ok(wants(&["clear"])), ms(1));
    let readings = meant(&found[0]);
    assert_eq!((readings[0].answers, readings[0].reading.response), (Some(0), Response::Yes));
    assert_eq!((readings[1].answers, readings[1].reading.base.len()), (None, 1));

    // Words heard in noise are doubted as the built-in reader doubts them, or in the mean.
    let heard = Hypothesis::of_words([("yes".to_owned(), 0.8), ("clear".to_owned(), 0.4)], 1.0);
    let (_, requests) = say(&mut node, answering(2, heard), ms(10));
    let content = json!({ "readings": [reading(json!(0), 1.0, &["clear", "metal"], "yes")] });
    let found = answer(&mut node, requests[0].ticket, Ok(content.to_string()), ms(11));
    let doubt = &meant(&found[0])[0].reading.doubt;
    assert!((doubt.base[0] - 0.6).abs() < 0.01 && (doubt.base[1] - 0.4).abs() < 0.01, "{doubt:?}");
    assert!(doubt.response > 0.1, "{doubt:?}");
}

#[test]
fn calibration_mixes_the_built_in_reader_in() {
    let calibration = Calibration { power: 1.0, built_in: 0.25 };
    let mut node = GroundingNode::recover(config(calibration), Vec::new()).unwrap();
    let (_, requests) = say(&mut node, utterance(1, "the white bowl"), ms(0));
    let found = answer(&mut node, requests[0].ticket, Ok(wants(&["clear"])), ms(1));
    let weights: Vec<f64> = meant(&found[0]).iter().map(|it| it.weight).collect();
    assert_eq!((weights, words(&found[0])), (vec![0.75, 0.25], vec!["clear".to_owned()]));
}

/// The thread answers through the inbox of the main loop, which never waits: not for a slow
/// service, nor for one that is gone.
#[test]
fn worker_answers_within_the_time_of_each_request() {
    let server = StandIn::start(|request| match stand_in_model::heard(request).as_str() {
        "slow" => Reply::Slow(Duration::from_secs(20), wants(&[])),
        _ => Reply::Content(wants(&["clear"])),
    })
    .unwrap();
    let model = LanguageModel {
        url: server.url(),
        name: "small".to_owned(),
        timeout: Duration::from_secs(1),
        temperature: 0.0,
        key_file: None,
        calibration: Calibration::NONE,
    };
    let (inbox, answers) = worker_channel::channel().unwrap();
    let worker = ModelWorker::start(Client::new(&model, &scene()).unwrap(), inbox).unwrap();
    let request = |ticket, text: &str, within: Span| ModelRequest {
        ticket,
        due: clock::now() + within,
        utterance: model_reader::utterance(&scene(), &[(1.0, text)], &[]),
    };
    let next = || loop {
        match answers.take() {
            Some(In::Answer(answer)) => break answer,
            Some(other) => panic!("{other:?}"),
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    };
    let long = Span::from_ms(60_000);
    worker.submit(request(1, "slow", Span::from_ms(300))).unwrap();
    worker.submit(request(2, "late already", Span::from_ms(0))).unwrap();
    worker.submit(request(3, "the clear bowl", long)).unwrap();
    let first = next();
    assert!(first.ticket == 1 && first.content.unwrap_err().contains("no answer within"));
    assert_eq!(next(), ModelAnswer { ticket: 3, content: Ok(wants(&["clear"])) });
    let address = server.address();
    drop(server);
    worker.submit(request(4, "the clear bowl", long)).unwrap();
    assert!(next().content.unwrap_err().starts_with("not reached"));
    let _back = StandIn::start_at(address, |_| Reply::Content(wants(&[]))).unwrap();
    worker.submit(request(5, "the clear bowl", long)).unwrap();
    assert_eq!(next(), ModelAnswer { ticket: 5, content: Ok(wants(&[])) });
}
