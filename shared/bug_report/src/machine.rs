//! The machine: kernel, distribution, processor, memory, limits.

use std::fs;

/// Lines of `/proc/meminfo` that matter.
const MEMORY: [&str; 3] = ["MemTotal", "MemAvailable", "SwapTotal"];

/// Describes the machine in a few lines. What cannot be read is missing.
pub(crate) fn text() -> String {
    let kernel =
        |name: &str| fs::read_to_string(format!("/proc/sys/kernel/{name}")).unwrap_or_default();
    let (kind, release) = (kernel("ostype"), kernel("osrelease"));
    let arch = std::env::consts::ARCH;
    let mut lines = vec![format!("kernel: {} {} {arch}", kind.trim(), release.trim())];
    lines.extend(field("/etc/os-release", "PRETTY_NAME").map(|name| format!("system: {name}")));
    lines.extend(field("/proc/cpuinfo", "model name").map(|name| format!("processor: {name}")));
    let processors = std::thread::available_parallelism().map_or(0, usize::from);
    lines.push(format!("processors: {processors}"));
    let memory =
        MEMORY.iter().filter_map(|key| Some(format!("{key}: {}", field("/proc/meminfo", key)?)));
    lines.extend(memory);
    lines.extend(
        fs::read_to_string("/proc/loadavg").ok().map(|load| format!("load: {}", load.trim())),
    );
    lines.extend(free("/dev/shm"));
    lines.push("limits:".to_owned());
    lines.extend(fs::read_to_string("/proc/self/limits").ok());
    lines.join("\n") + "\n"
}

/// The value behind a key and `:` or `=`, the first one of a file.
fn field(file: &str, key: &str) -> Option<String> {
    let text = fs::read_to_string(file).ok()?;
    let value = |line: &str| {
        let (name, value) = line.split_once([':', '='])?;
        (name.trim() == key).then(|| value.trim().trim_matches('"').to_owned())
    };
    text.lines().find_map(value)
}

fn free(folder: &str) -> Option<String> {
    let found = rustix::fs::statvfs(folder).ok()?;
    let mib = |blocks: u64| blocks.saturating_mul(found.f_frsize) >> 20;
    Some(format!("{folder}: {} MiB of {} MiB free", mib(found.f_bavail), mib(found.f_blocks)))
}
