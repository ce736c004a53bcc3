//! `chat`: a dialogue with the robot in the terminal.

use std::io::{self, BufRead, IsTerminal};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread;
use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::interrupt::Interrupt;
use command_line::output::{Ink, Output, note};
use messages::{PromptId, Receipt, ReceiptStatus, StopId};
use scene::ObjectId;
use serde_json::json;
use service::clock;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::printable::one_line;

use super::availability::Lookout;
use super::conversation::{Conversation, LOOK_EVERY};
use super::motion::{MotionOrders, ResumeGuard};
use super::{await_pick, operate, up};
use crate::cli::ChatArgs;

/// Time that the end of a chat waits for the last interaction to end.
const LAST_WORDS: Duration = Duration::from_secs(120);
/// Timeout for stopping a group that was started here.
const STOP: Duration = Duration::from_secs(60);

/// Runs a dialogue until `quit` or the end of the input.
pub(super) fn chat(paths: &GroupPaths, args: &ChatArgs, out: &mut Output<'_>) -> Outcome {
    let is_running = up::is_running(paths)?;
    let interrupt = Interrupt::listen()?;
    if !is_running {
        note(format_args!("no group {} is running; starting one", paths.name()));
    }
    let own = if is_running { None } else { up::bring_up(paths, &args.config)? };
    let ready = if is_running { Ok(()) } else { up::wait_ready(paths) };
    let talked = ready.and_then(|()| talk(paths, args, &interrupt, out));
    // Another supervisor may have the group by now.
    let is_own = || operate::status_of(paths).is_ok_and(|now| Some(now.supervisor_pid) == own);
    if own.is_some() && !args.keep && is_own() {
        note("stopping the group that was started for this chat");
        operate::down(paths, STOP, &mut Output::to(io::sink(), true))?;
    }
    talked
}

fn talk(
    paths: &GroupPaths,
    args: &ChatArgs,
    interrupt: &Interrupt,
    out: &mut Output<'_>,
) -> Outcome {
    let mut conversation = Conversation::join(paths)?;
    conversation.speak_as(args.from.clone());
    let mut chat = Chat::new(conversation, MotionOrders::open(paths)?, out);
    let talked = chat.run(paths, interrupt);
    chat.orders.finish(interrupt, None, talked)
}

/// Lines from standard input, read on a thread of their own because reading blocks.
fn typed_lines() -> Receiver<String> {
    let (typed, lines) = channel();
    thread::spawn(move || {
        let mut input = io::stdin().lock();
        let mut bytes = Vec::new();
        while input.read_until(b'\n', &mut bytes).is_ok_and(|read| read > 0) {
            if typed.send(String::from_utf8_lossy(&bytes).into_owned()).is_err() {
                return;
            }
            bytes.clear();
        }
    });
    lines
}

struct Chat<'a, 'b> {
    conversation: Conversation,
    out: &'a mut Output<'b>,
    /// The robot's line that was printed last.
    printed: Option<(u64, u32)>,
    /// The last interaction whose end is known.
    ended: Option<u64>,
    orders: MotionOrders,
    guard: ResumeGuard,
    /// The stop in force, as last seen and noted here.
    stop: StopId,
}

impl<'a, 'b> Chat<'a, 'b> {
    fn new(conversation: Conversation, orders: MotionOrders, out: &'a mut Output<'b>) -> Self {
        let (guard, stop) = (ResumeGuard::default(), StopId(0));
        Self { conversation, out, printed: None, ended: None, orders, guard, stop }
    }

    fn run(&mut self, paths: &GroupPaths, interrupt: &Interrupt) -> Outcome {
        self.conversation.first_look()?;
        self.greet()?;
        let (lines, mut lookout) = (typed_lines(), Lookout::new());
        while !interrupt.is_requested() {
            self.look()?;
            if let Some(why) = lookout.news(paths) {
                note(why);
            }
            match lines.try_recv() {
                Ok(line) => match line.trim() {
                    "" => {}
                    "quit" | "exit" => return Ok(Exit::Ok),
                    words => self.on_line(words)?,
                },
                Err(TryRecvError::Empty) => thread::sleep(LOOK_EVERY * 2),
                Err(TryRecvError::Disconnected) => return self.finish(interrupt),
            }
        }
        Ok(Exit::Ok)
    }

    /// Takes a line. Words that tell the robot to stop go to the arm at once, on the motion stop's own path, which
    /// needs no speech service; they are said to the robot besides.
    fn on_line(&mut self, words: &str) -> Result<(), Failure> {
        match words {
            "resume" => self.resume(),
            "go on" | "continue" if self.stop > StopId(0) => {
                note("the arm is stopped; to let it move, type resume");
            }
            words => {
                if language::is_stop(words) {
                    self.guard.on_stop(clock::now());
                    self.orders.stop();
                }
                let seen = self.printed.map_or(0, |(prompt, _)| prompt);
                self.conversation.say(words, PromptId(seen))?;
            }
        }
        Ok(())
    }

