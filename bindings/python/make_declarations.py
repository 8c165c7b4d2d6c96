#!/usr/bin/env python3
"""Writes limner/_declarations.py: what the C headers declare, for ctypes.

Usage: make_declarations.py [--check]     --check: only tell whether the file is what the headers say (exit status 1 when not).
Structs, enums, their standard values and functions are read from include/limner, so that none of them is written twice.
"""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
HEADERS = HERE.parent.parent / "include" / "limner"
OUTPUT = HERE / "limner" / "_declarations.py"

SIMPLE = {
    "void": "None", "bool": "c_bool", "char": "c_char", "int": "c_int", "unsigned": "c_uint", "float": "c_float", "double": "c_double",
    "size_t": "c_size_t", "uint8_t": "c_uint8", "uint16_t": "c_uint16", "uint32_t": "c_uint32", "uint64_t": "c_uint64",
    "int32_t": "c_int32", "int64_t": "c_int64",
}


class Headers:
    """All headers as one text, and what was found in them."""

    def __init__(self):
        text = "\n".join(path.read_text(encoding="utf-8") for path in sorted(HEADERS.glob("*.h")))
        text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S).replace("\\\n", " ")
        self.version = re.search(r'#define LMN_VERSION "([^"]+)"', text).group(1)
        self.standards = dict(re.findall(r"#define (LMN_\w+_INIT)\s+\{(.*?)\}\s*$", text, flags=re.M))
        self.numbers = dict(re.findall(r"#define (LMN_\w+)\s+(\d+)[uU]?\s*$", text, flags=re.M))
        self.text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
        self.enums = {name: body for body, name in re.findall(r"typedef enum \w+\s*\{([^}]*)\}\s*(\w+);", self.text)}
        self.structs = {name: body for body, name in re.findall(r"typedef struct \w+\s*\{([^}]*)\}\s*(\w+);", self.text)}
        self.callbacks = {name: (kind, body) for kind, name, body in
                          re.findall(r"typedef ([\w ]+?(?:\s*\*)*)\s*\(\*(\w+)\)\(([^)]*)\);", self.text)}
        self.functions = re.findall(r"LMN_API\s+([\w\s]+?[\s*]+)(lmn_\w+)\(((?:[^()]|\([^()]*\))*)\);", self.text)

    def values(self):
        """Every constant of every enum."""
        found = {}
        for body in [*self.enums.values(), *re.findall(r"(?<!\w )enum\s*\{([^}]*)\};", self.text)]:
            at = 0
            for item in filter(None, (part.strip() for part in body.split(","))):
                name, _, value = (part.strip() for part in item.partition("="))
                at = eval(value, {}, found) if value else at  # numbers and sums of earlier names
                found[name] = at
                at += 1
        return found

    def type_of(self, words, stars):
        """A type's name in ctypes."""
        word = " ".join(w for w in words.split() if w not in ("const", "struct"))
        known = SIMPLE.get(word)
        if word in self.enums:
            known = "c_int"
        elif word in self.structs or word in self.callbacks:
            known = word
        elif known is None:
            known = "None"  # behind a handle
        if stars == 0:
            return known
        if known == "c_char":
            inner = "c_char_p" if "const" in words else "c_void_p"  # what is not const is to be freed, by where it is
        elif known == "None":
            inner = "c_void_p"
        else:
            inner = f"POINTER({known})"
        for _ in range(stars - 1):
            inner = f"POINTER({inner})"
        return inner

    def declaration(self, text):
        """(name, type, words before the stars) of `const double eye[3]`, `char *name` or `const double (*points)[3]`."""
        rows = re.fullmatch(r"([\w\s]+?)\s*\(\*(\w+)\)\[(\w+)\]", text.strip())
        if rows:
            return rows.group(2), f"POINTER({self.type_of(rows.group(1), 0)} * {rows.group(3)})", rows.group(1)
        base, pointer, name, sizes = re.fullmatch(
            r"((?:const\s+)*\w+)((?:\s|\*|\bconst\b)*)\b(\w+)((?:\[\w+\])*)", text.strip()).groups()
        kind = self.type_of(base, pointer.count("*"))
        for size in reversed(re.findall(r"\w+", sizes)):
            kind = f"{kind} * {self.numbers.get(size, size)}"
        return name, kind, base

    def members(self, body):
        """Fields of a struct; `double a[3], b[3];` are two."""
        for line in filter(None, (part.strip() for part in body.split(";"))):
            first, *more = [part.strip() for part in line.split(",")]
            name, kind, base = self.declaration(first)
            yield name, kind
            for item in more:
                yield self.declaration(f"{base} {item}")[:2]

    def parameters(self, body):
        for item in filter(None, (part.strip() for part in body.split(","))):
            if item == "void":
                continue
            kind = self.declaration(item)[1]
            if " * " in kind:  # arrays are handed over as where they begin
                kind = f"POINTER({kind.split(' * ')[0]})"
            yield kind

    def standard_of(self, name):
        """The values of LMN_…_INIT of a struct, as Python."""
        body = self.standards.get(name.upper() + "_INIT")
        if body is None:
            return None
        body = " ".join(body.split()).replace("{", "(").replace("}", ",)")  # a list of one, too
        for old, new in (("NULL", "None"), ("true", "True"), ("false", "False")):
            body = re.sub(rf"\b{old}\b", new, body)
        values = re.findall(r"(?:[^,()]|\([^()]*\))+", body)
        kinds = [kind for _, kind in self.members(self.structs[name])]
        values = [f"{kind}()" if kind in self.callbacks else value.strip() for kind, value in zip(kinds, values, strict=True)]
        return ", ".join(values)


