//! Labelled lines: utterances to the robot with the polarity of each value word.
//!
//! One line is `scene | question | act | utterance`; in the utterance every word that names a value
//! of the scene is in brackets with a sign: `[red+]` wanted, `[red-]` denied, `[red0]` neither.
//!
//! | folder | |
//! |---|---|
//! | `lines/` | by authors who had seen neither the code nor each other's lines; the judge is trained on them |
//! | `answers/` | answers to questions of yes or no, by other such authors; the judge of answers is trained on them |
//! | `held_out_answers/` | by four more of them: never trained on (`scores.txt`) |
//! | `held_out/` | by two more authors: scored three times at most, and read by nobody (`scores.txt`) |
//! | `scenes/` | scenes that were made for the lines |
//! | `templates.txt` | ordinary requests, made into lines in several scenes |
//! | `hard_templates.txt` | reasons, exceptions, corrections, landmarks and talk, made into lines likewise |

mod answers;
mod cross;
mod inputs;
mod line;
mod linear;
mod model;
mod recurrent;
mod scenes;
mod score;
mod slips;
mod sources;
mod table;
mod templates;

pub use answers::{
    Answer, AnswerScore, Answers, answers, answers_of, answers_without, train_answers,
};
pub use cross::{Unseen, without_author, without_fifths};
pub use inputs::{answers_trained_on, trained_on};
pub use line::{Line, Marked, lines};
pub use linear::{Lesson, Linear};
pub use model::{Model, Sums, fitted};
pub use scenes::{Scenes, files, question};
pub use score::{Score, Scored, as_read, labels};
pub use slips::with_typo;
pub use sources::{Sources, Taught};
pub use table::{Row, table};
pub use templates::templates;

/// Prints why a program of this crate failed, and returns its exit code.
#[allow(clippy::print_stderr, reason = "for programs of the terminal")]
pub fn exit_code(outcome: Result<(), String>) -> std::process::ExitCode {
    match outcome {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            std::process::ExitCode::FAILURE
        }
    }
}
