/* Fuzzers of stroke textures. */
#include "fuzz.h"
#include "stroke_texture/strokes.h"

/* What a reader of strokes gives is written and read again: the text of a file that was accepted must be accepted. */
static void use_strokes(strokes *s, lmn_status status)
{
    lmn_error error;
    if (status == LMN_OK && s->count < 10000) {
        text    written = {0};
        strokes again = {0};
        strokes_wrap(s);
        strokes_write(&written, s);
        if (written.data && strokes_read(&again, "again", written.data, written.size, &error) == LMN_OK &&
            again.count != s->count)
            __builtin_trap();
        strokes_release(&again);
        text_release(&written);
    }
    strokes_release(s);
}

void fuzz_stx(const uint8_t *bytes, size_t size)
{
    strokes   s = {0};
    lmn_error error;
    use_strokes(&s, strokes_read(&s, "fuzz", (const char *)bytes, size, &error));
}

void fuzz_svg(const uint8_t *bytes, size_t size)
{
    strokes   s = {0};
    lmn_error error;
    use_strokes(&s, strokes_read_svg(&s, "fuzz", (const char *)bytes, size, &error));
}
