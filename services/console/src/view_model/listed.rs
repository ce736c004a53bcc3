//! The objects that pages list: those that have a place; of the others all of a small scene, and of
//! a large one those that the dialogue is about at the moment.

use std::collections::BTreeSet;

use messages::{ArmStatus, PolicyView};
use scene::{ObjectId, Question, Scene};
use vocabulary::Action;

/// Scenes of up to this many objects are listed whole.
pub(super) const WHOLE_MAX: usize = 64;
/// Likeliest objects that are listed of a larger scene.
pub(super) const LIKELIEST_MAX: usize = 24;

/// The objects that are listed besides `standing` for now: all of a small scene; of a large one the
/// likeliest, and those that the decision or the arm is about.
pub(super) fn further(
    scene: &Scene,
    standing: &[ObjectId],
    view: Option<&PolicyView>,
    arm: Option<&ArmStatus>,
) -> BTreeSet<ObjectId> {
    let count = scene.objects().len();
    let is_new =
        |object: &ObjectId| object.index() < count && standing.binary_search(object).is_err();
    if count <= WHOLE_MAX {
        return (0..count).map(ObjectId::from).filter(is_new).collect();
    }
    let Some(view) = view else { return BTreeSet::new() };
    let mut listed: BTreeSet<ObjectId> = likeliest(&view.belief, LIKELIEST_MAX).collect();
    let of_action = |(action, _): &(Action, f64)| match action {
        Action::Pick(object) | Action::Ask(Question::Point(object)) => Some(*object),
        Action::Wait | Action::Ask(_) => None,
    };
    listed.extend(view.alternatives.iter().filter_map(of_action));
    listed.extend(match view.question {
        Question::Point(object) => Some(object),
        _ => None,
    });
    listed.extend(view.last.as_ref().and_then(|last| last.object));
    listed.extend(view.refusable.map(|delivery| ObjectId(delivery.object)));
    let picked = arm.filter(|arm| arm.interaction != 0);
    listed.extend(picked.and_then(|arm| u16::try_from(arm.object).ok()).map(ObjectId));
    listed.into_iter().filter(is_new).collect()
}

/// The most probable objects, of equal ones the first.
pub(super) fn likeliest(belief: &[f64], most: usize) -> impl Iterator<Item = ObjectId> {
    let mut order: Vec<usize> = (0..belief.len()).collect();
    let by_belief = |a: &usize, b: &usize| belief[*b].total_cmp(&belief[*a]).then(a.cmp(b));
    if order.len() > most {
        order.select_nth_unstable_by(most, by_belief);
        order.truncate(most);
    }
    order.into_iter().map(ObjectId::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scene of `count` like mugs; the first three have a place.
    fn mugs(count: usize) -> Scene {
        let mug = |n: usize| {
            let place = "xyz = [0.7, 0.2, 0.0]\nsize = [0.1, 0.1, 0.1]\ngrasp_width = 0.004\nform = \"hollow\"\n";
            let place = if n < 3 { place } else { "" };
            format!("[[objects]]\nname = \"m{n}\"\nattributes = {{ colour = \"red\" }}\n{place}")
        };
        let mugs: String = (0..count).map(mug).collect();
        let head = "name = \"s\"\nnoun = \"mug\"\n[[attributes]]\nname = \"colour\"\n\
                    values = [\"red\"]\n";
        Scene::from_toml("s", &format!("{head}{mugs}")).unwrap()
    }

    #[test]
    fn small_scenes_are_listed_whole_and_large_ones_by_place_and_belief() {
        let small = mugs(WHOLE_MAX);
        let standing = [0, 1, 2].map(ObjectId);
        assert_eq!(further(&small, &standing, None, None).len(), WHOLE_MAX - 3);
        let count = WHOLE_MAX + 1;
        let large = mugs(count);
        let mut belief = vec![0.001; count];
        (belief[1], belief[60]) = (0.5, 0.4);
        let question = Question::Point(ObjectId(64));
        let view = PolicyView { belief, question, ..PolicyView::default() };
        let listed = further(&large, &standing, Some(&view), None);
        assert!(listed.contains(&ObjectId(60)) && listed.contains(&ObjectId(64)), "{listed:?}");
        assert!(!listed.contains(&ObjectId(1)), "it is listed already: {listed:?}");
        assert!(listed.len() <= LIKELIEST_MAX + 1, "{listed:?}");
    }
}
