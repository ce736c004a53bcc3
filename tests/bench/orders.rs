//! From a decision to pick to its acceptance by the arm and to the first motion, with the journals on the
//! disk and in memory, and the interval between joint states while the arm plans.

use crate::report::{Report, percentile};
use messages::{ArmStatus, JointStates, PickId, PickPhase, RobotAct, topics};
use service::bus::Reader;
use service::client::Client;
use std::collections::BTreeMap;
use std::time::Duration;
use whichone_tests::{Group, UR5E};

/// Polling interval of the topics; the shortest of them holds 160 ms of joint states.
const LOOK_EVERY: Duration = Duration::from_millis(5);
/// Time after a pick in which the arm returns to rest.
const REST: Duration = Duration::from_millis(500);
/// Fetches in each situation.
const FETCHES: usize = 20;

/// A scene with a request and the objects that it may mean, and the settings for them.
struct Orders {
    scene: &'static str,
    settings: &'static [&'static str],
    request: &'static str,
    objects: [&'static str; 6],
}

/// Short plans and long ones, and those of one arm of six joints.
const ORDERS: [Orders; 3] = [
    Orders {
        scene: "bowls",
        settings: &["group.scene=bowls"],
        request: "get me the bowl",
        objects: ["white", "white2", "white3", "metal", "metal2", "clear"],
    },
    Orders {
        scene: "tools",
        settings: &["group.scene=tools"],
        request: "get me the tool",
        objects: ["m_red", "m_black", "p_blue", "s_red", "w_black", "w_red"],
    },
    Orders {
        scene: "blocks (UR5e)",
        settings: &UR5E,
        request: "get me a block",
        objects: [
            "red_small",
            "red_large",
            "blue_small",
            "blue_large",
            "green_large",
            "yellow_small",
        ],
    },
];

pub(crate) fn measure(report: &mut Report, quick: bool) {
    let fetches = if quick { FETCHES / 5 } else { FETCHES };
    for orders in &ORDERS {
        orders.measure(report, "disk", &Group::up(orders.settings), fetches);
        let in_memory = Group::up_in_memory(orders.settings);
        orders.measure(report, "a memory file system", &in_memory, fetches);
    }
}

impl Orders {
    fn measure(&self, report: &mut Report, place: &str, group: &Group, fetches: usize) {
        let moments = self.fetch_all(group, fetches);
        moments.add(report, &format!("{}, journals on {place}", self.scene));
    }

    /// Fetches one object after another and returns the moments of each order.
    fn fetch_all(&self, group: &Group, fetches: usize) -> Moments {
        let client = Client::join(group.paths()).expect("a running group");
        let taps = Taps::open(&client);
        let fetch = |object: &str| {
            let outcome = group.fetch(self.request, object);
            assert_eq!(outcome["object"], object, "{outcome}");
            std::thread::sleep(REST);
        };
        std::thread::scope(|scope| {
            let user = scope
                .spawn(|| (0..fetches).for_each(|n| fetch(self.objects[n % self.objects.len()])));
            taps.watch(|| user.is_finished())
        })
    }
}

struct Taps {
    acts: Reader<RobotAct>,
    statuses: Reader<ArmStatus>,
    joints: Reader<JointStates>,
}

/// Times of one order, nanoseconds of the monotonic clock; 0 for what was not seen.
#[derive(Default)]
struct Order {
    decided: u64,
    sent: u64,
    accepted: u64,
    /// The first phase after the acceptance, which begins with a plan.
    moving: u64,
}

#[derive(Default)]
struct Moments {
    orders: BTreeMap<PickId, Order>,
    joints: Vec<u64>,
}

impl Taps {
    fn open(client: &Client) -> Self {
        let bus = client.bus();
        Self {
            acts: bus.reader(&topics::ACT).expect("acts"),
            statuses: bus.reader(&topics::STATUS).expect("statuses"),
            joints: bus.reader(&topics::JOINTS).expect("joint states"),
        }
    }

    fn watch(&self, is_over: impl Fn() -> bool) -> Moments {
        let mut moments = Moments::default();
        while !is_over() {
            self.collect(&mut moments);
            std::thread::sleep(LOOK_EVERY);
        }
        moments
    }

    fn collect(&self, Moments { orders, joints }: &mut Moments) {
        let acts = self.acts.drain_stamped(|act, stamp| {
            if let Some((id, _)) = act.pick() {
                let (decided, sent) = (act.decided_ns, stamp.sent_ns);
                orders.entry(id).or_insert(Order { decided, sent, ..Order::default() });
            }
        });
        let statuses = self.statuses.drain_stamped(|status, stamp| {
            let Some(order) = orders.get_mut(&status.pick()) else { return };
            let phase = status.phase.get();
            if order.accepted == 0 && phase >= PickPhase::Accepted {
                order.accepted = stamp.sent_ns;
            }
            if order.moving == 0 && phase >= PickPhase::Moving {
                order.moving = stamp.sent_ns;
            }
        });
        let states = self.joints.drain_stamped(|_, stamp| joints.push(stamp.sent_ns));
        acts.and(statuses).and(states).expect("topics that can be read");
    }
}

impl Moments {
    fn add(&self, report: &mut Report, situation: &str) {
        let orders = || self.orders.values().filter(|order| order.moving > 0);
        let ms = |from: fn(&Order) -> u64, to: fn(&Order) -> u64| -> Vec<f64> {
            orders().map(|order| to(order).saturating_sub(from(order)) as f64 / 1e6).collect()
        };
        let mut add = |what: &str, samples: &[f64], note: &str| {
            let max = percentile(samples, 1.0);
            let note = format!("max {max:.2} ms{note}");
            report.add(&format!("{what}: {situation}"), "ms", samples, &note);
        };
        add("decision to its publication", &ms(|o| o.decided, |o| o.sent), "; the policy's sync");
        let accepted = ms(|o| o.sent, |o| o.accepted);
        add("published decision to acceptance by the arm", &accepted, "; the arm's sync, two hops");
        add(
            "published decision to the phase `moving`",
            &ms(|o| o.sent, |o| o.moving),
            "; with the plan",
        );
        let longest: Vec<f64> = orders().map(|order| self.longest_interval_ms(order)).collect();
        add("longest interval of joint states while the arm plans", &longest, "; nominal 10 ms");
    }

    /// Longest interval between two joint states that overlaps the planning of an order, which begins with
    /// its acceptance.
    fn longest_interval_ms(&self, order: &Order) -> f64 {
        let overlaps = |pair: &&[u64]| pair[1] > order.accepted && pair[0] < order.moving;
        let pairs = self.joints.windows(2).filter(overlaps);
        pairs.map(|pair| (pair[1] - pair[0]) as f64 / 1e6).fold(0.0, f64::max)
    }
}
