//! Names of objects and values as users say them.

use scene::{AttributeId, ObjectId, Role, Scene, Value, ValueId};
use vocabulary::Rng;

use crate::simulation::draw::{chance, one_of};

/// A user's choice of words.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wording<'a> {
    pub(super) scene: &'a Scene,
    /// Probability that a value is named by a synonym, if it has one.
    pub(super) synonyms: f64,
}

impl<'a> Wording<'a> {
    /// The scene's own words.
    pub(super) fn plain(scene: &'a Scene) -> Self {
        Self { scene, synonyms: 0.0 }
    }

    /// A value in words.
    pub(super) fn value(&self, (k, v): (AttributeId, ValueId), rng: &mut Rng) -> String {
        let value = self.of((k, v));
        let synonym = if chance(rng, self.synonyms) { one_of(rng, &value.synonyms) } else { None };
        synonym.unwrap_or(&value.name).clone()
    }

    /// "It is …": the value as a predicate, e.g. `in the cabinet`.
    pub(super) fn predicate(&self, (k, v): (AttributeId, ValueId), rng: &mut Rng) -> String {
        let value = self.of((k, v));
        let word = self.value((k, v), rng);
        value.spoken.replace(&value.name, &word)
    }

    /// The value in its form after a noun.
    fn after_noun(&self, (k, v): (AttributeId, ValueId), rng: &mut Rng) -> String {
        let value = self.of((k, v));
        let word = self.value((k, v), rng);
        value.after_noun().replace(&value.name, &word)
    }

    /// An object with these values, e.g. `small white bowl in the cabinet`; the noun alone without
    /// any.
    pub(super) fn object(&self, values: &[(AttributeId, ValueId)], rng: &mut Rng) -> String {
        let (mut before, mut noun, mut after) = (Vec::new(), None, Vec::new());
        for &value in values {
            match self.of(value).role() {
                Role::Quality => before.push(self.value(value, rng)),
                Role::Kind => noun = Some(self.value(value, rng)),
                Role::Place | Role::Part => after.push(self.after_noun(value, rng)),
            }
        }
        before.push(noun.unwrap_or_else(|| self.scene.noun().to_owned()));
        before.extend(after);
        before.join(" ")
    }

    fn of(&self, (k, v): (AttributeId, ValueId)) -> &'a Value {
        &self.scene.attributes()[k.index()].values[v.index()]
    }
}

/// Draws values of the object, in random order; `probabilities` are those of drawing 0, 1, 2, … of
/// them.
pub(super) fn own_values(
    scene: &Scene,
    object: ObjectId,
    probabilities: &[f64],
    rng: &mut Rng,
) -> Vec<(AttributeId, ValueId)> {
    let values = scene.object(object).values.iter().enumerate();
    let mut values: Vec<_> = values.filter_map(|(k, v)| Some((k.into(), (*v)?))).collect();
    let count = number(probabilities, rng);
    let mut named = Vec::new();
    while named.len() < count && !values.is_empty() {
        named.push(values.swap_remove(rng.below(values.len())));
    }
    named
}

/// Draws an index with these probabilities; the last one if their sum is below 1.
pub(super) fn number(probabilities: &[f64], rng: &mut Rng) -> usize {
    let drawn = rng.index(probabilities.iter().copied());
    drawn.unwrap_or(probabilities.len().saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::testing::bowls;

    #[test]
    fn wording_puts_qualities_before_and_places_behind_the_noun() {
        let scene = bowls();
        let mut rng = Rng::new(1);
        let plain = Wording::plain(&scene);
        let of = |attribute: &str, value: &str| {
            let k = scene.attribute_named(attribute).unwrap();
            (k, scene.value_named(k, value).unwrap())
        };
        let values = [of("location", "cabinet"), of("size", "small"), of("color", "white")];
        assert_eq!(plain.object(&values, &mut rng), "small white bowl in the cabinet");
        assert_eq!(plain.object(&[], &mut rng), "bowl");
        assert_eq!(plain.predicate(values[0], &mut rng), "in the cabinet");
        let varied = Wording { scene: &scene, synonyms: 0.35 };
        let words: std::collections::BTreeSet<String> =
            (0..200).map(|_| varied.predicate(values[0], &mut rng)).collect();
        let all = ["in the cabinet", "in the cupboard"].map(str::to_owned);
        assert_eq!(words.into_iter().collect::<Vec<_>>(), all);
    }

    #[test]
    fn own_values_are_distinct_values_of_the_object() {
        let scene = bowls();
        let seed = 9;
        let mut rng = Rng::new(seed);
        for i in (0..6).map(ObjectId::from) {
            let named = own_values(&scene, i, &[0.0, 0.0, 0.0, 1.0], &mut rng);
            assert_eq!(named.len(), 3, "seed {seed}");
            assert!(named.iter().all(|(k, v)| scene.has(i, *k, *v)));
            let attributes: std::collections::HashSet<_> = named.iter().map(|(k, _)| k).collect();
            assert_eq!(attributes.len(), 3);
        }
        let mean = (0..10_000).map(|_| number(&[0.5, 0.3, 0.2], &mut rng)).sum::<usize>();
        assert!((6_600..7_400).contains(&mean), "seed {seed}: {mean}");
    }
}
