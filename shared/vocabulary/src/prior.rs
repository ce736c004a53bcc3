//! Settings of the belief before anything was said.

/// Prior of a new interaction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Prior over the objects.
    pub objects: PriorObjects,
    /// Weight of each object in the Dirichlet distribution, in deliveries.
    pub smoothing: f64,
    /// Probability that the wanted object is absent; 0 if absence is not considered.
    pub absent: f64,
}

/// Prior over the objects before any utterance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PriorObjects {
    /// All alike, as in the paper.
    Uniform,
    /// Objects delivered more often are likelier.
    History,
}
