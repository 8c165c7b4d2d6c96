/* Calls of limner/behaviour.h for null_calls_test.c, which this is a part of. */
static const double            place[3] = {1, 2, 3};
static const lmn_activity_desc activity_desc = {
    sizeof(lmn_activity_desc), LMN_ACTIVITY_EVENT, "e", 0, NULL, 0, LMN_FIT_START, 1, 2, NULL, 0};
static const lmn_constraint_desc constraint_desc = {.struct_size = sizeof(lmn_constraint_desc),
                                                    .duration_s = 1,
                                                    .node = 1,
                                                    .values = place,
                                                    .value_count = 1,
                                                    .restitution = 0.7,
                                                    .frequency = 1,
                                                    .rate_deg = 360};

/* A scene with an activity that plays. */
static void play_constraint(world *w)
{
    lmn_constraint_desc desc = constraint_desc;
    uint32_t            activity = 0;
    desc.node = w->node;
    if (lmn_behaviour_add_constraint(w->scene, &desc, &activity, NULL) == LMN_OK)
        lmn_behaviour_play(w->scene, &activity, 1, NULL);
}

CALL(lmn_behaviour_add)
{
    NUMBER;
    return lmn_behaviour_add(P(0, w->scene), P(1, w->desc[0]), P(2, &number), P(3, &w->error));
}
CALL(lmn_behaviour_set)
{
    lmn_behaviour_add(w->scene, &activity_desc, NULL, NULL);
    return lmn_behaviour_set(P(0, w->scene), 1, P(1, w->desc[0]), P(2, &w->error));
}
CALL(lmn_behaviour_add_constraint)
{
    NUMBER;
    return lmn_behaviour_add_constraint(P(0, w->scene), P(1, w->desc[0]), P(2, &number), P(3, &w->error));
}
CALL(lmn_behaviour_set_constraint)
{
    lmn_behaviour_add(w->scene, &activity_desc, NULL, NULL);
    return lmn_behaviour_set_constraint(P(0, w->scene), 1, P(1, w->desc[0]), P(2, &w->error));
}
CALL(lmn_behaviour_play)
{
    lmn_behaviour_add(w->scene, &activity_desc, NULL, NULL);
    return lmn_behaviour_play(P(0, w->scene), P(1, one), 1, P(2, &w->error));
}
CALL(lmn_behaviour_stop)
{
    play_constraint(w);
    return lmn_behaviour_stop(P(0, w->scene), P(1, &w->error));
}
CALL(lmn_behaviour_count)
{
    play_constraint(w);
    return neutral(lmn_behaviour_count(P(0, w->scene)) == 0);
}
CALL(lmn_behaviour_root_at)
{
    play_constraint(w);
    return neutral(lmn_behaviour_root_at(P(0, w->scene), 0) == 0);
}
CALL(lmn_dynamics_create)
{
    lmn_dynamics *made = NULL;
    lmn_status    status = lmn_dynamics_create(P(0, w->scene), P(1, NULL), P(2, &made), P(3, &w->error));
    lmn_dynamics_destroy(&made);
    return status;
}
CALL(lmn_dynamics_destroy)
{
    lmn_dynamics *none = NULL;
    lmn_dynamics_destroy(P(0, &none));
    return neutral(!none);
}

static lmn_dynamics *open_dynamics(world *w)
{
    lmn_dynamics *made = NULL;
    play_constraint(w);
    lmn_dynamics_create(w->scene, NULL, &made, NULL);
    return made;
}

CALL(lmn_dynamics_duration)
{
    lmn_dynamics *d = open_dynamics(w);
    bool          nothing = lmn_dynamics_duration(P(0, d)) == 0;
    lmn_dynamics_destroy(&d);
    return neutral(nothing);
}
CALL(lmn_dynamics_lifetime_at)
{
    lmn_dynamics *d = open_dynamics(w);
    lmn_lifetime  out;
    bool          nothing = !lmn_dynamics_lifetime_at(P(0, d), 0, P(1, &out));
    lmn_dynamics_destroy(&d);
    return neutral(nothing);
}
CALL(lmn_dynamics_of_node)
{
    lmn_dynamics *d = open_dynamics(w);
    uint32_t      path[4];
    size_t        lifetimes[4], path_count, lifetime_count;
    lmn_status status = lmn_dynamics_of_node(P(0, d), w->node, 0, 1, P(1, path), 4, P(2, &path_count), P(3, lifetimes),
                                             4, P(4, &lifetime_count), P(5, &w->error));
    lmn_dynamics_destroy(&d);
    return status;
}
CALL(lmn_dynamics_point)
{
    lmn_dynamics   *d = open_dynamics(w);
    lmn_point_state state;
    lmn_status      status = lmn_dynamics_point(P(0, d), w->node, P(1, place), 0.5, P(2, &state), P(3, &w->error));
    lmn_dynamics_destroy(&d);
    return status;
}
CALL(lmn_dynamics_trajectory)
{
    lmn_dynamics   *d = open_dynamics(w);
    lmn_point_state states[4];
    size_t          count;
    lmn_status status = lmn_dynamics_trajectory(P(0, d), w->node, P(1, place), 0, 1, 0.1, P(2, states), 4, P(3, &count),
                                                P(4, &w->error));
    lmn_dynamics_destroy(&d);
    return status;
}
CALL(lmn_dynamics_contacts)
{
    lmn_dynamics *d = open_dynamics(w);
    lmn_contact   contacts[4];
    size_t        count;
    lmn_status    status =
        lmn_dynamics_contacts(P(0, d), w->node, 0, 1, 0, P(1, contacts), 4, P(2, &count), P(3, &w->error));
    lmn_dynamics_destroy(&d);
    return status;
}
