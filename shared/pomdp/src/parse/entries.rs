//! The entries of `T`, `O` and `R`.

use std::collections::HashMap;

use super::{ParseError, Reader, Token};
use crate::{Matrix, Pomdp, Reward, Row};

/// What can be named in a place, by its name.
pub(super) struct Names {
    what: &'static str,
    by_name: HashMap<String, usize>,
}

impl Names {
    pub(super) fn new(what: &'static str, names: &[String]) -> Self {
        let by_name = names.iter().cloned().zip(0..).collect();
        Self { what, by_name }
    }
}

/// What the entries of a problem can name.
struct Scope {
    states: Names,
    actions: Names,
    observations: Names,
}

/// Reads all that follow.
pub(super) fn read(reader: &mut Reader<'_>, pomdp: &mut Pomdp) -> Result<(), ParseError> {
    let scope = Scope {
        states: Names::new("state", &pomdp.states),
        actions: Names::new("action", &pomdp.actions),
        observations: Names::new("observation", &pomdp.observations),
    };
    loop {
        let key = match reader.peek() {
            Token::End => return Ok(()),
            Token::Word(key @ ("T" | "O" | "R")) => key,
            _ => return reader.unexpected("T, O or R"),
        };
        reader.take();
        reader.colon()?;
        match key {
            "T" => transition(reader, &scope, pomdp)?,
            "O" => observation(reader, &scope, pomdp)?,
            _ => reward(reader, &scope, pomdp)?,
        }
    }
}

/// The number of what is named next.
pub(super) fn index(reader: &mut Reader<'_>, names: &Names) -> Result<usize, ParseError> {
    let (what, count) = (names.what, names.by_name.len());
    let found = match reader.peek() {
        Token::Word(name) => names.by_name.get(name).copied(),
        Token::Count(number) => Some(number).filter(|number| *number < count),
        _ => return reader.unexpected(&format!("the {what}")),
    };
    let Some(found) = found else {
        let told = format!("there is no {what} {}", reader.peek());
        return reader.error(told, format!("name one of the {count} {what}s"));
    };
    reader.take();
    Ok(found)
}

/// The same where `*` may stand.
fn any(reader: &mut Reader<'_>, names: &Names) -> Result<Option<usize>, ParseError> {
    if reader.peek() == Token::Star {
        reader.take();
        return Ok(None);
    }
    index(reader, names).map(Some)
}

/// Whether the entry goes on with another index.
fn goes_on(reader: &mut Reader<'_>) -> bool {
    let colon = reader.peek() == Token::Colon;
    if colon {
        reader.take();
    }
    colon
}

fn transition(reader: &mut Reader<'_>, scope: &Scope, pomdp: &mut Pomdp) -> Result<(), ParseError> {
    let action = any(reader, &scope.actions)?;
    let states = pomdp.states.len();
    if !goes_on(reader) {
        if reader.word("identity") {
            each(&mut pomdp.transition, action, |matrix| *matrix = Matrix::identity(states));
            return Ok(());
        }
        return matrix(reader, &mut pomdp.transition, action);
    }
    let state = any(reader, &scope.states)?;
    if goes_on(reader) {
        let end = any(reader, &scope.states)?;
        let p = reader.probability()?;
        each(&mut pomdp.transition, action, |matrix| matrix.set(state, end, p));
        return Ok(());
    }
    let row = if reader.word("reset") {
        sparse(pomdp.start.iter().copied())
    } else {
        row(reader, states)?
    };
    each(&mut pomdp.transition, action, |matrix| matrix.set_row(state, row.clone()));
    Ok(())
}

fn observation(
    reader: &mut Reader<'_>,
    scope: &Scope,
    pomdp: &mut Pomdp,
) -> Result<(), ParseError> {
    let action = any(reader, &scope.actions)?;
    if !goes_on(reader) {
        return matrix(reader, &mut pomdp.observation, action);
    }
    let end = any(reader, &scope.states)?;
    if goes_on(reader) {
        let seen = any(reader, &scope.observations)?;
        let p = reader.probability()?;
        each(&mut pomdp.observation, action, |matrix| matrix.set(end, seen, p));
        return Ok(());
    }
    let row = row(reader, pomdp.observations.len())?;
    each(&mut pomdp.observation, action, |matrix| matrix.set_row(end, row.clone()));
    Ok(())
}

fn reward(reader: &mut Reader<'_>, scope: &Scope, pomdp: &mut Pomdp) -> Result<(), ParseError> {
    let (ends, seen) = (pomdp.states.len() as u32, pomdp.observations.len() as u32);
    let number = |index: Option<usize>| index.map(|index| index as u32);
    let action = number(any(reader, &scope.actions)?);
    reader.colon()?;
    let start = number(any(reader, &scope.states)?);
    let line = Reward { action, start, end: None, observation: None, value: 0.0 };
    let mut add = |line| pomdp.reward.lines.push(line);
    if !goes_on(reader) {
        for end in 0..ends {
            for observation in 0..seen {
                let value = reader.number()?;
                add(Reward { end: Some(end), observation: Some(observation), value, ..line });
            }
        }
        return Ok(());
    }
    let end = number(any(reader, &scope.states)?);
    if goes_on(reader) {
        let observation = number(any(reader, &scope.observations)?);
        add(Reward { end, observation, value: reader.number()?, ..line });
        return Ok(());
    }
    for observation in 0..seen {
        add(Reward { end, observation: Some(observation), value: reader.number()?, ..line });
    }
    Ok(())
}

fn each(matrices: &mut [Matrix], action: Option<usize>, change: impl Fn(&mut Matrix)) {
    match action {
        Some(action) => change(&mut matrices[action]),
        None => matrices.iter_mut().for_each(change),
    }
}

fn matrix(
    reader: &mut Reader<'_>,
    matrices: &mut [Matrix],
    action: Option<usize>,
) -> Result<(), ParseError> {
    let (states, columns) = (matrices[0].states(), matrices[0].columns());
    let read = if reader.peek() == Token::Word("uniform") {
        Matrix::alike(states, columns, row(reader, columns)?)
    } else {
        let rows: Vec<Row> =
            (0..states).map(|_| row_of_numbers(reader, columns)).collect::<Result<_, _>>()?;
        Matrix::of_rows(columns, rows)
    };
    each(matrices, action, |matrix| matrix.clone_from(&read));
    Ok(())
}

fn row(reader: &mut Reader<'_>, columns: usize) -> Result<Row, ParseError> {
    if reader.word("uniform") {
        return Ok((0..columns as u32).map(|column| (column, 1.0 / columns as f64)).collect());
    }
    row_of_numbers(reader, columns)
}

fn row_of_numbers(reader: &mut Reader<'_>, columns: usize) -> Result<Row, ParseError> {
    let numbers: Vec<f64> = (0..columns).map(|_| reader.probability()).collect::<Result<_, _>>()?;
    Ok(sparse(numbers))
}

fn sparse(numbers: impl IntoIterator<Item = f64>) -> Row {
    let numbered = (0..).zip(numbers);
    numbered.filter(|(_, number)| *number != 0.0).collect()
}
