//! The interactions shared out among threads.
//!
//! Invariant: counts depend on the seed alone. Interactions are counted in pieces of [`CHUNK`],
//! whichever thread does them, and the pieces are merged in order.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;

use dialogue::manager::Manager;
use dialogue::registry;
use evaluation::simulation::{
    CHUNK, CachedPlanner, Room, SharedDecisions, Tally, acquainted, interactions, turns,
};
use vocabulary::{Attribution, TurnTaking};

use super::design::{People, Row};
use super::progress::Progress;
use super::setup::Setup;

/// A piece of work: a row, and which of its pieces.
#[derive(Clone, Copy)]
struct Piece {
    row: usize,
    chunk: u64,
}

/// Counts `count` interactions of every row.
pub(super) fn run(
    setup: &Setup,
    rows: &[Row],
    count: u64,
    seed: u64,
    threads: usize,
) -> Vec<Tally> {
    let chunks = count.div_ceil(CHUNK);
    let pieces: Vec<Piece> = (0..rows.len())
        .flat_map(|row| (0..chunks).map(move |chunk| Piece { row, chunk }))
        .collect();
    let shared: HashMap<Decider<'_>, Arc<SharedDecisions>> =
        rows.iter().map(|row| (decider(row), Arc::default())).collect();
    let next = AtomicUsize::new(0);
    let (counted, arrived) = mpsc::channel();
    let mut done: Vec<Option<Tally>> = vec![None; pieces.len()];
    thread::scope(|scope| {
        for _ in 0..threads.min(pieces.len()) {
            let (counted, next, pieces, shared) = (counted.clone(), &next, &pieces, &shared);
            scope.spawn(move || {
                let managers = HashMap::new();
                let mut worker = Worker { room: setup.room(), rows, count, seed, shared, managers };
                while let Some((at, piece)) = take(next, pieces) {
                    // The receiver is gone.
                    if counted.send((at, worker.count(piece))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(counted);
        let mut progress = Progress::new(pieces.len());
        for (at, tally) in arrived {
            done[at] = Some(tally);
            progress.step();
        }
    });
    merge(rows.len(), &pieces, &done)
}

fn take(next: &AtomicUsize, pieces: &[Piece]) -> Option<(usize, Piece)> {
    let at = next.fetch_add(1, Ordering::Relaxed);
    Some((at, *pieces.get(at)?))
}

fn merge(rows: usize, pieces: &[Piece], done: &[Option<Tally>]) -> Vec<Tally> {
    let mut tallies = vec![Tally::default(); rows];
    for (piece, tally) in pieces.iter().zip(done) {
        if let Some(tally) = tally {
            tallies[piece.row].merge(tally);
        }
    }
    tallies
}

/// Decider of a row: its policy, and whether in real time, with final picks, and knowing people.
type Decider<'a> = (&'a str, bool, bool);

fn decider(row: &Row) -> Decider<'_> {
    let people = &row.people;
    (row.policy.as_str(), people.in_real_time(), people.dialogue().is_some())
}

/// One thread's side.
struct Worker<'a> {
    room: Room<'a>,
    rows: &'a [Row],
    count: u64,
    seed: u64,
    shared: &'a HashMap<Decider<'a>, Arc<SharedDecisions>>,
    managers: HashMap<Decider<'a>, Manager>,
}

impl Worker<'_> {
    fn count(&mut self, piece: Piece) -> Tally {
        let row = &self.rows[piece.row];
        let (Row { policy, people }, decider) = (row, decider(row));
        if !self.managers.contains_key(&decider) {
            // The command line has accepted only known names.
            let Ok(planner) = registry::planner(policy) else { return Tally::default() };
            let mut planner = CachedPlanner::new(planner);
            if let Some(shared) = self.shared.get(&decider) {
                planner = planner.sharing(Arc::clone(shared));
            }
            let mut room = self.room;
            if people.in_real_time() {
                room.problem = room.problem.with_final_picks();
            }
            let manager = match people.dialogue() {
                Some(_) => room.learning_manager(planner),
                None => room.manager(planner),
            };
            self.managers.insert(decider, manager);
        }
        let Some(manager) = self.managers.get_mut(&decider) else {
            return Tally::default();
        };
        let first = piece.chunk * CHUNK;
        let numbers = first..(first + CHUNK).min(self.count);
        match people {
            People::InTurns(kind) => {
                // Dialogues in real time leave other settings behind.
                let attribution = Attribution::Onset;
                manager.set_turns(TurnTaking { attribution, ..self.room.turns });
                interactions(&self.room, manager, *kind, self.seed, numbers)
            }
            People::Known { kind, dialogue, zipf } => {
                let who = (*kind, *dialogue, *zipf);
                acquainted(&self.room, manager, who, self.seed, numbers)
            }
            People::RealTime { rules, kind, .. } => {
                turns::dialogues(&self.room, manager, rules, kind, self.seed, numbers)
            }
        }
    }
}
