//! Faults between two dialogues.

use crate::kind::Kind;
use crate::machine::Machine;
use crate::tally::Tally;
use std::fs;
use std::path::Path;
use std::time::Instant;
use vocabulary::Rng;
use whichone_tests::second_user::assert_closed;

/// Services with a journal.
const JOURNALED: [&str; 3] = ["speech", "policy", "arm"];

/// Injects one fault and checks that it was harmless, or refused with a way out that works.
pub(crate) fn inject(kind: Kind, machine: &mut Machine, rng: &mut Rng, tally: &mut Tally) {
    match kind {
        Kind::HostileUser => assert_closed(&machine.group),
        Kind::JournalLoss => lose_journal(machine, rng, tally),
        other => unreachable!("{other:?} is injected during dialogues"),
    }
}

/// Removes, empties or damages a journal. The group must refuse to start with it, name the way out,
/// and go on with that.
fn lose_journal(machine: &mut Machine, rng: &mut Rng, tally: &mut Tally) {
    let group = &mut machine.group;
    group.must(&["down"]);
    let service = JOURNALED[rng.below(JOURNALED.len())];
    let path = group.paths().journal_file(service);
    match rng.below(3) {
        0 => fs::remove_file(&path).expect("a journal"),
        1 => fs::write(&path, "").expect("a journal"),
        _ => flip_a_bit(&path, rng),
    }
    let since = Instant::now();
    let refused = group.start(&[]);
    let text = format!("{}{}", refused.stdout, refused.stderr);
    // A flipped number of the format or the epoch reads as another version's journal.
    assert!(matches!(refused.code, Some(74 | 78)), "{refused:?}");
    if refused.code == Some(74) {
        let way_out = format!("journal set-aside {service}");
        assert!(text.contains(&way_out), "`{way_out}` is missing in: {text}");
    }
    group.must(&["journal", "set-aside", service]);
    machine.up();
    tally.recovered(Kind::JournalLoss, since.elapsed());
    machine.group.verify_journals();
}

fn flip_a_bit(path: &Path, rng: &mut Rng) {
    let mut bytes = fs::read(path).expect("a journal");
    let at = rng.below(bytes.len());
    bytes[at] ^= 1 << rng.below(8);
    fs::write(path, bytes).expect("a journal");
}
