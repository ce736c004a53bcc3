//! The responder's life, at ports and on an interface of this machine alone.

use std::net::UdpSocket;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use mdns_sd::{DaemonEvent, DaemonStatus, Error, IfKind, ServiceDaemon};

use crate::responder::{
    End, RECORDS_MAX, Shared, Silence, Started, TIMERS_MAX, pause_after, record, watch,
};

/// Timeout of a wait.
const PATIENCE: Duration = Duration::from_secs(60);

/// Starts a responder that hears this machine, at a port that was free.
fn hearing() -> (Started, u16) {
    let free = UdpSocket::bind("127.0.0.1:0").unwrap();
    let port = free.local_addr().unwrap().port();
    drop(free);
    let responder = ServiceDaemon::new_with_port(port).unwrap();
    let events = responder.monitor().unwrap();
    responder.enable_interface(IfKind::LoopbackV4).unwrap();
    ((responder, events), port)
}

/// Waits until a fact holds.
fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !holds() {
        assert!(begun.elapsed() < PATIENCE, "{what}");
        thread::sleep(Duration::from_millis(10));
    }
}

fn has_ended(responder: &ServiceDaemon) -> bool {
    let status = responder.status().ok().and_then(|answer| answer.recv_timeout(PATIENCE).ok());
    status == Some(DaemonStatus::Shutdown)
}

/// A response that states one record 64 times: an address of `one.local`, for the rest of time.
fn repeated() -> Vec<u8> {
    let mut packet = vec![0, 0, 0x84, 0, 0, 0, 0, 64, 0, 0, 0, 0];
    for _ in 0..64 {
        packet.extend(b"\x03one\x05local\0\0\x01\0\x01\x7f\xff\xff\xff\0\x04\x0a\x4d\0\x01");
    }
    packet
}

#[test]
fn responder_is_replaced_after_a_flood_of_one_repeated_record() {
    let ((responder, events), port) = hearing();
    let watched = responder.clone();
    let watcher =
        thread::spawn(move || watch(&watched, &events, &mut Silence::begin(Instant::now())));
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let packet = repeated();
    until("the end of the watch", || {
        for _ in 0..32 {
            socket.send_to(&packet, ("127.0.0.1", port)).unwrap();
        }
        watcher.is_finished()
    });
    let End::Timers(kept) = watcher.join().unwrap() else { panic!("expected too many timers") };
    assert!(kept > TIMERS_MAX, "{kept}");
    let metrics = responder.get_metrics().unwrap().recv_timeout(PATIENCE).unwrap();
    assert!(metrics["cached-addr"] <= RECORDS_MAX, "one record alone: {metrics:?}");
    responder.shutdown().unwrap();
}

#[test]
fn responder_is_replaced_once_its_thread_has_ended() {
    // Reports of another one: its thread is what has not ended.
    let (((responder, own), _), ((other, events), _)) = (hearing(), hearing());
    let shared = Shared::default();
    let (waiting, ended) = (shared.clone(), responder.clone());
    let waiter = thread::spawn(move || waiting.outlast(&ended, &events));
    until("the end of the responder", || has_ended(&responder) && own.is_disconnected());
    thread::sleep(Duration::from_millis(2_500));
    assert!(!waiter.is_finished(), "a thread is alive");
    other.shutdown().unwrap();
    until("the wait's end", || waiter.is_finished());
    assert!(waiter.join().unwrap(), "another responder is wanted");
}

#[test]
fn responder_that_lives_on_is_not_replaced_after_the_end() {
    let (((responder, _own), _), ((other, events), _)) = (hearing(), hearing());
    let shared = Shared::default();
    let waiting = shared.clone();
    let waiter = thread::spawn(move || waiting.outlast(&responder, &events));
    thread::sleep(Duration::from_millis(1_500));
    shared.end();
    until("the wait's end", || waiter.is_finished());
    assert!(!waiter.join().unwrap(), "no other responder is wanted");
    other.shutdown().unwrap();
}

#[test]
fn start_that_fails_is_tried_again_until_the_end() {
    let (shared, starts) = (Shared::default(), Arc::new(AtomicUsize::new(0)));
    let (followed, counted) = (shared.clone(), Arc::clone(&starts));
    let ((responder, events), _) = hearing();
    let mut started = Some((responder.clone(), events));
    let follower = thread::spawn(move || {
        followed.follow(|| match counted.fetch_add(1, Ordering::Relaxed) {
            1 => Ok(started.take().unwrap()),
            _ => Err(Error::Msg("too many open files".to_owned())),
        });
    });
    // The second attempt succeeds; its responder ends, and the third attempt fails again.
    until("the second attempt", || starts.load(Ordering::Relaxed) == 2);
    responder.shutdown().unwrap();
    until("the third attempt", || starts.load(Ordering::Relaxed) == 3);
    shared.end();
    until("the thread's end", || follower.is_finished());
}

#[test]
fn responder_of_the_moment_ends_with_the_announcement() {
    let shared = Shared::default();
    let followed = shared.clone();
    let ((responder, events), _) = hearing();
    let mut started = Some((responder.clone(), events));
    let follower = thread::spawn(move || followed.follow(|| Ok(started.take().unwrap())));
    thread::sleep(Duration::from_millis(100));
    shared.end();
    until("the ends", || has_ended(&responder) && follower.is_finished());
    follower.join().unwrap();
}

#[test]
fn pauses_between_attempts_grow_from_a_second_to_a_minute() {
    let seconds = [1, 2, 3, 6, 7, 8, u32::MAX].map(|failures| pause_after(failures).as_secs());
    assert_eq!(seconds, [1, 2, 4, 32, 60, 60, 60]);
}

#[test]
fn silence_is_reported_once_unless_the_robot_is_announced() {
    let now = Instant::now();
    let [early, late] = [14, 15].map(|seconds| now + Duration::from_secs(seconds));
    let mut silence = Silence::begin(now);
    assert_eq!([early, late, late].map(|at| silence.is_too_long(at)), [false, true, false]);
    let mut silence = Silence::begin(now);
    record(DaemonEvent::IpAdd([192, 168, 7, 5].into()), &mut silence);
    assert!(silence.is_too_long(late), "an address is no announcement");
    let mut silence = Silence::begin(now);
    record(DaemonEvent::Announce("kitchen".to_owned(), "eth0".to_owned()), &mut silence);
    assert!(!silence.is_too_long(late), "the robot is announced");
}
