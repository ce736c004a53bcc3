//! Rewards: what is paid for an action, as the format lists it.

/// One line of rewards. Where an index is missing, it stands for every one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reward {
    /// The action.
    pub action: Option<u32>,
    /// The state that it starts in.
    pub start: Option<u32>,
    /// The state that it ends in.
    pub end: Option<u32>,
    /// What is observed after it.
    pub observation: Option<u32>,
    /// What is paid, in the problem's own unit.
    pub value: f64,
}

/// The rewards of a problem: of the lines that fit, the last counts; where none fits, 0 is paid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rewards {
    /// The lines, in order.
    pub lines: Vec<Reward>,
}

impl Rewards {
    /// What an action pays in a state, given what it leads to.
    pub fn get(&self, action: usize, start: usize, end: usize, observation: usize) -> f64 {
        let fits = |index: Option<u32>, with: usize| index.is_none_or(|i| i as usize == with);
        let found = self.lines.iter().rev().find(|line| {
            fits(line.action, action)
                && fits(line.start, start)
                && fits(line.end, end)
                && fits(line.observation, observation)
        });
        found.map_or(0.0, |line| line.value)
    }
}
