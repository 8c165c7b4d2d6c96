"""Many mutants of a C file in one program: which of them it is, is said when it starts (MUTANT_NUMBER), so that nothing is built between two.

A function with mutants gets a body for each of them beside the right one. Each function also tells, once and only when MUTANT_REACHED names
a file, that it was called: a test that never calls a function cannot notice what is wrong in it.
"""
import tokens as lexer

WOVEN = ".woven"
# How a compiler's message says which mutant it is about.
NAME = "mutant-"

# Behind the include of a file that begins so, warnings are none: a mutant may leave a variable unused.
HEAD = """#pragma GCC system_header
static int           mutant_number;
static unsigned char mutant_seen[{functions}];
static void          mutant_see(int function);
"""
# At the end, so that the file's own choices of what headers declare come first.
TAIL = """
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
static const char *mutant_record;
__attribute__((constructor)) static void mutant_choose(void)
{{
    const char *number = getenv("MUTANT_NUMBER");
    mutant_number = number ? (int)strtol(number, NULL, 10) : 0;
    mutant_record = getenv("MUTANT_REACHED");
}}
static void mutant_see(int function)
{{
    mutant_seen[function] = 1;
    int file = mutant_record ? open(mutant_record, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644) : -1;
    if (file < 0)
        return;
    char line[300];
    int  length = snprintf(line, sizeof line, "%s:%d\\n", "{path}", function);
    if (length > 0 && write(file, line, (size_t)length) < 0)
        mutant_seen[function] = 2;
    close(file);
}}
"""


def functions(source):
    """Where the bodies of a file's functions begin and end: behind the one brace and before the other."""
    found = lexer.split(source)
    return [(found[begin - 1].at + 1, found[end].at) for begin, end in lexer.bodies(found, lexer.partners(found))]


def function_of(source, mutant):
    """The number of the function that a mutant lies in, as `mutant_see` tells it."""
    return next(k for k, (begin, end) in enumerate(functions(source)) if begin <= mutant.begin < end)


def weave(path, source, numbered):
    """The file with the mutants `numbered` (number, mutant) in it."""
    bodies = functions(source)
    text, at = HEAD.format(functions=len(bodies) or 1) + f'#line 1 "{path}"\n', 0
    for k, (begin, end) in enumerate(bodies):
        text += source[at:begin] + f"\n    if (!mutant_seen[{k}])\n        mutant_see({k});\n"
        for number, m in numbered:
            if begin <= m.begin < end:
                body = source[begin:m.begin] + m.after + source[m.end:end]
                text += f'    if (mutant_number == {number}) {{\n#line 1 "{NAME}{number}"\n{body}\n    }} else\n'
        line = source.count("\n", 0, begin) + 1
        text += f'    {{\n#line {line} "{path}"\n{source[begin:end]}\n    }}\n#line {source.count(chr(10), 0, end) + 1} "{path}"\n'
        at = end
    return text + source[at:] + TAIL.format(path=path)
