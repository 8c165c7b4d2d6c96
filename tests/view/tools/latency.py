"""Measures the viewer while a model is turned: latency.py VIEWER MODEL LOOK [SECONDS] [WIDTHxHEIGHT]
Input to picture as the viewer traces it (median, 95th percentile), and gaps of its main loop. Run it by itself, under dbus-run-session."""
import os
import re
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
from window import Viewer, centre, start_display, xdo


def share(values, fraction):
    return sorted(values)[min(len(values) - 1, int(len(values) * fraction))] if values else float("nan")


def main():
    program, model, look = sys.argv[1:4]
    seconds = float(sys.argv[4]) if len(sys.argv) > 4 else 10
    server = start_display()
    begun = time.monotonic()
    v = Viewer(program, ["--look", look, model], {"LIMNER_VIEW_HEARTBEAT": "1"})
    v.wait("loaded", 120)
    loaded = time.monotonic() - begun
    v.rests(seconds=120)
    time.sleep(8)  # thumbnails
    x, y = centre(v.find("Drawing"))
    for warm in (True, False):
        since = v.mark()
        xdo("mousemove", x, y, "mousedown", 1)
        until, i = time.monotonic() + (3 if warm else seconds), 0
        while time.monotonic() < until:
            i += 1
            xdo("mousemove", x + i * 3 % 200, y + i % 60)
            time.sleep(0.012)
        xdo("mouseup", 1)
        v.rests(since, 60)
    drawn = [line for line in v.lines[since:] if "whole=0" in line]
    latency = [float(re.search(r"latency=([\d.]+)", line).group(1)) for line in drawn]
    sizes = sorted(set(re.search(r"width=\d+ height=\d+", line).group(0) for line in drawn))
    gaps = [float(re.search(r"gap ms=([\d.]+)", line).group(1)) for line in v.lines if " gap ms=" in line]
    moving = [float(re.search(r"gap ms=([\d.]+)", line).group(1)) for line in v.lines[since:] if " gap ms=" in line]
    print(f"{os.path.basename(model)} {look}: loaded in {loaded:.1f} s; {len(drawn)} pictures in {seconds:.0f} s ({', '.join(sizes)}); "
          f"input to picture {share(latency, 0.5):.0f} ms, 95 % {share(latency, 0.95):.0f} ms; "
          f"gaps of the main loop over 20 ms: {len(gaps)}, worst {max(gaps, default=0):.0f} ms, while turning {max(moving, default=0):.0f} ms")
    v.close()
    server.terminate()


main()
