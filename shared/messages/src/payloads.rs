//! Payloads of variable size: postcard in a byte slice.

use crate::schema::payloads;
use crate::{Hypothesis, PresentationState, Presented, RequestKey};
use perception::{Change, Sighting};
use scene::{ObjectId, Perceived, Question};
use serde::{Deserialize, Serialize};
use vocabulary::{ActKind, Action, Attributed, Ended, Outcome};

payloads! {
    Injection [Sound]
    PolicyView [Question, ActKind, Action, Outcome]
    WorldView []
    TrajectoryView [MotionPhase]
    Sighting [Change]
    TableView []
}

/// Something that a client gives to the speech service to hear. Clients to speech; sent again with
/// the same key until its receipt arrives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Injection {
    /// Made by the client, kept through its retries.
    pub key: RequestKey,
    /// When the person began to speak or type, monotonic clock; 0: when it arrives.
    pub onset_ns: u64,
    /// When the person had ended, monotonic clock; 0: when it arrives. Of a recording it is found
    /// out.
    pub end_ns: u64,
    /// The latest prompt that the user was shown before, as text or sound; 0: not known. If it is a question, an
    /// answer is to this one, whether or not the robot's own voice has begun it; otherwise to no later one.
    pub seen_prompt: u64,
    /// Name of the person who types or points, printable and of at most 64 bytes; empty or `guest`:
    /// nobody in particular, of whom nothing is learned. Of sound nobody is known.
    pub from: String,
    /// Text to be heard.
    pub sound: Sound,
}

impl Injection {
    /// Something to hear now, of a person, a time and a shown prompt that are not known.
    pub fn new(key: RequestKey, sound: Sound) -> Self {
        Self { key, onset_ns: 0, end_ns: 0, seen_prompt: 0, from: String::new(), sound }
    }
}

/// A client's input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Sound {
    /// Written words.
    Text(String),
    /// A WAV file, absolute path.
    Wav(String),
    /// A pointing gesture, with written words or without.
    Point {
        /// The point that is pointed at, metres, frame `base`.
        target_m: [f64; 3],
        /// Accompanying text; may be empty.
        words: String,
    },
    /// Speech into the microphone of the robot's computer from now on: one utterance.
    Talk {
        /// Longest wait for its end, seconds.
        longest_s: f64,
    },
    /// Speech that another recogniser has recognised already, a browser's say.
    Transcript {
        /// Hypotheses: text, weight above 0 (their sum need not be 1), and the confidence of each
        /// blank-separated word, 0 to 1; words beyond the end are certain.
        hypotheses: Vec<Hypothesis>,
    },
}

/// The policy's belief and decision, for people and their tools. Policy to clients.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PolicyView {
    /// The scene's key, to match object names.
    pub scene_key: u64,
    /// Highest utterance applied.
    pub applied: u64,
    /// The open interaction, 0 for none.
    pub interaction: u64,
    /// Name of the person whose interaction it is; empty: nobody in particular.
    pub from: String,
    /// Probability of each object, in the scene's order or in that of [`objects`](Self::objects).
    pub belief: Vec<f64>,
    /// Numbers of the objects of the belief, where they come from perception; empty where they are
    /// those of the scene. Every object of this message is given by its number.
    pub objects: Vec<ObjectId>,
    /// Probability that the wanted object is not here; 0 where that is not believed possible.
    pub absent: f64,
    /// Estimated parameters of the user, if the robot learns them: `p_l`, the probability that a
    /// question is answered, and `ε`, that an answer is wrong.
    pub person: Option<(f64, f64)>,
    /// The question that stands.
    pub question: Question,
    /// Its prompt, 0 for none.
    pub prompt: u64,
    /// The robot's last sentence or question.
    pub text: String,
    /// Kind of the standing decision.
    pub decision: ActKind,
    /// Expected discounted return of the decision.
    pub value: f64,
    /// The best other actions with their values, best first.
    pub alternatives: Vec<(Action, f64)>,
    /// Expected number of questions still to ask.
    pub expected_questions: f64,
    /// Certified lower and upper bound on what the best policy is worth, where the planner has them.
    pub bounds: Option<(f64, f64)>,
    /// The questions that the latest utterance was attributed to.
    pub attributed: Attributed,
    /// Questions asked in the open interaction.
    pub questions: u32,
    /// First and last utterance of the latest interaction.
    pub utterances: (u64, u64),
    /// The latest interaction that ended.
    pub last: Option<Ended>,
    /// The latest delivery, while it can be refused.
    pub refusable: Option<Delivery>,
    /// Observations refused because they made no sense.
    pub refused: u64,
    /// The planner that decides, by its name.
    pub planner: String,
    /// Key of the latest [`Forget`](crate::Forget) that was carried out.
    pub forgot: u64,
}

