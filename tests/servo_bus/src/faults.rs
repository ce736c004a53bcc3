//! Faults of answers, by chance.

use vocabulary::Rng;

/// Names of the faults.
pub const KINDS: [&str; 7] =
    ["lost", "late", "damaged", "truncated", "doubled", "noise", "wrong_id"];
/// Longest delay of a late answer, seconds.
const LATE_MAX_S: f64 = 0.12;

/// Chances of each fault in one answer.
#[derive(Clone, Debug)]
pub struct Faults {
    chances: [f64; 7],
    /// Chance that a servo does not hear a request.
    pub deaf: f64,
    /// Number of each fault so far.
    pub made: [u64; 7],
    rng: Rng,
}

impl Faults {
    /// No faults.
    pub fn none() -> Self {
        Self::each(0.0, 1)
    }

    /// Every fault with the same chance.
    pub fn each(chance: f64, seed: u64) -> Self {
        Self { chances: [chance; 7], deaf: 0.0, made: [0; 7], rng: Rng::new(seed) }
    }

    /// Sets the chance of one fault; `None` if it has another name than [`KINDS`].
    pub fn set(&mut self, kind: &str, chance: f64) -> Option<()> {
        let place = KINDS.iter().position(|known| *known == kind)?;
        self.chances[place] = chance;
        Some(())
    }

    /// Sets the chance of every fault.
    pub fn set_all(&mut self, chance: f64) {
        (self.chances, self.deaf) = ([chance; 7], chance);
    }

    /// Returns whether a servo hears a request.
    pub(crate) fn hears(&mut self) -> bool {
        self.deaf <= 0.0 || self.rng.uniform() >= self.deaf
    }

    /// Returns what becomes of an answer: its delay in seconds and its bytes, of which there may be none.
    pub(crate) fn pass(&mut self, good: Vec<u8>) -> (f64, Vec<u8>) {
        let happens = |rng: &mut Rng, chance: f64| chance > 0.0 && rng.uniform() < chance;
        let Some(kind) = (0..KINDS.len()).find(|kind| happens(&mut self.rng, self.chances[*kind]))
        else {
            return (0.0, good);
        };
        self.made[kind] += 1;
        let rng = &mut self.rng;
        match KINDS[kind] {
            "lost" => (0.0, Vec::new()),
            "late" => (rng.between((0.001, LATE_MAX_S)), good),
            "damaged" => (0.0, damaged(good, rng)),
            "truncated" => {
                let length = rng.below(good.len());
                (0.0, good[..length].to_vec())
            }
            "doubled" => (0.0, [good.clone(), good].concat()),
            "noise" => {
                let noise: Vec<u8> = (0..1 + rng.below(4)).map(|_| rng.below(256) as u8).collect();
                (0.0, [noise, good].concat())
            }
            _ => (0.0, of_another(good, rng)),
        }
    }
}

/// One bit differs.
fn damaged(mut bytes: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    let at = rng.below(bytes.len());
    bytes[at] ^= 1 << rng.below(8);
    bytes
}

/// The answer names another servo, and its checksum is right.
fn of_another(mut bytes: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    let other = bytes[2] % 6 + 1 + rng.below(2) as u8;
    let end = bytes.len() - 1;
    bytes[end] = bytes[end].wrapping_add(bytes[2]).wrapping_sub(other);
    bytes[2] = other;
    bytes
}
