//! Belief about the name of an object (its class, or a value) from what look after look called it.
//!
//! A look errs in two ways. Noise differs from look to look: other looks outvote it, the more of
//! them the less they disagree. Whatever misleads a camera in its place (light, pose, training)
//! misleads each of its looks alike. What it states for other names then stays; if it states one
//! name alone, at every look, that is believed in the end.

/// Looks that count; earlier ones fade.
const LOOKS_MAX: f64 = 40.0;
/// Share of the errors of one look that the other looks share: `n` looks count as
/// `n / (1 + (n − 1) · COMMON)` independent ones (the design effect), so at most as ten.
const COMMON: f64 = 0.1;
/// Looks beside the observed ones: those with the usual name, and those with another one.
const PRIOR: [f64; 2] = [4.0, 1.0];
/// Looks that a statement of a person, or of a table, counts as.
const STATED: f64 = 10.0;

/// Names with probabilities.
pub(crate) type Chances = Vec<(String, f64)>;

/// Looks that took an object for the same name.
#[derive(Clone, Debug, PartialEq)]
struct Taken {
    name: String,
    /// Sums of the stated probabilities, by name.
    stated: Chances,
    /// Doubt that was stated, which looks do not remove.
    doubt: f64,
}

/// All looks that named an object.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Names {
    /// Number of looks, less what has faded.
    pub(crate) looks: f64,
    taken: Vec<Taken>,
}

impl Names {
    /// What a person, or a table, states: believed as it is.
    pub(crate) fn stated(chances: &Chances) -> Self {
        let mut names = Self::default();
        names.see(chances, STATED);
        let doubt = STATED * (1.0 - sum(chances)).max(0.0);
        names.taken.iter_mut().for_each(|taken| taken.doubt = doubt);
        names
    }

    /// Adds looks that named the object alike. A score is the weight of a look: what it leaves open
    /// says nothing.
    pub(crate) fn see(&mut self, chances: &Chances, looks: f64) {
        self.looks += looks;
        let Some(name) = scene::likeliest(chances) else { return };
        let each = looks / sum(chances).max(1.0);
        let at = self.taken.iter().position(|taken| taken.name == name).unwrap_or_else(|| {
            self.taken.push(Taken { name: name.to_owned(), stated: Vec::new(), doubt: 0.0 });
            self.taken.len() - 1
        });
        let taken = &mut self.taken[at];
        for (name, p) in chances {
            add(&mut taken.stated, name, each * p);
        }
    }

    /// Makes room for another look.
    pub(crate) fn fade(&mut self, is_full: bool) {
        let kept = if is_full { 1.0 - 1.0 / LOOKS_MAX } else { 1.0 };
        self.looks *= kept;
        for taken in &mut self.taken {
            taken.doubt *= kept;
            taken.stated.iter_mut().for_each(|(_, sum)| *sum *= kept);
        }
    }

    /// Whether a further look takes the place of an earlier one.
    pub(crate) fn is_full(&self) -> bool {
        self.looks >= LOOKS_MAX
    }

    /// Returns the probability of each name, of `count` possible ones. The rest, up to 1, is doubt
    /// about all of them alike.
    ///
    /// The camera takes the object for one name `s`, and a look shows another one, each alike, with
    /// a probability `η` that is estimated from the looks: `P(s) ∝ ((1 − η) (count − 1) / η) ^ n_s`.
    /// Given `s`, the probabilities are those that looks with `s` stated on average.
    pub(crate) fn chances(&self, count: usize) -> Chances {
        let weights: Vec<f64> = self.taken.iter().map(|taken| sum(&taken.stated)).collect();
        let all: f64 = weights.iter().sum();
        let most = weights.iter().copied().fold(0.0, f64::max);
        let independent = 1.0 / (1.0 + COMMON * (all - 1.0).max(0.0));
        let noise =
            (PRIOR[1] + independent * (all - most)) / (PRIOR[0] + PRIOR[1] + independent * all);
        let others = count.saturating_sub(1).max(1) as f64;
        let odds = ((1.0 - noise) * others / noise).ln().max(0.0);
        let factor = |weight: f64| (odds * independent * (weight - most)).exp();
        let unseen = count.saturating_sub(weights.len()) as f64 * factor(0.0);
        let total = weights.iter().map(|weight| factor(*weight)).sum::<f64>() + unseen;
        let mut chances = Chances::new();
        for (taken, weight) in self.taken.iter().zip(&weights).filter(|(_, weight)| **weight > 0.0)
        {
            let share = factor(*weight) / total / (weight + taken.doubt);
            for (name, sum) in &taken.stated {
                add(&mut chances, name, share * sum);
            }
        }
        chances
    }
}

fn sum(chances: &Chances) -> f64 {
    chances.iter().map(|(_, p)| p).sum()
}

fn add(chances: &mut Chances, name: &str, p: f64) {
    match chances.iter_mut().find(|(known, _)| known == name) {
        Some((_, own)) => *own += p,
        None => chances.push((name.to_owned(), p)),
    }
}
