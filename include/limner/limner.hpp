/* Limner in C++17: owners for the handles, exceptions for errors; nothing to link but the C library. All that is not
 * here is called in C with get() of an object, by limner::call where it can fail.
 *
 * Objects are moved, not copied, and end what they own. A moved-from object owns nothing: get() is nullptr, and calls
 * with it throw limner::error (LMN_USAGE). Threads, units and errors are those of the C functions. Callbacks are
 * functions that may throw: the work ends, and the call that asked them throws what they have thrown. Since 0.1. */
#ifndef LIMNER_LIMNER_HPP
#define LIMNER_LIMNER_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "limner/limner.h"

namespace limner
{

/* --- errors --------------------------------------------------------------------------------------------- */

/* What went wrong: what() is the message. */
class error : public std::runtime_error
{
  public:
    explicit error(const lmn_error &e)
        : std::runtime_error(e.message[0] ? e.message : lmn_status_text(e.status)),
          error_(std::make_shared<lmn_error>(e))
    {
    }
    lmn_status status() const noexcept
    {
        return error_->status;
    }
    const char *hint() const noexcept
    {
        return error_->hint;
    } /* what to do about it; empty: nothing is known */
    const char *file() const noexcept
    {
        return error_->file;
    } /* which file is to blame; empty: none */
    int line() const noexcept
    {
        return error_->line;
    } /* from 1 on; 0: none */
    int column() const noexcept
    {
        return error_->column;
    }

  private:
    std::shared_ptr<const lmn_error> error_; /* copies of exceptions must not throw */
};

/* Calls a function of C whose last argument is the error, without that one; throws when it fails:
 * limner::call(lmn_scene_set_visible, scene.get(), node, false) */
template <class... Parameters, class... Arguments>
void call(lmn_status (*function)(Parameters...), Arguments &&...arguments)
{
    lmn_error  e = {};
    lmn_status status = function(std::forward<Arguments>(arguments)..., &e);
    if (status == LMN_OK)
        return;
    e.status = status;
    throw error(e);
}

/* Is asked during long work with the fraction done, 0 … 1, and what is done; false ends it: LMN_CANCELLED. */
using progress_function = std::function<bool(double fraction, const char *stage)>;

namespace detail
{
struct reading;

/* Text that Limner returned, as one of C++. NULL: memory is gone. */
inline std::string take(char *text)
{
    if (!text)
        throw std::bad_alloc();
    std::unique_ptr<char, void (*)(char *)> owner(text, lmn_text_free);
    return text;
}

/* Keeps what a callback throws, since nothing may be thrown through C. */
struct watch {
    progress_function  function;
    std::exception_ptr thrown;

