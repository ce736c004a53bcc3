# The tests of scripts/package, sourced by it: each way of installation on a bare Debian. Scenarios run inside
# the Debian's root folder; inside.sh, which lies beside this file, holds what they share.

suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-bookworm}")

# bare NAME [PACKAGES]: makes target/package/NAME a bare Debian, with more packages; kept as a file for the next time.
bare() {
    local folder="$out/root-$1" packages=${2:-} kept
    kept="$out/bare-$(cksum <<<"$suite $packages" | cut -d' ' -f1).tar"
    ((EUID == 0)) || { say "scripts/package test needs root"; exit 1; }
    [[ -z $(install debootstrap) ]] || { say "no debootstrap"; exit 1; }
    rm -rf --one-file-system "$folder"
    if [[ ! -f $kept ]]; then
        say "making a bare Debian ($suite${packages:+, with $packages})"
        debootstrap --variant=minbase ${packages:+--include="$packages"} "$suite" "$folder" >"$out/debootstrap.log" 2>&1 ||
            { tail -n 5 "$out/debootstrap.log" >&2; exit 1; }
        rm -f "$folder"/var/cache/apt/archives/*.deb
        tar -C "$folder" -cf "$kept" .
    else
        mkdir -p "$folder"
        tar -C "$folder" -xf "$kept"
    fi
    cp "$here/inside.sh" "$folder/root/"
    chroot "$folder" useradd --create-home --shell /bin/bash ann
    printf '%s\n' "$folder"
}

# inside FOLDER: runs the scenario on standard input there as root, in namespaces of its own: its processes end with
# it. Shared memory is 64 MiB, as in a container.
inside() {
    local folder=$1
    cat >"$folder/root/scenario.sh"
    unshare --mount --pid --fork --kill-child --ipc bash -euc '
        mount --make-rprivate /
        mount -t proc proc "$0/proc"
        mount -t tmpfs -o mode=755 tmpfs "$0/dev"
        for device in "null 3" "zero 5" "full 7" "random 8" "urandom 9"; do
            mknod -m 666 "$0/dev/${device% *}" c 1 "${device#* }"
        done
        ln -s /proc/self/fd "$0/dev/fd"
        mkdir "$0/dev/shm"
        mount -t tmpfs -o mode=1777,size=64m tmpfs "$0/dev/shm"
        mount -t tmpfs -o mode=755 tmpfs "$0/run"
        exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb LANG=C.UTF-8 \
            bash -euo pipefail -c "cd /root && source inside.sh && source scenario.sh"
    ' "$folder"
}

# The next version of the package, the same but for its number; uncompressed, which takes minutes less.
next_deb() {
    local tree="$out/next"
    rm -rf "$tree"
    cp -al "$out/deb" "$tree"
    sed "s/^Version: .*/&+next/" "$out/deb/DEBIAN/control" >"$tree/DEBIAN/control.new"
    mv "$tree/DEBIAN/control.new" "$tree/DEBIAN/control"
    dpkg-deb -Znone --root-owner-group --build "$tree" "$out/next.deb" >/dev/null
}

# with_debs FOLDER: puts the package and the next version there.
with_debs() {
    once make_deb
    next_deb
    cp "$deb" "$1/root/whichone.deb"
    cp "$out/next.deb" "$1/root/next.deb"
}

test_deb() {
    local folder
    folder=$(bare deb)
    with_debs "$folder"
    say "--- deb"
    inside "$folder" <<'SCENARIO'
snapshot before
began=$(date +%s%N)
step "install" apt_install ./whichone.deb
step "start" ann whichone up --detach --wait ready
step "first fetch" fetch
took "from the file to the first fetch" "$began"
check_installed
own_configuration
ann whichone journal --verify
records=$(ann whichone journal | wc -l)
step "upgrade, the group running" apt_install ./next.deb
step "a fetch by the old group" fetch
step "a service of it restarted" ann whichone restart policy
step "a fetch by the old group" fetch
step "stop and start with the new version" bash -c "source inside.sh; ann whichone down; ann whichone up --detach --wait ready"
(($(ann whichone journal | wc -l) >= records)) || fail "the journal was not kept"
step "another fetch" fetch
ann whichone journal --verify
ann whichone down
check_nothing_runs
echo "# mine" >>/etc/whichone/group.toml
step "remove" apt_remove remove
[[ -f /etc/whichone/group.toml ]] || fail "a removal keeps the configuration"
step "purge" apt_remove purge
ann rm -r .local/state/whichone
ann rmdir -p --ignore-fail-on-non-empty .local/state
compare before
SCENARIO
}

