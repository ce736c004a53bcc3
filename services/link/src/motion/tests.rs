use super::*;
use messages::MotionInhibit;

fn at(ms: u64) -> Time {
    Time(0) + Span::from_ms(ms)
}

fn stop(key: u8) -> Request {
    Request { key: [key; 16], order: Order::Stop }
}

fn release(key: u8, at_ms: u64, in_force: Time) -> Request {
    let stop = StopId(in_force.ns());
    let seen = Seen { at_ns: at(at_ms).ns(), in_force_ns: in_force.ns(), stopped: true, stop };
    Request { key: [key; 16], order: Order::Release(seen) }
}

/// The arm's rules.
#[derive(Default)]
struct Arm {
    stopped: bool,
    obeyed: Time,
}

impl Arm {
    fn obey(&mut self, (order, given): (MotionOrder, Time)) {
        let is_too_soon = order == MotionOrder::Resume && given < self.obeyed + RESUME_AFTER;
        if given > self.obeyed && !(self.stopped && is_too_soon) {
            (self.stopped, self.obeyed) = (order == MotionOrder::Stop, given);
        }
    }
}

#[test]
fn repeated_stop_keeps_the_stamp_of_its_first_arrival() {
    let mut register = Register::default();
    let first = register.stamp(&stop(1), at(100)).unwrap();
    assert_eq!(first, (MotionOrder::Stop, at(100)));
    assert_eq!(register.stamp(&stop(1), at(900)).unwrap(), first);
    let second = register.stamp(&stop(2), at(100)).unwrap();
    assert!(second.1 > first.1, "two stops at once have stamps of their own");
}

#[test]
fn release_lifts_the_stop_that_it_names_and_no_later_one_in_every_order_of_arrival() {
    let one = at(1_000);
    let requests = [stop(1), release(3, 0, one), stop(2), release(4, 0, one), stop(1)];
    // Every sequence of five arrivals out of these, repeated and swapped as a network may.
    for word in 0..5_usize.pow(5) {
        let mut arm = Arm::default();
        let mut register = Register::default();
        arm.obey(register.stamp(&stop(1), one).unwrap());
        let mut is_stopped_again = false;
        for place in 0..5_u32 {
            let request = requests[word / 5_usize.pow(place) % 5];
            // The first half comes too soon to release anything.
            let now = at(2_600 + 200 * u64::from(place));
            is_stopped_again |= request.key == [2; 16];
            let request = match request.order {
                Order::Stop => request,
                Order::Release(seen) => {
                    let seen = Seen { at_ns: now.ns(), ..seen };
                    Request { order: Order::Release(seen), ..request }
                }
            };
            match register.stamp(&request, now) {
                Ok(order) => arm.obey(order),
                Err(why) => assert!(why.contains("less than 2 s"), "{why}"),
            }
        }
        assert!(arm.stopped || !is_stopped_again, "{word}: a later stop was released");
    }
}

#[test]
fn stop_is_repeated_at_the_robot_without_the_network() {
    use service::group::GroupPaths;
    use service::stop_socket::StopListener;
    let home = tempfile::tempdir().unwrap();
    let paths = GroupPaths::in_home(home.path(), &"lab".parse().unwrap()).unwrap();
    std::fs::create_dir_all(paths.run()).unwrap();
    let (client, mut standing) = (StopClient::open(&paths).unwrap(), StandingStop::default());
    // One request arrives; the arm's service is away for an hour, and nothing else arrives.
    standing.take(MotionOrder::Stop, at(100));
    assert!(standing.repeats(at(100)));
    for ms in (100..3_600_000).step_by(1_000) {
        standing.advance(&client, at(ms));
        assert!(standing.is_open(), "after {ms} ms");
    }
    let arm = StopListener::bind(&paths).unwrap();
    standing.advance(&client, at(3_600_100));
    let mut heard = Vec::new();
    arm.drain(|command, _| heard.push((command.order, Time(command.given_ns))));
    assert_eq!(heard, [(MotionOrder::Stop, at(100))]);
    let state = StopState {
        given_ns: at(100).ns(),
        in_force_ns: at(100).ns(),
        stopped: true,
        at_rest: true,
        durable: true,
        inhibit: MotionInhibit::None,
        stop: StopId(0),
    };
    standing.on_answer(state, at(3_600_101));
    standing.advance(&client, at(3_600_101));
    assert!(!standing.is_open());
    // A repetition of the request that was held up in the network, and a release.
    standing.take(MotionOrder::Stop, at(100));
    standing.take(MotionOrder::Resume, at(3_700_000));
    assert!(!standing.is_open());
}

#[test]
fn old_release_is_refused() {
    let mut register = Register::default();
    assert!(register.stamp(&release(1, 1_000, at(900)), at(3_000)).is_ok());
    let error = register.stamp(&release(2, 1_000, at(900)), at(3_001)).unwrap_err();
    assert!(error.contains("2.0 s old"), "{error}");
    assert!(register.stamp(&release(3, 9_000, at(900)), at(3_000)).is_err(), "from the future");
}