    static bool ask(double fraction, const char *stage, void *user) noexcept
    {
        watch *w = static_cast<watch *>(user);
        if (w->thrown)
            return false;
        try {
            return w->function(fraction, stage);
        } catch (...) {
            w->thrown = std::current_exception();
            return false;
        }
    }
    /* Where there is a function, a description asks it instead of its own. */
    template <class Desc> void attach(Desc &desc)
    {
        if (function) {
            desc.progress = ask;
            desc.progress_user = this;
        }
    }
    /* The call, and then what was thrown in it. */
    template <class... Types> void run(Types &&...arguments)
    {
        try {
            call(std::forward<Types>(arguments)...);
        } catch (const error &) {
            rethrow();
            throw;
        }
        rethrow();
    }
    void rethrow()
    {
        if (thrown)
            std::rethrow_exception(std::exchange(thrown, nullptr));
    }
};

/* Bytes that Limner returned, as those of C++. */
template <class Type>
std::vector<std::uint8_t> encoded(lmn_status (*function)(const Type *, const char *, std::uint8_t **, std::size_t *,
                                                         lmn_error *),
                                  const Type *of, const std::string &format)
{
    std::uint8_t *bytes = nullptr;
    std::size_t   size = 0;
    call(function, of, format.c_str(), &bytes, &size);
    std::unique_ptr<std::uint8_t, void (*)(std::uint8_t *)> owner(bytes, lmn_bytes_free);
    return std::vector<std::uint8_t>(bytes, bytes + size);
}

/* Owns a handle of C. */
template <class Type, void (*End)(Type **)> class handle
{
  public:
    handle() noexcept = default;
    explicit handle(Type *owned) noexcept : pointer_(owned)
    {
    }
    handle(handle &&other) noexcept : pointer_(other.release())
    {
    }
    handle &operator=(handle &&other) noexcept
    {
        if (this != &other) {
            End(&pointer_);
            pointer_ = other.release();
        }
        return *this;
    }
    handle(const handle &) = delete;
    handle &operator=(const handle &) = delete;
    ~handle()
    {
        End(&pointer_);
    }

    Type *get() const noexcept
    {
        return pointer_;
    } /* lent */
    Type *release() noexcept
    {
        return std::exchange(pointer_, nullptr);
    } /* the caller's now */
    explicit operator bool() const noexcept
    {
        return pointer_ != nullptr;
    }

  protected:
    Type **out() noexcept
    {
        return &pointer_;
    }

  private:
    Type *pointer_ = nullptr;
};

} // namespace detail

/* A warning of a drawing, a sheet or a film. */
struct warning {
    std::string code, text;
    std::size_t count; /* how often */
};

namespace detail
{
template <class Type>
std::vector<warning> warnings_of(const Type *of, std::size_t (*how_many)(const Type *),
                                 const char *(*at)(const Type *, std::size_t, const char **, std::size_t *))
{
    std::vector<warning> all;
    for (std::size_t i = 0; i < how_many(of); i++) {
        const char *code = "";
        std::size_t count = 0;
        const char *text = at(of, i, &code, &count);
        all.push_back({code, text ? text : "", count});
    }
    return all;
}
} // namespace detail

/* --- descriptions with their standard values ------------------------------------------------------------ */

inline lmn_draw_desc draw_desc(int width = 1024, int height = 1024)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = width;
    desc.height = height;
    return desc;
}
inline lmn_load_desc load_desc()
{
    return LMN_LOAD_DESC_INIT;
}
inline lmn_renderer_desc renderer_desc()
{
    return LMN_RENDERER_DESC_INIT;
}
inline lmn_target target()
{
    return LMN_TARGET_INIT;
}
inline lmn_sheet_desc sheet_desc()
{
    return LMN_SHEET_DESC_INIT;
}
inline lmn_film_desc film_desc(int width = 1024, int height = 1024, double rate = 24)
{
    lmn_film_desc desc = LMN_FILM_DESC_INIT;
    desc.width = width;
    desc.height = height;
    desc.rate = rate;
    return desc;
}
inline lmn_mesh_desc mesh_desc()
{
    return LMN_MESH_DESC_INIT;
}
inline lmn_material_desc material_desc()
{
    return LMN_MATERIAL_DESC_INIT;
}
inline lmn_camera_desc camera_desc()
{
    return LMN_CAMERA_DESC_INIT;
}
inline lmn_light_desc light_desc()
{
    return LMN_LIGHT_DESC_INIT;
}
inline lmn_node_desc node_desc()
{
    return LMN_NODE_DESC_INIT;
}

inline lmn_technique_desc technique_desc(const char *name, const char *glsl)
{
    lmn_technique_desc desc = LMN_TECHNIQUE_DESC_INIT;
    desc.name = name;
    desc.glsl = glsl;
    return desc;
}

/* --- what the program brings: memory, techniques, formats ----------------------------------------------- */

/* Takes all memory of the library from an object with alloc(size), resize(block, size) and release(block), none of
 * which throws; nullptr says that there is no memory. It lives as long as the process: once, before all else. */
template <class Allocator> void set_allocator(Allocator &from)
{
    static_assert(noexcept(from.alloc(std::size_t())) &&noexcept(from.resize(nullptr, std::size_t())) &&noexcept(
                      from.release(nullptr)),
                  "nothing may be thrown through C");
    lmn_allocator a = LMN_ALLOCATOR_INIT;
    a.alloc = [](std::size_t size, void *user) -> void * { return static_cast<Allocator *>(user)->alloc(size); };
    a.resize = [](void *block, std::size_t size, void *user) -> void * {
        return static_cast<Allocator *>(user)->resize(block, size);
    };
    a.release = [](void *block, void *user) { static_cast<Allocator *>(user)->release(block); };
    a.user = &from;
    call(lmn_allocator_set, &a);
}

