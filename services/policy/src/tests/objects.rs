//! Objects from perception, under the real reducer.

use super::*;
use crate::Config;
use messages::{Change, Detection, Look, Sighting, TableView};
use scene::Scene;
use setup::DialogueSettings;
use vocabulary::Rng;

fn perceiving() -> Settings {
    static PERCEIVING: OnceLock<Settings> = OnceLock::new();
    PERCEIVING.get_or_init(|| settings_with(&[("group.perception.enabled", "true")])).clone()
}

/// The reducer with a camera in front of it, and its journal.
struct Bench {
    node: PolicyNode,
    records: Vec<Record>,
    table: TableView,
    now: Time,
    keys: u64,
}

fn config() -> Config {
    let settings = perceiving();
    let tracker = Some(settings.group.perception.tracker.clone());
    Config { tracker, ..Config::from(settings.manager().unwrap()) }
}

fn seen(class: &str, y: f64) -> Detection {
    let classes = vec![(class.to_owned(), 1.0)];
    Detection { classes, xyz: [0.65, y, -0.13], ..Detection::default() }
}

impl Bench {
    fn new() -> Self {
        let node = PolicyNode::recover(config(), Vec::new()).unwrap();
        let (records, table) = (Vec::new(), TableView::default());
        Self { node, records, table, now: at(100), keys: 0 }
    }

    fn with(seen: &[Detection]) -> Self {
        let mut bench = Self::new();
        bench.start();
        bench.looks(3, seen);
        assert_eq!(bench.objects().len(), seen.len());
        bench
    }

    fn start(&mut self) {
        let mut effects = Effects::default();
        self.node.on(Event::Started, self.now, &mut effects);
        self.note(effects);
    }

    fn note(&mut self, mut effects: Effects<Out, Record>) {
        self.records.extend(effects.take_records());
        for out in effects.take_outputs() {
            if let Out::Objects(view) = out {
                self.table = *view;
            }
        }
    }

    fn tell(&mut self, message: In) {
        let mut effects = Effects::default();
        self.node.on(Event::Message(message), self.now, &mut effects);
        self.note(effects);
    }

    fn sight(&mut self, key: u64, change: Change) {
        let (source, frame) = ("camera".to_owned(), "base".to_owned());
        self.tell(In::Sighting(Box::new(Sighting { key, source, frame, change })));
    }

    fn looks(&mut self, times: usize, seen: &[Detection]) {
        for _ in 0..times {
            self.now = self.now + Span::from_ms(100);
            let look = Look { at_ns: self.now.ns(), whole: true, seen: seen.to_vec() };
            self.keys += 1;
            self.sight(self.keys, Change::Look(look));
        }
    }

    fn hear(&mut self, reading: &Reading) {
        let state = self.node.state();
        let (seq, prompt) = (state.applied.0 + 1, state.act.prompt.0);
        self.now = self.now + Span::from_s(1.0);
        self.tell(observation(seq, prompt, reading));
    }

    fn says(&self, words: &[&str]) -> Reading {
        let scene = perceiving().scene;
        let base = words.iter().map(|word| scene.word_named(word).unwrap());
        Reading { base: base.collect(), ..Reading::default() }
    }

    fn objects(&self) -> Vec<String> {
        self.table.objects.iter().map(|object| object.known.name.clone()).collect()
    }

    fn scene(&self) -> Scene {
        let known: Vec<_> = self.table.objects.iter().map(|object| object.known.clone()).collect();
        perceiving().scene.with_objects(&known)
    }

    fn text(&self) -> String {
        rendering::text(&self.scene(), &self.node.state().act)
    }

    fn arm(&mut self, phase: PickPhase, outcome: PickOutcome) {
        let (id, object) = self.node.state().ordered().expect("an order");
        let object = self.scene().number(object);
        self.now = self.now + Span::from_s(1.0);
        self.tell(In::Arm(ArmStatus {
            interaction: id.interaction.0,
            attempt: id.attempt,
            object: object.0.into(),
            phase: phase.code(),
            outcome: outcome.code(),
            ..ArmStatus::default()
        }));
    }

