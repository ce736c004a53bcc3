//! A simulated user who never errs.

use std::collections::HashSet;

use dialogue::{Answer, Model, Params};
use scene::{ObjectId, Scene};

use crate::verbs::conversation::Seen;

/// Somebody who wants one object and answers every question once it was asked to its end.
pub(super) struct TruthfulUser {
    scene: Scene,
    model: Model,
    wanted: ObjectId,
    answered: HashSet<(u64, u32)>,
}

impl TruthfulUser {
    /// Somebody who wants the object of that name.
    ///
    /// # Errors
    /// The scene has none.
    pub(super) fn new(scene: &Scene, name: &str) -> Result<Self, String> {
        let wanted = scene.object_named(name).ok_or_else(|| {
            let names: Vec<&str> = scene.objects().iter().map(|o| o.name.as_str()).collect();
            format!("the scene has no object {name}; there are {}", names.join(", "))
        })?;
        // The truth does not depend on the parameters.
        let model = Model::new(scene, Params::default());
        Ok(Self { scene: scene.clone(), model, wanted, answered: HashSet::new() })
    }

    /// What this person says now, if anything: each presentation of a question gets one answer.
    ///
    /// Nothing is said while earlier words are not yet applied, because the question may be
    /// answered already, and an answer that comes after the end would be a new request.
    pub(super) fn answer(&mut self, seen: &Seen) -> Option<String> {
        let question = seen.open_question().filter(|_| seen.is_settled())?;
        let view = seen.view.as_ref()?;
        if !self.scene.contains(view.question) || !self.answered.insert(question) {
            return None;
        }
        let answer = Answer::truthful(&self.model, view.question, self.wanted);
        let text = answer.text(&self.scene);
        (!text.is_empty()).then(|| text.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use scene::Question;
    use serde_json::json;

    use super::super::super::conversation::example::{asked, ended, unapplied};
    use super::*;

    fn scene() -> Scene {
        let object =
            |name: &str, color: &str| json!({"name": name, "attributes": {"color": color}});
        let json = json!({"objects": [object("R", "red"), object("B", "blue"),
                                      {"name": "none", "attributes": {}}]});
        Scene::from_json("scene", &json).unwrap()
    }

    fn answer(wanted: &str, question: Question) -> Option<String> {
        TruthfulUser::new(&scene(), wanted).unwrap().answer(&asked(question))
    }

    #[test]
    fn answers_are_true() {
        let scene = scene();
        let color = scene.attribute_named("color").unwrap();
        let blue = scene.value_named(color, "blue").unwrap();
        let red = scene.object_named("R").unwrap();
        assert_eq!(answer("B", Question::Attribute(color, blue)).as_deref(), Some("yes"));
        assert_eq!(answer("R", Question::Attribute(color, blue)).as_deref(), Some("no"));
        assert_eq!(answer("R", Question::Point(red)).as_deref(), Some("yes"));
        assert_eq!(answer("B", Question::Which(color)).as_deref(), Some("blue"));
        assert_eq!(answer("none", Question::Which(color)), None, "there is nothing to say");
    }

    #[test]
    fn each_presentation_is_answered_once_and_only_while_it_stands() {
        let mut user = TruthfulUser::new(&scene(), "R").unwrap();
        let mut seen = asked(Question::Point(ObjectId(0)));
        assert_eq!(user.answer(&unapplied(seen.clone())), None);
        assert!(user.answer(&seen).is_some());
        assert_eq!(user.answer(&seen), None);
        seen.presented.presentation = 2;
        assert!(user.answer(&seen).is_some());
        assert_eq!(user.answer(&ended(7)), None);
    }

    #[test]
    fn nobody_wants_what_is_not_there() {
        let told = TruthfulUser::new(&scene(), "G").err().unwrap();
        assert_eq!(told, "the scene has no object G; there are R, B, none");
    }
}
