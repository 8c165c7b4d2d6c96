/* limner/film.h: films read back frame by frame, a program that fails in every way, files that appear whole or not at
 * all, and which pictures are whole. What stands in for ffmpeg is a shell script on a PATH of its own. */
#define _GNU_SOURCE
#include <dirent.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#ifdef LIMNER_HAVE_WEBPDEMUX
#include <webp/demux.h>
#endif

#include "base/memory.h"
#include "export/export.h"
#include "limner/limner.h"

enum { WIDTH = 37, HEIGHT = 21, FRAMES = 7, RATE = 24 };

static char folder[128], at[512], path_before[4096];

static int enter(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/limner-test-XXXXXX");
    snprintf(path_before, sizeof path_before, "%s", getenv("PATH"));
    return mkdtemp(folder) ? 0 : -1;
}

static int leave(void **state)
{
    char command[160];
    (void)state;
    setenv("PATH", path_before, 1);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

static const char *in_folder(const char *name)
{
    snprintf(at, sizeof at, "%s/%s", folder, name);
    return at;
}

/* Names in the folder besides the program's own. */
static void assert_names(int wanted)
{
    int  count = 0;
    DIR *list = opendir(folder);
    assert_non_null(list);
    for (struct dirent *entry; (entry = readdir(list)) != NULL;)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 &&
                 strcmp(entry->d_name, "bin") != 0 && strcmp(entry->d_name, "number") != 0;
    closedir(list);
    assert_int_equal(count, wanted);
}

static bool has_program(const char *name)
{
    char command[64];
    snprintf(command, sizeof command, "command -v %s > /dev/null", name);
    return system(command) == 0;
}

/* From here on this is ffmpeg, and the programs of the system are still there for it. */
static void pretend(const char *script)
{
    char path[sizeof path_before + 160];
    mkdir(in_folder("bin"), 0700);
    FILE *file = fopen(in_folder("bin/ffmpeg"), "w");
    assert_non_null(file);
    assert_true(fprintf(file, "#!/bin/sh\n%s\n", script) > 0);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(chmod(at, 0700), 0);
    snprintf(path, sizeof path, "%s/bin:%s", folder, path_before);
    assert_int_equal(setenv("PATH", path, 1), 0);
}

static void forget_programs(void)
{
    assert_int_equal(setenv("PATH", "/nothing", 1), 0);
}

/* --- frames --------------------------------------------------------------------------------------------- */

/* A square that goes to the right over slopes of colour; frame 3 is like frame 2. `opacity`: of the ground. */
static void paint(uint8_t *rgba, int width, int height, int frame, uint8_t opacity)
{
    int left = 4 * (frame == 3 ? 2 : frame);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint8_t *p = rgba + 4 * ((size_t)y * (size_t)width + (size_t)x);
            bool     inside = x >= left && x < left + 8 && y >= 6 && y < 14;
            int      green = inside ? 30 : 240 - x / 4 * 12;
            p[0] = inside ? 200 : (uint8_t)(255 - 2 * y);
            p[1] = (uint8_t)green;
            p[2] = inside ? 60 : (uint8_t)(200 + y);
            p[3] = inside ? 255 : opacity;
        }
}

static lmn_film_desc desc_of(int width, int height)
{
    lmn_film_desc d = LMN_FILM_DESC_INIT;
    d.width = width;
    d.height = height;
    d.rate = RATE;
    d.frame_count = FRAMES;
    return d;
}

static lmn_status make_film(const char *path, const lmn_film_desc *d, uint8_t opacity, int *warnings, lmn_error *error)
{
    lmn_film *film = NULL;
    uint8_t  *rgba = malloc((size_t)d->width * (size_t)d->height * 4);
    assert_non_null(rgba);
    lmn_status status = lmn_film_open(&film, path, d, error);
    for (int i = 0; i < FRAMES && status == LMN_OK; i++) {
        paint(rgba, d->width, d->height, i, opacity);
        status = lmn_film_add(film, rgba, error);
    }
    if (warnings)
        *warnings = (int)lmn_film_warning_count(film);
    if (status == LMN_OK)
        status = lmn_film_close(&film, NULL, error);
    lmn_film_destroy(&film);
    free(rgba);
    return status;
}