    /// The journal folds to the same states, and a restart from its end knows the same.
    fn check(&mut self) {
        refold(&mut perceiving().manager().unwrap(), &self.records).unwrap();
        let mut again = PolicyNode::recover(config(), self.records.clone()).unwrap();
        assert_eq!(again.state(), self.node.state());
        let mut effects = Effects::default();
        again.on(Event::Started, self.now, &mut effects);
        assert_eq!(effects.take_records(), [], "a restart changes nothing");
        self.node = again;
    }
}

#[test]
fn questions_are_about_the_objects_seen() {
    let mut bench = Bench::with(&[seen("white", 0.0), seen("metal2", 0.2), seen("clear", 0.4)]);
    assert_eq!(bench.objects(), ["white-6", "metal2-7", "clear-8"]);
    let white = bench.says(&["white", "white"]);
    bench.hear(&white);
    let state = bench.node.state();
    assert_eq!((state.act.kind, belief(state).len()), (ActKind::Pick, 3));
    assert_eq!(bench.scene().object(state.act.pick.unwrap().1).name, "white-6");
    bench.check();
}

#[test]
fn objects_come_and_go_during_a_dialogue_and_the_belief_follows_by_name() {
    let mut bench = Bench::with(&[seen("white", 0.0), seen("white2", 0.2), seen("metal", 0.4)]);
    let white = bench.says(&["white"]);
    bench.hear(&white);
    assert_eq!(bench.node.state().act.kind, ActKind::Ask);
    let before = belief(bench.node.state());
    let all = [seen("white", 0.0), seen("white2", 0.2), seen("metal", 0.4), seen("white3", 0.6)];
    bench.looks(3, &all);
    let after = belief(bench.node.state());
    assert_eq!(after.len(), 4);
    assert!((after[0] / after[2] - before[0] / before[2]).abs() < 1e-9, "{before:?} {after:?}");
    assert!(after[3] > after[2], "the new one counts with what was said: {after:?}");
    assert!(bench.text().contains("is new"), "{}", bench.text());
    bench.looks(25, &all[1..]);
    assert_eq!(bench.objects(), ["white2-7", "metal-8", "white3-9"]);
    assert!(bench.text().contains("is gone"), "{}", bench.text());
    assert_eq!(bench.node.state().open.as_ref().unwrap().id.0, 1, "the same interaction");
    bench.check();
}

#[test]
fn a_motion_is_no_reason_to_ask_again() {
    let mut bench = Bench::with(&[seen("white", 0.0), seen("white2", 0.2)]);
    let white = bench.says(&["white"]);
    bench.hear(&white);
    let act = bench.node.state().act.clone();
    let version = bench.table.version;
    bench.looks(5, &[seen("white", 0.05), seen("white2", 0.2)]);
    assert_eq!((bench.table.version, &bench.node.state().act), (version + 1, &act));
    assert!((bench.table.objects[0].known.xyz[1] - 0.05).abs() < 1e-9);
    bench.check();
}

#[test]
fn no_step_is_taken_while_the_arm_has_an_order_and_it_is_afterwards() {
    let mut bench = Bench::with(&[seen("white", 0.0), seen("metal", 0.4)]);
    let white = bench.says(&["white", "white"]);
    bench.hear(&white);
    assert_eq!(bench.node.state().act.kind, ActKind::Pick);
    let version = bench.table.version;
    bench.looks(30, &[seen("white", 0.3), seen("clear", -0.3)]);
    assert_eq!(bench.table.version, version, "the dialogue waits");
    assert!((bench.table.objects[0].place[1] - 0.3).abs() < 0.01, "the arm hears of it at once");
    assert!(bench.table.objects[1].gone);
    let add = Change::Add(seen("metal2", 0.5));
    bench.sight(77, add);
    assert!(bench.table.answers[0].refusal.contains("fetching"), "{:?}", bench.table.answers);
    bench.check();
    bench.arm(PickPhase::Done, PickOutcome::Missed);
    bench.looks(3, &[seen("white", 0.3), seen("clear", -0.3)]);
    assert_eq!(bench.objects(), ["white-6", "metal-7", "clear-8"], "a restart forgets misses");
    bench.looks(25, &[seen("white", 0.3), seen("clear", -0.3)]);
    assert_eq!(bench.objects(), ["white-6", "clear-8"]);
    bench.check();
}

