//! A ROS 1 master of Debian's packages, and a robot in rospy with the interface of a Baxter.

use crate::{Group, program, wait_for};
use ros1::types::of_baxter;
use ros1::xmlrpc::{Value as Xml, call};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

/// The interpreter that sees Debian's packages; another one in `PATH` does not.
const PYTHON: &str = "/usr/bin/python3";
/// Patience with a master.
const PATIENCE: Duration = Duration::from_secs(2);

/// A child that is killed when it is dropped.
#[derive(Debug)]
struct Process(Child);

impl Process {
    fn signal(&self, signal: Signal) {
        let pid = i32::try_from(self.0.id()).ok().and_then(Pid::from_raw).expect("a process id");
        kill_process(pid, signal).expect("a child of ours");
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A master with a robot.
#[derive(Debug)]
pub struct Ros {
    folder: tempfile::TempDir,
    port: u16,
    master: Process,
    robot: Robot,
}

#[derive(Debug)]
struct Robot {
    process: Process,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

impl Ros {
    /// Starts a master and a robot, and waits until the robot is registered.
    pub fn start() -> Self {
        let folder = tempfile::Builder::new().prefix("ros").tempdir().expect("a temporary folder");
        let free = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr());
        let port = free.expect("a free port").port();
        generate_messages(folder.path());
        let master = start_master(folder.path(), port);
        wait_for_master(port);
        let robot = start_robot(folder.path(), port);
        let ros = Self { folder, port, master, robot };
        wait_for("the robot", 20.0, || ros.knows_topics_of("/robot").then_some(()));
        ros
    }

    /// Starts a group behind the bridge.
    pub fn group(&self) -> Group {
        Group::up(&self.settings().each_ref().map(String::as_str))
    }

    /// Settings of a group behind the bridge.
    pub fn settings(&self) -> [String; 5] {
        [
            format!("group.services.baxter.command=[\"{}\"]", program("whichone-ros1").display()),
            "arm.driver=baxter".to_owned(),
            "arm.time_scale=1.0".to_owned(),
            format!("arm.ros1.master=127.0.0.1:{}", self.port),
            "arm.ros1.host=127.0.0.1".to_owned(),
        ]
    }

    /// Kills the robot and starts another one.
    pub fn restart_robot(&mut self) {
        self.kill_robot();
        self.start_robot();
    }

    /// Kills the robot, which cannot take leave of the master.
    pub fn kill_robot(&mut self) {
        self.robot.process.signal(Signal::KILL);
        self.robot.process.0.wait().expect("a child of ours");
    }

    /// Starts another robot in the place of one that was killed.
    pub fn start_robot(&mut self) {
        self.robot = start_robot(self.folder.path(), self.port);
    }

    /// Kills the master and starts another one on its port, which knows nobody.
    pub fn restart_master(&mut self) {
        self.master.signal(Signal::KILL);
        self.master.0.wait().expect("a child of ours");
        self.master = start_master(self.folder.path(), self.port);
        wait_for_master(self.port);
    }

    /// Gives the robot a word, and returns what it has seen.
    pub fn robot(&mut self, word: &str) -> Value {
        writeln!(self.robot.to, "{word}").expect("the robot reads");
        // rospy prints there, too.
        let mut lines = (&mut self.robot.from).lines().map_while(Result::ok);
        let line = lines.find(|line| line.starts_with('{')).expect("the robot answers");
        serde_json::from_str(&line).unwrap_or_else(|e| panic!("{e}: {line}"))
    }

    /// Calls the master.
    pub fn call(&self, method: &str, parameter: &str) -> Option<Xml> {
        let parameters = ["/test".into(), parameter.into()];
        let parameters = if parameter.is_empty() { &parameters[..1] } else { &parameters[..] };
        call(&uri(self.port), method, parameters, PATIENCE).ok()
    }

    /// Returns whether the master knows topics of a node.
    pub fn knows_topics_of(&self, node: &str) -> bool {
        fn mentions(value: &Xml, node: &str) -> bool {
            value.as_text() == Some(node)
                || value.as_list().into_iter().flatten().any(|item| mentions(item, node))
        }
        mentions(&self.call("getSystemState", "").expect("the master answers"), node)
    }

    /// A program of ROS for this master, in a folder of its own.
    pub fn command(&self, program: &str) -> Command {
        command(self.folder.path(), self.port, program)
    }

    /// The folder of the programs.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }
}

fn command(folder: &Path, port: u16, program: &str) -> Command {
    let mut command = Command::new(program);
    command.env("ROS_MASTER_URI", format!("http://127.0.0.1:{port}")).env("ROS_IP", "127.0.0.1");
    command.env("ROS_HOME", folder).env("PYTHONPATH", folder.join("gen")).current_dir(folder);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn start_master(folder: &Path, port: u16) -> Process {
    let mut command = command(folder, port, PYTHON);
    command.args(["/usr/bin/rosmaster", "--core", "-p", &port.to_string()]);
    Process(command.spawn().expect("rosmaster is installed"))
}

fn uri(port: u16) -> String {
    format!("http://127.0.0.1:{port}/")
}

fn wait_for_master(port: u16) {
    let parameters = ["/test".into()];
    wait_for("the ROS master", 20.0, || call(&uri(port), "getPid", &parameters, PATIENCE).ok());
}

fn start_robot(folder: &Path, port: u16) -> Robot {
    let errors = std::fs::File::create(folder.join("robot.log")).expect("a log");
    let mut command = command(folder, port, PYTHON);
    command.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/ros1/robot.py"));
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(errors);
    let mut child = command.spawn().expect("python3 is installed");
    let to = child.stdin.take().expect("piped");
    let from = BufReader::new(child.stdout.take().expect("piped"));
    Robot { process: Process(child), to, from }
}

/// Generates the Python classes of the bridge's own definitions, and compares the checksums.
fn generate_messages(folder: &Path) {
    let (source, package) = (folder.join("msg"), folder.join("gen/baxter_core_msgs"));
    std::fs::create_dir_all(&source).expect("a folder");
    std::fs::create_dir_all(package.join("msg")).expect("a folder");
    std::fs::write(package.join("__init__.py"), "").expect("a file");
    let mut files: Vec<PathBuf> = Vec::new();
    for (name, _, definition) in of_baxter() {
        let short = name.rsplit('/').next().expect("a name");
        files.push(source.join(format!("{short}.msg")));
        std::fs::write(&files[files.len() - 1], definition).expect("a file");
    }
    let generator = |arguments: &[&str]| {
        let mut command = Command::new(PYTHON);
        command.args(["/usr/lib/genpy/genmsg_py.py", "-p", "baxter_core_msgs", "-o"]);
        command.arg(package.join("msg")).args(arguments);
        command
    };
    let own = format!("-Ibaxter_core_msgs:{}", source.display());
    let mut includes = vec![own];
    for known in ["std_msgs", "geometry_msgs", "sensor_msgs"] {
        includes.push(format!("-I{known}:/usr/share/{known}/msg"));
    }
    let mut first = generator(&[]);
    first.args(&includes).args(&files);
    for mut command in [first, generator(&["--initpy"])] {
        let ended = crate::run(&mut command, "", 60.0);
        assert_eq!(ended.code, Some(0), "{ended:?}");
    }
    for (name, md5, _) in of_baxter() {
        let short = name.rsplit('/').next().expect("a name");
        let file = package.join(format!("msg/_{short}.py"));
        let text = std::fs::read_to_string(file).expect("a generated file");
        assert!(text.contains(&format!("_md5sum = \"{md5}\"")), "{name}: another checksum");
    }
}