test_archive() {
    local folder
    folder=$(bare archive)
    once make_archive
    cp "$archive" "$folder/home/ann/whichone.tar.gz"
    say "--- archive"
    inside "$folder" <<'SCENARIO'
snapshot before
began=$(date +%s%N)
step "unpack" ann tar --one-top-level=robot --strip-components=1 -xzf whichone.tar.gz
step "start" ann robot/bin/whichone up --detach --wait ready
ann robot/bin/whichone status | grep -q robot/config || ann robot/bin/whichone status --json | grep -q robot/config ||
    fail "the configuration is not that of the archive"
PATH=$PATH:/home/ann/robot/bin
step "first fetch" fetch
took "from the file to the first fetch" "$began"
ann whichone down
check_nothing_runs
ann mv robot elsewhere
PATH=$PATH:/home/ann/elsewhere/bin
step "moved, and started again" ann whichone up --detach --wait ready
ann whichone journal --verify
ann whichone down
ann rm -r elsewhere .local/state/whichone
ann rmdir -p --ignore-fail-on-non-empty .local/state
compare before
SCENARIO
}

test_cargo() {
    local folder toolchain
    folder=$(bare cargo gcc,libc6-dev,ca-certificates)
    toolchain=$(rustc --print sysroot)
    say "--- cargo (crates are taken from this machine's cache)"
    mkdir -p "$folder/home/ann/whichone" "$folder/home/ann/.cargo/registry" "$folder/opt/rust"
    git ls-files | tar -cf - -T - | tar -C "$folder/home/ann/whichone" -xf -
    cp -al "${CARGO_HOME:-$HOME/.cargo}"/registry/{index,cache} "$folder/home/ann/.cargo/registry/"
    cp -al "$toolchain/." "$folder/opt/rust/" 2>/dev/null || cp -a "$toolchain/." "$folder/opt/rust/"
    chroot "$folder" chown -R ann: /home/ann/whichone
    chroot "$folder" bash -c 'find /home/ann/.cargo -type d -exec chown ann: {} +'
    inside "$folder" <<'SCENARIO'
PATH=$PATH:/opt/rust/bin:/home/ann/.cargo/bin
snapshot before
began=$(date +%s%N)
step "cargo install --path services/whichone" ann nice cargo install --offline --locked --quiet --path whichone/services/whichone --target-dir /tmp/build
rm -rf /tmp/build
[[ $(ls /home/ann/.cargo/bin) == whichone ]] || fail "more than one program"
[[ $(ann whichone fleet 2>&1) == *"--features zenoh"* ]] || fail "fleet: a program that is not built in without help"
step "start" ann whichone up --detach --wait ready
step "first fetch" fetch
took "from the sources to the first fetch" "$began"
ann whichone down
check_nothing_runs
ann cargo uninstall --quiet whichone
ann rm -r .local/state/whichone
ann rmdir -p --ignore-fail-on-non-empty .local/state .cargo/bin
compare before
SCENARIO
}

# booted FOLDER: boots it with systemd, which runs the scenario on standard input and shuts down.
booted() {
    local folder=$1 status
    [[ -z $(install systemd-container) ]] || { say "no systemd-nspawn"; exit 1; }
    cat >"$folder/root/scenario.sh"
    cat >"$folder/etc/systemd/system/scenario.service" <<'UNIT'
[Unit]
After=multi-user.target
[Service]
Type=oneshot
ExecStart=/bin/bash -euo pipefail -c 'cd /root && source inside.sh && source scenario.sh'
ExecStopPost=/bin/bash -c 'echo $EXIT_STATUS >/root/status; systemctl --no-block poweroff'
StandardOutput=file:/root/output
StandardError=inherit
UNIT
    mkdir -p "$folder/etc/systemd/system/default.target.wants"
    ln -sf ../scenario.service "$folder/etc/systemd/system/default.target.wants/scenario.service"
    rm -f "$folder/root/status" "$folder/root/output"
    timeout 600 systemd-nspawn --quiet --directory "$folder" --boot --register=no --keep-unit --console=pipe \
        </dev/null >"$out/boot.log" 2>&1 || true
    cat "$folder/root/output" 2>/dev/null || { tail -n 20 "$out/boot.log" >&2; say "systemd did not come up here"; exit 1; }
    status=$(cat "$folder/root/status" 2>/dev/null || echo 1)
    [[ $status == 0 || $status == SUCCESS ]] || { say "the scenario failed ($status)"; exit 1; }
}

system_packages=systemd,systemd-sysv,dbus,libpam-systemd,procps

test_boot() {
    local folder
    folder=$(bare boot "$system_packages")
    with_debs "$folder"
    say "--- boot"
    inside "$folder" <<'SCENARIO'
snapshot before
step "install" apt_install ./whichone.deb
systemctl --quiet enable whichone.service
SCENARIO
    booted "$folder" <<'SCENARIO'
step "ready after boot" wait_until 60 systemctl --quiet is-active whichone.service
robot() { runuser -u whichone -- env -C /var/lib/whichone HOME=/var/lib/whichone whichone "$@"; }
robot status
robot say get me the bowl >/dev/null
step "first fetch" robot await pick --answer-as white2 --json
before=$(systemctl show --property MainPID --value whichone.service)
kill -STOP "$before"
another() { local pid; pid=$(systemctl show --property MainPID --value whichone.service); [[ $pid != "$before" && $pid != 0 ]] && systemctl --quiet is-active whichone.service; }
step "watchdog replaces a hung supervisor" wait_until 120 another
systemctl reload whichone.service
records=$(robot journal | wc -l)
step "upgrade" apt_install ./next.deb
wait_until 60 systemctl --quiet is-active whichone.service
(($(robot journal | wc -l) >= records)) || fail "the journal was not kept"
robot journal --verify
robot say the clear bowl >/dev/null
step "another fetch" robot await pick --answer-as clear --json
step "purge while it runs" apt_remove purge
check_nothing_runs
systemctl list-unit-files --no-legend 'whichone*' | grep . && fail "a unit is left"
compare before
SCENARIO
}

