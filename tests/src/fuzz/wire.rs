//! Bytes of fixed messages as another process may write them, through every typed conversion.

use std::fmt::Debug;

use messages::robot::*;
use messages::schema::Schema;
use messages::*;
use scene::Question;
use vocabulary::Presentation;

use super::bytes::{Input, chosen};

/// Words of the scene that readings refer to.
const WORDS: usize = 40;
/// Questions that readings may answer.
const ASKED: usize = 3;

/// A message whose bytes are its value.
pub(super) trait Plain: WireField + Schema + Copy + Debug + Default {}
impl<T: WireField + Schema + Copy + Debug + Default> Plain for T {}

/// The message that lies in shared memory as these bytes; zeros where they end.
pub(super) fn message<T: Plain>(bytes: &[u8]) -> T {
    let mut whole = vec![0; size_of::<T>()];
    let len = bytes.len().min(whole.len());
    whole[..len].copy_from_slice(&bytes[..len]);
    // SAFETY: `WireField` is implemented for types alone of which every byte pattern is a value:
    // numbers, codes, texts and structs of these. This is how a reader gets what another wrote.
    #[allow(unsafe_code)]
    unsafe {
        whole.as_ptr().cast::<T>().read_unaligned()
    }
}

/// The bytes of a message in shared memory.
pub(super) fn bytes_of<T: Plain>(message: &T) -> Vec<u8> {
    // SAFETY: wire structs have no padding, which a test of `messages` checks.
    #[allow(unsafe_code)]
    let bytes = unsafe {
        std::slice::from_raw_parts(std::ptr::from_ref(message).cast::<u8>(), size_of::<T>())
    };
    bytes.to_vec()
}

macro_rules! kinds {
    ($($kind:ident $convert:expr,)+) => {
        const KINDS: &[fn(&[u8])] = &[$(|bytes| check::<$kind>(bytes, $convert),)+];

        /// Every message as it is before anything is set.
        fn defaults() -> Vec<Vec<u8>> {
            vec![$(bytes_of(&$kind::default()),)+]
        }

        fn kind_of(name: &str) -> u8 {
            let names = [$(stringify!($kind),)+];
            names.iter().position(|known| *known == name).expect("a known message") as u8
        }
    };
}

kinds! {
    Stamp |_| {},
    WireQuestion question,
    WireGesture gesture,
    AskedQuestion asked,
    WireHypothesis |_| {},
    WireReading reading,
    Utterance utterance,
    Observation observation,
    AppliedMark |_| {},
    RobotAct act,
    Presented |_| {},
    Activity |_| {},
    Hearing |hearing| texts([hearing.note.as_str()]),
    Partial |partial| texts([partial.text.as_str()]),
    AudioChunk |chunk| assert!(chunk.sound().len() <= CHUNK_SAMPLES_MAX),
    Receipt |receipt| { texts([receipt.note.as_str()]); let _ = receipt.utterance(); },
    ArmStatus |status| { let _ = (status.pick(), status.aimed_at()); },
    JointStates |_| {},
    JointCommand joint_command,
    JointState joint_state,
    JointTrajectoryPoint |_| {},
    SpeedRatio |_| {},
    EndpointState |_| {},
    EndEffectorCommand gripper_command,
    EndEffectorState |state| { let _ = state.has_handled(&EndEffectorCommand::default()); },
    EndEffectorProperties |_| {},
    AssemblyState |_| {},
    Drill |_| {},
}

pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    let kind = usize::from(input.byte()) % KINDS.len();
    KINDS[kind](input.0);
}

fn check<T: Plain>(bytes: &[u8], convert: fn(&T)) {
    let message = message::<T>(bytes);
    // Log lines print messages that were refused.
    let _ = format!("{message:?}");
    if message.check().is_ok() {
        convert(&message);
    }
}

fn texts<const N: usize>(texts: [Result<&str, WireError>; N]) {
    texts.into_iter().flatten().for_each(|text| drop(text.to_owned()));
}

fn question(wire: &WireQuestion) {
    if let Ok(question) = Question::try_from(*wire) {
        assert_eq!(Question::try_from(WireQuestion::from(question)), Ok(question));
    }
}

fn gesture(wire: &WireGesture) {
    if let Ok(target_m) = wire.target_m() {
        assert!(target_m.is_none_or(|target_m| is_somewhere(&target_m)));
        assert_eq!(WireGesture::from(target_m).target_m(), Ok(target_m));
    }
}

fn asked(wire: &AskedQuestion) {
    if let Ok(presentation) = Presentation::try_from(wire) {
        let again = AskedQuestion::from(&presentation);
        assert_eq!(Presentation::try_from(&again), Ok(presentation));
    }
}

fn reading(wire: &WireReading) {
    let Ok(interpretation) = wire.interpretation(WORDS, ASKED) else { return };
    sound(&interpretation, ASKED);
    let (again, fits) = WireReading::new(&interpretation);
    assert_eq!(fits, Fits::Whole);
    assert_eq!(again.interpretation(WORDS, ASKED), Ok(interpretation));
}

