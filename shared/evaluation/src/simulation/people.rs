//! Dialogues with people whom the robot comes to know.

use dialogue::manager::Manager;
use scene::ObjectId;
use vocabulary::{PersonId, Rng};

use crate::simulation::draw::{Stream, stream};
use crate::simulation::interaction::interact_again;
use crate::simulation::{Room, SimulatedInteraction, SimulatedUser, Tally, UserKind};

/// Counts the dialogue of that number, from 1, with the people `numbers` of a kind. Each person
/// wants objects in proportion to `1 / rank^zipf`, in an order of their own: with 0, each alike.
///
/// The manager is one that learns ([`Room::learning_manager`]). Dialogues before the last one are
/// played, and teach it.
pub fn acquainted(
    room: &Room<'_>,
    manager: &mut Manager,
    (kind, dialogue, zipf): (UserKind, u32, f64),
    seed: u64,
    numbers: std::ops::Range<u64>,
) -> Tally {
    let mut tally = Tally::default();
    for number in numbers {
        let who = (kind, zipf);
        play(room, manager, who, (seed, number), dialogue, |n, ended| {
            if n == dialogue {
                tally.add(ended);
            }
        });
    }
    tally
}

/// Plays a number of dialogues with a person, and reports each with its number and end.
fn play(
    room: &Room<'_>,
    manager: &mut Manager,
    (kind, zipf): (UserKind, f64),
    (seed, number): (u64, u64),
    dialogues: u32,
    mut tell: impl FnMut(u32, &SimulatedInteraction),
) {
    let from = PersonId::new("somebody").unwrap_or_default();
    let mut wishes = stream(seed, Stream::Wishes, number);
    let mut person = stream(seed, Stream::Person, number);
    let mut clock = stream(seed, Stream::Clock, number);
    let weights = popularity(room.scene.objects().len(), zipf, &mut wishes);
    let mut state = manager.first();
    for n in 1..=dialogues {
        let wanted = wishes.index(weights.iter().copied()).map_or(ObjectId(0), ObjectId::from);
        let mut user = SimulatedUser::new(kind.into(), wanted, Rng::new(person.next_u64()));
        let known = (&mut state, from.clone());
        tell(n, &interact_again(room, manager, known, &mut user, &mut clock));
    }
}

/// How often each object is wanted, in a random order.
fn popularity(objects: usize, zipf: f64, rng: &mut Rng) -> Vec<f64> {
    let mut weights: Vec<f64> = (1..=objects).map(|rank| (rank as f64).powf(-zipf)).collect();
    for at in (1..weights.len()).rev() {
        weights.swap(at, rng.below(at + 1));
    }
    let all: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / all).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::CachedPlanner;
    use crate::simulation::testing::House;
    use dialogue::Lookahead;

    /// People who err are known after some dialogues: they get the wanted object more often, and
    /// the robot is as sure as it may be.
    #[test]
    fn people_who_err_are_known_after_some_dialogues() {
        let (seed, house) = (11, House::new());
        let room = Room { request: false, ..house.room() };
        let planner = Lookahead { beliefs_max: 100, tolerance: 1e-4 };
        let mut manager = room.learning_manager(CachedPlanner::new(Box::new(planner)));
        let mut after = |dialogue: u32| {
            let kind = (UserKind::Wrong(10), dialogue, 0.0);
            acquainted(&room, &mut manager, kind, seed, 0..1_000)
        };
        let (first, later) = (after(1), after(20));
        assert!(first.success() < 0.90, "seed {seed}: {}", first.success());
        assert!(later.success() > 0.92, "seed {seed}: {}", later.success());
        let off = |tally: &Tally| tally.stated.mean() - tally.success();
        assert!(off(&first) > 0.06, "seed {seed}: {}", off(&first));
        assert!(off(&later).abs() < 0.04, "seed {seed}: {}", off(&later));
    }
}
