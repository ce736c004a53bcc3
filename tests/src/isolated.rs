//! Situations of a machine that only the superuser can make, each for one thread and the processes
//! that it starts.

use rustix::mount::{MountFlags, MountPropagationFlags, mount, mount_change};
use rustix::process::{Gid, Uid};
use rustix::thread::{UnshareFlags, set_thread_groups, set_thread_res_gid, set_thread_res_uid};
use service::group::SHM;
use std::ffi::CString;

/// The user whom nothing belongs to.
pub const OTHER_USER: u32 = 65534;

/// Runs `act` with `mib` MiB of shared memory that nothing else on the machine sees.
///
/// # Panics
/// Without the permission to mount, or if `act` does.
pub fn with_shared_memory<T: Send>(mib: u32, act: impl FnOnce() -> T + Send) -> T {
    apart(|| {
        // SAFETY: the descriptors of the threads stay shared.
        #[allow(unsafe_code)]
        unsafe { rustix::thread::unshare_unsafe(UnshareFlags::NEWNS) }.expect("a namespace");
        let private = MountPropagationFlags::PRIVATE | MountPropagationFlags::REC;
        mount_change("/", private).expect("mounts of its own");
        let options = CString::new(format!("size={mib}m,mode=1777")).expect("no zero in it");
        let flags = MountFlags::NOSUID | MountFlags::NODEV;
        mount("tmpfs", SHM, "tmpfs", flags, options.as_c_str()).expect("a small file system");
        act()
    })
}

/// Runs `act` as another user of the machine.
///
/// # Panics
/// Without the permission to change the user, or if `act` does.
pub fn as_other_user<T: Send>(act: impl FnOnce() -> T + Send) -> T {
    apart(|| {
        let (user, group) = (Uid::from_raw(OTHER_USER), Gid::from_raw(OTHER_USER));
        set_thread_groups(&[]).expect("no further groups");
        set_thread_res_gid(group, group, group).expect("another group");
        set_thread_res_uid(user, user, user).expect("another user");
        act()
    })
}

/// In a thread that ends with `act`: it does not get back what it gives up.
fn apart<T: Send>(act: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| scope.spawn(act).join())
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
