//! Draws from the deterministic generator: the same on every machine and in every run.

pub(crate) use vocabulary::Rng;

/// Returns a number below `n`; 0 for an `n` of 0. The language model of a scene depends on these
/// very draws.
pub(crate) fn below(rng: &mut Rng, n: usize) -> usize {
    (rng.next_u64() % n.max(1) as u64) as usize
}

/// Returns a number from -1 to 1.
pub(crate) fn signed(rng: &mut Rng) -> f32 {
    (rng.next_u64() >> 40) as f32 / (1 << 23) as f32 - 1.0
}
