#!/bin/sh
# Installs the Debian packages of packages.txt, and those named as arguments, that are missing.
# Does nothing when all of them are there.
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
wanted="$(sed 's/#.*//' "$root/packages.txt") $*"

if ! command -v cargo >/dev/null; then
    echo "setup: cargo is not in PATH; install Rust from https://rustup.rs, then try again" >&2
    exit 1
fi

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "setup: this is not a Debian system, so nothing is installed." >&2
    echo "setup: the build needs what these Debian packages hold:" $wanted >&2
    exit 0
fi

missing=
for package in $wanted; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "setup: packages are missing, and installing them needs root or sudo. As root, run:" >&2
        echo "    apt-get update && apt-get install --no-install-recommends$missing" >&2
        exit 1
    fi
    as_root=sudo
fi

echo "setup: installing$missing"
$as_root apt-get -q update
$as_root env DEBIAN_FRONTEND=noninteractive apt-get -qy install --no-install-recommends $missing