/* A set of techniques of the program's own, for looks that are opened with it and may outlive it. */
class techniques : public detail::handle<lmn_techniques, lmn_techniques_destroy>
{
  public:
    techniques()
    {
        call(lmn_techniques_create, out());
    }
    /* techniques().add(technique_desc("heights", glsl), {{...}, {...}}): rows as in limner/techniques.h. */
    techniques &add(lmn_technique_desc desc, const std::vector<lmn_param_desc> &params = {})
    {
        if (!params.empty()) {
            desc.params = params.data();
            desc.param_count = params.size();
        }
        call(lmn_techniques_add, get(), &desc);
        return *this;
    }
    /* Their names. */
    std::vector<std::string> names() const
    {
        std::vector<std::string> all;
        lmn_technique_info       info = {};
        while (lmn_techniques_at(get(), all.size(), &info))
            all.emplace_back(info.name);
        return all;
    }
};

class scene;

/* A format that the program reads itself. The functions may throw: then the file is not read, and the call that reads
 * it throws what they have thrown. A limner::scene that is lent to them is not kept. */
struct importer {
    using probe_function = std::function<bool(const std::uint8_t *bytes, std::size_t size)>;
    using read_function =
        std::function<void(scene &into, const char *path, const std::uint8_t *bytes, std::size_t size)>;
    std::string    name, endings; /* ".off .coff" */
    read_function  read;
    probe_function probe; /* empty: the endings say which files are its own */
};

/* --- scene, look, renderer ------------------------------------------------------------------------------ */

class scene : public detail::handle<lmn_scene, lmn_scene_destroy>
{
  public:
    scene()
    {
        call(lmn_scene_create, out());
    }
    /* Of a model file. */
    explicit scene(const std::string &path, const lmn_load_desc &desc = load_desc(), progress_function ask = {})
        : scene()
    {
        add_file(path, desc, std::move(ask));
    }
    void add_file(const std::string &path, lmn_load_desc desc = load_desc(), progress_function ask = {})
    {
        detail::watch w{std::move(ask), nullptr};
        w.attach(desc);
        w.run(lmn_scene_add_file, get(), path.c_str(), &desc);
    }
    /* With formats of the program's own, asked before Limner's. */
    void add_file(const std::string &path, const std::vector<importer> &formats, lmn_load_desc desc = load_desc(),
                  progress_function ask = {});
    lmn_scene_info info() const
    {
        return lmn_scene_info_of(get());
    }
    std::string info_json() const
    {
        return detail::take(lmn_scene_info_json(get()));
    }
    std::string dynamics_json() const
    {
        return detail::take(lmn_scene_dynamics_json(get()));
    }
    /* By index from 0; its texts are the scene's. nullopt: out of range. */
    std::optional<lmn_part_info> part(std::size_t index) const
    {
        lmn_part_info found = {};
        return lmn_scene_part_at(get(), index, &found) ? std::optional<lmn_part_info>(found) : std::nullopt;
    }
    /* Content from memory; the results are numbers, as in limner/content.h. */
    std::uint32_t add(const lmn_mesh_desc &desc)
    {
        return add_by(lmn_scene_add_mesh, desc);
    }
    std::uint32_t add(const lmn_material_desc &desc)
    {
        return add_by(lmn_scene_add_material, desc);
    }
    std::uint32_t add(const lmn_camera_desc &desc)
    {
        return add_by(lmn_scene_add_camera, desc);
    }
    std::uint32_t add(const lmn_light_desc &desc)
    {
        return add_by(lmn_scene_add_light, desc);
    }
    std::uint32_t add(const lmn_node_desc &desc)
    {
        return add_by(lmn_scene_add_node, desc);
    }

  private:
    friend struct detail::reading;
    struct lent {
    };
    scene(lent, lmn_scene *of) noexcept : handle(of)
    {
    }
    template <class Desc>
    std::uint32_t add_by(lmn_status (*function)(lmn_scene *, const Desc *, std::uint32_t *, lmn_error *),
                         const Desc &desc)
    {
        std::uint32_t number = 0;
        call(function, get(), &desc, &number);
        return number;
    }
};

namespace detail
{

/* An importer while a file is read: its row of C, and what its functions throw. */
struct reading {
    const importer     *format;
    std::exception_ptr *thrown; /* of all formats of the call */
    lmn_importer        row;

