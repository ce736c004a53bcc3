//! `whichone token`: the tokens of programs.

use std::collections::BTreeSet;

use clap::{Args, Subcommand};
use command_line::Outcome;
use command_line::output::{Output, note, table};
use roster::Name;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};
use service::folders::make_private;
use service::group::GroupPaths;
use web_server::sessions::unix_s;

use crate::tokens::{self, Right, Tokens, tokens_file};
use crate::uses::{self, uses_file};

/// Rights of a new token, unless its maker says otherwise.
const USUAL: [Right; 3] = [Right::See, Right::Talk, Right::Stop];

/// Arguments of `token`.
#[derive(Debug, Args)]
pub struct TokenArgs {
    /// What to do; `list` by default.
    #[command(subcommand)]
    what: Option<TokenVerb>,
}

/// What `token` does.
#[derive(Debug, Subcommand)]
enum TokenVerb {
    /// Make a token and print its secret, once; or change the rights of one, which keeps its secret.
    Add {
        /// Name of the token, e.g. of the program: 1 to 32 of a–z 0–9 -.
        name: Name,
        /// What it may do; by default see, talk and stop.
        #[arg(long, value_name = "RIGHTS", value_enum, value_delimiter = ',')]
        may: Option<Vec<Right>>,
        /// Replace the secret: programs that have the former one are refused.
        #[arg(long)]
        renew: bool,
    },
    /// List the tokens with their rights and their last use.
    List,
    /// Revoke a token: its next request is refused.
    Revoke {
        /// Name of the token.
        name: Name,
    },
}

/// Makes, lists or revokes tokens of a group, whether it runs or not.
///
/// # Errors
/// The file of the tokens cannot be read or written, or a name is unknown.
pub fn token(paths: &GroupPaths, args: &TokenArgs, out: &mut Output<'_>) -> Outcome {
    let path = tokens_file(paths);
    match args.what.as_ref().unwrap_or(&TokenVerb::List) {
        TokenVerb::Add { name, may, renew } => add(paths, name, may.as_deref(), *renew, out),
        TokenVerb::List => list(paths, &Tokens::load(&path)?, out),
        TokenVerb::Revoke { name } => {
            tokens::revoke(&path, name)?;
            match out.is_json() {
                true => out.json(&json!({ "revoked": name }))?,
                false => out.line(format_args!("{name}: revoked"))?,
            }
            Ok(Exit::Ok)
        }
    }
}

fn add(
    paths: &GroupPaths,
    name: &Name,
    may: Option<&[Right]>,
    renew: bool,
    out: &mut Output<'_>,
) -> Outcome {
    let (root, path) = (paths.root(), tokens_file(paths));
    make_private(root).map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
    let known = Tokens::load(&path)?;
    let known = known.iter().find(|(known, _)| *known == name).map(|(_, token)| token.may.clone());
    let chosen = may.map(|may| may.iter().copied().collect::<BTreeSet<_>>());
    let may = chosen.or(known).unwrap_or_else(|| USUAL.into());
    let secret = tokens::add(&path, name, may.clone(), renew, unix_s())?;
    if out.is_json() {
        out.json(&json!({ "name": name, "may": may, "token": secret }))?;
        return Ok(Exit::Ok);
    }
    let Some(secret) = secret else {
        out.line(format_args!("{name}: may {}; the secret stays", words(&may)))?;
        return Ok(Exit::Ok);
    };
    out.line(&secret)?;
    note(format_args!("the token {name} may {}; it is shown this once", words(&may)));
    Ok(Exit::Ok)
}

fn list(paths: &GroupPaths, tokens: &Tokens, out: &mut Output<'_>) -> Outcome {
    let uses = uses::read(&uses_file(paths));
    if out.is_json() {
        let one = |(name, token): (&Name, &tokens::Token)| {
            json!({ "name": name, "may": token.may, "made_s": token.made_s,
                    "used_s": uses.get(name.as_str()) })
        };
        out.json(&json!({ "tokens": tokens.iter().map(one).collect::<Json>() }))?;
        return Ok(Exit::Ok);
    }
    let row = |(name, token): (&Name, &tokens::Token)| {
        let used = uses.get(name.as_str());
        let used = used.map_or("never".to_owned(), |used_s| age(unix_s().saturating_sub(*used_s)));
        vec![name.to_string(), words(&token.may), used]
    };
    let rows: Vec<Vec<String>> = tokens.iter().map(row).collect();
    if rows.is_empty() {
        out.line("no tokens; help: `whichone token add NAME`")?;
        return Ok(Exit::Ok);
    }
    table(&["token", "may", "last use"], &rows).into_iter().try_for_each(|line| out.line(line))?;
    Ok(Exit::Ok)
}

fn words(may: &BTreeSet<Right>) -> String {
    if may.is_empty() {
        return "nothing".to_owned();
    }
    may.iter().map(|right| right.word()).collect::<Vec<_>>().join(", ")
}

/// A time that is noted to the minute.
fn age(seconds: u64) -> String {
    match seconds {
        0..120 => "a moment ago".to_owned(),
        120..7_200 => format!("{} min ago", seconds / 60),
        7_200..172_800 => format!("{} h ago", seconds / 3_600),
        _ => format!("{} days ago", seconds / 86_400),
    }
}
