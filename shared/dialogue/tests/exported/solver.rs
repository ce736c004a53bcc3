//! Heuristic search value iteration (Smith and Simmons 2005) over the numbers of a POMDP: lower
//! bound from linear functions of the belief, upper bound from points, both exact statements.

use crate::parser::Parsed;

/// A POMDP as dense tables, and bounds on its value function.
pub(crate) struct Solver {
    discount: f64,
    start: Vec<f64>,
    /// `T(s, a, s')·O(s', a, o)` as `[a][o]` lists of `(s, s', p)`.
    steps: Vec<Vec<Vec<(usize, usize, f64)>>>,
    /// Expected reward `[a][s]`.
    reward: Vec<Vec<f64>>,
    /// Values that plans have in every state: each is a plan, so their maximum is a lower bound.
    plans: Vec<Vec<f64>>,
    /// An upper bound in every corner of the beliefs.
    corners: Vec<f64>,
    /// Beliefs with an upper bound below the corners'.
    points: Vec<Point>,
}

/// A belief at which the bound is lower than between the corners.
struct Point {
    belief: Vec<f64>,
    /// How much lower; negative.
    gain: f64,
}

impl Solver {
    pub(crate) fn new(pomdp: &Parsed) -> Self {
        let actions = 0..pomdp.actions.len();
        let states = 0..pomdp.states.len();
        let steps = |a: usize, o: usize| {
            let from = states.clone().flat_map(move |s| {
                let ends = pomdp.transition[a][s].iter().enumerate();
                ends.map(move |(t, p)| (s, t, p * pomdp.observation[a][t][o]))
            });
            from.filter(|(.., p)| *p > 0.0).collect::<Vec<_>>()
        };
        let observations = 0..pomdp.observations.len();
        let mut solver = Self {
            discount: pomdp.discount,
            start: pomdp.start.clone(),
            steps: actions
                .map(|a| {
                    let heard = observations.clone().map(|o| steps(a, o));
                    heard.filter(|steps| !steps.is_empty()).collect()
                })
                .collect(),
            reward: pomdp.reward.clone(),
            plans: Vec::new(),
            corners: Vec::new(),
            points: Vec::new(),
        };
        solver.plans = (0..solver.steps.len()).map(|a| solver.blind(a)).collect();
        solver.corners = solver.informed();
        solver
    }

    /// Searches until the bounds at the start are `gap` apart; returns them.
    pub(crate) fn solve(mut self, gap: f64) -> (f64, f64) {
        let start = self.start.clone();
        for _ in 0..5_000 {
            let bounds = (self.lower(&start), self.upper(&start));
            if bounds.1 - bounds.0 <= gap {
                return bounds;
            }
            self.explore(start.clone(), gap);
        }
        (self.lower(&start), self.upper(&start))
    }

    /// Value of doing the same action for ever.
    fn blind(&self, action: usize) -> Vec<f64> {
        let worst = self.reward[action].iter().copied().fold(0.0, f64::min);
        let mut value = vec![worst / (1.0 - self.discount); self.start.len()];
        // Begins below the value and rises, so that it is a lower bound whenever it stops.
        for _ in 0..3_000 {
            value = self.backed_up(action, |_| &value);
        }
        value
    }

    /// The fast informed bound (Hauskrecht 2000): the state becomes known one step later.
    fn informed(&self) -> Vec<f64> {
        let actions = 0..self.steps.len();
        let best = self.reward.iter().flatten().copied().fold(0.0, f64::max);
        let mut values = vec![vec![best / (1.0 - self.discount); self.start.len()]; actions.len()];
        for _ in 0..3_000 {
            let next = actions.clone().map(|a| {
                let mut value = self.reward[a].clone();
                for steps in &self.steps[a] {
                    for (s, value) in value.iter_mut().enumerate() {
                        let from = steps.iter().filter(|(from, ..)| *from == s);
                        let from: Vec<_> = from.map(|&(_, t, p)| (t, p)).collect();
                        let worth = |v: &Vec<f64>| from.iter().map(|&(t, p)| p * v[t]).sum::<f64>();
                        let most = values.iter().map(worth).fold(f64::NEG_INFINITY, f64::max);
                        *value += self.discount * most;
                    }
                }
                value
            });
            let next: Vec<Vec<f64>> = next.collect();
            let moved = next.iter().flatten().zip(values.iter().flatten());
            let still = moved.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-9;
            values = next;
            if still {
                break;
            }
        }
        (0..self.start.len())
            .map(|s| values.iter().map(|v| v[s]).fold(f64::NEG_INFINITY, f64::max))
            .collect()
    }

