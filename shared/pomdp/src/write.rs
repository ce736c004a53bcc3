//! The writer. Numbers are printed with as many digits as it takes to read the same ones back.

use std::fmt::Write;

use crate::{Matrix, Pomdp, Reward, Values};

impl Pomdp {
    /// The problem as text, below `comment`, whose lines are set behind `#`.
    ///
    /// [`Pomdp::parse`] reads an equal problem from it.
    pub fn write(&self, comment: &str) -> String {
        let mut text = String::new();
        for line in comment.lines() {
            let printable = line.chars().map(|c| if c.is_control() { ' ' } else { c });
            text += "# ";
            text.extend(printable);
            text.truncate(text.trim_end().len());
            text.push('\n');
        }
        self.write_preamble(&mut text);
        for (action, matrix) in self.actions.iter().zip(&self.transition) {
            let identity = *matrix == Matrix::identity(self.states.len());
            if identity {
                let _ = writeln!(text, "T: {action}\nidentity");
            } else {
                self.write_matrix(&mut text, "T", action, matrix, &self.states);
            }
        }
        text.push('\n');
        for (action, matrix) in self.actions.iter().zip(&self.observation) {
            self.write_matrix(&mut text, "O", action, matrix, &self.observations);
        }
        text.push('\n');
        self.reward.lines.iter().for_each(|line| self.write_reward(&mut text, line));
        text
    }

    fn write_preamble(&self, text: &mut String) {
        let values = match self.values {
            Values::Reward => "reward",
            Values::Cost => "cost",
        };
        let _ = writeln!(text, "discount: {:?}\nvalues: {values}", self.discount);
        let lists = [
            ("states", &self.states),
            ("actions", &self.actions),
            ("observations", &self.observations),
        ];
        for (key, names) in lists {
            let numbered = names.first().is_some_and(|name| name == "0");
            let list = if numbered { names.len().to_string() } else { names.join(" ") };
            let _ = writeln!(text, "{key}: {list}");
        }
        let start: Vec<String> = self.start.iter().map(|p| format!("{p:?}")).collect();
        let _ = writeln!(text, "start: {}\n", start.join(" "));
    }

    /// The commonest row for every state, then what differs from it.
    fn write_matrix(
        &self,
        text: &mut String,
        key: &str,
        action: &str,
        matrix: &Matrix,
        columns: &[String],
    ) {
        let common = matrix.commonest();
        let mut line = |state: &str, column: u32, value: f64| {
            let column = &columns[column as usize];
            let _ = writeln!(text, "{key}: {action} : {state} : {column} {value:?}");
        };
        common.iter().for_each(|&(column, value)| line("*", column, value));
        for (state, name) in self.states.iter().enumerate() {
            let row = matrix.row(state);
            let changed = row.iter().filter(|entry| !common.contains(entry));
            changed.for_each(|&(column, value)| line(name, column, value));
            let gone = common.iter().filter(|(column, _)| row.iter().all(|(c, _)| c != column));
            gone.for_each(|&(column, _)| line(name, column, 0.0));
        }
    }

    fn write_reward(&self, text: &mut String, line: &Reward) {
        let name = |index: Option<u32>, names: &[String]| {
            index.map_or_else(|| "*".to_owned(), |index| names[index as usize].clone())
        };
        let _ = writeln!(
            text,
            "R: {} : {} : {} : {} {:?}",
            name(line.action, &self.actions),
            name(line.start, &self.states),
            name(line.end, &self.states),
            name(line.observation, &self.observations),
            line.value
        );
    }
}
