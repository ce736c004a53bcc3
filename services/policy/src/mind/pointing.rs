//! Pointing gestures against the places of one scene's objects.

use dialogue::Belief;
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

    /// Bayes' rule with a gesture at `target_m`. One at the person's own place has no direction and
    /// says nothing.
    pub(super) fn observe(&self, belief: &mut Belief, target_m: [f64; 3]) {
        let Some(ray) = Direction::between(self.person_m, target_m) else { return };
        // Whatever the belief holds beyond the objects stands nowhere.
        let mut directions = self.objects.clone();
        directions.resize(belief.len(), None);
        belief.weigh(&self.model.log_likelihood(Some(ray), &directions));
    }
}
