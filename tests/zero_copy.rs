//! The way of a fixed message from its writer to a reducer: filled in shared memory, read in shared
//! memory, and no memory allocated for it in between. What a reducer puts out waits for durable records as
//! a value, which its shell copies into shared memory once, with no memory allocated for it either.

#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use baxter::shell::BaxterShell;
use grounding::shell::GroundingShell;
use messages::robot::{JointCommand, Order};
use messages::{
    Epoch, Incarnation, JointStates, Observation, RobotAct, Service, Utterance, WireMessage, topics,
};
use policy::shell::PolicyShell;
use service::Node;
use service::bus::{Bus, Identity, Reader, Writer};
use service::group::{GroupName, GroupPaths};
use service::lifecycle::Environment;
use service::service_loop::{Context, Shell};
use service::{shm_cleanup, worker_channel};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Counts the allocations of each thread.
struct Counting;

impl Counting {
    fn count() {
        // A thread that ends has no count any more.
        let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
    }
}

// SAFETY: every call is the system allocator's own.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::count();
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(block, layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        Self::count();
        // SAFETY: as the caller promises.
        unsafe { System.realloc(block, layout, size) }
    }
}

/// Returns whether an address lies in a file of `/dev/shm` that this process has mapped.
fn is_shared<T>(message: &T) -> bool {
    let address = std::ptr::from_ref(message) as usize;
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    maps.lines().filter(|line| line.contains("/dev/shm/")).any(|line| {
        let (from, to) = line.split_whitespace().next().unwrap().split_once('-').unwrap();
        let number = |text| usize::from_str_radix(text, 16).unwrap();
        (number(from)..number(to)).contains(&address)
    })
}

/// Allocations of iceoryx2 for each loan, whatever its size: the handle by which it counts references.
const LOAN_HANDLES: u64 = 1;

/// A group's shared memory; removed with it.
struct Shm {
    _home: tempfile::TempDir,
    environment: Environment,
    bus: Bus,
}

impl Shm {
    fn new() -> Self {
        let home = tempfile::Builder::new().prefix("wo").tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("zero").unwrap()).unwrap();
        shm_cleanup::create_place(&paths).unwrap();
        std::fs::create_dir_all(paths.run()).unwrap();
        let identity = Identity { epoch: Epoch(1), incarnation: Incarnation(1) };
        let bus = Bus::open(&paths, "test", identity).unwrap();
        let environment = Environment { paths, ..Environment::nowhere() };
        Self { _home: home, environment, bus }
    }

    fn open<N: Node, S: Shell<N>>(&self) -> S {
        let (devices, _) = worker_channel::channel().unwrap();
        let (settings, environment) = (whichone_tests::settings(&[]), &self.environment);
        S::open(&Context { bus: &self.bus, settings: &settings, devices, environment }).unwrap()
    }
}

impl Drop for Shm {
    fn drop(&mut self) {
        shm_cleanup::remove_leftovers(&self.environment.paths);
    }
}

/// Sends messages as `fill` makes them, and asserts that a reducer gets each of them in shared
/// memory, without an allocation for it on the way. `find` shows the message of a shell's input.
fn assert_zero_copy<N: Node, T: WireMessage + Default>(
    writer: &Writer<T>,
    shell: &mut impl Shell<N>,
    fill: impl Fn(&mut T),
    find: impl Fn(N::In<'_>, &mut dyn FnMut(&T)),
) {
    for is_first in [true, false, false, false, false] {
        let before = ALLOCATIONS.get();
        let mut is_filled_in_place = !is_first;
        let filled = |message: &mut T| {
            assert!(*message == T::default(), "nothing of an earlier message");
            fill(message);
            is_filled_in_place = is_filled_in_place || is_shared(message);
        };
        writer.send_with(filled).unwrap();
        let (sent, mut found, mut taken) = (ALLOCATIONS.get(), 0, 0);
        let mut take = |input: N::In<'_>| {
            taken = ALLOCATIONS.get() - sent;
            find(input, &mut |message| {
                found += u32::from(is_shared(message) && *message != T::default());
            });
        };
        shell.drain(&mut take).unwrap();
        assert!(is_filled_in_place);
        assert_eq!(found, 1, "{} is read in place", std::any::type_name::<T>());
        // The first one connects the two.
        let expected = if is_first { (sent - before, taken) } else { (LOAN_HANDLES, 0) };
        assert_eq!((sent - before, taken), expected, "allocations of sending and taking");
    }
}

