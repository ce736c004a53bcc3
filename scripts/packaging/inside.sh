# What the scenarios of test.sh share; runs as root inside the Debian under test.

export DEBIAN_FRONTEND=noninteractive

fail() { echo "FAILED: $*"; exit 1; }

# took NAME START: prints the seconds since START, which is in nanoseconds.
took() { printf '  %-44s %6.1f s\n' "$1" "$((($(date +%s%N) - $2) / 100000000))e-1"; }

# step NAME COMMAND…: runs it and prints its seconds; its output only if it fails.
step() {
    local name=$1 start status=0 output
    shift
    start=$(date +%s%N)
    output=$("$@" 2>&1) || status=$?
    took "$name" "$start"
    ((status == 0)) || { echo "$output"; fail "$name: exit $status"; }
}

# Runs a command as the user ann.
ann() { runuser -u ann -- env -C /home/ann HOME=/home/ann USER=ann PATH="$PATH" "$@"; }

# Runs a command as ann, in the session that systemd keeps for her.
user() { ann env XDG_RUNTIME_DIR="/run/user/$(id -u ann)" "$@"; }

apt_install() { apt-get install -qq -y --no-install-recommends "$@"; }
apt_remove() { apt-get "$1" -qq -y whichone; }

# The first fetch, as the README shows it.
fetch() {
    ann whichone say get me the bowl >/dev/null
    local outcome
    outcome=$(ann whichone await pick --answer-as white2 --json)
    echo "$outcome"
    [[ $outcome == *'"outcome":"delivered"'* ]]
}

# wait_until SECONDS COMMAND…
wait_until() {
    local until=$((SECONDS + $1))
    shift
    while ! "$@" >/dev/null 2>&1; do
        ((SECONDS < until)) || fail "waited in vain for: $*"
        sleep 0.2
    done
}

check_installed() {
    local page=/usr/share/man/man1/whichone-up.1.gz
    ann whichone --version
    ann whichone check >/dev/null || fail "the configuration is refused"
    [[ $(gzip -dc "$page") == *.TH* ]] || fail "no manual page $page"
    [[ $(offers restart gro) == grounding ]] || fail "completion offers: $(offers restart gro)"
    dpkg --verify whichone | grep . && fail "files differ from the package's"
    return 0
}

# offers WORD…: what Bash offers for the last word, with the installed completion.
offers() {
    ann bash -c 'source /usr/share/bash-completion/completions/whichone
        COMP_WORDS=(whichone "$@") COMP_CWORD=$#
        _whichone whichone "${@: -1}" "${@: -2:1}"
        echo "${COMPREPLY[@]}"' offers "$@"
}

# A configuration of the user's own counts instead of the machine's.
own_configuration() {
    ann whichone init .config/whichone >/dev/null
    ann whichone check | grep -F /home/ann/.config/whichone
    ann rm -r .config/whichone
    ann rmdir -p --ignore-fail-on-non-empty .config
}

check_nothing_runs() {
    local left
    left=$(grep -la whichone /proc/[0-9]*/comm 2>/dev/null || true)
    [[ -z $left ]] || fail "still running: $(cat $left)"
    left=$(ls /dev/shm)
    [[ -z $left ]] || fail "shared memory is left: $left"
}

# snapshot NAME, compare NAME: every file, and the users, before and after. What apt, dpkg, cargo and the system itself
# write down is not the package's.
listing() {
    find / -xdev \( -path /proc -o -path /sys -o -path /dev -o -path /run -o -path /root \
        -o -path /var/lib/dpkg -o -path /var/lib/apt -o -path /var/cache -o -path /var/log -o -path /var/tmp \
        -o -path /var/lib/systemd -o -path /etc/systemd/system/scenario.service -o -path /etc/systemd/system/default.target.wants \
        -o -path /home/ann/.cargo/registry -o -path '/home/ann/.cargo/.*' \
        -o -path /etc/machine-id -o -name '*-' -path '/etc/*' \) -prune -o -print | sort
    cat /etc/passwd /etc/group
}
snapshot() { listing >"/root/$1.list"; }
compare() {
    listing >/root/after.list
    if diff "/root/$1.list" /root/after.list >/root/difference; then
        echo "  nothing is left"
    else
        cat /root/difference
        fail "traces are left"
    fi
}
