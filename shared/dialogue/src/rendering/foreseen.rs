//! Lines that the robot is likely to say, so that their sound can be prepared.

use std::collections::HashSet;

use scene::{AttributeId, ObjectId, Question, Scene, ValueId};

use super::{fetching, wanted};
use crate::manager::Preface;

/// Wordings of one question that take turns soon.
const VARIANTS: u64 = 4;

/// Returns the questions of a scene and the announcements of its picks, the most likely first, each once.
pub fn foreseen(scene: &Scene) -> Vec<String> {
    let mut questions = vec![Question::None];
    for (k, attribute) in scene.attributes().iter().enumerate() {
        let k = AttributeId::from(k);
        if attribute.values.len() > 1 {
            let values = (0..attribute.values.len()).map(ValueId::from);
            questions.extend(values.map(|v| Question::Attribute(k, v)));
            questions.push(Question::Which(k));
        }
    }
    let ask = |n| questions.iter().map(move |question| scene.phrase_variant(*question, n, 1, &[]));
    let objects = (0..scene.objects().len()).map(ObjectId::from);
    let picks = objects.map(|i| fetching(&scene.describe(i), &Preface::None));
    let further = (1..VARIANTS).flat_map(ask);
    let lines = ask(0).chain(picks).chain([wanted(scene, 1)]).chain(further);
    let mut said = HashSet::new();
    lines.filter(|line| said.insert(line.clone())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::bowls;

    #[test]
    fn foreseen_lines_are_the_questions_and_picks_of_a_scene() {
        let lines = foreseen(&bowls());
        for line in ["Is the color white?", "What is the color?", "I will get the clear object."] {
            assert_eq!(lines.iter().filter(|known| *known == line).count(), 1, "{line}: {lines:?}");
        }
    }
}
