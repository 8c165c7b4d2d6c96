// limner.hpp against the installed library: ownership, errors, and what callbacks throw. Usage: cplusplus MODEL FOLDER
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limner/limner.hpp>
#include <type_traits>

static void check(bool good, const char *what)
{
    if (good)
        return;
    std::cerr << "not so: " << what << "\n";
    std::exit(1);
}
#define CHECK(condition) check(condition, #condition)

template <class Type> constexpr bool moves_only()
{
    return std::is_nothrow_move_constructible_v<Type> && std::is_nothrow_move_assignable_v<Type> &&
           !std::is_copy_constructible_v<Type> && !std::is_copy_assignable_v<Type>;
}
static_assert(moves_only<limner::scene>() && moves_only<limner::look>() && moves_only<limner::renderer>() &&
              moves_only<limner::drawing>() && moves_only<limner::sheet>() && moves_only<limner::film>() &&
              moves_only<limner::strokes>() && moves_only<limner::dynamics>());
static_assert(!std::is_move_constructible_v<limner::task> && !std::is_copy_constructible_v<limner::task>);
static_assert(std::is_nothrow_copy_constructible_v<limner::error>);

// The status of what a function throws; LMN_OK: nothing.
template <class Function> lmn_status thrown(Function function)
{
    try {
        function();
    } catch (const limner::error &e) {
        CHECK(e.what()[0] != 0);
        return e.status();
    }
    return LMN_OK;
}

static void errors(const std::string &folder)
{
    CHECK(thrown([] { limner::look l("hach"); }) == LMN_USAGE);
    try {
        limner::look l("hach");
    } catch (const limner::error &e) {
        CHECK(std::string(e.hint()).find("hatch") != std::string::npos);
        CHECK(dynamic_cast<const std::runtime_error *>(&e) != nullptr);
    }
    try {
        limner::scene s(folder + "/absent.stl");
        CHECK(false);
    } catch (const limner::error &e) {
        CHECK(e.status() == LMN_READ && e.file() == folder + "/absent.stl");
    }
    try {
        limner::look::parse("{\n  1", "mine.json");
        CHECK(false);
    } catch (const limner::error &e) {
        CHECK(e.status() == LMN_FORMAT && e.line() == 2);
    }
}

static void ownership(const std::string &model)
{
    limner::scene first(model), second;
    lmn_scene    *pointer = first.get();
    second = std::move(first);
    CHECK(second.get() == pointer && !first && second.info().parts == 1);
    CHECK(thrown([&] { first.add_file(model); }) == LMN_USAGE);
    limner::scene third(std::move(second));
    lmn_scene    *mine = third.release();
    CHECK(mine == pointer && !third);
    lmn_scene_destroy(&mine);
    limner::scene &same = third;
    third = std::move(same);
    // All of C is within reach.
    limner::scene  s;
    lmn_node_desc  node = limner::node_desc();
    const uint32_t number = s.add(node);
    limner::call(lmn_scene_set_visible, s.get(), number, false);
    CHECK(thrown([&] { limner::call(lmn_scene_set_visible, s.get(), number + 1, false); }) == LMN_USAGE);
}