    static bool probe(const void *bytes, std::size_t size, void *user) noexcept
    {
        reading *r = static_cast<reading *>(user);
        try {
            return r->format->probe(static_cast<const std::uint8_t *>(bytes), size);
        } catch (...) {
            *r->thrown = std::current_exception();
            return true; /* so that the file is not read by another */
        }
    }
    static lmn_status read(lmn_scene *into, const char *path, const void *bytes, std::size_t size, void *user,
                           lmn_error *e) noexcept;
};

} // namespace detail

inline lmn_status detail::reading::read(lmn_scene *into, const char *path, const void *bytes, std::size_t size,
                                        void *user, lmn_error *e) noexcept
{
    reading   *r = static_cast<reading *>(user);
    scene      lent{scene::lent(), into};
    lmn_status status = LMN_FORMAT;
    try {
        if (!*r->thrown)
            r->format->read(lent, path, static_cast<const std::uint8_t *>(bytes), size);
        status = *r->thrown ? LMN_FORMAT : LMN_OK;
    } catch (const error &thrown) {
        *r->thrown = std::current_exception();
        status = thrown.status();
    } catch (...) {
        *r->thrown = std::current_exception();
    }
    lent.release(); /* not ours to end */
    e->status = status;
    return status;
}

inline void scene::add_file(const std::string &path, const std::vector<importer> &formats, lmn_load_desc desc,
                            progress_function ask)
{
    detail::watch                     w{std::move(ask), nullptr};
    std::exception_ptr                thrown;
    std::vector<detail::reading>      readings;
    std::vector<const lmn_importer *> rows;
    readings.reserve(formats.size());
    for (const importer &format : formats) {
        readings.push_back({&format, &thrown, LMN_IMPORTER_INIT});
        lmn_importer &row = readings.back().row;
        row.name = format.name.c_str();
        row.endings = format.endings.c_str();
        row.probe = format.probe ? detail::reading::probe : nullptr;
        row.read = format.read ? detail::reading::read : nullptr;
        row.user = &readings.back();
        rows.push_back(&row);
    }
    desc.importers = rows.data();
    desc.importer_count = rows.size();
    w.attach(desc);
    try {
        w.run(lmn_scene_add_file, get(), path.c_str(), &desc);
    } catch (const error &) {
        if (thrown)
            std::rethrow_exception(thrown);
        throw;
    }
}

class look : public detail::handle<lmn_look, lmn_look_destroy>
{
  public:
    /* One that ships, by its name, or that of a file. */
    explicit look(const std::string &name_or_path)
    {
        call(lmn_look_load, out(), name_or_path.c_str());
    }
    /* The same with techniques of the program's own. */
    look(const std::string &name_or_path, const techniques &own)
    {
        open(own, name_or_path.c_str(), nullptr, nullptr);
    }
    static look parse(const std::string &json, const techniques &own, const std::string &name = "look")
    {
        look made;
        made.open(own, nullptr, json.c_str(), name.c_str());
        return made;
    }
    static look parse(const std::string &json, const std::string &name = "look")
    {
        look made;
        call(lmn_look_parse, made.out(), json.c_str(), name.c_str());
        return made;
    }
    /* look("line").set("lines.width", "2px").set(…) */
    look &set(const std::string &key, const std::string &value) &
    {
        call(lmn_look_set, get(), key.c_str(), value.c_str());
        return *this;
    }
    look &&set(const std::string &key, const std::string &value) &&
    {
        return std::move(set(key, value));
    }
    std::string json() const
    {
        return detail::take(lmn_look_json(get()));
    }
    const char *name() const noexcept
    {
        return lmn_look_name(get());
    }
    bool needs_pixels() const noexcept
    {
        return lmn_look_needs_pixels(get());
    }

  private:
    look() noexcept = default;
    void open(const techniques &own, const char *name_or_path, const char *json, const char *name)
    {
        lmn_look_desc desc = LMN_LOOK_DESC_INIT;
        desc.name_or_path = name_or_path;
        desc.json = json;
        desc.name = name;
        desc.techniques = own.get();
        call(lmn_look_open, out(), &desc);
    }
};