def ordered(headers):
    """Callbacks and structs, those that others name first."""
    done = []

    def kinds_of(name):
        if name in headers.callbacks:
            return headers.parameters(headers.callbacks[name][1])
        return (kind for _, kind in headers.members(headers.structs[name]))

    def visit(name):
        for kind in kinds_of(name):
            for other in re.findall(r"\w+", kind):
                if (other in headers.structs or other in headers.callbacks) and other != name:
                    visit(other)
        if name not in done:
            done.append(name)

    for name in [*headers.callbacks, *headers.structs]:
        visit(name)
    return done


def write(headers):
    out = ['"""What the C headers declare. Made by make_declarations.py; not to be changed by hand."""',
           "# mypy: ignore-errors", "from ctypes import *  # noqa: F403", "from typing import Any, Callable", "", f'VERSION = "{headers.version}"', ""]
    out += [f"{name} = {value}" for name, value in headers.values().items()]
    out += [f"{name} = {value}" for name, value in headers.numbers.items()]
    standards = []
    for name in ordered(headers):
        if name in headers.callbacks:
            kind, body = headers.callbacks[name]
            types = [headers.type_of(kind.replace("*", ""), kind.count("*")), *headers.parameters(body)]
            out += ["", f"{name} = CFUNCTYPE({', '.join(types)})"]
            continue
        out += ["", "", f"class {name}(Structure):", "    _fields_ = ["]
        out += [f'        ("{field}", {kind}),' for field, kind in headers.members(headers.structs[name])]
        out += ["    ]"]
        standard = headers.standard_of(name)
        if standard is not None:
            standards.append(f"    {name}: lambda: {name}({standard}),")
    out += ["", "", "# What the macros LMN_…_INIT make.", "STANDARDS: dict[type, Callable[[], Any]] = {", *standards, "}", "", "FUNCTIONS = {"]
    for kind, name, body in headers.functions:
        result = headers.type_of(kind.replace("*", ""), kind.count("*"))
        out.append(f'    "{name}": ({result}, [{", ".join(headers.parameters(body))}]),')
    out += ["}", ""]
    return "\n".join(out)


def main():
    text = write(Headers())
    if "--check" not in sys.argv[1:]:
        OUTPUT.write_text(text, encoding="utf-8")
        return 0
    if OUTPUT.read_text(encoding="utf-8") == text:
        return 0
    print(f"{OUTPUT} is not what the headers say; make it anew: {pathlib.Path(__file__).name}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
