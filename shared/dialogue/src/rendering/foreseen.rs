//! Lines that the robot is likely to say, so that their sound can be prepared.

use std::collections::HashSet;

use scene::{AttributeId, ObjectId, Question, Scene, ValueId};

use super::{fetching, wanted};
use crate::manager::Preface;

/// Wordings of one question that take turns soon.
const VARIANTS: u64 = 4;

/// Most picks whose announcements are foreseen: in a scene of thousands few are ever made, and the
/// sound of each takes time and space.
const PICKS_MAX: usize = 64;

/// Returns the questions of a scene and the announcements of its first picks, the most likely
/// first, each once. Objects that cannot be fetched are left out if others can.
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
    let mut objects: Vec<ObjectId> = scene.placed().collect();
    if objects.is_empty() {
        objects = scene.ids().collect();
    }
    let picks =
        objects.into_iter().take(PICKS_MAX).map(|i| fetching(&scene.describe(i), &Preface::None));
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

    /// A scene of `count` mugs; the last one alone has a place if `placed`.
    fn mugs(count: usize, placed: bool) -> Scene {
        let place = "xyz = [0.7, 0.2, 0.0]\nsize = [0.1, 0.1, 0.1]\ngrasp_width = 0.004\nform = \"hollow\"\n";
        let mug = |n: usize| {
            let place = if placed && n + 1 == count { place } else { "" };
            format!("[[objects]]\nname = \"m{n}\"\nattributes = {{ size = \"s{n}\" }}\n{place}")
        };
        let values: Vec<String> = (0..count).map(|n| format!("s{n}")).collect();
        let head = "name = \"s\"\nnoun = \"mug\"\n[[attributes]]\nname = \"size\"\n";
        let mugs: String = (0..count).map(mug).collect();
        Scene::from_toml("s", &format!("{head}values = {values:?}\n{mugs}")).unwrap()
    }

    #[test]
    fn foreseen_picks_are_few_and_those_that_can_be_fetched() {
        let picks = |scene: &Scene| -> Vec<String> {
            let lines = foreseen(scene).into_iter();
            lines.filter(|line| line.starts_with("I will get")).collect()
        };
        assert_eq!(picks(&mugs(PICKS_MAX + 9, false)).len(), PICKS_MAX);
        assert_eq!(picks(&mugs(PICKS_MAX + 9, true)), ["I will get the s72 mug."]);
    }
}
