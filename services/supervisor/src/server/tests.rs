use std::io::{BufRead, BufReader};

use super::*;

struct Bench {
    _folder: tempfile::TempDir,
    path: std::path::PathBuf,
    server: Server,
}

const NOW: Time = Duration::from_secs(1);

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("control.sock");
        let server = Server::bind(&path).unwrap();
        Self { _folder: folder, path, server }
    }

    fn connect(&mut self) -> UnixStream {
        let stream = UnixStream::connect(&self.path).unwrap();
        self.server.accept(NOW);
        stream
    }

    /// Serves every connection and collects the requests.
    fn requests(&mut self) -> Vec<(Client, Request)> {
        let clients: Vec<Client> = self.server.connections.keys().copied().collect();
        let take = |client| Some((client, self.server.advance(client, PollFlags::IN, NOW)?));
        clients.into_iter().filter_map(take).collect()
    }
}

fn line(stream: &UnixStream) -> String {
    let mut line = String::new();
    BufReader::new(stream).read_line(&mut line).unwrap();
    line
}

#[test]
fn server_answers_a_fragmented_request() {
    let mut bench = Bench::new();
    let mut stream = bench.connect();
    stream.write_all(b"{\"verb\":").unwrap();
    assert_eq!(bench.requests(), []);
    stream.write_all(b"\"ping\"}\nrest").unwrap();
    let requests = bench.requests();
    let [(client, Request::Ping)] = requests[..] else { panic!("{requests:?}") };
    assert!(bench.server.is_waiting(client));
    bench.server.reply(client, &Reply::Done { message: "here".into() }, NOW);
    assert_eq!(line(&stream), "{\"reply\":\"done\",\"message\":\"here\"}\n");
    assert!(bench.server.connections.is_empty());
}

#[test]
fn nonsense_is_answered_with_the_reason() {
    let mut bench = Bench::new();
    let mut stream = bench.connect();
    stream.write_all(b"hello\n").unwrap();
    assert_eq!(bench.requests(), []);
    assert!(line(&stream).contains("not a request"));
}

#[test]
fn server_drops_a_client_that_sends_too_much() {
    let mut bench = Bench::new();
    let mut stream = bench.connect();
    stream.set_nonblocking(true).unwrap();
    for _ in 0..64 {
        // Fails once the other side has closed.
        let _ = stream.write(&[b'x'; 4096]);
        assert_eq!(bench.requests(), []);
    }
    assert!(bench.server.connections.is_empty());
}

#[test]
fn slow_clients_are_dropped_and_waiting_ones_are_not() {
    let mut bench = Bench::new();
    let _silent = bench.connect();
    let mut patient = bench.connect();
    patient.write_all(b"{\"verb\":\"down\"}\n").unwrap();
    assert_eq!(bench.requests().len(), 1);
    bench.server.drop_slow(NOW + CLIENT_PATIENCE);
    assert_eq!(bench.server.connections.len(), 1);
}

#[test]
fn server_rejects_connections_beyond_the_limit() {
    let mut bench = Bench::new();
    let _others: Vec<_> = (0..CONNECTIONS_MAX).map(|_| bench.connect()).collect();
    let stream = bench.connect();
    assert!(line(&stream).contains("too many"));
    assert_eq!(bench.server.connections.len(), CONNECTIONS_MAX);
}

#[test]
fn server_is_not_blocked_by_a_client_that_never_reads() {
    let mut bench = Bench::new();
    let mut stream = bench.connect();
    stream.write_all(b"{\"verb\":\"status\"}\n").unwrap();
    let (client, _) = bench.requests()[0].clone();
    let message = "x".repeat(8 << 20);
    bench.server.reply(client, &Reply::Done { message }, NOW);
    assert_eq!(bench.server.connections.len(), 1, "the rest waits in a buffer");
    bench.server.drop_slow(NOW + CLIENT_PATIENCE);
    assert!(bench.server.connections.is_empty());
}
