"""Which small mistakes a source file could have. Each kind is one function that looks at one token and gives what could stand there."""
import collections
import hashlib
import itertools
import random
import re

import tokens as lexer

SHADERS = (".glsl", ".frag", ".vert", ".comp")

# What gives the same in either order, or whose first arguments are of different types throughout.
SYMMETRIC = {"min", "max", "dot", "distance", "fmin", "fmax", "fminf", "fmaxf", "hypot", "add", "vec_add", "dvec_add", "vec_dot", "dvec_dot", "equal",
             "notEqual", "if", "for", "while", "switch", "return", "sizeof", "strcmp", "abs_difference"}
FLIPPED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "!=", "!=": "=="}
SIGNS = {"+": "-", "-": "+", "+=": "-=", "-=": "+="}
CHANNELS = {"x": "y", "y": "x", "z": "x", "w": "z", "r": "g", "g": "r", "b": "r", "a": "b", "u": "v", "v": "u"}
# What a term reaches to, from its sign on: up to the next token of these outside brackets.
ENDS = {"+": {"+", "-"}, "-": {"+", "-"}, "*": {"+", "-", "*", "/", "%"}, "&&": {"&&", "||"}, "||": {"||"}}
ALWAYS_ENDS = {",", ";", ")", "]", "}", "?", ":", "<", ">", "<=", ">=", "==", "!=", "=", "&&", "||", "&", "|", "^", "<<", ">>"}
# Numbers below it are tolerances and guards against division by zero: twice of one is no mistake that shows.
SMALLEST_FACTOR = 1e-3

Mutant = collections.namedtuple("Mutant", "room path line kind before after begin end key")


class View:
    """A file's tokens, and what is asked about them."""

    def __init__(self, source):
        self.source = source
        self.tokens = lexer.split(source)
        self.pairs = lexer.partners(self.tokens)

    def text(self, i):
        return self.tokens[i].text if 0 <= i < len(self.tokens) else ""

    def span(self, first, last):
        """The source from the token `first` to the token `last`, both within."""
        return self.tokens[first].at, self.tokens[last].at + len(self.tokens[last].text)

    def is_operand_end(self, i):
        """Can an operand end here, so that a sign behind it stands between two?"""
        return 0 <= i and (self.tokens[i].kind in ("name", "number") and self.text(i) != "return" or self.text(i) in (")", "]"))

    def is_binary(self, i):
        # A name in brackets before it is a cast.
        if self.text(i - 1) == ")" and self.pairs.get(i - 1) == i - 3 and not self.is_operand_end(i - 4) and self.text(i) in "-*&":
            return not re.fullmatch(r"float|double|int|u?int\d+_t|size_t|unsigned|long|uint", self.text(i - 2))
        return self.is_operand_end(i - 1)

    def declares_pointer(self, i):
        """`type *name`: a star in a declaration and no product. The layout of the sources tells: a product has blanks on both sides."""
        at = self.tokens[i].at
        return self.source[at + 1:at + 2] not in (" ", "\n")

    def term_end(self, i):
        """The last token of the term that the sign at `i` brings."""
        ends = ALWAYS_ENDS | ENDS[self.text(i)] if self.text(i) not in ("&&", "||") else {",", ";", ")", "]", "}", "?", ":"} | ENDS[self.text(i)]
        at = i + 1
        while at < len(self.tokens):
            if self.text(at) in lexer.OPENING and at in self.pairs:
                at = self.pairs[at]
            elif self.text(at) in ends and at > i + 1:
                return at - 1
            at += 1
        return None

    def arguments(self, i):
        """The ranges of tokens of the arguments of the call whose bracket opens at `i`."""
        found, first, at, end = [], i + 1, i + 1, self.pairs[i]
        while at < end:
            if self.text(at) in lexer.OPENING and at in self.pairs:
                at = self.pairs[at]
            elif self.text(at) == ",":
                found.append((first, at - 1))
                first = at + 1
            at += 1
        return found + [(first, end - 1)] if first < end else found


def signs(v, i):
    text = v.text(i)
    if text in SIGNS and (text in ("+=", "-=") or v.is_binary(i)):
        yield i, i, SIGNS[text]
    elif text == "-" and v.tokens[i + 1].kind != "number" and not v.is_binary(i):
        yield i, i, ""


def factors(v, i):
    t = v.tokens[i]
    if t.text in ("*", "/") and v.is_binary(i) and not (t.text == "*" and v.declares_pointer(i)):
        yield i, i, "/" if t.text == "*" else "*"
    elif t.kind == "number" and re.fullmatch(r"[\d.]+(?:e[+-]?\d+)?[fF]?", t.text) and "." in t.text:
        value = float(t.text.rstrip("fF"))
        if value == 0:
            yield i, i, "1.0" + ("f" if t.text[-1] in "fF" else "")
        elif abs(value) >= SMALLEST_FACTOR and value < 1e6:
            yield i, i, f"{value * 2:.9g}".replace(".", ".", 1) + ("" if "." in f"{value * 2:.9g}" else ".0") + ("f" if t.text[-1] in "fF" else "")


