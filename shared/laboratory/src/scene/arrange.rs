//! Places for all objects of a scene that need one: the nearest, or any on the table.

use manipulation::PlanError;
use preflight::{Arrangement, GAP_M, Watch, rounded};

/// Distances between boxes that are tried one after the other on a free table, metres: loose
/// spacing leaves room for the next object.
const LOOSE_M: [f64; 3] = [0.10, 0.05, GAP_M];

/// Spacing of the places tried on a free table, and their extent from its middle, metres.
const GRID_M: f64 = 0.05;
const GRID_STEPS: i32 = 20;

/// Moves every object that cannot be fetched from its place to the nearest one where it can, then
/// puts each of `new`, which have no place yet, on the table. Returns those with a new place. Others
/// keep theirs, out of the others' way; no place helps those that cannot be grasped.
pub(super) fn arrange(
    objects: &mut Arrangement<'_>,
    new: &[usize],
    watch: Watch<'_>,
) -> Vec<usize> {
    let count = objects.poses().len();
    new.iter().for_each(|&i| objects.lift(i));
    let is_misplaced = |&i: &usize| {
        watch(format!("checking reach: {i} of {count} places"));
        !objects.is_late()
            && matches!(objects.limb(i), Err(error) if !matches!(error, PlanError::Grasp(_)))
    };
    let known = (0..count).filter(|i| !new.contains(i));
    let misplaced: Vec<usize> = known.filter(is_misplaced).collect();
    misplaced.iter().for_each(|&i| objects.lift(i));
    let mut moved = Vec::new();
    for (n, &i) in misplaced.iter().chain(new).enumerate() {
        watch(format!("finding places: {n} of {}", misplaced.len() + new.len()));
        let stays = objects.poses()[i].xyz_m;
        let place = if new.contains(&i) {
            on_table(objects, i)
        } else if objects.fits(i, stays, GAP_M) {
            Some(stays)
        } else {
            objects.nearest(i).or_else(|| on_table(objects, i))
        };
        if let Some(place) = place {
            objects.put(i, place);
            moved.extend((place != stays).then_some(i));
        }
    }
    moved
}

/// Returns the reason for which an object without a place gets none.
pub(super) fn why_unplaced(objects: &Arrangement<'_>, i: usize) -> String {
    match objects.limb(i) {
        Err(PlanError::Grasp(error)) => format!("cannot be grasped anywhere: {error}"),
        _ if objects.is_late() => {
            "has no place: the search took too long; help: set its `xyz`".to_owned()
        }
        _ => "finds no free place on the table that the arm reaches".to_owned(),
    }
}

/// Returns a place on the table, the nearest to the middle of the arm's reach.
fn on_table(objects: &Arrangement<'_>, i: usize) -> Option<[f64; 3]> {
    let plan = &objects.setup().plan;
    // In front of the robot, a little nearer than objects are handed over.
    let middle_x = rounded(plan.hand_over_xyz_m[0] - 0.1);
    let z = plan.table_z_m + 0.5 * objects.poses()[i].size_m[2];
    let steps = || -GRID_STEPS..=GRID_STEPS;
    let mut places: Vec<[f64; 3]> = steps()
        .flat_map(|n| steps().map(move |k| (f64::from(n) * GRID_M, f64::from(k) * GRID_M)))
        .map(|(dx, dy)| [rounded(middle_x + dx), rounded(dy), (z * 1e4).round() / 1e4])
        .collect();
    let from_middle = |at: &[f64; 3]| (at[0] - middle_x).hypot(at[1]);
    // The sort is stable, so that equal distances keep their order.
    places.sort_by(|a, b| from_middle(a).total_cmp(&from_middle(b)));
    LOOSE_M
        .iter()
        .flat_map(|gap_m| places.iter().map(move |place| (*gap_m, *place)))
        .take_while(|_| !objects.is_late())
        .find_map(|(gap_m, place)| objects.fits(i, place, gap_m).then_some(place))
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::time::Instant;

    use config::Settings;
    use manipulation::ObjectPose;
    use preflight::ArmSetup;

    use super::*;

    /// The shipped arm, and bowls that have no place yet.
    fn unplaced(count: usize) -> (ArmSetup, Vec<ObjectPose>) {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        let settings = Settings::load(&shipped, None, &[]).unwrap();
        let setup = ArmSetup::new(&settings).unwrap();
        let bowl = preflight::pose(&settings.scene.objects()[0].placement.unwrap());
        (setup, vec![ObjectPose { xyz_m: [0.0; 3], ..bowl }; count])
    }

    #[test]
    fn nine_objects_without_places_are_arranged_the_same_way_each_time() {
        let (setup, poses) = unplaced(9);
        let all: Vec<usize> = (0..9).collect();
        let arranged = || {
            let mut objects = Arrangement::new(&setup, poses.clone());
            assert_eq!(arrange(&mut objects, &all, &|_| {}), all);
            all.iter().for_each(|&i| assert!(objects.limb(i).is_ok(), "{i}"));
            objects.poses().iter().map(|pose| pose.xyz_m).collect::<Vec<_>>()
        };
        assert_eq!(arranged(), arranged());
    }

    #[test]
    fn search_for_places_ends_in_time_and_says_so() {
        let (setup, poses) = unplaced(2);
        let mut late = Arrangement::new(&setup, poses).until(Instant::now());
        assert_eq!(arrange(&mut late, &[0, 1], &|_| {}), [] as [usize; 0]);
        let why = why_unplaced(&late, 1);
        assert!(why.contains("took too long"), "{why}");
    }
}
