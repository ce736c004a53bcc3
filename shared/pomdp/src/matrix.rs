//! Conditional probabilities of one action: a sparse row per state, equal rows held once.

use std::collections::HashMap;

/// The entries of a row that are not zero: column and probability, columns rising.
pub type Row = Vec<(u32, f64)>;

/// A row per state over columns (end states or observations). Two matrices are equal if every
/// entry is, however their rows are shared.
#[derive(Clone, Debug)]
pub struct Matrix {
    columns: usize,
    rows: Vec<Row>,
    /// How many states have each row.
    users: Vec<u32>,
    /// The row of each state.
    of: Vec<u32>,
}

impl PartialEq for Matrix {
    fn eq(&self, other: &Self) -> bool {
        self.columns == other.columns
            && self.states() == other.states()
            && (0..self.states()).all(|state| self.row(state) == other.row(state))
    }
}

impl Matrix {
    /// Every row the same.
    pub fn alike(states: usize, columns: usize, row: Row) -> Self {
        Self { columns, rows: vec![row], users: vec![states as u32], of: vec![0; states] }
    }

    /// Every state goes to itself.
    pub fn identity(states: usize) -> Self {
        Self::of_rows(states, (0..states).map(|state| vec![(state as u32, 1.0)]))
    }

    /// A row per state, in order.
    pub fn of_rows(columns: usize, rows: impl IntoIterator<Item = Row>) -> Self {
        let mut matrix = Self { columns, rows: Vec::new(), users: Vec::new(), of: Vec::new() };
        let mut known = HashMap::new();
        for row in rows {
            let number = *known.entry(bits(&row)).or_insert_with(|| {
                matrix.rows.push(row);
                matrix.users.push(0);
                matrix.rows.len() as u32 - 1
            });
            matrix.users[number as usize] += 1;
            matrix.of.push(number);
        }
        matrix
    }

    /// How many states there are.
    pub fn states(&self) -> usize {
        self.of.len()
    }

    /// How many columns there are.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The entries of a state's row that are not zero.
    pub fn row(&self, state: usize) -> &[(u32, f64)] {
        &self.rows[self.of[state] as usize]
    }

    /// One entry.
    pub fn get(&self, state: usize, column: usize) -> f64 {
        let row = self.row(state);
        row.binary_search_by_key(&(column as u32), |entry| entry.0).map_or(0.0, |at| row[at].1)
    }

    /// Puts a row in the place of a state's, or of every state's.
    pub(crate) fn set_row(&mut self, state: Option<usize>, row: Row) {
        match state {
            None => *self = Self::alike(self.states(), self.columns, row),
            Some(state) => *self.own(state) = row,
        }
    }

    /// Puts one value in the place of an entry; of a whole row or column where one is not named.
    pub(crate) fn set(&mut self, state: Option<usize>, column: Option<usize>, value: f64) {
        let Some(column) = column else {
            let all = (0..self.columns as u32).map(|column| (column, value));
            return self.set_row(state, all.filter(|_| value != 0.0).collect());
        };
        match state {
            None => self.rows.iter_mut().for_each(|row| put(row, column as u32, value)),
            Some(state) => put(self.own(state), column as u32, value),
        }
    }

    /// The state's row, where no other state has it.
    fn own(&mut self, state: usize) -> &mut Row {
        let mut number = self.of[state] as usize;
        if self.users[number] > 1 {
            self.users[number] -= 1;
            self.rows.push(self.rows[number].clone());
            self.users.push(1);
            number = self.rows.len() - 1;
            self.of[state] = number as u32;
        }
        &mut self.rows[number]
    }

    /// The row that most states have; of several the one that is met first.
    pub(crate) fn commonest(&self) -> &[(u32, f64)] {
        let mut counts: HashMap<Vec<(u32, u64)>, (usize, usize)> = HashMap::new();
        for state in 0..self.states() {
            counts.entry(bits(self.row(state))).or_insert((0, state)).0 += 1;
        }
        let most = counts.into_values().max_by_key(|&(count, first)| (count, usize::MAX - first));
        most.map_or(&[], |(_, state)| self.row(state))
    }
}

fn put(row: &mut Row, column: u32, value: f64) {
    match row.binary_search_by_key(&column, |entry| entry.0) {
        Ok(at) if value == 0.0 => drop(row.remove(at)),
        Ok(at) => row[at].1 = value,
        Err(_) if value == 0.0 => {}
        Err(at) => row.insert(at, (column, value)),
    }
}

fn bits(row: &[(u32, f64)]) -> Vec<(u32, u64)> {
    row.iter().map(|(column, value)| (*column, value.to_bits())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_shared_until_one_is_changed() {
        let mut matrix = Matrix::alike(3, 2, vec![(0, 1.0)]);
        matrix.set(Some(1), Some(0), 0.25);
        matrix.set(Some(1), Some(1), 0.75);
        assert_eq!((matrix.row(0), matrix.row(2)), (&[(0, 1.0)][..], &[(0, 1.0)][..]));
        assert_eq!((matrix.get(1, 0), matrix.get(1, 1), matrix.get(0, 1)), (0.25, 0.75, 0.0));
        assert_eq!(matrix.commonest(), &[(0, 1.0)]);
        matrix.set(None, Some(0), 0.0);
        assert_eq!((matrix.row(0), matrix.row(1)), (&[][..], &[(1, 0.75)][..]));
        matrix.set(None, None, 0.5);
        assert_eq!(matrix, Matrix::alike(3, 2, vec![(0, 0.5), (1, 0.5)]));
    }

    #[test]
    fn equality_is_of_entries() {
        let rows = [vec![(0, 1.0)], vec![(1, 1.0)], vec![(2, 1.0)]];
        let mut built = Matrix::alike(3, 3, Vec::new());
        rows.iter().enumerate().for_each(|(s, row)| built.set_row(Some(s), row.clone()));
        assert_eq!(built, Matrix::identity(3));
        built.set(Some(2), Some(0), 1e-300);
        assert_ne!(built, Matrix::identity(3));
    }
}
