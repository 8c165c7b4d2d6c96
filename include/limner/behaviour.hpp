/* limner/behaviour.h in C++17; a part of limner.hpp, which includes it. Since 0.1. */
#ifndef LIMNER_BEHAVIOUR_HPP
#define LIMNER_BEHAVIOUR_HPP

#include <limits>

#include "limner/limner.hpp"

namespace limner
{

inline lmn_activity_desc activity_desc(lmn_activity_kind kind)
{
    lmn_activity_desc desc = LMN_ACTIVITY_DESC_INIT;
    desc.kind = kind;
    return desc;
}
inline lmn_constraint_desc constraint_desc(std::uint32_t node, lmn_time_map map, double duration_s)
{
    lmn_constraint_desc desc = LMN_CONSTRAINT_DESC_INIT;
    desc.node = node;
    desc.map = map;
    desc.duration_s = duration_s;
    return desc;
}

/* Makes what happens in a scene, which it is lent. Activities are numbers. */
class behaviour
{
  public:
    /* The value of a property at a time, into as many numbers as it has. It may throw: then the call that lays out the
     * behaviour throws what it has thrown, and the scene is as before. It lives as long as the scene asks it. */
    using value_function = std::function<void(double seconds, double *out)>;

    explicit behaviour(scene &of) noexcept : scene_(of)
    {
    }
    std::uint32_t add(const lmn_activity_desc &desc)
    {
        return number([&](std::uint32_t *out, lmn_error *e) { return lmn_behaviour_add(scene_.get(), &desc, out, e); });
    }
    /* A table, or whatever has rows. */
    std::uint32_t add(lmn_activity_desc desc, const std::vector<lmn_activity_child> &children)
    {
        fill(desc, children);
        return add(desc);
    }
    /* b.add(LMN_ACTIVITY_SEQUENCE, {first, second}) */
    std::uint32_t add(lmn_activity_kind kind, const std::vector<std::uint32_t> &children)
    {
        return add(activity_desc(kind), rows_of(children));
    }
    std::uint32_t add(const lmn_constraint_desc &desc)
    {
        return number([&](std::uint32_t *out, lmn_error *e) {
            return lmn_behaviour_add_constraint(scene_.get(), &desc, out, e);
        });
    }
    std::uint32_t add(lmn_constraint_desc desc, value_function value)
    {
        asked               held = attach(desc, std::move(value));
        const std::uint32_t made = add(desc);
        held.release(); /* the scene ends it */
        return made;
    }
    void set(std::uint32_t activity, const lmn_activity_desc &desc)
    {
        run([&](lmn_error *e) { return lmn_behaviour_set(scene_.get(), activity, &desc, e); });
    }
    void set(std::uint32_t activity, lmn_activity_desc desc, const std::vector<lmn_activity_child> &children)
    {
        fill(desc, children);
        set(activity, desc);
    }
    void set(std::uint32_t activity, const lmn_constraint_desc &desc)
    {
        run([&](lmn_error *e) { return lmn_behaviour_set_constraint(scene_.get(), activity, &desc, e); });
    }
    void set(std::uint32_t activity, lmn_constraint_desc desc, value_function value)
    {
        asked held = attach(desc, std::move(value));
        set(activity, desc);
        held.release();
    }
    void play(const std::vector<std::uint32_t> &activities)
    {
        run([&](lmn_error *e) { return lmn_behaviour_play(scene_.get(), activities.data(), activities.size(), e); });
    }

    /* Takes back what play, or a script, has said. */
    void stop()
    {
        run([&](lmn_error *e) { return lmn_behaviour_stop(scene_.get(), e); });
    }

  private:
    struct question {
        value_function value;
    };
    using asked = std::unique_ptr<question>;

