//! Two machines with a slow network between them, all on this one: two network namespaces, whose only way to each other
//! is a pair of devices, and a relay that carries each packet late, loses some, and has a bounded rate.

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::ioctl::{Setter, ioctl};
use rustix::thread::{LinkNameSpaceType, UnshareFlags, move_into_link_name_space};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::os::fd::AsFd;
use std::process::Command;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Largest packet, bytes; smaller than an Ethernet's, as behind a tunnel.
const PACKET_MAX: usize = 1_400;
/// Longest wait for a packet, before the end of the relay is noticed.
const LOOK_EVERY: Timespec = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };
/// Greedy connections in each direction that fill the network.
const FLOWS: usize = 4;

/// What the network does to every packet, in each direction.
#[derive(Clone, Copy, Debug)]
pub struct Conditions {
    /// Time that a packet travels.
    pub delay: Duration,
    /// Probability that it is lost.
    pub loss: f64,
    /// Bits per second.
    pub rate: u64,
    /// Bytes that wait for the rate; what finds no room is lost.
    pub queue: usize,
}

/// Kind of the machines' devices, as flags of TUNSETIFF: without a header before each packet.
#[derive(Clone, Copy, Debug)]
enum Device {
    /// Carries IP packets between two ends.
    Tun = 0x1001,
    /// Carries Ethernet frames, as of a house's network.
    Tap = 0x1002,
}

/// One of the two machines.
#[derive(Debug)]
pub struct Machine {
    namespace: File,
    /// Its address in the network.
    pub address: &'static str,
}

/// Both machines and what lies between them.
#[derive(Debug)]
pub struct Network {
    /// The robot's machine.
    pub robot: Machine,
    /// The operator's machine.
    pub operator: Machine,
    state: Arc<State>,
    threads: Vec<JoinHandle<()>>,
}

#[derive(Debug)]
struct State {
    conditions: Mutex<Conditions>,
    is_cut: AtomicBool,
    is_over: AtomicBool,
    /// Bytes that the robot, and the operator, have sent.
    sent: [AtomicU64; 2],
}

impl Machine {
    /// Makes a machine with one device; returns it with the device.
    fn new(address: &'static str, kind: Device) -> (Self, File) {
        let make = move || {
            // SAFETY: only the network of this thread is another one; descriptors and memory stay shared.
            #[allow(unsafe_code)]
            unsafe { rustix::thread::unshare_unsafe(UnshareFlags::NEWNET) }.expect("a namespace");
            let namespace = File::open("/proc/thread-self/ns/net").expect("the namespace");
            let device = device(kind);
            let with_mask = format!("{address}/24");
            let mtu = PACKET_MAX.to_string();
            ip(&["link", "set", "lo", "up"]);
            ip(&["addr", "add", &with_mask, "dev", "wo0"]);
            ip(&["link", "set", "wo0", "mtu", &mtu, "up"]);
            (Self { namespace, address }, device)
        };
        std::thread::spawn(make).join().expect("root, and /dev/net/tun")
    }

    /// Runs `act` in a thread of this machine: the sockets that it opens and the programs that it starts are there.
    ///
    /// # Panics
    /// If `act` does.
    pub fn run<T: Send>(&self, act: impl FnOnce() -> T + Send) -> T {
        let there = || {
            let network = Some(LinkNameSpaceType::Network);
            move_into_link_name_space(self.namespace.as_fd(), network)
                .expect("a namespace of ours");
            act()
        };
        std::thread::scope(|scope| scope.spawn(there).join())
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }
}

/// Runs `ip` in this thread's network.
///
/// # Panics
/// If it fails.
pub fn ip(arguments: &[&str]) {
    let ended = Command::new("ip").args(arguments).output().expect("ip, of the package iproute2");
    assert!(ended.status.success(), "ip {arguments:?}: {ended:?}");
}

/// The kernel's `struct ifreq` with the name and flags of a device.
#[repr(C)]
struct Wanted {
    name: [u8; 16],
    flags: i16,
    rest: [u8; 22],
}

/// Makes the device `wo0` in this thread's network; each read and write is one packet.
fn device(kind: Device) -> File {
    const TUNSETIFF: u32 = 0x4004_54ca;
    let tun = OpenOptions::new().read(true).write(true).open("/dev/net/tun").expect("/dev/net/tun");
    let mut name = [0; 16];
    name[..3].copy_from_slice(b"wo0");
    let wanted = Wanted { name, flags: kind as i16, rest: [0; 22] };
    // SAFETY: TUNSETIFF reads a `struct ifreq`, whose layout and size `Wanted` has.
    #[allow(unsafe_code)]
    unsafe { ioctl(&tun, Setter::<TUNSETIFF, Wanted>::new(wanted)) }.expect("a device");
    tun
}

impl Network {
    /// Makes both machines and starts the relay.
    ///
    /// # Panics
    /// Without root or without TUN devices.
    pub fn new(conditions: Conditions) -> Self {
        Self::of(Device::Tun, conditions)
    }

    /// As [`Network::new`], with Ethernet between them, without delay and loss: multicast reaches the other machine.
    pub fn ethernet() -> Self {
        let conditions =
            Conditions { delay: Duration::ZERO, loss: 0.0, rate: 100_000_000, queue: 1 << 20 };
        Self::of(Device::Tap, conditions)
    }

