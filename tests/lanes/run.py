#!/usr/bin/env python3
"""Runs the test programs that cargo has built, side by side; `scripts/test` calls it.

    run.py --targets LANE    the options of cargo that build the programs of a lane
    run.py LANE [NAME…] [-- OPTIONS OF THE TEST PROGRAMS…] < what cargo printed

LANE is quick, full or nightly (`lanes.toml`): full holds quick, and nightly what full leaves out. NAME… selects
programs. Standard input is what `cargo test --no-run --message-format=json-render-diagnostics` printed.

Programs that start processes run at normal priority, those that only compute fill the gaps at the lowest one. Tests
in real time wait for the other tests with processes, and for the process WHICHONE_BESIDE, which tests something else
meanwhile. A few failed tests are tried again, alone, and must pass three times in a row: `flaky.toml`. At the end
nothing may be left: processes, shared memory, temporary files. With WHICHONE_TIMES set it prints the slowest tests.
"""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# Results of earlier runs, which a check-out keeps and a fresh machine lacks.
KEPT = ROOT / "target" / "lanes"
# A program that takes longer hangs: one that only computes gets little time while those with processes run.
LIMIT_S = 2_400
# More failures than this are no matter of chance.
TRIED_AGAIN = 5
PASSES_IN_A_ROW = 3
RUNS_REMEMBERED = 20
SECOND_TRIES_ALLOWED = 2
# Letters that all names of a group in shared memory share at their start (`ShmName` in shared/runtime/src/group.rs).
PREFIX = 24
SLOWEST_PRINTED = 40
TOO_SLOW = "the physics did not keep up with real time"


def say(text):
    print(text, file=sys.stderr, flush=True)


@dataclass
class Program:
    """A test program: its name is CRATE for unit tests, CRATE/TARGET for others."""

    name: str
    path: str
    folder: str
    is_unit: bool


@dataclass
class Result:
    program: Program
    output: str
    code: int
    seconds: float
    failed: list = field(default_factory=list)

    @property
    def count(self):
        return sum(int(n) for n in re.findall(r"^test result: \w+\. (\d+) passed", self.output, re.M))


def programs(lines):
    """The test programs among the messages of cargo."""
    found = []
    for line in lines:
        message = json.loads(line) if line.startswith("{") else {}
        if message.get("executable") and message["profile"]["test"]:
            target, package = message["target"], message["package_id"]
            crate = re.search(r"([^/#@]+)(?:#[\d.]+|@[\d.]+)$", package).group(1)
            is_unit = bool({"lib", "cdylib", "rlib", "staticlib"} & set(target["kind"]))
            name = crate if is_unit else f"{crate}/{target['name']}"
            folder = os.path.dirname(message["manifest_path"])
            found.append(Program(name, message["executable"], folder, is_unit))
    return found


def test_targets():
    """Names of the test targets that are no unit tests of a library, of the whole workspace."""
    command = ["cargo", "metadata", "--no-deps", "--format-version=1", "--locked"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout)
    return {
        f"{package['name']}/{target['name']}"
        for package in metadata["packages"]
        for target in package["targets"]
        if target["test"] and {"bin", "test"} & set(target["kind"])
    }


def check_lanes(lanes):
    """Exits if a test target is in no lane, or a lane names one that is not there."""
    named = {name for lane in ["quick", "full", "elsewhere"] for name in lanes[lane]}
    names = test_targets()
    for name in sorted(names - named):
        say(f"tests/lanes/lanes.toml: expected the lane of {name}, found none; help: add it to one of the lists")
    for name in sorted(named - names):
        say(f"tests/lanes/lanes.toml: expected a test target, found {name}; help: remove it")
    if names != named:
        sys.exit(1)


def cargo_options(lanes, lane):
    """The options of `cargo test` that build the programs of a lane."""
    if lane != "quick":
        return []
    return ["--lib", *(f"--test={name.split('/')[1]}" for name in lanes["quick"])]


def in_lane(lanes, lane, found):
    """The programs of a lane."""
    if lane == "nightly":
        return [p for p in found if p.name in lanes["full"]]
    names = set(lanes["quick"]) | (set(lanes["full"]) if lane == "full" else set())
    return [p for p in found if p.is_unit or p.name in names]


