//! Pointing gestures against the places of one scene's objects.

use dialogue::gesture::{Direction, Gestures};
use scene::Scene;

/// Who points from where, and in which direction each object lies from there.
#[derive(Clone, Debug)]
pub(super) struct Pointing {
    model: Gestures,
    person_m: [f64; 3],
    objects: Vec<Option<Direction>>,
}

impl Pointing {
    /// Somebody at `person_m`, metres, frame `base`.
    pub(super) fn new(model: Gestures, person_m: [f64; 3], scene: &Scene) -> Self {
        Self { model, person_m, objects: Direction::to_objects(person_m, scene) }
    }

    /// Logarithm of the likelihood of a gesture at `target_m`, for as many hypotheses. One at the
    /// person's own place has no direction and says nothing.
    pub(super) fn log_likelihood(&self, target_m: [f64; 3], hypotheses: usize) -> Option<Vec<f64>> {
        let ray = Direction::between(self.person_m, target_m)?;
        // Whatever is believed beyond the objects stands nowhere.
        let mut directions = self.objects.clone();
        directions.resize(hypotheses, None);
        Some(self.model.log_likelihood(Some(ray), &directions))
    }
}