test_user() {
    local folder
    folder=$(bare user "$system_packages")
    with_debs "$folder"
    say "--- user"
    inside "$folder" <<'SCENARIO'
snapshot before
step "install" apt_install ./whichone.deb
SCENARIO
    booted "$folder" <<'SCENARIO'
id=$(id -u ann)
loginctl enable-linger ann
wait_until 30 test -S "/run/user/$id/systemd/private"
step "start by systemctl --user" user systemctl --user --quiet enable --now whichone.service
step "first fetch" fetch
# A session that ends takes nothing with it, because ann lingers.
systemd-run --quiet --wait --collect --property PAMName=login --uid ann true
sleep 12
ann whichone status
SCENARIO
    booted "$folder" <<'SCENARIO'
step "ready after boot, nobody logged in" wait_until 60 ann whichone status
ann whichone journal --verify
step "another fetch" fetch
user systemctl --user --quiet disable --now whichone.service
check_nothing_runs
loginctl disable-linger ann
step "purge" apt_remove purge
ann rm -r .local/state/whichone
ann rmdir -p --ignore-fail-on-non-empty .local/state .config/systemd/user
compare before
SCENARIO
}

test_image() {
    local folder engine=podman options base
    [[ -z $(install podman runc containernetworking-plugins iptables curl) ]] || { say "no podman, no network for it, or no curl"; exit 1; }
    folder=$(bare image)
    say "--- image"
    options="--runtime runc --cgroup-manager cgroupfs --storage-driver vfs --root $out/podman --runroot $out/podman-run"
    base=localhost/whichone-base
    # shellcheck disable=SC2086
    tar -C "$folder" --exclude ./proc --exclude ./sys -cf - . | podman $options import --quiet - "$base" >/dev/null
    WHICHONE_ENGINE_OPTIONS=$options WHICHONE_BASE=$base WHICHONE_BUILD_OPTIONS="--isolation chroot --network host" make_image
    image_scenario "$options"
}

# The image, run as docs/install.md says, and read-only besides. Podman leaves the times of the health check to systemd,
# which need not be here: the check is asked for. In a shell of its own, at whose end the container is removed.
image_scenario() (
    podman="podman $1" container=whichone-test-$$
    export DISABLE_HC_SYSTEMD=true
    # shellcheck disable=SC2206
    run=($podman run --detach --name "$container" --shm-size 64m --volume "$container:/var/lib/whichone" --read-only
        --tmpfs /tmp --publish 127.0.0.1::8377 --ulimit nofile=1024:4096 --ulimit nproc=1000:1000 "whichone:$image")
    source "$here/inside.sh"
    in_container() { $podman exec "$container" whichone "$@"; }
    # in_order NAME: the group is ready, and its journals are those of before, at least $records of them.
    in_order() {
        step "$1: ready" wait_until 60 in_container status
        (($(in_container journal | wc -l) >= records)) || fail "$1: the journals were not kept"
        step "$1: journals verified" in_container journal --verify
    }
    # The page, from the host, by the link of the container but for the port.
    page() {
        local link
        link=$(in_container console)
        curl --silent --show-error --fail --location --cookie-jar /dev/null --output /dev/null \
            "http://$($podman port "$container" 8377/tcp)/?${link#*\?}"
    }
    remove() {
        $podman rm --force --volumes "$container" >/dev/null 2>&1 || true
        $podman volume rm --force "$container" >/dev/null 2>&1 || true
    }
    trap remove EXIT
    step "run" "${run[@]}"
    step "ready" wait_until 60 in_container status
    in_container say get me the bowl >/dev/null
    step "first fetch" in_container await pick --answer-as white2 --json
    step "page, from the host" page
    step "healthy" $podman healthcheck run "$container"
    records=$(in_container journal | wc -l)
    step "restart" $podman restart --time 30 "$container"
    in_order "restarted"
    $podman kill "$container" >/dev/null
    step "start after a kill" wait_until 30 $podman start "$container"
    in_order "killed"
    step "stop" $podman stop --time 30 "$container"
    [[ $($podman inspect --format '{{.State.ExitCode}}' "$container") == 0 ]] || fail "the group was not stopped in order"
    $podman rm "$container" >/dev/null
    step "another container, the volume kept" "${run[@]}"
    in_order "replaced"
    in_container say the clear bowl >/dev/null
    step "another fetch" in_container await pick --answer-as clear --json
    step "stop" $podman stop --time 30 "$container"
)
