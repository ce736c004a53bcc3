//! The gateway: the consoles of many robots under one address, with each person's rights to each
//! robot and an audit (docs/fleet.md).
//!
//! A robot is a group of this machine, or a mirror of one elsewhere, whose console knows no people:
//! it has one token, which the gateway keeps. The gateway is in front of the consoles, knows people
//! by their secrets, and judges every frame of their pages ([`rules`]). It needs no transport: the
//! link's program is started for the list of robots ([`feed`]) and for mirrors ([`mirrors`]).

mod access;
pub mod audit;
mod budgets;
pub mod cli;
pub mod feed;
mod mirrors;
pub mod people;
mod programs;
mod proxy;
mod robots;
pub mod rules;
mod socket;
mod sounds;
mod web;

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use service::clock;
use service::exit::{Exit, Failure};
use service::folders::make_private;
use service::group::GroupName;
use tokio::sync::watch;
use web_server::audit::Audit;
use web_server::connections::{Gate, Of, Pages};
use web_server::sessions::Sessions;

use access::{Address, SESSIONS, SESSIONS_FILE};
use budgets::{Budgets, Places};
use people::{People, PeopleFile};
use robots::Robots;
use roster::Name;

/// Intervals at which unused mirrors are looked for, and expired connections and the wish to end.
const TIDY_EVERY: Duration = Duration::from_secs(10);
const LOOK_EVERY: Duration = Duration::from_millis(100);
/// Most connections, including pages.
const CONNECTIONS_MAX: usize = 512;
/// Time for open pages to be closed.
const CLOSE: Duration = Duration::from_secs(2);

/// Served groups, and addresses.
#[derive(Clone, Debug)]
struct Options {
    /// The gateway's folder: people, sessions, audit.
    folder: PathBuf,
    /// Groups on the gateway's machine.
    groups: Vec<GroupName>,
    /// Keys of a person, for robots elsewhere.
    keys: Option<PathBuf>,
    /// Address to listen on.
    listen: SocketAddr,
    /// The address under which people reach it.
    address: Option<Address>,
}

/// Everything that requests share.
#[derive(Debug)]
struct Gateway {
    people: PeopleFile,
    sessions: Sessions<Name>,
    audit: Audit,
    robots: Robots,
    address: Address,
    /// Number of pages that were opened.
    visits: AtomicU64,
    /// Budgets of each person for entries in the audit.
    budgets: Budgets,
    /// The places of each person's pages.
    places: Places,
    ending: watch::Sender<bool>,
}

/// Serves until SIGTERM or SIGINT. `ready` is called with the address once it listens.
///
/// # Errors
/// The folder, its files or the port cannot be had.
fn serve(
    options: &Options,
    ready: impl FnOnce(&Address) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let is_ending = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&is_ending))
            .map_err(|error| Failure::new(Exit::NotReached, format!("signals: {error}")))?;
    }
    if !options.listen.ip().is_loopback() && options.address.is_none() {
        let what = "expected --address: the https://… under which people reach the gateway; help: put a proxy with \
                    https before it, secrets travel in the clear otherwise";
        return Err(Failure::new(Exit::Usage, what));
    }
    let failed = |what: &'static str| {
        move |error: std::io::Error| Failure::new(Exit::NotReached, format!("{what}: {error}"))
    };
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .thread_name("gateway")
        .enable_all()
        .build()
        .map_err(failed("gateway's threads"))?;
    runtime.block_on(async {
        let listener = tokio::net::TcpListener::bind(options.listen).await;
        let listener = listener.map_err(failed("gateway's port"))?;
        let local = listener.local_addr().map_err(failed("gateway's port"))?;
        let own = Address { scheme: "http".to_owned(), host: local.to_string() };
        let address = options.address.clone().unwrap_or(own);
        let gateway = Arc::new(Gateway::open(options, address)?);
        ready(&gateway.address)?;
        run(&gateway, Gate::new(listener, CONNECTIONS_MAX, Pages::Among), &is_ending)
            .await
            .map_err(failed("gateway"))
    })?;
    runtime.shutdown_timeout(Duration::from_millis(500));
    Ok(())
}

impl Gateway {
    fn open(options: &Options, address: Address) -> Result<Self, Failure> {
        let folder = &options.folder;
        make_private(folder).map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
        let audit = Audit::open(folder, audit::NAME).map_err(|error| {
            Failure::file(&folder.join(audit::NAME).with_extension("jsonl"), &error)
        })?;
        Ok(Self {
            people: PeopleFile::open(folder.join(people::FILE), People::load)?,
            sessions: Sessions::open(SESSIONS, folder.join(SESSIONS_FILE)),
            audit,
            robots: Robots::new(&options.groups, options.keys.as_deref(), folder)?,
            address,
            visits: AtomicU64::new(0),
            budgets: Budgets::default(),
            places: Places::default(),
            ending: watch::channel(false).0,
        })
    }
}

async fn run(gateway: &Arc<Gateway>, gate: Gate, is_ending: &AtomicBool) -> std::io::Result<()> {
    let tidying = Arc::clone(gateway);
    let tidy = tokio::spawn(async move {
        loop {
            tokio::time::sleep(TIDY_EVERY).await;
            tidying.robots.tidy().await;
        }
    });
    let mut ending = gateway.ending.subscribe();
    let table = gate.table();
    let router = web::router(Arc::clone(gateway)).into_make_service_with_connect_info::<Of>();
    let served = axum::serve(gate, router).with_graceful_shutdown(async move {
        // A gateway that is gone ends the server, too.
        let _ = ending.wait_for(|ending| *ending).await;
    });
    let mut served = tokio::spawn(async move { served.await });
    let ended = loop {
        tokio::select! {
            ended = &mut served => break ended.map_err(std::io::Error::other)?,
            () = tokio::time::sleep(LOOK_EVERY) => {}
        }
        table.tick(clock::now());
        if is_ending.load(Ordering::Relaxed) {
            gateway.ending.send_replace(true);
            // Connections that stay open do not keep the program from ending.
            break match tokio::time::timeout(CLOSE, &mut served).await {
                Ok(ended) => ended.map_err(std::io::Error::other)?,
                Err(_) => Ok(()),
            };
        }
    };
    tidy.abort();
    gateway.robots.end();
    ended
}