def orders(v, i):
    if v.text(i) != "(" or i not in v.pairs or v.tokens[i - 1].kind != "name" or v.text(i - 1) in SYMMETRIC or v.tokens[i - 2].kind == "name":
        return
    found = v.arguments(i)
    for (a, b), (c, d) in zip(found, found[1:]):
        first, second = (v.source[slice(*v.span(*x))] for x in ((a, b), (c, d)))
        # Of the same shape, so that they could have been confused.
        if first != second and [t.kind for t in v.tokens[a:b + 1]] == [t.kind for t in v.tokens[c:d + 1]]:
            yield a, d, f"{second}, {first}"
            return


def comparisons(v, i):
    if v.text(i) in FLIPPED and v.is_operand_end(i - 1):
        yield i, i, FLIPPED[v.text(i)]


def dropped(v, i):
    text = v.text(i)
    if text not in ENDS or not v.is_binary(i) or text == "*" and v.declares_pointer(i):
        return
    end = v.term_end(i)
    if end is not None:
        yield i, end, ""


def channels(v, i):
    t = v.tokens[i]
    if t.kind != "name" or v.text(i - 1) not in (".", "->") or v.text(i + 1) == "(":
        return
    if t.text in CHANNELS:
        yield i, i, CHANNELS[t.text]
    elif re.fullmatch(r"[xyzw]{2,4}|[rgba]{2,4}", t.text) and t.text[0] != t.text[1]:
        yield i, i, t.text[1] + t.text[0] + t.text[2:]


def off_by_one(v, i):
    t = v.tokens[i]
    if t.kind == "number" and re.fullmatch(r"\d+[uU]?", t.text) and v.text(i - 1) in ("+", "-") and v.is_binary(i - 1):
        yield i, i, str(int(t.text.rstrip("uU")) - 1) + ("u" if t.text[-1] in "uU" else "")
    elif t.text in ("<", "<=") and loop_of(v, i):
        yield i, i, "<=" if t.text == "<" else "<"


def loop_of(v, i):
    """Does the comparison at `i` say when a `for` ends?"""
    at = i
    while at > 0 and v.text(at) not in ("{", "}"):
        if v.text(at) == ")" and at in v.pairs:
            at = v.pairs[at]
        elif v.text(at) == "(":
            return v.text(at - 1) == "for"
        at -= 1
    return False


def conditions(v, i):
    if v.text(i) == "if" and v.text(i + 1) == "(" and i + 1 in v.pairs:
        first, last = i + 2, v.pairs[i + 1] - 1
        yield first, last, f"!({v.source[slice(*v.span(first, last))]})"


KINDS = {"sign": signs, "factor": factors, "order": orders, "comparison": comparisons, "dropped term": dropped, "channel": channels, "off by one": off_by_one,
         "condition": conditions}


def of_file(room, path, source):
    """All mutants of one file, in the order of the source."""
    v, found = View(source), []
    for begin, end in lexer.bodies(v.tokens, v.pairs):
        for i in range(begin, end):
            for kind, look in KINDS.items():
                for first, last, after in look(v, i):
                    a, b = v.span(first, last)
                    found.append(mutant_of(room, path, v.tokens[first].line, kind, source, a, b, after))
    return found


def mutant_of(room, path, line, kind, source, begin, end, after):
    # Known by what it changes and by the file it changes: an edit of the file makes others of all.
    key = hashlib.sha1(f"{path}\n{begin}\n{end}\n{after}\n{source}".encode()).hexdigest()[:12]
    return Described(room, path, line, kind, source[begin:end], after, begin, end, key)


class Described(Mutant):
    __slots__ = ()

    def describe(self, line=True):
        before, after = (" ".join(text.split()) or "nothing" for text in (self.before, self.after))
        return f"{self.path}{f':{self.line}' if line else ''}: {self.kind}: {before} -> {after}"


def marked_line(m, source):
    """The line that a mutant begins in, with marks around what it changes there."""
    first, last = source.rfind("\n", 0, m.begin) + 1, source.find("\n", m.begin)
    end = min(m.end, last)
    return f"{source[first:m.begin]}«{source[m.begin:end]}»{source[end:last]}".strip()


def of_room(tree, room):
    """All mutants of a room, in the order of its files' names."""
    found = []
    for path in sorted((tree / "src" / room).rglob("*")):
        if path.suffix == ".c" or path.suffix in SHADERS:
            found += of_file(room, path.relative_to(tree).as_posix(), path.read_text())
    return found


def sample(found, count, seed):
    """Some of them, of all kinds alike: the next of each kind in turn."""
    chance = random.Random(seed)
    by_kind = [[m for m in found if m.kind == kind] for kind in KINDS]
    for group in by_kind:
        chance.shuffle(group)
    in_turn = (m for row in itertools.zip_longest(*by_kind) for m in row if m)
    return list(itertools.islice(in_turn, count))
