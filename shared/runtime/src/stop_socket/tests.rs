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

fn at(ms: u64) -> Time {
    Time(1_000_000 * ms)
}

fn command(order: MotionOrder, given_ms: u64) -> StopOrder {
    StopOrder::new(order, at(given_ms))
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
        stop: StopId(0),
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
        let in_force_ns = command.given_ns - RESUME_AFTER.0;
        let inhibit = MotionInhibit::Stopped;
        Some(StopState { stopped: true, inhibit, in_force_ns, ..obeyed(command) })
    });
    assert!(matches!(latched, Err(StopError::NotTaken(_, MotionInhibit::Stopped))), "{latched:?}");
    let soon = give_to(&paths, MotionOrder::Resume, 20_000, |command, _| {
        let in_force_ns = command.given_ns - RESUME_AFTER.0 + 1;
        Some(StopState { stopped: true, in_force_ns, ..obeyed(command) })
    });
    assert_eq!(soon, Err(StopError::TooSoon));
}

#[test]
fn stop_that_its_giver_leaves_waits_for_the_arm() {
    let (_home, paths) = group();
    assert!(give(&paths, MotionOrder::Stop, Span::from_ms(20), &mut |_| true).is_err());
    assert!(is_kept(&paths));
    // Its giver is gone; a new arm binds the socket.
    let arm = StopListener::bind(&paths).unwrap();
    let mut kept = KeptStop::find(&paths).unwrap().unwrap();
    assert!(!kept.pass());
    let mut orders = Vec::new();
    arm.drain(|order, caller| orders.push((order, caller)));
    let (order, caller) = orders.pop().unwrap();
    assert_eq!(order.order, MotionOrder::Stop);
    assert!(!kept.pass() && is_kept(&paths), "until the arm is at rest, for good");
    arm.answer(&caller, &StopState { durable: false, ..obeyed(&order) });
    assert!(!kept.pass() && is_kept(&paths));
    arm.answer(&caller, &obeyed(&order));
    assert!(kept.pass() && !is_kept(&paths));
    assert!(KeptStop::find(&paths).unwrap().is_none());

    // A file without a time is a stop as well, given now.
    let before = clock::now().ns();
    let given = || KeptStop::find(&paths).unwrap().unwrap().order().given_ns;
    std::fs::write(paths.kept_stop(), "").unwrap();
    assert!(given() >= before);
    std::fs::remove_file(paths.kept_stop()).unwrap();
    std::os::unix::fs::symlink("nowhere", paths.kept_stop()).unwrap();
    assert!(given() >= before);
    kept::forget(&paths.kept_stop());
    std::fs::create_dir(paths.kept_stop()).unwrap();
    assert!(given() >= before);
    kept::forget(&paths.kept_stop());
    assert!(!is_kept(&paths));
}

#[test]
fn latest_stop_is_kept_whoever_ends_last() {
    let (_home, paths) = group();
    for given_ns in [200, 100, 300] {
        kept::keep(&paths, given_ns).unwrap();
    }
    assert_eq!(std::fs::read_to_string(paths.kept_stop()).unwrap(), "300\n");
    // The group is down; the next one's arm must not move either.
    std::fs::remove_dir_all(paths.run()).unwrap();
    kept::forget(&paths.kept_stop());
    let ended = give(&paths, MotionOrder::Stop, None, &mut |_| true);
    assert!(matches!(ended, Err(StopError::NoGroup(_))) && is_kept(&paths), "{ended:?}");
}

#[test]
fn stop_that_is_not_answered_is_kept_while_it_is_repeated() {
    let (_home, paths) = group();
    let mut stop = RepeatedStop::open(&paths).unwrap();
    stop.give(clock::now());
    while !is_kept(&paths) {
        assert_eq!(stop.pass(), None);
        thread::yield_now();
    }
    let arm = StopListener::bind(&paths).unwrap();
    while stop.pass().is_none() {
        arm.drain(|order, caller| arm.answer(&caller, &obeyed(&order)));
    }
    assert!(!is_kept(&paths), "carried out");
}

#[test]
fn stop_outlasts_every_restart_and_warns_now_and_then() {
    // Longer than any backoff, hold or upload: a day without a listener.
    let mut stop = Progress::new(MotionOrder::Stop, at(1), default_patience(MotionOrder::Stop));
    let mut warnings = Vec::new();
    for ms in (1..86_400_000).step_by(500) {
        if stop.due(at(ms)) {
            stop.on_sent(&Err(StopError::Absent));
        }
        assert_eq!(stop.result(at(ms)), None, "after {ms} ms");
        warnings.extend(stop.warning(at(ms)).map(|why| (ms, why)));
    }
    assert_eq!(warnings[0], (1, StopError::Absent), "at once");
    assert!(warnings.windows(2).all(|pair| pair[1].0 - pair[0].0 == 3_000), "every few seconds");
    assert!(StopError::Absent.to_string().contains("emergency stop"));
    // The service is back, and answers.
    assert!(stop.due(at(86_400_000)));
    stop.on_sent(&Ok(()));
    stop.on_answer(obeyed(&command(MotionOrder::Stop, 1)), at(86_400_001));
    assert!(matches!(stop.result(at(86_400_001)), Some(Ok(state)) if state.at_rest));
    assert_eq!(stop.warning(at(86_400_001)), None);
}

