//! A ROS 1 master of Debian's packages, and a robot in rospy with the interface of a Baxter.

use crate::{Group, program, wait_for};
use ros1::types::without_a_package;
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
    robot: Peer,
}

/// A program in rospy that takes lines on its standard input and answers each with a line of JSON.
#[derive(Debug)]
pub struct Peer {
    process: Process,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

impl Peer {
    /// Sends the program a signal.
    pub fn signal(&self, signal: Signal) {
        self.process.signal(signal);
    }

    /// Gives the program a line, and returns its answer.
    pub fn tell(&mut self, line: &str) -> Value {
        writeln!(self.to, "{line}").expect("the program reads");
        // rospy prints there, too.
        let mut lines = (&mut self.from).lines().map_while(Result::ok);
        let line = lines.find(|line| line.starts_with('{')).expect("the program answers");
        serde_json::from_str(&line).unwrap_or_else(|e| panic!("{e}: {line}"))
    }
}

impl Ros {
    /// Starts a master and a robot, and waits until the robot is registered.
    pub fn start() -> Self {
        let folder = tempfile::Builder::new().prefix("ros").tempdir().expect("a temporary folder");
        generate_messages(folder.path());
        let free = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr());
        let port = free.expect("a free port").port();
        let master = start_master(folder.path(), port);
        wait_for_master(port);
        let robot = start_peer(folder.path(), port, "robot");
        let ros = Self { folder, port, master, robot };
        wait_for("the robot", 20.0, || ros.knows_topics_of("/robot").then_some(()));
        ros
    }

    /// Starts a group behind the bridge.
    pub fn group(&self) -> Group {
        Group::up(&self.settings().each_ref().map(String::as_str))
    }

    /// Settings of a group behind the bridge.
    pub fn settings(&self) -> [String; 6] {
        [
            // The robot is a program in Python, which is late on a busy machine.
            "arm.baxter.path_tolerance_rad=0.8".to_owned(),
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
        self.robot = start_peer(self.folder.path(), self.port, "robot");
    }

    /// Kills the master and starts another one on its port, which knows nobody.
    pub fn restart_master(&mut self) {
        self.master.signal(Signal::KILL);
        self.master.0.wait().expect("a child of ours");
        self.master = start_master(self.folder.path(), self.port);
        wait_for_master(self.port);
    }

    /// Starts a camera with detectors, which sees nothing yet.
    pub fn camera(&self) -> Peer {
        start_peer(self.folder.path(), self.port, "camera")
    }

    /// Gives the robot a word, and returns what it has seen.
    pub fn robot(&mut self, word: &str) -> Value {
        self.robot.tell(word)
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

fn start_peer(folder: &Path, port: u16, name: &str) -> Peer {
    let errors = std::fs::File::create(folder.join(format!("{name}.log"))).expect("a log");
    let mut command = command(folder, port, PYTHON);
    command.arg(format!("{}/ros1/{name}.py", env!("CARGO_MANIFEST_DIR")));
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(errors);
    let mut child = command.spawn().expect("python3 is installed");
    let to = child.stdin.take().expect("piped");
    let from = BufReader::new(child.stdout.take().expect("piped"));
    Peer { process: Process(child), to, from }
}

/// Generates the Python classes of the bridge's own definitions, and compares the checksums.
fn generate_messages(folder: &Path) {
    let mut packages: Vec<&str> = Vec::new();
    for (name, _, definition) in without_a_package() {
        let (package, short) = name.split_once('/').expect("a package");
        let source = folder.join("msg").join(package);
        std::fs::create_dir_all(&source).expect("a folder");
        std::fs::write(source.join(format!("{short}.msg")), definition).expect("a file");
        if !packages.contains(&package) {
            packages.push(package);
        }
    }
    let own = packages.iter().map(|package| (*package, folder.join("msg").join(package)));
    let known = ["std_msgs", "geometry_msgs", "sensor_msgs"];
    let known = known.map(|package| (package, PathBuf::from(format!("/usr/share/{package}/msg"))));
    let includes = own.chain(known).map(|(package, at)| format!("-I{package}:{}", at.display()));
    let includes: Vec<String> = includes.collect();
    packages.iter().for_each(|package| generate_package(folder, package, &includes));
    for (name, md5, _) in without_a_package() {
        let (package, short) = name.split_once('/').expect("a package");
        let file = folder.join(format!("gen/{package}/msg/_{short}.py"));
        let text = std::fs::read_to_string(file).expect("a generated file");
        assert!(text.contains(&format!("_md5sum = \"{md5}\"")), "{name}: another checksum");
    }
}

fn generate_package(folder: &Path, name: &str, includes: &[String]) {
    let (source, package) = (folder.join("msg").join(name), folder.join("gen").join(name));
    std::fs::create_dir_all(package.join("msg")).expect("a folder");
    std::fs::write(package.join("__init__.py"), "").expect("a file");
    let generator = || {
        let mut command = Command::new(PYTHON);
        command.args(["/usr/lib/genpy/genmsg_py.py", "-p", name, "-o"]).arg(package.join("msg"));
        command
    };
    let files = std::fs::read_dir(source).expect("a folder");
    let mut classes = generator();
    classes.args(includes).args(files.map(|file| file.expect("a file").path()));
    let mut module = generator();
    module.arg("--initpy");
    for mut command in [classes, module] {
        let ended = crate::run(&mut command, "", 60.0);
        assert_eq!(ended.code, Some(0), "{ended:?}");
    }
}