static void drawings(const std::string &model, const std::string &folder)
{
    limner::drawing d = limner::draw(model, "hatch", 64, 48);
    CHECK(d.pixels().width == 64 && d.pixels().height == 48 && d.pixels().size() == 64 * 48 * 4);
    CHECK(d.write(folder + "/hatch.png") > 100 && d.report_json()[0] == '{' && d.warnings().empty());
    CHECK(thrown([&] { d.map(LMN_MAP_DEPTH); }) == LMN_USAGE);

    limner::renderer r;
    limner::scene    s(model);
    limner::look     l = limner::look("line").set("lines.width", "2px");
    lmn_draw_desc    desc = limner::draw_desc(64, 48);
    desc.maps = true;
    limner::drawing mapped(r, s, l, desc);
    CHECK(mapped.map(LMN_MAP_NORMAL).size() == 64 * 48 * 3 && mapped.ids().size() == 64 * 48);
    const lmn_pick seen = mapped.pick(32, 24);
    CHECK(seen.part == 1 && mapped.ids()[24 * 64 + 32] == 1);
    CHECK(mapped.pick_parts(0, 0, 64, 48) == std::vector<std::uint32_t>{1});
    const auto at = mapped.project({seen.position[0], seen.position[1], seen.position[2]});
    CHECK(at && at->x > 32 && at->x < 33 && at->y > 24 && at->y < 25);
    const auto point = mapped.unproject(*at);
    CHECK(std::abs(point[0] - seen.position[0]) < 1e-6);

    limner::sheet sheet(s, l, desc);
    CHECK(sheet.write(folder + "/line.svg") > 100 && sheet.write(folder + "/line.out", ".pdf") > 100);
    CHECK(limner::looks().size() == lmn_look_count());
    limner::strokes strokes;
    strokes.set(0, lmn_stroke{0, 0, 1, 1, 1, 1, 0});
    CHECK(strokes.size() == 1 && strokes.at(0).u1 == 1);
}

// What happens in a scene: made, changed, and told.
static void behaviours()
{
    limner::scene     s;
    const auto        ball = s.add(limner::node_desc());
    limner::behaviour b(s);
    auto              fall = limner::constraint_desc(ball, LMN_TIME_MAP_FALL, 1);
    fall.start_given = true;
    fall.start[1] = 9;
    const double place[] = {1, 2, 3};
    auto         rest = limner::constraint_desc(ball, LMN_TIME_MAP_CONSTANT, 1);
    rest.values = place;
    rest.value_count = 1;
    const auto whole = b.add(LMN_ACTIVITY_SEQUENCE, {b.add(fall), b.add(rest)});
    b.play({whole});
    {
        limner::dynamics d(s);
        CHECK(d.duration() == 2 && d.lifetimes().size() == 2 && d.lifetimes()[1].from_s == 1);
        CHECK(std::abs(d.point(ball, 0.5).position[1] - (9 - 9.81 / 8)) < 1e-9 && d.point(ball, 2).position[0] == 1);
        CHECK(d.trajectory(ball, 0, 2, 0.01).size() >= 4 && d.contacts(ball, 0, 2).empty());
        CHECK(d.of_node(ball, 0, 0.5).second == std::vector<std::size_t>{0});
    }
    // A function that throws leaves the scene as it was, and one that does not is kept as long as it is asked.
    struct mine {
    };
    auto kept = std::make_shared<int>(0);
    b.set(whole, limner::constraint_desc(ball, LMN_TIME_MAP_CALLBACK, 3), [kept](double seconds, double *out) {
        out[0] = out[1] = out[2] = seconds;
        ++*kept;
    });
    CHECK(*kept > 0 && kept.use_count() == 2 && limner::dynamics(s).point(ball, 2).position[2] == 2);
    bool caught = false;
    try {
        b.set(whole, limner::constraint_desc(ball, LMN_TIME_MAP_CALLBACK, 3), [](double, double *) { throw mine(); });
    } catch (const mine &) {
        caught = true;
    }
    CHECK(caught && limner::dynamics(s).duration() == 3);
    const std::vector<lmn_activity_child> itself = {{whole, 0, 0}};
    CHECK(thrown([&] { b.set(whole, limner::activity_desc(LMN_ACTIVITY_TABLE), itself); }) == LMN_USAGE);
    b.set(whole, rest);
    CHECK(kept.use_count() == 1);
}