def give_way(session, nice):
    """Lowers the share of a session: with groups by session, Linux compares `nice` only within each of them."""
    try:
        Path(f"/proc/{session}/autogroup").write_text(str(nice))
    except OSError:
        pass  # A kernel without such groups, or a program that has ended.


class Runner:
    def __init__(self, lanes, options, temporary):
        self.lanes = lanes
        self.options = options
        # PulseAudio's library, which espeak-ng uses, keeps its folder for all later programs of the user.
        self.environment = dict(os.environ, TMPDIR=temporary, PULSE_RUNTIME_PATH=str(KEPT / "pulse"))
        self.results = []
        self.lock = threading.Lock()
        self.seconds = read_json(KEPT / "seconds.json", {})

    def run(self, program, options, nice=0):
        """Runs a program to its end, and kills it with what it started if it hangs."""
        began = time.monotonic()
        environment = dict(self.environment, CARGO_MANIFEST_DIR=program.folder)
        if os.environ.get("WHICHONE_TIMES"):
            # libtest counts times as unstable.
            environment["RUSTC_BOOTSTRAP"] = "1"
            options = ["-Zunstable-options", "--report-time", *options]
        process = subprocess.Popen(
            ["nice", "-n", str(nice), program.path, *options],
            cwd=program.folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            text=True,
            errors="replace",
        )
        give_way(process.pid, nice)
        try:
            output, _ = process.communicate(timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            output, _ = process.communicate()
            output += f"\nexpected an end within {LIMIT_S} s, found the program running\n"
        result = Result(program, output, process.returncode, time.monotonic() - began)
        result.failed = failed_in(output)
        return result

    def record(self, result):
        with self.lock:
            self.results.append(result)
            name = result.program.name
            self.seconds[name] = max(self.seconds.get(name, 0), round(result.seconds, 1))
            if result.code == 0 and result.count == 0:
                return
            state = "ok" if result.code == 0 else f"FAILED ({len(result.failed)})"
            say(f"{state:<10} {result.seconds:6.1f} s  {result.count:4} passed  {name}")

    def run_queue(self, queue, options, nice):
        while True:
            with self.lock:
                if not queue:
                    return
                program = queue.pop(0)
            self.record(self.run(program, options, nice))

    def run_all(self, selected, is_full):
        """Runs the programs side by side, the longest first; in the full lane the tests in real time after the others
        with processes."""
        rank = {name: n for n, name in enumerate(self.lanes["slowest"])}
        longest = lambda program: (-self.seconds.get(program.name, 0), rank.get(program.name, len(rank)))
        processes = [p for p in selected if p.name in self.lanes["processes"]]
        pure = sorted((p for p in selected if p not in processes), key=longest)
        processes.sort(key=longest)
        cores = os.cpu_count() or 2
        beside = [f"--skip={part}" for part in self.lanes["alone"]]
        # Tests with processes wait most of their time: beside the longest program the others run one by one.
        queues = [(processes[:1], 2 * cores, 0), (processes[1:], cores, 0)]
        first = [self.start(queue, [*beside, f"--test-threads={at_once}"], nice) for queue, at_once, nice in queues]
        gaps = [self.start(pure, ["--test-threads=1"], 19) for _ in range(cores)]
        for thread in first:
            thread.join()
        wait_for_end(os.environ.get("WHICHONE_BESIDE"))
        if is_full:
            self.run_alone(processes)
        for thread in gaps:
            thread.join()

    def start(self, queue, options, nice):
        thread = threading.Thread(target=self.run_queue, args=(queue, [*options, *self.options], nice))
        thread.start()
        return thread

    def run_alone(self, selected):
        """Runs the tests in real time, one for each core."""
        for program in selected:
            tests = self.tests_alone(program)
            if tests:
                included = [option for option in self.options if option == "--include-ignored"]
                options = [f"--test-threads={os.cpu_count() or 2}", *included, "--exact", *tests]
                self.record(self.run(program, options))

    def tests_alone(self, program):
        """Names of the tests in real time among those that were asked for."""
        listed = self.run(program, ["--list", *self.options]).output
        tests = re.findall(r"^(\S+): test$", listed, re.M)
        return [test for test in tests if any(part in test for part in self.lanes["alone"])]

    def try_again(self, failed):
        """Tries failed tests again, alone. Returns those that passed, that physics was too slow for, and the rest."""
        passed, slow, broken = [], [], []
        for program, test in failed:
            say(f"once more, alone: {program.name} {test}")
            options = ["--exact", test, "--include-ignored", "--test-threads=1"]
            for _ in range(PASSES_IN_A_ROW):
                result = self.run(program, options)
                if result.code != 0 or result.count != 1:
                    break
            name = f"{program.name} {test}"
            if result.code == 0 and result.count == 1:
                passed.append(name)
            elif any(part in test for part in self.lanes["alone"]) and TOO_SLOW in result.output:
                slow.append(name)
            else:
                broken.append(name)
                say(result.output)
        return passed, slow, broken


def say_slowest(results):
    """Prints the slowest tests, if their times are known."""
    timed = [
        (float(seconds), f"{result.program.name} {test}")
        for result in results
        for test, seconds in re.findall(r"^test (\S+) .*<([\d.]+)s>$", result.output, re.M)
    ]
    for seconds, name in sorted(timed, reverse=True)[:SLOWEST_PRINTED]:
        say(f"{seconds:6.1f} s  {name}")


def failed_in(output):
    """Names of the failed tests."""
    named = re.findall(r"^test (\S+)(?: - should panic)? \.\.\. FAILED(?: <[\d.]+s>)?$", output, re.M)
    listed = output.rsplit("\nfailures:\n", 1)
    if len(listed) == 2:
        named += re.findall(r"^    (\S+)$", listed[1], re.M)
    return sorted(set(named))


def end_of(result):
    """How a program ended that reports no failed test, and the test that it was in."""
    begun = re.findall(r"^test (\S+) \.\.\. $", result.output, re.M)
    how = f"killed by {signal.Signals(-result.code).name}" if result.code < 0 else f"exit {result.code}"
    return f"{how} in {begun[-1]}" if begun else how


def read_json(path, default):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return default


def judge_second_tries(passed):
    """Whether second tries are too many, by the ledger and by earlier runs."""
    ledger = tomllib.loads((HERE / "flaky.toml").read_text())
    is_strict = os.environ.get("WHICHONE_LEDGER") == "strict"
    path = KEPT / "second_tries.json"
    runs = (read_json(path, []) + [passed])[-RUNS_REMEMBERED:]
    path.write_text(json.dumps(runs))
    is_good = True
    for name in passed:
        tries = sum(name in run for run in runs)
        cause = ledger.get(name, {}).get("cause")
        say(f"second try: {name}: {cause or 'not listed in tests/lanes/flaky.toml'}")
        if tries > SECOND_TRIES_ALLOWED:
            say(f"{name}: {tries} of the last {len(runs)} runs needed a second try: that is a fault")
            is_good = False
        if is_strict and not cause:
            is_good = False
    return is_good


def wait_for_end(process):
    """Waits until a process has ended: what it runs disturbs tests in real time, and would look left behind."""
    while process and os.path.exists(f"/proc/{process}"):
        time.sleep(0.5)


class Leftovers:
    """What this run may leave: processes of this build, shared memory of groups, temporary files."""

    def __init__(self, temporary):
        self.temporary = Path(temporary)
        self.memory = self.segments()
        self.processes = set(self.running())

    @staticmethod
    def segments():
        return set(os.listdir("/dev/shm")) if os.path.isdir("/dev/shm") else set()

    @staticmethod
    def running():
        """Processes whose program is in `target`."""
        found = {}
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                program = os.readlink(f"/proc/{pid}/exe")
            except OSError:
                continue
            if program.startswith(f"{ROOT}/target/") and "/lanes/" not in program:
                found[int(pid)] = program
        return found

    @staticmethod
    def in_use():
        """Groups with a process that has some of their shared memory mapped: prefixes of their names in it."""
        found = set()
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                text = Path(f"/proc/{pid}/maps").read_text()
            except OSError:
                continue
            found.update(name[:PREFIX] for name in re.findall(r"/dev/shm/(\S+)", text))
        return found

    def new(self):
        """Processes, shared memory and temporary files that were not there at the start."""
        processes = {pid: x for pid, x in self.running().items() if pid not in self.processes}
        left = [f"process {pid}, {program}" for pid, program in sorted(processes.items())]
        # Groups beside this run, of another checkout for example, do not belong to it.
        new = self.segments() - self.memory
        in_use = self.in_use()
        left += [f"shared memory /dev/shm/{name}" for name in sorted(new) if name[:PREFIX] not in in_use]
        return left + [f"temporary {path}" for path in sorted(self.temporary.iterdir())]

    def find(self, known):
        """New ones that are still there after 10 s, as some end a moment later, without those of known cause."""
        until = time.monotonic() + 10
        while True:
            left = [it for it in self.new() if not any(fnmatch(it, pattern) for pattern in known)]
            if not left or time.monotonic() > until:
                return left
            time.sleep(0.5)


def main():
    lanes = tomllib.loads((HERE / "lanes.toml").read_text())
    arguments, options = sys.argv[1:], []
    if arguments[0] == "--targets":
        check_lanes(lanes)
        print(*cargo_options(lanes, arguments[1]))
        return
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1 :]
    lane, names = arguments[0], arguments[1:]
    selected = in_lane(lanes, lane, programs(sys.stdin))
    if names:
        selected = [p for p in selected if any(name in p.name for name in names)]
    if lane == "nightly":
        options = [*options, *lanes["only_nightly"]]
    else:
        options = [*options, *(f"--skip={part}" for part in lanes["only_nightly"])]
    KEPT.mkdir(parents=True, exist_ok=True)
    # Short, as sockets are found by their path; open, as /tmp is, for tests with a second user.
    temporary = tempfile.mkdtemp(prefix="wl-")
    os.chmod(temporary, 0o1777)
    leftovers = Leftovers(temporary)
    runner = Runner(lanes, options, temporary)
    began = time.monotonic()
    if lane == "nightly":
        for program in selected:
            runner.record(runner.run(program, ["--test-threads=1", *options]))
    else:
        runner.run_all(selected, lane == "full")
    (KEPT / "seconds.json").write_text(json.dumps(runner.seconds, indent=1, sort_keys=True))
    sys.exit(0 if judge(lane, runner, leftovers, began) else 1)


