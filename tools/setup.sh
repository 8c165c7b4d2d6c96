#!/usr/bin/env bash
# Makes sure that what Limner is built and tested with is installed: says which Debian packages are missing, then installs them.
# Usage: tools/setup.sh [--check]   --check: only say it; exit status 1 when something is missing.
set -euo pipefail

packages=(build-essential cmake ninja-build pkg-config
          libepoxy-dev libegl-dev libegl1 libgl1-mesa-dri
          libjansson-dev libassimp-dev libmeshoptimizer-dev libdraco-dev libocct-data-exchange-dev
          libpng-dev libjpeg-dev libwebp-dev zlib1g-dev libdeflate-dev libglu1-mesa-dev
          libgeos-dev libqhull-dev libfreetype-dev libfontconfig-dev libharfbuzz-dev fonts-liberation
          libxml2-dev libseccomp-dev libsqlite3-dev gdal-bin
          libcairo2-dev libpango1.0-dev
          xvfb libglfw3-dev libsdl2-dev libgtk-4-dev libadwaita-1-dev
          dbus at-spi2-core gir1.2-atspi-2.0 python3-gi xdotool adwaita-icon-theme desktop-file-utils appstream gettext
          libcmocka-dev librsvg2-bin poppler-utils libdxflib-dev chromium ffmpeg
          abigail-tools mandoc zsh fish python3 python3-numpy
          slurmctld slurmd slurm-client munge parallel
          clang clang-format libclang-rt-dev llvm lld ccache)

if ! command -v dpkg-query > /dev/null; then
    echo "This is no Debian system; install what docs/DEPENDENCIES.md lists, then run this again." >&2
    command -v cmake > /dev/null && command -v ninja > /dev/null && command -v pkg-config > /dev/null
    exit
fi

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2> /dev/null || true)
    # A package may also be provided by another one that is installed.
    if [ "$state" != installed ] && ! dpkg-query -W -f='${Provides}\n' 2> /dev/null | grep -qE "(^|[ ,])$package([ ,]|\$)"; then
        missing+=("$package")
    fi
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "missing Debian packages: ${missing[*]}"
if [ "${1:-}" = --check ]; then
    exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo > /dev/null; then
        echo "install them as root: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
"${as_root[@]}" apt-get update
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