// Exceptions of callbacks arrive, and none goes through C.
static void callbacks(const std::string &model)
{
    struct mine {
    };
    limner::renderer r;
    limner::scene    s(model);
    limner::look     l("line");
    int              asked = 0;
    limner::drawing  good(r, s, l, limner::draw_desc(64, 48), [&](double, const char *) { return ++asked > 0; });
    CHECK(asked > 0);
    CHECK(thrown([&] {
              limner::drawing d(r, s, l, limner::draw_desc(64, 48), [](double, const char *) { return false; });
          }) == LMN_CANCELLED);
    bool caught = false;
    try {
        limner::drawing d(r, s, l, limner::draw_desc(64, 48), [](double, const char *) -> bool { throw mine(); });
    } catch (const mine &) {
        caught = true;
    }
    CHECK(caught);

    lmn_task_desc conditions = lmn_task_desc_standard();
    conditions.limits.triangles = 1;
    {
        limner::task strict(conditions);
        CHECK(thrown([&] { limner::scene big(model); }) == LMN_LIMIT);
    }
    {
        limner::task archive(
            lmn_task_desc_standard(), {},
            [](const char *, const char *) -> std::optional<std::vector<std::uint8_t>> { throw mine(); });
        CHECK(thrown([&] { limner::scene unread(model); }) == LMN_READ);
        caught = false;
        try {
            archive.rethrow();
        } catch (const mine &) {
            caught = true;
        }
        CHECK(caught);
        archive.rethrow();
    }
}

static void films(const std::string &folder)
{
    lmn_film_desc desc = limner::film_desc(16, 16);
    if (lmn_film_check("f.webp", &desc, nullptr) != LMN_OK)
        return;
    const std::vector<std::uint8_t> frame(16 * 16 * 4, 255);
    const std::string               kept = folder + "/kept.webp", left = folder + "/left.webp";
    {
        limner::film f(kept, desc), g(left, desc);
        g.add(frame.data());
        limner::film moved(std::move(f));
        moved.add(frame.data());
        CHECK(moved.close() > 0 && !moved && moved.warnings().empty());
        CHECK(thrown([&] { moved.add(frame.data()); }) == LMN_USAGE);
    }
    std::FILE *file = std::fopen(kept.c_str(), "rb");
    CHECK(file != nullptr);
    std::fclose(file);
    CHECK(std::fopen(left.c_str(), "rb") == nullptr);
}

