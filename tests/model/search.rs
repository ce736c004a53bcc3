//! Breadth-first search over all interleavings, with the shortest way to a violation.

use std::collections::HashMap;
use std::hash::Hash;

/// A system that is searched.
pub(crate) trait System {
    /// Everything about it at one moment.
    type State: Clone + Eq + Hash;
    /// One step, for the counterexample; `true` with the successor for a fault.
    type Step: Clone + std::fmt::Debug;

    /// Calls `visit` with every successor.
    fn successors(&self, state: &Self::State, visit: &mut dyn FnMut(Self::Step, Self::State));
    /// Returns whether a step is a fault: progress must not depend on it.
    fn is_fault(step: &Self::Step) -> bool;
    /// Returns the invariant that the state breaks.
    fn broken(state: &Self::State) -> Option<&'static str>;
    /// Returns whether everything wanted has been reached.
    fn is_done(&self, state: &Self::State) -> bool;
}

/// What a search found.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    /// Number of different states.
    pub(crate) states: usize,
    /// Steps of the longest shortest way to a state.
    pub(crate) depth: usize,
    /// A broken invariant with the shortest way to it.
    pub(crate) violation: Option<(String, Vec<String>)>,
}

struct Node<S: System> {
    from: u32,
    step: Option<S::Step>,
    depth: u32,
}

/// Visits every state that can be reached from `first`, or up to the first violation.
///
/// Besides the invariants it checks progress: from every state the end can be reached without any
/// further fault.
pub(crate) fn search<S: System>(system: &S, first: S::State) -> Found {
    let mut known = HashMap::from([(first.clone(), 0_u32)]);
    let mut states = vec![first];
    let mut nodes: Vec<Node<S>> = vec![Node { from: 0, step: None, depth: 0 }];
    let mut back: Vec<(u32, u32)> = Vec::new();
    let mut at = 0;
    while at < states.len() {
        let state = states[at].clone();
        if let Some(broken) = S::broken(&state) {
            return found(&nodes, at, Some(broken));
        }
        let (from, depth) = (at as u32, nodes[at].depth + 1);
        system.successors(&state, &mut |step, next| {
            let to = *known.entry(next).or_insert_with_key(|next| {
                states.push(next.clone());
                nodes.push(Node { from, step: Some(step.clone()), depth });
                (states.len() - 1) as u32
            });
            if to != from && !S::is_fault(&step) {
                back.push((to, from));
            }
        });
        at += 1;
    }
    match stuck(system, &states, back) {
        Some(at) => found(&nodes, at, Some("progress: the end cannot be reached any more")),
        None => found(&nodes, states.len() - 1, None),
    }
}

/// Returns the first state from which the end cannot be reached without a fault.
fn stuck<S: System>(system: &S, states: &[S::State], mut back: Vec<(u32, u32)>) -> Option<usize> {
    back.sort_unstable();
    let mut live: Vec<bool> = states.iter().map(|state| system.is_done(state)).collect();
    let mut queue: Vec<u32> = (0..states.len() as u32).filter(|at| live[*at as usize]).collect();
    while let Some(to) = queue.pop() {
        let first = back.partition_point(|(end, _)| *end < to);
        for (_, from) in back[first..].iter().take_while(|(end, _)| *end == to) {
            if !std::mem::replace(&mut live[*from as usize], true) {
                queue.push(*from);
            }
        }
    }
    live.iter().position(|live| !live)
}

fn found<S: System>(nodes: &[Node<S>], at: usize, broken: Option<&str>) -> Found {
    let violation = broken.map(|broken| {
        let mut way = Vec::new();
        let mut at = at;
        while let Some(step) = &nodes[at].step {
            way.push(format!("{step:?}"));
            at = nodes[at].from as usize;
        }
        way.reverse();
        (broken.to_owned(), way)
    });
    let depth = nodes.iter().map(|node| node.depth).max().unwrap_or(0) as usize;
    Found { states: nodes.len(), depth, violation }
}
