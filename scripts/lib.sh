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

# For the ROS 2 node: Cyclone DDS, and ROS 2 Jazzy, whose packages are for Python 3.11 alone.
cyclone_python() { python_with cyclone cyclonedds==11.0.1; }
rclpy_python() {
    command -v python3.11 >/dev/null || return 1
    PYTHON=python3.11 python_with rclpy ros-jazzy-rclpy==7.1.6 ros-jazzy-rmw-fastrtps-cpp==8.4.3 \
        ros-jazzy-{std,sensor,visualization,diagnostic}-msgs==5.3.6 ros-jazzy-std-srvs==5.3.6
}
