use super::*;
use crate::Scene;

/// Cups at these places and of these sizes, metres, all alike in words.
fn cups(placed: &[([f64; 3], [f64; 3])]) -> Scene {
    let head = "name = \"cups\"\nnoun = \"cup\"\n[[attributes]]\nname = \"color\"\n\
        ask_yes_no = [\"Is it {value}?\"]\nask_which = [\"Which?\"]\nvalues = [\"white\"]\n";
    let object = |(n, (xyz, size)): (usize, &([f64; 3], [f64; 3]))| {
        format!(
            "[[objects]]\nname = \"c{n}\"\nattributes = {{ color = \"white\" }}\n\
             xyz = {xyz:?}\nsize = {size:?}\ngrasp_width = 0.05\n"
        )
    };
    let objects: String = placed.iter().enumerate().map(object).collect();
    Scene::from_toml("cups.toml", &format!("{head}{objects}")).unwrap_or_else(|e| panic!("{e}"))
}

const CUP: [f64; 3] = [0.08, 0.08, 0.1];

/// Four cups in a row, from the left.
fn row() -> Scene {
    cups(&[0.3, 0.1, -0.1, -0.3].map(|y| ([0.6, y, 0.05], CUP)))
}

fn truths(scene: &Scene, relation: Relation, to: &[Vec<ObjectId>], view: View) -> Vec<f64> {
    let among: Vec<ObjectId> = scene.ids().collect();
    let about = Related { among: &among, to, view };
    let truths = scene.truths(relation, &about).expect("known");
    truths.into_iter().map(|truth| truth.expect("of every object")).collect()
}

/// The objects of which a relation is plainly true; of the others it is plainly not.
fn plainly(scene: &Scene, relation: Relation, to: &[usize], view: View) -> Vec<usize> {
    let to: Vec<Vec<ObjectId>> = to.iter().map(|i| vec![ObjectId::from(*i)]).collect();
    let truths = truths(scene, relation, &to, view);
    assert!(truths.iter().all(|truth| *truth > 0.9 || *truth < 0.1), "{truths:?}");
    (0..truths.len()).filter(|i| truths[*i] > 0.9).collect()
}

#[test]
fn order_goes_from_the_side_that_is_named() {
    let scene = row();
    let nth = |measure, n| plainly(&scene, Relation::Nth(measure, n), &[], View::Robot);
    assert_eq!((nth(Measure::Left, 1), nth(Measure::Right, 1)), (vec![0], vec![3]));
    assert_eq!((nth(Measure::Left, 2), nth(Measure::Right, 2)), (vec![1], vec![2]));
    let middle = plainly(&scene, Relation::Middle(Measure::Left), &[], View::Robot);
    assert_eq!(middle, [1, 2], "of four, two are in the middle");
}

#[test]
fn a_user_who_faces_the_robot_has_left_and_right_reversed() {
    let view = View::User([1.6, 0.0, 0.4]);
    let leftmost = Relation::Nth(Measure::Left, 1);
    assert_eq!(plainly(&row(), leftmost, &[], view), [3]);
    assert_eq!(plainly(&row(), Relation::More(Measure::Left), &[1], view), [2]);
}

#[test]
fn relations_to_an_object_prefer_what_is_near_it() {
    let scene = row();
    let of = |relation, to: &[usize]| plainly(&scene, relation, to, View::Robot);
    assert_eq!(of(Relation::More(Measure::Right), &[1]), [2]);
    assert_eq!(of(Relation::Beside, &[1]), [0, 2]);
    assert_eq!(of(Relation::Between, &[0, 2]), [1]);
}

#[test]
fn in_front_and_behind_count_along_the_view_alone() {
    let scene = cups(&[
        ([0.5, 0.0, 0.05], CUP),
        ([0.7, 0.0, 0.05], CUP),
        ([0.9, 0.0, 0.05], CUP),
        ([0.8, 0.4, 0.05], CUP),
    ]);
    let of = |measure| plainly(&scene, Relation::More(measure), &[1], View::Robot);
    assert_eq!((of(Measure::Front), of(Measure::Back)), (vec![0], vec![2]));
}

#[test]
fn a_comparison_goes_by_the_dimension_that_it_names() {
    let scene = cups(&[
        ([0.5, 0.3, 0.05], [0.30, 0.02, 0.02]),
        ([0.5, 0.0, 0.05], [0.10, 0.10, 0.10]),
        ([0.5, -0.3, 0.05], [0.05, 0.05, 0.20]),
    ]);
    let most = |measure| plainly(&scene, Relation::Nth(measure, 1), &[], View::Robot);
    assert_eq!(most(Measure::Long), [0]);
    assert_eq!(most(Measure::Big), [1]);
    assert_eq!(most(Measure::Tall), [2]);
    assert_eq!(plainly(&scene, Relation::More(Measure::Tall), &[1], View::Robot), [2]);
}

#[test]
fn truth_is_graded_and_ties_stay_open() {
    let scene =
        cups(&[([0.6, 0.21, 0.05], CUP), ([0.6, 0.20, 0.05], CUP), ([0.6, -0.2, 0.05], CUP)]);
    let leftmost = truths(&scene, Relation::Nth(Measure::Left, 1), &[], View::Robot);
    assert_eq!(leftmost[0], 1.0);
    assert!((0.4..0.9).contains(&leftmost[1]) && leftmost[2] < 1e-6, "{leftmost:?}");
    let tied = cups(&[0.2, 0.2, 0.1].map(|length| ([0.6, 0.0, 0.05], [length, 0.05, 0.05])));
    let longest = truths(&tied, Relation::Nth(Measure::Long, 1), &[], View::Robot);
    assert_eq!(longest[..2], [1.0, 1.0]);
    assert!(longest[2] < 1e-3, "{longest:?}");
}

#[test]
fn what_is_not_known_is_not_told() {
    let scene = row();
    let among: Vec<ObjectId> = scene.ids().collect();
    let about = Related { among: &among, to: &[], view: View::Robot };
    let none = |relation| assert_eq!(scene.truths(relation, &about), None, "{relation:?}");
    none(Relation::Nth(Measure::Heavy, 1));
    none(Relation::Nth(Measure::Big, 1));
    none(Relation::Nth(Measure::NearUser, 1));
    none(Relation::Beside);
    none(Relation::Between);
}
