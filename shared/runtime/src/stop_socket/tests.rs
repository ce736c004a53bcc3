use super::*;
use crate::group::GroupName;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

/// A group's folder with `run/`.
fn group() -> (tempfile::TempDir, GroupPaths) {
    let home = tempfile::tempdir().unwrap();
    let paths = GroupPaths::in_home(home.path(), &GroupName::new("stop").unwrap()).unwrap();
    std::fs::create_dir_all(paths.run()).unwrap();
    (home, paths)
}

/// The state of an arm that obeyed `command` and has come to rest.
fn obeyed(command: &StopOrder) -> StopState {
    StopState {
        given_ns: command.given_ns,
        in_force_ns: command.given_ns,
        stopped: command.order == MotionOrder::Stop,
        at_rest: true,
        durable: true,
        inhibit: MotionInhibit::None,
    }
}

/// Gives an order to an arm that answers with the states that `answer` makes, one an order.
fn give_to(
    paths: &GroupPaths,
    order: MotionOrder,
    patience_ms: u64,
    mut answer: impl FnMut(&StopOrder, u32) -> Option<StopState> + Send,
) -> Result<StopState, StopError> {
    let listener = StopListener::bind(paths).unwrap();
    let done = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            let mut count = 0;
            while !done.load(Ordering::Relaxed) {
                listener.drain(|command, caller| {
                    count += 1;
                    let state = answer(&command, count);
                    state.iter().for_each(|state| listener.answer(&caller, state));
                });
                thread::yield_now();
            }
        });
        let result = give(paths, order, Span::from_ms(patience_ms), &mut |_| true);
        done.store(true, Ordering::Relaxed);
        result
    })
}

#[test]
fn order_is_repeated_until_the_arm_rests() {
    let (_home, paths) = group();
    let state = give_to(&paths, MotionOrder::Stop, 20_000, |command, count| {
        let lost = count.is_multiple_of(2);
        (!lost).then(|| StopState { at_rest: count > 4, ..obeyed(command) })
    });
    assert!(state.unwrap().at_rest);
    let state = give_to(&paths, MotionOrder::Resume, 20_000, |command, _| Some(obeyed(command)));
    assert!(!state.unwrap().stopped);
}

#[test]
fn stop_that_cannot_become_durable_is_confirmed_as_such() {
    let (_home, paths) = group();
    let state = give_to(&paths, MotionOrder::Stop, 20_000, |command, _| {
        Some(StopState { durable: false, ..obeyed(command) })
    });
    assert!(!state.unwrap().durable);
}

#[test]
fn unconfirmed_orders_end_with_the_reason() {
    let (_home, paths) = group();
    let moving = give_to(&paths, MotionOrder::Stop, 100, |command, _| {
        Some(StopState { at_rest: false, ..obeyed(command) })
    });
    assert!(matches!(moving, Err(StopError::Moving(_))), "{moving:?}");
    let silent = give_to(&paths, MotionOrder::Stop, 100, |_, _| None);
    assert!(matches!(silent, Err(StopError::Silent(_))), "{silent:?}");
    let overruled = give_to(&paths, MotionOrder::Stop, 20_000, |command, _| {
        let in_force_ns = command.given_ns + 1;
        Some(StopState { stopped: false, in_force_ns, ..obeyed(command) })
    });
    assert_eq!(overruled, Err(StopError::Overruled));
    let latched = give_to(&paths, MotionOrder::Resume, 100, |command, _| {
        Some(StopState { stopped: true, inhibit: MotionInhibit::Stopped, ..obeyed(command) })
    });
    assert!(matches!(latched, Err(StopError::NotTaken(_, MotionInhibit::Stopped))), "{latched:?}");
}

#[test]
fn absent_service_is_reported_soon_with_the_emergency_stop() {
    let (_home, paths) = group();
    // The socket of a service that was killed.
    drop(StopListener::bind(&paths).unwrap());
    let mut reasons = Vec::new();
    let given = clock::now();
    let result = give(&paths, MotionOrder::Stop, Span::from_ms(60_000), &mut |reason| {
        reasons.push(reason.clone());
        true
    });
    assert_eq!(result, Err(StopError::Absent));
    assert!(reasons.len() > 1 && reasons.iter().all(|reason| *reason == StopError::Absent));
    assert!(clock::now().since(given) < Span::from_ms(30_000), "not at the end of its patience");
    let mut asked = 0;
    let result = give(&paths, MotionOrder::Stop, Span::from_ms(60_000), &mut |_| {
        asked += 1;
        asked < 3
    });
    assert_eq!((result, asked), (Err(StopError::Absent), 3));
    assert!(StopError::Absent.to_string().contains("emergency stop"));
    std::fs::remove_dir_all(paths.run()).unwrap();
    let result = give(&paths, MotionOrder::Stop, Span::from_ms(60_000), &mut |_| true);
    assert_eq!(result, Err(StopError::NoGroup("stop".to_owned())));
}

#[test]
fn restarted_service_takes_the_repeated_order() {
    let (_home, paths) = group();
    drop(StopListener::bind(&paths).unwrap());
    let (noted, trouble) = std::sync::mpsc::channel();
    let paths = &paths;
    thread::scope(|scope| {
        let listener = scope.spawn(move || {
            trouble.recv().unwrap();
            let listener = StopListener::bind(paths).unwrap();
            let mut answered = false;
            while !answered {
                listener.drain(|command, caller| {
                    listener.answer(&caller, &obeyed(&command));
                    answered = true;
                });
            }
        });
        let state = give(paths, MotionOrder::Stop, Span::from_ms(60_000), &mut |_| {
            // The listener takes the first of them.
            let _ = noted.send(());
            true
        });
        listener.join().unwrap();
        assert!(state.unwrap().stopped);
    });
}

#[test]
fn nonsense_and_floods_are_passed_over() {
    let (_home, paths) = group();
    let listener = StopListener::bind(&paths).unwrap();
    let speaker = std::os::unix::net::UnixDatagram::unbound().unwrap();
    speaker.set_nonblocking(true).unwrap();
    let long = vec![b'x'; 4 * DATAGRAM_BYTES_MAX];
    for datagram in [&b""[..], b"stop", b"{}", b"{\"order\":\"stop\"}", b"\xff\xfe", &long] {
        speaker.send_to(datagram, paths.stop_socket()).unwrap();
        listener.drain(|command, _| panic!("{command:?}"));
    }
    let client = StopClient::open(&paths).unwrap();
    // The queue of the socket is bounded, and nobody is kept waiting by it.
    for _ in 0..5_000 {
        client.send(MotionOrder::Stop, Time(7)).unwrap();
    }
    let mut count = 0;
    listener.drain(|command, caller| {
        count += 1;
        assert_eq!((command.given_ns, command.order), (7, MotionOrder::Stop));
        listener.answer(&caller, &obeyed(&command));
    });
    assert!((1..=DATAGRAMS_MAX).contains(&count), "{count}");
    assert_eq!(client.take().map(|state| state.given_ns), Some(7));
}
