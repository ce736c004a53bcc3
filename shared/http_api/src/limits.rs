//! Places that are given back when they are dropped.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Places for what goes on at a time: so many for one name, so many in all.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    taken: Arc<Mutex<HashMap<String, usize>>>,
    each: usize,
    all: usize,
}

/// A taken place.
#[derive(Debug)]
pub(crate) struct Place {
    places: Places,
    name: String,
}

impl Places {
    pub(crate) fn new(each: usize, all: usize) -> Self {
        Self { taken: Arc::default(), each, all }
    }

    /// Takes a place; `None` if all are taken.
    pub(crate) fn take(&self, name: &str) -> Option<Place> {
        // A count is changed in one step.
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let own = taken.get(name).copied().unwrap_or(0);
        if own >= self.each || taken.values().sum::<usize>() >= self.all {
            return None;
        }
        taken.insert(name.to_owned(), own + 1);
        Some(Place { places: self.clone(), name: name.to_owned() })
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut taken = self.places.taken.lock().unwrap_or_else(PoisonError::into_inner);
        match taken.get_mut(&self.name) {
            Some(own) if *own > 1 => *own -= 1,
            _ => drop(taken.remove(&self.name)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_shared_and_given_back() {
        let places = Places::new(2, 3);
        let hall = [places.take("hall"), places.take("hall")];
        assert!(hall.iter().all(Option::is_some) && places.take("hall").is_none());
        let kitchen = places.take("kitchen");
        assert!(kitchen.is_some() && places.take("garden").is_none(), "three in all");
        drop(hall);
        assert!(places.take("hall").is_some());
        drop(kitchen);
        assert!(places.taken.lock().unwrap().is_empty());
    }
}