    /// Value of an action with a plan for each observation.
    fn backed_up<'a>(&self, action: usize, plan: impl Fn(usize) -> &'a Vec<f64>) -> Vec<f64> {
        let mut value = self.reward[action].clone();
        for (o, steps) in self.steps[action].iter().enumerate() {
            let plan = plan(o);
            steps.iter().for_each(|&(s, t, p)| value[s] += self.discount * p * plan[t]);
        }
        value
    }

    fn lower(&self, belief: &[f64]) -> f64 {
        dot(belief, self.best_plan(belief))
    }

    fn best_plan(&self, belief: &[f64]) -> &Vec<f64> {
        let worth = |plan: &Vec<f64>| dot(belief, plan);
        self.plans.iter().max_by(|a, b| worth(a).total_cmp(&worth(b))).unwrap()
    }

    /// The least of the sawtooth functions: between corners and one point, the bound is linear.
    fn upper(&self, belief: &[f64]) -> f64 {
        let corners = dot(belief, &self.corners);
        let mut least = 0.0_f64;
        for point in &self.points {
            let mut ratio = 1.0_f64;
            for (p, b) in point.belief.iter().zip(belief) {
                if *p > 0.0 {
                    ratio = ratio.min(b / p);
                }
                // It only gets nearer to nothing.
                if ratio * point.gain >= least {
                    break;
                }
            }
            least = least.min(ratio * point.gain);
        }
        corners + least
    }

    /// The beliefs after an action, with their probabilities.
    fn after(&self, belief: &[f64], action: usize) -> Vec<(f64, Vec<f64>)> {
        let heard = self.steps[action].iter().map(|steps| {
            let mut next = vec![0.0; belief.len()];
            steps.iter().for_each(|&(s, t, p)| next[t] += belief[s] * p);
            let sum: f64 = next.iter().sum();
            next.iter_mut().for_each(|p| *p /= sum.max(f64::MIN_POSITIVE));
            (sum, next)
        });
        heard.filter(|(p, _)| *p > 0.0).collect()
    }

    fn hope(&self, belief: &[f64], action: usize) -> f64 {
        let after = self.after(belief, action);
        let after: f64 = after.iter().map(|(p, next)| p * self.upper(next)).sum();
        dot(belief, &self.reward[action]) + self.discount * after
    }

    /// Goes down along the most hopeful actions and the most doubtful observations, and tightens
    /// both bounds on the way back.
    fn explore(&mut self, start: Vec<f64>, gap: f64) {
        let mut path = vec![start];
        let mut allowed = gap;
        loop {
            let belief = path.last().unwrap();
            if self.upper(belief) - self.lower(belief) <= allowed || path.len() > 40 {
                break;
            }
            let hopes = (0..self.steps.len()).map(|a| (a, self.hope(belief, a)));
            let (action, _) = hopes.reduce(|a, b| if b.1 > a.1 { b } else { a }).unwrap();
            allowed /= self.discount;
            let doubt =
                |(p, next): &(f64, Vec<f64>)| p * (self.upper(next) - self.lower(next) - allowed);
            let after = self.after(belief, action).into_iter();
            let next = after.map(|next| (doubt(&next), next.1));
            path.push(next.reduce(|a, b| if b.0 > a.0 { b } else { a }).unwrap().1);
        }
        path.into_iter().rev().for_each(|belief| self.tighten(belief));
    }

    fn tighten(&mut self, belief: Vec<f64>) {
        let actions = 0..self.steps.len();
        let plan = |a: usize| {
            let best: Vec<&Vec<f64>> = (self.steps[a].iter())
                .map(|steps| {
                    let mut next = vec![0.0; belief.len()];
                    steps.iter().for_each(|&(s, t, p)| next[t] += belief[s] * p);
                    self.best_plan(&next)
                })
                .collect();
            self.backed_up(a, |o| best[o])
        };
        let worth = |plan: &Vec<f64>| dot(&belief, plan);
        let plans = actions.clone().map(plan);
        let plan = plans.max_by(|a, b| worth(a).total_cmp(&worth(b))).unwrap();
        let hope = actions.map(|a| self.hope(&belief, a)).fold(f64::NEG_INFINITY, f64::max);
        if dot(&belief, &plan) > self.lower(&belief) {
            self.plans.retain(|old| old.iter().zip(&plan).any(|(old, new)| old > new));
            self.plans.push(plan);
        }
        if hope < self.upper(&belief) {
            let gain = hope - dot(&belief, &self.corners);
            let near = |a: &[f64]| a.iter().zip(&belief).all(|(a, b)| (a - b).abs() < 1e-12);
            self.points.retain(|point| !near(&point.belief));
            self.points.push(Point { belief, gain });
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
