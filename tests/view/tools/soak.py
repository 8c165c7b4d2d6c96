"""Uses the viewer over and over and tells how much memory it holds: soak.py VIEWER MODEL MINUTES
Looks, drags, wheel, undo, sections, hiding; a line a half minute. Run it under dbus-run-session."""
import os
import random
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
from window import Failure, Viewer, centre, drag, start_display, xdo


def resident_mib(pid):
    with open(f"/proc/{pid}/statm") as file:
        return int(file.read().split()[1]) * 4096 / 2**20


def main():
    program, model, minutes = sys.argv[1], sys.argv[2], float(sys.argv[3])
    server = start_display()
    v = Viewer(program, [model])
    v.rests(seconds=60)
    chance = random.Random(1)
    looks = ["toon", "edges", "pencil", "gooch", "sketch", "line", "comic", "hatch"]
    x, y = centre(v.find("Drawing"))
    begun = told = time.monotonic()
    rounds = 0
    while time.monotonic() < begun + minutes * 60:
        since = v.mark()
        what = chance.randrange(5)
        if what == 0:
            v.click(chance.choice(looks), "push button")
        elif what == 1:
            drag(x, y, chance.randrange(-200, 200) or 1, chance.randrange(-80, 80))
        elif what == 2:
            xdo("click", chance.choice([4, 5]))
        elif what == 3:
            v.click("Undo")
        else:
            xdo("mousemove", x + chance.randrange(-100, 100), y, "click", 1)
        try:
            v.rests(since, 8)
        except Failure:
            pass  # nothing was to undo, or nothing was there to pick
        v.lines = v.lines[-200:]
        rounds += 1
        if time.monotonic() > told + 30:
            told = time.monotonic()
            print(f"{(told - begun) / 60:.1f} min, {rounds} rounds: {resident_mib(v.process.pid):.0f} MiB", flush=True)
    print("ended with", v.close())
    server.terminate()


main()
