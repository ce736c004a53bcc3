//! Steps of a child process between fork and exec. The only unsafe code of this crate.

use std::os::fd::{AsRawFd, BorrowedFd, RawFd};
use std::os::unix::process::CommandExt;
use std::process::Command;

use libc::{CLOSE_RANGE_CLOEXEC, SYS_close_range};
use rustix::io::{Errno, FdFlags, fcntl_setfd};
use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal, setpriority_process};

/// Makes the command's process inherit `fds` and no other descriptor beyond the standard three, run
/// with niceness `nice`, and receive TERM when the calling thread ends. A niceness that is
/// not permitted is left as it is.
///
/// To be called, like `spawn`, on the process's main thread only: the signal is sent when the
/// *thread* ends that started the child. It does not reach the child's own children.
#[allow(unsafe_code)]
pub(crate) fn prepare(command: &mut Command, fds: [BorrowedFd<'_>; 2], nice: i32) {
    let kept = fds.map(|fd| fd.as_raw_fd());
    let others: Vec<RawFd> = if closes_ranges() {
        Vec::new()
    } else {
        open_fds().into_iter().filter(|fd| !kept.contains(fd)).collect()
    };
    let parent = rustix::process::getpid();
    // SAFETY: the closure runs in the forked child, where only async-signal-safe functions may be
    // called. `in_child` makes system calls and nothing else: it takes no lock and allocates
    // nothing, not even for its errors.
    unsafe {
        command.pre_exec(move || Ok(in_child(kept, &others, parent, nice)?));
    }
}

/// Descriptors of this process beyond the standard three. Not all are closed by exec: libraries
/// open files of their own, and some were inherited from a shell.
fn open_fds() -> Vec<RawFd> {
    let Ok(entries) = std::fs::read_dir("/proc/self/fd") else { return Vec::new() };
    let numbers = entries.filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
    numbers.filter(|&number| number > 2).collect()
}

fn in_child(kept: [RawFd; 2], others: &[RawFd], parent: Pid, nice: i32) -> Result<(), Errno> {
    set_parent_process_death_signal(Some(Signal::TERM))?;
    // A parent that died before the line above sends nothing any more.
    if getppid() != Some(parent) {
        return Err(Errno::CHILD);
    }
    if nice != 0 {
        let _ = setpriority_process(None, nice);
    }
    // Without a list of them where the kernel can (5.11): one that another thread opens meanwhile is not missed.
    let _ = close_on_exec_from(3);
    for &fd in others {
        // One that was only open while they were listed is not there any more.
        let _ = set_flags(fd, FdFlags::CLOEXEC);
    }
    kept.into_iter().try_for_each(|fd| set_flags(fd, FdFlags::empty()))
}

/// Returns true if the kernel marks ranges of descriptors.
fn closes_ranges() -> bool {
    close_on_exec_from(u32::MAX)
}

/// Has all descriptors from `first` on closed by exec; returns false if the kernel cannot.
#[allow(unsafe_code)]
fn close_on_exec_from(first: u32) -> bool {
    // SAFETY: a system call on numbers. In the parent the range is empty; between fork and exec it concerns the child's
    // own copies only. Older C libraries have no function for it.
    unsafe { libc::syscall(SYS_close_range, first, u32::MAX, CLOSE_RANGE_CLOEXEC) == 0 }
}

#[allow(unsafe_code)]
fn set_flags(fd: RawFd, flags: FdFlags) -> Result<(), Errno> {
    // SAFETY: the descriptor is used for this one call, which fails where it is not open. Flags
    // that are set between fork and exec concern the child's own copy only.
    fcntl_setfd(unsafe { BorrowedFd::borrow_raw(fd) }, flags)
}
