//! A process's access to its group.

use std::ffi::{CString, c_char};
use std::fs;

use messages::{MotionOrder, PromptId, ReceiptStatus, Sound, StopId};
use service::bus::{Bus, Identity};
use service::client::{Client, submit};
use service::exit::Failure;
use service::group::{ENV_GROUP, GroupName, GroupPaths};
use service::lifecycle::{Environment, Lifecycle};
use service::logging::{self, LogFlush};
use service::stop_socket::{self, StopError, default_patience};
use service::submission::Submission;
use service::{Span, Time, clock};

use crate::{complain, or_complain, text};

/// Longest timeout of an order to the motion stop, a month.
const SECONDS_MAX: f64 = 2_678_400.0;

/// File of the group with the scene's key and words.
const WORDS_FILE: &str = "scene.words";

/// A process in its group; `whichone_group_t`.
#[derive(Debug)]
pub struct Group {
    role: Role,
    paths: GroupPaths,
    words: Words,
}

/// How a process takes part.
#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "a process has one")]
enum Role {
    Client(Client),
    Service { bus: Bus, name: String, lifecycle: Option<Lifecycle>, _log: LogFlush },
}

/// The scene's key and words, as far as they were there.
#[derive(Debug, Default)]
struct Words {
    key: u64,
    words: Vec<CString>,
}

impl Words {
    fn read(paths: &GroupPaths) -> Self {
        let path = paths.run().join(WORDS_FILE);
        let read =
            fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()));
        let Some(text) = or_complain(read) else { return Self::default() };
        let mut lines = text.lines();
        let key = lines.next().and_then(|line| u64::from_str_radix(line, 16).ok());
        if key.is_none() {
            complain(&format_args!("{}: expected a key in hexadecimal in line 1", path.display()));
        }
        // A line has no zero.
        let words = lines.filter_map(|line| CString::new(line).ok()).collect();
        Self { key: key.unwrap_or_default(), words }
    }
}

impl Group {
    fn of_service(name: &str) -> Result<Self, Failure> {
        let log = logging::init();
        logging::identify();
        let environment = Environment::read(Vec::new())?;
        let Environment { paths, epoch, incarnation, .. } = environment;
        let lifecycle = Some(Lifecycle::begin(&paths)?);
        let bus = Bus::open(&paths, name, Identity { epoch, incarnation })?;
        let role = Role::Service { bus, name: name.to_owned(), lifecycle, _log: log };
        Ok(Self { role, words: Words::read(&paths), paths })
    }

    fn of_client(name: Option<&str>) -> Result<Self, Failure> {
        let configured = std::env::var(ENV_GROUP).ok().filter(|name| !name.is_empty());
        let name = name.or(configured.as_deref()).unwrap_or(GroupName::DEFAULT);
        let paths = GroupPaths::resolve(&GroupName::new(name)?)?;
        let client = Client::join(&paths)?;
        Ok(Self { role: Role::Client(client), words: Words::read(&paths), paths })
    }

    /// The process's access to the topics.
    pub(crate) fn bus(&self) -> &Bus {
        match &self.role {
            Role::Client(client) => client.bus(),
            Role::Service { bus, .. } => bus,
        }
    }

    /// Takes what a service runs with: its name, and its connection to the supervisor, once.
    pub(crate) fn take_lifecycle(&mut self) -> Result<(String, Lifecycle), String> {
        let Role::Service { name, lifecycle, .. } = &mut self.role else {
            return Err("a client is not run; help: join the group as a service".to_owned());
        };
        let lifecycle = lifecycle.take().ok_or("the service has run already")?;
        Ok((name.clone(), lifecycle))
    }

    fn say(&self, from: &str, text: &str, seen: u64, patience: Span) -> Result<u64, String> {
        let Role::Client(client) = &self.role else {
            return Err("a service does not speak to the robot; help: join the group as a client"
                .to_owned());
        };
        let (writer, receipts) = client.submissions().map_err(|error| error.to_string())?;
        let sound = Sound::Text(text.to_owned());
        let said = (Time(0), Time(0));
        let submission = Submission::new(sound, said, clock::now(), patience).by(from);
        let mut submission = submission.after(PromptId(seen));
        let receipts = submit(&writer, &receipts, &mut submission, || {
            (!self.paths.control_socket().exists()).then(|| "the group is not running".to_owned())
        });
        let receipts = receipts.map_err(|error| error.to_string())?;
        let receipt = receipts.first().ok_or("no receipt")?;
        match receipt.utterance() {
            Some(number) if receipt.status == ReceiptStatus::Accepted => Ok(number.0),
            _ => Err(format!("refused: {}", receipt.note.as_str().unwrap_or_default())),
        }
    }
}

impl Group {
    /// Gives an order to the motion stop, a release of `stop` alone; `seconds` below 0 stand for the usual patience.
    fn order(&self, order: MotionOrder, stop: StopId, seconds: f64) -> bool {
        let patience = match seconds >= 0.0 {
            true => Some(Span::from_s(seconds.min(SECONDS_MAX))),
            false => default_patience(order),
        };
        let complain = &mut |why: Option<StopError>| {
            why.iter()
                .for_each(|why| complain(&format_args!("not confirmed: {why}; it is repeated")));
            true
        };
        or_complain(match order {
            MotionOrder::Stop => stop_socket::give(&self.paths, order, patience, complain),
            MotionOrder::Resume => stop_socket::release(&self.paths, stop, patience, complain),
        })
        .is_some()
    }
}