/// Publishes outputs of a reducer through its shell, and asserts that each is read in shared memory, without
/// an allocation for it on the way.
fn assert_published_without_allocation<N: Node, T: WireMessage + Default>(
    reader: &Reader<T>,
    shell: &mut impl Shell<N>,
    output: impl Fn() -> N::Out,
) {
    for is_first in [true, false, false] {
        let output = output();
        let before = ALLOCATIONS.get();
        shell.publish(output).unwrap();
        let sent = ALLOCATIONS.get();
        let found = reader.take(|message| is_shared(message) && *message != T::default()).unwrap();
        assert_eq!(found, Some(true), "{} is read in place", std::any::type_name::<T>());
        // The first one connects the two.
        assert!(is_first || sent - before == LOAN_HANDLES, "{} allocations", sent - before);
    }
}

#[test]
fn outputs_of_the_reducers_are_published_without_an_allocation() {
    let shm = Shm::new();
    let listen = |service: &Service| shm.bus.wake_listener(*service).unwrap();
    let _listeners: Vec<_> =
        Service::BUILT_IN.iter().chain([&Service::Robot]).map(listen).collect();
    assert_published_without_allocation(
        &shm.bus.reader::<Observation>(&topics::OBSERVATION).unwrap(),
        &mut shm.open::<_, GroundingShell>(),
        || {
            let observation = Observation { seq: 7, ..Observation::default() };
            grounding::Out::Observation(Box::new(observation))
        },
    );
    assert_published_without_allocation(
        &shm.bus.reader::<RobotAct>(&topics::ACT).unwrap(),
        &mut shm.open::<_, PolicyShell>(),
        || policy::Out::Act(Box::new(RobotAct { act: 7, ..RobotAct::default() })),
    );
    assert_published_without_allocation(
        &shm.bus.reader::<JointStates>(&topics::JOINTS).unwrap(),
        &mut shm.open::<_, arm::shell::ArmShell<drivers::Shipped>>(),
        || arm::Out::Joints(Box::new(JointStates { at_ns: 7, ..JointStates::default() })),
    );
}

#[test]
fn fixed_messages_reach_the_reducers_without_a_copy_or_an_allocation() {
    let shm = Shm::new();
    // Their wake-ups are delivered, too.
    let listen = |service: &Service| shm.bus.wake_listener(*service).unwrap();
    let _listeners: Vec<_> =
        Service::BUILT_IN.iter().chain([&Service::Robot]).map(listen).collect();
    let mut grounding: GroundingShell = shm.open();
    assert_zero_copy(
        &shm.bus.writer::<Utterance>(&topics::UTTERANCE).unwrap(),
        &mut grounding,
        |utterance| utterance.seq = 7,
        |input, show| {
            let grounding::In::Utterance(utterance) = input else { return };
            show(&utterance);
        },
    );
    // A topic has one writer.
    drop(grounding);
    let mut policy: PolicyShell = shm.open();
    assert_zero_copy(
        &shm.bus.writer::<Observation>(&topics::OBSERVATION).unwrap(),
        &mut policy,
        |observation| observation.seq = 7,
        |input, show| {
            let policy::In::Observation(observation) = input else { return };
            show(&observation);
        },
    );
    drop(policy);
    let mut arm: arm::shell::ArmShell<drivers::Shipped> = shm.open();
    assert_zero_copy(
        &shm.bus.writer::<RobotAct>(&topics::ACT).unwrap(),
        &mut arm,
        |act| act.act = 7,
        |input, show| {
            let arm::In::Act(act) = input else { return };
            show(&act);
        },
    );
    drop(arm);
    let mut robot: BaxterShell = shm.open();
    assert_zero_copy(
        &shm.bus.writer::<JointCommand>(&topics::robot::JOINT_COMMAND[1]).unwrap(),
        &mut robot,
        |command| command.len = 7,
        |input, show| {
            let baxter::In::Order(Order::Joints(1, command)) = input else { return };
            show(&command);
        },
    );
}