static lmn_status make(const char *path, int width, int height, uint8_t opacity, int *warnings, lmn_error *error)
{
    lmn_film_desc d = desc_of(width, height);
    return make_film(path, &d, opacity, warnings, error);
}

/* --- WebP ----------------------------------------------------------------------------------------------- */

#ifdef LIMNER_HAVE_WEBPDEMUX

static void check_webp(uint8_t opacity)
{
    unsigned char *bytes = malloc(1 << 20);
    uint8_t        wanted[WIDTH * HEIGHT * 4], *shown;
    WebPAnimInfo   info;
    int            end_ms, frame = 0;
    FILE          *file = fopen(in_folder("x.webp"), "rb");
    assert_non_null(file);
    WebPData         data = {bytes, fread(bytes, 1, 1 << 20, file)};
    WebPAnimDecoder *decoder = WebPAnimDecoderNew(&data, NULL);
    fclose(file);
    assert_non_null(decoder);
    assert_true(WebPAnimDecoderGetInfo(decoder, &info));
    assert_int_equal(info.canvas_width, WIDTH);
    assert_int_equal(info.canvas_height, HEIGHT);
    assert_int_equal(info.loop_count, 0);
    while (WebPAnimDecoderHasMoreFrames(decoder)) {
        assert_true(WebPAnimDecoderGetNext(decoder, &shown, &end_ms));
        paint(wanted, WIDTH, HEIGHT, frame, opacity);
        for (size_t i = 0; i < sizeof wanted; i += 4) /* what cannot be seen has no colour */
            assert_true(wanted[i + 3] == shown[i + 3] && (wanted[i + 3] == 0 || memcmp(wanted + i, shown + i, 3) == 0));
        frame += frame == 2 ? 2 : 1; /* alike: one picture that is shown longer */
        assert_int_equal(end_ms, (frame * 1000 + RATE / 2) / RATE);
    }
    assert_int_equal(frame, FRAMES);
    WebPAnimDecoderDelete(decoder);
    free(bytes);
}

static void webp_is_exact(void **state)
{
    static const uint8_t opacities[] = {255, 128, 0};
    lmn_error            error = {0};
    int                  warnings = 0;
    (void)state;
    forget_programs();
    for (size_t i = 0; i < sizeof opacities; i++) {
        assert_int_equal(make(in_folder("x.webp"), WIDTH, HEIGHT, opacities[i], &warnings, &error), LMN_OK);
        assert_int_equal(warnings, 0);
        check_webp(opacities[i]);
    }
    assert_names(1);
}

#else

static void webp_is_exact(void **state)
{
    (void)state;
    skip();
}

#endif

/* --- ffmpeg --------------------------------------------------------------------------------------------- */

/* How far a film's pixels lie from the painted ones: all, and those of the last column and row. */
typedef struct distance {
    double sum[2], count[2];
} distance;

static void measure(distance *d, const uint8_t *shown, const uint8_t *wanted, bool on_white, bool last)
{
    double sum = on_white ? 0 : abs(shown[3] - wanted[3]);
    for (int k = 0; k < 3; k++) {
        int should = on_white ? (wanted[k] * wanted[3] + 255 * (255 - wanted[3])) / 255 : wanted[k];
        sum += on_white || wanted[3] > 0 ? abs(shown[k] - should) : 0; /* what cannot be seen has no colour */
    }
    for (int i = 0; i <= last; i++) {
        d->sum[i] += sum;
        d->count[i] += 4;
    }
}

/* Decodes a film with `decoder` before its name; the mean distance to the frames painted, whose last column and row
 * come again where the film is larger, or that of the last column and row, whichever is larger. */