/// Checks that nothing of an accepted interpretation lies outside the scene.
fn sound(Interpretation { weight, answers, reading }: &Interpretation, asked: usize) {
    let share = |share: f64| (0.0..=1.0 + 1e-6).contains(&share);
    assert!(share(*weight), "weight {weight}");
    assert!(answers.is_none_or(|place| place < asked));
    let words = reading.base.iter().chain(reading.excluded.iter().flatten());
    words.for_each(|word| assert!(word.index() < WORDS));
    let doubt = &reading.doubt;
    let doubts = doubt.base.iter().chain(&doubt.excluded).chain([&doubt.response]);
    doubts.for_each(|doubt| assert!(share(*doubt), "doubt {doubt}"));
}

fn utterance(wire: &Utterance) {
    gesture(&wire.gesture);
    wire.asked().into_iter().flatten().for_each(asked);
    let Ok(heard) = wire.hypotheses() else { return };
    assert!(heard.len() <= HYPOTHESES_MAX);
    heard.iter().for_each(|one| assert!((0.0..=1.0 + 1e-6).contains(&one.weight)));
    let mut again = Utterance::default();
    let total: f64 = heard.iter().map(|one| one.weight).sum();
    if again.set_hypotheses(&heard).is_ok() && total > 0.0 {
        let again = again.hypotheses().expect("what was set is valid");
        let texts = |heard: &[Hypothesis]| -> Vec<String> {
            heard.iter().map(|one| one.text.clone()).collect()
        };
        assert_eq!(texts(&again), texts(&heard));
    }
}

fn observation(wire: &Observation) {
    gesture(&wire.gesture);
    texts([wire.unknown.as_str()]);
    let asked = wire.asked().map_or(0, <[_]>::len);
    if let Ok(interpretations) = wire.interpretations(WORDS) {
        assert!((1..=READINGS_MAX).contains(&interpretations.len()));
        interpretations.iter().for_each(|one| sound(one, asked));
    }
}

fn act(wire: &RobotAct) {
    question(&wire.question);
    texts([wire.text.as_str()]);
    let _ = wire.pick();
}

fn joint_command(wire: &JointCommand) {
    let _ = JointMode::from_code(wire.mode);
    if let Ok(joints) = wire.joints() {
        let again = JointCommand::new(JointMode::Position, &joints).expect("they fitted");
        assert_eq!(again.joints().map(|again| again.len()), Ok(joints.len()));
    }
}

fn joint_state(wire: &JointState) {
    if let Ok(joints) = wire.joints() {
        assert!(joints.iter().all(|(_, measured)| measured.iter().all(|x| x.is_finite())));
        let again = JointState::new(wire.stamp_ns, &joints).expect("they fitted");
        assert_eq!(again.joints(), Ok(joints));
    }
}

fn gripper_command(wire: &EndEffectorCommand) {
    let Ok(command) = wire.read() else { return };
    if let Command::Go(percent) = command {
        assert!((0.0..=100.0).contains(&percent));
    }
    let again = EndEffectorCommand::new(wire.id, command, "fuzz", wire.sequence).read();
    let near = match (&again, &command) {
        (Ok(Command::Go(a)), Command::Go(b)) => (a - b).abs() < 1e-3,
        (again, _) => again.as_ref() == Ok(&command),
    };
    assert!(near, "{command:?} became {again:?}");
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let mut seeds: Vec<_> =
        (0..).zip(defaults()).map(|(kind, bytes)| chosen(kind, bytes)).collect();
    let mut seed = |name: &str, bytes: Vec<u8>| seeds.push(chosen(kind_of(name), bytes));
    let mut heard = Utterance { seq: 3, ..Utterance::default() };
    let hypotheses = [Hypothesis::certain("the small bowl"), Hypothesis::certain("größe")];
    heard.set_hypotheses(&hypotheses).expect("short texts fit");
    heard.set_asked(&[AskedQuestion { prompt: 2, whole: 1, ..AskedQuestion::default() }]);
    heard.gesture = Some([0.5, -0.25, 1.0]).into();
    seed("Utterance", bytes_of(&heard));
    let reading = scene::Reading {
        base: vec![scene::WordId(2), scene::WordId(7)],
        excluded: vec![vec![scene::WordId(1)]],
        ..scene::Reading::default()
    };
    let meant = Interpretation { weight: 1.0, answers: Some(0), reading };
    let (reading, _) = WireReading::new(&meant);
    seed("WireReading", bytes_of(&reading));
    let mut seen =
        Observation { seq: 3, asked: heard.asked, asked_count: 1, ..Observation::default() };
    (seen.reading_count, seen.readings[0]) = (1, reading);
    seed("Observation", bytes_of(&seen));
    let joints = [("left_s0", 0.5), ("left_w2", -1.0)];
    let command = JointCommand::new(JointMode::Position, &joints).expect("short names");
    seed("JointCommand", bytes_of(&command));
    let state = JointState::new(5, &[("head_pan", [0.1, 0.2, 0.3])]).expect("short names");
    seed("JointState", bytes_of(&state));
    for command in [Command::Grip, Command::Go(12.5), Command::Calibrate] {
        seed("EndEffectorCommand", bytes_of(&EndEffectorCommand::new(1, command, "fuzz", 2)));
    }
    seeds
}