#[test]
fn release_that_came_too_soon_stays_refused_however_often_it_is_repeated() {
    let mut register = Register::default();
    assert!(register.stamp(&release(1, 2_800, at(900)), at(2_899)).is_err());
    assert!(register.stamp(&release(1, 2_950, at(900)), at(3_000)).is_err());
    let given_again = register.stamp(&release(2, 2_950, at(900)), at(3_000));
    assert_eq!(given_again, Ok((MotionOrder::Resume, at(3_000))));
}

#[test]
fn request_is_repeated_under_one_key_while_its_client_wants_it() {
    let mut orders = Orders::default();
    let given = StopOrder::new(MotionOrder::Stop, at(50));
    let mut sent = Vec::new();
    for ms in (0..3_000).step_by(10) {
        if ms < 1_000 {
            let key = [ms as u8; 16];
            let taken = orders.take(&given, None, key, at(ms));
            assert_eq!(taken, Ok(None));
        }
        sent.extend(orders.due(None, at(ms)).map(|(request, way)| (ms, request.key[0], way)));
    }
    let both = |ms| [(ms, 0, Way::First), (ms + 10, 0, Way::Second)];
    let expected: Vec<_> = (0..2_000).step_by(250).flat_map(both).collect();
    assert_eq!(sent, expected);
}

#[test]
fn answers_come_back_in_the_clients_time() {
    let mut orders = Orders::default();
    let given = at(50).ns();
    orders.take(&StopOrder::new(MotionOrder::Stop, at(50)), None, [1; 16], at(50)).unwrap();
    let state = StopState {
        given_ns: 900,
        in_force_ns: 900,
        stopped: true,
        at_rest: false,
        durable: false,
        inhibit: MotionInhibit::None,
        stop: StopId(0),
    };
    assert_eq!(orders.on_answer([2; 16], &Answer::State(Stamped(state))), None);
    let here = orders.on_answer([1; 16], &Answer::State(Stamped(state))).unwrap();
    assert_eq!((here.given_ns, here.in_force_ns, here.at_rest), (given, given, false));
    let overruled = Stamped(StopState { in_force_ns: 901, ..state });
    assert_eq!(overruled.here(given).in_force_ns, given + 1);
    assert!(orders.due(None, at(60)).is_some(), "until it is at rest");
    let done = Stamped(StopState { at_rest: true, durable: true, ..state });
    orders.on_answer([1; 16], &Answer::State(done));
    assert_eq!(orders.due(None, at(900)), None);
}

#[test]
fn release_needs_a_state_and_keeps_to_the_stop_that_was_seen() {
    let mut orders = Orders::default();
    let resume = StopOrder::new(MotionOrder::Resume, at(50));
    assert!(orders.take(&resume, None, [1; 16], at(50)).is_err());
    let seen = Seen { at_ns: 10, in_force_ns: 5, stopped: true, stop: StopId(5) };
    orders.take(&resume, Some(seen), [1; 16], at(50)).unwrap();
    let newer = Seen { at_ns: 20, ..seen };
    assert_eq!(orders.due(Some(newer), at(50)).unwrap().0.order, Order::Release(newer));
    let other_stop = Seen { at_ns: 30, in_force_ns: 25, stopped: true, stop: StopId(25) };
    assert_eq!(orders.due(Some(other_stop), at(400)).unwrap().0.order, Order::Release(newer));
    // The person saw an earlier stop than the mirror did: the arm is to refuse the release.
    let late = StopOrder { stop: seen.stop, ..StopOrder::new(MotionOrder::Resume, at(500)) };
    orders.take(&late, Some(other_stop), [2; 16], at(500)).unwrap();
    let named = Seen { stop: seen.stop, ..other_stop };
    assert_eq!(orders.due(Some(other_stop), at(500)).unwrap().0.order, Order::Release(named));
    let newest = Seen { at_ns: 40, ..other_stop };
    let named = Seen { at_ns: 40, ..named };
    assert_eq!(orders.due(Some(newest), at(510)).unwrap().0.order, Order::Release(named));
}

#[test]
fn question_for_the_state_is_answered_here_and_orders_nothing() {
    let mut orders = Orders::default();
    assert_eq!(orders.take(&LOOK, None, [1; 16], at(900)), Ok(None));
    let seen =
        Seen { at_ns: at(500).ns(), in_force_ns: at(200).ns(), stopped: true, stop: StopId(7) };
    let state = orders.take(&LOOK, Some(seen), [1; 16], at(900)).unwrap().unwrap();
    assert_eq!((state.given_ns, state.stop, state.stopped), (0, StopId(7), true));
    assert_eq!(state.in_force_ns, at(600).ns(), "as long ago as on the robot");
    assert_eq!(orders.due(Some(seen), at(900)), None);
}