static double difference(const char *name, const char *decoder, int width, int height, uint8_t opacity, bool on_white)
{
    char     command[1024];
    distance d = {{0, 0}, {0, 0}};
    size_t   size = (size_t)width * (size_t)height * 4;
    uint8_t  painted[WIDTH * HEIGHT * 4], *shown = malloc(size);
    snprintf(command, sizeof command, "ffmpeg -v error %s -i %s -f rawvideo -pix_fmt rgba - < /dev/null", decoder,
             in_folder(name));
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    for (int frame = 0; frame < FRAMES; frame++) {
        assert_int_equal(fread(shown, 1, size, pipe), size);
        paint(painted, WIDTH, HEIGHT, frame, opacity);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                size_t from = (size_t)(y < HEIGHT ? y : HEIGHT - 1) * WIDTH + (size_t)(x < WIDTH ? x : WIDTH - 1);
                measure(&d, shown + 4 * ((size_t)y * (size_t)width + (size_t)x), painted + 4 * from, on_white,
                        x == width - 1 || y == height - 1);
            }
    }
    assert_int_equal(fread(shown, 1, 1, pipe), 0); /* and no frame more */
    assert_int_equal(pclose(pipe), 0);
    free(shown);
    double all = d.sum[0] / d.count[0], last = d.sum[1] / d.count[1];
    return all > last ? all : last;
}

static void films_show_what_was_drawn(void **state)
{
    lmn_error error = {0};
    int       warnings;
    (void)state;
    if (!has_program("ffmpeg"))
        skip();
    assert_int_equal(make(in_folder("x.mp4"), WIDTH, HEIGHT, 255, &warnings, &error), LMN_OK);
    assert_int_equal(warnings, 1); /* the size is odd */
    assert_true(difference("x.mp4", "", WIDTH + 1, HEIGHT + 1, 255, true) < 2.0);
    assert_int_equal(make(in_folder("x.webm"), WIDTH, HEIGHT, 255, &warnings, &error), LMN_OK);
    assert_int_equal(warnings, 0);
    assert_true(difference("x.webm", "", WIDTH, HEIGHT, 255, true) < 3.0);
    assert_names(2);
}

static void gif_is_exact_in_few_colours(void **state)
{
    lmn_error error = {0};
    (void)state;
    if (!has_program("ffmpeg"))
        skip();
    assert_int_equal(make(in_folder("x.gif"), WIDTH, HEIGHT, 255, NULL, &error), LMN_OK);
    assert_true(difference("x.gif", "", WIDTH, HEIGHT, 255, true) < 1.0);
    lmn_film_desc d = desc_of(WIDTH, HEIGHT);
    d.frame_count = 0; /* a palette a frame */
    assert_int_equal(make_film(in_folder("y.gif"), &d, 255, NULL, &error), LMN_OK);
    assert_true(difference("y.gif", "", WIDTH, HEIGHT, 255, true) < 1.0);
    struct stat one, each;
    assert_int_equal(stat(in_folder("x.gif"), &one), 0);
    assert_int_equal(stat(in_folder("y.gif"), &each), 0);
    assert_true(each.st_size > one.st_size);
}

static void opacity_is_kept_or_laid_on_white(void **state)
{
    lmn_error error = {0};
    int       warnings;
    (void)state;
    if (!has_program("ffmpeg"))
        skip();
    assert_int_equal(make(in_folder("x.webm"), WIDTH, HEIGHT, 96, &warnings, &error), LMN_OK);
    assert_int_equal(warnings, 0);
    assert_true(difference("x.webm", "-c:v libvpx-vp9", WIDTH, HEIGHT, 96, false) < 4.0);
    assert_int_equal(make(in_folder("x.mp4"), WIDTH, HEIGHT, 96, &warnings, &error), LMN_OK);
    assert_int_equal(warnings, 2);
    assert_true(difference("x.mp4", "", WIDTH + 1, HEIGHT + 1, 96, true) < 2.5);
    assert_int_equal(make(in_folder("x.gif"), WIDTH, HEIGHT, 0, &warnings, &error), LMN_OK);
    assert_int_equal(warnings, 1);
    assert_true(difference("x.gif", "", WIDTH, HEIGHT, 0, false) < 1.0);
}