    /// Releases the motion stop. The typed word is its own confirmation, unless it comes right after a stop.
    fn resume(&mut self) {
        match self.guard.may_resume(clock::now()) {
            true => self.orders.release(self.stop),
            false => note("stopped just now; type resume 2 s after the latest stop, or later"),
        }
    }

    fn greet(&mut self) -> Result<(), Failure> {
        if self.out.is_json() || !io::stdin().is_terminal() {
            return Ok(());
        }
        let scene = self.conversation.scene();
        let noun = scene.noun();
        let objects: Vec<ObjectId> =
            (0..scene.objects().len()).map(ObjectId::from).take(12).collect();
        let Some(first) = objects.first() else {
            note("Nothing is known to be on the table yet; quit ends.");
            return Ok(());
        };
        let first = scene.describe(*first);
        note(format_args!("Here are {}.", scene.list(&objects, "and")));
        note(format_args!(
            "Ask for a {noun}, e.g. \"get me the {first}\"; stop stops the arm, resume lets it move again; quit ends."
        ));
        Ok(())
    }

    /// Prints new events.
    fn look(&mut self) -> Result<(), Failure> {
        std::iter::from_fn(|| self.orders.news()).for_each(|news| note(news.text));
        for receipt in self.conversation.look()? {
            if self.conversation.is_own(&receipt) {
                self.refused(&receipt)?;
            }
        }
        let stop = self.conversation.latest().arm.map_or(self.stop, |arm| arm.stop());
        // The first stop of one's own has its answer; a later one may be somebody else's.
        let is_told = self.stop == StopId(0) && !self.guard.may_resume(clock::now());
        if stop > self.stop && !is_told {
            note("the arm is stopped; to let it move, type resume");
        }
        self.stop = stop;
        let words = self.conversation.latest().presented_line();
        let words = words.map(|(said, text)| (said, text.to_owned()));
        if let Some((said, text)) = words
            && self.printed != Some(said)
        {
            // What was said before this chat began is over, unless a question stands.
            let seen = self.conversation.latest();
            let stands = seen.view.as_ref().is_some_and(|view| view.interaction != 0);
            let news = self.ended.is_some() || stands;
            self.printed = Some(said);
            if news {
                self.robot_says(&text)?;
            }
        }
        self.outcome()
    }

    fn robot_says(&mut self, text: &str) -> Result<(), Failure> {
        if self.out.is_json() {
            return self.out.json(&json!({ "robot": text }));
        }
        let robot = self.out.style().paint(Ink::Cyan, "robot:");
        self.out.line(format_args!("{robot} {}", one_line(text)))
    }

    /// Prints the reason of a rejected utterance; accepted ones are in the terminal already.
    fn refused(&mut self, receipt: &Receipt) -> Result<(), Failure> {
        if receipt.status == ReceiptStatus::Accepted {
            return Ok(());
        }
        let why = receipt.note.as_str().unwrap_or("no reason was given");
        if self.out.is_json() {
            return self.out.json(&json!({ "refused": why }));
        }
        let line = format!("not accepted: {}", one_line(why));
        self.out.line(self.out.style().paint(Ink::Red, line))
    }

    fn outcome(&mut self) -> Result<(), Failure> {
        let Some(view) = &self.conversation.latest().view else { return Ok(()) };
        let last = view.last.clone();
        let id = last.as_ref().map_or(0, |last| last.interaction.0);
        let before = self.ended.replace(id);
        let (Some(last), Some(true)) = (last, before.map(|before| before < id)) else {
            return Ok(());
        };
        if self.out.is_json() {
            return self.out.json(&await_pick::to_json(&last));
        }
        let sentence = await_pick::sentence(&last);
        self.out.line(self.out.style().paint(Ink::Dim, format!("({sentence})")))
    }

    /// Waits, at the end of the input, until the interaction ends or a question is left unanswered.
    fn finish(&mut self, interrupt: &Interrupt) -> Outcome {
        let until = Instant::now() + LAST_WORDS;
        let mut over_since = None;
        while Instant::now() < until && !interrupt.is_requested() {
            self.look()?;
            if !self.is_over() {
                over_since = None;
            } else if over_since.get_or_insert_with(Instant::now).elapsed() >= self.farewell() {
                return Ok(Exit::Ok);
            }
            thread::sleep(LOOK_EVERY * 2);
        }
        Ok(Exit::NotReached)
    }

    fn is_over(&self) -> bool {
        let seen = self.conversation.latest();
        let rests = seen.view.as_ref().is_some_and(|view| view.interaction == 0);
        let asks = seen.open_question().is_some();
        self.conversation.is_heard() && seen.is_settled() && (rests || asks)
    }

    /// Time to stay once all is over: until the robot's last words are said, which may have been cut
    /// short.
    fn farewell(&self) -> Duration {
        let view = self.conversation.latest().view.as_ref();
        let said = self.printed.map(|(prompt, _)| prompt);
        match view.is_some_and(|view| Some(view.prompt) == said || view.text.is_empty()) {
            true => Duration::from_millis(50),
            false => Duration::from_secs(5),
        }
    }
}