    fn of(kind: Device, conditions: Conditions) -> Self {
        let (robot, robots) = Machine::new("10.77.0.2", kind);
        let (operator, operators) = Machine::new("10.77.0.1", kind);
        let state = Arc::new(State {
            conditions: Mutex::new(conditions),
            is_cut: AtomicBool::new(false),
            is_over: AtomicBool::new(false),
            sent: Default::default(),
        });
        let mut threads = Vec::new();
        let copy = |file: &File| file.try_clone().expect("a descriptor");
        for (side, from, to) in
            [(0, copy(&robots), copy(&operators)), (1, copy(&operators), copy(&robots))]
        {
            let (sender, receiver) = channel();
            let state = Arc::clone(&state);
            threads.push(std::thread::spawn(move || take(side, from, &state, &sender)));
            threads.push(std::thread::spawn(move || deliver(&receiver, to)));
        }
        Self { robot, operator, state, threads }
    }

    /// Cuts the network for this time.
    pub fn cut(&self, time: Duration) {
        self.state.is_cut.store(true, Ordering::Relaxed);
        std::thread::sleep(time);
        self.state.is_cut.store(false, Ordering::Relaxed);
    }

    /// Bytes that the robot and the operator have sent so far, headers included.
    pub fn sent(&self) -> [u64; 2] {
        [0, 1].map(|side| self.state.sent[side].load(Ordering::Relaxed))
    }

    /// Fills the network in both directions with other connections, for as long as the result lives.
    ///
    /// # Panics
    /// If they cannot be made.
    pub fn fill(&self) -> Load {
        let mut load = Load { is_over: Arc::default(), received: Arc::default(), threads: vec![] };
        for (from, to) in [(&self.robot, &self.operator), (&self.operator, &self.robot)] {
            for _ in 0..FLOWS {
                load.add(from, to);
            }
        }
        load
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        self.state.is_over.store(true, Ordering::Relaxed);
        self.threads.drain(..).for_each(|thread| drop(thread.join()));
    }
}

/// Takes packets of one machine and decides when each arrives, if it does.
fn take(side: usize, mut from: File, state: &State, on_the_way: &Sender<(Instant, Vec<u8>)>) {
    let mut rng = vocabulary::Rng::new(side as u64 + 1);
    let mut bytes = [0; 2 * PACKET_MAX];
    let mut is_free_at = Instant::now();
    while !state.is_over.load(Ordering::Relaxed) {
        let is_there = poll(&mut [PollFd::new(&from, PollFlags::IN)], Some(&LOOK_EVERY));
        if is_there.is_ok_and(|count| count == 0) {
            continue;
        }
        let Ok(length) = from.read(&mut bytes) else { continue };
        state.sent[side].fetch_add(length as u64, Ordering::Relaxed);
        let Conditions { delay, loss, rate, queue } =
            *state.conditions.lock().expect("it is only copied");
        if state.is_cut.load(Ordering::Relaxed) || rng.uniform() < loss {
            continue;
        }
        let now = Instant::now();
        let waiting = is_free_at.saturating_duration_since(now).as_secs_f64();
        if waiting * rate as f64 / 8.0 + length as f64 > queue as f64 {
            continue;
        }
        is_free_at =
            is_free_at.max(now) + Duration::from_secs_f64(length as f64 * 8.0 / rate as f64);
        let _ = on_the_way.send((is_free_at + delay, bytes[..length].to_vec()));
    }
}

fn deliver(on_the_way: &Receiver<(Instant, Vec<u8>)>, mut to: File) {
    for (at, packet) in on_the_way {
        std::thread::sleep(at.saturating_duration_since(Instant::now()));
        // A device that takes no more loses it, as a network does.
        let _ = to.write(&packet);
    }
}

/// Connections that send as much as they can.
#[derive(Debug)]
pub struct Load {
    is_over: Arc<AtomicBool>,
    received: Arc<AtomicU64>,
    threads: Vec<JoinHandle<()>>,
}

impl Load {
    fn add(&mut self, from: &Machine, to: &Machine) {
        let listener = to.run(|| TcpListener::bind((to.address, 0)).expect("a port"));
        let at = listener.local_addr().expect("an address");
        let mut sender = from.run(|| TcpStream::connect(at).expect("a connection"));
        let (mut receiver, _) = listener.accept().expect("a connection");
        let patience = Some(Duration::from_millis(200));
        sender.set_write_timeout(patience).expect("a timeout");
        receiver.set_read_timeout(patience).expect("a timeout");
        let over = Arc::clone(&self.is_over);
        self.threads.push(std::thread::spawn(move || {
            while !over.load(Ordering::Relaxed) {
                // A full buffer is tried again.
                let _ = sender.write(&[0; 8 << 10]);
            }
        }));
        let (over, received) = (Arc::clone(&self.is_over), Arc::clone(&self.received));
        self.threads.push(std::thread::spawn(move || {
            let mut bytes = [0; 16 << 10];
            while !over.load(Ordering::Relaxed) {
                let count = receiver.read(&mut bytes).unwrap_or(0);
                received.fetch_add(count as u64, Ordering::Relaxed);
            }
        }));
    }

    /// Bytes that have arrived in both directions together.
    pub fn received(&self) -> u64 {
        self.received.load(Ordering::Relaxed)
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        self.threads.drain(..).for_each(|thread| drop(thread.join()));
    }
}