static void read_whole(const char *path, unsigned char *out, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    *size = fread(out, 1, 1 << 16, file);
    fclose(file);
}

static void same_frames_same_bytes(void **state)
{
    static const char *const names[] = {"x.mp4", "x.webm", "x.gif", "x.webp"};
    static unsigned char     bytes[2][1 << 16];
    size_t                   sizes[2];
    (void)state;
    for (size_t i = has_program("ffmpeg") ? 0 : 3; i < sizeof names / sizeof *names; i++) {
        lmn_error error = {0};
        for (int k = 0; k < 2; k++) {
            lmn_status status = make(in_folder(names[i]), WIDTH, HEIGHT, 255, NULL, &error);
            if (status == LMN_UNSUPPORTED)
                continue;
            assert_int_equal(status, LMN_OK);
            read_whole(at, bytes[k], &sizes[k]);
        }
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    }
}

static void one_pixel_is_a_film(void **state)
{
    static const char *const names[] = {"x.mp4", "x.webm", "x.gif", "x.webp"};
    (void)state;
    if (!has_program("ffmpeg"))
        skip();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        lmn_error  error = {0};
        lmn_status status = make(in_folder(names[i]), 1, 1, 255, NULL, &error);
        assert_true(status == LMN_OK || (status == LMN_UNSUPPORTED && i == 3));
    }
}

/* --- programs that fail --------------------------------------------------------------------------------- */

enum { LARGE = 512 };

/* With frames that do not fit into what is on its way. */
static lmn_status make_large(lmn_error *error)
{
    return make(in_folder("x.mp4"), LARGE, LARGE, 255, NULL, error);
}

