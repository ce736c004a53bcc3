//! `[prior]` of `dialogue.toml`: what is believed before anything is said.

use crate::fields::Fields;

/// The prior of a new interaction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Which objects are likelier.
    pub objects: PriorObjects,
    /// Weight of each object in the Dirichlet distribution, in deliveries.
    pub smoothing: f64,
    /// Probability that the wanted object is not here; 0 where that is not considered.
    pub absent: f64,
}

/// Which objects are likelier before anything is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PriorObjects {
    /// All alike, as in the paper.
    Uniform,
    /// Those that were delivered more often.
    History,
}

pub(crate) fn read(f: &mut Fields<'_>) -> Prior {
    let objects = [("uniform", PriorObjects::Uniform), ("history", PriorObjects::History)];
    Prior {
        objects: f.choice("objects", &objects),
        smoothing: f.number("smoothing", 0.01..=1e6),
        absent: f.number("absent", 0.0..=0.9),
    }
}
