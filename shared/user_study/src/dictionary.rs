//! Data dictionary: the meaning of every column.

use crate::{Item, Kind};

/// A column of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the column.
    pub name: &'static str,
    /// Type of its values: `text`, `number`, `0/1` or `UTC`.
    pub kind: &'static str,
    /// Meaning.
    pub meaning: &'static str,
}

const fn column(name: &'static str, kind: &'static str, meaning: &'static str) -> Column {
    Column { name, kind, meaning }
}

/// The columns of `interactions.csv`: a row per interaction, also spoilt and unfinished ones.
pub const INTERACTIONS: [Column; 27] = [
    column("participant", "text", "the participant's code"),
    column("status", "text", "of the participant: complete, left, running or withdrawn"),
    column("trial", "number", "1, 2, … within the participant, everything counted"),
    column("number", "number", "1, 2, … within the participant, only what counts; else empty"),
    column(
        "block",
        "number",
        "which of the participant's policies it is, in the order met, from 1",
    ),
    column("practice", "0/1", "whether it is practice"),
    column("counts", "0/1", "whether it is in the results: ended, no practice, not withdrawn"),
    column("policy", "text", "the planner that decided"),
    column("scene", "text", "the scene's name"),
    column("scene_key", "text", "the scene's content as a number of 16 hexadecimal digits"),
    column("desired", "text", "the object that was shown to the participant"),
    column("picked", "text", "the object that was handed over or tried; empty for none"),
    column(
        "outcome",
        "text",
        "right, wrong, failed (the arm could not), cancelled (by the participant), abandoned (silence \
         or nothing left to ask), not_here (the robot concluded so), too_long, fault (spoilt, \
         repeated) or unfinished",
    ),
    column("success", "0/1", "whether the desired object was handed over; empty unless it counts"),
    column("seconds", "number", "from the first sound or key of the first utterance to the end"),
    column("talk_seconds", "number", "from there to the decision which object to fetch"),
    column("questions", "number", "questions the robot asked, repetitions not counted"),
    column("repeats", "number", "how often it asked one again"),
    column("utterances", "number", "what the participant said and typed"),
    column("typed", "number", "… of these by keyboard"),
    column("spoken", "number", "… of these by voice"),
    column("interaction", "number", "the robot's own number of it, as in its journals"),
    column("drawn_at", "UTC", "when the desired object was drawn"),
    column("started_at", "UTC", "when the participant began"),
    column("ended_at", "UTC", "when the end was noticed"),
    column("resumed", "number", "how often page or console came back in the middle of it"),
    column("fault", "text", "what spoilt it, in words"),
];

/// The columns of `participants.csv` before those of the questionnaire.
pub const PARTICIPANTS: [Column; 12] = [
    column("participant", "text", "the participant's code"),
    column("status", "text", "complete, left, running, withdrawn or deleted"),
    column("policies", "text", "the policies in the order met, joined by >"),
    column("interactions", "number", "interactions that count"),
    column("right", "number", "… of these with the desired object handed over"),
    column("faults", "number", "interactions that were spoilt and repeated"),
    column("consented", "0/1", "whether there was consent; empty where it was not asked for"),
    column("begun_at", "UTC", "when the participant came"),
    column("latest_at", "UTC", "when anything was recorded last"),
    column("seed", "text", "what the plan and the objects were drawn from"),
    column("group", "text", "the robot's group"),
    column("software", "text", "version of the console"),
];

/// Returns the dictionary as CSV: file, column, kind, meaning.
pub fn dictionary(items: &[Item]) -> String {
    let mut text = "file,column,kind,meaning\n".to_owned();
    let mut add = |file: &str, name: &str, kind: &str, meaning: &str| {
        text += &format!("{file},{name},{kind},{}\n", super::rows::cell(meaning));
    };
    for column in INTERACTIONS {
        add("interactions.csv", column.name, column.kind, column.meaning);
    }
    for column in PARTICIPANTS {
        add("participants.csv", column.name, column.kind, column.meaning);
    }
    for item in items {
        let (kind, range) = match item.kind {
            Kind::Likert => {
                ("number", format!(" (1 {} … {} {})", item.low, item.points, item.high))
            }
            Kind::Choice => ("text", format!(" ({})", item.options.join(" / "))),
            Kind::Number => ("number", String::new()),
            Kind::Text => ("text", String::new()),
        };
        add("participants.csv", &format!("q_{}", item.id), kind, &(item.text.clone() + &range));
    }
    text
}
