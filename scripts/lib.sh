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

# git_version NUMBER [COMMIT]: the version of what is built from a commit, HEAD by default. Of a tag it is the number;
# else it has the commit's time and hash, and sorts before the release of that number, or behind it if that is out.
git_version() {
    local number=$1 commit=${2:-HEAD} sign='~' moment
    moment=$(TZ=UTC git log -1 --date=format-local:%Y%m%d%H%M%S --format=%cd.%h --abbrev=12 "$commit" 2>/dev/null) ||
        { printf '%s\n' "$number" && return; }
    if git merge-base --is-ancestor "v$number" "$commit" 2>/dev/null; then
        sign='+'
        # An ancestor of the tag as well: the same commit.
        git merge-base --is-ancestor "$commit" "v$number" && { printf '%s\n' "$number" && return; }
    fi
    printf '%s%sgit%s\n' "$number" "$sign" "$moment"
}

# pack ARCHIVE FOLDER NAME: packs NAME of a folder so that the same content makes the same bytes.
pack() {
    tar -C "$2" --format=gnu --sort=name --owner=0 --group=0 --numeric-owner --mode='u+rwX,go+rX,go-w' \
        --mtime="@${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}" -cf - "$3" | gzip -9n >"$1"
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

# For the robot in its local network: another implementation of multicast DNS.
zeroconf_python() { python_with zeroconf zeroconf==0.154.0 ifaddr==0.2.0; }

# For simulated servos: the maker's library.
servos_python() { python_with servos feetech-servo-sdk==1.0.0 pyserial==3.5; }

# For servers of speech: the protocol's own package.
wyoming_python() { python_with wyoming wyoming==1.10.2; }

# For the ROS 2 node and the driver `trajectory`: Cyclone DDS, and ROS 2 Jazzy, whose packages are for Python 3.11
# alone.
cyclone_python() { python_with cyclone cyclonedds==11.0.1; }
rclpy_python() {
    local python
    command -v python3.11 >/dev/null || return 1
    python=$(PYTHON=python3.11 python_with rclpy ros-jazzy-rclpy==7.1.6 ros-jazzy-rmw-fastrtps-cpp==8.4.3 \
        ros-jazzy-{std,sensor,visualization,diagnostic}-msgs==5.3.6 ros-jazzy-std-srvs==5.3.6 \
        ros-jazzy-trajectory-msgs==5.3.6 ros-jazzy-action-msgs==2.0.3 "${rosidl[@]}") &&
        control_msgs "${python%/bin/python}" && printf '%s\n' "$python"
}

# For Home Assistant: its core and what its voice pipeline needs. HOME_ASSISTANT_PYTHON names an interpreter for it.
home_assistant_needs="no Python 3.13 with packages of PyPI, which Home Assistant 2025.4 needs (HOME_ASSISTANT_PYTHON)"
home_assistant_python() {
    local python
    for python in "${HOME_ASSISTANT_PYTHON:-}" python3.13 "$HOME"/.pyenv/versions/3.13.*/bin/python; do
        "$python" -c 'import sys, venv; sys.exit(sys.version_info[:2] != (3, 13))' &>/dev/null || continue
        PYTHON=$python python_with home-assistant pytest-homeassistant-custom-component==0.13.236 ruff==0.17.6 \
            hassil==2.2.3 home-assistant-intents==2025.3.28 ha-ffmpeg==3.2.2 mutagen==1.47.0 pymicro-vad==1.0.1 \
            pyspeex-noise==1.0.2
        return
    done
    return 1
}

# What makes Python and C++ of definitions of messages.
rosidl=(ros-jazzy-rosidl-default-{generators,runtime}==1.6.0 ros-jazzy-rosidl-core-{generators,runtime}==0.2.0
    ros-jazzy-rosidl-generator-py==0.22.2 ros-jazzy-rosidl-{pycommon,cli}==4.6.6 ros-jazzy-rpyutils==0.4.2
    ros-jazzy-python-cmake-module==0.11.1 ros-jazzy-ament-package==0.16.4 ros-jazzy-ament-cmake-ros==0.12.0
    ros-jazzy-ament-cmake{,-include-directories,-gtest,-gmock,-pytest,-vendor-package}==2.5.4
    cmake==4.4.5 ninja==1.13.2 catkin_pkg==1.1.1 empy==3.3.4 'setuptools<80')

# control_msgs VENV: builds the actions of ros2_control's controllers (tests/ros2/control_msgs), which are in no package
# of PyPI, into an environment with ROS 2: a minute or more of one core, once. Needs a C++ compiler.
control_msgs() (
    venv=$1 source="$root/tests/ros2/control_msgs"
    sum=$(cd "$source" && find . -type f -print0 | sort -z | xargs -0 cat | sha256sum)
    [[ "$(cat "$venv/control_msgs" 2>/dev/null)" != "$sum" ]] || exit 0
    say "building control_msgs into ${venv#"$root"/}"
    include=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_paths()["include"])')
    numpy=$("$venv/bin/python" -c 'import numpy; print(numpy.get_include())')
    # The packages name the Python that they were built with.
    built=/opt/python/cp311-cp311
    { grep -rl "$built" "$venv/share" || true; } | xargs -r sed -i \
        -e "s#$built/lib/python3.11/site-packages/numpy/_core/include#$numpy#g" \
        -e "s#$built/include/python3.11#$include#g"
    export AMENT_PREFIX_PATH=$venv CMAKE_PREFIX_PATH=$venv LD_LIBRARY_PATH=$venv/lib PATH=$venv/bin:$PATH
    {
        cmake -S "$source" -B "$venv/build/control_msgs" -G Ninja -DCMAKE_BUILD_TYPE=MinSizeRel -DBUILD_TESTING=OFF \
            -DPython3_EXECUTABLE="$venv/bin/python" -DCMAKE_INSTALL_PREFIX="$venv" &&
            cmake --build "$venv/build/control_msgs" --target install
    } >"$venv/control_msgs.log" 2>&1 || {
        say "control_msgs cannot be built: $venv/control_msgs.log"
        exit 1
    }
    printf '%s\n' "$sum" >"$venv/control_msgs"
)