#[test]
fn a_delivery_can_be_refused_and_is_then_off_the_table() {
    let mut bench = Bench::with(&[seen("white", 0.0), seen("white2", 0.2)]);
    let white = bench.says(&["white", "dishwasher", "dishwasher"]);
    bench.hear(&white);
    while bench.node.state().act.kind == ActKind::Ask {
        bench.hear(&answer(Response::Yes));
    }
    let (_, object) = bench.node.state().ordered().expect("sure enough");
    let name = bench.scene().object(object).name.clone();
    bench.arm(PickPhase::Closing, PickOutcome::Pending);
    bench.arm(PickPhase::Done, PickOutcome::Delivered);
    assert!(bench.table.objects[object.index()].known.taken);
    let other = [seen("white", 0.0), seen("white2", 0.2)].into_iter().enumerate();
    let left: Vec<_> = other.filter(|(n, _)| *n != object.index()).map(|(_, it)| it).collect();
    bench.looks(30, &left);
    assert_eq!(bench.objects().len(), 2, "it may be refused");
    bench.hear(&answer(Response::No));
    let state = bench.node.state();
    let open = state.open.as_ref().expect("taken up again");
    assert_eq!(open.id.0, 2);
    assert!(belief(state)[object.index()] < 1e-6);
    if let Some((_, next)) = state.ordered() {
        assert_ne!(bench.scene().object(next).name, name);
    }
    bench.check();
}

#[test]
fn an_empty_table_is_said() {
    let mut bench = Bench::new();
    bench.start();
    let white = bench.says(&["white"]);
    bench.hear(&white);
    let state = bench.node.state();
    assert_eq!(state.ended.as_ref().map(|ended| ended.outcome), Some(Outcome::NotHere));
    bench.check();
}

/// One is surely white. The camera is unsure of the other, which is asked about.
#[test]
fn a_doubtful_detection_is_asked_about() {
    let color = |white: f64| {
        let values = [("white", white), ("metallic", 1.0 - white)];
        vec![("color".to_owned(), values.map(|(name, p)| (name.to_owned(), p)).to_vec())]
    };
    let of = |white: f64, class, y| Detection { attributes: color(white), ..seen(class, y) };
    let pick_at_once = |white| {
        let mut bench = Bench::with(&[of(1.0, "white", 0.0), of(white, "white2", 0.3)]);
        let said = bench.says(&["white"]);
        bench.hear(&said);
        bench.check();
        bench.node.state().act.kind == ActKind::Pick
    };
    assert!(pick_at_once(0.0), "the other is metallic");
    assert!(!pick_at_once(0.5), "the other may be white");
}

/// The camera sees no colour: whichever object is fetched would be a guess.
#[test]
fn objects_whose_values_are_in_doubt_are_asked_about_by_place() {
    for doubt in [[0.34, 0.33, 0.33], [0.45, 0.3, 0.25]] {
        let of = |n: usize, y: f64| {
            let values = ["white", "metallic", "clear"].into_iter().enumerate();
            let chances = values.map(|(v, name)| (name.to_owned(), doubt[(v + n) % 3])).collect();
            Detection { attributes: vec![("color".to_owned(), chances)], ..seen("white", y) }
        };
        let mut bench = Bench::with(&[of(0, -0.3), of(1, 0.0), of(2, 0.3)]);
        let said = bench.says(&["metallic"]);
        bench.hear(&said);
        assert_eq!(bench.node.state().act.kind, ActKind::Ask, "{:?}", belief(bench.node.state()));
        let text = bench.text();
        assert!(text.contains("left") || text.contains("middle"), "{text}");
        bench.check();
    }
}

