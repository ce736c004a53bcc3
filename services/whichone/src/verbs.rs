//! The verbs, a file each or a family a file.

use command_line::Outcome;
use command_line::output::Output;
use messages::{MotionOrder, Service};
use service::control::Request;
use service::group::GroupPaths;

use self::availability::Availability;
use crate::cli::{Awaited, Cli, ServiceArgs, StopArgs, Verb};

mod availability;
mod await_pick;
mod chat;
mod completion;
mod console;
mod conversation;
mod doctor;
mod hearing;
mod init;
mod inspection;
mod leftovers;
mod licences;
mod listen;
mod motion;
mod operate;
mod other_program;
mod people;
mod speak;
mod status;
mod up;
mod watch;
mod words;

pub use await_pick::Waiting;

/// Executes the verb of the command line.
///
/// # Errors
/// The verb failed.
pub fn run(cli: Cli, out: &mut Output<'_>) -> Outcome {
    let paths = || GroupPaths::resolve(&cli.common.group);
    match cli.verb {
        Verb::Up(args) => up::up(&paths()?, &args, out),
        Verb::Down(args) => operate::down(&paths()?, args.timeout, out),
        Verb::Status => status::status(&paths()?, out),
        Verb::Start(args) => operate::on_service(&paths()?, Request::Start, args, out),
        Verb::Stop(StopArgs { service: Some(service), timeout }) => {
            operate::on_service(&paths()?, Request::Stop, ServiceArgs { service, timeout }, out)
        }
        // Whoever types it in a fright means the arm.
        Verb::Stop(_) => motion::motion(&paths()?, MotionOrder::Stop, None, out),
        Verb::Restart(args) => operate::restart(&paths()?, args, out),
        Verb::Hold(args) => operate::on_service(&paths()?, Request::Hold, args, out),
        Verb::Release(args) => operate::on_service(&paths()?, Request::Release, args, out),
        Verb::Console(args) => console::console(&paths()?, &args, out),
        Verb::Token(args) => http_api::verb::token(&paths()?, &args, out),
        Verb::Logs(args) => bug_report::logs(&paths()?, &args, out),
        Verb::Reload(args) => operate::reload(&paths()?, args, out),
        Verb::Check(args) => laboratory::check(&args, out),
        Verb::Swap(args) => operate::swap(&paths()?, args, out),
        Verb::Conform(args) => laboratory::conform(&args, out),
        Verb::Say(args) => speak::say(&paths()?, &args, out),
        Verb::Point(args) => speak::point(&paths()?, &args, out),
        Verb::Objects(args) => {
            let paths = paths()?;
            let is_up = || Availability::now(&paths).require(Service::Policy);
            detections::objects(&paths, &args, is_up, out)
        }
        Verb::People(args) => people::people(&paths()?, &args, out),
        Verb::Listen(args) => listen::listen(&paths()?, &args, out),
        Verb::Talk(args) => speak::talk(&paths()?, &args, out),
        Verb::Watch(args) => watch::watch(&paths()?, &args, out),
        Verb::Chat(args) => chat::chat(&paths()?, &args, out),
        Verb::Await(args) => match args.what {
            Awaited::Pick => await_pick::await_pick(&paths()?, &args, out),
        },
        Verb::StopMotion(args) => motion::motion(&paths()?, MotionOrder::Stop, args.timeout, out),
        Verb::ResumeMotion(args) => {
            motion::motion(&paths()?, MotionOrder::Resume, args.timeout, out)
        }
        Verb::Link(args) => Err(other_program::link(&cli.common.group, args)),
        Verb::Fleet(args) => Err(other_program::fleet(args, cli.common.json)),
        Verb::Gateway(args) => Err(other_program::gateway(args)),
        Verb::Baxter(args) => Err(other_program::baxter(&cli.common.group, args)),
        Verb::Record { what } => operate::recorder(&paths()?, what, out),
        Verb::Replay(args) => laboratory::replay(paths, &args, out),
        Verb::Scene { what } => laboratory::scene(what, out),
        Verb::Journal(args) => inspection::journal(&paths()?, &args, out),
        Verb::Completions { shell } => completion::completions(shell, out),
        Verb::Complete { line } => completion::complete(&line, out),
        Verb::Init { folder } => init::init(&folder, out),
        Verb::Man { folder } => init::man(&folder, out),
        Verb::Licences => licences::licences(out),
        Verb::Report(args) => bug_report::report(&paths()?, &args, out),
        Verb::Doctor(args) => doctor::doctor(&paths()?, &args, out),
        Verb::Laboratory(verb) => laboratory::run(*verb, paths, out),
    }
}

/// A group called lab, for tests, in a home of its own.
#[cfg(test)]
fn lab() -> (tempfile::TempDir, GroupPaths) {
    let home = tempfile::tempdir().expect("a temporary folder");
    let paths = GroupPaths::in_home(home.path(), &"lab".parse().expect("a name"));
    (home, paths.expect("a short path"))
}
