//! Training of the recurrent judge: gradient steps (Adam; Kingma and Ba 2015) in a fixed order.

use language::recurrent::{
    EMBEDDINGS, HIDDEN, JOINED, PARTS, Recurrent, Sequence, Stated, Step, UNITS, WIDTH, add,
};
use language::softmax;
use vocabulary::Rng;

/// Passes over the utterances.
const EPOCHS: usize = 5;
/// Utterances of a step.
const BATCH: usize = 16;
/// Rate of the first step and of the last.
const RATES: (f64, f64) = (4e-3, 2e-4);
/// Averages of gradients and of their squares: how much of the former one stays.
const STAYS: (f32, f32) = (0.9, 0.99);
/// Pull towards zero of the weights, a step.
const SHRINK: f32 = 1e-3;
/// Share of the rows of an element that are not seen in a pass: no word may be needed.
const UNSEEN: f64 = 0.3;
/// Numbers of units of a step.
const GATES: usize = 3 * UNITS;

/// An utterance with the label of each of its value words that has one, and how much they count.
#[derive(Clone, Debug)]
pub struct Utterance {
    /// Input of the recurrent judge.
    pub sequence: Sequence,
    /// Label of each value word.
    pub labels: Vec<Option<usize>>,
    /// How much each counts.
    pub weight: f64,
}

/// Trains on the utterances.
pub(crate) fn train(utterances: &[&Utterance], seed: u64) -> Recurrent {
    let mut random = Rng::new(seed);
    let mut trained = Training::new(&mut random);
    let mut order: Vec<usize> = (0..utterances.len()).collect();
    let steps = EPOCHS * utterances.len().div_ceil(BATCH);
    let mut done = 0;
    for _ in 0..EPOCHS {
        crate::linear::shuffle(&mut order, &mut random);
        for batch in order.chunks(BATCH) {
            for n in batch {
                trained.learn(utterances[*n], &mut random);
            }
            let progress = f64::from(done as u32) / steps as f64;
            trained.step(RATES.0 * (RATES.1 / RATES.0).powf(progress));
            done += 1;
        }
    }
    trained.model
}

struct Training {
    model: Recurrent,
    gradient: Vec<f32>,
    mean: Vec<f32>,
    square: Vec<f32>,
    /// Rows of embeddings with a gradient.
    touched: Vec<u32>,
}

impl Training {
    fn new(random: &mut Rng) -> Self {
        let mut weights = Vec::new();
        let spreads = [0.1, 0.2, 0.18, 0.0, 0.2, 0.18, 0.0, 0.1, 0.0, 0.15, 0.0];
        for (size, spread) in PARTS.into_iter().zip(spreads) {
            weights.extend((0..size).map(|_| (random.normal() * spread) as f32));
        }
        let zeros = vec![0.0; weights.len()];
        let model = Recurrent { weights };
        let (mean, square) = (zeros.clone(), zeros.clone());
        Self { model, gradient: zeros, mean, square, touched: Vec::new() }
    }

    /// Adds the gradient of an utterance.
    fn learn(&mut self, utterance: &Utterance, random: &mut Rng) {
        let Utterance { sequence, labels, weight } = utterance;
        if labels.iter().all(Option::is_none) {
            return;
        }
        let seen = |rows: &Vec<u32>, random: &mut Rng| -> Vec<u32> {
            // The first row, the kind of the element, is always seen.
            let is_hidden = random.uniform() < UNSEEN;
            rows.iter().take(if is_hidden { 1 } else { rows.len() }).copied().collect()
        };
        let elements: Vec<Vec<u32>> =
            sequence.elements.iter().map(|rows| seen(rows, random)).collect();
        let inputs: Vec<_> = elements.iter().map(|rows| self.model.embedded(rows)).collect();
        let steps = [0, 1].map(|direction| self.model.steps(&inputs, direction));
        let mut of_states = [vec![[0.0; UNITS]; inputs.len()], vec![[0.0; UNITS]; inputs.len()]];
        for ((at, rows), label) in sequence.values.iter().zip(labels) {
            let Some(label) = label else { continue };
            let own = self.model.embedded(rows);
            let stated = self.model.stated(&steps[0], &steps[1], *at, &own);
            let mut of_sums = softmax(stated.sums.map(f64::from));
            of_sums[*label] -= 1.0;
            let of_joined = self.head(&stated, of_sums.map(|it| (it * weight) as f32));
            let last = inputs.len() - 1;
            for (direction, at, from) in [(0, *at, 0), (1, *at, 1), (0, last, 2), (1, 0, 3)] {
                let part = &of_joined[from * UNITS..(from + 1) * UNITS];
                add(&mut of_states[direction][at], 1.0, part);
            }
            self.embedding(rows, &of_joined[4 * UNITS..]);
        }
        let mut of_inputs = vec![[0.0; WIDTH]; inputs.len()];
        for direction in [0, 1] {
            self.back(direction, &inputs, &steps[direction], &of_states[direction], &mut of_inputs);
        }
        for (rows, of_input) in elements.iter().zip(&of_inputs) {
            self.embedding(rows, of_input);
        }
    }

