//! The judge: probabilities that a value word is wanted, denied, or neither, by nearby words.
//!
//! The sum of a linear model over hashed features ([`crate::features`]) and two recurrent ones
//! ([`crate::recurrent`]), trained by `reader_training` on labelled lines; unsure of new cases.

use std::sync::LazyLock;

use crate::features::{Example, Features, ROWS};
use crate::recurrent::{PARTS, Recurrent, Sequence};

/// The weights, as `reader_training` writes them: a hash of the inputs; a scale, and the linear
/// weights of the polarities by row; then, for each recurrent part, a scale and 8-bit weights.
const FILE: &[u8] = include_bytes!("vocabulary/judge.bin");
/// Length of the hash, bytes.
const HASH: usize = 8;
/// Probability that a value word says nothing, whatever the judge states: training is incomplete.
pub const FLOOR: f64 = 0.01;

/// Recurrent networks, each trained from another start: others seldom share a chance error.
pub const NETWORKS: usize = 2;

static BUILT_IN: LazyLock<Judge> =
    LazyLock::new(|| Judge::from_bytes(FILE).expect("vocabulary/judge.bin has all weights"));

/// Weights of the features.
#[derive(Clone, Debug)]
pub struct Judge {
    scale: f64,
    weights: Vec<[i16; 3]>,
    recurrent: Vec<Recurrent>,
}

impl Judge {
    /// Reads the weights as `reader_training` writes them; `None` if there are too few.
    pub fn from_bytes(file: &[u8]) -> Option<Self> {
        let (scale, mut rest) = number(file.get(HASH..)?)?;
        let word = |bytes: &[u8]| i16::from_le_bytes([bytes[0], bytes[1]]);
        let row = |row: &[u8]| [word(row), word(&row[2..]), word(&row[4..])];
        let weights = rest.get(..6 * ROWS)?.chunks_exact(6).map(row).collect();
        rest = &rest[6 * ROWS..];
        let mut recurrent = vec![Recurrent { weights: Vec::new() }; NETWORKS];
        for network in &mut recurrent {
            for size in PARTS {
                let (scale, bytes) = number(rest)?;
                let part = bytes.get(..size)?.iter().map(|byte| f32::from(*byte as i8) * scale);
                network.weights.extend(part);
                rest = &bytes[size..];
            }
        }
        Some(Self { scale: f64::from(scale), weights, recurrent })
    }

    /// The judge whose weights are part of the program.
    pub(crate) fn built_in() -> &'static Self {
        &BUILT_IN
    }

    /// Returns the probabilities of wanted, denied and neither for each value word.
    pub(crate) fn stated(&self, features: &Features) -> Vec<[f64; 3]> {
        let recurrent = recurrent_sums(&self.recurrent, &features.sequence);
        let stated = |(example, recurrent): (&Example, [f32; 3])| {
            let linear = self.linear(&example.rows);
            softmax([0, 1, 2].map(|n| linear[n] as f64 * self.scale + f64::from(recurrent[n])))
        };
        features.examples.iter().zip(recurrent).map(stated).collect()
    }

    /// Sums of whole numbers: they do not depend on the order.
    fn linear(&self, rows: &[u32]) -> [i64; 3] {
        let mut sums = [0; 3];
        for row in rows {
            for (sum, weight) in sums.iter_mut().zip(self.weights[*row as usize]) {
                *sum += i64::from(weight);
            }
        }
        sums
    }
}

/// Returns the probabilities of which these are the logarithms, up to a summand.
pub fn softmax<const N: usize>(sums: [f64; N]) -> [f64; N] {
    let most = sums.into_iter().fold(f64::MIN, f64::max);
    let powers = sums.map(|sum| (sum - most).exp());
    let all: f64 = powers.iter().sum();
    powers.map(|power| power / all)
}

/// The sums of all networks together, for each value word.
pub fn recurrent_sums(networks: &[Recurrent], sequence: &Sequence) -> Vec<[f32; 3]> {
    let mut all = vec![[0.0; 3]; sequence.values.len()];
    for network in networks {
        for (sums, more) in all.iter_mut().zip(network.sums(sequence)) {
            sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
    }
    all
}

/// Reads a number of 32 bits; returns it with the remaining bytes.
fn number(bytes: &[u8]) -> Option<(f32, &[u8])> {
    let (number, rest) = bytes.split_first_chunk()?;
    Some((f32::from_le_bytes(*number), rest))
}

/// Returns the hash of the inputs on which the weights were trained.
pub fn trained_on() -> u64 {
    FILE[..HASH].try_into().map_or(0, u64::from_le_bytes)
}