#[test]
fn release_is_given_up_soon() {
    let mut release =
        Progress::new(MotionOrder::Resume, at(1), default_patience(MotionOrder::Resume));
    release.on_sent(&Err(StopError::Absent));
    assert_eq!(release.result(at(5_000)), None);
    assert_eq!(release.result(at(5_001)), Some(Err(StopError::Absent)));
}

#[test]
fn release_names_its_stop_and_ends_if_another_one_holds() {
    let (_home, paths) = group();
    let listener = StopListener::bind(&paths).unwrap();
    let client = StopClient::open(&paths).unwrap();
    let heard = || {
        let mut orders = Vec::new();
        listener.drain(|order, _| orders.push(order.stop));
        orders
    };
    let given = at(9_000);
    let mut release = Progress::new(MotionOrder::Resume, given, RELEASE_PATIENCE).of(StopId(5));
    release.advance(&client, given);
    assert_eq!(heard(), [StopId(5)]);
    let held = obeyed(&command(MotionOrder::Stop, 9_000));
    release.on_answer(StopState { stop: StopId(5), in_force_ns: 0, ..held }, at(9_001));
    assert_eq!(release.result(at(9_002)), None, "the arm is about to release it");
    release.on_answer(StopState { stop: StopId(6), in_force_ns: 0, ..held }, at(9_003));
    assert_eq!(release.result(at(9_003)), Some(Err(StopError::OtherStop)));
    release.renew(at(9_004), StopId(6));
    release.advance(&client, at(9_004));
    assert_eq!((heard(), release.result(at(9_004))), (vec![StopId(6)], None));
    // Orders of older clients name none, and those to older arms must not.
    let speaker = std::os::unix::net::UnixDatagram::bind(paths.run().join("old")).unwrap();
    speaker.send_to(br#"{"order":"resume","given_ns":7}"#, paths.stop_socket()).unwrap();
    client.send(&StopOrder::new(MotionOrder::Stop, given)).unwrap();
    assert_eq!(heard(), [StopId(0), StopId(0)]);
}

#[test]
fn what_an_arm_answered_before_its_end_confirms_nothing() {
    let mut stop = Progress::new(MotionOrder::Stop, at(1), None);
    let lost = StopState { durable: false, ..obeyed(&command(MotionOrder::Stop, 1)) };
    stop.on_answer(lost, at(2));
    stop.on_sent(&Err(StopError::Absent));
    assert_eq!(stop.result(at(10_000)), None);
    stop.on_answer(lost, at(10_000));
    assert_eq!(stop.result(at(10_499)), None);
    assert_eq!(stop.result(at(10_500)), Some(Ok(lost)), "it cannot become durable");
}

#[test]
fn robot_that_is_not_heard_is_not_called_stopped() {
    let mut stop = Progress::new(MotionOrder::Stop, at(1), None);
    let heard = obeyed(&command(MotionOrder::Stop, 1));
    let unheard = StopState { inhibit: MotionInhibit::Unheard, ..heard };
    stop.on_answer(unheard, at(2));
    assert_eq!(stop.result(at(1_001)), None, "an arm that has just started hears it soon");
    assert_eq!(stop.result(at(1_002)), Some(Err(StopError::Unheard)));
    stop.on_answer(heard, at(1_001));
    assert_eq!(stop.result(at(1_002)), Some(Ok(heard)));
}

#[test]
fn order_that_is_given_again_puts_off_neither_its_deadline_nor_its_warning() {
    let mut stop = Progress::new(MotionOrder::Stop, at(0), Span::from_ms(4_000));
    let mut warned = None;
    for ms in (0..4_000).step_by(20) {
        stop.renew(at(ms), StopId(0));
        assert!(stop.due(at(ms)), "each is sent at once");
        stop.on_sent(&Ok(()));
        warned = warned.or(stop.warning(at(ms)).map(|_| ms));
        assert_eq!(stop.result(at(ms)), None);
    }
    assert_eq!(warned, Some(260));
    stop.on_answer(obeyed(&command(MotionOrder::Stop, 0)), at(3_990));
    assert!(matches!(stop.result(at(4_000)), Some(Err(StopError::Silent(_)))), "of an earlier one");
}

#[test]
fn giver_may_end_an_order_and_a_group_that_is_down_has_none() {
    let (_home, paths) = group();
    // The socket of a service that was killed.
    drop(StopListener::bind(&paths).unwrap());
    let (mut asked, mut warnings) = (0, Vec::new());
    let result = give(&paths, MotionOrder::Stop, None, &mut |why| {
        asked += 1;
        warnings.extend(why);
        asked < 5
    });
    assert_eq!((result, asked), (Err(StopError::Ended), 5));
    assert_eq!(warnings, [StopError::Absent], "not with each repetition");
    std::fs::remove_dir_all(paths.run()).unwrap();
    let result = give(&paths, MotionOrder::Stop, None, &mut |_| true);
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
        let state = give(paths, MotionOrder::Stop, None, &mut |why| {
            // The listener takes the first of them.
            why.map(|_| noted.send(()));
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
    let long = vec![b'x'; 4 * datagram::BYTES_MAX];
    for datagram in [&b""[..], b"stop", b"{}", b"{\"order\":\"stop\"}", b"\xff\xfe", &long] {
        speaker.send_to(datagram, paths.stop_socket()).unwrap();
        listener.drain(|command, _| panic!("{command:?}"));
    }
    let client = StopClient::open(&paths).unwrap();
    // The queue of the socket is bounded, and never blocks a sender.
    for _ in 0..5_000 {
        client.send(&StopOrder::new(MotionOrder::Stop, Time(7))).unwrap();
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