    /* What was thrown while this thread laid something out. */
    static std::exception_ptr &thrown() noexcept
    {
        static thread_local std::exception_ptr pointer;
        return pointer;
    }
    static void ask(double seconds, double *out, void *user) noexcept
    {
        try {
            static_cast<question *>(user)->value(seconds, out);
        } catch (...) {
            if (!thrown())
                thrown() = std::current_exception();
            out[0] = std::numeric_limits<double>::quiet_NaN(); /* which ends the call */
        }
    }
    static void end(void *user) noexcept
    {
        delete static_cast<question *>(user);
    }
    static asked attach(lmn_constraint_desc &desc, value_function value)
    {
        asked held(new question{std::move(value)});
        desc.map = LMN_TIME_MAP_CALLBACK;
        desc.function = ask;
        desc.function_user = held.get();
        desc.release = end;
        return held;
    }
    static void fill(lmn_activity_desc &desc, const std::vector<lmn_activity_child> &children)
    {
        desc.children = children.data();
        desc.child_count = children.size();
    }
    static std::vector<lmn_activity_child> rows_of(const std::vector<std::uint32_t> &children)
    {
        std::vector<lmn_activity_child> rows;
        for (const std::uint32_t child : children)
            rows.push_back({child, 0, 0});
        return rows;
    }
    template <class Function> static void run(Function function)
    {
        lmn_error e = {};
        thrown() = nullptr;
        const lmn_status status = function(&e);
        if (thrown())
            std::rethrow_exception(std::exchange(thrown(), nullptr));
        if (status == LMN_OK)
            return;
        e.status = status;
        throw error(e);
    }
    template <class Function> static std::uint32_t number(Function function)
    {
        std::uint32_t made = 0;
        run([&](lmn_error *e) { return function(&made, e); });
        return made;
    }
    scene &scene_;
};

/* What happens in a scene, laid out in time; the scene neither changes nor ends before it. */
class dynamics : public detail::handle<lmn_dynamics, lmn_dynamics_destroy>
{
  public:
    explicit dynamics(const scene &of, const char *clips = nullptr)
    {
        call(lmn_dynamics_create, of.get(), clips, out());
    }
    double duration() const
    {
        return lmn_dynamics_duration(get());
    }
    std::vector<lmn_lifetime> lifetimes() const
    {
        std::vector<lmn_lifetime> all;
        lmn_lifetime              one = {};
        while (lmn_dynamics_lifetime_at(get(), all.size(), &one))
            all.push_back(one);
        return all;
    }
    /* The nodes from the root to it, and which of lifetimes() move it. */
    std::pair<std::vector<std::uint32_t>, std::vector<std::size_t>> of_node(std::uint32_t node, double from_s,
                                                                            double to_s) const
    {
        std::size_t path = 0, count = 0;
        call(lmn_dynamics_of_node, get(), node, from_s, to_s, nullptr, std::size_t(), &path, nullptr, std::size_t(),
             &count);
        std::pair<std::vector<std::uint32_t>, std::vector<std::size_t>> all{std::vector<std::uint32_t>(path),
                                                                            std::vector<std::size_t>(count)};
        call(lmn_dynamics_of_node, get(), node, from_s, to_s, all.first.data(), path, &path, all.second.data(), count,
             &count);
        return all;
    }
    lmn_point_state point(std::uint32_t node, double time_s, const std::array<double, 3> &at = {}) const
    {
        lmn_point_state state = {};
        call(lmn_dynamics_point, get(), node, at.data(), time_s, &state);
        return state;
    }
    std::vector<lmn_point_state> trajectory(std::uint32_t node, double from_s, double to_s, double tolerance,
                                            const std::array<double, 3> &at = {}) const
    {
        return listed<lmn_point_state>([&](lmn_point_state *states, std::size_t capacity, std::size_t *count) {
            call(lmn_dynamics_trajectory, get(), node, at.data(), from_s, to_s, tolerance, states, capacity, count);
        });
    }
    std::vector<lmn_contact> contacts(std::uint32_t node, double from_s, double to_s, double least = 0) const
    {
        return listed<lmn_contact>([&](lmn_contact *found, std::size_t capacity, std::size_t *count) {
            call(lmn_dynamics_contacts, get(), node, from_s, to_s, least, found, capacity, count);
        });
    }

  private:
    template <class Type, class Function> static std::vector<Type> listed(Function function)
    {
        std::vector<Type> all(64);
        std::size_t       count = 0;
        function(all.data(), all.size(), &count);
        if (count > all.size()) {
            all.resize(count);
            function(all.data(), all.size(), &count);
        }
        all.resize(count);
        return all;
    }
};

} // namespace limner

#endif
