"""C and GLSL as tokens: comments, texts, characters and the preprocessor's lines are none."""
import collections
import re

Token = collections.namedtuple("Token", "kind text at line")

PATTERN = re.compile(
    r"""(?P<skip>//(?:\\\n|[^\n])*|/\*.*?\*/|\s+)
      | (?P<text>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
      | (?P<number>(?:0[xX][0-9a-fA-F]+|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?)[a-zA-Z]*)
      | (?P<name>[A-Za-z_]\w*)
      | (?P<sign>->|\+\+|--|<<=|>>=|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|\.\.\.|\#\#|.)
    """, re.VERBOSE | re.DOTALL)

# Everything to the end of a line of the preprocessor, and of those it goes on in.
DIRECTIVE = re.compile(r"[ \t]*#(?:\\\n|/\*.*?\*/|[^\n])*", re.DOTALL)

OPENING = {"(": ")", "[": "]", "{": "}"}


def split(source):
    """All tokens of a file, in order."""
    found, at, line, fresh = [], 0, 1, True
    while at < len(source):
        directive = DIRECTIVE.match(source, at) if fresh else None
        match = directive or PATTERN.match(source, at)
        text = match.group()
        kind = "skip" if directive else match.lastgroup
        if kind != "skip":
            found.append(Token(kind, text, at, line))
        at = match.end()
        line += text.count("\n")
        # A directive can only begin where nothing but blanks stands before it on its line.
        fresh = "\n" in text if kind == "skip" and not text.isspace() else (fresh and text.isspace()) or "\n" in text
    return found


def partners(tokens):
    """Which bracket belongs to which: a dictionary of indices, both ways. What does not match is left out."""
    pairs, open_ones = {}, []
    for i, t in enumerate(tokens):
        if t.kind != "sign":
            continue
        if t.text in OPENING:
            open_ones.append(i)
        elif t.text in OPENING.values() and open_ones and OPENING[tokens[open_ones[-1]].text] == t.text:
            begin = open_ones.pop()
            pairs[begin], pairs[i] = i, begin
    return pairs


def bodies(tokens, pairs):
    """The ranges of tokens that are bodies of functions: braces outside all others, behind a list of parameters."""
    i, found = 0, []
    while i < len(tokens):
        if tokens[i].text == "{" and i in pairs:
            if i and tokens[i - 1].text == ")":
                found.append((i + 1, pairs[i]))
            i = pairs[i]
        i += 1
    return found
