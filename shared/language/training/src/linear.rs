//! A linear model over hashed features, trained with AdaGrad: steps shrink with past gradients.
//!
//! The order is fixed, so that the same lines give the same weights on every machine.

use language::softmax;
use vocabulary::Rng;

/// Pull of each weight towards zero, a step.
const SHRINK: f64 = 3e-6;

/// A training example: rows of weights, the label's number, and its weight.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// Rows.
    pub rows: Vec<u32>,
    /// Number of the label.
    pub label: usize,
    /// Weight of the example.
    pub weight: f64,
}

/// Weights of the labels by row.
#[derive(Clone, Debug)]
pub struct Linear<const LABELS: usize> {
    weights: Vec<[f64; LABELS]>,
}

impl<const LABELS: usize> Linear<LABELS> {
    /// Trains `rows` rows of weights on the lessons.
    pub fn train(lessons: &[Lesson], rows: usize, epochs: usize, rate: f64, seed: u64) -> Self {
        let mut linear = Self { weights: vec![[0.0; LABELS]; rows] };
        let mut seen = vec![[1e-2; LABELS]; rows];
        let mut order: Vec<usize> = (0..lessons.len()).collect();
        let mut random = Rng::new(seed);
        for _ in 0..epochs {
            shuffle(&mut order, &mut random);
            for lesson in order.iter().map(|n| &lessons[*n]) {
                linear.step(lesson, rate, &mut seen);
            }
        }
        linear
    }

    fn step(&mut self, lesson: &Lesson, rate: f64, seen: &mut [[f64; LABELS]]) {
        let stated = softmax(self.sums(&lesson.rows));
        for (label, stated) in stated.into_iter().enumerate() {
            let error = (stated - f64::from(u8::from(label == lesson.label))) * lesson.weight;
            // Each row takes its part of the step.
            for row in &lesson.rows {
                let (row, n) = (*row as usize, label);
                let gradient = error + SHRINK * self.weights[row][n];
                seen[row][n] += gradient * gradient;
                self.weights[row][n] -= rate * gradient / seen[row][n].sqrt();
                self.weights[row][n] *= 1.0 - SHRINK;
            }
        }
    }

    /// Returns the sums of the labels.
    pub fn sums(&self, rows: &[u32]) -> [f64; LABELS] {
        let mut sums = [0.0; LABELS];
        for row in rows {
            for (sum, weight) in sums.iter_mut().zip(self.weights[*row as usize]) {
                *sum += weight;
            }
        }
        sums
    }

    /// The weights of a row.
    pub fn row(&self, row: usize) -> [f64; LABELS] {
        self.weights[row]
    }
}

pub(crate) fn shuffle(order: &mut [usize], random: &mut Rng) {
    for last in (1..order.len()).rev() {
        order.swap(last, (random.next_u64() % (last as u64 + 1)) as usize);
    }
}