class renderer : public detail::handle<lmn_renderer, lmn_renderer_destroy>
{
  public:
    explicit renderer(const lmn_renderer_desc &desc = renderer_desc())
    {
        call(lmn_renderer_create, out(), &desc);
    }
    std::string json() const
    {
        return detail::take(lmn_renderer_json(get()));
    }
    /* Into the framebuffer of a host whose context it has adopted. */
    void draw_into(const scene &s, const look &l, lmn_draw_desc desc, const lmn_target &to, progress_function ask = {})
    {
        detail::watch w{std::move(ask), nullptr};
        w.attach(desc);
        w.run(lmn_draw_into, get(), s.get(), l.get(), &desc, &to);
    }
    /* What one pixel of a picture would show. */
    lmn_pick pick(const scene &s, const look &l, lmn_draw_desc desc, int x, int y, progress_function ask = {})
    {
        detail::watch w{std::move(ask), nullptr};
        lmn_pick      found = {};
        w.attach(desc);
        w.run(lmn_draw_pick, get(), s.get(), l.get(), &desc, x, y, &found);
        return found;
    }
};

/* --- drawings ------------------------------------------------------------------------------------------- */

/* Pixels that a drawing lends: RGBA, 8 bits, sRGB, straight alpha, row 0 on top. */
struct pixels {
    const std::uint8_t *data;
    int                 width, height;
    std::size_t         size() const noexcept
    {
        return std::size_t(width) * std::size_t(height) * 4;
    }
};

/* Where a point of the scene is seen. */
struct projected {
    double x, y, depth; /* pixels from the top left corner; distance along the camera's axis */
};

class drawing : public detail::handle<lmn_drawing, lmn_drawing_destroy>
{
  public:
    drawing(renderer &r, const scene &s, const look &l, lmn_draw_desc desc = draw_desc(), progress_function ask = {})
    {
        detail::watch w{std::move(ask), nullptr};
        w.attach(desc);
        w.run(lmn_draw, out(), r.get(), s.get(), l.get(), &desc);
    }
    limner::pixels pixels() const noexcept
    {
        limner::pixels p = {};
        p.data = lmn_drawing_pixels(get(), &p.width, &p.height);
        return p;
    }
    /* `format` as ".png"; empty: the path's ending. Gives the bytes written. */
    std::uint64_t write(const std::string &path, const std::string &format = {}) const
    {
        std::uint64_t bytes = 0;
        call(lmn_drawing_write, get(), path.c_str(), format.empty() ? nullptr : format.c_str(), &bytes);
        return bytes;
    }
    void write_maps(const std::string &folder) const
    {
        call(lmn_drawing_write_maps, get(), folder.c_str());
    }
    std::string report_json() const
    {
        return detail::take(lmn_drawing_report_json(get()));
    }
    std::vector<warning> warnings() const
    {
        return detail::warnings_of<lmn_drawing>(get(), lmn_drawing_warning_count, lmn_drawing_warning_at);
    }
    /* What follows but project() needs `maps` in the description. A map of float, row 0 on top; ids() is LMN_MAP_ID. */
    std::vector<float> map(lmn_map which) const
    {
        if (which == LMN_MAP_ID)
            throw std::invalid_argument("limner: numbers of LMN_MAP_ID are no floats; ids() has them");
        return copy<float>(which);
    }
    std::vector<std::uint32_t> ids() const
    {
        return copy<std::uint32_t>(LMN_MAP_ID);
    }
    /* Of drawings with `textures`, as in limner/host.h: OpenGL's names; and after read_back() all is in memory, too. */
    std::uint32_t texture() const
    {
        std::uint32_t name = 0;
        call(lmn_drawing_texture, get(), &name);
        return name;
    }
    std::uint32_t map_texture(lmn_map which) const
    {
        std::uint32_t name = 0;
        call(lmn_drawing_map_texture, get(), which, &name);
        return name;
    }
    void read_back()
    {
        call(lmn_drawing_read_back, get());
    }
    /* The bytes of a file; `format` as ".png". */
    std::vector<std::uint8_t> encode(const std::string &format) const
    {
        return detail::encoded(lmn_drawing_encode, get(), format);
    }
    lmn_pick pick(int x, int y) const
    {
        lmn_pick found = {};
        call(lmn_drawing_pick, get(), x, y, &found);
        return found;
    }
    std::vector<std::uint32_t> pick_parts(int x, int y, int width, int height) const
    {
        std::size_t count = 0;
        call(lmn_drawing_pick_parts, get(), x, y, width, height, nullptr, std::size_t(0), &count);
        std::vector<std::uint32_t> parts(count);
        call(lmn_drawing_pick_parts, get(), x, y, width, height, parts.data(), count, &count);
        return parts;
    }
    /* nullopt: behind the camera. */
    std::optional<projected> project(const std::array<double, 3> &point) const
    {
        double    pixel[2] = {0, 0};
        projected p = {};
        if (!lmn_drawing_project(get(), point.data(), pixel, &p.depth))
            return std::nullopt;
        p.x = pixel[0];
        p.y = pixel[1];
        return p;
    }
    std::array<double, 3> unproject(const projected &p) const
    {
        const double          pixel[2] = {p.x, p.y};
        std::array<double, 3> point = {};
        lmn_drawing_unproject(get(), pixel, p.depth, point.data());
        return point;
    }

