//! Output of this program's other verbs, as their users see it.

use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use service::group::{ENV_HOME, GroupPaths};

/// Longest run: `doctor` may load a recogniser.
const PATIENCE: Duration = Duration::from_secs(60);

/// Most bytes that are read of an output.
const BYTES_MAX: u64 = 64 << 20;

/// Interval at which the end of a run is looked for.
const POLL: Duration = Duration::from_millis(5);

/// Runs `whichone WORDS…` for a group. Returns standard output, or standard error if the former is empty. The exit
/// code does not matter, as a group that is down is reported, too.
///
/// # Errors
/// The program cannot be started, or does not end in time.
pub(crate) fn output(paths: &GroupPaths, words: &[&str]) -> Result<String, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut command = Command::new(program);
    command.args(words).args(["--group", paths.name().as_str()]).env(ENV_HOME, paths.home());
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| error.to_string())?;
    let outputs = [reader(child.stdout.take()), reader(child.stderr.take())];
    wait(&mut child)?;
    let [printed, complaint] = outputs.map(|reader| reader.join().unwrap_or_default());
    Ok(if printed.is_empty() { complaint } else { printed })
}

/// Reads everything, so that the program does not wait for a reader, and keeps as much as may be kept.
fn reader(pipe: Option<impl Read + Send + 'static>) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let Some(mut pipe) = pipe else { return String::new() };
        let mut bytes = Vec::new();
        let _ = pipe.by_ref().take(BYTES_MAX).read_to_end(&mut bytes);
        let _ = std::io::copy(&mut pipe, &mut std::io::sink());
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

fn wait(child: &mut Child) -> Result<(), String> {
    let until = Instant::now() + PATIENCE;
    loop {
        match child.try_wait() {
            Ok(Some(_)) => return Ok(()),
            Ok(None) if Instant::now() < until => thread::sleep(POLL),
            Ok(None) => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("no end within {} s", PATIENCE.as_secs()));
            }
            Err(error) => return Err(error.to_string()),
        }
    }
}
