# shellcheck shell=bash
# packages.sh - sourced by the setup scripts: installs Debian packages that are missing.

# give_up NAME WHY PACKAGE...: ends the script NAME.
give_up() {
    echo "$1: $2; install by hand: ${*:3}" >&2
    exit 1
}

# install_missing NAME PACKAGE...: by apt, as root or with sudo; nothing if all are installed.
install_missing() {
    local name=$1 package
    local -a missing=() as_root=()
    shift
    for package in "$@"; do
        [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
    done
    ((${#missing[@]})) || return 0
    if ((EUID != 0)); then
        have sudo || give_up "$name" 'this needs root or sudo' "${missing[@]}"
        as_root=(sudo)
    fi
    apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=1200 "$@"; }
    refresh_lists apt && apt -y install --no-install-recommends "${missing[@]}" ||
        give_up "$name" 'apt-get failed' "${missing[@]}"
}

# refresh_lists APT: waits while another program, such as a second setup or an upgrade, refreshes them; apt-get itself
# waits for the other locks only.
refresh_lists() {
    local said tries=240
    until said=$("$1" update 2>&1); do
        echo "$said"
        [[ $said == *'Could not get lock'* ]] && ((tries-- > 0)) || return
        sleep 5
    done
}

# have PROGRAM...: whether all of them are found.
have() {
    local program
    for program in "$@"; do command -v "$program" >/dev/null || return; done
}

is_debian() { have dpkg-query apt-get; }
