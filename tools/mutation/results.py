"""What became of each mutant: one line of JSON each, the last one of a mutant holds."""
import collections
import json
import os


class Results:
    def __init__(self, path):
        self.path = path
        self.rows, self.first = {}, {}
        if path.exists():
            for line in path.read_text().splitlines():
                self.take(line)

    def take(self, line):
        try:
            row = json.loads(line)
            key = row["key"]
        except (ValueError, KeyError, TypeError):
            return  # the last line of a run that was stopped while it wrote
        self.rows[key] = row
        self.first.setdefault(key, row)

    def has(self, mutant):
        return mutant.key in self.rows

    def outcomes(self, room, outcome):
        return {key: row for key, row in self.rows.items() if row["room"] == room and row["outcome"] == outcome}

    def add(self, mutant, result):
        line = json.dumps({"key": mutant.key, "room": mutant.room, "mutant": mutant.describe(), **result})
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with open(self.path, "a", encoding="utf-8") as out:
            # Behind a line that was cut off, a new one.
            if out.tell() and not self.ends_whole():
                out.write("\n")
            out.write(line + "\n")
            out.flush()
            os.fsync(out.fileno())
        self.take(line)

    def ends_whole(self):
        with open(self.path, "rb") as f:
            f.seek(-1, os.SEEK_END)
            return f.read(1) == b"\n"


def summary(store, rooms, there):
    """A Markdown table: how many mutants of each room, of those that the sources still have (`there`, keys), were killed at first, and are now."""
    text = "| room | mutants | no program | equivalent | killed at first | killed now | survive | not all tests met |\n|---|---|---|---|---|---|---|---|\n"
    for room in rooms:
        rows = [(row["outcome"], store.first[key]["outcome"]) for key, row in store.rows.items() if row["room"] == room and key in there]
        count = collections.Counter(now for now, _ in rows)
        valid = [(now, before) for now, before in rows if now not in ("invalid", "equivalent")]
        before = sum(before == "killed" for _, before in valid)
        share = f" ({100 * count['killed'] / len(valid):.0f} %)" if valid else ""
        text += (f"| `{room}` | {len(valid)} | {count['invalid']} | {count['equivalent']} | {before} | {count['killed']}{share} | {count['survived']} | "
                 f"{count['unfinished']} |\n")
    return text