static std::vector<std::uint8_t> bytes_of(const std::string &path)
{
    std::ifstream file(path, std::ios::binary);
    return std::vector<std::uint8_t>(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

// Encoded bytes are those of files; textures are refused as in C.
static void encoded(const std::string &model, const std::string &folder)
{
    limner::renderer r;
    limner::scene    s(model);
    limner::look     l("line");
    lmn_draw_desc    desc = limner::draw_desc(64, 48);
    desc.maps = true;
    limner::drawing d(r, s, l, desc);
    limner::sheet   sheet(s, l, desc);
    d.write(folder + "/encoded.png");
    sheet.write(folder + "/encoded.svg");
    CHECK(d.encode(".png") == bytes_of(folder + "/encoded.png") && d.encode(".png").size() > 100);
    CHECK(sheet.encode(".svg") == bytes_of(folder + "/encoded.svg") && sheet.encode(".svg").size() > 100);
    CHECK(thrown([&] { d.encode(".txt"); }) == LMN_USAGE);
    const lmn_pick one = r.pick(s, l, desc, 32, 24), same = d.pick(32, 24);
    CHECK(one.part == 1 && one.part == same.part && one.depth == same.depth);
    CHECK(thrown([&] { d.texture(); }) == LMN_USAGE && thrown([&] { d.map_texture(LMN_MAP_ID); }) == LMN_USAGE);
    d.read_back();
    desc.textures = true; // the context is Limner's own
    CHECK(thrown([&] { limner::drawing(r, s, l, desc); }) == LMN_USAGE);
}

// A technique that paints all in one colour, in looks that outlive its set.
static void techniques(const std::string &model)
{
    static_assert(moves_only<limner::techniques>());
    const std::string  glsl = "vec4 surface_colour(surface_point p) { return vec4(u_paint.rgb, 1.0); }";
    lmn_param_desc     paint = {};
    limner::renderer   r;
    limner::scene      s(model);
    limner::techniques set;
    paint.key = "paint";
    paint.type = LMN_PARAM_COLOUR;
    paint.standard = "#ff0000";
    set.add(limner::technique_desc("painted", glsl.c_str()), {paint});
    CHECK(set.names() == std::vector<std::string>{"painted"});
    CHECK(thrown([&] { set.add(limner::technique_desc("painted", glsl.c_str())); }) == LMN_USAGE);
    CHECK(thrown([&] { set.add(limner::technique_desc("empty", nullptr)); }) == LMN_USAGE);
    const std::string json = "{\"version\": 2, \"rules\": [{\"select\": \"*\", \"surface\": \"painted\"}]}";
    limner::look      l = limner::look::parse(json, set);
    CHECK(thrown([&] { limner::look::parse(json); }) != LMN_OK);
    CHECK(std::string(limner::look("line", set).name()) == "line");
    set = limner::techniques();
    const limner::drawing d(r, s, l, limner::draw_desc(32, 32));
    const std::uint8_t   *middle = d.pixels().data + 4 * (16 * 32 + 16);
    CHECK(middle[0] == 255 && middle[1] == 0 && middle[2] == 0);
}

// A format of the program's own: the number of triangles as text. What its functions throw arrives, and leaves no part.
static void importers(const std::string &folder)
{
    const std::string path = folder + "/three.count";
    std::ofstream(path) << "3";
    const float      corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    limner::importer counted{"counted",
                             ".count",
                             [&](limner::scene &into, const char *, const std::uint8_t *bytes, std::size_t size) {
                                 CHECK(size == 1);
                                 for (int i = 0; i < bytes[0] - '0'; i++) {
                                     lmn_mesh_desc mesh = limner::mesh_desc();
                                     lmn_node_desc node = limner::node_desc();
                                     mesh.positions = corners;
                                     mesh.vertex_count = 3;
                                     node.mesh = into.add(mesh);
                                     into.add(node);
                                 }
                             },
                             {}};
    limner::scene    s;
    s.add_file(path, {counted});
    CHECK(s.info().parts == 3);
    CHECK(thrown([&] { s.add_file(path); }) != LMN_OK); // Limner has no such format
    limner::importer broken = counted, asks = counted;
    broken.read = [](limner::scene &, const char *, const std::uint8_t *, std::size_t) { throw std::string("broken"); };
    asks.probe = [](const std::uint8_t *, std::size_t) -> bool { throw 7; };
    int caught = 0;
    try {
        s.add_file(path, {broken});
    } catch (const std::string &what) {
        caught += what == "broken";
    }
    try {
        s.add_file(path, {asks, counted});
    } catch (int number) {
        caught += number == 7;
    }
    broken.read = [](limner::scene &into, const char *, const std::uint8_t *, std::size_t) {
        limner::call(lmn_scene_set_visible, into.get(), 4711u, false);
    };
    CHECK(caught == 2 && thrown([&] { s.add_file(path, {broken}); }) == LMN_USAGE && s.info().parts == 3);
    asks.probe = [](const std::uint8_t *bytes, std::size_t) { return bytes[0] == 'x'; };
    s.add_file(path, {asks, counted});
    CHECK(s.info().parts == 6);
}

// All of the library's memory, and none of it left.
struct counting {
    std::atomic<long> blocks{0}, asked{0};
    void             *alloc(std::size_t size) noexcept
    {
        void *block = std::malloc(size);
        blocks += block != nullptr;
        asked++;
        return block;
    }
    void *resize(void *block, std::size_t size) noexcept
    {
        return std::realloc(block, size);
    }
    void release(void *block) noexcept
    {
        blocks -= block != nullptr;
        std::free(block);
    }
};
static counting memory;

int main(int count, char **arguments)
{
    if (count != 3)
        return 1;
    const std::string model = arguments[1], folder = arguments[2];
    limner::set_allocator(memory);
    CHECK(thrown([] {
              limner::scene first;
              limner::set_allocator(memory);
          }) == LMN_USAGE);
    errors(folder);
    ownership(model);
    drawings(model, folder);
    behaviours();
    callbacks(model);
    films(folder);
    encoded(model, folder);
    techniques(model);
    importers(folder);
    CHECK(memory.asked > 1000 && memory.blocks == 0);
    return 0;
}