def judge(lane, runner, leftovers, began):
    """Prints what failed, and whether the lane passes."""
    bad = [result for result in runner.results if result.code != 0]
    failed = [(result.program, test) for result in bad for test in result.failed]
    for result in bad:
        say(f"\n==== {result.program.name} (exit {result.code})\n{result.output}")
    # A program that was killed reports no failed test.
    is_sudden = any(result.code < 0 or not result.failed for result in bad)
    broken = [f"{program.name} {test}" for program, test in failed]
    broken += [f"{result.program.name}, {end_of(result)}" for result in bad if result.code < 0 or not result.failed]
    is_good = not bad
    if failed and not is_sudden and len(failed) <= TRIED_AGAIN:
        passed, slow, broken = runner.try_again(failed)
        is_good = not broken and judge_second_tries(passed)
        if slow:
            say(f"this machine was too slow for physics in real time; not tried: {', '.join(slow)}")
    elif not bad:
        judge_second_tries([])
    for name in broken if bad else []:
        say(f"failed: {name}")
    say_slowest(runner.results)
    left = leftovers.find(runner.lanes["known_leftovers"])
    for what in left:
        say(f"left behind: {what}")
    if not left:
        shutil.rmtree(leftovers.temporary)
    count = sum(result.count for result in runner.results)
    say(f"{lane}: {count} tests in {time.monotonic() - began:.0f} s: {'passed' if is_good and not left else 'FAILED'}")
    return is_good and not left


if __name__ == "__main__":
    main()
