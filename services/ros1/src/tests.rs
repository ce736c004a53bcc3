//! A node that hears itself, at a small master.

use crate::address::Address;
use crate::connection;
use crate::guarded;
use crate::node::{NAME, Node, Topics};
use crate::publication::Publication;
use crate::subscription::{Sink, Subscription};
use crate::types::Float64;
use crate::xmlrpc::{Value, call, serve};
use ros::wire::Message;
use service::{Time, clock};
use std::collections::BTreeSet;
use std::net::TcpListener;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

const SOON: Duration = Duration::from_secs(20);

/// Registrations: call, topic, URI of the node.
type Known = Arc<Mutex<BTreeSet<[String; 3]>>>;

/// A master that knows nobody when it starts.
struct Master {
    port: u16,
    known: Known,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Master {
    fn start(port: u16) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", port)).unwrap();
        let port = listener.local_addr().unwrap().port();
        let (known, ends) = (Known::default(), Arc::new(AtomicBool::new(false)));
        let (own, last) = (Arc::clone(&known), Arc::clone(&ends));
        let thread = std::thread::spawn(move || {
            while let Ok((mut stream, _)) = listener.accept() {
                if last.load(Ordering::Acquire) {
                    return;
                }
                let _ = serve(&mut stream, SOON, |method, given| answer(&own, method, given));
            }
        });
        Self { port, known, ends, thread: Some(thread) }
    }

    fn knows(&self) -> Vec<String> {
        guarded(&self.known).iter().map(|[call, topic, _]| format!("{call} {topic}")).collect()
    }
}

impl Drop for Master {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Release);
        let _ = std::net::TcpStream::connect(("127.0.0.1", self.port));
        self.thread.take().unwrap().join().unwrap();
    }
}

fn answer(known: &Known, method: &str, given: &[Value]) -> (i32, String, Value) {
    let mut known = guarded(known);
    let text = |i: usize| given.get(i).and_then(Value::as_text).unwrap_or_default().to_owned();
    let uris = |known: &BTreeSet<[String; 3]>, role: &str, topic: &str| {
        let found = known.iter().filter(|[own, name, _]| own == role && name == topic);
        Value::List(found.map(|[.., uri]| uri.as_str().into()).collect())
    };
    match method {
        "lookupNode" => match known.first() {
            Some([.., uri]) => (1, String::new(), uri.as_str().into()),
            None => (-1, "unknown node".to_owned(), Value::Int(0)),
        },
        "registerPublisher" => {
            known.insert(["Publisher".to_owned(), text(1), text(3)]);
            (1, String::new(), uris(&known, "Subscriber", &text(1)))
        }
        "registerSubscriber" => {
            known.insert(["Subscriber".to_owned(), text(1), text(3)]);
            (1, String::new(), uris(&known, "Publisher", &text(1)))
        }
        "unregisterPublisher" | "unregisterSubscriber" => {
            let role = method.trim_start_matches("unregister").to_owned();
            let was_known = known.remove(&[role, text(1), text(2)]);
            (1, String::new(), Value::Int(was_known.into()))
        }
        _ => (-1, "unknown call".to_owned(), Value::Int(0)),
    }
}

