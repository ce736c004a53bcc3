//! What comes before the entries: discount, sign, names, and the belief at the start.

use std::collections::HashSet;

use super::entries::{Names, index};
use super::{ParseError, Reader, SUM_TOLERANCE, Token};
use crate::{Matrix, PAIRS_MAX, Pomdp, Rewards, Start, Values};

/// What the preamble must say.
const KEYS: [&str; 5] = ["discount", "values", "states", "actions", "observations"];

/// Words of the format itself, which cannot name anything.
const RESERVED: [&str; 16] = [
    "discount",
    "values",
    "states",
    "actions",
    "observations",
    "T",
    "O",
    "R",
    "uniform",
    "identity",
    "reward",
    "cost",
    "start",
    "include",
    "exclude",
    "reset",
];

/// Reads it, and makes a problem without entries.
pub(super) fn read(reader: &mut Reader<'_>) -> Result<Pomdp, ParseError> {
    let (mut discount, mut values) = (None, None);
    let (mut states, mut actions, mut observations) = (None, None, None);
    while let Token::Word(key) = reader.peek()
        && KEYS.contains(&key)
    {
        let line = reader.line();
        reader.take();
        reader.colon()?;
        let again = match key {
            "discount" => discount.replace(read_discount(reader)?).is_some(),
            "values" => values.replace(read_values(reader)?).is_some(),
            "states" => states.replace(names(reader, "state")?).is_some(),
            "actions" => actions.replace(names(reader, "action")?).is_some(),
            _ => observations.replace(names(reader, "observation")?).is_some(),
        };
        if again {
            let what = format!("{key} is there twice");
            return Err(ParseError::new(line, what, "keep one of them"));
        }
    }
    let states: Vec<String> = required(reader, states, "states")?;
    let actions = required(reader, actions, "actions")?;
    let observations: Vec<String> = required(reader, observations, "observations")?;
    if states.len().saturating_mul(actions.len()) > PAIRS_MAX {
        let what = format!("{} states and {} actions are too many", states.len(), actions.len());
        return reader.error(what, format!("at most {PAIRS_MAX} pairs of them can be read"));
    }
    let none =
        |columns: usize| vec![Matrix::alike(states.len(), columns, Vec::new()); actions.len()];
    Ok(Pomdp {
        discount: required(reader, discount, "discount")?,
        values: required(reader, values, "values")?,
        start: read_start(reader, &states)?,
        transition: none(states.len()),
        observation: none(observations.len()),
        reward: Rewards::default(),
        states,
        actions,
        observations,
    })
}

fn required<T>(reader: &Reader<'_>, value: Option<T>, key: &str) -> Result<T, ParseError> {
    value.map_or_else(
        || reader.error(format!("{key} is missing"), format!("write \"{key}: …\" before this")),
        Ok,
    )
}

fn read_discount(reader: &mut Reader<'_>) -> Result<f64, ParseError> {
    reader.probability()
}

fn read_values(reader: &mut Reader<'_>) -> Result<Values, ParseError> {
    if reader.word("reward") {
        return Ok(Values::Reward);
    }
    if reader.word("cost") {
        return Ok(Values::Cost);
    }
    reader.unexpected("\"reward\" or \"cost\"")
}

/// A count, or names.
fn names(reader: &mut Reader<'_>, what: &str) -> Result<Vec<String>, ParseError> {
    if let Token::Count(count) = reader.peek() {
        if !(1..=PAIRS_MAX).contains(&count) {
            return reader.error(format!("{count} is no number of {what}s"), "use 1 or more");
        }
        reader.take();
        return Ok((0..count).map(|number| number.to_string()).collect());
    }
    let mut names = Vec::new();
    let mut known = HashSet::new();
    // A list ends where the next key begins: keys are reserved.
    while let Token::Word(name) = reader.peek()
        && !RESERVED.contains(&name)
    {
        if !known.insert(name) {
            return reader.error(format!("{what} \"{name}\" is there twice"), "rename one");
        }
        names.push(name.to_owned());
        reader.take();
    }
    if names.is_empty() {
        return reader.unexpected(&format!("a number of {what}s or a name that is not reserved"));
    }
    Ok(names)
}

fn read_start(reader: &mut Reader<'_>, states: &[String]) -> Result<Start, ParseError> {
    let among = |chosen: &dyn Fn(usize) -> bool| -> Start {
        let count = (0..states.len()).filter(|state| chosen(*state)).count();
        let p = |state| if chosen(state) { 1.0 / count as f64 } else { 0.0 };
        (0..states.len()).map(p).collect()
    };
    if !reader.word("start") {
        return Ok(among(&|_| true));
    }
    let names = Names::new("state", states);
    let include = reader.word("include");
    let exclude = !include && reader.word("exclude");
    reader.colon()?;
    if include || exclude {
        let line = reader.line();
        let named = state_list(reader, &names)?;
        if exclude && named.len() == states.len() {
            return Err(ParseError::new(line, "no state is left to start in", "exclude fewer"));
        }
        return Ok(among(&|state| named.contains(&state) == include));
    }
    if reader.word("uniform") {
        return Ok(among(&|_| true));
    }
    // A single number is a state's, unless it is the only state's probability.
    let single = matches!(reader.peek(), Token::Word(_))
        || (matches!(reader.peek(), Token::Count(_)) && !number_follows(reader));
    if single && states.len() > 1 {
        let only = index(reader, &names)?;
        return Ok(among(&|state| state == only));
    }
    let line = reader.line();
    let start: Start = states.iter().map(|_| reader.probability()).collect::<Result<_, _>>()?;
    let sum: f64 = start.iter().sum();
    if (sum - 1.0).abs() > SUM_TOLERANCE {
        let what = format!("the belief at the start sums to {sum}");
        return Err(ParseError::new(line, what, "give probabilities that sum to 1"));
    }
    Ok(start)
}

fn number_follows(reader: &Reader<'_>) -> bool {
    let after = reader.tokens.get(reader.next + 1).map(|(_, token)| token);
    matches!(after, Some(Token::Count(_) | Token::Number(_)))
}

fn state_list(reader: &mut Reader<'_>, names: &Names) -> Result<HashSet<usize>, ParseError> {
    let mut named = HashSet::new();
    loop {
        named.insert(index(reader, names)?);
        let more = match reader.peek() {
            Token::Count(_) => true,
            Token::Word(word) => !RESERVED.contains(&word),
            _ => false,
        };
        if !more {
            return Ok(named);
        }
    }
}