impl PolicyView {
    /// Returns prompt and presentation of the question in force, once presented completely.
    pub fn open_question(&self, presented: &Presented) -> Option<(u64, u32)> {
        let Presented { prompt, presentation, state, .. } = *presented;
        // "Say yes, and I will get the white bowl."
        let is_confirmation = self.decision == ActKind::Say && self.question != Question::None;
        let is_asked = self.interaction != 0
            && (self.decision == ActKind::Ask || is_confirmation)
            && prompt == self.prompt
            && state == PresentationState::Ended;
        is_asked.then_some((prompt, presentation))
    }
}

/// A hand-over that can be refused for a while.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Delivery {
    /// The interaction that ended with it.
    pub interaction: u64,
    /// The object, by its number.
    pub object: u16,
    /// End of the time for a refusal, monotonic clock.
    pub until_ns: u64,
}

/// Object poses in the simulated world. Arm to clients.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WorldView {
    /// When it was so.
    pub at_ns: u64,
    /// Pose of each object in the scene's order, frame `base`: x, y, z in metres and quaternion
    /// x, y, z, w. None: handed over.
    pub objects: Vec<Option<[f64; 7]>>,
    /// Numbers of these objects, where they come from perception; else empty.
    pub numbers: Vec<ObjectId>,
    /// The object in the gripper, by its number.
    pub held: Option<u16>,
    /// Pose of the left and right gripper, as the objects'.
    pub grippers: [[f64; 7]; 2],
}

/// The objects on the table, where they come from perception. Policy to arm and clients.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TableView {
    /// Number of changes of the table so far: each is a step of the dialogue.
    pub version: u64,
    /// The objects.
    pub objects: Vec<TableObject>,
    /// The latest changes by hand, by key: the object, or why it was refused.
    pub answers: Vec<ChangeAnswer>,
    /// Reports of sources that were refused.
    pub refused: u64,
    /// Why the latest of them was.
    pub refusal: String,
}

/// An object on the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TableObject {
    /// The object as the dialogue knows it.
    pub known: Perceived,
    /// The best estimate of its place at this moment: centre in frame `base`, metres, and yaw, radians.
    pub place: [f64; 4],
    /// Standard deviation of each.
    pub sd: [f64; 4],
    /// When it was last seen, monotonic clock, nanoseconds.
    pub seen_ns: u64,
    /// Whether it was looked for in vain for so long that it counts as gone; the dialogue hears of
    /// it when the arm is done.
    pub gone: bool,
}

/// What became of a change by hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChangeAnswer {
    /// Its key.
    pub key: u64,
    /// The object's number.
    pub object: u16,
    /// Why it was refused; empty if it was not.
    pub refusal: String,
}

/// Largest number of points in a published trajectory.
pub const TRAJECTORY_POINTS_MAX: usize = 256;

/// The way that a gripper is planned to take in the motion under way. Arm to clients; no phases
/// while nothing moves by plan.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrajectoryView {
    /// [`crate::InteractionId`] of the pick that the motion is for, 0 for none.
    pub interaction: u64,
    /// Attempt of that pick.
    pub attempt: u32,
    /// The object that is fetched or pointed at.
    pub object: Option<u16>,
    /// The limb that moves: 0 left, 1 right.
    pub limb: u8,
    /// Start of the motion, monotonic clock. Published with each phase change, including any delay
    /// of the motion so far.
    pub began_ns: u64,
    /// The phases in order, over or not; at most [`TRAJECTORY_POINTS_MAX`] points in all.
    pub phases: Vec<PhaseWay>,
}

/// The gripper's way in one phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseWay {
    /// Purpose of the phase.
    pub phase: MotionPhase,
    /// Position of the point between the finger tips, metres, frame `base`.
    pub points_m: Vec<[f64; 3]>,
    /// When it is there, seconds since the motion began; as many as there are points.
    pub t_s: Vec<f64>,
}

/// Purpose of a part of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionPhase {
    /// Away from what the arm touches, straight up; or a pause while the fingers open.
    Clear,
    /// To above the object and straight down to it.
    Approach,
    /// The fingers close.
    Close,
    /// Straight up with the object.
    Lift,
    /// To where the person takes the object.
    HandOver,
    /// The fingers open.
    Release,
    /// To where the gripper's axis passes through an object.
    Aim,
    /// Back to rest.
    Return,
    /// To where the user gives an object back, and still there.
    Take,
    /// To above the place of an object that is put back.
    CarryBack,
    /// Straight down to that place.
    Lower,
}

impl std::fmt::Display for MotionPhase {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Clear => "clear",
            Self::Approach => "approach",
            Self::Close => "close",
            Self::Lift => "lift",
            Self::HandOver => "hand over",
            Self::Release => "release",
            Self::Aim => "aim",
            Self::Return => "return",
            Self::Take => "take",
            Self::CarryBack => "carry back",
            Self::Lower => "lower",
        })
    }
}