static void programs_that_die_are_quoted(void **state)
{
    static const struct {
        const char *script, *how, *words;
    } rows[] = {
        {"head -c 2000000 > /dev/null; echo 'no more' >&2; echo 'for today' >&2; exit 3", "exit status 3",
         "no more for today"},
        {"head -c 2000000 > /dev/null; kill -SEGV $$", "signal 11", ""},
        {"exit 0", "did not do all", ""},
        {"cat > /dev/null; exit 1", "exit status 1", ""},
        {"cat > /dev/null; echo 'Error writing trailer of x: No space left on device' >&2", "did not do all",
         "No space left on device"},
        {"head -c 300000 /dev/zero | tr '\\0' 'e' >&2; echo >&2; echo end >&2; cat > /dev/null; exit 2",
         "exit status 2", ": end"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_error error = {0};
        pretend(rows[i].script);
        assert_int_equal(make_large(&error), LMN_WRITE);
        assert_string_equal(error.file, in_folder("x.mp4"));
        if (!strstr(error.message, rows[i].how) || !strstr(error.message, rows[i].words))
            fail_msg("%s", error.message);
        assert_names(0);
    }
}

static void programs_that_do_not_start_are_told(void **state)
{
    lmn_error error = {0};
    (void)state;
    pretend("exit 0");
    FILE *file = fopen(in_folder("bin/ffmpeg"), "w");
    assert_non_null(file);
    fputs("#!/nosuch/interpreter\n", file);
    fclose(file);
    assert_int_equal(make_large(&error), LMN_WRITE);
    assert_non_null(strstr(error.message, "cannot be started: No such file"));
    assert_names(0);
}

static void a_missing_encoder_is_told(void **state)
{
    lmn_error error = {0};
    (void)state;
    pretend("echo \"Unknown encoder 'libx264'\" >&2; exit 1");
    assert_int_equal(make_large(&error), LMN_WRITE);
    assert_non_null(strstr(error.message, "libx264"));
    assert_non_null(strstr(error.hint, ".webp"));
}

static void a_missing_program_is_told(void **state)
{
    lmn_error            error = {0};
    lmn_film_desc        d = desc_of(8, 8);
    lmn_film_format_info info;
    (void)state;
    forget_programs();
    assert_int_equal(make_large(&error), LMN_UNSUPPORTED);
    assert_string_equal(error.file, in_folder("x.mp4"));
    assert_non_null(strstr(error.hint, "apt-get install ffmpeg"));
    assert_int_equal(lmn_film_check("x.gif", &d, &error), LMN_UNSUPPORTED);
    for (size_t i = 0; lmn_film_format_at(i, &info); i++)
        assert_true(
            info.usable ==
            (lmn_film_check(
                 "x",
                 &(lmn_film_desc){.struct_size = sizeof d, .width = 8, .height = 8, .rate = 1, .format = info.ending},
                 NULL) == LMN_OK));
    assert_names(0);
}

/* Whoever put a folder called ffmpeg there did not mean this. */
static void folders_are_no_programs(void **state)
{
    lmn_error error = {0};
    (void)state;
    mkdir(in_folder("bin"), 0700);
    mkdir(in_folder("bin/ffmpeg"), 0700);
    assert_int_equal(setenv("PATH", in_folder("bin"), 1), 0);
    assert_int_equal(make_large(&error), LMN_UNSUPPORTED);
}

/* --- stopping ------------------------------------------------------------------------------------------- */

static bool go_on(double fraction, const char *stage, void *user)
{
    int *left = user;
    (void)fraction, (void)stage;
    return --*left > 0;
}

static long number_in_folder(void)
{
    long  number = 0;
    FILE *file = fopen(in_folder("number"), "r");
    if (file) {
        if (fscanf(file, "%ld", &number) != 1)
            number = 0;
        fclose(file);
    }
    return number;
}

/* One that nobody has asked for its result yet does not run any more. */
static bool is_running(long id)
{
    char path[64], state = 'Z';
    snprintf(path, sizeof path, "/proc/%ld/stat", id);
    FILE *file = fopen(path, "r");
    if (file && fscanf(file, "%*d %*s %c", &state) != 1)
        state = 'Z';
    if (file)
        fclose(file);
    return state != 'Z' && state != 'X';
}

/* What was killed goes when the system comes to it: on a busy machine a little later. */
static bool ends(long id)
{
    for (int i = 0; i < 1000 && is_running(id); i++)
        usleep(10000);
    return !is_running(id);
}

/* A program that takes nothing and has one of its own, and one that never ends. */
static void stopping_ends_the_program(void **state)
{
    static const char *const scripts[] = {"sleep 1000 & echo $! > number; wait",
                                          "cat > /dev/null; echo $$ > number; exec sleep 1000"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        char          script[256];
        int           left = 40;
        lmn_film     *film = NULL;
        lmn_error     error = {0};
        lmn_film_desc d = desc_of(LARGE, LARGE);
        uint8_t      *rgba = calloc((size_t)LARGE * LARGE, 4);
        snprintf(script, sizeof script, "cd %s; %s", folder, scripts[i]);
        pretend(script);
        d.progress = go_on;
        d.progress_user = &left;
        assert_int_equal(lmn_film_open(&film, in_folder("x.mp4"), &d, &error), LMN_OK);
        lmn_status status = lmn_film_add(film, rgba, &error);
        assert_int_equal(status, i == 0 ? LMN_CANCELLED : LMN_OK);
        if (i == 1)
            assert_int_equal(lmn_film_close(&film, NULL, &error), LMN_CANCELLED);
        lmn_film_destroy(&film);
        assert_null(film);
        assert_true(number_in_folder() > 0);
        assert_true(ends(number_in_folder()));
        assert_names(0);
        free(rgba);
    }
}

/* The process ends in the middle of a film; the program sees its input end and what it writes has no name. */
static void killed_processes_leave_nothing(void **state)
{
    (void)state;
    pretend("cat > /proc/self/fd/3");
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        lmn_film     *film = NULL;
        lmn_film_desc d = desc_of(LARGE, LARGE);
        uint8_t      *rgba = calloc((size_t)LARGE * LARGE, 4);
        if (lmn_film_open(&film, in_folder("x.mp4"), &d, NULL) == LMN_OK && lmn_film_add(film, rgba, NULL) == LMN_OK)
            raise(SIGKILL);
        _exit(1);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
    assert_names(0);
}

/* --- files ---------------------------------------------------------------------------------------------- */

static void assert_content(const char *path, const char *wanted)
{
    char  got[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_true(fread(got, 1, sizeof got - 1, file) > 0);
    fclose(file);
    assert_string_equal(got, wanted);
}

static void films_replace_what_was_there(void **state)
{
    struct stat facts;
    lmn_error   error = {0};
    (void)state;
    FILE *file = fopen(in_folder("old.mp4"), "w");
    assert_non_null(file);
    fputs("old", file);
    fclose(file);
    assert_int_equal(chmod(at, 0444), 0);
    assert_int_equal(symlink("old.mp4", in_folder("x.mp4")), 0);
    pretend("cat > /dev/null; exit 1");
    assert_int_equal(make_large(&error), LMN_WRITE);
    assert_content(in_folder("old.mp4"), "old");
    pretend("cat > /dev/null; printf new > /proc/self/fd/3");
    assert_int_equal(make_large(&error), LMN_OK);
    assert_content(in_folder("old.mp4"), "new");
    assert_int_equal(stat(at, &facts), 0);
    assert_int_equal(facts.st_mode & 0777, 0444);
    assert_int_equal(lstat(in_folder("x.mp4"), &facts), 0);
    assert_true(S_ISLNK(facts.st_mode));
    assert_names(2);
}

static void where_no_film_can_lie_is_told(void **state)
{
    lmn_film     *film = NULL;
    lmn_film_desc d = desc_of(8, 8);
    (void)state;
    pretend("cat > /dev/null");
    d.format = "mp4";
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    const char *const places[] = {in_folder("pipe"), "/dev/null", "/dev/stdout", "/nosuch/x.mp4", "/tmp", ""};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        lmn_error error = {0};
        assert_int_equal(lmn_film_open(&film, places[i], &d, &error), LMN_WRITE);
        assert_string_equal(error.file, places[i]);
        assert_null(film);
    }
}

static int make_beyond_the_limit(void)
{
    struct rlimit limit = {64, 64};
    lmn_error     error = {0};
    setrlimit(RLIMIT_FSIZE, &limit);
    return make(in_folder("x.webp"), WIDTH, HEIGHT, 255, NULL, &error) == LMN_WRITE ? 0 : 1;
}

static void too_large_a_film_is_an_error(void **state)
{
    int   status = 0;
    pid_t child = fork();
    (void)state;
    assert_true(child >= 0);
    if (child == 0)
        _exit(make_beyond_the_limit());
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_names(0);
}

/* --- arguments ------------------------------------------------------------------------------------------ */

static void wrong_arguments_are_told(void **state)
{
    (void)state;
    static const struct {
        const char *path, *format, *words;
        int         width;
        double      rate;
    } rows[] = {
        {"x.avi", NULL, "cannot write '.avi' films", 8, 24},
        {"x.webm", "wep", "cannot write 'wep' films", 8, 24},
        {"x", NULL, "cannot write '' films", 8, 24},
        {"x.webp", NULL, "of 0x8 pixels", 0, 24},
        {"x.webp", NULL, "1 to 16383 a side", 16384, 24},
        {"x.webp", NULL, "0.001 to 1000", 8, 1001},
        {"x.gif", NULL, "0.001 to 50", 8, 50.5},
        {"x.webp", NULL, "0 frames a second", 8, 0},
    };
    lmn_film *film = NULL;
    lmn_error error = {0};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_film_desc d = desc_of(rows[i].width, 8);
        d.rate = rows[i].rate;
        d.format = rows[i].format;
        assert_int_equal(lmn_film_open(&film, rows[i].path, &d, &error), LMN_USAGE);
        if (!strstr(error.message, rows[i].words))
            fail_msg("%s", error.message);
    }
    lmn_film_desc unset = {0};
    assert_int_equal(lmn_film_check("x.webp", &unset, &error), LMN_USAGE);
    assert_non_null(strstr(error.hint, "LMN_FILM_DESC_INIT"));
    assert_int_equal(lmn_film_check(NULL, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_film_open(NULL, "x.webp", NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_film_add(NULL, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_film_close(&film, NULL, &error), LMN_USAGE);
    lmn_film_destroy(NULL);
    lmn_film_destroy(&film);
}

static void films_without_frames_are_none(void **state)
{
    lmn_film     *film = NULL;
    lmn_error     error = {0};
    lmn_film_desc d = desc_of(8, 8);
    (void)state;
    pretend("cat > /dev/null");
    assert_int_equal(lmn_film_open(&film, in_folder("x.mp4"), &d, &error), LMN_OK);
    assert_int_equal(lmn_film_close(&film, NULL, &error), LMN_USAGE);
    assert_null(film);
    assert_names(0);
}

/* --- memory --------------------------------------------------------------------------------------------- */

static void missing_memory_is_told(void **state)
{
    static const char *const names[] = {"x.webp", "x.mp4"};
    (void)state;
    pretend("cat > /dev/null; printf film > /proc/self/fd/3");
    for (int i = 0; i < 2; i++) {
        lmn_status status = LMN_MEMORY;
        for (long n = 1; status != LMN_OK && n < 100; n++) {
            lmn_error error = {0};
            in_folder(names[i]);
            mem_fail_at(n);
            status = make(at, 5, 5, 100, NULL, &error);
            mem_fail_at(0);
            assert_true(status == LMN_OK || status == LMN_MEMORY || (status == LMN_UNSUPPORTED && i == 0));
            assert_names(i + (status == LMN_OK));
            if (status == LMN_UNSUPPORTED)
                skip();
        }
        assert_int_equal(status, LMN_OK);
    }
}

/* --- pictures that are whole ---------------------------------------------------------------------------- */

static bool is_whole(const unsigned char *bytes, size_t size, int width, int height)
{
    FILE *file = fopen(in_folder("x.png"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return lmn_picture_is_whole(at, width, height);
}

static void whole_pictures_are_known(void **state)
{
    uint8_t      rgba[9 * 5 * 4];
    export_bytes png;
    (void)state;
    paint(rgba, 9, 5, 0, 255);
    assert_int_equal(export_png(&png, rgba, 9, 5, NULL), LMN_OK);
    assert_true(is_whole(png.data, png.size, 9, 5));
    assert_false(is_whole(png.data, png.size, 5, 9));
    assert_false(is_whole(png.data, png.size, 9, 6));
    for (size_t size = 0; size < png.size; size++)
        assert_false(is_whole(png.data, size, 9, 5));
    for (size_t i = 0; i < png.size; i++) {
        png.data[i] ^= 0x10;
        assert_false(is_whole(png.data, png.size, 9, 5));
        png.data[i] ^= 0x10;
    }
    unsigned char *longer = malloc(png.size + 1);
    memcpy(longer, png.data, png.size);
    longer[png.size] = 0;
    assert_false(is_whole(longer, png.size + 1, 9, 5));
    free(longer);
    mem_free(png.data);
    assert_false(lmn_picture_is_whole(in_folder("nosuch.png"), 9, 5));
    assert_false(lmn_picture_is_whole(folder, 9, 5));
    assert_false(lmn_picture_is_whole(NULL, 9, 5));
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, enter, leave)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(webp_is_exact),
        CASE(films_show_what_was_drawn),
        CASE(gif_is_exact_in_few_colours),
        CASE(opacity_is_kept_or_laid_on_white),
        CASE(same_frames_same_bytes),
        CASE(one_pixel_is_a_film),
        CASE(programs_that_die_are_quoted),
        CASE(programs_that_do_not_start_are_told),
        CASE(a_missing_encoder_is_told),
        CASE(a_missing_program_is_told),
        CASE(folders_are_no_programs),
        CASE(stopping_ends_the_program),
        CASE(killed_processes_leave_nothing),
        CASE(films_replace_what_was_there),
        CASE(where_no_film_can_lie_is_told),
        CASE(too_large_a_film_is_an_error),
        CASE(wrong_arguments_are_told),
        CASE(films_without_frames_are_none),
        CASE(missing_memory_is_told),
        CASE(whole_pictures_are_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
