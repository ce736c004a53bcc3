//! Places of connections that are handled at a time: bounded in number, and for each address.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex};

use crate::guarded;

/// The places of a listener.
#[derive(Debug)]
pub(crate) struct Slots {
    most: usize,
    taken: Arc<Mutex<BTreeMap<IpAddr, usize>>>,
}

impl Slots {
    /// Places for so many connections. No address gets more than half of them, so that a silent host does not keep others
    /// out.
    pub(crate) fn new(most: usize) -> Self {
        Self { most, taken: Arc::default() }
    }

    /// Takes a place for a connection from this address, if there is one.
    pub(crate) fn take(&self, from: IpAddr) -> Option<Slot> {
        let mut taken = guarded(&self.taken);
        let of_address = taken.get(&from).copied().unwrap_or(0);
        if taken.values().sum::<usize>() >= self.most || of_address >= self.most.div_ceil(2) {
            return None;
        }
        taken.insert(from, of_address + 1);
        Some(Slot { taken: Arc::clone(&self.taken), from })
    }
}

/// A place, which is free again when this is dropped.
#[derive(Debug)]
pub(crate) struct Slot {
    taken: Arc<Mutex<BTreeMap<IpAddr, usize>>>,
    from: IpAddr,
}

impl Drop for Slot {
    fn drop(&mut self) {
        let mut taken = guarded(&self.taken);
        if let Some(count) = taken.get_mut(&self.from) {
            *count -= 1;
            if *count == 0 {
                taken.remove(&self.from);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_are_bounded_for_all_and_for_each_address() {
        let slots = Slots::new(4);
        let address = |n: u8| IpAddr::from([10, 0, 0, n]);
        let take = |n| slots.take(address(n));
        let held = [take(1), take(1)];
        assert!(held.iter().all(Option::is_some) && take(1).is_none());
        let others = [take(2), take(3)];
        assert!(others.iter().all(Option::is_some) && take(4).is_none());
        drop(others);
        assert!(take(4).is_some() && take(1).is_none());
        drop(held);
        assert!(take(1).is_some() && guarded(&slots.taken).is_empty());
    }
}