  private:
    template <class Number> std::vector<Number> copy(lmn_map which) const
    {
        const limner::pixels p = pixels();
        std::vector<Number>  numbers(p.size() / 4 * std::size_t(lmn_map_components(which)));
        call(lmn_drawing_copy_map, get(), which, numbers.data(), numbers.size());
        return numbers;
    }
};

/* A drawing as vectors. */
class sheet : public detail::handle<lmn_sheet, lmn_sheet_destroy>
{
  public:
    /* Without a renderer: lines alone of looks whose surfaces need pixels. */
    sheet(const scene &s, const look &l, const lmn_draw_desc &desc = draw_desc(),
          const lmn_sheet_desc &paper = sheet_desc(), progress_function ask = {})
    {
        make(nullptr, s, l, desc, paper, std::move(ask));
    }
    sheet(renderer &r, const scene &s, const look &l, const lmn_draw_desc &desc = draw_desc(),
          const lmn_sheet_desc &paper = sheet_desc(), progress_function ask = {})
    {
        make(r.get(), s, l, desc, paper, std::move(ask));
    }
    /* `format` as ".svg"; empty: the path's ending. Gives the bytes written. */
    std::uint64_t write(const std::string &path, const std::string &format = {}) const
    {
        std::uint64_t bytes = 0;
        call(lmn_sheet_write, get(), path.c_str(), format.empty() ? nullptr : format.c_str(), &bytes);
        return bytes;
    }
    /* The same bytes; `format` as ".svg". */
    std::vector<std::uint8_t> encode(const std::string &format) const
    {
        return detail::encoded(lmn_sheet_encode, get(), format);
    }
    std::string report_json() const
    {
        return detail::take(lmn_sheet_report_json(get()));
    }
    std::vector<warning> warnings() const
    {
        return detail::warnings_of<lmn_sheet>(get(), lmn_sheet_warning_count, lmn_sheet_warning_at);
    }

  private:
    void make(lmn_renderer *r, const scene &s, const look &l, lmn_draw_desc desc, const lmn_sheet_desc &paper,
              progress_function ask)
    {
        detail::watch w{std::move(ask), nullptr};
        w.attach(desc);
        w.run(lmn_draw_sheet, out(), r, s.get(), l.get(), &desc, &paper);
    }
};

/* --- films, strokes, tasks ------------------------------------------------------------------------------ */

/* Ends without a trace unless it is closed. */
class film : public detail::handle<lmn_film, lmn_film_destroy>
{
  public:
    film(const std::string &path, lmn_film_desc desc, progress_function ask = {})
        : watch_(new detail::watch{std::move(ask), nullptr})
    {
        watch_->attach(desc);
        watch_->run(lmn_film_open, out(), path.c_str(), &desc);
    }
    film(film &&other) noexcept = default;
    film &operator=(film &&other) noexcept
    {
        handle::operator=(std::move(other)); /* ends the old film, which may ask its function, before that goes */
        watch_ = std::move(other.watch_);
        return *this;
    }
    ~film()
    {
        *static_cast<handle *>(this) = handle();
    }
    /* A frame of the film's size. */
    void add(const drawing &d)
    {
        add(d.pixels().data);
    }
    void add(const std::uint8_t *rgba)
    {
        watch().run(lmn_film_add, get(), rgba);
    }
    /* Finishes the file; gives its bytes. */
    std::uint64_t close()
    {
        std::uint64_t bytes = 0;
        watch().run(lmn_film_close, out(), &bytes);
        return bytes;
    }
    std::vector<warning> warnings() const
    {
        return detail::warnings_of<lmn_film>(get(), lmn_film_warning_count, lmn_film_warning_at);
    }

