//! Settings in effect: the dialogue manager and the observation model of a configuration.
//!
//! `config` parses and checks values and knows no planner; this crate knows them all.

use config::Settings;
use dialogue::manager::{Manager, Setup};
use dialogue::registry::{self, UnknownPlanner};
use dialogue::{CERTAIN_SMOOTHING, Confusion, Model, NotAConfusion};
use scene::Scene;
use vocabulary::Language;

/// Error of building a dialogue manager from settings.
#[derive(Debug, thiserror::Error)]
pub enum ManagerError {
    /// The planner does not exist.
    #[error("dialogue.planner: {0}")]
    Planner(#[from] UnknownPlanner),
    /// The language's table of similar words is inconsistent.
    #[error("words by sound: {0}")]
    Confusion(#[from] NotAConfusion),
}

/// The dialogue manager of a group's settings, and its observation model.
pub trait DialogueSettings {
    /// Returns the dialogue manager of these settings.
    ///
    /// # Errors
    /// An unknown planner.
    fn manager(&self) -> Result<Manager, ManagerError>;

    /// Returns the dialogue manager of these settings, with another planner.
    ///
    /// # Errors
    /// An unknown planner.
    fn manager_with(&self, planner: &str) -> Result<Manager, ManagerError>;

    /// Returns the manager that decided under the key `settings_key`: that of these settings, or
    /// the same with another planner, which may have been swapped in. For an unknown key, that of
    /// these settings.
    ///
    /// # Errors
    /// An unknown planner.
    fn manager_of_key(&self, settings_key: u64) -> Result<Manager, ManagerError>;

    /// Returns whether the key is that of these settings, perhaps with another planner.
    fn makes_key(&self, settings_key: u64) -> bool;

    /// Returns everything that the manager decides by, besides its planner.
    ///
    /// # Errors
    /// An inconsistent table of similar words.
    fn manager_setup(&self) -> Result<Setup, NotAConfusion>;

    /// Returns the observation model of a scene under these settings, without similar words.
    fn model_of(&self, scene: &Scene) -> Model;
}

impl DialogueSettings for Settings {
    fn manager(&self) -> Result<Manager, ManagerError> {
        self.manager_with(&self.dialogue.planner)
    }

    fn manager_with(&self, planner: &str) -> Result<Manager, ManagerError> {
        let made = registry::planner(planner)?;
        Ok(Manager::new(self.manager_setup()?, made, self.manager_key(planner)))
    }

    fn manager_of_key(&self, settings_key: u64) -> Result<Manager, ManagerError> {
        let mut known = registry::known().into_iter();
        let planner = known.find(|planner| self.manager_key(planner) == settings_key);
        self.manager_with(planner.unwrap_or(&self.dialogue.planner))
    }

    fn makes_key(&self, settings_key: u64) -> bool {
        registry::known().into_iter().any(|planner| self.manager_key(planner) == settings_key)
    }

    fn manager_setup(&self) -> Result<Setup, NotAConfusion> {
        let dialogue = &self.dialogue;
        let confusion = Confusion::from_rows(words::confusion(&self.scene))?;
        let gesture = dialogue.gesture;
        Ok(Setup {
            scene: self.scene.clone(),
            model: self.model_of(&self.scene).with_confusion(confusion),
            costs: dialogue.costs,
            durations: self.durations.clone(),
            actions: dialogue.actions,
            announce: dialogue.announce,
            prior: dialogue.prior,
            gestures: gesture.enabled.then_some((gesture.model, gesture.person_xyz_m)),
            turns: dialogue.turns,
            people: dialogue.people,
            perceives: self.group.perception.enabled,
        })
    }

    fn model_of(&self, scene: &Scene) -> Model {
        let model = Model::new(scene, self.dialogue.params);
        match self.dialogue.language {
            Language::Paper => model,
            Language::Careful => {
                let rate = |it: &scene::Attribute| self.dialogue.misperception_of(&it.name);
                let rates: Vec<f64> = scene.attributes().iter().map(rate).collect();
                let smoothing = self.dialogue.alpha_typed.unwrap_or(CERTAIN_SMOOTHING);
                model.with_certain_words(smoothing).with_misperceptions(&rates)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn settings(over: &[(String, String)]) -> Settings {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        Settings::load(&folder, None, over).unwrap()
    }

    #[test]
    fn managers_are_found_by_their_keys() {
        let settings = settings(&[]);
        let manager = settings.manager().unwrap();
        assert_eq!(manager.planner(), settings.dialogue.planner);
        assert!(settings.makes_key(manager.key()) && !settings.makes_key(1));
        let other = settings.manager_of_key(settings.manager_key("entropy")).unwrap();
        assert_eq!((other.planner(), other.key() == manager.key()), ("entropy", false));
        let unknown = settings.manager_of_key(1).unwrap();
        assert_eq!(unknown.key(), manager.key());
    }

    #[test]
    fn unknown_planners_are_told_with_their_key() {
        let Err(error) = settings(&[]).manager_with("oracle") else { panic!("there is no oracle") };
        let text = error.to_string();
        let start =
            "dialogue.planner: there is no planner \"oracle\"; the planners are lookahead, ";
        assert!(text.starts_with(start), "{text}");
    }

    /// A typed word is doubted as often as a value is taken for another one, and by nothing else.
    #[test]
    fn no_doubt_is_counted_twice() {
        use dialogue::{Belief, Posterior};
        use scene::{Question, Reading};

        let settings = settings(&[]);
        let (scene, model) = (&settings.scene, settings.model_of(&settings.scene));
        let rate = settings.dialogue.misperception;
        for (k, attribute) in scene.attributes().iter().enumerate() {
            let value = &attribute.values[0];
            let has = |i: &scene::ObjectId| scene.has(*i, k.into(), 0.into());
            let other = scene.ids().find(|i| !has(i));
            let Some((with, without)) = scene.ids().find(has).zip(other) else { continue };
            let prior = Belief::uniform(model.objects());
            let mut posterior = Posterior::new(prior, None).of_perceived();
            let reading = Reading { base: vec![value.word], ..Reading::default() };
            posterior.update_mixture(&model, &[(1.0, Question::None, reading)]);
            let belief = posterior.belief();
            let odds = belief.probability(without) / belief.probability(with);
            let misperceived = rate / (attribute.values.len() - 1) as f64 / (1.0 - rate);
            assert!((odds / misperceived - 1.0).abs() < 2e-3, "{}: {odds}", attribute.name);
        }
    }

    #[test]
    fn words_that_are_certain_have_their_own_smoothing_but_in_the_paper() {
        let paper = ("dialogue.language".to_owned(), "paper".to_owned());
        let [careful, paper] = [&[][..], &[paper]].map(settings);
        let plain = Model::new(&paper.scene, paper.dialogue.params);
        assert_eq!(format!("{:?}", paper.model_of(&paper.scene)), format!("{plain:?}"));
        assert_ne!(format!("{:?}", careful.model_of(&careful.scene)), format!("{plain:?}"));
    }
}
