#!/usr/bin/env bash
# Does check_layers see each kind of mistake? Usage: check_layers_test.sh PROGRAM
set -u
program=$1
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
failed=0

# expect TEXT FILE CONTENT: a tree with only this file gives a message with the text ("" = none).
expect() {
    rm -rf "${root:?}"/*
    mkdir -p "$root/docs" "$root/$(dirname "$2")"
    printf '| 1 | `base` | |\n| 2 | `scene` `gpu` | |\n| 3 | `look` | |\n' > "$root/docs/ARCHITECTURE.md"
    printf '%b' "$3" > "$root/$2"
    local said status=0
    said=$("$program" "$root" 2>&1) || status=$?
    if [ -z "$1" ] && [ $status -ne 0 ] || [ -n "$1" ] && { [ $status -ne 1 ] || [[ $said != *"$1"* ]]; }; then
        printf 'for %s with\n%b\nexpected "%s", got: %s\n' "$2" "$3" "$1" "$said"
        failed=1
    fi
}

expect "" src/look/a.c '#include "scene/scene.h"\n#include "base/text.h"\n#include "look/look.h"\n#include "limner/look.h"\n'
expect "not below it: look/look.h" src/scene/a.c '#include "look/look.h"\n'
expect "not below it: gpu/gpu.h" src/scene/a.c '#  include "gpu/gpu.h"\n'
expect "a.c:2: includes" src/base/a.c '/* line */\n#include "scene/scene.h"\n'
expect "not in docs/ARCHITECTURE.md: other" src/other/a.c 'int x;\n'
expect "not in docs/ARCHITECTURE.md: other" src/look/a.c '#include "other/x.h"\n'
expect "only include/limner/" apps/cli/a.c '#include "base/text.h"\n'
expect "" apps/cli/a.c '#include "limner/limner.h"\n#include "beside.h"\n#include <stdio.h>\n'
expect "OpenGL" src/look/a.c 'void f(void) { glClear(1); }\n'
expect "" src/gpu/a.c 'void f(void) { glClear(1); }\n'
expect "" src/look/a.c '/* glClear(1) printf(2) */ const char *s = "strcpy(a)";\n'
expect "" src/look/a.c 'void f(void) { snprintf(a); s.printf(b); p->exit(1); }\n'
for word in sprintf strcpy strcat gets strtok atoi; do
    expect "unsafe function: $word" apps/cli/a.c "int x = $word(y);\n"
done
expect "depend on this: time" src/look/a.c 'int x = time(0);\n'
expect "" src/base/a.c 'int x = time(0);\n'
for word in printf exit abort; do
    expect "neither prints" src/base/a.c "void f(void) { $word(1); }\n"
    expect "" apps/cli/a.c "void f(void) { $word(1); }\n"
done
expect "promise" src/look/a.c '/* TO''DO: later */\n'
expect "" src/look/a.c '/* TO''DO (#12): later */\n'
expect "longer than 1000" src/look/a.c "$(printf 'int;\\n%.0s' $(seq 1001))"
expect "" src/look/a.c "$(printf 'int;\\n%.0s' $(seq 1000))"
expect "longer than 1200" tests/unit/a.c "$(printf 'int;\\n%.0s' $(seq 1201))"
expect "" tests/unit/a.c "$(printf 'int;\\n%.0s' $(seq 1200))"
expect "longer than 80" src/look/a.c "int f(void)\n{\n$(printf ';\\n%.0s' $(seq 81))}\n"
expect "" src/look/a.c "int f(void)\n{\n$(printf ';\\n%.0s' $(seq 80))}\n"
exit $failed