  private:
    detail::watch &watch()
    {
        if (!watch_)
            watch_.reset(new detail::watch{});
        return *watch_;
    }
    std::unique_ptr<detail::watch> watch_;
};

class strokes : public detail::handle<lmn_strokes, lmn_strokes_destroy>
{
  public:
    strokes()
    {
        call(lmn_strokes_create, out(), nullptr);
    } /* none yet */
    explicit strokes(const lmn_pattern_desc &desc)
    {
        call(lmn_strokes_create, out(), &desc);
    }
    explicit strokes(const std::string &path)
    {
        call(lmn_strokes_load, out(), path.c_str());
    }
    std::size_t size() const noexcept
    {
        return lmn_strokes_count(get());
    }
    lmn_stroke at(std::size_t index) const
    {
        lmn_stroke stroke = {};
        call(lmn_strokes_get, get(), index, &stroke);
        return stroke;
    }
    void set(std::size_t index, const lmn_stroke &stroke)
    {
        call(lmn_strokes_set, get(), index, &stroke);
    }
    void write(const std::string &path, const lmn_strokes_view *view = nullptr) const
    {
        call(lmn_strokes_write, get(), path.c_str(), nullptr, view);
    }
};

/* Conditions for what this thread calls while the object lives. Objects of a thread end in the reverse order, as
 * local ones do; so they are not moved. */
class task
{
  public:
    /* Reads a file for Limner: its bytes, or nullopt when there is none. */
    using read_function = std::function<std::optional<std::vector<std::uint8_t>>(const char *path, const char *what)>;

    explicit task(lmn_task_desc desc = lmn_task_desc_standard(), progress_function ask = {}, read_function read = {})
        : watch_{std::move(ask), nullptr}, read_(std::move(read))
    {
        watch_.attach(desc);
        if (read_) {
            desc.read_file = read_file;
            desc.read_user = this;
        }
        call(lmn_task_begin, &task_, &desc);
    }
    task(const task &) = delete;
    task &operator=(const task &) = delete;
    ~task()
    {
        lmn_task_end(&task_);
    }
    lmn_task *get() const noexcept
    {
        return task_;
    }
    /* A call in the task fails when its functions throw: LMN_CANCELLED by the first, LMN_READ by the second. This
     * throws what they have thrown, once. */
    void rethrow()
    {
        watch_.rethrow();
    }

  private:
    static bool read_file(const char *path, const char *what, void **bytes, std::size_t *size, void *user) noexcept
    {
        task *t = static_cast<task *>(user);
        try {
            const std::optional<std::vector<std::uint8_t>> found = t->read_(path, what);
            if (!found)
                return false;
            *bytes = lmn_file_alloc(found->empty() ? 1 : found->size());
            *size = found->size();
            if (*bytes && !found->empty())
                std::memcpy(*bytes, found->data(), found->size());
            return *bytes != nullptr;
        } catch (...) {
            t->watch_.thrown = std::current_exception();
            return false;
        }
    }
    detail::watch watch_;
    read_function read_;
    lmn_task     *task_ = nullptr;
};

/* --- in one line ---------------------------------------------------------------------------------------- */

/* limner::draw("part.stl", "hatch", 1024, 768).write("part.png"). Makes a renderer for this one picture. */
inline drawing draw(const std::string &model, const std::string &look_name_or_path, int width = 1024, int height = 1024)
{
    const scene s(model);
    const look  l(look_name_or_path);
    renderer    r;
    return drawing(r, s, l, draw_desc(width, height));
}

/* The names of the looks that ship. */
inline std::vector<std::string> looks()
{
    std::vector<std::string> names;
    for (std::size_t i = 0; i < lmn_look_count(); i++)
        names.emplace_back(lmn_look_name_at(i));
    return names;
}

} // namespace limner

#include "limner/behaviour.hpp"

#endif
