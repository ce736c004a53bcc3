//! `[prior]` of `dialogue.toml`: what is believed before anything is said.

use dialogue::{Prior, PriorObjects};

use diagnostics::Fields;

pub(crate) fn read(f: &mut Fields<'_>) -> Prior {
    let objects = [("uniform", PriorObjects::Uniform), ("history", PriorObjects::History)];
    Prior {
        objects: f.choice("objects", &objects),
        smoothing: f.number("smoothing", 0.01..=1e6),
        absent: f.number("absent", 0.0..=0.9),
    }
}
