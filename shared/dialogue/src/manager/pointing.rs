//! Likelihood of pointing gestures, given the places of one scene's objects.

use scene::Scene;
use vocabulary::gesture::{Direction, Gestures};

use crate::gesture;

/// The user's place, and the direction in which each object lies from there.
#[derive(Clone, Debug)]
pub(super) struct Pointing {
    model: Gestures,
    user_m: [f64; 3],
    objects: Vec<Option<Direction>>,
}

impl Pointing {
    /// Pointing by a user at `user_m`, metres, frame `base`.
    pub(super) fn new(model: Gestures, user_m: [f64; 3], scene: &Scene) -> Self {
        Self { model, user_m, objects: Direction::to_objects(user_m, scene) }
    }

    /// Returns the logarithm of the likelihood of a gesture at `target_m`, for each hypothesis. A
    /// gesture at the user's own place has no direction and says nothing.
    pub(super) fn log_likelihood(&self, target_m: [f64; 3], hypotheses: usize) -> Option<Vec<f64>> {
        let ray = Direction::between(self.user_m, target_m)?;
        // The hypothesis beyond the objects has no place.
        let mut directions = self.objects.clone();
        directions.resize(hypotheses, None);
        Some(gesture::log_likelihood(&self.model, Some(ray), &directions))
    }
}
