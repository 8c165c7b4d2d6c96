#!/usr/bin/env python3
"""Are the scripts of a folder valid under the schema? check_scripts.py SCHEMA FOLDER; status 77 without jsonschema."""
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

schema = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
checker = jsonschema.Draft202012Validator(schema)
wrong = 0
for path in sorted(pathlib.Path(sys.argv[2]).glob("*.json")):
    for error in checker.iter_errors(json.loads(path.read_text(encoding="utf-8"))):
        print(f"{path}: {list(error.absolute_path)}: {error.message[:200]}")
        wrong += 1
# A schema that lets everything pass checks nothing.
for bad in ({"limner_script": 2}, {"limner_script": 1, "behaviour": {"sequence": []}}, {"limner_script": 1, "nodse": []}):
    if checker.is_valid(bad):
        print(f"valid and should not be: {bad}")
        wrong += 1
sys.exit(1 if wrong else 0)