    fn embedding(&mut self, rows: &[u32], gradient: &[f32]) {
        for row in rows {
            let from = *row as usize * WIDTH;
            add(&mut self.gradient[from..from + WIDTH], 1.0, gradient);
            self.touched.push(*row);
        }
    }

    /// Adds the gradient of the hidden units and the polarities; returns that of their inputs.
    fn head(&mut self, stated: &Stated, of_sums: [f32; 3]) -> Vec<f32> {
        let [hidden, hidden_bias, sums, sums_bias] = [7, 8, 9, 10].map(Recurrent::offset);
        add(&mut self.gradient[sums_bias..sums_bias + 3], 1.0, &of_sums);
        let mut of_hidden = [0.0; HIDDEN];
        for (n, activity) in stated.hidden.into_iter().enumerate().filter(|it| it.1 > 0.0) {
            let from = sums + 3 * n;
            add(&mut self.gradient[from..from + 3], activity, &of_sums);
            of_hidden[n] = dot(&self.model.weights[from..from + 3], &of_sums);
        }
        add(&mut self.gradient[hidden_bias..hidden_bias + HIDDEN], 1.0, &of_hidden);
        let mut of_joined = vec![0.0; JOINED];
        for (n, input) in stated.joined.iter().enumerate() {
            let from = hidden + n * HIDDEN;
            add(&mut self.gradient[from..from + HIDDEN], *input, &of_hidden);
            of_joined[n] = dot(&self.model.weights[from..from + HIDDEN], &of_hidden);
        }
        of_joined
    }

    /// Goes back through the steps of a direction.
    fn back(
        &mut self,
        direction: usize,
        inputs: &[[f32; WIDTH]],
        steps: &[Step],
        of_states: &[[f32; UNITS]],
        of_inputs: &mut [[f32; WIDTH]],
    ) {
        let [of_input, of_state, bias] =
            [1, 2, 3].map(|part| Recurrent::offset(part + 3 * direction));
        let count = steps.len();
        let mut of_next = [0.0; UNITS];
        for n in 0..count {
            let at = if direction == 0 { count - 1 - n } else { n };
            let before = match direction {
                0 => at.checked_sub(1),
                _ => Some(at + 1).filter(|at| *at < count),
            };
            let before = before.map_or([0.0; UNITS], |at| steps[at].state);
            add(&mut of_next, 1.0, &of_states[at]);
            let (sums, recalled, direct) = gates(&steps[at], &before, &of_next);
            add(&mut self.gradient[bias..bias + GATES], 1.0, &sums);
            for (n, input) in inputs[at].iter().enumerate() {
                let from = of_input + n * GATES;
                add(&mut self.gradient[from..from + GATES], *input, &sums);
                of_inputs[at][n] += dot(&self.model.weights[from..from + GATES], &sums);
            }
            for (n, state) in before.iter().enumerate() {
                let from = of_state + n * GATES;
                add(&mut self.gradient[from..from + GATES], *state, &recalled);
                of_next[n] = direct[n] + dot(&self.model.weights[from..from + GATES], &recalled);
            }
        }
    }

    /// One step of Adam at that rate; rows of embeddings without a gradient keep their averages.
    fn step(&mut self, rate: f64) {
        self.touched.sort_unstable();
        self.touched.dedup();
        let rows = std::mem::take(&mut self.touched);
        for row in rows {
            let from = row as usize * WIDTH;
            self.adapt(from..from + WIDTH, rate as f32);
        }
        let dense = EMBEDDINGS * WIDTH..self.gradient.len();
        self.adapt(dense, rate as f32);
    }

