# Functions of the scripts beside this file: paths, and installation of missing packages.
# Sourced, not run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

say() { printf '%s\n' "$*" >&2; }

# install PACKAGE…: installs missing Debian packages. Prints one per line those that
# could not be installed, and succeeds nevertheless: the caller decides how to continue without them.
install() {
    local missing=() package
    for package in "$@"; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
            missing+=("$package")
    done
    ((${#missing[@]})) || return 0
    local sudo=()
    ((EUID == 0)) || sudo=(sudo -n)
    if command -v apt-get >/dev/null && { ((EUID == 0)) || sudo -n true 2>/dev/null; }; then
        say "installing: ${missing[*]}"
        "${sudo[@]}" apt-get update -qq >&2 || true
        "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null 2>&1 && return 0
    fi
    printf '%s\n' "${missing[@]}"
}

# Settings of builds that are used once, as by continuous integration: nothing is kept for a later build, no debugger
# runs, and few large units of code take a tenth less processor time than many small ones.
build_once() { export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=0 CARGO_PROFILE_DEV_CODEGEN_UNITS=4; }

# Builds check the lints as well: clippy's compiler does both, and nothing is compiled a second time for them.
lint_while_building() {
    export RUSTC_WORKSPACE_WRAPPER=clippy-driver
    export CLIPPY_ARGS=-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__
}

# A ROS 1 master, robot and recorder, for the tests and benchmarks of the bridge.
ros1_packages=(python3-rosmaster python3-rospy python3-rosbag python3-sensor-msgs python3-trajectory-msgs
    python3-genmsg python3-genpy ros-std-msgs ros-geometry-msgs ros-sensor-msgs)

need_cargo() {
    command -v cargo >/dev/null || {
        say "no cargo on the PATH: install a Rust toolchain (1.89 or newer), see https://rustup.rs"
        exit 1
    }
}

# python_with FOLDER PACKAGE…: installs packages of PyPI into target/FOLDER unless they are there, and prints the
# path of a Python that has them. Fails without network. PYTHON names the interpreter, python3 by default.
python_with() {
    local venv="$root/target/$1"
    shift
    if [[ "$(cat "$venv/packages" 2>/dev/null)" != "$*" ]]; then
        say "installing into ${venv#"$root"/}: $*"
        "${PYTHON:-python3}" -m venv "$venv" >&2 &&
            "$venv/bin/pip" install --quiet --disable-pip-version-check "$@" >&2 || return 1
        printf '%s\n' "$*" >"$venv/packages"
    fi
    printf '%s\n' "$venv/bin/python"
}

# For physics: MuJoCo, and shared memory for the robot in it.
physics_python() { python_with physics mujoco==4.0.0 numpy==2.4.6 iceoryx2==0.10.0; }

# For recordings: the libraries that read them.
recording_python() {
    python_with recording mcap==1.6.0 mcap-ros2-support==0.6.0 mcap-protobuf-support==0.6.0 \
        jsonschema==4.26.0 foxglove-sdk==0.30.3 websockets==17.4 prometheus-client==0.26.0
}

# For simulated servos: the maker's library.
servos_python() { python_with servos feetech-servo-sdk==1.0.0 pyserial==3.5; }

# For the ROS 2 node: Cyclone DDS, and ROS 2 Jazzy, whose packages are for Python 3.11 alone.
cyclone_python() { python_with cyclone cyclonedds==11.0.1; }
rclpy_python() {
    command -v python3.11 >/dev/null || return 1
    PYTHON=python3.11 python_with rclpy ros-jazzy-rclpy==7.1.6 ros-jazzy-rmw-fastrtps-cpp==8.4.3 \
        ros-jazzy-{std,sensor,visualization,diagnostic}-msgs==5.3.6 ros-jazzy-std-srvs==5.3.6
}

# Everything that is shipped, in one set: with the same features in every step each crate is built once. Never add
# `-p`: the features of a single package are other ones, with which cargo builds most crates again.
# whisper.cpp is left to scripts/nightly, as it needs cmake and libclang.
workspace=(--workspace --features "ros2/dds,link/zenoh,grounding/tls" --locked)

# prepare_tests: installs what tests need beyond a Rust toolchain, and sets `with` to the options of the test programs
# that include the tests for which that succeeded. Without them cargo ignores these tests, with their reasons.
prepare_tests() {
    local missing
    with=(--include-ignored)
    missing=$(install espeak-ng flite libpocketsphinx3 pocketsphinx-en-us)
    if [[ -n $missing ]]; then
        say "without ${missing//$'\n'/, }: the tests that cargo ignores are not run"
        with=()
        return
    fi
    without() {
        local reason=$1 name
        shift
        say "not run: $reason"
        for name in "$@"; do with+=(--skip "$name"); done
    }
    # Disks and shared memory that get full are small ones of their own; a second user needs the superuser.
    ((EUID == 0)) && unshare --mount true 2>/dev/null ||
        without "tests on full disks, in full memory (no root)" as_root:: full_memory
    setpriv --reuid=65534 --regid=65534 --clear-groups true 2>/dev/null ||
        without "tests with a second user (no root)" second_user
    WHICHONE_PYTHON=$(python_with python iceoryx2==0.10.0) ||
        without "Python examples (no iceoryx2 for python3)" python:: sdk_python_
    missing=$(install "${ros1_packages[@]}")
    [[ -z $missing ]] || without "bridge to ROS 1 (no ${missing//$'\n'/, })" ros1_
    WHICHONE_CYCLONE=$(cyclone_python) || without "ROS 2 node (no cyclonedds for python3)" ros2_cyclone
    WHICHONE_SERVOS=$(servos_python) ||
        without "simulated servos with the maker's library (no feetech-servo-sdk for python3)" makers_library
    WHICHONE_PHYSICS=$(physics_python) || without "picks in a physics engine (no MuJoCo for python3)" physics::
    WHICHONE_RECORDING_PYTHON=$(recording_python) ||
        without "recordings, metrics and schemas by other readers (no mcap and websockets for python3)" \
            recorded_dialogue_is_read live_view_ metrics_are_read_by_ schemas_accept_
    local name
    for name in WHICHONE_PYTHON WHICHONE_CYCLONE WHICHONE_SERVOS WHICHONE_PHYSICS WHICHONE_RECORDING_PYTHON; do
        if [[ -n ${!name} ]]; then export "${name?}"; else unset "$name"; fi
    done
}

# prepare_browser: sets `browser` to "ready", or to what the tests of the page lack.
prepare_browser() {
    browser=ready
    if [[ -n $(install chromium fonts-dejavu-core) ]]; then
        browser="chromium"
    elif ! { { command -v node && command -v npm; } >/dev/null || [[ -z $(install nodejs npm) ]]; }; then
        browser="node and npm"
    elif ! npm install --prefix tests/browser --no-save --ignore-scripts --loglevel error >&2; then
        browser="the packages of tests/browser"
    fi
    if [[ $browser != ready ]]; then
        say "not run: tests of the console's page (no $browser)"
        [[ -z ${WHICHONE_REQUIRE_BROWSER:-} ]] || exit 1
    fi
}
