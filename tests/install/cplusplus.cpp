// limner.hpp against the installed library: ownership, errors, and what callbacks throw. Usage: cplusplus MODEL FOLDER
#include <cstdio>
#include <cstdlib>
#include <iostream>
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
              moves_only<limner::strokes>());
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

int main(int count, char **arguments)
{
    if (count != 3)
        return 1;
    const std::string model = arguments[1], folder = arguments[2];
    errors(folder);
    ownership(model);
    drawings(model, folder);
    callbacks(model);
    films(folder);
    return 0;
}
