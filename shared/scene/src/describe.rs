//! Short descriptions that distinguish an object.

use crate::{AttributeId, ObjectId, Role, Scene, Value, ValueId};

impl Scene {
    /// The object in words, e.g. `small white bowl in the dishwasher`: the scene's noun with the
    /// values that rule out most of the other objects, until none is left or none helps.
    pub fn describe(&self, object: ObjectId) -> String {
        let mut rivals: Vec<ObjectId> =
            (0..self.objects().len()).map(ObjectId::from).filter(|&i| i != object).collect();
        let mut chosen: Vec<(AttributeId, ValueId)> = Vec::new();
        while let Some((k, v)) = self.most_telling(object, &rivals) {
            rivals.retain(|&i| self.has(i, k, v));
            chosen.push((k, v));
        }
        chosen.sort_unstable();
        self.compose(&chosen)
    }

    /// The value of the object that the fewest rivals share, if it rules out any.
    fn most_telling(
        &self,
        object: ObjectId,
        rivals: &[ObjectId],
    ) -> Option<(AttributeId, ValueId)> {
        let values = self.object(object).values.iter().enumerate();
        let telling = values.filter_map(|(k, value)| {
            let (k, v) = (AttributeId::from(k), (*value)?);
            let left = rivals.iter().filter(|&&i| self.has(i, k, v)).count();
            (left < rivals.len()).then_some((left, k, v))
        });
        telling.min().map(|(_, k, v)| (k, v))
    }

    /// Qualities, then the kind (or the scene's noun), then places.
    fn compose(&self, values: &[(AttributeId, ValueId)]) -> String {
        let values = values.iter().map(|(k, v)| &self.attributes()[k.index()].values[v.index()]);
        let values: Vec<&Value> = values.collect();
        let of = |role: Role| values.iter().filter(move |value| value.role() == role);
        let qualities = of(Role::Quality).rev().map(|value| value.name.as_str());
        let kind = of(Role::Kind).next().map_or(self.noun(), |value| value.name.as_str());
        let places = of(Role::Place).map(|value| value.spoken.as_str());
        qualities.chain([kind]).chain(places).collect::<Vec<_>>().join(" ")
    }
}
