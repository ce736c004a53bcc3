//! English of a reading, for operators.

use crate::{Intent, Reading, Reference, Response, Scene, WordId};

impl Reading {
    /// Returns the meaning of an utterance in the scene's words, for operators, e.g. `yes · white`.
    pub fn text(&self, scene: &Scene) -> String {
        let word = |id: &WordId| scene.words().get(id.index()).map_or("?", String::as_str);
        let intent = match self.intent {
            Intent::Inform => None,
            Intent::None => return "nothing for me".to_owned(),
            Intent::Stop => Some("stop"),
            Intent::StopAndCancel => Some("stop, never mind"),
            Intent::GoOn => Some("go on"),
            Intent::Cancel => Some("never mind"),
            Intent::Repeat => Some("say that again"),
            Intent::StartOver => Some("start over"),
            Intent::AskBack
            | Intent::AskCount
            | Intent::AskWhich
            | Intent::AskWhether
            | Intent::AskWhere
            | Intent::AskWhy
            | Intent::AskStatus
            | Intent::AskHelp => Some("a question to me"),
            Intent::Greet => Some("a greeting"),
            Intent::Leave => Some("a farewell"),
            Intent::Thank => Some("thanks"),
            Intent::PutBack => Some("put it back"),
            Intent::Chore => Some("something else than to fetch"),
        };
        let response = match self.response {
            Response::Yes => Some("yes"),
            Response::No => Some("no"),
            Response::CannotTell => Some("cannot tell"),
            Response::DoesNotMatter => Some("does not matter"),
            Response::None => None,
        };
        let relation = match self.refers {
            Reference::Relation(relation) => Some(relation.text()),
            _ => None,
        };
        let refers = match self.refers {
            Reference::None | Reference::Relation(_) => None,
            Reference::Other => Some("the other one"),
            Reference::Same => Some("the same one"),
            Reference::Smaller => Some("the smaller one"),
            Reference::Larger => Some("the bigger one"),
            Reference::Smallest => Some("the smallest one"),
            Reference::Largest => Some("the biggest one"),
            Reference::Any => Some("any one"),
        };
        let given = [intent, response, refers].into_iter().flatten().map(str::to_owned);
        let mut parts: Vec<String> = given.chain(relation).collect();
        parts.extend(self.base.iter().map(|id| word(id).to_owned()));
        parts.extend(self.excluded.iter().map(|group| {
            let group: Vec<&str> = group.iter().map(word).collect();
            format!("not {}", group.join(" and "))
        }));
        let joint = match (self.intent, self.refers) {
            (Intent::AskWhich, _) => "or",
            (_, Reference::Relation(_)) => "of",
            _ => "then",
        };
        parts.extend(self.further.iter().map(|group| {
            let group: Vec<&str> = group.iter().map(word).collect();
            format!("{joint} {}", group.join(" "))
        }));
        if parts.is_empty() { "a request".to_owned() } else { parts.join(" · ") }
    }
}