fn wait_for<T>(what: &str, mut fact: impl FnMut() -> Option<T>) -> T {
    let until = Instant::now() + SOON;
    loop {
        if let Some(value) = fact() {
            return value;
        }
        assert!(Instant::now() < until, "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A node that subscribes to the topic that it publishes.
fn start(master: &Master) -> (Node, Arc<Publication>, Receiver<f64>) {
    let (sender, received) = channel();
    let sink = move || -> Sink {
        let sender = sender.clone();
        Box::new(move |bytes, _| {
            let _ = sender.send(Float64::from_bytes(bytes)?.data);
            Ok(())
        })
    };
    let publication = Arc::new(Publication::new::<Float64>("/t"));
    let topics = Topics {
        published: vec![Arc::clone(&publication)],
        subscribed: vec![Arc::new(Subscription::new::<Float64>("/t", sink))],
    };
    let address = Address { master: format!("http://127.0.0.1:{}/", master.port), host: None };
    let node = Node::start(address, topics, |_| {});
    wait_for("a connection", || (publication.subscribers() == 1).then_some(()));
    (node, publication, received)
}

const REGISTERED: [&str; 2] = ["Publisher /t", "Subscriber /t"];

#[test]
fn messages_arrive_but_old_ones_are_dropped() {
    let master = Master::start(0);
    let (_node, publication, received) = start(&master);
    for data in [1.0, 2.0] {
        publication.publish(&Float64 { data }, clock::now());
        assert_eq!(received.recv_timeout(SOON), Ok(data));
    }
    let a_second_ago = Time(clock::now().ns() - 1_000_000_000);
    publication.publish(&Float64 { data: 3.0 }, a_second_ago);
    // Time for it to be taken: a message behind it would replace it.
    std::thread::sleep(Duration::from_millis(300));
    publication.publish(&Float64 { data: 4.0 }, clock::now());
    assert_eq!(received.recv_timeout(SOON), Ok(4.0));
}

#[test]
fn node_registers_at_a_restarted_master_and_unregisters_at_its_end() {
    let master = Master::start(0);
    let (node, publication, received) = start(&master);
    assert_eq!(master.knows(), REGISTERED);
    let port = master.port;
    drop(master);
    publication.publish(&Float64 { data: 1.0 }, clock::now());
    assert_eq!(received.recv_timeout(SOON), Ok(1.0), "connections go on without a master");
    let master = Master::start(port);
    wait_for("registration", || (master.knows() == REGISTERED).then_some(()));
    publication.publish(&Float64 { data: 2.0 }, clock::now());
    assert_eq!(received.recv_timeout(SOON), Ok(2.0));
    assert_eq!(publication.subscribers(), 1, "no second connection");
    drop(node);
    assert_eq!(master.knows(), Vec::<String>::new());
}

#[test]
fn calls_of_other_nodes_are_answered() {
    let master = Master::start(0);
    let (sender, asked) = channel();
    let sender = Mutex::new(sender);
    let address = Address { master: format!("http://127.0.0.1:{}/", master.port), host: None };
    let topics = Topics {
        published: vec![Arc::new(Publication::new::<Float64>("/t"))],
        subscribed: Vec::new(),
    };
    let _node = Node::start(address, topics, move |reason| {
        let _ = guarded(&sender).send(reason.to_owned());
    });
    let uri =
        wait_for("registration", || guarded(&master.known).first().map(|[.., uri]| uri.clone()));
    let names = call(&uri, "getPublications", &["/test".into()], SOON).unwrap();
    let pair = Value::List(vec!["/t".into(), "std_msgs/Float64".into()]);
    assert_eq!(names, Value::List(vec![pair]));
    let refused = call(&uri, "requestTopic", &["/test".into(), "/other".into()], SOON).unwrap_err();
    assert!(refused.to_string().contains(&format!("{NAME} does not publish /other")), "{refused}");
    call(&uri, "shutdown", &["/master".into(), "same name".into()], SOON).unwrap();
    assert_eq!(asked.recv_timeout(SOON).as_deref(), Ok("same name"));
}

/// The number of threads of this process.
fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").unwrap().count()
}

fn uri_of(master: &Master) -> String {
    wait_for("registration", || guarded(&master.known).first().map(|[.., uri]| uri.clone()))
}

/// A recorder of every topic connects often and stays.
#[test]
fn subscribers_that_stay_and_silent_ones_do_not_shut_the_api() {
    let master = Master::start(0);
    let address = Address { master: format!("http://127.0.0.1:{}/", master.port), host: None };
    let published: Vec<Arc<Publication>> =
        (0..8).map(|n| Arc::new(Publication::new::<Float64>(&format!("/t{n}")))).collect();
    let topics = Topics { published: published.clone(), subscribed: Vec::new() };
    let _node = Node::start(address, topics, |_| {});
    let uri = uri_of(&master);
    let request = ["/test".into(), "/t0".into(), Value::List(Vec::new())];
    let answer = call(&uri, "requestTopic", &request, SOON).unwrap();
    let Some([_, _, Value::Int(port)]) = answer.as_list() else { panic!("{answer:?}") };
    let place = ("127.0.0.1", u16::try_from(*port).unwrap());
    let subscribe = |n: usize| {
        let mut stream = std::net::TcpStream::connect(place).unwrap();
        connection::write_header(&mut stream, &published[n % 8].topic.fields("/recorder")).unwrap();
        connection::read_header(&mut stream).unwrap();
        stream
    };
    let stay: Vec<_> = (0..96).map(subscribe).collect();
    let silent: Vec<_> = (0..70).map(|_| std::net::TcpStream::connect(place).unwrap()).collect();
    let pid = call(&uri, "getPid", &["/test".into()], SOON).unwrap();
    assert_eq!(pid, Value::Int(std::process::id() as i32));
    let before: usize = published.iter().map(|it| it.subscribers()).sum();
    assert_eq!(before, stay.len());
    drop(silent);
    wait_for("one more subscriber", || {
        let mut stream = std::net::TcpStream::connect(place).ok()?;
        connection::write_header(&mut stream, &published[0].topic.fields("/late")).ok()?;
        connection::read_header(&mut stream).ok()
    });
}

#[test]
fn publishers_that_the_master_lists_are_bounded() {
    let master = Master::start(0);
    let (_node, _publication, received) = start(&master);
    let uri = uri_of(&master);
    let before = threads();
    let many: Vec<Value> =
        (0..3_000).map(|n| Value::from(format!("http://127.0.0.1:1/{n}").as_str())).collect();
    let update = ["/master".into(), "/t".into(), Value::List(many)];
    call(&uri, "publisherUpdate", &update, SOON).unwrap();
    assert!(threads() < before + 40, "{before} before, {} after", threads());
    drop(received);
}
