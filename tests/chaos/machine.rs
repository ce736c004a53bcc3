//! The group under test, on small file systems of its own where the machine allows that.

use crate::kind::Kind;
use rustix::process::geteuid;
use service::folders::make_private;
use service::group::SHM;
use std::collections::BTreeMap;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;
use whichone_tests::Group;
use whichone_tests::shortage::SmallDisk;

/// Set in the process that has mounts of its own.
const OWN_MOUNTS: &str = "WHICHONE_CHAOS_MOUNTS";
/// Sizes of the file systems, MiB.
const HOME_MIB: u32 = 96;
const LOGS_MIB: u32 = 4;
const MEMORY_MIB: u32 = 128;

/// Starts this program again with private mounts if that is possible; else goes on without.
pub(crate) fn enter_own_mounts() {
    let possible = || {
        let probe = Command::new("unshare").args(["--mount", "true"]).output();
        probe.is_ok_and(|probe| probe.status.success())
    };
    if std::env::var_os(OWN_MOUNTS).is_some() || !geteuid().is_root() || !possible() {
        return;
    }
    let own = std::env::current_exe().expect("the path of this program");
    let mut again = Command::new("unshare");
    again.args(["--mount", "--propagation", "private", "--"]).arg(own);
    // Returns only if it fails; the tests then run without mounts.
    let error = again.args(std::env::args_os().skip(1)).env(OWN_MOUNTS, "1").exec();
    crate::print(&format!("no private mounts: {error}"));
}

/// A running group and its file systems.
pub(crate) struct Machine {
    pub(crate) group: Group,
    disks: BTreeMap<Kind, SmallDisk>,
}

impl Machine {
    /// Starts a group.
    pub(crate) fn start() -> Self {
        let mut machine = Self { group: Group::new(), disks: BTreeMap::new() };
        if std::env::var_os(OWN_MOUNTS).is_some() {
            let paths = machine.group.paths().clone();
            let memory = SmallDisk::mount(Path::new(SHM), MEMORY_MIB);
            let home = SmallDisk::mount(paths.home(), HOME_MIB);
            make_private(&paths.log()).expect("the folder of the logs");
            let logs = SmallDisk::mount(&paths.log(), LOGS_MIB);
            machine.disks = BTreeMap::from([
                (Kind::FullMemory, memory),
                (Kind::FullHome, home),
                (Kind::FullLogs, logs),
            ]);
        }
        machine.up();
        machine
    }

    /// The file system that a fault of this kind fills.
    pub(crate) fn disk(&self, kind: Kind) -> &SmallDisk {
        &self.disks[&kind]
    }

    /// Starts the group again after it has ended.
    pub(crate) fn up(&mut self) {
        let ended = self.group.start(&["arm.time_scale=20.0"]);
        assert_eq!(ended.code, Some(0), "{ended:?}\n{}", self.group.logs());
    }

    /// Returns true if faults of this kind can be injected here.
    pub(crate) fn allows(&self, kind: Kind) -> bool {
        match kind {
            Kind::FullLogs | Kind::FullHome | Kind::FullMemory => self.disks.contains_key(&kind),
            Kind::HostileUser | Kind::ClockStep => geteuid().is_root(),
            _ => true,
        }
    }

    /// Stops the group; it leaves nothing.
    pub(crate) fn end(self) {
        self.group.down();
    }
}
