//! Commands of the page, and their answers: JSON objects.
//!
//! | command | effect |
//! |---|---|
//! | `{"do":"scenes"}` | the names of the scenes |
//! | `{"do":"open","scene":"bowls","unix_ms":0}` | a new dialogue, at time 0 |
//! | `{"do":"look","at_ms":20}` | lets time pass |
//! | `{"do":"say","text":"yes","seen":3,"at_ms":20}` | words; `seen`: the prompt that was shown then, 0 for none |
//! | `{"do":"stop","at_ms":20}`, `resume` | the motion stop |
//!
//! An answer has `scenes` or `sections`, those that have changed since the last answer. A command that is not carried
//! out is answered with `error`, besides the sections.

use serde::Deserialize;
use serde_json::{Map, Value, json};
use vocabulary::RESUME_AFTER;
use vocabulary::time::Span;

use crate::Session;
use crate::scenes;
use crate::sections::ms;

/// Latest time, milliseconds: a century.
const AT_MS_MAX: f64 = 3.2e12;

#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
enum Command {
    Scenes {},
    Open {
        scene: String,
        #[serde(default)]
        unix_ms: u64,
    },
    Look {
        at_ms: f64,
    },
    Say {
        text: String,
        #[serde(default)]
        seen: u64,
        at_ms: f64,
    },
    Stop {
        at_ms: f64,
    },
    Resume {
        at_ms: f64,
    },
}

/// The dialogue of a page.
#[derive(Default)]
#[allow(missing_debug_implementations, reason = "sessions have none")]
pub struct Desk {
    open: Option<Open>,
}

struct Open {
    session: Session,
    at_ms: f64,
    /// The sections of the last answer.
    known: Map<String, Value>,
}

impl Desk {
    /// Carries out a command and returns its answer.
    pub fn command(&mut self, command: &str) -> String {
        let answer = serde_json::from_str(command)
            .map_err(|error| format!("command: {error}"))
            .and_then(|command| self.carry_out(command));
        answer.unwrap_or_else(|error| json!({ "error": error })).to_string()
    }

    fn carry_out(&mut self, command: Command) -> Result<Value, String> {
        match command {
            Command::Scenes {} => Ok(json!({ "scenes": scenes::names().collect::<Vec<_>>() })),
            Command::Open { scene, unix_ms } => {
                let scene = scenes::scene(&scene)?;
                let session = Session::new(scene, unix_ms).map_err(|error| error.to_string())?;
                let open = self.open.insert(Open { session, at_ms: 0.0, known: Map::new() });
                Ok(open.first_answer())
            }
            Command::Look { at_ms } => self.at(at_ms, |_| Ok(())),
            Command::Say { text, seen, at_ms } => self.at(at_ms, |session| {
                session.say(&text, seen);
                Ok(())
            }),
            Command::Stop { at_ms } => self.at(at_ms, |session| {
                session.stop();
                Ok(())
            }),
            Command::Resume { at_ms } => self.at(at_ms, resume),
        }
    }

    /// Lets time pass, and then acts on the dialogue.
    fn at(
        &mut self,
        at_ms: f64,
        act: impl FnOnce(&mut Session) -> Result<(), String>,
    ) -> Result<Value, String> {
        let open = self.open.as_mut().ok_or("no dialogue; help: open a scene first")?;
        open.pass(at_ms)?;
        let refused = act(&mut open.session).err();
        Ok(open.answer(refused))
    }
}

fn resume(session: &mut Session) -> Result<(), String> {
    let seconds = RESUME_AFTER.s();
    let too_soon = format!("a stop was given less than {seconds} s before; help: resume again");
    session.resume().then_some(()).ok_or(too_soon)
}

impl Open {
    /// Lets time pass until `at_ms`. Time that goes back stands still.
    fn pass(&mut self, at_ms: f64) -> Result<(), String> {
        if !(0.0..=AT_MS_MAX).contains(&at_ms) {
            return Err(format!("at_ms: expected 0 to {AT_MS_MAX:e}, found {at_ms}"));
        }
        let span = Span::from_s((at_ms - self.at_ms) / 1e3);
        self.at_ms = self.at_ms.max(at_ms);
        self.session.advance(span);
        Ok(())
    }

    /// The answer to the command that opened it.
    fn first_answer(&mut self) -> Value {
        let mut answer = self.answer(None);
        if let Value::Object(scene) = written(self.session.scene_sections())
            && let Some(Value::Object(sections)) = answer.get_mut("sections")
        {
            sections.extend(scene);
        }
        answer
    }

    fn answer(&mut self, error: Option<String>) -> Value {
        let Value::Object(sections) = written(self.session.sections()) else { return Value::Null };
        let is_new = |(name, value): &(&String, &Value)| self.known.get(*name) != Some(*value);
        let changed = sections.iter().filter(is_new).map(|(name, it)| (name.clone(), it.clone()));
        let changed: Map<String, Value> = changed.collect();
        self.known = sections;
        let now_ms = ms(self.session.now);
        let mut answer = json!({ "sections": changed, "now_ms": now_ms });
        if let Some(error) = error {
            answer["error"] = error.into();
        }
        answer
    }
}

/// Sections have no part that cannot be written.
fn written(sections: impl serde::Serialize) -> Value {
    serde_json::to_value(sections).unwrap_or_default()
}
