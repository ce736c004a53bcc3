//! Budgets of one person in shared resources: entries in the audit, and pages.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use roster::Name;

/// Logins, pages and orders of a person at once, and how many more each second.
const BUDGET: (f64, f64) = (20.0, 10.0);
/// Open pages of a person, and of all.
const PAGES_EACH: usize = 32;
const PAGES_MAX: usize = 256;

/// How many logins, pages and orders each person may still give.
#[derive(Debug, Default)]
pub(crate) struct Budgets(Mutex<BTreeMap<Name, (f64, Instant)>>);

impl Budgets {
    /// Takes one of a person's; returns whether there was one.
    pub(crate) fn take(&self, person: &Name) -> bool {
        self.take_at(person, Instant::now())
    }

    fn take_at(&self, person: &Name, now: Instant) -> bool {
        let mut all = lock(&self.0);
        let (left, since) = all.entry(person.clone()).or_insert((BUDGET.0, now));
        let more = now.duration_since(*since).as_secs_f64() * BUDGET.1;
        (*left, *since) = ((*left + more).min(BUDGET.0), now);
        let has = *left >= 1.0;
        *left -= f64::from(u8::from(has));
        has
    }
}

/// The number of open pages of each person.
#[derive(Debug, Default)]
pub(crate) struct Places(Arc<Mutex<BTreeMap<Name, usize>>>);

impl Places {
    /// Takes a place for a page; `None` if the person has too many, or all are taken.
    pub(crate) fn take(&self, person: &Name) -> Option<Place> {
        let mut all = lock(&self.0);
        let taken = all.get(person).copied().unwrap_or(0);
        if taken >= PAGES_EACH || all.values().sum::<usize>() >= PAGES_MAX {
            return None;
        }
        all.insert(person.clone(), taken + 1);
        Some(Place { all: Arc::clone(&self.0), person: person.clone() })
    }
}

/// The place of an open page.
#[derive(Debug)]
pub(crate) struct Place {
    all: Arc<Mutex<BTreeMap<Name, usize>>>,
    person: Name,
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut all = lock(&self.all);
        if let Some(taken) = all.get_mut(&self.person) {
            *taken -= 1;
            if *taken == 0 {
                all.remove(&self.person);
            }
        }
    }
}

fn lock<T>(all: &Mutex<T>) -> MutexGuard<'_, T> {
    // Every change leaves consistent counts.
    all.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn people() -> [Name; 2] {
        ["ann", "bob"].map(|name| Name::new(name).unwrap())
    }

    #[test]
    fn one_persons_orders_take_nothing_of_anothers() {
        let ([ann, bob], budgets, now) = (people(), Budgets::default(), Instant::now());
        let taken = |person, now| (0..100).filter(|_| budgets.take_at(person, now)).count();
        assert_eq!([taken(&bob, now), taken(&bob, now), taken(&ann, now)], [20, 0, 20]);
        assert_eq!(taken(&bob, now + std::time::Duration::from_secs(1)), 10);
    }

    #[test]
    fn pages_of_a_person_are_bounded_and_give_their_places_back() {
        let ([ann, bob], places) = (people(), Places::default());
        let mut open: Vec<Place> = (0..500).filter_map(|_| places.take(&bob)).collect();
        assert_eq!(open.len(), PAGES_EACH);
        assert!(places.take(&ann).is_some() && places.take(&bob).is_none());
        open.pop();
        assert!(places.take(&bob).is_some());
        drop(open);
        assert!(lock(&places.0).is_empty());
    }
}
