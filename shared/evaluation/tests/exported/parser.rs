//! A strict parser of the forms of the `.pomdp` format that the export uses.

use std::collections::HashMap;

/// A POMDP as dense tables.
pub(crate) struct Parsed {
    pub(crate) discount: f64,
    pub(crate) states: Vec<String>,
    pub(crate) actions: Vec<String>,
    pub(crate) observations: Vec<String>,
    pub(crate) start: Vec<f64>,
    /// `T(s, a, s')` as `[a][s][s']`.
    pub(crate) transition: Vec<Vec<Vec<f64>>>,
    /// `O(s', a, o)` as `[a][s'][o]`.
    pub(crate) observation: Vec<Vec<Vec<f64>>>,
    /// `R(s, a)` as `[a][s]`: its expectation if it depends on `s'`.
    pub(crate) reward: Vec<Vec<f64>>,
}

/// Names of one list with their numbers.
struct Names(HashMap<String, usize>);

impl Names {
    fn new(names: &[String]) -> Self {
        for name in names {
            let letters = name.bytes().all(|b| b.is_ascii_alphanumeric() || b"_-".contains(&b));
            let reserved = ["T", "O", "R", "uniform", "identity", "reset", "start"];
            assert!(letters && name.as_bytes()[0].is_ascii_alphabetic(), "{name}");
            assert!(!reserved.contains(&&**name), "{name}");
        }
        let by_name: HashMap<_, _> = names.iter().cloned().zip(0..).collect();
        assert_eq!(by_name.len(), names.len(), "names are distinct: {names:?}");
        Self(by_name)
    }

    /// The numbers denoted by a name or `*`.
    fn all(&self, name: &str) -> Vec<usize> {
        if name == "*" { (0..self.0.len()).collect() } else { vec![self.0[name]] }
    }
}

fn after<'a>(lines: &mut impl Iterator<Item = &'a str>, key: &str) -> Vec<String> {
    let line = lines.next().unwrap();
    let rest = line.strip_prefix(&format!("{key}: ")).unwrap_or_else(|| panic!("{key}: {line}"));
    rest.split(' ').map(str::to_owned).collect()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// Reads the text.
///
/// # Panics
/// If it is not in the format, or if a row of probabilities does not sum to one.
pub(crate) fn parse(text: &str) -> Parsed {
    let lines = text.lines().map(|line| line.split('#').next().unwrap().trim());
    let mut lines = lines.filter(|line| !line.is_empty());
    let discount = number(&after(&mut lines, "discount")[0]);
    assert_eq!(after(&mut lines, "values"), ["reward"]);
    let [states, actions, observations] =
        ["states", "actions", "observations"].map(|key| after(&mut lines, key));
    let start: Vec<f64> = after(&mut lines, "start").iter().map(|p| number(p)).collect();
    let (by_state, by_action) = (Names::new(&states), Names::new(&actions));
    let by_observation = Names::new(&observations);
    let table = |columns: usize| vec![vec![vec![0.0_f64; columns]; states.len()]; actions.len()];
    let (mut transition, mut observation) = (table(states.len()), table(observations.len()));
    let mut rewards = table(states.len());
    while let Some(line) = lines.next() {
        let (key, rest) = line.split_once(": ").unwrap();
        let parts: Vec<&str> = rest.split(" : ").collect();
        let chosen = by_action.all(parts[0]);
        let last = |part: usize| {
            let (name, value) = parts[part].split_once(' ').unwrap();
            (name, number(value))
        };
        match (key, parts.len()) {
            ("T", 1) => {
                assert_eq!(lines.next(), Some("identity"));
                for a in chosen {
                    (0..states.len()).for_each(|s| transition[a][s][s] = 1.0);
                }
            }
            ("T" | "O", 3) => {
                let (name, p) = last(2);
                assert!((0.0..=1.0).contains(&p), "{line}");
                let (tables, columns) = match key {
                    "T" => (&mut transition, by_state.all(name)),
                    _ => (&mut observation, by_observation.all(name)),
                };
                for a in chosen {
                    for s in by_state.all(parts[1]) {
                        columns.iter().for_each(|&column| tables[a][s][column] = p);
                    }
                }
            }
            ("R", 4) => {
                let (name, value) = last(3);
                assert_eq!(name, "*", "{line}");
                for a in chosen {
                    for s in by_state.all(parts[1]) {
                        by_state.all(parts[2]).into_iter().for_each(|to| rewards[a][s][to] = value);
                    }
                }
            }
            _ => panic!("not an entry: {line}"),
        }
    }
    let rows = transition.iter().chain(&observation).flatten().chain([&start]);
    for row in rows {
        let sum: f64 = row.iter().sum();
        assert!((sum - 1.0).abs() < 1e-5, "a row sums to {sum}");
    }
    let expected = |(paid, reached): (&Vec<f64>, &Vec<f64>)| {
        paid.iter().zip(reached).filter(|(_, p)| **p > 0.0).map(|(r, p)| r * p).sum()
    };
    let reward = rewards.iter().zip(&transition);
    let reward = reward.map(|(paid, reached)| paid.iter().zip(reached).map(expected).collect());
    let reward = reward.collect();
    Parsed { discount, states, actions, observations, start, transition, observation, reward }
}