fn boxed(group: Result<Group, Failure>) -> *mut Group {
    or_complain(group).map_or(std::ptr::null_mut(), |group| Box::into_raw(Box::new(group)))
}

/// Joins the group as one of its services; null after saying why not.
///
/// # Safety
/// `service` is null, or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_join_as_service(service: *const c_char) -> *mut Group {
    // SAFETY: as the caller promises.
    let name = unsafe { text(service) };
    name.map_or(std::ptr::null_mut(), |name| boxed(Group::of_service(name)))
}

/// Joins a running group as a client; null after saying why not.
///
/// # Safety
/// `group` is null, or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_join_as_client(group: *const c_char) -> *mut Group {
    // SAFETY: as the caller promises.
    boxed(Group::of_client(unsafe { text(group) }))
}

/// Leaves the group.
///
/// # Safety
/// `group` is null, or was joined and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_leave(group: *mut Group) {
    if !group.is_null() {
        // SAFETY: as the caller promises.
        drop(unsafe { Box::from_raw(group) });
    }
}

/// Nanoseconds of the monotonic clock.
#[unsafe(no_mangle)]
pub extern "C" fn whichone_now_ns() -> u64 {
    clock::now().ns()
}

/// Says something to the robot. Returns the utterance's number, or 0 after saying why.
///
/// # Safety
/// `group` is null or joined; `words` is null, or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_say(
    group: *const Group,
    words: *const c_char,
    seconds: f64,
) -> u64 {
    // SAFETY: as the caller promises.
    let (Some(group), Some(words)) = (unsafe { (group.as_ref(), text(words)) }) else { return 0 };
    let patience = Span::from_s(seconds.clamp(0.0, 3600.0));
    or_complain(group.say("", words, 0, patience)).unwrap_or_default()
}

/// As [`whichone_say`], for a person by their name.
///
/// # Safety
/// `group` is null or joined; `from` and `words` are null, or end with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_say_from(
    group: *const Group,
    from: *const c_char,
    words: *const c_char,
    seconds: f64,
) -> u64 {
    // SAFETY: as the caller promises.
    unsafe { whichone_say_in_answer(group, from, words, 0, seconds) }
}

/// As [`whichone_say_from`], in answer to the line `seen`, the latest one that the person was shown; 0 if unknown.
///
/// # Safety
/// `group` is null or joined; `from` and `words` are null, or end with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_say_in_answer(
    group: *const Group,
    from: *const c_char,
    words: *const c_char,
    seen: u64,
    seconds: f64,
) -> u64 {
    // SAFETY: as the caller promises.
    let given = unsafe { (group.as_ref(), text(from), text(words)) };
    let (Some(group), Some(from), Some(words)) = given else { return 0 };
    let patience = Span::from_s(seconds.clamp(0.0, 3600.0));
    or_complain(group.say(from, words, seen, patience)).unwrap_or_default()
}

/// Stops the arm and latches the stop. Returns false after saying why it is not confirmed.
///
/// # Safety
/// `group` is null or joined.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_stop_motion(group: *const Group, seconds: f64) -> bool {
    // SAFETY: as the caller promises.
    unsafe { group.as_ref() }
        .is_some_and(|group| group.order(MotionOrder::Stop, StopId(0), seconds))
}

/// Releases the motion stop. Returns false after saying why it is not confirmed.
///
/// # Safety
/// `group` is null or joined.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_resume_motion(group: *const Group, seconds: f64) -> bool {
    // SAFETY: as the caller promises.
    unsafe { whichone_release_stop(group, 0, seconds) }
}

/// As [`whichone_resume_motion`], for this stop alone, the one that the person saw; 0 stands for any.
///
/// # Safety
/// `group` is null or joined.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_release_stop(
    group: *const Group,
    stop: u64,
    seconds: f64,
) -> bool {
    // SAFETY: as the caller promises.
    let group = unsafe { group.as_ref() };
    group.is_some_and(|group| group.order(MotionOrder::Resume, StopId(stop), seconds))
}

/// Key of the scene in force.
///
/// # Safety
/// `group` is null or joined.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_scene_key(group: *const Group) -> u64 {
    // SAFETY: as the caller promises.
    unsafe { group.as_ref() }.map_or(0, |group| group.words.key)
}

/// Number of the scene's words.
///
/// # Safety
/// `group` is null or joined.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_word_count(group: *const Group) -> usize {
    // SAFETY: as the caller promises.
    unsafe { group.as_ref() }.map_or(0, |group| group.words.words.len())
}

/// The word of this number, valid until the group is left; null if there is none.
///
/// # Safety
/// `group` is null or joined.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn whichone_word(group: *const Group, number: usize) -> *const c_char {
    // SAFETY: as the caller promises.
    let group = unsafe { group.as_ref() };
    let word = group.and_then(|group| group.words.words.get(number));
    word.map_or(std::ptr::null(), |word| word.as_ptr())
}
