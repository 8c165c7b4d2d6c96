#!/usr/bin/env bash
# under_xvfb.sh COMMAND…: runs a command on a display of its own; 77, which tests take for skipped, without Xvfb.
set -uo pipefail
if ! command -v Xvfb > /dev/null; then
    echo "skipped: Xvfb is not installed"
    exit 77
fi
folder=$(mktemp -d)
Xvfb -displayfd 3 -screen 0 800x600x24 -nolisten tcp 3> "$folder/display" 2> "$folder/log" &
server=$!
trap 'kill "$server" 2> /dev/null; wait "$server" 2> /dev/null; rm -rf "$folder"' EXIT
for ((i = 0; i < 200; i++)); do
    [ -s "$folder/display" ] && break
    sleep 0.05
done
if [ ! -s "$folder/display" ]; then
    cat "$folder/log"
    echo "Xvfb gives no display"
    exit 1
fi
DISPLAY=:$(cat "$folder/display") "$@"