    fn adapt(&mut self, range: std::ops::Range<usize>, rate: f32) {
        for n in range {
            let gradient = self.gradient[n] / BATCH as f32;
            self.gradient[n] = 0.0;
            self.mean[n] += (1.0 - STAYS.0) * (gradient - self.mean[n]);
            self.square[n] += (1.0 - STAYS.1) * (gradient * gradient - self.square[n]);
            let weight = &mut self.model.weights[n];
            *weight -= rate * (self.mean[n] / (self.square[n].sqrt() + 1e-6) + SHRINK * *weight);
        }
    }
}

/// The gradients of a step's sums by input and by state, and of the earlier state without gates.
fn gates(
    step: &Step,
    before: &[f32; UNITS],
    of_state: &[f32; UNITS],
) -> ([f32; GATES], [f32; GATES], [f32; UNITS]) {
    let (mut sums, mut direct) = ([0.0; GATES], [0.0; UNITS]);
    let mut recalled = [0.0; GATES];
    for n in 0..UNITS {
        let Step { keep, reset, candidate, .. } = *step;
        let (keep, reset, candidate) = (keep[n], reset[n], candidate[n]);
        let of_candidate = of_state[n] * (1.0 - keep) * (1.0 - candidate * candidate);
        let of_keep = of_state[n] * (before[n] - candidate) * keep * (1.0 - keep);
        let of_reset = of_candidate * step.recalled[n] * reset * (1.0 - reset);
        sums[n] = of_keep;
        sums[UNITS + n] = of_reset;
        sums[2 * UNITS + n] = of_candidate;
        recalled[n] = of_keep;
        recalled[UNITS + n] = of_reset;
        recalled[2 * UNITS + n] = of_candidate * reset;
        direct[n] = of_state[n] * keep;
    }
    (sums, recalled, direct)
}

fn dot(one: &[f32], other: &[f32]) -> f32 {
    // Four sums in a fixed order: they can be computed side by side.
    let mut sums = [0.0_f32; 8];
    let (ones, others) = (one.chunks_exact(8), other.chunks_exact(8));
    let rest = ones.remainder().iter().zip(others.remainder()).map(|(a, b)| a * b).sum::<f32>();
    for (one, other) in ones.zip(others) {
        for n in 0..8 {
            sums[n] += one[n] * other[n];
        }
    }
    sums.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The loss of an utterance of which nothing is hidden.
    fn loss(model: &Recurrent, utterance: &Utterance) -> f64 {
        let all = model.sums(&utterance.sequence).into_iter().zip(&utterance.labels);
        let stated = |sums: [f32; 3]| softmax(sums.map(f64::from));
        all.filter_map(|(sums, label)| Some(-stated(sums)[(*label)?].ln())).sum()
    }

    #[test]
    fn gradient_is_that_of_the_loss() {
        // With one row per element, nothing can be hidden.
        let elements = vec![vec![3], vec![70], vec![500], vec![3]];
        let sequence = Sequence { elements, values: vec![(1, vec![9, 11]), (3, vec![12])] };
        let labels = vec![Some(1), Some(0)];
        let utterance = Utterance { sequence, labels, weight: 1.0 };
        let mut random = Rng::new(5);
        let mut training = Training::new(&mut random);
        training.learn(&utterance, &mut random);
        for (part, size) in PARTS.into_iter().enumerate() {
            let row = if part == 0 { 70 * WIDTH } else { 0 };
            let at = Recurrent::offset(part) + row + size.min(WIDTH) / 2;
            let mut moved = training.model.clone();
            let mut at_distance = |distance: f32| {
                moved.weights[at] = training.model.weights[at] + distance;
                loss(&moved, &utterance)
            };
            let slope = (at_distance(0.01) - at_distance(-0.01)) / 0.02;
            let found = f64::from(training.gradient[at]);
            // The gates' functions have about the slope of the functions that they approximate.
            assert!((slope - found).abs() < 0.02 + 0.15 * slope.abs(), "{part}: {slope} {found}");
        }
    }
}