# Everything that is shipped, in one set: with the same features in every step each crate is built once. Never add
# `-p`: the features of a single package are other ones, with which cargo builds most crates again.
# whisper.cpp is left to scripts/nightly, as it needs cmake and libclang.
workspace=(--workspace --features "ros2/dds,link/zenoh,grounding/tls" --locked)
# Unlike `--all-targets`, this builds no tests of programs that have none (`test = false`).
every_target=(--lib --bins --tests --examples)

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
    WHICHONE_WYOMING=$(wyoming_python) ||
        without "speech servers of the package wyoming (not for python3 here)" wyoming_servers_
    WHICHONE_PHYSICS=$(physics_python) || without "picks in a physics engine (no MuJoCo for python3)" physics::
    WHICHONE_RECORDING_PYTHON=$(recording_python) ||
        without "recordings, metrics and schemas by other readers (no mcap and websockets for python3)" \
            recorded_dialogue_is_read live_view_ metrics_are_read_by_ schemas_accept_
    WHICHONE_ZEROCONF=$(zeroconf_python) && ((EUID == 0)) && [[ -c /dev/net/tun && -z $(install iproute2) ]] ||
        without "discovery by another machine (no root, /dev/net/tun, iproute2 or zeroconf for python3)" \
            found_from_another_machine
    local name
    for name in WHICHONE_PYTHON WHICHONE_CYCLONE WHICHONE_SERVOS WHICHONE_WYOMING WHICHONE_PHYSICS \
        WHICHONE_RECORDING_PYTHON WHICHONE_ZEROCONF; do
        if [[ -n ${!name} ]]; then export "${name?}"; else unset "$name"; fi
    done
}

# prepare_browser: sets `browser` to "ready", or to what the tests of the page lack.
prepare_browser() {
    browser=ready
    # Chromium without windows takes a fifth less processor time.
    if [[ -n $(install chromium-headless-shell fonts-dejavu-core) && -n $(install chromium fonts-dejavu-core) ]]; then
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