/// A detector whose labels the scene does not know puts nothing on the table.
#[test]
fn labels_that_the_scene_lacks_are_refused_with_its_names() {
    let mut bench = Bench::new();
    bench.start();
    bench.looks(10, &[seen("a red block", 0.0), seen("a blue block", 0.3)]);
    assert_eq!(bench.objects(), [""; 0]);
    assert!(bench.table.refusal.contains("`a red block`"), "{}", bench.table.refusal);
    assert!(bench.table.refusal.contains("white2"), "{}", bench.table.refusal);
    assert_eq!(bench.table.refused, 1, "the same reason is published once");
    bench.looks(1, &[seen("a blue block", 0.3)]);
    assert_eq!(bench.table.refused, 11, "another reason is published");
    bench.looks(3, &[seen("a red block", 0.0), seen("a big metal bowl", 0.3)]);
    assert_eq!(bench.objects(), ["metal2-6"]);
}

#[test]
fn a_change_by_hand_that_is_sent_again_takes_effect_once() {
    let mut bench = Bench::with(&[seen("white", 0.0)]);
    for _ in 0..3 {
        bench.sight(9_001, Change::Add(seen("metal", 0.3)));
        bench.check();
    }
    assert_eq!(bench.objects(), ["white-6", "metal-7"]);
    assert_eq!(bench.table.answers.last().map(|it| (it.key, it.object)), Some((9_001, 7)));
    bench.sight(9_002, Change::Remove { object: "metal-7".to_owned() });
    assert_eq!(bench.objects(), ["white-6"]);
    bench.sight(9_003, Change::Remove { object: "metal-7".to_owned() });
    assert!(bench.table.answers.last().unwrap().refusal.contains("no object `metal-7`"));
}

/// Whole dialogues over tables that change at random: the journal folds again, bit for bit, and
/// every belief is over the objects of its table.
#[test]
fn random_tables_under_random_dialogues_fold_again() {
    const CLASSES: [&str; 6] = ["white", "white2", "white3", "metal", "metal2", "clear"];
    for seed in 0..12 {
        let mut rng = Rng::new(seed);
        let mut bench = Bench::new();
        bench.start();
        let mut there: Vec<(usize, f64)> = (0..4).map(|n| (n, 0.2 * n as f64)).collect();
        for _ in 0..40 {
            match rng.below(8) {
                0 if there.len() < 6 => there.push((rng.below(6), 0.2 * rng.below(8) as f64)),
                1 if !there.is_empty() => drop(there.remove(rng.below(there.len()))),
                2 if !there.is_empty() => {
                    let n = rng.below(there.len());
                    there[n].1 += 0.05;
                }
                3 => {
                    let said = bench.says(&[["white", "metallic", "big", "counter"][rng.below(4)]]);
                    bench.hear(&said);
                }
                4 => bench.hear(&answer([Response::Yes, Response::No][rng.below(2)])),
                5 if bench.node.state().ordered().is_some() => {
                    let ends =
                        [PickOutcome::Delivered, PickOutcome::Missed, PickOutcome::Cancelled];
                    bench.arm(PickPhase::Done, ends[rng.below(3)]);
                }
                _ => {
                    let all: Vec<_> = there.iter().map(|(c, y)| seen(CLASSES[*c], *y)).collect();
                    let times = [1, 3, 25][rng.below(3)];
                    bench.looks(times, &all);
                }
            }
            let state = bench.node.state();
            let objects = state.table.as_ref().unwrap().objects.len();
            let hypotheses = state.open.as_ref().map_or(objects, |open| open.belief().len());
            assert!(hypotheses == objects || hypotheses == objects + 1, "seed {seed}");
        }
        bench.check();
    }
}
