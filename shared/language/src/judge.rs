//! The judge: how probable it is that a value word is wanted, denied, or neither, by the words around it.
//!
//! A linear model over hashed features ([`crate::features`]), trained by `reader_training` on labelled lines. It corrects
//! what the rules propose and says how sure that is: what they do not cover is in doubt.

use std::sync::LazyLock;

use crate::features::ROWS;

/// The weights, as `reader_training` writes them: a hash of what they were trained on, a scale, and the weights of the
/// three polarities by row.
const FILE: &[u8] = include_bytes!("vocabulary/judge.bin");
/// Length of the hash and the scale, bytes.
const HEAD: usize = 12;
/// Probability that a value word says nothing, whatever the judge states: it has not seen all that people say.
pub const FLOOR: f64 = 0.01;

static JUDGE: LazyLock<Judge> = LazyLock::new(Judge::load);

struct Judge {
    scale: f64,
    weights: Vec<[i16; 3]>,
}

impl Judge {
    fn load() -> Self {
        let scale = FILE[8..HEAD].try_into().map_or(0.0, f32::from_le_bytes);
        let number = |bytes: &[u8]| i16::from_le_bytes([bytes[0], bytes[1]]);
        let row = |row: &[u8]| [number(row), number(&row[2..]), number(&row[4..])];
        let weights: Vec<[i16; 3]> = FILE[HEAD..].chunks_exact(6).map(row).collect();
        assert_eq!(weights.len(), ROWS, "vocabulary/judge.bin");
        Self { scale: f64::from(scale), weights }
    }
}

/// Returns the hash of what the weights were trained on.
pub fn trained_on() -> u64 {
    FILE[..8].try_into().map_or(0, u64::from_le_bytes)
}

/// Returns the probabilities of wanted, denied and neither. Sums are of whole numbers: they do not depend on the order.
pub(crate) fn judge(rows: &[u32]) -> [f64; 3] {
    let mut sums = [0_i64; 3];
    for row in rows {
        for (sum, weight) in sums.iter_mut().zip(JUDGE.weights[*row as usize]) {
            *sum += i64::from(weight);
        }
    }
    let most = sums.into_iter().max().unwrap_or(0);
    let powers = sums.map(|sum| ((sum - most) as f64 * JUDGE.scale).exp());
    let all: f64 = powers.iter().sum();
    powers.map(|power| power / all)
}
