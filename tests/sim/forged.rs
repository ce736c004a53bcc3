//! A dialogue among forged messages: whatever numbers arrive in between, what is valid is still taken,
//! and the journals agree.

use whichone_tests::settings;
use whichone_tests::simulated_group::{Faults, GroupUser, SimulatedGroup};

#[test]
fn forged_messages_neither_deafen_a_service_nor_enter_a_journal() {
    for seed in super::seeds(60) {
        let user = GroupUser::typing((seed % 6) as usize);
        // Kills as well: what was forged must not come back from a journal.
        let faults = if seed % 2 == 0 { Faults::none() } else { Faults::everything(seed) };
        let group = SimulatedGroup::new(settings(&[]), user, faults).with_forger(seed);
        super::run_with(seed, group);
    }
}
