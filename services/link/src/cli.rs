//! The command line, called by `whichone link …` and `whichone fleet`; a service without arguments.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use roster::Name;
use service::exit::{Exit, Failure};
use service::group::{ENV_GROUP, GroupName};
use service::json_schema::with_schema;

use crate::keyring::{self, Wanted};
use crate::{fleet, mirror, robot, router, watch};

/// Links robots with operators elsewhere (docs/remote.md).
#[derive(Debug, Parser)]
#[command(
    name = "whichone link",
    bin_name = "whichone link",
    version,
    args_conflicts_with_subcommands = true
)]
struct Cli {
    #[command(subcommand)]
    verb: Option<Verb>,
    #[command(flatten)]
    mirror: MirrorArgs,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Make keys for the router, robots and people, and the router's configuration.
    Init(InitArgs),
    /// Run the router that robots and people connect to.
    Router {
        /// The folder `router` that `init` made.
        folder: PathBuf,
    },
    /// List the robots that are connected.
    Fleet {
        /// Your folder of keys.
        #[arg(long, env = "WHICHONE_KEYS", value_name = "DIR")]
        keys: PathBuf,
        /// Print JSON instead of text.
        #[arg(long)]
        json: bool,
        /// Print each change of the list as a line of JSON, until Ctrl-C.
        #[arg(long, conflicts_with = "json")]
        watch: bool,
    },
}

#[derive(Debug, Args)]
struct MirrorArgs {
    /// Show this robot as a group of this machine until Ctrl-C or `whichone down`.
    #[arg(long, value_name = "ROBOT")]
    mirror: Option<Name>,
    /// Your folder of keys.
    #[arg(long, env = "WHICHONE_KEYS", value_name = "DIR")]
    keys: Option<PathBuf>,
    /// Name of the local group.
    #[arg(long, env = ENV_GROUP, value_name = "NAME", default_value = GroupName::DEFAULT)]
    group: GroupName,
    /// Where the console listens.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:8377")]
    listen: std::net::SocketAddr,
    /// Serve no console.
    #[arg(long)]
    no_console: bool,
}

#[derive(Debug, Args)]
struct InitArgs {
    /// The folder for all keys. It stays with who administers the robots.
    folder: PathBuf,
    /// Address under which robots and people reach the router, the first time and when it changes.
    #[arg(long, value_name = "HOST[:PORT]")]
    router: Option<String>,
    /// A robot.
    #[arg(long = "robot", value_name = "NAME")]
    robots: Vec<Name>,
    /// A person who sees and commands robots.
    #[arg(long = "operator", value_name = "NAME")]
    operators: Vec<Name>,
    /// A person who sees robots.
    #[arg(long = "viewer", value_name = "NAME")]
    viewers: Vec<Name>,
    /// Only for this robot (the operators and viewers of this call); default: for all.
    #[arg(long = "for", value_name = "ROBOT")]
    for_robots: Vec<Name>,
    /// Give a robot or person a new certificate and password.
    #[arg(long, value_name = "NAME")]
    renew: Vec<Name>,
    /// Let a robot or person in no longer.
    #[arg(long, value_name = "NAME")]
    revoke: Vec<Name>,
}

/// Runs the program.
pub fn run() -> ExitCode {
    if std::env::args_os().len() == 1 {
        return robot::run();
    }
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Nothing to do if standard error is closed.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage.code() } else { Exit::Ok.code() };
        }
    };
    let _log = service::logging::init();
    match carry_out(cli) {
        Ok(()) => Exit::Ok.code(),
        Err(failure) => {
            let _ = writeln!(std::io::stderr(), "whichone link: {failure}");
            failure.exit.code()
        }
    }
}

fn carry_out(cli: Cli) -> Result<(), Failure> {
    match cli.verb {
        Some(Verb::Init(args)) => {
            let InitArgs { folder, router, robots, operators, viewers, for_robots, renew, revoke } =
                args;
            let wanted = Wanted { router, robots, operators, viewers, for_robots, renew, revoke };
            let done = keyring::init(&folder, &wanted)?;
            print(&done.iter().map(|line| format!("{line}\n")).collect::<String>())
        }
        Some(Verb::Router { folder }) => router::run(&folder),
        Some(Verb::Fleet { keys, watch: true, .. }) => watch::run(&keys, &mut std::io::stdout()),
        Some(Verb::Fleet { keys, json, .. }) => {
            let robots = fleet::list(&keys)?;
            match json {
                true => {
                    let listed = serde_json::json!({ "robots": robots }).to_string();
                    print(&format!("{}\n", with_schema(&listed)))
                }
                false => print(&fleet::table(&robots)),
            }
        }
        None => mirror_of(cli.mirror),
    }
}

fn mirror_of(args: MirrorArgs) -> Result<(), Failure> {
    let usage = |what: &str| Failure::new(Exit::Usage, what.to_owned());
    let MirrorArgs { mirror, keys, group, listen, no_console } = args;
    let robot = mirror
        .ok_or_else(|| usage("expected --mirror ROBOT, init, router or fleet; help: --help"))?;
    let keys =
        keys.ok_or_else(|| usage("expected --keys DIR: your folder of keys (or WHICHONE_KEYS)"))?;
    let console = (!no_console).then(|| listen.to_string());
    mirror::run(&mirror::Options { robot, keys, group, console })
}

fn print(text: &str) -> Result<(), Failure> {
    std::io::stdout().write_all(text.as_bytes()).map_err(Failure::output)
}
