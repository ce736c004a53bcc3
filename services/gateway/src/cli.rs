//! The command line: `whichone gateway …`.

use std::io::Write;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use roster::Name;
use service::exit::{Exit, Failure};
use service::folders::make_private;
use service::group::GroupName;
use service::json_schema::with_schema;

use crate::access::Address;
use crate::people::{self, EVERY_ROBOT, People};
use crate::{Options, serve};

/// File with the address of a gateway that runs or ran.
const ADDRESS: &str = "address";

/// Serves the pages of many robots under one address, with people's rights and an audit (docs/fleet.md).
#[derive(Debug, Parser)]
#[command(name = "whichone gateway", bin_name = "whichone gateway", version)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Serve until Ctrl-C.
    Serve(ServeArgs),
    /// Add a person, or set the rights of one; prints the secret of a new one.
    Add(AddArgs),
    /// Remove a person: open pages are closed.
    Remove {
        /// The gateway's folder.
        folder: PathBuf,
        /// The person.
        name: Name,
    },
    /// List people and their rights.
    People {
        /// The gateway's folder.
        folder: PathBuf,
        /// Print JSON instead of text.
        #[arg(long)]
        json: bool,
    },
}

#[derive(Debug, Args)]
struct ServeArgs {
    /// The gateway's folder: people, sessions, audit, mirrors.
    folder: PathBuf,
    /// A group of this machine.
    #[arg(long = "group", value_name = "NAME")]
    groups: Vec<GroupName>,
    /// Keys of a person: all robots of their router that connect.
    #[arg(long, env = "WHICHONE_KEYS", value_name = "DIR")]
    keys: Option<PathBuf>,
    /// Where to listen.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:8400")]
    listen: SocketAddr,
    /// The address under which people reach it, if it is another one: that of the proxy with https before it.
    #[arg(long, value_name = "URL")]
    address: Option<Address>,
}

#[derive(Debug, Args)]
struct AddArgs {
    /// The gateway's folder.
    folder: PathBuf,
    /// The person.
    name: Name,
    /// A robot that the person may see, talk to, stop and release; "*" for all.
    #[arg(long = "operator", value_name = "ROBOT")]
    operator: Vec<String>,
    /// A robot that the person may see; "*" for all.
    #[arg(long = "viewer", value_name = "ROBOT")]
    viewer: Vec<String>,
    /// Replace the secret: it and its sessions end.
    #[arg(long)]
    renew: bool,
}

/// Runs the program.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Nothing to do if standard error is closed.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage.code() } else { Exit::Ok.code() };
        }
    };
    let _log = service::logging::init();
    match carry_out(cli.verb) {
        Ok(()) => Exit::Ok.code(),
        Err(failure) => {
            let _ = writeln!(std::io::stderr(), "whichone gateway: {failure}");
            failure.exit.code()
        }
    }
}

fn carry_out(verb: Verb) -> Result<(), Failure> {
    match verb {
        Verb::Serve(args) => {
            let ServeArgs { folder, groups, keys, listen, address } = args;
            if groups.is_empty() && keys.is_none() {
                let what = "expected robots: --group NAME for those of this machine, --keys DIR for those of a router";
                return Err(Failure::new(Exit::Usage, what));
            }
            let options = Options { folder, groups, keys, listen, address };
            serve(&options, |address| {
                let path = options.folder.join(ADDRESS);
                safe_files::replace_private(&path, format!("{address}\n"))
                    .map_err(|error| Failure::file(&path, &error))?;
                print(&format!("{address}/\n"))
            })
        }
        Verb::Add(AddArgs { folder, name, operator, viewer, renew }) => {
            make_private(&folder)
                .map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
            let path = folder.join(people::FILE);
            let secret = people::add(&path, &name, &operator, &viewer, renew)?;
            let address = std::fs::read_to_string(folder.join(ADDRESS)).unwrap_or_default();
            print(&match (secret, address.trim()) {
                (Some(secret), "") => format!("{name}: secret {secret}\n"),
                (Some(secret), address) => format!("{name}: {address}/?token={secret}\n"),
                (None, _) => format!("{name}: rights changed, the secret stays\n"),
            })
        }
        Verb::Remove { folder, name } => {
            people::remove(&folder.join(people::FILE), &name)?;
            print(&format!("{name}: removed\n"))
        }
        Verb::People { folder, json } => {
            let people = People::load(&folder.join(people::FILE))?;
            print(&if json { listed_json(&people) } else { listed(&people) })
        }
    }
}

fn listed(people: &People) -> String {
    let robots = |names: &[String]| match names {
        [] => "none".to_owned(),
        names if names.iter().any(|name| name == EVERY_ROBOT) => "all".to_owned(),
        names => names.join(", "),
    };
    let line = |(name, person): (&Name, &people::Person)| {
        format!(
            "{name}: operator of {}, viewer of {}\n",
            robots(&person.operator),
            robots(&person.viewer)
        )
    };
    let lines: String = people.iter().map(line).collect();
    if lines.is_empty() { "nobody; help: `whichone gateway add`\n".to_owned() } else { lines }
}

fn listed_json(people: &People) -> String {
    let one = |(name, person): (&Name, &people::Person)| serde_json::json!({ "person": name, "operator": person.operator, "viewer": person.viewer });
    let people: serde_json::Value = people.iter().map(one).collect();
    format!("{}\n", with_schema(&serde_json::json!({ "people": people }).to_string()))
}

fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(Failure::output)
}
